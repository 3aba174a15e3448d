"""Lines between points in space: forces on the points and their stiffness, in kernels."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.contract import Array

from .catenary import CLOSEST, FAST, HORIZONTAL_A, HORIZONTAL_B, VERTICAL_A, VERTICAL_B, solve

Integers = NDArray[np.int64]

#: columns of a line's figures: unstretched m, N/m in water, EA N, friction of the seabed
LENGTH, WEIGHT, STIFFNESS, FRICTION = range(4)
#: columns of a point's figures: kg times gravity N, buoyancy N, radius m, seabed's stiffness N/m
OWN_WEIGHT, BUOYANCY, RADIUS, BED = range(4)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def line_between(
    A: Array, B: Array, figures: Array, depth: float, found: Array, slopes: Array, F: Array,
    K: Array,
) -> None:  # fmt: skip
    """Forces ``F`` (2,3) of a line on its ends, and ``K`` (6,6), minus their slope over both.

    ``found`` (5,) and ``slopes`` (4,3) are those of ``catenary.solve``; eq. (12).
    """
    length = figures[LENGTH]
    away, across = B[0] - A[0], B[1] - A[1]
    x = np.sqrt(away * away + across * across)
    solve(
        x, A[2] + depth, B[2] + depth, length, figures[WEIGHT], figures[STIFFNESS],
        figures[FRICTION], True, found, slopes,
    )  # fmt: skip
    close = x < CLOSEST * length
    x = max(x, CLOSEST * length)
    n = (away / x, across / x)
    for end in range(2):
        sign = 1.0 - 2.0 * end
        h, v = 2 * end, 2 * end + 1
        round_ = found[h] / x
        along = 0.0 if close else slopes[h, 0] - round_
        for i in range(2):
            F[end, i] = sign * found[h] * n[i]
            for j in range(2):
                k = along * n[i] * n[j] + (round_ if i == j else 0.0)
                K[3 * end + i, j], K[3 * end + i, 3 + j] = sign * k, -sign * k
            K[3 * end + i, 2] = -sign * n[i] * slopes[h, 1]
            K[3 * end + i, 5] = -sign * n[i] * slopes[h, 2]
            K[3 * end + 2, i] = sign * slopes[v, 0] * n[i]
            K[3 * end + 2, 3 + i] = -sign * slopes[v, 0] * n[i]
        F[end, 2] = sign * found[v]
        K[3 * end + 2, 2], K[3 * end + 2, 5] = -sign * slopes[v, 1], -sign * slopes[v, 2]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def assemble(
    points: Array, ends: Integers, figures: Array, depth: float, found: Array, F: Array, K: Array
) -> None:
    """All m lines between n ``points`` (n,3): forces ``F`` (n,3) and stiffness ``K`` (3n,3n).

    ``found`` (m,5) keeps what each line is.
    """
    F[:], K[:] = 0.0, 0.0
    slopes, f, k = np.empty((4, 3)), np.empty((2, 3)), np.empty((6, 6))
    for line in range(len(ends)):
        A, B = ends[line]
        line_between(points[A], points[B], figures[line], depth, found[line], slopes, f, k)
        for end, node in enumerate((A, B)):
            for i in range(3):
                F[node, i] += f[end, i]
                for j in range(3):
                    K[3 * node + i, 3 * A + j] += k[3 * end + i, j]
                    K[3 * node + i, 3 * B + j] += k[3 * end + i, 3 + j]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def add_own(z: float, figures: Array, depth: float) -> tuple[float, float]:
    """Upward force N on a connection but for its lines', and its stiffness N/m.

    A buoy is a ball that loses its buoyancy straight over its diameter at the still water; the
    seabed is a spring.
    """
    force, stiffness = -figures[OWN_WEIGHT], 0.0
    if figures[BUOYANCY] > 0.0:
        wet = 0.5 - 0.5 * z / figures[RADIUS]
        force += figures[BUOYANCY] * min(max(wet, 0.0), 1.0)
        if 0.0 < wet < 1.0:
            stiffness += 0.5 * figures[BUOYANCY] / figures[RADIUS]
    if z < -depth:
        force -= figures[BED] * (z + depth)
        stiffness += figures[BED]
    return force, stiffness


@njit(cache=True, error_model="numpy", fastmath=FAST)
def on_body(
    points: Array, vessel: Integers, F: Array, K: Array, origin: Array,
    force: Array, moment: Array, stiffness: Array,
) -> None:  # fmt: skip
    """Add what ``vessel`` (k,) of the points put on a body: about ``origin`` (3,) m, eq. (13).

    ``F`` (n,3) N and ``K`` (3n,3n) N/m are the points' own; ``force`` (3,), ``moment`` (3,) and
    ``stiffness`` (6,6) the body's.
    """
    arms = np.empty((len(vessel), 3, 3))
    for i in range(len(vessel)):
        node = vessel[i]
        r, f = points[node] - origin, F[node]
        _hat(r, arms[i])
        for m in range(3):
            n, o = (m + 1) % 3, (m + 2) % 3
            force[m] += f[m]
            moment[m] += r[n] * f[o] - r[o] * f[n]
            for k in range(3):
                stiffness[3 + m, 3 + k] += r[m] * -f[k]
            stiffness[3 + m, 3 + m] += r[0] * f[0] + r[1] * f[1] + r[2] * f[2]
    for i in range(len(vessel)):
        for j in range(len(vessel)):
            block = K[3 * vessel[i] : 3 * vessel[i] + 3, 3 * vessel[j] : 3 * vessel[j] + 3]
            if np.any(block != 0.0):
                _add_block(block, arms[i], arms[j], stiffness)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def place(points: Array, vessel: Integers, arms: Array, position: Array, rotation: Array) -> None:
    """Move ``vessel`` (k,) of the points to ``arms`` (k,3) of a frame."""
    for i in range(len(vessel)):
        for j in range(3):
            turned = rotation[j, 0] * arms[i, 0] + rotation[j, 1] * arms[i, 1]
            points[vessel[i], j] = position[j] + turned + rotation[j, 2] * arms[i, 2]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def turn_back(
    spring: float, ahead: Array, rotation: Array, moment: Array, stiffness: Array
) -> None:
    """Add a spring N m/rad about z against the heading of ``ahead`` (3,) in a frame; eq. (15)."""
    x, y, z = 0.0, 0.0, 0.0
    for j in range(3):
        x += rotation[0, j] * ahead[j]
        y += rotation[1, j] * ahead[j]
        z += rotation[2, j] * ahead[j]
    level = x * x + y * y
    moment[2] -= spring * np.arctan2(y, x)
    stiffness[5, 3] -= spring * x * z / level
    stiffness[5, 4] -= spring * y * z / level
    stiffness[5, 5] += spring


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _hat(r: Array, A: Array) -> None:
    A[:] = 0.0
    A[0, 1], A[0, 2], A[1, 2] = -r[2], r[1], -r[0]
    A[1, 0], A[2, 0], A[2, 1] = r[2], -r[1], r[0]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_block(k: Array, left: Array, right: Array, stiffness: Array) -> None:
    """Add [k, -k right; left k, -left k right] to ``stiffness`` (6,6)."""
    for i in range(3):
        for j in range(3):
            turn = -(k[i, 0] * right[0, j] + k[i, 1] * right[1, j] + k[i, 2] * right[2, j])
            stiffness[i, j] += k[i, j]
            stiffness[i, 3 + j] += turn
            for m in range(3):
                stiffness[3 + m, j] += left[m, i] * k[i, j]
                stiffness[3 + m, 3 + j] += left[m, i] * turn


def tensions(found: Array) -> tuple[Array, Array]:
    """Tensions N (m,) at A and at B."""
    at_a = np.hypot(found[:, HORIZONTAL_A], found[:, VERTICAL_A])
    return at_a, np.hypot(found[:, HORIZONTAL_B], found[:, VERTICAL_B])
