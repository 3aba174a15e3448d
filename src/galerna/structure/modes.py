"""Linearisation about any state, natural frequencies and shapes, at rest or turning.

In body axes the perturbation ``h`` of a machine that turns steadily obeys constant
coefficients, ``M h'' + C h' + K h = 0`` with the constraints' ``B h = 0``: centrifugal and
gyroscopic terms come from the one residual by its tangents.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs, splu

from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError

from .solvers import SparseSolver
from .statics import spin_tangent
from .system import Forces, State, System


@dataclass(frozen=True, eq=False)
class Linear:
    """Mass, damping and stiffness, sparse, over (node variations, multipliers).

    The variations are the body's own, 6 a node without the ground; the rows and columns of
    the multipliers stand in ``stiffness``.
    """

    mass: csc_matrix
    damping: csc_matrix
    stiffness: csc_matrix
    motions: int


@dataclass(frozen=True, eq=False)
class Modes:
    """Natural modes by rising frequency: damped ``frequency`` (k,) Hz, ``damping_ratio`` (k,).

    ``shape`` (k,n,6) complex: body variations of the frames, the largest shift or turn 1.
    """

    frequency: Array
    damping_ratio: Array
    shape: Array

    def __len__(self) -> int:
        return len(self.frequency)


def linearise(
    system: System,
    state: State,
    forces: Forces | None = None,
) -> Linear:
    """Linear equations about a state at rest, or whose body twists are constant in time."""
    forces = forces or Forces.none(len(system))
    still, one = system.still(), np.tile(np.eye(6), (len(system), 1, 1))
    spin = spin_tangent(state)
    solver = SparseSolver(system.pairs, len(system))

    def matrix(velocity_tangent: Array, acceleration_tangent: Array) -> csc_matrix:
        balance = system.balance(state, forces, velocity_tangent, acceleration_tangent)
        return solver.matrix(balance.nodes, balance.pairs, system.stiffness_scale, balance.rows)

    base = matrix(still, still)
    mass = matrix(still, one) - base
    return Linear(
        mass=mass,
        damping=matrix(one, spin) - base,
        stiffness=matrix(spin, still),
        motions=6 * (len(system) - 1),
    )


def natural_modes(
    system: System,
    state: State,
    count: int = 10,
    forces: Forces | None = None,
    about_hz: float = 0.0,
) -> Modes:
    """The ``count`` modes whose frequencies are nearest to ``about_hz``.

    ``state`` should be an equilibrium, with the loads ``forces`` held constant. Rigid motions
    appear at 0 Hz. Source: shift and invert of the first-order pencil (Arnoldi).
    """
    return modes_of(system, linearise(system, state, forces), count, about_hz)


def modes_of(system: System, linear: Linear, count: int, about_hz: float = 0.0) -> Modes:
    """Modes of linear equations, see ``natural_modes``."""
    size = linear.stiffness.shape[0]
    count = min(count, linear.motions // 2)
    if count < 1:
        raise InputError("modes", "the structure has too few frames for this many modes")
    shift = 2j * np.pi * about_hz + 0.05
    values, vectors = _nearest(linear, shift, min(2 * count + 4, 2 * size - 2))
    return _sorted_modes(system, linear, values, vectors, count, shift)


def _nearest(linear: Linear, shift: complex, number: int) -> tuple[Array, Array]:
    """Eigenvalues s of (M s^2 + C s + K) h = 0 next to ``shift``, and vectors h.

    With p = s h the inverse of the shifted pencil needs one factorisation of the size of K.
    """
    M, C, K = linear.mass, linear.damping, linear.stiffness
    size = K.shape[0]
    factor = splu((shift**2 * M + shift * C + K).tocsc().astype(complex))

    def apply(z: Array) -> Array:
        h, p = z[:size], z[size:]
        right = -(M @ (p + shift * h) + C @ h)
        x = factor.solve(right.astype(complex))
        return np.concatenate([x, h + shift * x])

    operator = LinearOperator((2 * size, 2 * size), matvec=apply, dtype=complex)
    start = np.random.default_rng(0).normal(size=2 * size).astype(complex)
    subspace = min(2 * size, max(3 * number, 80))
    try:
        values, vectors = eigs(operator, number, v0=start, ncv=subspace, tol=1e-11)
    except ArpackNoConvergence as error:
        raise ConvergenceError("modes", str(error), "ask for fewer modes") from error
    return shift + 1.0 / values, vectors[:size]


def _sorted_modes(
    system: System, linear: Linear, values: Array, vectors: Array, count: int, shift: complex
) -> Modes:
    keep = (values.imag > -1e-6) & np.isfinite(values)
    order = np.argsort(np.abs(values[keep].imag - shift.imag))[:count]
    s, h = values[keep][order], vectors[:, keep][:, order]
    order = np.argsort(np.abs(s.imag))
    s, h = s[order], h[:, order]
    shape = np.zeros((len(s), len(system), 6), dtype=complex)
    shape[:, 1:] = h[: linear.motions].T.reshape(len(s), -1, 6)
    peak = np.abs(shape).reshape(len(s), -1).argmax(axis=1)
    largest = shape.reshape(len(s), -1)[np.arange(len(s)), peak]
    size = np.maximum(np.abs(s), 1e-12)
    return Modes(np.abs(s.imag) / (2 * np.pi), -s.real / size, shape / largest[:, None, None])
