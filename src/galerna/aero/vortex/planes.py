"""Velocity in the flow: at points, in planes, along lines."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vortex.options import PlaneOptions
from galerna.aero.vortex.vtk import Patch
from galerna.contract import Array
from galerna.errors import InputError

if TYPE_CHECKING:
    import xarray

Velocity = Callable[[Array], Array]  #: of points (...,3) m, in m/s


@dataclass(frozen=True, eq=False)
class Plane:
    """A parallelogram in the flow, with ``points`` (p,q,3) m along its two sides.

    ``corner`` (3,) m; ``first_side`` and ``second_side`` (3,) m lead from it to its neighbours.
    Raises InputError for sides that span no area, or fewer than two points on one.
    """

    corner: Array
    first_side: Array
    second_side: Array
    shape: tuple[int, int] = (41, 41)

    def __post_init__(self) -> None:
        for name in ("corner", "first_side", "second_side"):
            vector = np.asarray(getattr(self, name), dtype=float)
            if vector.shape != (3,) or not np.isfinite(vector).all():
                raise InputError(f"plane, {name}", "is not three finite numbers")
            object.__setattr__(self, name, vector)
        sides = np.linalg.norm(self.first_side) * np.linalg.norm(self.second_side)
        if np.linalg.norm(np.cross(self.first_side, self.second_side)) <= 1e-9 * sides:
            raise InputError("plane", "its sides span no area", "give two that are not parallel")
        if min(self.shape) < 2:
            raise InputError("plane", f"expected two points a side or more, found {self.shape}")

    @classmethod
    def of(cls, options: PlaneOptions) -> Plane:
        """The plane of a case's block."""
        corner, first, second = (
            np.array(side)
            for side in (options.corner_m, options.first_side_m, options.second_side_m)
        )
        return cls(corner, first, second, options.points)

    @classmethod
    def across(cls, center: ArrayLike, size: float, points: int = 41) -> Plane:
        """A vertical square of ``size`` m across the x axis about ``center`` (3,) m."""
        corner = np.asarray(center, dtype=float) - 0.5 * size * np.array([0.0, 1.0, 1.0])
        sides = size * np.eye(3)
        return cls(corner, sides[1], sides[2], (points, points))

    @property
    def points(self) -> Array:
        """Points (p,q,3) m, the corner first."""
        first, second = (np.linspace(0.0, 1.0, n) for n in self.shape)
        return (
            self.corner
            + first[:, None, None] * self.first_side
            + second[None, :, None] * self.second_side
        )

    def patch(self, velocity: Velocity) -> Patch:
        """The plane with the velocity at its points, for a file."""
        points = self.points
        return Patch(points, {"velocity [m/s]": velocity(points)})

    def dataset(self, velocity: Velocity) -> xarray.Dataset:
        """Velocity and position (p,q,3) with units, along the distances from the corner in m."""
        import xarray

        points = self.points
        along = [
            np.linalg.norm(side) * np.linspace(0.0, 1.0, n)
            for side, n in zip((self.first_side, self.second_side), self.shape, strict=True)
        ]
        dims = ("first", "second", "component")
        made = xarray.Dataset(
            {
                "velocity": (dims, velocity(points), {"units": "m/s", "long_name": "velocity"}),
                "position": (dims, points, {"units": "m", "long_name": "position"}),
            },
            coords={"first": along[0], "second": along[1], "component": ["x", "y", "z"]},
        )
        for name in ("first", "second"):
            made[name].attrs.update(units="m", long_name=f"distance along the {name} side")
        return made
