"""Lines between points in space: forces on both ends with their stiffness, in kernels."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit

from galerna.contract import Array

from .catenary import solve

NEAR = 1e-9  #: of a line's length: a horizontal distance that has no direction


@njit(cache=True, error_model="numpy")
def pull(first: Array, second: Array, line: Array, friction: float, out: Array) -> None:
    """Forces of a line on its ends ``first`` and ``second`` (3,) m, and their stiffness.

    ``line`` (3,): unstretched length m, EA N and weight N/m. ``friction`` is the seabed's if the
    lower end lies on it, below 0 if not. ``out`` (5,3): force on the first end, on the second
    one, and minus the derivative of the latter over its place (3,3), with both tensions and the
    length on the seabed left in ``out[5, :]`` if it has six rows.
    """
    lower, upper, sign = first, second, 1.0
    if first[2] > second[2]:
        lower, upper, sign = second, first, -1.0
    arm_x, arm_y, z = upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]
    x = sqrt(arm_x * arm_x + arm_y * arm_y)
    found = np.empty(8)
    solve(x, z, line[0], line[1], line[2], friction, found)
    H, V, low_H, low_V, grounded = found[0], found[1], found[2], found[3], found[4]
    c, s, across = 1.0, 0.0, found[5]
    if x > NEAR * line[0]:
        c, s = arm_x / x, arm_y / x
        across = H / x
    up, down = (1, 0) if sign > 0.0 else (0, 1)
    out[up, 0], out[up, 1], out[up, 2] = -H * c, -H * s, -V
    out[down, 0], out[down, 1], out[down, 2] = low_H * c, low_H * s, low_V
    along, lift, steep = found[5], found[6], found[7]
    out[2, 0] = along * c * c + across * s * s
    out[2, 1] = out[3, 0] = (along - across) * c * s
    out[3, 1] = along * s * s + across * c * c
    out[2, 2] = out[4, 0] = lift * c
    out[3, 2] = out[4, 1] = lift * s
    out[4, 2] = steep
    out[5, up] = sqrt(H * H + V * V)
    out[5, down] = sqrt(low_H * low_H + low_V * low_V)
    out[5, 2] = grounded


@njit(cache=True, error_model="numpy")
def pull_all(points: Array, ends: Array, lines: Array, friction: Array, out: Array) -> None:
    """All m lines between n ``points`` (n,3); ``ends`` (m,2), ``lines`` (m,3), ``out`` (m,6,3)."""
    for i in range(len(ends)):
        pull(points[ends[i, 0]], points[ends[i, 1]], lines[i], friction[i], out[i])


@njit(cache=True, error_model="numpy")
def on_body(
    arms: Array, nodes: Array, ends: Array, answer: Array, force: Array, moment: Array, K: Array
) -> None:
    """Sum of the lines' pull on a body: force, moment about its frame and stiffness (6,6).

    ``arms`` (n,3) m reach from the frame to each point in global axes; ``nodes`` (n,) is True
    for the body's own points.
    """
    for i in range(len(ends)):
        for side in range(2):
            node = ends[i, side]
            if not nodes[node]:
                continue
            r, f, k = arms[node], answer[i, side], answer[i, 2:5]
            cross = np.zeros((3, 3))
            cross[0, 1], cross[0, 2], cross[1, 2] = -r[2], r[1], -r[0]
            cross[1, 0], cross[2, 0], cross[2, 1] = r[2], -r[1], r[0]
            weighed = np.zeros((3, 3))
            for a in range(3):
                force[a] += f[a]
                for b in range(3):
                    moment[a] += cross[a, b] * f[b]
                    K[a, b] += k[a, b]
                    for d in range(3):
                        weighed[a, b] -= k[a, d] * cross[d, b]
            for a in range(3):
                for b in range(3):
                    K[a, 3 + b] += weighed[a, b]
                    K[3 + b, a] += weighed[a, b]
                    for d in range(3):
                        K[3 + a, 3 + b] += cross[a, d] * weighed[d, b]
            # the arm turns with the body: minus the derivative of r x F over the turn is -F~ r~
            for a in range(3):
                for b in range(3):
                    K[3 + a, 3 + b] -= f[b] * r[a] - (f[0] * r[0] + f[1] * r[1] + f[2] * r[2]) * (
                        a == b
                    )
