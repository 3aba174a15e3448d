"""Radiation as a passive state space: ``x' = A x + B v``, force ``-B^T x``.

``A + A^T`` has no positive eigenvalue, so the stored energy ``|x|^2 / 2`` never grows by more
than the work of the velocity against the force: that is the whole proof of passivity.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag, expm

from galerna.contract import Array
from galerna.hydro.database import Complex


@dataclass(frozen=True, eq=False)
class RadiationStateSpace:
    """K(s) = B^T (s - A)^-1 B with ``A`` (n,n) 1/s and ``B`` (n,6), states in square roots of J.

    ``added_mass_infinite`` (6,6) kg, kg m, kg m2 is what acts on the acceleration beside it.
    ``error`` (6,6) is the largest distance from the coefficients fitted, over frequency, and
    ``rms`` (6,6) its root mean square, both as fractions of the largest coefficient.
    """

    A: Array
    B: Array
    added_mass_infinite: Array
    error: Array = field(default_factory=lambda: np.zeros((6, 6)))
    rms: Array = field(default_factory=lambda: np.zeros((6, 6)))
    notes: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.A)

    @cached_property
    def largest_growth(self) -> float:
        """Largest eigenvalue of ``A + A^T`` in 1/s: the certificate of passivity where <= 0."""
        return float(np.linalg.eigvalsh(self.A + self.A.T).max(initial=-np.inf))

    def transfer(self, frequency: ArrayLike) -> Complex:
        """K(i w) (k,6,6) in N s/m, N s, N m s at frequencies (k,) rad/s."""
        s = 1j * np.atleast_1d(np.asarray(frequency, dtype=float))
        inside = s[:, None, None] * np.eye(len(self)) - self.A
        states = np.linalg.solve(inside, np.broadcast_to(self.B, (len(s), *self.B.shape)))
        return np.asarray(self.B.T @ states)

    def impulse_response(self, time: ArrayLike) -> Array:
        """K(t) (k,6,6) in N/m, N, N m at times (k,) s from 0 on."""
        times = np.atleast_1d(np.asarray(time, dtype=float))
        return np.stack([self.B.T @ expm(self.A * t) @ self.B for t in times])

    def smallest_damping(self, frequency: ArrayLike) -> float:
        """Smallest eigenvalue of Re K over frequencies (k,), over the largest one."""
        values = np.linalg.eigvalsh(self.transfer(frequency).real)
        return float(values.min() / values.max())

    def step(self, dt: float) -> tuple[Array, Array, Array]:
        """E (n,n), B0 and B1 (n,6) of ``x1 = E x0 + B0 v0 + B1 v1``.

        Exact for a velocity that is linear over ``dt`` s.
        """
        n = len(self)
        whole = np.zeros((n + 12, n + 12))
        whole[:n, :n], whole[:n, n : n + 6] = self.A * dt, self.B * dt
        whole[n : n + 6, n + 6 :] = np.eye(6)
        grown = expm(whole)
        held, rising = grown[:n, n : n + 6], grown[:n, n + 6 :]
        return grown[:n, :n].copy(), held - rising, rising.copy()

    def arrays(self) -> dict[str, Array]:
        """Everything but the notes, to be stored."""
        names = ("A", "B", "added_mass_infinite", "error", "rms")
        return {name: getattr(self, name) for name in names}

    @classmethod
    def of_arrays(cls, arrays: Mapping[str, ArrayLike]) -> RadiationStateSpace:
        """What ``arrays`` gave, taken back."""
        names = ("A", "B", "added_mass_infinite", "error", "rms")
        A, B, added_mass, error, rms = (np.asarray(arrays[name], dtype=float) for name in names)
        return cls(A, B, added_mass, error, rms)


def joined(parts: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """A and B of systems (n_i,n_i), (n_i,6) that stand side by side."""
    if not parts:
        return np.zeros((0, 0)), np.zeros((0, 6))
    return block_diag(*(A for A, _ in parts)), np.vstack([B for _, B in parts])


def reciprocal(A: Array, B: Array) -> tuple[Array, Array]:
    """A system and its transpose side by side, half of each: symmetric, and as passive."""
    return block_diag(A, A.T), np.vstack([B, B]) / np.sqrt(2.0)
