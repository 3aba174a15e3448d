"""Inertia, weight and applied loads at the nodes, in body axes, with their tangents.

The inertia wrench of a frame with mass matrix M and body twist v is ``M v' - ad(v)^T M v``
(Euler's equations on SE(3)); beams and rigid bodies alike are mass matrices at nodes.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from galerna.contract import Array

from .blocks import FAST, apply_transposed, multiply3, multiply6, multiply6_transposed
from .frames import ad, bracket_by_twist, hat


@njit(cache=True, error_model="numpy", fastmath=FAST)
def node_balance(
    mass: Array,
    weight: Array,
    gravity: Array,
    dead: Array,
    follower: Array,
    R: Array,
    v: Array,
    v_rate: Array,
    velocity_tangent: Array,
    acceleration_tangent: Array,
    residual: Array,
    tangent: Array,
) -> None:
    """Inertia minus weight and loads of all nodes: ``residual`` (n,6) and ``tangent`` (n,6,6).

    Where ``tangent`` (0,6,6) has no room, it is left out.

    ``mass`` (n,6,6); ``weight`` (n,4) the mass kg that gravity (3,) m/s2 acts on and its
    first moment kg m in body axes; ``dead`` (n,6) in global and ``follower`` (n,6) in body
    axes. The two tangents (n,6,6) are the derivatives of the twist v (n,6) and of its rate
    over the nodes' variations.
    """
    momentum, down = np.empty(6), np.empty(3)
    for i in range(len(mass)):
        M, r, moment = mass[i], residual[i], weight[i, 1:]
        for k in range(6):
            momentum[k], r[k] = 0.0, -follower[i, k]
            for j in range(6):
                momentum[k] += M[k, j] * v[i, j]
                r[k] += M[k, j] * v_rate[i, j]
        for k in range(3):
            down[k] = 0.0
            for j in range(3):
                down[k] += R[i, j, k] * gravity[j]
                r[k] -= R[i, j, k] * dead[i, j]
                r[3 + k] -= R[i, j, k] * dead[i, 3 + j]
        for k in range(3):
            r[k] -= weight[i, 0] * down[k]
            m, n = (k + 1) % 3, (k + 2) % 3
            r[3 + k] -= moment[m] * down[n] - moment[n] * down[m]
            r[k] += v[i, 3 + m] * momentum[n] - v[i, 3 + n] * momentum[m]
            r[3 + k] += v[i, m] * momentum[n] - v[i, n] * momentum[m]
            r[3 + k] += v[i, 3 + m] * momentum[3 + n] - v[i, 3 + n] * momentum[3 + m]
        if len(tangent) == 0:
            continue
        bracket = ad(v[i])
        force = apply_transposed(R[i], dead[i, :3])
        torque = apply_transposed(R[i], dead[i, 3:])
        gyroscopic = multiply6_transposed(bracket, M) + bracket_by_twist(momentum, True)
        S = multiply6(M, acceleration_tangent[i]) - multiply6(gyroscopic, velocity_tangent[i])
        S[:3, 3:] -= hat(weight[i, 0] * down + force)
        S[3:, 3:] -= multiply3(hat(moment), hat(down)) + hat(torque)
        tangent[i] = S
