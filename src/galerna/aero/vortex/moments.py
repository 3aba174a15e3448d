"""The far field of patches of vortex rings: moments of the layers of dipoles they are.

Away from a closed ring of circulation G its velocity is the gradient of the potential of
dipoles of moment G/(4 pi) dA, spread over any surface that the ring bounds (Saffman, Vortex
Dynamics, 1992, section 2.3); here over the bilinear one, by Gauss's rule. One potential takes
a third of the work of the three of a field of vortex segments.
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from numba import njit, prange

from galerna.aero.vortex.clusters import Panels, Patches
from galerna.aero.vortex.expansions import (
    Indices,
    add_dipoles,
    add_shifted_moments,
    harmonic_polynomials,
    reduce_moments,
)
from galerna.aero.vortex.simd import FASTMATH
from galerna.contract import Array


def patch_moments(k: Indices, panels: Panels, patches: Patches) -> Array:
    """Moments (patches, independent of order-1) of the rings about the centres of the patches."""
    moments = np.zeros((len(patches.child), k.up_to[k.order - 1]))
    _add_all_rings(k, panels, patches, moments)
    _pass_upward(k, patches, moments)
    return moments


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FASTMATH)
def _add_all_rings(k, panels, patches, moments):  # type: ignore[no-untyped-def]
    for patch in prange(len(patches.child)):
        if patches.child[patch] == 0:
            _add_rings(k, panels, patches.limits[patch], patches.centre[patch], moments[patch])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _pass_upward(k, patches, moments):  # type: ignore[no-untyped-def]
    """Sum the moments of the halves of patches, which come behind them."""
    s, summed = np.zeros((len(k.exponents) + 1, 1)), np.empty(len(k.exponents) + 1)
    for patch in range(len(moments) - 1, -1, -1):
        if patches.child[patch] == 0:
            continue
        summed[:] = 0.0
        for part in range(patches.child[patch], patches.child[patch] + 2):
            away = patches.centre[patch] - patches.centre[part]
            harmonic_polynomials(k, k.order - 2, away[0:1], away[1:2], away[2:3], s)
            add_shifted_moments(k, moments[part], s, summed)
        reduce_moments(k, summed)
        moments[patch] = summed[: moments.shape[1]]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _add_rings(k, panels, limits, centre, moments):  # type: ignore[no-untyped-def]
    sheet, r0, r1, c0, c1 = limits
    _, columns, vertex, panel = panels.shapes[sheet]
    down, across = (3 if r1 - r0 < 3 else 2), (3 if c1 - c0 < 3 else 2)
    away = np.empty((3, (r1 - r0) * (c1 - c0) * down * across))
    dipole = np.empty(away.shape)
    n = 0
    for r in range(r0, r1):
        for c in range(c0, c1):
            a = vertex + r * (columns + 1) + c
            strength = panels.circulation[panel + r * columns + c] / (4.0 * pi)
            corners = (a, a + columns + 1, a + 1, a + columns + 2)
            for i in range(down):
                for j in range(across):
                    _place_dipole(
                        panels.vertices, corners, _gauss(down, i), _gauss(across, j),
                        strength, centre, away[:, n], dipole[:, n],
                    )  # fmt: skip
                    n += 1
    s = np.empty((len(k.exponents) + 1, n))
    harmonic_polynomials(k, k.order - 2, away[0], away[1], away[2], s)
    add_dipoles(k, s, dipole[0], dipole[1], dipole[2], moments)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _place_dipole(x, corners, row, column, strength, centre, away, dipole):  # type: ignore[no-untyped-def]
    """Way from a point of a bilinear surface to the centre, and the dipole that stands for it."""
    u, weight_u = row
    v, weight_v = column
    p, q, s, t = corners  # at (u,v) = (0,0), (1,0), (0,1), (1,1)
    for i in range(3):
        near, far = (1.0 - u) * x[p, i] + u * x[q, i], (1.0 - u) * x[s, i] + u * x[t, i]
        away[i] = centre[i] - ((1.0 - v) * near + v * far)
    ux, vx = _tangents(x[p, 0], x[q, 0], x[s, 0], x[t, 0], u, v)
    uy, vy = _tangents(x[p, 1], x[q, 1], x[s, 1], x[t, 1], u, v)
    uz, vz = _tangents(x[p, 2], x[q, 2], x[s, 2], x[t, 2], u, v)
    weight = strength * weight_u * weight_v
    dipole[0] = weight * (uy * vz - uz * vy)
    dipole[1] = weight * (uz * vx - ux * vz)
    dipole[2] = weight * (ux * vy - uy * vx)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _tangents(p, q, s, t, u, v):  # type: ignore[no-untyped-def]
    return (1.0 - v) * (q - p) + v * (t - s), (1.0 - u) * (s - p) + u * (t - q)


@njit(cache=True)
def _gauss(points, i):  # type: ignore[no-untyped-def]
    """Place and weight on (0,1) of point i of the Gauss rule with 2 or 3 points."""
    if points == 2:
        return 0.5 + (i - 0.5) / sqrt(3.0), 0.5
    return 0.5 + (i - 1) * sqrt(0.15), (4.0 / 9.0 if i == 1 else 5.0 / 18.0)
