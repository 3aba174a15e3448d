"""A plane that no flow crosses: the ground below a rotor, or the middle of a symmetric flow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """The plane through ``point`` (3,) m across ``normal`` (3,), of any length but zero.

    The image of a flow u is M u(M x), with M the reflection in the plane; the sum of a flow
    and its image does not cross the plane.
    """

    point: Array
    normal: Array

    def __post_init__(self) -> None:
        for name in ("point", "normal"):
            vector = np.asarray(getattr(self, name), dtype=float)
            if vector.shape != (3,) or not np.isfinite(vector).all():
                raise InputError(f"mirror plane {name}", "is not three finite numbers")
            object.__setattr__(self, name, vector)
        length = np.linalg.norm(self.normal)
        if length == 0.0:
            raise InputError(
                "mirror plane normal", "is zero", "give the direction across the plane"
            )
        object.__setattr__(self, "normal", self.normal / length)

    def reflect_points(self, points: Array) -> Array:
        """Mirror images (...,3) m of points (...,3) m."""
        return self.point + self.reflect_vectors(np.asarray(points) - self.point)

    def reflect_vectors(self, vectors: Array) -> Array:
        """Mirror images (...,3) of free vectors (...,3), velocities for instance."""
        vectors = np.asarray(vectors)
        return vectors - 2.0 * (vectors @ self.normal)[..., None] * self.normal
