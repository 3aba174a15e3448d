"""The relative motion of two frames: the one element behind beams, springs and joints.

Two frames A and B, each fixed to a node, have the relative motion ``d`` (6,) with
``A exp(d) = B``. A beam element or a spring answers it with a wrench, a joint locks some of
its components. Everything depends on ``d`` alone, so a rigid motion of both costs nothing
and the forces on A and B balance to rounding.
Source: Sonneville, Cardona and Bruls, Comput. Methods Appl. Mech. Eng. 268 (2014) 451.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.contract import Array

from .blocks import (
    FAST,
    apply,
    apply_transposed,
    multiply3,
    multiply3_transposed,
    multiply6,
    multiply6_transposed,
    multiply_6_6_12,
    multiply_12_6_6_transposed,
    multiply_12_6_12,
    multiply_12_6_12_transposed,
)
from .frames import adjoint, bracket_by_twist, inverse_tangent_slope, inverse_tangents, log_se3

Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]


@dataclass(eq=False, slots=True)
class Pairs:
    """All pairs of a system, m of them.

    ``ends`` (m,2) nodes, 0 the ground; ``offset_rotation`` (m,2,3,3) and
    ``offset_position`` (m,2,3) place the frames A and B in their nodes' axes where
    ``has_offset`` (m,). The wrench is ``stiffness @ (d - reference) + damping @ d' +
    preload`` with (m,6,6) and (m,6) arrays in the axes of d; ``locked`` (m,6) marks the
    components of d that a joint holds at zero.
    """

    ends: Integers
    has_offset: Flags
    offset_rotation: Array
    offset_position: Array
    reference: Array
    stiffness: Array
    damping: Array
    damped: Flags
    preload: Array
    locked: Flags

    def __len__(self) -> int:
        return len(self.ends)


@dataclass(eq=False, slots=True)
class PairAnswer:
    """What the pairs give: relative motion, its rate and wrench (m,6), node wrenches and tangents.

    ``node_wrench`` (m,12) and ``tangent`` (m,12,12) belong to (A, B) in body axes,
    ``direction`` (m,6,12) is the derivative of d over the variations of the two nodes.
    ``carried`` (m,6) is the wrench that turns with the nodes in the tangent.
    """

    motion: Array
    rate: Array
    wrench: Array
    node_wrench: Array
    direction: Array
    tangent: Array
    carried: Array


@njit(cache=True, error_model="numpy")
def _placed(node: int, x: Array, R: Array, offset_x: Array, offset_R: Array) -> tuple[Array, Array]:
    """Position and rotation of a frame that is fixed to a node."""
    return x[node] + apply(R[node], offset_x), multiply3(R[node], offset_R)


@njit(cache=True, error_model="numpy")
def _to_offset(R: Array, x: Array) -> Array:
    """The matrix (6,6) that carries a node's twist to a frame at R, x in its axes."""
    return adjoint(R.T.copy(), -apply_transposed(R, x))


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _answer_one(
    first: int,
    second: int,
    has_offset: bool,
    offset_R: Array,
    offset_x: Array,
    reference: Array,
    stiffness: Array,
    damping: Array,
    damped: bool,
    preload: Array,
    carried: Array,
    x: Array,
    R: Array,
    v: Array,
    velocity_tangent: Array,
    motion: Array,
    rate: Array,
    wrench: Array,
    node_wrench: Array,
    direction: Array,
    tangent: Array,
) -> None:
    """One pair; fills the last six arguments."""
    va, vb = v[first], v[second]
    if has_offset:
        xa, Ra = _placed(first, x, R, offset_x[0], offset_R[0])
        xb, Rb = _placed(second, x, R, offset_x[1], offset_R[1])
        to_a = _to_offset(offset_R[0], offset_x[0])
        to_b = _to_offset(offset_R[1], offset_x[1])
        va, vb = apply(to_a, va), apply(to_b, vb)
    else:
        xa, Ra, xb, Rb = x[first], R[first], x[second], R[second]
        to_a = to_b = np.empty((0, 0))
    d = log_se3(multiply3_transposed(Ra, Rb), apply_transposed(Ra, xb - xa))
    ahead, behind = inverse_tangents(d)
    d_rate = apply(ahead, vb) - apply(behind, va)
    stress = preload + apply(stiffness, d - reference)
    if damped:
        stress += apply(damping, d_rate)
    if np.isnan(carried[0]):
        carried[:] = stress
    slope = inverse_tangent_slope(d, carried, True)
    half = 0.5 * bracket_by_twist(carried, True)
    P = np.empty((6, 12))
    G = np.empty((12, 6))
    if has_offset:
        P[:, :6] = -multiply6(behind, to_a)
        P[:, 6:] = multiply6(ahead, to_b)
        G[:6] = -multiply6_transposed(to_a, slope - half)
        G[6:] = multiply6_transposed(to_b, slope + half)
    else:
        P[:, :6] = -behind
        P[:, 6:] = ahead
        G[:6] = half - slope
        G[6:] = slope + half
    law = stiffness
    if damped:
        by_motion = inverse_tangent_slope(d, vb - va, False)
        by_motion += 0.5 * bracket_by_twist(va + vb, False)
        law = stiffness + multiply6(damping, by_motion)
    G += multiply_12_6_6_transposed(P, law)
    S = multiply_12_6_12(G, P)
    if damped:
        moving = np.empty((6, 12))
        moving[:, :6] = multiply6(P[:, :6], velocity_tangent[first])
        moving[:, 6:] = multiply6(P[:, 6:], velocity_tangent[second])
        S += multiply_12_6_12_transposed(P, multiply_6_6_12(damping, moving))
    motion[:] = d
    rate[:] = d_rate
    wrench[:] = stress
    node_wrench[:] = apply_transposed(P, stress)
    direction[:] = P
    tangent[:] = S


@njit(cache=True, error_model="numpy")
def _answer_all(
    ends: Integers,
    has_offset: Flags,
    offset_R: Array,
    offset_x: Array,
    reference: Array,
    stiffness: Array,
    damping: Array,
    damped: Flags,
    preload: Array,
    carried: Array,
    x: Array,
    R: Array,
    v: Array,
    velocity_tangent: Array,
    motion: Array,
    rate: Array,
    wrench: Array,
    node_wrench: Array,
    direction: Array,
    tangent: Array,
) -> None:
    for e in range(len(ends)):
        _answer_one(
            ends[e, 0], ends[e, 1], has_offset[e], offset_R[e], offset_x[e], reference[e],
            stiffness[e], damping[e], damped[e], preload[e], carried[e], x, R, v, velocity_tangent,
            motion[e], rate[e], wrench[e], node_wrench[e], direction[e], tangent[e],
        )  # fmt: skip


def empty_answer(m: int) -> PairAnswer:
    """Room for the answer of m pairs."""
    return PairAnswer(
        np.zeros((m, 6)), np.zeros((m, 6)), np.zeros((m, 6)),
        np.zeros((m, 12)), np.zeros((m, 6, 12)), np.zeros((m, 12, 12)), np.zeros((m, 6)),
    )  # fmt: skip


def answer(
    pairs: Pairs,
    multiplier: Array,
    x: Array,
    R: Array,
    v: Array,
    velocity_tangent: Array,
    room: PairAnswer,
    carried: Array | None = None,
) -> PairAnswer:
    """Wrenches and tangents of all pairs, written into ``room``.

    ``multiplier`` (m,6) is what the joints hold in their locked components; x (n,3), R
    (n,3,3) and v (n,6) are the nodes' positions, rotations and body twists, and
    ``velocity_tangent`` (n,6,6) the derivative of v over the nodes' variations.
    ``carried`` (m,6), where given, replaces the pairs' own wrenches in the tangent.
    """
    room.carried[:] = np.nan if carried is None else carried
    _answer_all(
        pairs.ends, pairs.has_offset, pairs.offset_rotation, pairs.offset_position,
        pairs.reference, pairs.stiffness, pairs.damping, pairs.damped,
        pairs.preload + multiplier, room.carried, x, R, v, velocity_tangent,
        room.motion, room.rate, room.wrench, room.node_wrench, room.direction, room.tangent,
    )  # fmt: skip
    return room


def carried_on(pairs: Pairs, before: PairAnswer, variation: Array, multiplier: Array) -> Array:
    """The wrenches (m,6) that Newton's linear equations expect after a correction.

    Used in the next tangent in place of the wrenches of the overstretched trial shape, they
    let slender beams take large steps. Source: Magisano, Leonetti and Garcea, Comput.
    Methods Appl. Mech. Eng. 313 (2017) 986, where the iteration is derived from stresses
    as unknowns of their own.
    """
    moved = np.einsum("mij,mj->mi", before.direction, variation[pairs.ends].reshape(-1, 12))
    return before.wrench + np.einsum("mij,mj->mi", pairs.stiffness, moved) + multiplier
