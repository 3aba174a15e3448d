"""Section matrices (6x6) of a beam from engineering constants.

Strains of a beam section are gamma = (gamma_x, gamma_y, epsilon) and kappa at its
reference point. At a point p of the section they are gamma + kappa x p and
kappa, and the velocities of a rigid section are v + omega x p and omega: one
*transfer* T takes both to another point and to axes turned about z. Energy
does not depend on where it is written down, so a matrix known at p, in its own
axes, is T^T M T at the reference point. Three points matter: axial force and
bending part at the elastic centre, shear and torsion at the shear centre, and
momentum at the mass centre.
(Hodges, Nonlinear Composite Beam Theory, 2006, chapter 4.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from galerna.turbine.model import Array


def transfer(point: ArrayLike, angle: ArrayLike) -> Array:
    """Transfers (n,6,6) to ``point`` (n,2) m, in axes turned by ``angle`` (n,) rad about z.

    T takes generalised strains or velocities at the reference point to the point;
    its transpose takes forces and moments back.
    """
    x, y = np.moveaxis(np.atleast_2d(np.asarray(point, dtype=float)), -1, 0)
    c, s = np.broadcast_arrays(np.cos(angle), np.sin(angle), x)[:2]
    zero, one = np.zeros_like(c), np.ones_like(c)
    to_axes = np.moveaxis(
        np.array([[c, s, zero], [-s, c, zero], [zero, zero, one]]), (0, 1), (-2, -1)
    )
    minus_point_cross = np.moveaxis(
        np.array([[zero, zero, -y], [zero, zero, x], [y, -x, zero]]), (0, 1), (-2, -1)
    )
    out = np.zeros((*to_axes.shape[:-2], 6, 6))
    out[..., :3, :3] = out[..., 3:, 3:] = to_axes
    out[..., :3, 3:] = to_axes @ minus_point_cross
    return out


def at_reference(matrix: Array, point: ArrayLike, angle: ArrayLike = 0.0) -> Array:
    """Matrices (n,6,6) known at ``point`` in axes turned by ``angle``, at the reference point."""
    t = transfer(point, angle)
    return np.swapaxes(t, -1, -2) @ matrix @ t


def stiffness_matrix(
    axial: ArrayLike,
    bending: tuple[ArrayLike, ArrayLike],
    shear: tuple[ArrayLike, ArrayLike],
    torsion: ArrayLike,
    elastic_center: ArrayLike = (0.0, 0.0),
    shear_center: ArrayLike = (0.0, 0.0),
    principal_angle: ArrayLike = 0.0,
) -> Array:
    """Stiffness (n,6,6) at the reference point from the constants of (n,) sections.

    ``axial`` EA N, ``bending`` EI N m2 about the two principal axes, ``shear`` kGA N
    along them, ``torsion`` GJ N m2; the centres (n,2) m; ``principal_angle`` (n,) rad
    from the section's x to the first principal axis, about z.
    """
    normal = _diagonal(0.0, 0.0, axial, *bending, 0.0)
    transverse = _diagonal(*shear, 0.0, 0.0, 0.0, torsion)
    return at_reference(normal, elastic_center, principal_angle) + at_reference(
        transverse, shear_center, principal_angle
    )


def inertia_matrix(
    mass: ArrayLike, center_of_mass: ArrayLike, moments: ArrayLike, product: ArrayLike = 0.0
) -> Array:
    """Inertia (n,6,6) at a point of (n,) sections, in that point's axes.

    ``mass`` kg/m, ``center_of_mass`` (n,2) m from the point, ``moments`` (n,2) kg m
    about the point's x and y, ``product`` (n,) kg m, the integral of x y dm.
    """
    m = np.atleast_1d(np.asarray(mass, dtype=float))
    cx, cy = np.moveaxis(np.broadcast_to(np.asarray(center_of_mass, float), (*m.shape, 2)), -1, 0)
    i_x, i_y = np.moveaxis(np.broadcast_to(np.asarray(moments, float), (*m.shape, 2)), -1, 0)
    out = _diagonal(m, m, m, i_x, i_y, i_x + i_y)
    for row, column, value in (
        (0, 5, -m * cy),
        (1, 5, m * cx),
        (2, 3, m * cy),
        (2, 4, -m * cx),
        (3, 4, -np.asarray(product, dtype=float)),
    ):
        out[..., row, column] = out[..., column, row] = value
    return out


def center_of_mass(inertia: Array) -> Array:
    """Mass centres (n,2) m of inertia matrices (n,6,6)."""
    return np.stack([inertia[..., 1, 5], -inertia[..., 0, 5]], axis=-1) / inertia[..., :1, 0]


def _diagonal(*entries: ArrayLike) -> Array:
    values = np.broadcast_arrays(*(np.atleast_1d(np.asarray(e, dtype=float)) for e in entries))
    return np.stack(values, axis=-1)[..., None] * np.eye(6)
