"""Inertia, weight and applied loads at the nodes, in body axes, with their tangents.

The inertia wrench of a frame with mass matrix M and body twist v is ``M v' - ad(v)^T M v``
(Euler's equations on SE(3)); beams and rigid bodies alike are mass matrices at nodes.
"""

from __future__ import annotations

from numba import njit

from galerna.contract import Array

from .blocks import FAST, apply, apply_transposed, multiply3, multiply6, multiply6_transposed
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

    ``mass`` (n,6,6); ``weight`` (n,4) the mass kg that gravity (3,) m/s2 acts on and its
    first moment kg m in body axes; ``dead`` (n,6) in global and ``follower`` (n,6) in body
    axes. The two tangents (n,6,6) are the derivatives of the twist v (n,6) and of its rate
    over the nodes' variations.
    """
    for i in range(len(mass)):
        M = mass[i]
        momentum = apply(M, v[i])
        bracket = ad(v[i])
        down = apply_transposed(R[i], gravity)
        moment = weight[i, 1:]
        force = apply_transposed(R[i], dead[i, :3])
        torque = apply_transposed(R[i], dead[i, 3:])
        r = apply(M, v_rate[i]) - apply_transposed(bracket, momentum) - follower[i]
        r[:3] -= weight[i, 0] * down + force
        r[3:] -= apply(hat(moment), down) + torque
        residual[i] = r
        gyroscopic = multiply6_transposed(bracket, M) + bracket_by_twist(momentum, True)
        S = multiply6(M, acceleration_tangent[i]) - multiply6(gyroscopic, velocity_tangent[i])
        S[:3, 3:] -= hat(weight[i, 0] * down + force)
        S[3:, 3:] -= multiply3(hat(moment), hat(down)) + hat(torque)
        tangent[i] = S
