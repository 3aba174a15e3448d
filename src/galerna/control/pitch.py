"""Collective pitch: a PID on the filtered generator speed, its gains scheduled with pitch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, inf

import numpy as np

from galerna.contract import Array
from galerna.control.actuators import limited
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
    """The pitch angle that holds a generator speed (eq. 2.127), up to ``high`` rad.

    It changes by at most ``rate`` rad/s: what the actuator can follow. The integral part is an
    angle, so that gains may change without a jump; it stays within the limits of the angle, and
    waits while the rate is at its limit, so that it does not wind up. The gains are those at the
    integral part: the pitch without what the speed's ripple adds.
    """

    def __init__(self, gains: PitchGains, reference: float, high: float, rate: float = inf) -> None:
        self.gains, self.reference, self.high, self.rate = gains, reference, high, rate
        self.integral = self.angle = 0.0
        self._error = np.nan

    def start(self, pitch: float) -> None:
        """Begin at a pitch angle and no speed error."""
        self.integral = self.angle = pitch
        self._error = np.nan

    def go(self, target: float, rate: float, dt: float) -> float:
        """Move towards an angle at a rate rad/s, whatever the speed is."""
        self.start(limited(target, self.angle, min(rate, self.rate), dt))
        return self.angle

    def hold_speed(self, speed: float, low: float, dt: float) -> float:
        """Pitch angle, from ``low`` rad on, for a generator speed ``dt`` s after the last one."""
        error = speed - self.reference
        proportional, integral, derivative = self.gains.at(self.integral)
        change = 0.0 if np.isnan(self._error) or dt == 0.0 else (error - self._error) / dt
        self._error = error
        summed = self._within(self.integral + integral * error * dt, low)
        wanted = self._within(summed + proportional * error + derivative * change, low)
        self.angle = limited(wanted, self.angle, self.rate, dt)
        if (wanted - self.angle) * error <= 0.0:
            self.integral = summed
        return self.angle

    def _within(self, angle: float, low: float) -> float:
        return min(max(angle, low), self.high)

    def state(self) -> dict[str, np.ndarray]:
        """The integral, the last error and the last angle."""
        return {"pitch_pid": np.array([self.integral, self._error, self.angle])}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.integral, self._error, self.angle = state["pitch_pid"].tolist()
