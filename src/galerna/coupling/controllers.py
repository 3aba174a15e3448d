"""From the options of a case to the controller, and what stands between it and the machine."""

from __future__ import annotations

from math import inf, pi

from galerna.case import LoadedCase
from galerna.control.actuators import PitchActuator
from galerna.control.baseline import BaselineController, BaselineSettings
from galerna.control.discon import DisconController
from galerna.control.external import ExternalController
from galerna.control.individual_pitch import IndividualPitchSettings
from galerna.control.interface import Controller
from galerna.control.options import (
    BaselineOptions,
    Control,
    DisconOptions,
    IndividualPitchOptions,
    PythonOptions,
    YawOptions,
)
from galerna.control.python_controller import python_controller
from galerna.control.yawing import YawSettings
from galerna.coupling.gains_file import with_stored_gains
from galerna.coupling.strategy import completed, root_moment_by_pitch
from galerna.errors import InputError
from galerna.turbine.model import Turbine
from galerna.units import DEG

INDIVIDUAL_PITCH_TIME = 5.0  #: s, in which individual pitch control takes the moments away


def controller(
    case: LoadedCase, turbine: Turbine, from_outside: Controller | None = None
) -> Controller | None:
    """The controller that a case describes, or for an external one that which is given.

    None for a case without control. Raises InputError for a file that is not there.
    """
    if case.case.control is None:
        return None
    with case.blame("control"):
        return _controller(case, case.case.control, turbine, from_outside)


def _controller(
    case: LoadedCase, options: Control, turbine: Turbine, from_outside: Controller | None
) -> Controller:
    if isinstance(options, DisconOptions):
        return DisconController(options, turbine, case.folder, sample_time(case))
    if isinstance(options, PythonOptions):
        with case.blame("control", "object"):
            return python_controller(options.object, turbine, case.folder)
    if isinstance(options, BaselineOptions):
        return baseline(options, with_gains(case, turbine))
    return from_outside or ExternalController()


def with_gains(case: LoadedCase, turbine: Turbine) -> Turbine:
    """The turbine with the gains of the file that its case names, or with its own."""
    options = case.case.control
    if not isinstance(options, BaselineOptions) or options.gains is None:
        return turbine
    with case.blame("control", "gains"):
        return with_stored_gains(turbine, case.folder / options.gains)


def baseline(options: BaselineOptions, turbine: Turbine) -> BaselineController:
    """The reference controller; what the turbine leaves open comes from its own rotor."""
    fine, brake, overspeed = (
        options.fine_pitch_deg,
        options.brake_torque_kN_m,
        options.overspeed_percent,
    )
    actuator, individual = options.pitch_actuator, options.individual_pitch
    rate = actuator.rate_limit_deg_s
    settings = BaselineSettings(
        above_rated=options.above_rated,
        mode=options.mode,
        events=tuple((event.time_s, event.mode) for event in options.events),
        fine_pitch=None if fine is None else fine * DEG,
        pitch_rate=inf if rate is None else rate * DEG,
        highest_pitch=actuator.highest_deg * DEG,
        overspeed=None if overspeed is None else overspeed / 100.0,
        brake_torque=None if brake is None else brake * 1e3,
        emergency_brake=options.emergency_brake,
        individual_pitch=None if individual is None else _individual_pitch(individual, turbine),
        yaw=None if options.yaw is None else _yaw(options.yaw),
    )
    return BaselineController(completed(turbine, options.above_rated), settings)


def _individual_pitch(options: IndividualPitchOptions, turbine: Turbine) -> IndividualPitchSettings:
    integral, per_meganewton = options.integral_gain_deg_per_MN_m_s, DEG / 1e6
    if integral is None:
        gain = 1.0 / (INDIVIDUAL_PITCH_TIME * root_moment_by_pitch(turbine))
    else:
        gain = integral * per_meganewton
    return IndividualPitchSettings(
        integral=gain,
        proportional=options.proportional_gain_deg_per_MN_m * per_meganewton,
        azimuth_offset=options.azimuth_offset_deg * DEG,
        amplitude=options.amplitude_deg * DEG,
        corner=turbine.control.rated_rotor_speed,
        below_rated=options.below_rated,
    )


def _yaw(options: YawOptions) -> YawSettings:
    return YawSettings(options.rate_deg_s * DEG, options.dead_band_deg * DEG, options.averaging_s)


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
    frequency = chosen.frequency_hz
    return PitchActuator(
        chosen.time_constant_s,
        chosen.lowest_deg * DEG,
        chosen.highest_deg * DEG,
        own if rate is None else rate * DEG,
        frequency=None if frequency is None else 2.0 * pi * frequency,
        damping_ratio=chosen.damping_ratio,
    )


def held_inertia(turbine: Turbine, flexible_shaft: bool) -> float:
    """The smallest inertia kg m2 that the brake holds, at the low-speed shaft."""
    drivetrain = turbine.drivetrain
    generator = drivetrain.generator_inertia * drivetrain.gear_ratio**2
    return generator if flexible_shaft and generator > 0.0 else generator + turbine.hub.inertia
