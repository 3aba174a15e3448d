"""One steady flow: surfaces, the strips of their wakes, and the circulation of both.

The circulation of a steady wake is that of the trailing edge all along each strip, so the wake
enters the boundary condition as n strips and not as K x n rings (eq. 4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.helix import carried, drifted_centre
from galerna.aero.vortex.influence import strip_influence
from galerna.aero.vortex.loads import SurfaceLoads, lattice_loads
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import (
    Surface,
    collocation_normals,
    collocation_points,
    collocation_velocities,
    segment_points,
    segment_velocities,
    split_panels,
)
from galerna.aero.vortex.symmetry import RotationalSymmetry
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array

Wind = Callable[[Array], Array]


class SteadyFlow:
    """The flow about ``all_surfaces``, of which ``surfaces`` are solved for.

    With a ``sector`` that is the first blade of a symmetric rotor. ``rows`` (K+1,n+1,3) m are
    where the wakes of ``surfaces`` lie, moved by ``drifts`` (eq. 8) from where the ``wind`` (3,)
    m/s alone carries them; ``circulation`` (m,n) m2/s is that of ``surfaces``.
    """

    def __init__(
        self,
        surfaces: list[Surface],
        air: Wind,
        wind: Array,
        ages: Array,
        *,
        axis: RotorAxis | None = None,
        core: VortexCore | None = None,
        sector: RotationalSymmetry | None = None,
        mirror: MirrorPlane | None = None,
    ) -> None:
        self.all_surfaces = surfaces
        self.surfaces = surfaces if sector is None else surfaces[:1]
        self.air, self.wind, self.axis, self.ages = air, wind, axis, ages
        self.core, self.sector, self.mirror = core, sector, mirror
        self.rows = [carried(ages, s.lattice.vertices[-1], wind, axis) for s in self.surfaces]
        self.drifts = [np.zeros_like(x) for x in self.rows]
        self.circulation = [np.zeros(s.shape) for s in self.surfaces]
        self.system = BoundSystem(sector, mirror)
        self.system.place(self.surfaces)
        self.solve()

    @property
    def size(self) -> float:
        """The rotor's radius or, without an axis, the span, m."""
        return extent(self.all_surfaces, self.axis)

    @property
    def period(self) -> float:
        """Time of a revolution, s; 0 without one."""
        turning = self.axis is not None and self.axis.speed != 0.0
        return 2.0 * np.pi / abs(self.axis.speed) if self.axis and turning else 0.0

    def solve(self) -> None:
        """Find the circulation with the wake as it lies now."""
        points, normals = collocation_points(self.surfaces), collocation_normals(self.surfaces)
        relative = self.air(points) - collocation_velocities(self.surfaces)
        onset = np.einsum("ka,ka->k", relative, normals)
        strips = np.einsum("kja,ka->kj", self._strips(points), normals)
        flat = self.system.solve(-onset, strips)
        self.circulation = split_panels(flat, self.surfaces)

    def shift(self, surface: int, row: int, move: Array, turn: Array) -> None:
        """Move a row and all behind it by ``move`` (n+1,3) m; ``turn`` are R(a) of eq. (8)."""
        self.drifts[surface][row:] += move
        self.rows[surface][row:] += np.einsum("kba,nb->kna", turn[row:], move)

    def place_drift(self, surface: int, row: int, drift: Array, turn: Array) -> None:
        """Give the rows from ``row`` on the drift (k,n+1,3) m."""
        move = drift - self.drifts[surface][row:]
        self.drifts[surface][row:] = drift
        self.rows[surface][row:] += np.einsum("kba,knb->kna", turn[row:], move)

    def wake(self) -> Wake:
        """The wakes of the surfaces solved for."""
        panels = len(self.ages) - 1
        centre = None
        if self.axis is not None:
            centre = drifted_centre(self.ages, self.wind, self.drifts, self.axis)
        strengths = tuple(np.tile(g[-1], (panels, 1)) for g in self.circulation)
        return Wake(self.ages, tuple(self.rows), strengths, centre)

    def whole(self) -> tuple[Wake, list[Array]]:
        """The wakes and the circulations of all surfaces."""
        wake = self.wake()
        if self.sector is None:
            return wake, self.circulation
        images = tuple(self.sector.images(wake.vertices[0]))
        strengths = wake.circulation * self.sector.order
        return replace(wake, vertices=images, circulation=strengths), (
            self.circulation * self.sector.order
        )

    def sheets(self) -> list[Sheet]:
        """All that induces velocity: the bound sheets, then the wakes."""
        wake, circulation = self.whole()
        bound = zip(self.all_surfaces, circulation, strict=True)
        return [Sheet(s.lattice.vertices, g) for s, g in bound] + wake.sheets(self.core)

    def induced(self, points: Array, precision: str) -> Array:
        """Velocity (k,3) m/s that everything induces at points (k,3) m, by direct summation."""
        sheets = self._bound_sheets() + self.wake().sheets(self.core)
        return self._by_all(lambda x: direct_velocity(sheets, x, precision), points)

    def loads(self, density: float) -> list[SurfaceLoads]:
        """Loads of all surfaces in air of a density kg/m3."""
        points = segment_points(self.surfaces)
        trailing = np.concatenate([g[-1] for g in self.circulation])
        bound = self._bound_sheets()
        velocity = self.air(points) + np.einsum("kja,j->ka", self._strips(points), trailing)
        velocity += self._by_all(lambda x: direct_velocity(bound, x), points)
        relative = velocity - segment_velocities(self.surfaces)
        loads = lattice_loads(self.surfaces, self.circulation, relative, density)
        if self.sector is None:
            return loads
        return [
            loads[0].turned(turn, s.lattice.corners)
            for turn, s in zip(self.sector.rotations, self.all_surfaces, strict=True)
        ]

    def _strips(self, points: Array) -> Array:
        """Velocity (k,n,3) 1/m of each strip of wake, images and all, of circulation 1."""
        wakes = list(zip(self.rows, self.wake().core_radius(self.core), strict=True))

        def of_own(x: Array) -> Array:
            return np.concatenate([strip_influence(rows, x, r) for rows, r in wakes], axis=1)

        return self._by_all(of_own, points)

    def _by_all(self, of_own: Callable[[Array], Array], points: Array) -> Array:
        """Velocity (k,...,3) by all sectors or images, from that by the surfaces solved for."""
        if self.sector is not None:
            return self.sector.sum_of_sectors(of_own, points)
        velocity = of_own(points)
        if self.mirror is not None:
            velocity += self.mirror.reflect_vectors(of_own(self.mirror.reflect_points(points)))
        return velocity

    def _bound_sheets(self) -> list[Sheet]:
        bound = zip(self.surfaces, self.circulation, strict=True)
        return [Sheet(s.lattice.vertices, g) for s, g in bound]


def extent(surfaces: list[Surface], axis: RotorAxis | None) -> float:
    """Radius m about the axis or, without one, the greatest extent of the surfaces."""
    corners = np.concatenate([s.lattice.corners.reshape(-1, 3) for s in surfaces])
    if axis is None:
        return float(np.ptp(corners, axis=0).max())
    arms = np.cross(corners - axis.origin, axis.direction)
    return float(np.linalg.norm(arms, axis=1).max())
