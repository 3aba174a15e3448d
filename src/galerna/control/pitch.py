"""Collective pitch: a PI on the filtered generator speed, its gains scheduled with pitch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError


@dataclass(frozen=True, eq=False)
class PitchGains:
    """Gains against the generator's speed error at pitch angles (n,) rad.

    ``proportional`` (n,) s, ``integral`` (n,) 1 and ``derivative`` (n,) s2, in rad of pitch per
    rad/s of speed, per rad of its integral and per rad/s2 of its rate.
    """

    pitch: Array
    proportional: Array
    integral: Array
    derivative: Array

    @classmethod
    def of_schedule(cls, schedule: Array) -> PitchGains:
        """From rows (n,3) of pitch, proportional and integral gain."""
        pitch, proportional, integral = schedule.T
        return cls(pitch, proportional, integral, np.zeros(len(schedule)))

    def at(self, pitch: float) -> tuple[float, float, float]:
        """Proportional, integral and derivative gain at a pitch angle, the outermost held."""
        p = self.pitch
        return (
            float(np.interp(pitch, p, self.proportional)),
            float(np.interp(pitch, p, self.integral)),
            float(np.interp(pitch, p, self.derivative)),
        )


class LowPass:
    """First-order low-pass (eq. 2.129) of a corner frequency rad/s, exact for a held input."""

    def __init__(self, frequency: float | None) -> None:
        if frequency is not None and frequency <= 0.0:
            raise InputError("speed_filter", f"{frequency:g} rad/s is not a frequency")
        self._frequency = frequency
        self.value = np.nan

    def __call__(self, value: float, dt: float) -> float:
        """The filtered value after ``dt`` s of ``value``; it starts where the input does."""
        if self._frequency is None or np.isnan(self.value):
            self.value = value
        else:
            self.value += (1.0 - exp(-self._frequency * dt)) * (value - self.value)
        return self.value


class CollectivePitch:
    """The pitch angle that holds a generator speed, between ``low`` and ``high`` rad.

    The integral part is an angle and stays within the limits, so that it does not wind up and
    gains may change without a jump.
    """

    def __init__(self, gains: PitchGains, reference: float, low: float, high: float) -> None:
        self.gains, self.reference, self.low, self.high = gains, reference, low, high
        self.integral = low
        self._error = np.nan

    def start(self, pitch: float) -> None:
        """Begin at a pitch angle and no speed error."""
        self.integral, self._error = float(np.clip(pitch, self.low, self.high)), np.nan

    def angle(self, speed: float, dt: float) -> float:
        """Pitch angle for a filtered generator speed rad/s, ``dt`` s after the last."""
        error = speed - self.reference
        proportional, integral, derivative = self.gains.at(self.integral)
        rate = 0.0 if np.isnan(self._error) or dt == 0.0 else (error - self._error) / dt
        self._error = error
        self.integral = float(np.clip(self.integral + integral * error * dt, self.low, self.high))
        angle = self.integral + proportional * error + derivative * rate
        return float(np.clip(angle, self.low, self.high))

    def state(self) -> dict[str, np.ndarray]:
        """The integral and the last error."""
        return {"pitch_integral": np.array(self.integral), "speed_error": np.array(self._error)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.integral, self._error = float(state["pitch_integral"]), float(state["speed_error"])
