"""Velocity of rings of unit circulation: what the boundary condition is made of."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from galerna.aero.vortex.biot_savart import enter
from galerna.aero.vortex.segments import (
    LANES,
    NUMBERS,
    add_segment,
    add_tile,
    make_block,
    see_vertex,
    set_segment,
    whole_vectors,
)
from galerna.aero.vortex.simd import FASTMATH
from galerna.contract import Array


def normal_influence(
    vertices: Array, points: Array, normals: Array, core_radius: Array | float = 0.0
) -> Array:
    """Velocity (k, m*n) 1/m along normals (k,3) at points (k,3) m of each ring of circulation 1.

    The rings stand between vertices (m+1,n+1,3) m; ring (i,j) is column i*n+j. ``core_radius`` m
    stands on the vertices, or anything that broadcasts to them.
    """
    normals = np.ascontiguousarray(normals, float)
    return _ring_influence(vertices, points, normals[:, None], core_radius)[:, 0]


def ring_influence(vertices: Array, points: Array, core_radius: Array | float = 0.0) -> Array:
    """Velocity (k,3,m*n) 1/m at points (k,3) m of each ring, as in `normal_influence`."""
    axes = np.broadcast_to(np.eye(3), (len(points), 3, 3))
    return _ring_influence(vertices, points, axes, core_radius)


def _ring_influence(
    vertices: Array, points: Array, directions: Array, core_radius: Array | float
) -> Array:
    """Velocity (k,d,m*n) 1/m of each ring along the directions (k,d,3) of each point."""
    core = np.ascontiguousarray(np.broadcast_to(core_radius, vertices.shape[:2]), float)
    table = _unit_table(np.ascontiguousarray(vertices, float), core)
    rows, columns = vertices.shape[0] - 1, vertices.shape[1] - 1
    influence = np.empty((*directions.shape[:2], rows * columns))
    _set_rings(table, rows, columns, np.ascontiguousarray(points, float), directions, influence)
    return influence


def strip_influence(vertices: Array, points: Array, core_radius: Array | float = 0.0) -> Array:
    """Velocity (k,n,3) 1/m at points (k,3) m of strips of a wake, each of circulation 1.

    A strip is a column of rings between vertices (K+1,n+1,3) m whose circulation is the same
    from the trailing edge to its end, so its spanwise segments cancel but for the first and the
    last. ``core_radius`` m stands on the vertices, or anything that broadcasts to them.
    """
    core = np.ascontiguousarray(np.broadcast_to(core_radius, vertices.shape[:2]), float)
    table = _unit_table(np.ascontiguousarray(vertices, float), core)
    points = np.ascontiguousarray(points, float)
    influence = np.zeros((len(points), vertices.shape[1] - 1, 3))
    _add_strips(table, vertices.shape[0], vertices.shape[1], points, influence)
    return influence


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _unit_table(vertices, core):  # type: ignore[no-untyped-def]
    """A table for `segments.add_tile` in which every segment has circulation 1."""
    rows, columns = core.shape
    table = np.zeros((rows * columns, NUMBERS))
    for i in range(rows):
        for j in range(columns):
            numbers = table[i * columns + j]
            numbers[:3] = vertices[i, j]
            if j > 0:
                core_squared = 0.5 * (core[i, j] ** 2 + core[i, j - 1] ** 2)
                set_segment(numbers[3:9], vertices[i, j - 1], vertices[i, j], core_squared, 1.0)
            if i > 0:
                core_squared = 0.5 * (core[i, j] ** 2 + core[i - 1, j] ** 2)
                set_segment(numbers[9:15], vertices[i - 1, j], vertices[i, j], core_squared, 1.0)
    return table


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FASTMATH)
def _set_rings(table, rows, columns, points, directions, influence):  # type: ignore[no-untyped-def]
    for number in prange((len(points) + LANES - 1) // LANES):
        low = number * LANES
        high = min(low + LANES, len(points))
        _set_block(
            table, rows, columns, points[low:high], directions[low:high], influence[low:high]
        )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _set_block(table, rows, columns, points, directions, influence):  # type: ignore[no-untyped-def]
    """The influence (k,d,rings) on up to LANES points, gathered with the points as lanes."""
    width = columns + 1
    block = make_block(width, table)
    origin, lanes = enter(points, block), whole_vectors(len(points))
    along = _by_lanes(directions)
    found = np.zeros((directions.shape[1], rows * columns, LANES))
    for i in range(rows + 1):
        now, before = (i % 2) * width, ((i + 1) % 2) * width
        for j in range(width):
            numbers, ring = table[i * width + j], i * columns + j
            place = see_vertex(numbers, origin, now + j, lanes, block)
            if j > 0:
                add_segment(numbers[3:9], place, now + j - 1, now + j, lanes, block)
                below, above = ring - 1 if i < rows else -1, ring - 1 - columns
                _share(block.velocity, along, lanes, below, above, found)
            if i > 0:
                add_segment(numbers[9:15], place, before + j, now + j, lanes, block)
                left, right = ring - columns - 1 if j > 0 else -1, ring - columns
                _share(block.velocity, along, lanes, left, right if j < columns else -1, found)
    for n in range(len(points)):
        for a in range(directions.shape[1]):
            for ring in range(rows * columns):
                influence[n, a, ring] = found[a, ring, n]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _by_lanes(directions):  # type: ignore[no-untyped-def]
    """Directions (d,3,LANES) from those (k,d,3) of up to LANES points."""
    lanes = np.zeros((directions.shape[1], 3, LANES))
    for n in range(len(directions)):
        for a in range(directions.shape[1]):
            for i in range(3):
                lanes[a, i, n] = directions[n, a, i]
    return lanes


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _share(velocity, along, lanes, plus, minus, found):  # type: ignore[no-untyped-def]
    """Give the velocity along the directions to the two rings of a segment (negative: none)."""
    for a in range(len(along)):
        for n in range(lanes):
            w = velocity[n] * along[a, 0, n]
            w += velocity[LANES + n] * along[a, 1, n]
            w += velocity[2 * LANES + n] * along[a, 2, n]
            if plus >= 0:
                found[a, plus, n] += w
            if minus >= 0:
                found[a, minus, n] -= w
    velocity[:] = 0.0


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FASTMATH)
def _add_strips(table, rows, columns, points, influence):  # type: ignore[no-untyped-def]
    end = (rows - 1) * columns
    for number in prange((len(points) + LANES - 1) // LANES):
        low = number * LANES
        high = min(low + LANES, len(points))
        block = make_block(2, table)
        origin, lanes = enter(points[low:high], block), whole_vectors(high - low)
        part = influence[low:high]
        for j in range(columns):
            add_tile(table, j, columns, rows, 1, (False, True), origin, lanes, block)
            _add(block, part, j - 1, 1.0, j, -1.0)
            if j < columns - 1:
                add_tile(table, j, 1, 1, 2, (True, False), origin, lanes, block)
                _add(block, part, j, 1.0, -1, 0.0)
                add_tile(table, end + j, 1, 1, 2, (True, False), origin, lanes, block)
                _add(block, part, j, -1.0, -1, 0.0)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _add(block, influence, one, sign, other, other_sign):  # type: ignore[no-untyped-def]
    """Add the block's velocity, times the signs, to two strips (k,n,3) where there are such."""
    for n in range(len(influence)):
        for i in range(3):
            u = block.velocity[i * LANES + n]
            if one >= 0:
                influence[n, one, i] += sign * u
            if 0 <= other < influence.shape[1]:
                influence[n, other, i] += other_sign * u
    block.velocity[:] = 0.0
