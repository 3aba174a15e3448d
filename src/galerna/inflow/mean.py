"""The mean wind: what it is at hub height over time, and how it changes with height."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError


class HubWind(NamedTuple):
    """The wind at hub height at one time; speeds m/s, angles rad, gradients 1/s.

    ``direction`` turns the wind about +z: 0 blows along x, pi/2 along y, so the yaw
    error is the nacelle's yaw minus it. ``upflow`` lifts it. ``gust`` adds to the
    speed at every height, where ``speed`` follows the profile. The gradients add to
    the speed with the distance from the hub to the left and upwards.
    ``vertical_speed`` is across the wind, upwards at zero upflow.
    """

    speed: float
    direction: float = 0.0
    upflow: float = 0.0
    gust: float = 0.0
    lateral_gradient: float = 0.0
    vertical_gradient: float = 0.0
    vertical_speed: float = 0.0


class Shear(IntEnum):
    """How the mean speed follows the height."""

    NONE = 0
    POWER_LAW = 1
    LOGARITHMIC = 2
    LINEAR = 3
    IN_BOX = 4  #: the turbulence box holds the mean wind


class Profile(NamedTuple):
    """Mean speed over height, relative to that at ``hub_height`` m; shear ends at the ground.

    ``parameter`` is the exponent, the roughness length m, or the relative gradient
    1/m. ``veer`` rad/m turns the wind about +z with height above the hub.
    """

    hub_height: float
    shear: int = 0  #: a Shear, as a plain int: compiled code takes that much faster
    parameter: float = 0.0
    veer: float = 0.0

    @classmethod
    def power_law(cls, hub_height: float, exponent: float, veer: float = 0.0) -> Self:
        """(z / hub_height)^exponent (IEC 61400-1, eq. 10)."""
        return cls(hub_height, int(Shear.POWER_LAW), exponent, veer)

    @classmethod
    def logarithmic(cls, hub_height: float, roughness_length: float, veer: float = 0.0) -> Self:
        """log(z / z0) / log(hub_height / z0); InputError unless 0 < z0 < hub_height."""
        if not 0.0 < roughness_length < hub_height:
            what = f"{roughness_length:g} m, expected more than 0 and less than {hub_height:g} m"
            raise InputError("roughness length", what)
        return cls(hub_height, int(Shear.LOGARITHMIC), roughness_length, veer)

    @classmethod
    def linear(cls, hub_height: float, gradient: float, veer: float = 0.0) -> Self:
        """1 + gradient (z - hub_height)."""
        return cls(hub_height, int(Shear.LINEAR), gradient, veer)

    @classmethod
    def in_box(cls, hub_height: float) -> Self:
        """Nothing: the box that goes with it holds the mean wind."""
        return cls(hub_height, int(Shear.IN_BOX))


class Course(Protocol):
    """The hub wind over time; immutable."""

    def at(self, time: float) -> HubWind: ...


@dataclass(frozen=True)
class Steady:
    """A wind that does not change."""

    wind: HubWind

    def at(self, time: float) -> HubWind:
        """The hub wind, the same at any ``time`` s."""
        return self.wind


class TimeSeries:
    """A hub wind linear between given times, held before the first and after the last.

    ``time`` (n,) s ascends; every other argument is a field of HubWind, a number or
    (n,) numbers. Directions may step over +-180 deg: the short way round is taken.
    Raises InputError for times out of order, lengths that differ, NaN.
    """

    def __init__(
        self, time: ArrayLike, *, source: str = "wind time series", **fields: ArrayLike
    ) -> None:
        self._source = source
        self._time = self._finite("time", time)
        if self._time.ndim != 1 or len(self._time) < 2 or np.any(np.diff(self._time) <= 0.0):
            raise InputError(source, "times must be two or more, each later than the last")
        columns = {name: self._column(name, values) for name, values in fields.items()}
        columns["direction"] = np.unwrap(columns.get("direction", np.zeros_like(self._time)))
        rows = zip(*columns.values(), strict=True)
        self._times = self._time.tolist()
        self._rows = [HubWind(**dict(zip(columns, map(float, row), strict=True))) for row in rows]

    def _column(self, name: str, values: ArrayLike) -> Array:
        column = self._finite(name, values)
        if column.shape not in ((), self._time.shape):
            what = f"{name} has {column.size} values for {len(self._time)} times"
            raise InputError(self._source, what)
        return np.broadcast_to(column, self._time.shape)

    def _finite(self, name: str, values: ArrayLike) -> Array:
        column = np.asarray(values, dtype=np.float64)
        if not math.isfinite(float(column.sum())):
            raise InputError(self._source, f"{name} holds values that are not finite numbers")
        return column

    @property
    def end(self) -> float:
        """Last time s."""
        return float(self._time[-1])

    def turned(self, direction: float, upflow: float) -> TimeSeries:
        """The same series with a direction and an upflow, rad, added at every time."""
        fields = dict(zip(HubWind._fields, np.array(self._rows).T, strict=True))
        fields["direction"] = fields["direction"] + direction
        fields["upflow"] = fields["upflow"] + upflow
        return TimeSeries(self._time, source=self._source, **fields)

    def mean_speed(self, duration: float) -> float:
        """Mean of the speed m/s from time 0 to ``duration`` s."""
        inside = self._time[(self._time > 0.0) & (self._time < duration)]
        time = np.concatenate([[0.0], inside, [duration]])
        speed = np.array([self.at(t).speed for t in time])
        return float(np.trapezoid(speed, time) / duration)

    def at(self, time: float) -> HubWind:
        """The hub wind at ``time`` s."""
        after = bisect_right(self._times, time)
        if after == 0:
            return self._rows[0]
        if after == len(self._times):
            return self._rows[-1]
        t0, t1 = self._times[after - 1], self._times[after]
        s = (time - t0) / (t1 - t0)
        pairs = zip(self._rows[after - 1], self._rows[after], strict=True)
        return HubWind(*[a + s * (b - a) for a, b in pairs])
