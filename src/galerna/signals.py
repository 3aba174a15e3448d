"""Quantities prescribed over time: straight lines between knots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from galerna.contract import Array


@dataclass(frozen=True, eq=False)
class Signal:
    """A quantity over time: straight between its knots, constant before and after them.

    ``time`` (n,) s ascends; ``value`` (n,) is in SI.
    """

    time: Array
    value: Array

    @classmethod
    def constant(cls, value: float) -> Signal:
        return cls(np.zeros(1), np.array([float(value)]))

    def knots(self) -> Array:
        """Rows (n,3) of time, value and the integral of the value from time 0."""
        steps = np.diff(self.time) * 0.5 * (self.value[1:] + self.value[:-1])
        integral = np.concatenate([[0.0], np.cumsum(steps)])
        table = np.column_stack([self.time, self.value, integral])
        table[:, 2] -= evaluate(table, 0, len(table), 0.0)[2]
        return table

    def mean(self, duration: float) -> float:
        """The mean from time 0 to ``duration`` s."""
        knots = self.knots()
        return evaluate(knots, 0, len(knots), duration)[2] / duration


@njit(cache=True, error_model="numpy")
def evaluate(knots: Array, first: int, end: int, time: float) -> tuple[float, float, float]:
    """Value, slope and integral from time 0 of the signal in rows ``first`` to ``end``.

    The slope at a knot is that of the segment which follows.
    """
    if time < knots[first, 0]:
        before = time - knots[first, 0]
        return knots[first, 1], 0.0, knots[first, 2] + knots[first, 1] * before
    low, high = first, end - 1
    while low < high:
        middle = (low + high + 1) // 2
        if knots[middle, 0] <= time:
            low = middle
        else:
            high = middle - 1
    elapsed = time - knots[low, 0]
    slope = 0.0
    if low < end - 1:
        slope = (knots[low + 1, 1] - knots[low, 1]) / (knots[low + 1, 0] - knots[low, 0])
    value = knots[low, 1] + slope * elapsed
    return value, slope, knots[low, 2] + 0.5 * (knots[low, 1] + value) * elapsed
