"""The inflow of a machine: a mean wind over time and height, and a box of turbulence on it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.inflow import kernels
from galerna.inflow.box import Block, Box
from galerna.inflow.mean import Course, HubWind, Profile, Shear

NO_TOWER: Block = np.zeros((3, 2, 0), dtype=np.float32)


@dataclass(frozen=True, eq=False)
class WindField:
    """Wind velocity at any point and time: an ``Inflow`` of the contract.

    The hub wind follows ``course``, the speed follows ``profile`` over the height, and
    ``box`` adds turbulence, turned with the wind's direction and upflow about the hub's
    place on the tower axis and moved at the box's own mean speed. A point outside the
    box is an error; with ``held_below`` its lowest row holds down to the ground, with
    ``held_beyond`` its outermost values hold on every side and before and after it.
    Raises InputError if the box holds the mean wind and the profile would add another.
    """

    course: Course
    profile: Profile
    box: Box | None = None
    held_below: bool = False
    held_beyond: bool = False

    def __post_init__(self) -> None:
        in_box = self.box is not None and self.box.holds_mean
        if in_box != (self.profile.shear == Shear.IN_BOX):
            source = self.box.source if self.box is not None else "inflow"
            what = "holds the mean wind" if in_box else "does not hold the mean wind"
            raise InputError(source, what, "the mean wind belongs in the profile or in the box")

    def velocity(self, points: Array, time: float) -> Array:
        """Wind velocity (n,3) m/s at points (n,3) m, global axes; InputError outside the box."""
        points = np.ascontiguousarray(points, dtype=np.float64)
        out = np.empty(points.shape)
        wind = self.course.at(time)
        if self.box is None:
            kernels.mean_wind(points, wind, self.profile, out)
            return out
        outside = kernels.wind_with_box(
            points, time, wind, self.profile, self.box.data, self._tower, self._grid, out
        )
        if outside != kernels.INSIDE:
            raise self._not_held(points[outside], time, wind)
        return out

    def hub_wind(self, time: float) -> HubWind:
        """The mean wind at hub height at ``time`` s."""
        return self.course.at(time)

    def hub_velocity(self, time: float) -> Array:
        """Wind velocity (3,) m/s at hub height on the tower axis, turbulence included."""
        return self.velocity(np.array([[0.0, 0.0, self.profile.hub_height]]), time)[0]

    def held_everywhere(self) -> WindField:
        """The same wind without an end: beyond a box its outermost values hold."""
        return replace(self, held_beyond=True)

    def without_turbulence(self) -> WindField:
        """The mean wind alone."""
        if self.box is None or not self.box.holds_mean:
            return replace(self, box=None)
        return replace(self, box=self.box.mean_over_time())

    @cached_property
    def _grid(self) -> kernels.Grid:
        assert self.box is not None
        box = self.box
        dx, dy, dz = box.spacing
        return kernels.Grid(
            float(dx),
            float(dy),
            float(dz),
            float(box.mean_speed),
            float(box.lead),
            -0.5 * box.width,
            float(box.bottom),
            bool(box.periodic),
            self.held_below or self.held_beyond,
            self.held_beyond,
        )

    @cached_property
    def _tower(self) -> Block:
        assert self.box is not None
        return NO_TOWER if self.box.tower is None else self.box.tower

    def _not_held(self, point: Array, time: float, wind: HubWind) -> InputError:
        """The error for a point (3,) m that the box does not hold."""
        assert self.box is not None
        c, s = np.cos(wind.direction), np.sin(wind.direction)
        cu, su = np.cos(wind.upflow), np.sin(wind.upflow)
        hub = np.array([0.0, 0.0, self.profile.hub_height])
        to_wind = np.array([[c * cu, s * cu, su], [-s, c, 0.0], [-c * su, -s * su, cu]])
        with np.errstate(invalid="ignore"):  # a point that is not a number has no place
            x, y, z = to_wind @ (point - hub) + hub
        at = f"the point ({', '.join(f'{p:.6g}' for p in point)}) m at t = {time:.6g} s"
        reasons = self.box.missing(x, y, z, time)
        hint = (
            "make the box larger, or move it"
            if reasons
            else "the point or the time is not a number"
        )
        return InputError(self.box.source, f"does not hold {at}: " + "; ".join(reasons), hint)
