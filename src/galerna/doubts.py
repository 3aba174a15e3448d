"""What can be simulated but is hardly meant: said before a run, without stopping it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.case import Case
from galerna.case.options import BaseMotion, Harmonic
from galerna.control.options import BaselineOptions
from galerna.kinematics import PrescribedOperation
from galerna.structure.options import StructureOptions
from galerna.turbine.model import Turbine
from galerna.units import DEG, RPM

LARGEST_TIP_SPEED = 150.0  #: m/s
LARGEST_OVERSPEED = 1.5  #: times the rated tip speed
PITCH_RANGE = (-10.0, 100.0)  #: deg
LOWEST_ATTACHED = 3.0  #: tip-speed ratio
LARGEST_TURN = 10.0  #: deg of azimuth in a time step


def doubts(
    case: Case, turbine: Turbine, operation: PrescribedOperation, mean_wind: float
) -> Iterator[str]:
    """One sentence for each thing in doubt; ``mean_wind`` m/s is at the hub."""
    yield from _about_speed(turbine, operation.rotor_speed.value, case.time_step_s)
    yield from _about_pitch(np.concatenate([signal.value for signal in operation.pitch]) / DEG)
    if case.start.operating_point == "steady":
        yield from _about_wind(turbine, mean_wind)
    steps = case.duration_s / case.time_step_s
    if abs(steps - round(steps)) > 1e-6 * steps:
        yield (
            f"duration_s, {case.duration_s:g} s, is not a whole number of steps of "
            f"{case.time_step_s:g} s: the run ends at {round(steps) * case.time_step_s:g} s"
        )
    if isinstance(case.aerodynamics, VortexLatticeOptions) and not case.aerodynamics.decambering:
        yield from _about_attached_flow(turbine, operation.rotor_speed.value, mean_wind)
    if case.moves and case.structure is not None:
        yield from _about_step(turbine, case.structure, case.time_step_s)
    if turbine.platform is not None and case.base_motion is None and case.sea is None:
        yield "the platform is held still: give a sea for it to float in, such as `sea: still`"
    if case.base_motion is not None:
        yield from _about_base_motion(case.base_motion, case.time_step_s)
    if isinstance(case.control, BaselineOptions):
        for event in case.control.events:
            if event.time_s >= case.duration_s:
                yield (
                    f"the control event {event.mode} at {event.time_s:g} s does not come: "
                    f"the run ends at {case.duration_s:g} s"
                )


def _about_speed(turbine: Turbine, speeds: np.ndarray, time_step: float) -> Iterator[str]:
    lowest, fastest = float(speeds.min()), float(abs(speeds).max())
    if lowest < 0.0:
        yield f"the rotor turns backwards, at {lowest / RPM:.4g} rpm"
    tip, rated = (
        turbine.rotor_radius * speed for speed in (fastest, turbine.control.rated_rotor_speed)
    )
    if tip > min(LARGEST_TIP_SPEED, LARGEST_OVERSPEED * rated):
        yield (
            f"the blade tips move at {tip:.4g} m/s ({fastest / RPM:.4g} rpm); "
            f"at rated speed it is {rated:.4g} m/s"
        )
    turn = fastest * time_step / DEG
    if turn > LARGEST_TURN:
        yield (
            f"the rotor turns {turn:.4g} deg in a time step of {time_step:g} s: "
            f"above {LARGEST_TURN:g} deg the loads over a turn are coarse"
        )


def _about_step(turbine: Turbine, parts: StructureOptions, time_step: float) -> Iterator[str]:
    """The bending that a step resolves least, where that is too little."""
    if parts.blades == "rigid" and parts.tower == "rigid":
        return
    from galerna.coupling.step_size import STEPS_PER_PERIOD, bending_periods

    name, period = min(bending_periods(turbine, parts).items(), key=lambda item: item[1])
    if period < STEPS_PER_PERIOD * time_step * (1.0 - 1e-9):
        yield (
            f"the first {name} takes {period:.3g} s, {period / time_step:.2g} time steps: it is "
            f"hardly followed; time_step_s: {period / (2 * STEPS_PER_PERIOD):.1g} would do"
        )


def _about_base_motion(motion: BaseMotion, time_step: float) -> Iterator[str]:
    from galerna.coupling.step_size import STEPS_PER_PERIOD

    for key, value in motion:
        if not isinstance(value, Harmonic):
            continue
        steps = 1.0 / (value.frequency_hz * time_step)
        if steps < STEPS_PER_PERIOD * (1.0 - 1e-9):
            yield (
                f"base_motion, {key}: a swing takes {1.0 / value.frequency_hz:.3g} s, {steps:.2g} "
                f"time steps: below {STEPS_PER_PERIOD} it is hardly followed"
            )


def _about_attached_flow(turbine: Turbine, speeds: np.ndarray, mean_wind: float) -> Iterator[str]:
    slowest = float(abs(speeds).min()) * turbine.rotor_radius
    if slowest < LOWEST_ATTACHED * mean_wind:
        yield (
            f"the blade tips move at {slowest:.4g} m/s in a wind of {mean_wind:.4g} m/s: most "
            "sections will stall, and the vortex lattice lifts on unless decambering is true"
        )


def _about_pitch(pitch: np.ndarray) -> Iterator[str]:
    low, high = PITCH_RANGE
    for angle in (pitch.min(), pitch.max()):
        if not low <= angle <= high:
            yield f"a blade is pitched to {angle:.4g} deg, beyond {low:g} to {high:g} deg"
            return


def _about_wind(turbine: Turbine, mean_wind: float) -> Iterator[str]:
    control = turbine.control
    if mean_wind < control.cut_in_wind_speed:
        yield (
            f"the mean wind of {mean_wind:.4g} m/s is below cut-in, "
            f"{control.cut_in_wind_speed:g} m/s: the turbine would not run"
        )
    if mean_wind > control.cut_out_wind_speed:
        yield (
            f"the mean wind of {mean_wind:.4g} m/s is above cut-out, "
            f"{control.cut_out_wind_speed:g} m/s: the turbine would not run"
        )
