"""Forces on a lattice: Joukowski on its segments and the rate of its circulation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vectors import cross_products
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface
from galerna.contract import Array


@dataclass(eq=False)
class SurfaceLoads:
    """Loads of one surface: on its corners (m+1,n+1,3) m and on its strips.

    ``corner_force`` (m+1,n+1,3) N does the same work as the forces on the segments in every
    motion of the corners, so the total force and moment are exact too. ``strip_force`` (n,3) N
    takes of the segments between two strips half to either, and sums to the same force.
    """

    corners: Array
    corner_force: Array
    strip_force: Array

    @property
    def force(self) -> Array:
        """Total force (3,) N."""
        return self.corner_force.sum(axis=(0, 1))

    def moment(self, about: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
        """Total moment (3,) N m about a point (3,) m."""
        arm = self.corners - np.asarray(about, dtype=float)
        return np.cross(arm, self.corner_force).sum(axis=(0, 1))

    def column_loads(self, origins: Array) -> tuple[Array, Array]:
        """Force (n+1,3) N and moment (n+1,3) N m of the columns about origins (n+1,3) m."""
        force = self.corner_force.sum(axis=0)
        return force, cross_products(self.corners - origins, self.corner_force).sum(axis=0)

    def turned(self, turn: Array, corners: Array) -> SurfaceLoads:
        """The loads turned by a rotation (3,3), on the corners there."""
        return SurfaceLoads(corners, self.corner_force @ turn.T, self.strip_force @ turn.T)


def lattice_loads(
    surfaces: Sequence[Surface],
    circulation: Sequence[Array],
    relative_velocity: Array,
    density: float,
    circulation_rate: Sequence[Array] | None = None,
) -> list[SurfaceLoads]:
    """Loads of surfaces whose rings carry ``circulation`` (m,n) m2/s each.

    ``relative_velocity`` (S,3) m/s is that of the air, induced velocities and all, less that of
    the segments, at ``surface.segment_points``. ``circulation_rate`` (m,n) m2/s2 adds the
    unsteady pressure.
    """
    loads, first = [], 0
    rates = [None] * len(surfaces) if circulation_rate is None else circulation_rate
    for surface, strength, rate in zip(surfaces, circulation, rates, strict=True):
        m, n = surface.shape
        last = first + m * n + m * (n + 1)
        velocity = relative_velocity[first:last]
        loads.append(_surface_loads(surface.lattice, strength, velocity, density, rate))
        first = last
    return loads


def _surface_loads(
    lattice: Lattice, circulation: Array, velocity: Array, density: float, rate: Array | None
) -> SurfaceLoads:
    m, n = lattice.shape
    x = lattice.vertices
    sheet = Sheet(x, circulation)
    spanwise = _joukowski(
        sheet.spanwise_strength[:-1], velocity[: m * n], x[:-1, 1:] - x[:-1, :-1], density
    )
    streamwise = _joukowski(sheet.streamwise_strength, velocity[m * n :], x[1:] - x[:-1], density)
    upstream, downstream = _shares_of_ends(lattice)
    force = np.zeros_like(x)
    force[:-1, :-1] += 0.5 * spanwise
    force[:-1, 1:] += 0.5 * spanwise
    force[:-1] += upstream * streamwise
    force[1:] += downstream * streamwise
    borne = upstream + downstream
    strips = spanwise.sum(axis=0) + _shared_by_strips((borne * streamwise).sum(axis=0))
    corner_force = _on_corners(force, lattice.rings)
    if rate is not None:
        pressure = density * _panel_rate(rate, lattice.rings)[..., None] * lattice.area_vectors
        for part in (np.s_[:-1, :-1], np.s_[:-1, 1:], np.s_[1:, :-1], np.s_[1:, 1:]):
            corner_force[part] += 0.25 * pressure
        strips += pressure.sum(axis=0)
    return SurfaceLoads(lattice.corners, corner_force, strips)


def _panel_rate(rate: Array, rings: str) -> Array:
    """Rate (m,n) of the potential's jump at the middles of panels, from the rings' rates.

    A ring that stands on the quarters of two panels has the jump between them, where they meet.
    """
    if rings == "edges":
        return rate
    return 0.5 * (rate + np.concatenate([np.zeros_like(rate[:1]), rate[:-1]]))


def _shares_of_ends(lattice: Lattice) -> tuple[Array, Array]:
    """Shares (m,1,1) of a chordwise segment's load at its two ends.

    A half each, but for rings that reach a quarter of a panel beyond the trailing edge, where
    the wake bears no load. To count that quarter makes the lift by wind along the span wrong by
    its length.
    """
    upstream, downstream = np.full((2, lattice.shape[0], 1, 1), 0.5)
    if lattice.rings == "quarter_chord":
        on_surface = 0.75
        downstream[-1] = 0.5 * on_surface**2  # its middle stands at 3/8
        upstream[-1] = on_surface - downstream[-1]
    return upstream, downstream


def _joukowski(strength: Array, velocity: Array, segment: Array, density: float) -> Array:
    """rho G v x l, eq. (5), in the shape of the segments."""
    return density * strength[..., None] * cross_products(velocity.reshape(segment.shape), segment)


def _shared_by_strips(columns: Array) -> Array:
    """Forces (n+1,3) on the sides of strips as forces (n,3) on the strips."""
    share = 0.5 * (columns[:-1] + columns[1:])
    share[0] += 0.5 * columns[0]
    share[-1] += 0.5 * columns[-1]
    return share


def _on_corners(force: Array, rings: str) -> Array:
    """Forces on ring vertices as forces on corners: the transpose of ``Lattice.vertices``."""
    if rings == "edges":
        return force
    corners = force.copy()
    corners[:-1] -= 0.25 * force[:-1]
    corners[1:] += 0.25 * force[:-1]
    corners[-1] += 0.25 * force[-1]
    corners[-2] -= 0.25 * force[-1]
    return corners
