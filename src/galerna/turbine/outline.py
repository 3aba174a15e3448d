"""The outline of an airfoil and its camber line."""

from __future__ import annotations

import numpy as np

from galerna.turbine.model import Array

_POINTS = 81


def camber_line(coordinates: Array) -> Array:
    """Mean line (m,2) of x/c and z/c of an outline (n,2), halfway between its sides.

    The outline runs from the trailing edge over the suction side to the nose and back.
    """
    nose = int(np.argmin(coordinates[:, 0]))
    x = (1.0 - np.cos(np.linspace(0.0, np.pi, _POINTS))) / 2.0
    suction, pressure = coordinates[nose::-1], coordinates[nose:]
    heights = [np.interp(x, *_rising(side).T) for side in (suction, pressure)]
    return np.column_stack([x, (heights[0] + heights[1]) / 2.0])


def suction_side_first(coordinates: Array) -> Array:
    """The outline (n,2), turned round if it began along the pressure side."""
    nose = int(np.argmin(coordinates[:, 0]))
    upper, lower = coordinates[: nose + 1, 1].mean(), coordinates[nose:, 1].mean()
    return coordinates if upper >= lower else coordinates[::-1].copy()


def _rising(side: Array) -> Array:
    """One side from the nose to the trailing edge with x never falling, as interpolation needs."""
    return side[np.argsort(side[:, 0], kind="stable")]
