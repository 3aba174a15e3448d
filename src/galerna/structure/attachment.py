"""Stations that ride on frames: their motion, and their loads taken back without loss of work.

Between two frames A and B of a beam element a station moves as the element's own shape,
H = A exp(s d) K with d = log(A^-1 B), s its fraction of the element and K fixed. Its twist is
linear in the frames' twists; the transpose of that map takes loads to the frames, so that
force times velocity is the same on both sides.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from galerna.contract import Array, Loads, Motion
from galerna.errors import InputError

from .blocks import apply, apply_transposed, multiply3, multiply3_transposed, multiply6
from .frames import adjoint, exp_se3, inverse_tangents, log_se3, tangent
from .pairs import Integers
from .system import State


@njit(cache=True, error_model="numpy")
def _between(RA: Array, xA: Array, RB: Array, xB: Array, s: float):  # type: ignore[no-untyped-def]
    """The frame at ``s`` from A to B, and the maps (6,6) of A's and of B's twist to its own."""
    ahead, behind = np.eye(6), np.zeros((6, 6))
    if s == 0.0:
        return RA.copy(), xA.copy(), ahead, behind
    d = log_se3(multiply3_transposed(RA, RB), apply_transposed(RA, xB - xA))
    R, x = exp_se3(s * d)
    back_R, back_x = exp_se3(-s * d)
    inverse, inverse_back = inverse_tangents(d)
    growth = s * tangent(s * d)
    of_A = adjoint(back_R, back_x) - multiply6(growth, inverse_back)
    return multiply3(RA, R), xA + apply(RA, x), of_A, multiply6(growth, inverse)


@njit(cache=True, error_model="numpy")
def _ride(
    ends: Integers, fraction: Array, KR: Array, Kx: Array, x: Array, R: Array, v: Array, a: Array,
    vectors: Array, rotation: Array, carry: Array,
) -> None:  # fmt: skip
    """Motion of all stations; ``vectors`` stacks position, velocity, spin and their rates."""
    for i in range(len(ends)):
        first, second = ends[i]
        hR, hx, of_A, of_B = _between(R[first], x[first], R[second], x[second], fraction[i])
        inwards = adjoint(KR[i].T.copy(), -apply_transposed(KR[i], Kx[i]))
        carry[i, 0], carry[i, 1] = multiply6(inwards, of_A), multiply6(inwards, of_B)
        twist, rate = np.zeros(6), np.zeros(6)
        for k in range(6):
            for j in range(6):
                twist[k] += carry[i, 0, k, j] * v[first, j] + carry[i, 1, k, j] * v[second, j]
                rate[k] += carry[i, 0, k, j] * a[first, j] + carry[i, 1, k, j] * a[second, j]
        own = multiply3(hR, KR[i])
        rotation[i] = own
        vectors[0, i] = hx + apply(hR, Kx[i])
        vectors[1, i], vectors[2, i] = apply(own, twist[:3]), apply(own, twist[3:])
        vectors[3, i] = apply(own, rate[:3] + np.cross(twist[3:], twist[:3]))
        vectors[4, i] = apply(own, rate[3:])


@njit(cache=True, error_model="numpy")
def _take_back(
    ends: Integers, carry: Array, rotation: Array, force: Array, moment: Array, out: Array
) -> None:
    wrench = np.empty(6)
    for i in range(len(ends)):
        wrench[:3] = apply_transposed(rotation[i], force[i])
        wrench[3:] = apply_transposed(rotation[i], moment[i])
        for end in range(2):
            for j in range(6):
                for k in range(6):
                    out[ends[i, end], j] += carry[i, end, k, j] * wrench[k]


class Attachment:
    """Stations on the frames ``ends`` (n,2), ``fraction`` (n,) of the way from one to the other.

    ``position`` (n,3) m and ``rotation`` (n,3,3) are the stations' while the frames stand
    as in ``state``. ``motion`` is written by ``follow`` and keeps its arrays. Its
    accelerations leave out the rate at which a deforming element changes its shape.
    """

    def __init__(
        self, state: State, ends: Integers, fraction: Array, position: Array, rotation: Array
    ) -> None:
        n = len(ends)
        self._ends, self._fraction = np.ascontiguousarray(ends), np.asarray(fraction, dtype=float)
        self._offset_rotation, self._offset = np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3))
        self._vectors, self._carry = np.zeros((5, n, 3)), np.zeros((n, 2, 6, 6))
        self._rotation = np.zeros((n, 3, 3))
        self.follow(state)
        bare_position, bare = self._vectors[0].copy(), self._rotation.copy()
        self._offset_rotation = np.ascontiguousarray(np.einsum("nki,nkj->nij", bare, rotation))
        self._offset = np.einsum("nki,nk->ni", bare, position - bare_position)
        x, velocity, spin, acceleration, spin_rate = self._vectors
        self.motion = Motion(x, self._rotation, velocity, spin, acceleration, spin_rate)
        self.follow(state)

    def follow(self, state: State) -> None:
        """Write the motion of the stations at a state of the frames."""
        _ride(
            self._ends, self._fraction, self._offset_rotation, self._offset,
            state.position, state.rotation, state.velocity, state.acceleration,
            self._vectors, self._rotation, self._carry,
        )  # fmt: skip

    def add_loads(self, loads: Loads, follower: Array) -> None:
        """Add loads on the stations, where they were last, to ``follower`` (n,6) of the frames."""
        if loads.stiffness is not None or loads.damping is not None or loads.mass is not None:
            raise InputError("loads", "tangents of loads are taken on frames alone, not between")
        _take_back(
            self._ends, self._carry, self._rotation, loads.force, loads.moment, follower
        )  # fmt: skip
