"""The velocity of lattices of straight vortex segments at a few points at once.

A segment from a to b of circulation G, seen from x with r1 = x - a, r2 = x - b and l = b - a,
induces (Katz and Plotkin, Low-Speed Aerodynamics, 2001, eq. 2.68)

    G/(4 pi) (r1 x r2) (1/|r1| + 1/|r2|) / (|r1||r2| + r1.r2)  *  d^2 / sqrt(d^4 + r_c^4)    (1)

with d = |r1 x r2|/|l| the distance from its line; the last factor is the core of Vatistas,
Kozel and Mih (1991), n = 2, close to the swirl of a Lamb-Oseen vortex. With e = l/|l| and
s = |r1| + |r2| it is evaluated as

    G |l|/(2 pi) c (1/|r1| + 1/|r2|) d^2 / sqrt(D^2 (d^4 + r_c^4)),
    c = e x x - e x a,   d^2 = c.c,   D = s^2 - |l|^2 = 2 (|r1||r2| + r1.r2)                 (2)

so a vertex costs one reciprocal root and a segment another, and no division. The points are
the lanes of vectors: a vertex or a segment is read once for all of them. Neighbouring rings share
vertices and segments, and each is evaluated once, with the difference of circulations.

Nothing is infinite: a segment has a core of at least 1e-8 (single precision: 1e-3) of its
length, and one that ends within 1e-9 m (1e-5 m) of a point leaves its end out. In single
precision coordinates count from an origin near the points and must stay within 20 km of it.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit, types
from numba.extending import overload

from galerna.aero.vortex.simd import (
    FASTMATH,
    aligned_zeros,
    inverse_square_root,
    prefer_wide_vectors,
)
from galerna.contract import Array

LANES = 64  # points of a block: distances from two rows of vertices then stay in the cache
NUMBERS = 15  # of a vertex: itself, the segment from its left neighbour, and that from upstream
_four = np.float32(4.0)
WIDEST = 9  # vertices across a tile: small ones are soon far enough for single precision


class Block(NamedTuple):
    """Points (3 LANES,) m and their velocity (3 LANES,) m/s, x before y before z.

    ``distances`` (2 columns, 2 LANES): from two rows of vertices, m, and their reciprocals.
    """

    points: Array
    velocity: Array
    distances: Array


@njit(cache=True)
def make_block(columns, like):  # type: ignore[no-untyped-def]
    """A block for tiles up to so many vertices across, in the precision of the array ``like``."""
    return Block(
        aligned_zeros(3 * LANES, like),
        aligned_zeros(3 * LANES, like),
        aligned_zeros(4 * columns * LANES, like).reshape(2 * columns, 2 * LANES),
    )


@njit(cache=True)
def whole_vectors(points):  # type: ignore[no-untyped-def]
    """Lanes that hold so many points, in whole vectors of any processor."""
    return (points + 15) // 16 * 16


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def set_segment(numbers, start, end, core_squared, circulation):  # type: ignore[no-untyped-def]
    """Numbers (6,) of a segment: direction, length squared, core to the fourth, strength."""
    x, y, z = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    length_squared = x * x + y * y + z * z
    length = sqrt(length_squared)
    inverse = 1.0 / length if length > 0.0 else 0.0
    numbers[0], numbers[1], numbers[2] = x * inverse, y * inverse, z * inverse
    numbers[3], numbers[4] = length_squared, core_squared * core_squared
    numbers[5] = circulation * length / (2.0 * pi)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_tile(table, first, stride, rows, columns, borders, origin, lanes, block):  # type: ignore[no-untyped-def]
    """Add to the block's velocity what a tile of vertices (rows,columns) of a table induces.

    ``table`` (k,NUMBERS): position (3,) m of vertex (i,j), and by `set_segment` the segments from
    (i,j-1) and from (i-1,j) to it; it is row ``first`` + i ``stride`` + j. ``borders``: whether
    the segments along the first row and along the first column are the tile's own, or
    another's. The block's points count from ``origin`` (3,) m; the first ``lanes`` of
    them are served, see `whole_vectors`.
    """
    for i in range(rows):
        now, before = (i % 2) * columns, ((i + 1) % 2) * columns
        for j in range(columns):
            k = first + i * stride + j
            place = see_vertex(table[k], origin, now + j, lanes, block)
            if j > 0 and (i > 0 or borders[0]):
                add_segment(table[k, 3:9], place, now + j - 1, now + j, lanes, block)
            if i > 0 and (j > 0 or borders[1]):
                add_segment(table[k, 9:15], place, before + j, now + j, lanes, block)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def see_vertex(numbers, origin, slot, lanes, block):  # type: ignore[no-untyped-def]
    """Put the points' distances from a vertex into a slot; returns its place from the origin."""
    x, y, z = numbers[0] - origin[0], numbers[1] - origin[1], numbers[2] - origin[2]
    number = block.points.dtype.type
    _distances(block.points, block.distances, slot, number(x), number(y), number(z), lanes)
    return x, y, z


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_segment(numbers, place, start, end, lanes, block):  # type: ignore[no-untyped-def]
    """Add what a segment, see `set_segment`, induces that ends at a place (3) m.

    ``start`` and ``end`` are the slots that hold the distances from its ends.
    """
    if numbers[5] == 0.0:
        return
    x, y, z = place
    ex, ey, ez = numbers[0], numbers[1], numbers[2]
    number = block.points.dtype.type
    _velocity(
        block.points, block.distances, block.velocity, start, end,
        number(ex), number(ey), number(ez),
        number(ey * z - ez * y), number(ez * x - ex * z), number(ex * y - ey * x),
        number(numbers[3]), number(numbers[4]), number(numbers[5]), lanes,
    )  # fmt: skip


def _fraction(d2: float, r1: float, r2: float, l2: float, least: float) -> tuple[float, float]:
    """Top and bottom of d^2/D."""
    raise NotImplementedError("for compiled code")


@overload(_fraction, jit_options={"fastmath": FASTMATH, "error_model": "numpy"})
def _fraction_of(d2, r1, r2, l2, least):  # type: ignore[no-untyped-def]
    """Beside a segment D has lost its digits; d^2/D = E/(4 |l|^2), E = |l|^2 - (|r1|-|r2|)^2.

    Double precision has digits to lose.
    """
    if d2 == types.float64:
        return lambda d2, r1, r2, l2, least: (d2, max((r1 + r2) * (r1 + r2) - l2, least))

    def single(d2, r1, r2, l2, least):  # type: ignore[no-untyped-def]
        D, E = max((r1 + r2) * (r1 + r2) - l2, least), l2 - (r1 - r2) * (r1 - r2)
        beside = D < E
        return (E if beside else d2), (_four * l2 if beside else D)

    return single


def _limits(like: Array) -> tuple[float, float, float, float]:
    """Least distance squared, (core/length)^4 and D/length^2, and a number that vanishes."""
    raise NotImplementedError("for compiled code")


@overload(_limits)
def _limits_of(like):  # type: ignore[no-untyped-def]
    number = np.float32 if like.dtype == types.float32 else np.float64
    least = (1e-10, 1e-12, 1e-6, 1e-36) if number is np.float32 else (1e-18, 1e-32, 1e-14, 1e-300)
    distance, core, beside, vanishing = (number(x) for x in least)
    return lambda like: (distance, core, beside, vanishing)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _distances(points, distances, vertex, vx, vy, vz, lanes):  # type: ignore[no-untyped-def]
    prefer_wide_vectors()
    least, _, _, vanishing = _limits(points)
    nothing = vanishing - vanishing
    for n in range(lanes):
        x, y, z = points[n] - vx, points[LANES + n] - vy, points[2 * LANES + n] - vz
        square = x * x + y * y + z * z
        root = inverse_square_root(square + vanishing)
        inverse = root if square > least else nothing
        distances[vertex, n] = square * inverse
        distances[vertex, LANES + n] = inverse


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _velocity(  # type: ignore[no-untyped-def]
    points, distances, velocity, start, end, ex, ey, ez, mx, my, mz, l2, core, strength, lanes
):
    """Equation (2) for one segment; m = e x a."""
    prefer_wide_vectors()
    _, thinnest, beside, vanishing = _limits(points)
    core = max(core, thinnest * l2 * l2)
    least = beside * l2
    for n in range(lanes):
        x, y, z = points[n], points[LANES + n], points[2 * LANES + n]
        cx, cy, cz = ey * z - ez * y - mx, ez * x - ex * z - my, ex * y - ey * x - mz
        d2 = cx * cx + cy * cy + cz * cz
        top, D = _fraction(d2, distances[start, n], distances[end, n], l2, least)
        inverse = distances[start, LANES + n] + distances[end, LANES + n]
        root = inverse_square_root(D * D * (d2 * d2 + core) + vanishing)
        f = strength * inverse * top * root
        velocity[n] += f * cx
        velocity[LANES + n] += f * cy
        velocity[2 * LANES + n] += f * cz
