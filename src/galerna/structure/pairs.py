"""The relative motion of two frames: the one element behind beams, springs and joints.

Two frames A and B, each fixed to a node, have the relative motion ``d`` (6,) with
``A exp(d) = B``. A beam element or a spring answers it with a wrench, a joint locks some of
its components. Everything depends on ``d`` alone, so a rigid motion of both costs nothing
and the forces on A and B balance to rounding.
Source: Sonneville, Cardona and Bruls, Comput. Methods Appl. Mech. Eng. 268 (2014) 451.
"""

from __future__ import annotations

from typing import NamedTuple

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
    multiply_12_6_6_transposed,
    multiply_12_6_12,
)
from .frames import adjoint, bracket_by_twist, inverse_tangent_slope, inverse_tangents, log_se3

Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Pairs(NamedTuple):
    """All pairs of a system, m of them.

    ``ends`` (m,2) nodes, 0 the ground; ``offset_rotation`` (m,2,3,3) and
    ``offset_position`` (m,2,3) place the frames A and B in their nodes' axes where
    ``has_offset`` (m,). The wrench is ``stiffness @ (d - reference) + damping @ d' +
    preload`` with (m,6,6) and (m,6) arrays in the axes of d; ``locked`` (m,6) marks the
    components of d that a joint holds at zero. ``drive_twist`` (m,6) is that of A in its own
    axes against its node; ``inertance`` (m,) kg m2 resists the rate of the relative spin about z.
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
    drive_twist: Array
    inertance: Array


class PairAnswer(NamedTuple):
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _end(
    pairs: Pairs, e: int, side: int, x: Array, R: Array, v: Array
) -> tuple[Array, Array, Array, Array]:
    """Position, rotation and twist of a pair's frame, and what carries its node's twist there."""
    node = pairs.ends[e, side]
    if not pairs.has_offset[e]:
        return x[node], R[node], v[node], np.empty((0, 0))
    arm, turn = pairs.offset_position[e, side], pairs.offset_rotation[e, side]
    carry = adjoint(turn.T.copy(), -apply_transposed(turn, arm))
    return x[node] + apply(R[node], arm), multiply3(R[node], turn), apply(carry, v[node]), carry


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _beside(left: Array, right: Array) -> Array:
    """Two blocks (6,6) side by side."""
    out = np.empty((6, 12))
    for i in range(6):
        for j in range(6):
            out[i, j], out[i, 6 + j] = left[i, j], right[i, j]
    return out


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _turning_of_wrench(
    d: Array, wrench: Array, carry_a: Array, carry_b: Array, has_offset: bool
) -> Array:
    """Derivative (12,6) over d of the node wrenches ``P.T @ wrench`` at a constant wrench."""
    even = inverse_tangent_slope(d, wrench, True)
    odd = bracket_by_twist(wrench, True)
    on_a, on_b = np.empty((6, 6)), np.empty((6, 6))
    for i in range(6):
        for j in range(6):
            on_a[i, j] = 0.5 * odd[i, j] - even[i, j]
            on_b[i, j] = 0.5 * odd[i, j] + even[i, j]
    if has_offset:
        on_a, on_b = multiply6_transposed(carry_a, on_a), multiply6_transposed(carry_b, on_b)
    G = np.empty((12, 6))
    for i in range(6):
        for j in range(6):
            G[i, j], G[6 + i, j] = on_a[i, j], on_b[i, j]
    return G


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _damping_law(d: Array, va: Array, vb: Array, damping: Array) -> Array:
    """Derivative (6,6) over d of the damping wrench at constant twists of the two frames."""
    rate_by_motion = inverse_tangent_slope(d, vb - va, False)
    rate_by_motion += 0.5 * bracket_by_twist(va + vb, False)
    return multiply6(damping, rate_by_motion)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _respond(
    pairs: Pairs, e: int, multiplier: Array, x: Array, R: Array, v: Array, out: PairAnswer
) -> tuple[Array, Array, Array, Array]:
    """Motion, wrench and directions of one pair; the twists of its frames and what carries them."""
    has_offset = pairs.has_offset[e]
    xa, Ra, va, carry_a = _end(pairs, e, 0, x, R, v)
    xb, Rb, vb, carry_b = _end(pairs, e, 1, x, R, v)
    d = log_se3(multiply3_transposed(Ra, Rb), apply_transposed(Ra, xb - xa))
    by_b, by_a = inverse_tangents(d)
    driven = np.zeros(6)
    if has_offset:
        driven = apply(by_a, pairs.drive_twist[e])
        va = va + pairs.drive_twist[e]
        by_b, by_a = multiply6(by_b, carry_b), multiply6(by_a, carry_a)
    first, second = v[pairs.ends[e, 0]], v[pairs.ends[e, 1]]
    wrench, rate, P = out.wrench[e], out.rate[e], out.direction[e]
    for i in range(6):
        out.motion[e, i], rate[i] = d[i], -driven[i]
        wrench[i] = pairs.preload[e, i] + multiplier[e, i]
        for j in range(6):
            wrench[i] += pairs.stiffness[e, i, j] * (d[j] - pairs.reference[e, j])
            rate[i] += by_b[i, j] * second[j] - by_a[i, j] * first[j]
            P[i, j], P[i, 6 + j] = -by_a[i, j], by_b[i, j]
    for i in range(6 * pairs.damped[e]):
        for j in range(6):
            wrench[i] += pairs.damping[e, i, j] * rate[j]
    for j in range(12):
        out.node_wrench[e, j] = 0.0
        for i in range(6):
            out.node_wrench[e, j] += P[i, j] * wrench[i]
    return va, vb, carry_a, carry_b


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _respond_all(
    pairs: Pairs, multiplier: Array, x: Array, R: Array, v: Array, out: PairAnswer
) -> None:
    for e in range(len(pairs.ends)):
        _respond(pairs, e, multiplier, x, R, v, out)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _answer_all(
    pairs: Pairs, multiplier: Array, x: Array, R: Array, v: Array, velocity_tangent: Array,
    out: PairAnswer,
) -> None:  # fmt: skip
    for e in range(len(pairs.ends)):
        va, vb, carry_a, carry_b = _respond(pairs, e, multiplier, x, R, v, out)
        d, P, damped = out.motion[e], out.direction[e], pairs.damped[e]
        if np.isnan(out.carried[e, 0]):
            out.carried[e] = out.wrench[e]
        G = _turning_of_wrench(d, out.carried[e], carry_a, carry_b, pairs.has_offset[e])
        law = pairs.stiffness[e]
        if damped:
            law = law + _damping_law(d, va, vb, pairs.damping[e])
        G += multiply_12_6_6_transposed(P, law)
        S = multiply_12_6_12(G, P)
        if damped:
            by_velocity = _beside(
                multiply6(P[:, :6], velocity_tangent[pairs.ends[e, 0]]),
                multiply6(P[:, 6:], velocity_tangent[pairs.ends[e, 1]]),
            )
            S += multiply_12_6_12(multiply_12_6_6_transposed(P, pairs.damping[e]), by_velocity)
        out.tangent[e] = S


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
    _answer_all(pairs, multiplier, x, R, v, velocity_tangent, room)
    return room


def respond(
    pairs: Pairs, multiplier: Array, x: Array, R: Array, v: Array, room: PairAnswer
) -> PairAnswer:
    """As ``answer``, with wrenches and directions alone: the tangents stay as they were."""
    _respond_all(pairs, multiplier, x, R, v, room)
    return room


def carried_on(pairs: Pairs, before: PairAnswer, variation: Array, multiplier: Array) -> Array:
    """The wrenches (m,6) that Newton's linear equations expect after a correction.

    Used in the next tangent in place of the wrenches of the overstretched trial shape, they
    let slender beams take large steps. Source: Magisano, Leonetti and Garcea, Comput.
    Methods Appl. Mech. Eng. 313 (2017) 986, where the iteration is derived from stresses
    as unknowns of their own.
    """
    return _carried_on(pairs, before, variation, multiplier)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _carried_on(pairs: Pairs, before: PairAnswer, variation: Array, multiplier: Array) -> Array:
    out = before.wrench + multiplier
    for e in range(len(out)):
        first, second = variation[pairs.ends[e, 0]], variation[pairs.ends[e, 1]]
        P = before.direction[e]
        out[e] += apply(pairs.stiffness[e], apply(P[:, :6], first) + apply(P[:, 6:], second))
    return out
