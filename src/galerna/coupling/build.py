"""From a case to the moving machine and what commands it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from galerna.case import LoadedCase
from galerna.contract import Array, Stations
from galerna.control.actuators import PitchActuator
from galerna.control.baseline import BaselineController, BaselineSettings
from galerna.control.discon import DisconController
from galerna.control.drivetrain import PowerTrain
from galerna.control.interface import Controller
from galerna.control.options import BaselineOptions, Control, DisconOptions
from galerna.coupling.control_loop import ControlLoop
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.paths import SignalPath, StepPath
from galerna.coupling.trim import start_turning
from galerna.errors import InputError
from galerna.kinematics import PrescribedOperation
from galerna.structure import Scheme, TurbineOptions
from galerna.structure.options import StructureOptions
from galerna.turbine.model import Turbine
from galerna.units import DEG


def moving_machine(
    case: LoadedCase,
    turbine: Turbine,
    operation: PrescribedOperation,
    stations: Sequence[Sequence[Stations]],
) -> FlexibleMachine:
    """The structure of a case; with a controller it starts as ``operation`` says."""
    settings = case.case
    options = settings.structure or StructureOptions.rigid()
    speed, pitch = operation.rotor_speed, operation.pitch
    first_pitch = float(pitch[0].value[0])
    controlled = settings.control is not None
    machine = FlexibleMachine(
        turbine,
        stations,
        TurbineOptions(
            blade_elements=options.blade_elements if options.blades == "flexible" else 0,
            tower_elements=options.tower_elements if options.tower == "flexible" else 0,
            flexible_shaft=options.shaft == "flexible",
            flexible_yaw=options.yaw_bearing == "flexible",
            azimuth=operation.azimuth,
            rotor_motion=None if controlled else SignalPath(speed, integral=True),
            pitch=first_pitch,
            pitch_motion=tuple(
                StepPath(float(angle.value[0]) - first_pitch)
                if controlled
                else SignalPath(angle, offset=-first_pitch)
                for angle in pitch
            ),
            yaw_motion=SignalPath(operation.yaw),
            gravity=(0.0, 0.0, -options.gravity_m_s2),
        ),
        scheme=Scheme.generalized_alpha(options.rho_inf),
    )
    start_turning(machine, float(speed.value[0]))
    return machine


def control_loop(
    case: LoadedCase,
    turbine: Turbine,
    machine: FlexibleMachine,
    hub_wind: Callable[[float], Array],
) -> ControlLoop:
    """The controller of a case with its actuators."""
    options = case.case.control
    assert options is not None
    return ControlLoop(
        machine,
        controller(case, turbine),
        PowerTrain.of(turbine.drivetrain),
        pitch_actuator(options, turbine),
        hub_wind,
        options.sample_time_s,
    )


def controller(case: LoadedCase, turbine: Turbine) -> Controller:
    """The controller that a case describes."""
    options = case.case.control
    assert options is not None
    if isinstance(options, DisconOptions):
        return DisconController(options, turbine, case.folder, sample_time(case))
    if isinstance(options, BaselineOptions):
        fine = options.fine_pitch_deg
        return BaselineController(
            turbine,
            BaselineSettings(
                above_rated=options.above_rated,
                mode=options.mode,
                events=tuple((event.time_s, event.mode) for event in options.events),
                fine_pitch=None if fine is None else fine * DEG,
            ),
        )
    raise InputError("model", f"{options.model!r} is not built yet")


def sample_time(case: LoadedCase) -> float:
    """Time s between the calls of a case's controller; InputError for parts of a time step."""
    options, step = case.case.control, case.case.time_step_s
    chosen = (options.sample_time_s if options is not None else None) or step
    if abs(chosen / step - round(chosen / step)) > 1e-6:
        what = f"{chosen:g} s is not a whole number of time steps of {step:g} s"
        raise InputError("sample_time_s", what)
    return chosen


def pitch_actuator(options: Control, turbine: Turbine) -> PitchActuator:
    """The actuator of a case; the turbine's own rate where none is given."""
    chosen = options.pitch_actuator
    own, rate = turbine.control.maximum_pitch_rate, chosen.rate_limit_deg_s
    return PitchActuator(
        chosen.time_constant_s,
        chosen.lowest_deg * DEG,
        chosen.highest_deg * DEG,
        own if rate is None else rate * DEG,
    )
