"""The moved base of a case: the foot of the tower, or the platform."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from galerna.case.options import BaseMotion, Harmonic, Series
from galerna.contract import Array
from galerna.coupling.paths import BasePath, Spline
from galerna.coupling.paths import Harmonic as Swing
from galerna.turbine.model import Turbine
from galerna.units import DEG

STILL = BaseMotion()


def base_path(turbine: Turbine, motion: BaseMotion | None) -> BasePath | None:
    """How the base of a turbine moves; None where it is the ground. A platform stands still."""
    if motion is None and turbine.platform is None:
        return None
    chosen = motion or STILL
    return BasePath(
        base_place(turbine),
        {
            "surge": over_time(chosen.surge_m, 1.0),
            "sway": over_time(chosen.sway_m, 1.0),
            "heave": over_time(chosen.heave_m, 1.0),
            "roll": over_time(chosen.roll_deg, DEG),
            "pitch": over_time(chosen.pitch_deg, DEG),
            "yaw": over_time(chosen.yaw_deg, DEG),
        },
    )


def base_place(turbine: Turbine) -> Array:
    """Where a turbine's base stands (3,) m: the platform's reference point or the tower's foot."""
    platform = turbine.platform
    return np.array(turbine.tower.axis[0] if platform is None else platform.reference_point)


def over_time(value: float | Series | Harmonic, unit: float) -> Callable[[float], float]:
    """A smooth function of time s for what a case says, in SI."""
    if isinstance(value, Series):
        return Spline(np.array(value.time_s), unit * np.array(value.values))
    if isinstance(value, Harmonic):
        return Swing(
            unit * value.mean,
            unit * value.amplitude,
            value.frequency_hz,
            value.phase_deg * DEG,
            value.ramp_s,
        )
    return Spline(np.zeros(1), np.array([unit * value]))
