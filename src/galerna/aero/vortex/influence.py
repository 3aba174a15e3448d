"""Velocity of rings of unit circulation: what the boundary condition is made of."""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from galerna.aero.vortex.biot_savart import enter
from galerna.aero.vortex.segments import (
    LANES,
    NUMBERS,
    add_tile,
    make_block,
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
    vertices, points, normals = (
        np.ascontiguousarray(a, float) for a in (vertices, points, normals)
    )
    core = np.ascontiguousarray(np.broadcast_to(core_radius, vertices.shape[:2]), float)
    table = _unit_table(vertices, core)
    rows, columns = vertices.shape[0] - 1, vertices.shape[1] - 1
    influence = np.zeros((len(points), rows * columns))
    _add_rings(table, rows, columns, points, normals, influence)
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
def _add_rings(table, rows, columns, points, normals, influence):  # type: ignore[no-untyped-def]
    for number in prange((len(points) + LANES - 1) // LANES):
        low = number * LANES
        high = min(low + LANES, len(points))
        block = make_block(2, table)
        origin, lanes = enter(points[low:high], block), whole_vectors(high - low)
        for i in range(rows + 1):
            for j in range(columns + 1):
                k, ring = i * (columns + 1) + j, i * columns + j
                if j < columns:
                    add_tile(table, k, 1, 1, 2, (True, False), origin, lanes, block)
                    below, above = ring if i < rows else -1, ring - columns
                    _share(block, normals[low:high], below, above, influence[low:high])
                if i < rows:
                    add_tile(table, k, columns + 1, 2, 1, (False, True), origin, lanes, block)
                    left, right = ring - 1 if j > 0 else -1, ring if j < columns else -1
                    _share(block, normals[low:high], left, right, influence[low:high])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _share(block, normals, plus, minus, influence):  # type: ignore[no-untyped-def]
    """Give the velocity along the normals to the two rings of a segment (negative: none)."""
    velocity = block.velocity
    for n in range(len(normals)):
        w = velocity[n] * normals[n, 0]
        w += velocity[LANES + n] * normals[n, 1]
        w += velocity[2 * LANES + n] * normals[n, 2]
        if plus >= 0:
            influence[n, plus] += w
        if minus >= 0:
            influence[n, minus] -= w
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
