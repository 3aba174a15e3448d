"""Velocity induced by sheets of vortex rings, summed directly over every segment."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
from numba import njit, prange

from galerna.aero.vortex.segments import (
    LANES,
    NUMBERS,
    WIDEST,
    add_tile,
    make_block,
    set_segment,
    whole_vectors,
)
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.simd import FASTMATH
from galerna.contract import Array
from galerna.errors import InputError, did_you_mean

_ROWS = 64  # of a tile: sums in single precision are no longer than this
_REACH = 1e4  # m: what single precision can hold, see `segments`
#: precisions by how many lengths of segments around a block of points are summed in double
_NEAR = {"single": -np.inf, "mixed": 2.0, "double": np.inf}


def direct_velocity(sheets: Sequence[Sheet], points: Array, precision: str = "double") -> Array:
    """Velocity (...,3) m/s that sheets induce at points (...,3) m, eq. (2) of `segments`.

    ``precision`` "single" is good to about 1e-5 of the velocity and meant for vortices with
    cores; "mixed" has double precision for what is near, and is good to 1e-6. Sheets that reach
    further than 10 km are summed in double precision all the same.
    """
    if precision not in _NEAR:
        raise InputError("precision", f"{precision!r}", did_you_mean(precision, _NEAR))
    points = np.asarray(points, dtype=float)
    flat = np.ascontiguousarray(points.reshape(-1, 3))
    velocity = np.zeros_like(flat)
    if len(flat) and len(sheets):
        table, shapes = segment_table(sheets)
        far = _extent(table, flat) > _REACH
        _sum(table, shapes, flat, velocity, np.inf if far else _NEAR[precision])
    return velocity.reshape(points.shape)


def segment_table(sheets: Sequence[Sheet]) -> tuple[Array, Array]:
    """The vertices of all sheets with their segments (k,NUMBERS), see `segments.add_tile`.

    And of each sheet the first row, and the vertices along and across it (sheets,3).
    """
    counts = [sheet.vertices.shape[0] * sheet.vertices.shape[1] for sheet in sheets]
    first = np.concatenate([[0], np.cumsum(counts)])
    table = np.empty((first[-1], NUMBERS))
    for sheet, start in zip(sheets, first, strict=False):
        _fill(
            table,
            start,
            np.ascontiguousarray(sheet.vertices, dtype=float),
            np.ascontiguousarray(sheet.circulation, dtype=float),
            np.ascontiguousarray(np.broadcast_to(sheet.core_radius, sheet.vertices.shape[:2])),
        )
    shapes = [(start, *s.vertices.shape[:2]) for s, start in zip(sheets, first, strict=False)]
    return table, np.array(shapes)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _fill(table, first, vertices, circulation, core):  # type: ignore[no-untyped-def]
    rows, columns = circulation.shape
    for i in range(rows + 1):
        for j in range(columns + 1):
            numbers, x = table[first + i * (columns + 1) + j], vertices[i, j]
            numbers[0], numbers[1], numbers[2] = x[0], x[1], x[2]
            numbers[3:] = 0.0
            if j > 0:
                strength = circulation[i, j - 1] if i < rows else 0.0
                strength -= circulation[i - 1, j - 1] if i > 0 else 0.0
                core_squared = 0.5 * (core[i, j] ** 2 + core[i, j - 1] ** 2)
                set_segment(numbers[3:9], vertices[i, j - 1], x, core_squared, strength)
            if i > 0:
                strength = circulation[i - 1, j - 1] if j > 0 else 0.0
                strength -= circulation[i - 1, j] if j < columns else 0.0
                core_squared = 0.5 * (core[i, j] ** 2 + core[i - 1, j] ** 2)
                set_segment(numbers[9:15], vertices[i - 1, j], x, core_squared, strength)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _extent(table, points):  # type: ignore[no-untyped-def]
    """Largest extent m along an axis of the vertices in a table and points (k,3) together."""
    largest = 0.0
    for i in range(3):
        low = high = points[0, i]
        for k in range(len(points)):
            low, high = min(low, points[k, i]), max(high, points[k, i])
        for k in range(len(table)):
            low, high = min(low, table[k, i]), max(high, table[k, i])
        largest = max(largest, high - low)
    return largest


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FASTMATH)
def _sum(table, shapes, points, velocity, near):  # type: ignore[no-untyped-def]
    for number in prange((len(points) + LANES - 1) // LANES):
        first = number * LANES
        last = min(first + LANES, len(points))
        _sum_at(table, shapes, points[first:last], velocity[first:last], near)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _sum_at(table, shapes, points, velocity, near):  # type: ignore[no-untyped-def]
    """Velocity (k,3) at up to LANES points (k,3); near tiles in double precision."""
    single, double = make_block(WIDEST, np.zeros(1, np.float32)), make_block(WIDEST, np.zeros(1))
    enter(points, single)
    origin, lanes = enter(points, double), whole_vectors(len(points))
    radius = 0.0
    for n in range(len(points)):
        radius = max(radius, _distance(points[n], origin))
    for sheet in range(len(shapes)):
        first, rows, columns = shapes[sheet]
        tiles = max(1, -(-(columns - 1) // (WIDEST - 1)))
        for tile in range(tiles):
            left, right = (columns - 1) * tile // tiles, (columns - 1) * (tile + 1) // tiles
            for top in range(0, rows - 1, _ROWS):
                bottom = min(top + _ROWS, rows - 1)
                corner, borders = first + top * columns + left, (top == 0, left == 0)
                down, across = bottom - top + 1, right - left + 1
                if _is_near(table, corner, columns, down, across, origin, radius, near):
                    add_tile(table, corner, columns, down, across, borders, origin, lanes, double)
                    leave(double, velocity)
                else:
                    add_tile(table, corner, columns, down, across, borders, origin, lanes, single)
                    leave(single, velocity)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _is_near(table, first, stride, rows, columns, origin, radius, near):  # type: ignore[no-untyped-def]
    """Whether the tile is within ``near`` lengths of its longest segment of the block's ball."""
    nearest, longest = np.inf, 0.0
    for i in range(rows):
        for k in range(first + i * stride, first + i * stride + columns):
            nearest = min(nearest, _distance(table[k, :3], origin))
            longest = max(longest, sqrt(max(table[k, 6], table[k, 12])))
    return nearest - radius < near * longest


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _distance(a, b):  # type: ignore[no-untyped-def]
    return sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def enter(points, block):  # type: ignore[no-untyped-def]
    """Put up to LANES points (k,3) m into the block; returns the origin they count from."""
    origin = np.zeros(3)
    for i in range(3):
        origin[i] = np.mean(points[:, i])
        for n in range(LANES):
            block.points[i * LANES + n] = points[min(n, len(points) - 1), i] - origin[i]
    block.velocity[:] = 0.0
    return origin


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def leave(block, velocity):  # type: ignore[no-untyped-def]
    """Add the block's velocity to ``velocity`` (k,3) m/s, and start again from zero."""
    for n in range(len(velocity)):
        for i in range(3):
            velocity[n, i] += block.velocity[i * LANES + n]
    block.velocity[:] = 0.0
