"""What stands between a demand and the machine: lags, and limits of rates and angles."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, exp, inf, sin, sqrt

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError


class PitchActuator:
    """A lag of first or second order with limits of rate and angle, one for each blade.

    ``time_constant`` s is the first order's; with ``frequency`` rad/s and ``damping_ratio`` it is
    angle'' = frequency^2 (demand - angle) - 2 damping_ratio frequency angle'. Without either the
    blades follow at once. Both are exact for a demand that is held. ``lowest`` and ``highest``
    rad, which a blade that begins beyond them comes back to, ``rate`` rad/s. Raises InputError for
    figures that no actuator has.
    """

    def __init__(
        self,
        time_constant: float = 0.0,
        lowest: float = -np.pi / 2,
        highest: float = np.pi,
        rate: float = inf,
        *,
        frequency: float | None = None,
        damping_ratio: float = 0.7,
    ) -> None:
        if time_constant < 0.0 or rate <= 0.0 or lowest >= highest:
            what = "needs a lag from 0 on, a rate and a range of angles"
            raise InputError("pitch_actuator", what)
        if frequency is not None and (time_constant > 0.0 or frequency <= 0.0):
            what = "has either a time constant or a positive frequency"
            raise InputError("pitch_actuator", what)
        if damping_ratio < 0.0:
            raise InputError("pitch_actuator", "its damping ratio cannot be negative")
        self.time_constant, self.lowest, self.highest = time_constant, lowest, highest
        self.rate, self.frequency, self.damping_ratio = rate, frequency, damping_ratio
        self._speed: Array | None = None  # rad/s of each blade, where the lag is of second order

    def after(self, pitch: Array, demand: Array, dt: float) -> Array:
        """Pitch (b,) rad ``dt`` s later under a demand (b,) held for that time."""
        step, speed = self._linear(pitch - np.clip(demand, self.lowest, self.highest), dt)
        limit = self.rate * dt
        limited = np.clip(step, -limit, limit)
        lowest, highest = np.minimum(self.lowest, pitch), np.maximum(self.highest, pitch)
        moved = np.clip(pitch + limited, lowest, highest)
        if self.frequency is not None:
            speed = np.where(limited == step, speed, np.sign(limited) * self.rate)
            self._speed = np.where(moved == pitch + limited, speed, 0.0)
        return moved

    def _linear(self, offset: Array, dt: float) -> tuple[Array, Array]:
        """Step rad and final speed rad/s without limits, from an offset (b,) rad to the demand."""
        if self.frequency is None:
            left = exp(-dt / self.time_constant) if self.time_constant > 0.0 else 0.0
            return (left - 1.0) * offset, np.zeros_like(offset)
        if self._speed is None:
            self._speed = np.zeros_like(offset)
        a, b, c, d = free_motion(self.frequency, self.damping_ratio, dt)
        return (a - 1.0) * offset + b * self._speed, c * offset + d * self._speed

    def state(self) -> dict[str, np.ndarray]:
        """The speeds of the blades, where they are a state."""
        return {} if self._speed is None else {"pitch_speed": self._speed.copy()}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        speed = state.get("pitch_speed")
        self._speed = None if speed is None else speed.copy()


def free_motion(frequency: float, damping: float, dt: float) -> tuple[float, float, float, float]:
    """[[a, b], [c, d]] that takes offset and speed of an oscillator ``dt`` s on, row by row."""
    decay = damping * frequency
    root = frequency * sqrt(abs(1.0 - damping**2))
    turn = root * dt
    if turn < 1e-6:  # critical damping
        wave, rise = exp(-decay * dt), exp(-decay * dt) * dt
    elif damping < 1.0:
        wave, rise = exp(-decay * dt) * cos(turn), exp(-decay * dt) * sin(turn) / root
    else:  # cosh and sinh alone would overflow
        slow, fast = exp((root - decay) * dt), exp(-(root + decay) * dt)
        wave, rise = 0.5 * (slow + fast), 0.5 * (slow - fast) / root
    pull = decay * rise
    return wave + pull, rise, -(frequency**2) * rise, wave - pull


def limited(value: float, before: float, rate: float, dt: float) -> float:
    """``value`` as near as a rate of change allows, ``dt`` s after ``before``."""
    return min(max(value, before - rate * dt), before + rate * dt)


def lagged(value: float, before: float, time_constant: float, dt: float) -> float:
    """What a first-order lag gives ``dt`` s after ``before`` under a ``value`` that is held."""
    left = exp(-dt / time_constant) if time_constant > 0.0 else 0.0
    return value + left * (before - value)
