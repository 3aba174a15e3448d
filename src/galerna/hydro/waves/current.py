"""A steady horizontal current over the depth."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError

_POINTS = 200  #: of the table of a power law


@dataclass(frozen=True, eq=False)
class Current:
    """Velocity (p,2) m/s along x and y at rising heights (p,) m, 0 at the still water.

    Straight between the heights, constant beyond them: above the still water it is that of
    the surface.
    """

    height: Array
    velocity: Array

    @classmethod
    def none(cls) -> Current:
        return cls(np.zeros(1), np.zeros((1, 2)))

    @classmethod
    def uniform(cls, speed: float, direction: float) -> Current:
        """A speed m/s towards a direction rad at every depth."""
        return cls(np.zeros(1), _along([speed], direction))

    @classmethod
    def power_law(
        cls, speed: float, direction: float, depth: float, exponent: float = 1.0 / 7.0
    ) -> Current:
        """Speed (1 + z/h)^exponent with ``speed`` m/s at the still water (IEC 61400-3).

        Raises InputError where the depth is infinite.
        """
        if not isfinite(depth):
            what = "a power law of the current needs a finite water depth"
            raise InputError("sea.current", what, "take a uniform current or a table")
        above_bed = np.linspace(0.0, 1.0, _POINTS) ** 3
        return cls(depth * (above_bed - 1.0), _along(speed * above_bed**exponent, direction))

    @classmethod
    def table(cls, depth: ArrayLike, speed: ArrayLike, direction: ArrayLike) -> Current:
        """Speeds (p,) m/s towards directions (p,) or one, rad, at rising depths (p,) m."""
        below = np.asarray(depth, dtype=float)
        if np.any(np.diff(below) <= 0.0) or below.min() < 0.0:
            raise InputError("sea.current", f"depths {below.tolist()} m must rise from 0 on")
        return cls(-below[::-1], _along(speed, direction)[::-1])

    def at(self, height: ArrayLike) -> Array:
        """Velocity (n,2) m/s at heights (n,) m."""
        z = np.atleast_1d(np.asarray(height, dtype=float))
        return np.stack([np.interp(z, self.height, part) for part in self.velocity.T], axis=1)


def _along(speed: ArrayLike, direction: ArrayLike) -> Array:
    s = np.asarray(speed, dtype=float)
    return np.stack([s * np.cos(direction), s * np.sin(direction)], axis=1)
