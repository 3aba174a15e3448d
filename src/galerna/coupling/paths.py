"""How joints and the base are moved: to where a controller wants them, or as is prescribed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from galerna.contract import Array
from galerna.signals import Signal, evaluate
from galerna.structure.frames import turned_by


class StepPath:
    """An angle over one step, rad: straight from where it was to where it goes."""

    def __init__(self, angle: float) -> None:
        self.start = self.end = angle
        self.time, self.duration = 0.0, 0.0

    def __call__(self, time: float) -> float:
        share = (time - self.time) / self.duration if self.duration else 1.0
        return self.start + min(max(share, 0.0), 1.0) * (self.end - self.start)

    def go(self, angle: float, time: float, duration: float) -> None:
        """Reach ``angle`` rad ``duration`` s after ``time``."""
        self.start, self.end, self.time, self.duration = self.end, angle, time, duration

    def hold(self, angle: float) -> None:
        """Be at ``angle`` rad, always."""
        self.start, self.end, self.time, self.duration = angle, angle, 0.0, 0.0

    def state(self) -> Array:
        """Start, end, time and duration (4,)."""
        return np.array([self.start, self.end, self.time, self.duration])

    def restore(self, state: Array) -> None:
        """Take ``state`` back."""
        self.start, self.end, self.time, self.duration = state.tolist()


class SignalPath:
    """An angle rad that a signal prescribes, or the integral of it: an angle from a speed.

    Before time 0 an angle goes on as it changes there, so that a start is under way.
    """

    def __init__(self, signal: Signal, *, integral: bool = False, offset: float = 0.0) -> None:
        self._knots, self._column = signal.knots(), 2 if integral else 0
        self._offset = offset

    def __call__(self, time: float) -> float:
        early = min(time, 0.0) if self._column == 0 else 0.0
        found = evaluate(self._knots, 0, len(self._knots), time - early)
        return float(found[self._column]) + early * found[1] + self._offset


@dataclass(frozen=True)
class Harmonic:
    """``mean + amplitude sin(2 pi frequency t + phase)``; the amplitude grows over ``ramp`` s."""

    mean: float
    amplitude: float
    frequency: float
    phase: float = 0.0
    ramp: float = 0.0

    def __call__(self, time: float) -> float:
        share = min(max(time / self.ramp, 0.0), 1.0) if self.ramp else 1.0
        grown = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)  # no jump in velocity, rate
        angle = 2.0 * np.pi * self.frequency * time + self.phase
        return self.mean + grown * self.amplitude * float(np.sin(angle))


class Spline:
    """A cubic spline through knots: accelerations are finite everywhere.

    ``time`` (n,) s rises, ``value`` (n,). It is at rest after the last knot and before a first
    one after time 0; one that begins at time 0 or earlier is under way.
    """

    def __init__(self, time: Array, value: Array) -> None:
        self._first, self._last, self._value = float(time[0]), float(time[-1]), float(value[0])
        self._curve, self._slope = None, 0.0
        if len(time) > 1:
            under_way = self._first <= 0.0
            self._curve = CubicSpline(
                time, value, bc_type=((2 if under_way else 1, 0.0), (1, 0.0))
            )  # the order of the derivative that vanishes
            self._slope = float(self._curve(self._first, 1))

    def __call__(self, time: float) -> float:
        if time < self._first or self._curve is None:
            return self._value + self._slope * (time - self._first)
        return float(self._curve(min(time, self._last)))


class BasePath:
    """Where the base is and how it is turned: about z first, then about y, about x last.

    ``place`` (3,) m is where it stands without motion; ``motion`` has the six displacements m
    and angles rad over time, by the names of the platform's degrees of freedom.
    """

    def __init__(self, place: Array, motion: Mapping[str, Callable[[float], float]]) -> None:
        self._place = np.asarray(place, dtype=float)
        self._shift = [motion[name] for name in ("surge", "sway", "heave")]
        self._turn = [motion[name] for name in ("roll", "pitch", "yaw")]

    def __call__(self, time: float) -> tuple[Array, Array]:
        shift = np.array([along(time) for along in self._shift])
        return self._place + shift, turned_by(*(about(time) for about in self._turn))
