"""Angles that are moved: straight over one step to where a controller wants them, or prescribed."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.signals import Signal, evaluate


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

    def state(self) -> Array:
        """Start, end, time and duration (4,)."""
        return np.array([self.start, self.end, self.time, self.duration])

    def restore(self, state: Array) -> None:
        """Take ``state`` back."""
        self.start, self.end, self.time, self.duration = state.tolist()


class SignalPath:
    """An angle rad that a signal prescribes, or the integral of it: an angle from a speed."""

    def __init__(self, signal: Signal, *, integral: bool = False, offset: float = 0.0) -> None:
        self._knots, self._column = signal.knots(), 2 if integral else 0
        self._offset = offset

    def __call__(self, time: float) -> float:
        value = evaluate(self._knots, 0, len(self._knots), time)[self._column]
        return float(value) + self._offset
