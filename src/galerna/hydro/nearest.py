"""The points of a surface that are nearest to others."""

from __future__ import annotations

import numpy as np
from numba import njit

from galerna.contract import Array
from galerna.hydro.hull import Hull


def onto(surface: Hull, points: Array) -> Array:
    """The points (n,3) of a surface that are nearest to ``points`` (n,3)."""
    corners = np.ascontiguousarray(surface.vertices[surface.triangles])
    centers = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1)
    found = np.empty_like(points)
    _nearest(points, corners, centers, reach, found)
    return found


@njit(cache=True, error_model="numpy")
def _nearest(points: Array, corners: Array, centers: Array, reach: Array, found: Array) -> None:
    """Fill ``found`` (n,3); triangles (f,3,3) lie within ``reach`` (f,) of their centres."""
    for i in range(len(points)):
        least = np.inf
        for k in range(len(corners)):
            if _away(centers[k], points[i]) - reach[k] > least:
                continue
            point = _nearest_of(points[i], corners[k])
            away = _away(point, points[i])
            if away < least:
                least = away
                found[i] = point


@njit(cache=True, error_model="numpy")
def _away(a: Array, b: Array) -> float:
    return float(np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2))


@njit(cache=True, error_model="numpy")
def _nearest_of(p: Array, corner: Array) -> Array:
    """The point of a triangle nearest to p: Ericson, Real-Time Collision Detection, 5.1.5."""
    a, b, c = corner[0], corner[1], corner[2]
    ab, ac = b - a, c - a
    d1, d2 = (ab * (p - a)).sum(), (ac * (p - a)).sum()
    if d1 <= 0.0 and d2 <= 0.0:
        return a.copy()
    d3, d4 = (ab * (p - b)).sum(), (ac * (p - b)).sum()
    if d3 >= 0.0 and d4 <= d3:
        return b.copy()
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return a + d1 / (d1 - d3) * ab
    d5, d6 = (ab * (p - c)).sum(), (ac * (p - c)).sum()
    if d6 >= 0.0 and d5 <= d6:
        return c.copy()
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return a + d2 / (d2 - d6) * ac
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)
    total = va + vb + vc
    return a + vb / total * ab + vc / total * ac
