"""Velocity induced by sheets of vortex rings, summed directly.

A straight segment from a to b of circulation G, seen from x with r1 = x - a, r2 = x - b and
l = b - a, induces (Katz and Plotkin, Low-Speed Aerodynamics, 2001, eq. 2.68)

    G/(4 pi) (r1 x r2) (1/|r1| + 1/|r2|) / (|r1||r2| + r1.r2)  *  d^2 / sqrt(d^4 + r_c^4)

with d = |r1 x r2|/|l| the distance from its line; the last factor is the core of Vatistas,
Kozel and Mih (1991), n = 2, close to the swirl of a Lamb-Oseen vortex.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi, sqrt

import numpy as np
from numba import njit

from galerna.aero.vortex.sheet import Sheet
from galerna.contract import Array

_FASTMATH = {"reassoc", "contract", "arcp", "nsz", "afn"}


def direct_velocity(sheets: Sequence[Sheet], points: Array) -> Array:
    """Velocity (...,3) m/s that sheets induce at points (...,3) m, in double precision."""
    points = np.asarray(points, dtype=float)
    flat = np.ascontiguousarray(points.reshape(-1, 3))
    velocity = np.zeros_like(flat)
    for sheet in sheets:
        x, core = sheet.vertices, np.broadcast_to(sheet.core_radius, sheet.vertices.shape[:2])
        for start, end, strength, ends in (
            (x[:, :-1], x[:, 1:], sheet.spanwise_strength, (core[:, :-1], core[:, 1:])),
            (x[:-1], x[1:], sheet.streamwise_strength, (core[:-1], core[1:])),
        ):
            core_squared = 0.5 * (ends[0] ** 2 + ends[1] ** 2)
            _add_segments(
                flat,
                np.ascontiguousarray(start.reshape(-1, 3)),
                np.ascontiguousarray(end.reshape(-1, 3)),
                strength.ravel(),
                core_squared.ravel(),
                velocity,
            )
    return velocity.reshape(points.shape)


@njit(cache=True, error_model="numpy", fastmath=_FASTMATH)
def _add_segments(  # type: ignore[no-untyped-def]
    points, start, end, strength, core_squared, velocity
):
    for i in range(points.shape[0]):
        for k in range(start.shape[0]):
            ax = points[i, 0] - start[k, 0]
            ay = points[i, 1] - start[k, 1]
            az = points[i, 2] - start[k, 2]
            bx, by, bz = (
                points[i, 0] - end[k, 0],
                points[i, 1] - end[k, 1],
                points[i, 2] - end[k, 2],
            )
            lx, ly, lz = ax - bx, ay - by, az - bz
            cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            across = cx * cx + cy * cy + cz * cz
            core = core_squared[k] * (lx * lx + ly * ly + lz * lz)
            r1 = sqrt(ax * ax + ay * ay + az * az)
            r2 = sqrt(bx * bx + by * by + bz * bz)
            along = max(r1 * r2 + ax * bx + ay * by + az * bz, 1e-14 * r1 * r2)
            if across <= 1e-24 * (r1 * r2) ** 2:
                continue
            swirl = across / sqrt(across * across + core * core)
            f = strength[k] / (4.0 * pi) * (r1 + r2) / (r1 * r2 * along) * swirl
            velocity[i, 0] += f * cx
            velocity[i, 1] += f * cy
            velocity[i, 2] += f * cz
