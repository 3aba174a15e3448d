"""A thin lifting surface cut into panels, and the vortex rings that stand on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from galerna.aero.vectors import cross_products
from galerna.contract import Array
from galerna.errors import InputError, did_you_mean

RINGS = ("quarter_chord", "edges")


@dataclass(eq=False)
class Lattice:
    """Panels (m,n) of a surface between corners (m+1,n+1,3) m.

    Rows run from the leading to the trailing edge, columns along the span; see ``sheet``.
    With ``rings`` "quarter_chord" a ring's upstream side lies on its panel's quarter chord and
    the collocation point on three quarters, which is exact for a flat plate in plane flow
    (James 1972); with "edges" rings and panels coincide and the point is the ring's centre.
    What follows from the corners is computed when it is first wanted, and kept.
    """

    corners: Array
    rings: str = "quarter_chord"

    def __post_init__(self) -> None:
        if self.rings not in RINGS:
            raise InputError("rings", f"{self.rings!r} is unknown", did_you_mean(self.rings, RINGS))

    @property
    def shape(self) -> tuple[int, int]:
        """Panels along the chord and along the span."""
        return self.corners.shape[0] - 1, self.corners.shape[1] - 1

    @cached_property
    def vertices(self) -> Array:
        """Corners (m+1,n+1,3) of the rings; the last row lies behind the trailing edge."""
        if self.rings == "edges":
            return self.corners
        panel = np.diff(self.corners, axis=0)
        return self.corners + 0.25 * np.concatenate([panel, panel[-1:]])

    @cached_property
    def collocation(self) -> Array:
        """Points (m,n,3) at which no flow passes through the surface."""
        place = 0.5 if self.rings == "edges" else 0.75
        along = (1.0 - place) * self.corners[:-1] + place * self.corners[1:]
        return 0.5 * (along[:, :-1] + along[:, 1:])

    @cached_property
    def area_vectors(self) -> Array:
        """Normals (m,n,3) times panel areas, m2, towards the suction side."""
        x = self.corners
        return 0.5 * cross_products(x[1:, 1:] - x[:-1, :-1], x[:-1, 1:] - x[1:, :-1])

    @cached_property
    def normals(self) -> Array:
        """Unit normals (m,n,3) of the surface at the collocation points, to the suction side.

        A panel is as steep as the curved surface at its middle. Where the point stands on three
        quarters the normals are interpolated to there, linearly along the chord: the lift of a
        parabolic camber line is exact with the slope at that point, while with the panel's own it
        lacks a share that falls only as 1/m.
        """
        normals = _unit(self.area_vectors)
        if self.rings == "edges" or len(normals) == 1:
            return normals
        length = np.linalg.norm(np.diff(self.corners, axis=0), axis=-1)
        length = 0.5 * (length[:, :-1] + length[:, 1:])
        middle = np.cumsum(length, axis=0) - 0.5 * length
        before = np.minimum(np.arange(len(normals)), len(normals) - 2)
        gap = middle[before + 1] - middle[before]
        share = ((middle + 0.25 * length - middle[before]) / gap)[..., None]
        return _unit((1.0 - share) * normals[before] + share * normals[before + 1])


def _unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
