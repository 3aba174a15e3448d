"""Individual pitch control: blade angles that take the once-per-revolution load off the roots.

The out-of-plane root moments become a tilt and a yaw moment of the rotor by the Coleman (multi-
blade) transform; integrators hold both at zero, and their angles go back to the blades (Bossanyi,
Wind Energy 6, 2003). A shear or a yaw error, which each blade meets once per turn, is steady
there; a low-pass filter keeps out what is fast.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, inf

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.units import DEG

FADE = 2.0 * DEG  #: of collective pitch above the minimum, over which it comes in


@dataclass(frozen=True)
class IndividualPitchSettings:
    """Gains in rad of pitch per N m of tilt or yaw moment, and per N m s of its integral.

    ``azimuth_offset`` rad turns the blades' angles ahead, by what the actuators lag behind;
    ``amplitude`` rad bounds them. ``below_rated`` acts there too.
    """

    integral: float
    proportional: float = 0.0
    azimuth_offset: float = 0.0
    amplitude: float = 5.0 * DEG
    corner: float = inf
    below_rated: bool = False

    def __post_init__(self) -> None:
        if min(self.integral, self.proportional) < 0.0 or min(self.amplitude, self.corner) <= 0.0:
            what = "its gains cannot be negative, its amplitude and corner must be positive"
            raise InputError("individual_pitch", what)


class IndividualPitch:
    """Angles of the blades beside the collective one, from the moments at their roots."""

    def __init__(self, settings: IndividualPitchSettings) -> None:
        self.settings = settings
        self.rest()

    def rest(self) -> None:
        """Begin anew when it is asked again."""
        self.integral = np.zeros(2)  #: rad, of tilt and yaw
        self.moment = np.full(2, np.nan)  #: N m, of tilt and yaw, filtered

    def __call__(self, moment: Array, azimuth: float, above_minimum: float, dt: float) -> Array:
        """Angles (b,) rad for out-of-plane moments (b,) N m at an azimuth rad of blade 1.

        ``above_minimum`` rad is the collective pitch above its minimum.
        """
        settings = self.settings
        share = 1.0 if settings.below_rated else min(max(above_minimum / FADE, 0.0), 1.0)
        limit = share * settings.amplitude
        now = to_rotor(moment, azimuth)
        before = now if np.isnan(self.moment[0]) else self.moment
        self.moment = now + exp(-settings.corner * dt) * (before - now) if dt else before
        self.integral = bounded(self.integral + settings.integral * dt * self.moment, limit)
        angles = bounded(self.integral + share * settings.proportional * self.moment, limit)
        return to_blades(angles, azimuth + settings.azimuth_offset, len(moment))

    def state(self) -> dict[str, np.ndarray]:
        """The integrals and the filtered moments."""
        return {"individual_pitch": np.append(self.integral, self.moment)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.integral, self.moment = state["individual_pitch"].reshape(2, 2).copy()


def blade_azimuths(azimuth: float, blades: int) -> Array:
    """Azimuth (b,) rad of every blade."""
    return azimuth + np.linspace(0.0, 2.0 * np.pi, blades, endpoint=False)


def to_rotor(values: Array, azimuth: float) -> Array:
    """Cosine and sine part over the azimuth (2,), tilt and yaw, of values (b,) on the blades."""
    around = blade_azimuths(azimuth, len(values))
    share = 2.0 / len(values)
    tilt, yaw = float(np.cos(around) @ values), float(np.sin(around) @ values)
    return np.array([share * tilt, share * yaw])


def to_blades(parts: Array, azimuth: float, blades: int) -> Array:
    """Values (b,) on the blades of a cosine and a sine part (2,)."""
    around = blade_azimuths(azimuth, blades)
    return parts[0] * np.cos(around) + parts[1] * np.sin(around)


def bounded(vector: Array, limit: float) -> Array:
    """A vector that is shortened where it is longer than a limit."""
    length = float(np.hypot(*vector))
    return vector * (limit / length) if length > limit else vector
