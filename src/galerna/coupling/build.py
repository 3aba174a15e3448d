"""From a case to the moving machine and what commands it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from galerna.case import LoadedCase
from galerna.contract import Array, Stations
from galerna.control.drivetrain import PowerTrain
from galerna.control.interface import Controller
from galerna.coupling.afloat import Afloat
from galerna.coupling.base import base_path
from galerna.coupling.control_loop import ControlLoop
from galerna.coupling.controllers import held_inertia, pitch_actuator, sample_time
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.paths import SignalPath, StepPath
from galerna.coupling.sensors import Gauges
from galerna.coupling.trim import Trim
from galerna.errors import InputError
from galerna.inflow.field import WindField
from galerna.kinematics import PrescribedOperation
from galerna.structure import Scheme, TurbineOptions
from galerna.structure.joints import ALL
from galerna.structure.options import StructureOptions
from galerna.turbine.model import Turbine


def turbine_options(
    case: LoadedCase,
    turbine: Turbine,
    operation: PrescribedOperation,
    afloat: Afloat | None = None,
) -> TurbineOptions:
    """What of a case's machine is flexible, where it stands at first, and how it is moved.

    Raises InputError for a part whose sectional data the turbine does not give.
    """
    floating = None if afloat is None else afloat.floating
    locked = () if floating is None else floating.water.locked
    settings = case.case
    options = settings.structure or StructureOptions.rigid()
    _require_sections(turbine, options)
    speed, pitch, yaw = operation.rotor_speed, operation.pitch, operation.yaw
    first_pitch = float(pitch[0].value[0])
    controlled = settings.control is not None
    return TurbineOptions(
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
        yaw_motion=StepPath(float(yaw.value[0])) if controlled else SignalPath(yaw),
        base_motion=base_path(turbine, settings.base_motion)
        if floating is None
        else floating.pose
        if locked
        else None,
        base_locked=locked or ALL,
        platform="rigid" if settings.platform is None else settings.platform.model,
        gravity=(0.0, 0.0, -options.gravity_m_s2),
    )


def _require_sections(turbine: Turbine, options: StructureOptions) -> None:
    """InputError for a part that cannot bend, or not even be moved, for want of data."""
    if turbine.blade.structure is None:
        what = f"{turbine.name!r} gives no sectional stiffness and inertia of its blades"
        hint = "leave out structure, control and base_motion: its motion is prescribed then"
        raise InputError("blades", what, hint)
    if turbine.tower.structure is None and options.tower == "flexible":
        what = f"{turbine.name!r} gives no sectional stiffness and inertia of its tower"
        raise InputError("tower", what, "make it rigid with `tower: rigid`")


def moving_machine(
    case: LoadedCase,
    turbine: Turbine,
    operation: PrescribedOperation,
    stations: Sequence[Sequence[Stations]],
    afloat: Afloat | None = None,
) -> FlexibleMachine:
    """The structure of a case, as it was described; ``Trim.start`` sets it in motion."""
    options = case.case.structure or StructureOptions.rigid()
    newmark = options.alpha_n
    scheme = (
        Scheme.generalized_alpha(options.rho_inf) if newmark is None else Scheme.newmark(newmark)
    )
    outputs = case.case.outputs
    gauges = Gauges(outputs.blade_stations, outputs.tower_stations)
    return FlexibleMachine(
        turbine,
        stations,
        turbine_options(case, turbine, operation, afloat),
        scheme=scheme,
        gauges=gauges,
        energy=outputs.energy,
        loose=options.coupling == "loose",
    )


def trim_of(case: LoadedCase, turbine: Turbine, wind: WindField, afloat: Afloat | None) -> Trim:
    """What a case starts from."""
    describe = partial(turbine_options, case, turbine, afloat=afloat)
    return Trim(case, turbine, wind, describe, None if afloat is None else afloat.floating)


def control_loop(
    case: LoadedCase,
    turbine: Turbine,
    machine: FlexibleMachine,
    hub_wind: Callable[[float], Array],
    controller: Controller,
) -> ControlLoop:
    """The controller of a case with its actuators."""
    options = case.case.control
    assert options is not None
    structure = case.case.structure or StructureOptions.rigid()
    loop = ControlLoop(
        machine,
        controller,
        PowerTrain.of(turbine.drivetrain),
        pitch_actuator(options, turbine),
        hub_wind,
        None if options.sample_time_s is None else sample_time(case),
        torque_lag=options.torque_time_constant_s,
        held_inertia=held_inertia(turbine, structure.shaft == "flexible"),
    )
    machine.given = loop.power_given
    return loop
