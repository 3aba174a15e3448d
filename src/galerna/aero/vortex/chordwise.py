"""Velocity that varies smoothly along the chords of surfaces, from a few points of them.

Vortices that stay NEAR chords or more away from a surface induce a velocity that a cubic through a
few points of the chord gives at all others. With the distance d of a vortex and the chord c,
interpolation at p Chebyshev points errs by (c/4d)^p / 2 of its velocity: 1e-4 at two chords with
four points. So only few points need the sum over a long wake, or over the other blades.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.simd import FASTMATH
from galerna.aero.vortex.surface import Surface, segment_middles
from galerna.contract import Array

NEAR = 2.0  #: chords from a surface, within which vortices are summed at every point
NODES = 4  #: points of a chord that the velocity of the others is interpolated from
WORTH = 3e5  #: pairs of panel and point, from which on interpolation is worth its overhead
SLENDER = 20.0  #: lengths over distance of segments, above which single precision loses digits

MakeField = Callable[[Sequence[Sheet], str], InducedField]


class ChordPoints:
    """Points of a surface that want a velocity, and the stations of its chords that give it.

    The points (P,3) are the middles of the loaded segments, behind the collocation points if
    these are ``collocated`` as well.
    """

    def __init__(self, surface: Surface, collocated: bool) -> None:
        self.surface, self.collocated = surface, collocated
        lattice = surface.lattice
        self.points = segment_middles(lattice.vertices)
        if collocated:
            self.points = np.concatenate([lattice.collocation.reshape(-1, 3), self.points])

    @cached_property
    def stations(self) -> Array:
        """Points (NODES (2n+1),3) m: at every node those of the columns, then their middles."""
        corners = self.surface.lattice.corners
        place = _nodes() * (len(corners) - 1)
        row = np.minimum(place.astype(int), len(corners) - 2)
        share = (place - row)[:, None, None]
        columns = (1.0 - share) * corners[row] + share * corners[row + 1]
        middles = 0.5 * (columns[:, 1:] + columns[:, :-1])
        return np.concatenate([columns, middles], axis=1).reshape(-1, 3)

    def directly(self, field: InducedField) -> Array:
        """Velocity (P,3) m/s of a field at the points, which are asked column by column.

        So points that are summed together are neighbours, and more of the field is far from them.
        """
        velocity = np.empty_like(self.points)
        velocity[self._by_column] = field.velocity(self.points[self._by_column])
        return velocity

    @cached_property
    def _by_column(self) -> NDArray[np.intp]:
        m, n = self.surface.shape
        middles, columns = np.tile(np.arange(n) + 0.5, m), np.tile(np.arange(n + 1), m)
        parts = [middles, middles, columns] if self.collocated else [middles, columns]
        return np.argsort(np.concatenate(parts), kind="stable")

    def near_rows(self, vertices: Array) -> NDArray[np.bool_]:
        """Whether panels (K,) between vertices (K+1,n+1,3) m come near."""
        corners = self.surface.lattice.corners[:, ::2]
        reach = (NEAR + 0.5) * np.linalg.norm(corners[-1] - corners[0], axis=-1)
        near: NDArray[np.bool_] = _comes_near(
            np.ascontiguousarray(vertices), 0.5 * (corners[0] + corners[-1]), reach
        )
        return near

    def interpolated(self, velocity: Array) -> Array:
        """Velocities at the stations as at the points (P,3)."""
        m, n = self.surface.shape
        upstream, middle = (0.0, 0.5) if self.surface.lattice.rings == "edges" else (0.25, 0.75)
        velocity = velocity.reshape(NODES, 2 * n + 1, 3)
        columns, middles = velocity[:, : n + 1], velocity[:, n + 1 :]
        parts = [(upstream, middles), (middle, columns)]
        if self.collocated:
            parts.insert(0, (middle, middles))
        return np.concatenate(
            [(_weights(m, place) @ u.reshape(NODES, -1)).reshape(-1, 3) for place, u in parts]
        )


class AlongChords:
    """Sums of sheets at the points of targets, each target's as it lies to each sheet.

    What is near a target is summed at all its points in the ``near`` precision, the rest at its
    stations, in single precision where no segment is long beside its distance. Without ``smooth``,
    or for few panels, nothing is interpolated. ``make_field`` is as in `FarWake`.
    """

    def __init__(
        self,
        targets: Sequence[ChordPoints],
        sheets: Sequence[Sheet],
        make_field: MakeField,
        smooth: bool,
    ) -> None:
        self._make_field = make_field
        panels = sum(np.size(sheet.circulation) for sheet in sheets)
        self._smooth = smooth and panels * sum(len(t.points) for t in targets) >= WORTH
        if self._smooth:
            vertices = [sheet.vertices for sheet in sheets]
            self._near = np.array([[t.near_rows(x).any() for x in vertices] for t in targets])
            self._apart = _precision_apart(targets, vertices)

    def velocity(
        self, targets: Sequence[ChordPoints], sheets: Sequence[Sheet], near: str
    ) -> list[Array]:
        """Velocity (P,3) m/s at each target, where these and the sheets have moved a little."""
        if not self._smooth:
            return self._at_all(sheets, [target.points for target in targets], near)
        lonely = np.logical_not(self._near.any(axis=0))
        stations = [target.stations for target in targets]
        found = self._at_all(_chosen(sheets, lonely), stations, self._apart)
        for number, (target, own) in enumerate(zip(targets, self._near, strict=True)):
            others = self._make_field(_chosen(sheets, ~own & ~lonely), self._apart)
            smooth = found[number] + others.velocity(target.stations)
            direct = self._make_field(_chosen(sheets, own), near)
            found[number] = target.interpolated(smooth) + target.directly(direct)
        return found

    def _at_all(
        self, sheets: Sequence[Sheet], places: Sequence[Array], precision: str
    ) -> list[Array]:
        """The velocity at the places of all targets, in one sum."""
        velocity = self._make_field(sheets, precision).velocity(np.concatenate(places))
        return np.split(velocity, np.cumsum([len(x) for x in places])[:-1])


def _chosen(sheets: Sequence[Sheet], which: NDArray[np.bool_]) -> list[Sheet]:
    return [sheet for sheet, wanted in zip(sheets, which, strict=True) if wanted]


def _precision_apart(targets: Sequence[ChordPoints], vertices: Sequence[Array]) -> str:
    """Single where no segment between vertices is long beside its distance from a target."""
    chords = [
        np.linalg.norm(np.subtract(*t.surface.lattice.corners[[-1, 0]]), axis=-1) for t in targets
    ]
    nearest = NEAR * min(float(chord.min()) for chord in chords)
    longest = max(
        float(np.linalg.norm(np.diff(x, axis=along), axis=-1).max())
        for x in vertices
        for along in (0, 1)
    )
    return "single" if longest < SLENDER * nearest else "mixed"


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


@lru_cache(maxsize=64)
def _weights(panels: int, place: float) -> Array:
    """Lagrange's weights (panels,NODES) of the nodes at a place of each panel of a chord."""
    nodes, places = _nodes(), (np.arange(panels) + place) / panels
    weights = np.ones((panels, NODES))
    for k in range(NODES):
        for other in range(NODES):
            if other != k:
                weights[:, k] *= (places - nodes[other]) / (nodes[k] - nodes[other])
    return weights
