"""Rotational symmetry: a rotor in axial flow is one blade and its turned images."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from galerna.contract import Array


@dataclass(frozen=True, eq=False)
class RotationalSymmetry:
    """``order`` equal sectors about the axis through ``center`` (3,) m along ``axis`` (3,)."""

    order: int
    axis: Array
    center: Array

    @cached_property
    def rotations(self) -> Array:
        """Rotations (order,3,3) from the first sector to each."""
        unit = np.asarray(self.axis, dtype=float) / np.linalg.norm(self.axis)
        angles = 2.0 * np.pi * np.arange(self.order) / self.order
        return Rotation.from_rotvec(angles[:, None] * unit).as_matrix()

    def images(self, points: Array) -> list[Array]:
        """Points (...,3) m of the first sector as they stand in each."""
        return [self.center + (points - self.center) @ turn.T for turn in self.rotations]

    def sum_of_sectors(self, of_first: Callable[[Array], Array], points: Array) -> Array:
        """Vectors (k,...,3) at points (k,3) m by all sectors, each the first one's turned.

        ``of_first`` gives those of the first sector, and is asked once, at the points as they
        stand to each sector.
        """
        seen = [self.center + (points - self.center) @ turn for turn in self.rotations]
        vectors = of_first(np.concatenate(seen))
        parts = vectors.reshape(self.order, *points.shape[:1], *vectors.shape[1:])
        return np.einsum("bac,b...c->...a", self.rotations, parts)

    def turn_vectors(self, vectors: Array, sector: int) -> Array:
        """Vectors (...,3) of the first sector as they stand in another."""
        return vectors @ self.rotations[sector].T


def sector_of(
    points: Sequence[Array], axis: Array, center: Array, tolerance: float = 1e-9
) -> RotationalSymmetry | None:
    """The symmetry whose sectors hold these points (...,3) m each in turn; None if they do not.

    The sectors may follow each other in either sense; ``tolerance`` is relative to the
    greatest distance from the center.
    """
    if len({p.shape for p in points}) != 1:
        return None
    size = np.linalg.norm(points[0] - center, axis=-1).max()
    for sense in (1.0, -1.0):
        symmetry = RotationalSymmetry(len(points), sense * np.asarray(axis, float), center)
        images = symmetry.images(points[0])
        apart = max(np.abs(a - b).max() for a, b in zip(images, points, strict=True))
        if apart <= tolerance * size:
            return symmetry
    return None
