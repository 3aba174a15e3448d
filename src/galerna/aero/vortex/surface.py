"""A lifting surface at an instant: where its lattice is and how it moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vortex.lattice import Lattice
from galerna.contract import Array


@dataclass(eq=False)
class Surface:
    """A lattice whose corners (m+1,n+1,3) move at ``velocity`` (m+1,n+1,3) m/s.

    The rings' vertices and the collocation points are linear in the corners, so the lattice of
    the corners' velocities holds their velocities.
    """

    lattice: Lattice
    velocity: Array

    @classmethod
    def at_rest(cls, corners: Array, rings: str = "quarter_chord") -> Surface:
        """A surface that stands still."""
        corners = np.asarray(corners, dtype=float)
        return cls(Lattice(corners, rings), np.zeros_like(corners))

    @classmethod
    def turning(
        cls,
        corners: Array,
        rotation: ArrayLike,
        center: ArrayLike = (0.0, 0.0, 0.0),
        rings: str = "quarter_chord",
    ) -> Surface:
        """A rigid surface that turns at ``rotation`` (3,) rad/s about ``center`` (3,) m."""
        corners = np.asarray(corners, dtype=float)
        arm = corners - np.asarray(center, dtype=float)
        return cls(Lattice(corners, rings), np.cross(np.asarray(rotation, dtype=float), arm))

    @property
    def shape(self) -> tuple[int, int]:
        """Panels along the chord and along the span."""
        return self.lattice.shape

    @cached_property
    def moving(self) -> Lattice:
        """Velocities m/s of all points of the lattice, in their places."""
        return Lattice(self.velocity, self.lattice.rings)

    @property
    def collocation_velocity(self) -> Array:
        """Velocity (m,n,3) m/s of the collocation points."""
        return self.moving.collocation

    @property
    def segment_velocity(self) -> Array:
        """Velocity (s,3) m/s of the middles of the loaded segments; see ``segment_middles``."""
        return segment_middles(self.moving.vertices)


def segment_middles(vertices: Array) -> Array:
    """Middles (m*n + m*(n+1), 3) of the loaded segments between vertices (m+1,n+1,3).

    First the m*n segments along the span, then the m*(n+1) along the chord. Those along the
    trailing edge carry no load (the Kutta condition) and are left out.
    """
    along_span = 0.5 * (vertices[:-1, :-1] + vertices[:-1, 1:])
    along_chord = 0.5 * (vertices[:-1] + vertices[1:])
    return np.concatenate([along_span.reshape(-1, 3), along_chord.reshape(-1, 3)])


def collocation_points(surfaces: Sequence[Surface]) -> Array:
    """Collocation points (N,3) m of all surfaces, one after the other, rows first."""
    return np.concatenate([s.lattice.collocation.reshape(-1, 3) for s in surfaces])


def collocation_velocities(surfaces: Sequence[Surface]) -> Array:
    """Velocities (N,3) m/s of ``collocation_points``."""
    return np.concatenate([s.collocation_velocity.reshape(-1, 3) for s in surfaces])


def collocation_normals(surfaces: Sequence[Surface]) -> Array:
    """Unit normals (N,3) at ``collocation_points``."""
    return np.concatenate([s.lattice.normals.reshape(-1, 3) for s in surfaces])


def segment_points(surfaces: Sequence[Surface]) -> Array:
    """Middles (S,3) m of the loaded segments of all surfaces, as in ``segment_middles``."""
    return np.concatenate([segment_middles(s.lattice.vertices) for s in surfaces])


def segment_velocities(surfaces: Sequence[Surface]) -> Array:
    """Velocities (S,3) m/s of ``segment_points``."""
    return np.concatenate([s.segment_velocity for s in surfaces])


def split_panels(values: Array, surfaces: Sequence[Surface]) -> list[Array]:
    """A value per panel (N,...) of all surfaces as one array (m,n,...) per surface."""
    ends = np.cumsum([s.shape[0] * s.shape[1] for s in surfaces])[:-1]
    parts = np.split(values, ends)
    return [p.reshape(s.shape + p.shape[1:]) for p, s in zip(parts, surfaces, strict=True)]
