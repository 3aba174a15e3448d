"""Buoyancy of the displaced hull in still water, and what it is linearly about upright.

With the platform's frame at p, m = int (r - p) dV over the displaced volume V and S the
waterplane with coordinates x, y from p, the force is rho g V upwards and the moment about p
is rho g (m_y, -m_x, 0). A motion (dx, dtheta) lifts the waterplane by
dz + dtheta_x y - dtheta_y x, so V loses the integral of that and m turns with the body. Minus
the rate of force and moment is therefore, over rho g,

    K33 = S      K34 = S_y               K35 = -S_x
    K43 = S_y    K44 = S_yy + m_z        K45 = -S_xy           K46 = -m_x
    K53 = -S_x   K54 = -S_xy             K55 = S_xx + m_z      K56 = -m_y

Buoyancy does not turn with the body, hence K46 and K56 without K64 and K65: where m_x or m_y
is not zero, a weight beside it has the same terms with the other sign. Newman, Marine
Hydrodynamics (1977), sec. 6.16, has the sum of both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.hull import Hull
from galerna.units import SEA_WATER, STANDARD_GRAVITY

FAST = {"reassoc", "contract", "arcp", "nsz", "afn"}


@dataclass(frozen=True, eq=False)
class Hydrostatics:
    """A hull upright in still water.

    ``volume`` m3, ``center_of_buoyancy`` (3,) m from the origin; of the waterplane the ``area``
    m2, its centre (2,) m from the reference point's axis and its second ``moments`` (S_xx, S_yy,
    S_xy) m4 about it; ``stiffness`` (6,6) of buoyancy alone about the reference point.
    """

    volume: float
    center_of_buoyancy: Array
    area: float
    center_of_flotation: Array
    moments: Array
    stiffness: Array


def hydrostatics(
    hull: Hull,
    reference_point: ArrayLike = (0.0, 0.0, 0.0),
    density: float = SEA_WATER,
    gravity: float = STANDARD_GRAVITY,
) -> Hydrostatics:
    """Volume, waterplane and stiffness of a hull as it is described. Raises InputError if dry."""
    origin = np.asarray(reference_point, dtype=float)
    sums = NonlinearBuoyancy(hull, origin, density, gravity).integrals(origin, np.eye(3))
    volume, area = float(sums[0]), float(sums[4])
    if volume <= 0.0:
        top = f"its lowest point is at z = {hull.vertices[:, 2].min():g} m"
        raise InputError("hull", f"displaces nothing; {top}", "z = 0 is the still water")
    return Hydrostatics(
        volume=volume,
        center_of_buoyancy=origin + sums[1:4] / volume,
        area=area,
        center_of_flotation=sums[5:7] / area if area > 0.0 else np.zeros(2),
        moments=sums[7:10].copy(),
        stiffness=density * gravity * _tangent(sums),
    )


class NonlinearBuoyancy:
    """Hydrostatic pressure on a hull below the still water z = 0, wherever it is.

    Exact for the hull's facets: by the divergence theorem, the integrals over the displaced
    volume are sums over the wetted parts of triangles.
    """

    def __init__(
        self,
        hull: Hull,
        reference_point: ArrayLike = (0.0, 0.0, 0.0),
        density: float = SEA_WATER,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        self.weight = density * gravity
        self._vertices = np.ascontiguousarray(hull.vertices - np.asarray(reference_point))
        self._triangles = hull.triangles.astype(np.int32)
        self._areas = hull.area_vectors()
        self._height = np.zeros(len(hull.vertices))

    def integrals(self, position: Array, rotation: Array) -> Array:
        """V, m (3,), S, S_x, S_y, S_xx, S_yy and S_xy in one row (10,), global axes."""
        sums = np.zeros(10)
        hull = self._vertices, self._triangles, self._areas
        _integrate(*hull, self._height, position, rotation, sums)
        return sums

    def loads(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Force and moment (6,) about the frame's origin and stiffness (6,6), global axes.

        ``position`` (3,) m and ``rotation`` (3,3) of the platform's frame.
        """
        sums = self.integrals(position, rotation)
        return self.weight * _wrench(sums), self.weight * _tangent(sums)


@njit(cache=True, error_model="numpy")
def _wrench(sums: Array) -> Array:
    wrench = np.zeros(6)
    wrench[2], wrench[3], wrench[4] = sums[0], sums[2], -sums[1]
    return wrench


@njit(cache=True, error_model="numpy")
def _tangent(sums: Array) -> Array:
    """Minus the rate of ``_wrench`` over translation and rotation: the module's K."""
    _, mx, my, mz, area, sx, sy, sxx, syy, sxy = sums
    K = np.zeros((6, 6))
    K[2, 2], K[2, 3], K[2, 4] = area, sy, -sx
    K[3, 2], K[3, 3], K[3, 4], K[3, 5] = sy, syy + mz, -sxy, -mx
    K[4, 2], K[4, 3], K[4, 4], K[4, 5] = -sx, -sxy, sxx + mz, -my
    return K


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _integrate(
    vertices: Array,
    triangles: NDArray[np.int32],
    areas: Array,
    height: Array,
    position: Array,
    rotation: Array,
    sums: Array,
) -> None:
    """Fill ``sums`` (10,); ``height`` (v,) is room for the vertices' heights over the water.

    In the body's axes, with h the height and u the upward direction, V is the surface integral
    of h u.n, int h dV that of h^2 u.n / 2, and int r dV + u int h dV that of h r u.n.
    """
    u = (rotation[2, 0], rotation[2, 1], rotation[2, 2])
    for i in range(len(vertices)):
        height[i] = position[2] + _dot(u, (vertices[i, 0], vertices[i, 1], vertices[i, 2]))
    volume = moment = gx = gy = gz = 0.0
    for k in range(len(triangles)):
        corner = (triangles[k, 0], triangles[k, 1], triangles[k, 2])
        below = (height[corner[0]] < 0.0) + (height[corner[1]] < 0.0) + (height[corner[2]] < 0.0)
        if below == 0:
            continue
        level = _dot(u, (areas[k, 0], areas[k, 1], areas[k, 2]))
        a, b, c = _turned(corner, height, below)
        ra, rb, rc = _row(vertices, a), _row(vertices, b), _row(vertices, c)
        ha, hb, hc = height[a], height[b], height[c]
        if below == 3:
            part = _part(level, ra, rb, rc, ha, hb, hc)
        else:
            s, t = ha / (ha - hb), ha / (ha - hc)
            p, q = _between(ra, rb, s), _between(ra, rc, t)
            part = _part(s * t * level, ra, p, q, ha, 0.0, 0.0)
            if below == 2:
                part = _minus(_part(level, ra, rb, rc, ha, hb, hc), part)
                p, q = q, p
            _add_waterline(rotation, q, p, sums)
        volume += part[0]
        moment += part[1]
        gx += part[2]
        gy += part[3]
        gz += part[4]
    g = (gx, gy, gz)
    sums[0] = volume
    sums[1] = _dot((rotation[0, 0], rotation[0, 1], rotation[0, 2]), g)
    sums[2] = _dot((rotation[1, 0], rotation[1, 1], rotation[1, 2]), g)
    sums[3] = moment - position[2] * volume


_Point = tuple[float, float, float]
_Part = tuple[float, float, float, float, float]


@njit(cache=True, error_model="numpy")
def _turned(corner: tuple[int, int, int], height: Array, below: int) -> tuple[int, int, int]:
    """The corners in their order, first the one that is alone on its side of the water."""
    a, b, c = corner
    alone = below == 1
    if (height[b] < 0.0) == alone:
        return b, c, a
    if (height[c] < 0.0) == alone:
        return c, a, b
    return a, b, c


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _part(level: float, a: _Point, b: _Point, c: _Point, ha: float, hb: float, hc: float) -> _Part:
    """Integrals of h, h^2 / 2 and h r, times ``level``, over a triangle of unit area."""
    total = ha + hb + hc
    squares = ha * ha + hb * hb + hc * hc
    wa, wb, wc = total + ha, total + hb, total + hc
    scale = level / 12.0
    return (
        level * total / 3.0,
        scale * (total * total + squares) / 2.0,
        scale * (wa * a[0] + wb * b[0] + wc * c[0]),
        scale * (wa * a[1] + wb * b[1] + wc * c[1]),
        scale * (wa * a[2] + wb * b[2] + wc * c[2]),
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_waterline(rotation: Array, p: _Point, q: _Point, sums: Array) -> None:
    """Add the segment from p to q, with the water's inside to its left, to the waterplane."""
    x1 = _dot((rotation[0, 0], rotation[0, 1], rotation[0, 2]), p)
    y1 = _dot((rotation[1, 0], rotation[1, 1], rotation[1, 2]), p)
    x2 = _dot((rotation[0, 0], rotation[0, 1], rotation[0, 2]), q)
    y2 = _dot((rotation[1, 0], rotation[1, 1], rotation[1, 2]), q)
    cross = x1 * y2 - x2 * y1
    sums[4] += cross / 2.0
    sums[5] += cross * (x1 + x2) / 6.0
    sums[6] += cross * (y1 + y2) / 6.0
    sums[7] += cross * (x1 * x1 + x1 * x2 + x2 * x2) / 12.0
    sums[8] += cross * (y1 * y1 + y1 * y2 + y2 * y2) / 12.0
    sums[9] += cross * (2.0 * x1 * y1 + x1 * y2 + x2 * y1 + 2.0 * x2 * y2) / 24.0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _dot(a: _Point, b: _Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, error_model="numpy")
def _row(a: Array, i: int) -> _Point:
    return a[i, 0], a[i, 1], a[i, 2]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _between(a: _Point, b: _Point, s: float) -> _Point:
    return a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _minus(a: _Part, b: _Part) -> _Part:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3], a[4] - b[4]
