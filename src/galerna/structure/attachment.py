"""Stations that ride on frames: their motion, and their loads taken back without loss of work.

Between two frames A and B of a beam element a station moves as the element's own shape,
H = A exp(s d) K with d = log(A^-1 B), s its fraction of the element and K fixed. Its twist is
linear in the frames' twists; the transpose of that map takes loads to the frames, so that
force times velocity is the same on both sides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from galerna.contract import Array, Loads, Motion
from galerna.errors import InputError

from .blocks import (
    FAST,
    apply,
    apply_transposed,
    multiply3,
    multiply3_transposed,
    multiply6,
    multiply6_transposed,
)
from .forces import BLOCKS, NO_BLOCKS, Forces
from .frames import exp_se3, hat, inverse_tangent_slope, inverse_tangents, log_se3, tangent
from .pairs import Integers
from .system import State


class Riding(NamedTuple):
    """How n stations ride: what takes their loads back to the frames.

    ``base`` (n,3,3) and ``base_position`` (n,3) m of the frame A, ``shape`` (n,3,3) and
    ``shape_position`` (n,3) of ``A exp(s d)``; ``growth`` (n,6,6) is how its twist follows the
    rate of d, ``inverse`` (n,2,6,6) how that follows the twists of A and B.
    """

    base: Array
    base_position: Array
    shape: Array
    shape_position: Array
    growth: Array
    inverse: Array

    @classmethod
    def of(cls, n: int) -> Riding:
        return cls(
            np.zeros((n, 3, 3)), np.zeros((n, 3)), np.zeros((n, 3, 3)), np.zeros((n, 3)),
            np.zeros((n, 6, 6)), np.zeros((n, 2, 6, 6)),
        )  # fmt: skip


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _cross(a: Array, i: int, b: Array, j: int, k: int) -> float:
    """Component k of the cross product of ``a[i : i + 3]`` and ``b[j : j + 3]``."""
    m, n = (k + 1) % 3, (k + 2) % 3
    return a[i + m] * b[j + n] - a[i + n] * b[j + m]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_bracket(scale: float, a: Array, b: Array, out: Array) -> None:
    """``out += scale ad(a) b`` for twists (6,)."""
    for k in range(3):
        out[k] += scale * (_cross(a, 3, b, 0, k) + _cross(a, 0, b, 3, k))
        out[3 + k] += scale * _cross(a, 3, b, 3, k)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _seen_from(R: Array, x: Array, twist: Array) -> Array:
    """The twist (6,) of a frame at ``R``, ``x`` on a body with ``twist``: its inverse adjoint."""
    turned, out = np.empty(3), np.empty(6)
    for k in range(3):
        turned[k] = twist[k] + _cross(twist, 3, x, 0, k)
    for k in range(3):
        out[k] = R[0, k] * turned[0] + R[1, k] * turned[1] + R[2, k] * turned[2]
        out[3 + k] = R[0, k] * twist[3] + R[1, k] * twist[4] + R[2, k] * twist[5]
    return out


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _between(
    s: float, d: Array, growth: Array, ahead: Array, behind: Array,
    va: Array, vb: Array, aa: Array, ab: Array, E: Array, shift: Array,
) -> tuple[Array, Array]:  # fmt: skip
    """Twist and its rate (6,) of the shape at ``s`` from A to B, in its axes.

    The rate counts that of the element's shape, to third order in d beside its own rate.
    """
    change = apply(ahead, vb) - apply(behind, va)
    bend = apply(ahead, ab) - apply(behind, aa)
    bend += apply(inverse_tangent_slope(d, vb - va, False), change)
    _add_bracket(0.5, change, va + vb, bend)
    carried, relative = _seen_from(E, shift, va), apply(growth, change)
    rate = _seen_from(E, shift, aa) + apply(growth, bend)
    _add_bracket(-1.0, relative, carried, rate)
    _add_growth_rate(s, d, change, rate)
    return carried + relative, rate


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_growth_rate(s: float, d: Array, change: Array, rate: Array) -> None:
    """Add the rate of ``s T(s d)`` times ``change``, the rate of d, by the series of T."""
    across, twice, twice_across, mixed = np.zeros(6), np.zeros(6), np.zeros(6), np.zeros(6)
    _add_bracket(1.0, d, change, across)
    _add_bracket(1.0, change, across, twice)
    _add_bracket(1.0, d, twice, mixed)
    _add_bracket(1.0, d, across, twice_across)
    _add_bracket(1.0, change, twice_across, mixed)
    for k in range(6):
        rate[k] += s**3 * (twice[k] / 6.0 - s * mixed[k] / 24.0)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _ride(
    ends: Integers, fraction: Array, KR: Array, Kx: Array, x: Array, R: Array, v: Array, a: Array,
    vectors: Array, rotation: Array, riding: Riding,
) -> None:  # fmt: skip
    """Motion of all stations; ``vectors`` stacks position, velocity, spin and their rates."""
    for i in range(len(ends)):
        A, B, s = ends[i, 0], ends[i, 1], fraction[i]
        shape, at, twist, rate = R[A], x[A], v[A], a[A]
        riding.base[i], riding.base_position[i] = shape, at
        if s != 0.0:
            d = log_se3(multiply3_transposed(R[A], R[B]), apply_transposed(R[A], x[B] - x[A]))
            ahead, behind = inverse_tangents(d)
            growth = s * tangent(s * d)
            E, shift = exp_se3(s * d)
            twist, rate = _between(
                s, d, growth, ahead, behind, v[A], v[B], a[A], a[B], E, shift
            )  # fmt: skip
            shape, at = multiply3(R[A], E), x[A] + apply(R[A], shift)
            riding.growth[i], riding.inverse[i, 0], riding.inverse[i, 1] = growth, behind, ahead
        riding.shape[i], riding.shape_position[i] = shape, at
        own = multiply3(shape, KR[i])
        rotation[i] = own
        local, local_rate = _seen_from(KR[i], Kx[i], twist), _seen_from(KR[i], Kx[i], rate)
        for k in range(3):
            local_rate[k] += _cross(local, 3, local, 0, k)
        for k in range(3):
            vectors[0, i, k] = at[k]
            for row in range(1, 5):
                vectors[row, i, k] = 0.0
            for j in range(3):
                vectors[0, i, k] += shape[k, j] * Kx[i, j]
                vectors[1, i, k] += own[k, j] * local[j]
                vectors[2, i, k] += own[k, j] * local[3 + j]
                vectors[3, i, k] += own[k, j] * local_rate[j]
                vectors[4, i, k] += own[k, j] * local_rate[3 + j]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_wrench(R: Array, x: Array, at: Array, force: Array, moment: Array, out: Array) -> None:
    """Add a global load at ``at`` to the wrench ``out`` (6,) in the axes of the frame R, x."""
    arm, about = at - x, np.empty(3)
    for k in range(3):
        about[k] = moment[k] + _cross(arm, 0, force, 0, k)
    for k in range(3):
        for j in range(3):
            out[k] += R[j, k] * force[j]
            out[3 + k] += R[j, k] * about[j]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _take_back(
    ends: Integers, fraction: Array, riding: Riding, position: Array, force: Array, moment: Array,
    out: Array,
) -> None:  # fmt: skip
    for i in range(len(ends)):
        _add_wrench(
            riding.base[i], riding.base_position[i], position[i], force[i], moment[i],
            out[ends[i, 0]],
        )  # fmt: skip
        if fraction[i] == 0.0:
            continue
        wrench = np.zeros(6)
        _add_wrench(
            riding.shape[i], riding.shape_position[i], position[i], force[i], moment[i], wrench
        )
        against = apply_transposed(riding.growth[i], wrench)
        out[ends[i, 0]] -= apply_transposed(riding.inverse[i, 0], against)
        out[ends[i, 1]] += apply_transposed(riding.inverse[i, 1], against)


class Attachment:
    """Stations on the frames ``ends`` (n,2), ``fraction`` (n,) of the way from one to the other.

    ``position`` (n,3) m and ``rotation`` (n,3,3) are the stations' while the frames stand
    as in ``state``. ``motion`` is written by ``follow`` and keeps its arrays.
    """

    def __init__(
        self, state: State, ends: Integers, fraction: Array, position: Array, rotation: Array
    ) -> None:
        n = len(ends)
        self._ends, self._fraction = np.ascontiguousarray(ends), np.asarray(fraction, dtype=float)
        self._offset_rotation, self._offset = np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3))
        self._vectors, self._riding = np.zeros((5, n, 3)), Riding.of(n)
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
            self._vectors, self._rotation, self._riding,
        )  # fmt: skip

    @property
    def frames(self) -> Integers:
        """The frame (n,) on which each station rides, where it does not stand between two."""
        return self._ends[:, 0]

    def add_loads(self, loads: Loads, forces: Forces) -> None:
        """Add loads on the stations, where they were last, to ``forces`` on the frames.

        Those with tangents turn with nothing: their stations stand on frames, not between.
        """
        if any(getattr(loads, name) is not None for name in BLOCKS):
            self._add_stiff(loads, forces)
            return
        _take_back(
            self._ends, self._fraction, self._riding, self._vectors[0], loads.force, loads.moment,
            forces.follower,
        )  # fmt: skip

    def _add_stiff(self, loads: Loads, forces: Forces) -> None:
        if self._fraction.any():
            raise InputError("loads", "tangents of loads are taken on frames alone, not between")
        K, D, M = (NO_BLOCKS if block is None else block for block in forces.blocks)
        stiffness, damping, mass = (
            NO_BLOCKS if block is None or not len(room) else block
            for block, room in zip(
                (getattr(loads, name) for name in BLOCKS), (K, D, M), strict=True
            )
        )
        _put_on_frames(
            self.frames, self._riding.base_position, self._vectors[0], loads.force, loads.moment,
            stiffness, damping, mass, forces.dead, K, D, M,
        )  # fmt: skip


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _put_on_frames(
    frames: Integers, origin: Array, position: Array, force: Array, moment: Array,
    stiffness: Array, damping: Array, mass: Array,
    dead: Array, K: Array, D: Array, M: Array,
) -> None:  # fmt: skip
    """Loads with tangents at points that ride on frames, about the frames' origins."""
    carry = np.eye(6)
    for i in range(len(frames)):
        frame, arm = frames[i], position[i] - origin[i]
        for k in range(3):
            dead[frame, k] += force[i, k]
            dead[frame, 3 + k] += moment[i, k] + _cross(arm, 0, force[i], 0, k)
        apart = arm[0] != 0.0 or arm[1] != 0.0 or arm[2] != 0.0
        carry[:3, 3:] = -hat(arm)
        for given, total in ((stiffness, K), (damping, D), (mass, M)):
            if len(given) == 0:
                continue
            own = given[i]
            if apart:
                own = multiply6_transposed(carry, multiply6(np.ascontiguousarray(own), carry))
            for a in range(6):
                for b in range(6):
                    total[frame, a, b] += own[a, b]
        if apart and len(stiffness):  # the arm turns with the frame
            K[frame, 3:, 3:] -= multiply3(hat(force[i]), hat(arm))
