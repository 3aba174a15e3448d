"""Six-component forces and motions about one point, seen from another point or other axes."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.structure.frames import hat

MODES = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def shift(arm: Array) -> Array:
    """Matrix T (6,6): the motion at B is T times that at A, with ``arm`` (3,) m from A to B.

    Forces go the other way with its transpose: about A, T^T f of those about B.
    """
    matrix = np.eye(6)
    matrix[:3, 3:] = -hat(np.asarray(arm, dtype=float))
    return matrix


def turn(angle: float) -> Array:
    """Matrix (6,6) that turns forces and motions by ``angle`` rad about z."""
    c, s = np.cos(angle), np.sin(angle)
    block = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.kron(np.eye(2), block)


def constant_force_stiffness(force: Array, arm: Array) -> Array:
    """Stiffness (6,6) of a force (3,) N that keeps its direction at a point of the body.

    The point is ``arm`` (3,) m from the reference point; the moment arm x F turns with the
    body: minus its rate is -hat(F) hat(arm) = (F . arm) 1 - arm F^T.
    """
    stiffness = np.zeros((6, 6))
    stiffness[3:, 3:] = -hat(force) @ hat(arm)
    return stiffness


def point_mass(mass: float, arm: Array) -> Array:
    """Mass matrix (6,6) of a mass kg at ``arm`` (3,) m from the reference point."""
    matrix = shift(arm)
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    return matrix.T @ inertia @ matrix
