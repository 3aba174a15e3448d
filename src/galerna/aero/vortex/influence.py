"""Velocity of rings of unit circulation: what the boundary condition is made of."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from numba import njit

from galerna.contract import Array

_FASTMATH = {"reassoc", "contract", "arcp", "nsz", "afn"}


def normal_influence(vertices: Array, points: Array, normals: Array) -> Array:
    """Velocity (k, m*n) 1/m along normals (k,3) at points (k,3) m of each ring of circulation 1.

    The rings stand between vertices (m+1,n+1,3) m without a core; ring (i,j) is column i*n+j.
    """
    vertices, points, normals = (
        np.ascontiguousarray(a, float) for a in (vertices, points, normals)
    )
    return _normal_influence(vertices, points, normals)


def strip_influence(vertices: Array, points: Array, core_radius: Array | float = 0.0) -> Array:
    """Velocity (k,n,3) 1/m at points (k,3) m of strips of a wake, each of circulation 1.

    A strip is a column of rings between vertices (K+1,n+1,3) m whose circulation is the same
    from the trailing edge to its end, so its spanwise segments cancel but for the first and the
    last. ``core_radius`` m stands on the vertices, or anything that broadcasts to them.
    """
    core_squared = np.broadcast_to(core_radius, vertices.shape[:2]) ** 2
    return _strip_influence(
        np.ascontiguousarray(vertices, float),
        np.ascontiguousarray(core_squared),
        np.ascontiguousarray(points, float),
    )


@njit(cache=True, error_model="numpy", fastmath=_FASTMATH)
def _segment(a, b, point, core_squared, out):  # type: ignore[no-untyped-def]
    """The velocity of a segment of circulation 1 from a to b; see ``biot_savart``."""
    ax, ay, az = point[0] - a[0], point[1] - a[1], point[2] - a[2]
    bx, by, bz = point[0] - b[0], point[1] - b[1], point[2] - b[2]
    lx, ly, lz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    cx, cy, cz = ly * az - lz * ay, lz * ax - lx * az, lx * ay - ly * ax
    across = cx * cx + cy * cy + cz * cz
    core = core_squared * (lx * lx + ly * ly + lz * lz)
    r1 = sqrt(ax * ax + ay * ay + az * az)
    r2 = sqrt(bx * bx + by * by + bz * bz)
    along = max(r1 * r2 + ax * bx + ay * by + az * bz, 1e-14 * r1 * r2)
    out[:] = 0.0
    if across <= 1e-24 * (r1 * r2) ** 2:
        return
    swirl = across / sqrt(across * across + core * core)
    f = (r1 + r2) / (4.0 * pi * r1 * r2 * along) * swirl
    out[0], out[1], out[2] = f * cx, f * cy, f * cz


@njit(cache=True, error_model="numpy", fastmath=_FASTMATH)
def _normal_influence(vertices, points, normals):  # type: ignore[no-untyped-def]
    rows, columns = vertices.shape[0] - 1, vertices.shape[1] - 1
    out = np.zeros((points.shape[0], rows * columns))
    u = np.empty(3)
    for k in range(points.shape[0]):
        for i in range(rows + 1):
            for j in range(columns + 1):
                if j < columns:
                    _segment(vertices[i, j], vertices[i, j + 1], points[k], 0.0, u)
                    w = u[0] * normals[k, 0] + u[1] * normals[k, 1] + u[2] * normals[k, 2]
                    if i < rows:
                        out[k, i * columns + j] += w
                    if i > 0:
                        out[k, (i - 1) * columns + j] -= w
                if i < rows:
                    _segment(vertices[i, j], vertices[i + 1, j], points[k], 0.0, u)
                    w = u[0] * normals[k, 0] + u[1] * normals[k, 1] + u[2] * normals[k, 2]
                    if j < columns:
                        out[k, i * columns + j] -= w
                    if j > 0:
                        out[k, i * columns + j - 1] += w
    return out


@njit(cache=True, error_model="numpy", fastmath=_FASTMATH)
def _strip_influence(vertices, core_squared, points):  # type: ignore[no-untyped-def]
    last, columns = vertices.shape[0] - 1, vertices.shape[1] - 1
    out = np.zeros((points.shape[0], columns, 3))
    u = np.empty(3)
    for k in range(points.shape[0]):
        for j in range(columns + 1):
            for i in range(last):
                core = 0.5 * (core_squared[i, j] + core_squared[i + 1, j])
                _segment(vertices[i, j], vertices[i + 1, j], points[k], core, u)
                if j < columns:
                    out[k, j] -= u
                if j > 0:
                    out[k, j - 1] += u
            if j < columns:
                core = 0.5 * (core_squared[0, j] + core_squared[0, j + 1])
                _segment(vertices[0, j], vertices[0, j + 1], points[k], core, u)
                out[k, j] += u
                core = 0.5 * (core_squared[last, j] + core_squared[last, j + 1])
                _segment(vertices[last, j], vertices[last, j + 1], points[k], core, u)
                out[k, j] -= u
    return out
