"""The tower's influence on the wind that the blades meet: dam effect and shadow.

In a plane across the tower, in tower radii, x with the wind and y across it, r^2 = x^2 + y^2,
the wind W (relative to the tower, across its axis) is changed by

    potential flow about a circle:   W (y^2 - x^2) / r^4 along x,   - W 2 x y / r^4 along y
    shadow (Powles, Wind Engineering 7, 1983, with the width of AeroDyn's theory manual):
        - W C_d / sqrt(r) cos^2(pi y / (2 sqrt(r))) along x,   for x > 0 and |y| < sqrt(r)

The shadow's momentum deficit, the integral of C_d / sqrt(r) cos^2(...) over y, is C_d: it is
the tower's drag. It is held to half of the wind, so that air never flows back. Beyond the
tower's top both end as cos^2(pi z / 2) within one radius; towards the base they go on.
"""

from __future__ import annotations

from math import cos, pi, sqrt

import numpy as np
from numba import njit

from galerna.aero.bem.lag import FASTMATH
from galerna.aero.vectors import (
    Vector,
    add,
    combine,
    cross,
    dot,
    length,
    put,
    row,
    scale,
    subtract,
)
from galerna.contract import Array
from galerna.turbine.model import Tower

LARGEST_DEFICIT = 0.5  #: of the wind, in the shadow


def tower_sections(tower: Tower, span: Array) -> Array:
    """Radius m and drag coefficient (m,2) of the tower at the fractions ``span`` (m,)."""
    return np.stack(
        [
            np.interp(span, tower.axis_span, 0.5 * tower.diameter),
            np.interp(span, tower.axis_span, tower.drag_coefficient),
        ],
        axis=1,
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def across_tower(x: float, y: float, drag_coefficient: float, shadow: bool) -> tuple[float, float]:
    """Change of the wind along x and y, as a share of it, at (x, y) in tower radii, r >= 1."""
    square = x * x + y * y
    along = (y * y - x * x) / (square * square)
    sideways = -2.0 * x * y / (square * square)
    width = sqrt(sqrt(square))
    if shadow and x > 0.0 and abs(y) < width:
        deficit = drag_coefficient / width * cos(0.5 * pi * y / width) ** 2
        along -= min(deficit, LARGEST_DEFICIT)
    return along, sideways


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _segment(point: Vector, position: Array) -> tuple[int, float]:
    """The part of the axis that a point stands beside, and where on it; 0 and 1 are its ends."""
    for k in range(position.shape[0] - 2, -1, -1):
        along = subtract(row(position, k + 1), row(position, k))
        place = dot(subtract(point, row(position, k)), along) / dot(along, along)
        if place >= 0.0:
            return k, place
    return 0, 0.0


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _change(
    point: Vector, air: Vector, position: Array, motion: Array, section: Array, shadow: bool
) -> tuple[Vector, bool]:
    """Change of the wind ``air`` at one point, and whether the point is inside the tower."""
    still = (0.0, 0.0, 0.0)
    k, place = _segment(point, position)
    beyond, place = max(place - 1.0, 0.0), min(place, 1.0)
    axis = subtract(row(position, k + 1), row(position, k))
    extent = length(axis)
    axis = scale(1.0 / extent, axis)
    radius = section[k, 0] + place * (section[k + 1, 0] - section[k, 0])
    height = beyond * extent / radius if k == position.shape[0] - 2 else 0.0
    moving = combine(1.0 - place, row(motion, k), place, row(motion, k + 1))
    wind = subtract(air, moving)
    wind = combine(1.0, wind, -dot(wind, axis), axis)
    speed = length(wind)
    if height >= 1.0 or speed == 0.0:
        return still, False
    across = cross(axis, wind)
    arm = scale(1.0 / (speed * radius), subtract(point, row(position, k)))
    x, y = dot(arm, wind), dot(arm, across)
    if x * x + y * y < 1.0:
        return still, height == 0.0
    drag = section[k, 1] + place * (section[k + 1, 1] - section[k, 1])
    along, sideways = across_tower(x, y, drag, shadow)
    fade = cos(0.5 * pi * height) ** 2
    return combine(fade * along, wind, fade * sideways, across), False


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_tower_influence(
    points: Array, position: Array, motion: Array, section: Array, shadow: bool, velocity: Array
) -> int:
    """Change the wind ``velocity`` (n,3) m/s at ``points`` (n,3) m as the tower does.

    The tower's axis passes through ``position`` (m,3) m from base to top, which move with
    ``motion`` (m,3) m/s and have the ``section`` (m,2) of ``tower_sections``. Each point is
    changed by its own wind. Returns the index of the first point inside the tower, whose
    wind is left as it is, or -1.
    """
    first = -1
    for i in range(points.shape[0]):
        air = row(velocity, i)
        change, inside = _change(row(points, i), air, position, motion, section, shadow)
        put(velocity, i, add(air, change))
        if inside and first < 0:
            first = i
    return first
