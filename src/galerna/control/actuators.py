"""What stands between a demand and the machine: lags, and limits of rates and angles."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError


@dataclass(frozen=True)
class PitchActuator:
    """A first-order lag with limits: ``time_constant`` s, angles rad, rate rad/s."""

    time_constant: float = 0.0
    lowest: float = -np.pi / 2
    highest: float = np.pi
    rate: float = inf

    def __post_init__(self) -> None:
        if self.time_constant < 0.0 or self.rate <= 0.0 or self.lowest >= self.highest:
            raise InputError(
                "pitch actuator", "needs a lag from 0 on, a rate and a range of angles"
            )

    def after(self, pitch: Array, demand: Array, dt: float) -> Array:
        """Pitch (b,) rad ``dt`` s later under a demand (b,) held for that time."""
        lag = 1.0 if self.time_constant == 0.0 else 1.0 - exp(-dt / self.time_constant)
        step = np.clip(lag * (demand - pitch), -self.rate * dt, self.rate * dt)
        return np.clip(pitch + step, self.lowest, self.highest)


def limited(value: float, before: float, rate: float, dt: float) -> float:
    """``value`` as near as a rate of change allows, ``dt`` s after ``before``."""
    return float(np.clip(value, before - rate * dt, before + rate * dt))
