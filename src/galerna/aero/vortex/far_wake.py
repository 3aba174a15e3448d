"""The wake's velocity at the blades: what is far from them varies smoothly along their chords.

Rows of a wake that stay NEAR chords or more away from every surface induce a velocity that
a parabola or cubic through a few points of the chord gives at all others. With the distance d of
a vortex and the chord c, interpolation at p Chebyshev points errs by (c/4d)^p / 2 of its velocity:
1e-4 at two chords with four points. So only few points need the sum over the long wake.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.simd import FASTMATH
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array

NEAR = 2.0  #: chords from a surface, within which a row of a wake is summed at every point
NODES = 4  #: points of a chord that the velocity of the others is interpolated from
WORTH = 3e6  #: pairs of panel and point, from which on interpolation is worth its overhead
SLENDER = 20.0  #: lengths over distance of segments, above which single precision loses digits

MakeField = Callable[[Sequence[Sheet], str], InducedField]


class FarWake:
    """The field of all panels of a wake but the first, at the control points of surfaces.

    ``make_field`` sums sheets in a precision, as in `InducedField`. Without ``smooth``, or for
    few panels, nothing is interpolated.
    """

    def __init__(
        self, wake: Wake, core: VortexCore | None, make_field: MakeField, smooth: bool = True
    ) -> None:
        self._wake, self._core, self._make_field = wake, core, make_field
        self._smooth = smooth

    def velocity(self, surfaces: Sequence[Surface], points: Array) -> Array:
        """Velocity (P,3) m/s at the ``control_points`` (P,3) m of the surfaces."""
        panels = sum(g.size for g in self._wake.circulation)
        if not self._smooth or panels * len(points) < WORTH:
            sheets = self._wake.sheets(self._core, rows=slice(1, None))
            return self._make_field(sheets, "mixed").velocity(points)
        near = self._near_rows(surfaces)
        velocity = np.zeros_like(points)
        if near.any():
            velocity += self._make_field(self._sheets(near), "mixed").velocity(points)
        if not near.all():
            far = self._make_field(self._sheets(~near), self._precision(surfaces))
            stations = [_chord_stations(s.lattice.corners) for s in surfaces]
            found = far.velocity(np.concatenate([x.reshape(-1, 3) for x in stations]))
            ends = np.cumsum([x.size // 3 for x in stations])[:-1]
            parts = np.split(found, ends)
            smooth = [u.reshape(x.shape) for u, x in zip(parts, stations, strict=True)]
            velocity += _at_control_points(smooth, surfaces)
        return velocity

    def _near_rows(self, surfaces: Sequence[Surface]) -> NDArray[np.bool_]:
        """Whether panels 1, 2, ... of the wakes come near a surface (K-1,)."""
        points, reach = [], []
        for surface in surfaces:
            x = surface.lattice.corners
            points.append(0.5 * (x[0] + x[-1])[::2])
            reach.append((NEAR + 0.5) * np.linalg.norm(x[-1] - x[0], axis=-1)[::2])
        centres, limits = np.concatenate(points), np.concatenate(reach)
        near = np.zeros(len(self._wake.ages) - 2, dtype=bool)
        for x in self._wake.vertices:
            near |= _comes_near(np.ascontiguousarray(x[1:]), centres, limits)
        return near

    def _precision(self, surfaces: Sequence[Surface]) -> str:
        """Single where no segment is long beside its distance from a surface."""
        chords = [
            np.linalg.norm(np.subtract(*s.lattice.corners[[-1, 0]]), axis=-1) for s in surfaces
        ]
        nearest = NEAR * min(float(chord.min()) for chord in chords)
        longest = max(
            float(np.linalg.norm(np.diff(x, axis=along), axis=-1).max())
            for x in self._wake.vertices
            for along in (0, 1)
        )
        return "single" if longest < SLENDER * nearest else "mixed"

    def _sheets(self, chosen: NDArray[np.bool_]) -> list[Sheet]:
        """The chosen panels, from panel 1 on, in runs of neighbours."""
        sheets: list[Sheet] = []
        for wanted, run in groupby(range(len(chosen)), key=lambda k: bool(chosen[k])):
            rows = list(run)
            if wanted:
                window = slice(rows[0] + 1, rows[-1] + 2)
                sheets += self._wake.sheets(self._core, rows=window)
        return sheets


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FASTMATH)
def _comes_near(x, centres, limits):  # type: ignore[no-untyped-def]
    """Whether segments from row k to row k+1 of vertices come within limits of centres (K,)."""
    near = np.zeros(x.shape[0] - 1, dtype=np.bool_)
    for k in prange(x.shape[0] - 1):
        for j in range(x.shape[1]):
            lx, ly = x[k + 1, j, 0] - x[k, j, 0], x[k + 1, j, 1] - x[k, j, 1]
            lz = x[k + 1, j, 2] - x[k, j, 2]
            inverse = 1.0 / max(lx * lx + ly * ly + lz * lz, 1e-300)
            for p in range(len(centres)):
                rx, ry = centres[p, 0] - x[k, j, 0], centres[p, 1] - x[k, j, 1]
                rz = centres[p, 2] - x[k, j, 2]
                along = min(max((rx * lx + ry * ly + rz * lz) * inverse, 0.0), 1.0)
                rx, ry, rz = rx - along * lx, ry - along * ly, rz - along * lz
                if rx * rx + ry * ry + rz * rz < limits[p] * limits[p]:
                    near[k] = True
    return near


def _nodes() -> Array:
    """Chebyshev points (NODES,) from 0, the leading edge, to 1."""
    return 0.5 - 0.5 * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)


def _chord_stations(corners: Array) -> Array:
    """Points (NODES,2n+1,3) m of a surface: its columns first, then their middles."""
    place = _nodes() * (len(corners) - 1)
    row = np.minimum(place.astype(int), len(corners) - 2)
    share = (place - row)[:, None, None]
    columns = (1.0 - share) * corners[row] + share * corners[row + 1]
    return np.concatenate([columns, 0.5 * (columns[:, 1:] + columns[:, :-1])], axis=1)


def _at_control_points(velocities: Sequence[Array], surfaces: Sequence[Surface]) -> Array:
    """Velocities at chord stations (NODES,2n+1,3) of each surface as at ``control_points``."""
    collocation, segments = [], []
    for u, surface in zip(velocities, surfaces, strict=True):
        m, n = surface.shape
        quarter = surface.lattice.rings == "quarter_chord"
        spanwise, middle = (0.25, 0.75) if quarter else (0.0, 0.5)
        ahead, behind = (_weights((np.arange(m) + place) / m) for place in (spanwise, middle))
        columns, middles = u[:, : n + 1].reshape(NODES, -1), u[:, n + 1 :].reshape(NODES, -1)
        collocation.append((behind @ middles).reshape(-1, 3))
        segments += [(ahead @ middles).reshape(-1, 3), (behind @ columns).reshape(-1, 3)]
    return np.concatenate([*collocation, *segments])


def _weights(places: Array) -> Array:
    """Lagrange's weights (p,NODES) of the nodes at places (p,)."""
    nodes = _nodes()
    weights = np.ones((len(places), NODES))
    for k in range(NODES):
        for other in range(NODES):
            if other != k:
                weights[:, k] *= (places - nodes[other]) / (nodes[k] - nodes[other])
    return weights
