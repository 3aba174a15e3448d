"""Mass matrices (6,6) of rigid bodies about a frame, ordered (translation, rotation)."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError

from .frames import adjoint, hat


def rigid_body(mass: float, center: Array | None = None, inertia: Array | None = None) -> Array:
    """Mass matrix (6,6) of a body of ``mass`` kg with its centre at ``center`` (3,) m.

    ``inertia`` (3,), (6,) as xx, yy, zz, xy, xz, yz (negative products of inertia) or (3,3)
    kg m2 is about the centre of mass in the frame's axes. Raises InputError if no body has
    such figures.
    """
    J = _inertia_matrix(np.zeros(3) if inertia is None else np.asarray(inertia, dtype=float))
    c = np.zeros(3) if center is None else np.asarray(center, dtype=float)
    rounding = 1e-9 * max(np.abs(J).max(), 1e-300)
    if not np.isfinite([mass, *c, *J.ravel()]).all() or np.abs(J - J.T).max() > rounding:
        raise InputError(
            "rigid body", "mass, centre and a symmetric inertia must be finite numbers"
        )
    if mass < 0.0 or np.linalg.eigvalsh(J).min() < -rounding:
        raise InputError("rigid body", "mass and moments of inertia must not be negative")
    M = np.zeros((6, 6))
    M[:3, :3] = mass * np.eye(3)
    M[:3, 3:] = -mass * hat(c)
    M[3:, :3] = mass * hat(c)
    M[3:, 3:] = J - mass * hat(c) @ hat(c)
    return M


def point_mass(mass: float, position: Array | None = None) -> Array:
    """Mass matrix (6,6) of a point mass kg at ``position`` (3,) m in the frame's axes."""
    return rigid_body(mass, position)


def moved(mass_matrix: Array, R: Array, x: Array) -> Array:
    """A mass matrix (6,6), given about a frame at R, x of a base, about the base itself."""
    back = adjoint(R.T.copy(), -R.T @ x)
    return back.T @ mass_matrix @ back


def weight_of(mass_matrix: Array) -> Array:
    """Mass kg and first moment kg m (4,) on which gravity acts."""
    M = mass_matrix
    return np.array([M[0, 0], M[1, 5], M[2, 3], M[0, 4]])


def _inertia_matrix(J: Array) -> Array:
    if J.shape == (3,):
        return np.diag(J)
    if J.shape == (6,):
        xx, yy, zz, xy, xz, yz = J
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if J.shape == (3, 3):
        return J
    raise InputError("inertia", f"shape {J.shape}, expected (3,), (6,) or (3,3)")
