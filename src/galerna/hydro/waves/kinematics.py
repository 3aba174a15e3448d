"""How the water moves under waves of the first order (Airy), and up to their crests."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError, did_you_mean
from galerna.hydro.waves.sea import Sea
from galerna.hydro.waves.series import FAST, Complex, Series, cubic, tabulate

STRETCHINGS = ("none", "vertical", "extrapolation", "wheeler")
_NONE, _VERTICAL, _EXTRAPOLATION, _WHEELER = range(4)

_TOLERANCE = 1e-3  #: error between levels over the standard deviation at the uppermost one
_SCALES = (4.0, 1.0, 0.25)  #: m below z = 0 where levels may stand twice as far apart as there
_COUNTS = (4, 6, 8, 11, 16, 23, 32, 45, 64, 90)  #: of levels; the fewest that do are taken


def profiles(sea: Sea, height: ArrayLike) -> tuple[Array, Array]:
    """cosh k(z+h) / sinh kh and sinh k(z+h) / sinh kh (n,m) at heights (m,) m, 0 at most."""
    z, k = np.atleast_1d(np.asarray(height, dtype=float)), sea.wavenumber[:, None]
    down = np.exp(k * z)
    up = np.exp(-k * (z + 2.0 * sea.depth))
    scale = 1.0 - np.exp(-2.0 * k * sea.depth)
    return (down + up) / scale, (down - up) / scale


def velocity_transfer(sea: Sea, points: ArrayLike) -> Complex:
    """Velocity (n,m,3) m/s over an elevation's amplitude at points (m,3) m, z at most 0."""
    at = np.atleast_2d(np.asarray(points, dtype=float))
    along, upward = profiles(sea, at[:, 2])
    return _velocity(sea, along, upward) * sea.spread(at[:, :2])[:, :, None]


def acceleration_transfer(sea: Sea, points: ArrayLike) -> Complex:
    """Acceleration (n,m,3) m/s2 likewise, without the convective part of second order."""
    return 1j * sea.frequency[:, None, None] * velocity_transfer(sea, points)


def pressure_transfer(sea: Sea, points: ArrayLike) -> Complex:
    """Dynamic pressure (n,m) Pa over an elevation's amplitude at points (m,3) m, z at most 0."""
    at = np.atleast_2d(np.asarray(points, dtype=float))
    along, _ = profiles(sea, at[:, 2])
    scale = sea.density * sea.frequency**2 / sea.wavenumber
    return np.asarray(scale[:, None] * along * sea.spread(at[:, :2]))


def _velocity(sea: Sea, along: Array, upward: Array) -> Complex:
    """Velocities (n,m,3) of the profiles (n,m), above the origin."""
    w, course = sea.frequency[:, None], sea.direction[:, None]
    x, y = w * along * np.cos(course), w * along * np.sin(course)
    return np.stack([x + 0j, y + 0j, 1j * w * upward], axis=2)


@dataclass(frozen=True, eq=False)
class WaterColumns:
    """Elevation and water velocity in c columns that stand still, as one table over time.

    A row of ``series`` holds for each column the elevation, for ``extrapolation`` the
    velocity's slope over z at the still water, and the velocities at the column's levels. These
    are even in s = log(1 - z / scale); between them goes a cubic. ``layout`` (c,5): first
    column of the table, number of levels, s of the uppermost, step of s, scale m.
    """

    series: Series
    layout: Array
    stretching: int
    depth: float


def water_columns(
    sea: Sea, places: Array, tops: Array, bottoms: Array, stretching: str = "wheeler"
) -> WaterColumns:
    """Tables of the columns at ``places`` (c,2) m from ``bottoms`` to ``tops`` (c,) m, at most 0.

    Velocities err between levels by less than 1e-3 of the standard deviation at the column's
    top, between times by less than 3e-4. Raises InputError for an unknown stretching.
    """
    if stretching not in STRETCHINGS:
        hint = did_you_mean(stretching, STRETCHINGS)
        raise InputError("sea.stretching", f"{stretching!r} is not known", hint)
    mode = STRETCHINGS.index(stretching)
    spans = list(zip(tops.tolist(), bottoms.tolist(), strict=True))
    found = {span: _levels(sea, *span) for span in set(spans)}
    levels = [found[span] for span in spans]
    extra = 4 if mode == _EXTRAPOLATION else 1
    first = np.cumsum([0, *(3 * len(level.s) + extra for level in levels)])
    samples = sea.samples(_fastest(sea, float(np.max(tops, initial=-np.inf))))
    table = np.empty((samples, first[-1]), dtype=np.float32)
    for column, (place, level) in enumerate(zip(places, levels, strict=True)):
        spectrum = sea.amplitude[:, None] * _column_transfer(sea, place, level, mode)
        table[:, first[column] : first[column + 1]] = tabulate(spectrum, sea.order, samples)
    rows = [[f, *level.layout] for f, level in zip(first, levels, strict=False)]
    layout = np.array(rows, dtype=float).reshape(-1, 5)
    return WaterColumns(Series(table, sea.period / samples, sea.ramp), layout, mode, sea.depth)


class _Levels(NamedTuple):
    """Levels even in s (p,) = log(1 - z / scale)."""

    s: Array
    scale: float

    @classmethod
    def between(cls, top: float, bottom: float, scale: float, count: int) -> _Levels:
        return cls(np.linspace(np.log1p(-top / scale), np.log1p(-bottom / scale), count), scale)

    @property
    def layout(self) -> tuple[float, float, float, float]:
        return len(self.s), self.s[0], self.s[1] - self.s[0], self.scale

    def height(self, s: Array) -> Array:
        return np.asarray(-self.scale * np.expm1(s))


def _levels(sea: Sea, top: float, bottom: float) -> _Levels:
    """The fewest levels that follow the velocity from ``top`` to ``bottom`` m.

    Raises InputError where not even the most do.
    """
    weight = np.abs(sea.amplitude * sea.frequency) ** 2
    for count, scale in product(_COUNTS, _SCALES):
        levels = _Levels.between(top, bottom, scale, count)
        if _error_between(sea, levels, weight) <= _TOLERANCE:
            return levels
    what = f"{_COUNTS[-1]} levels from {bottom:.4g} to {top:.4g} m do not resolve its short waves"
    raise InputError("sea.waves", what, "lower highest_frequency_hz")


def _error_between(sea: Sea, levels: _Levels, weight: Array) -> float:
    """Largest error halfway between levels, over the deviation at the first."""
    at_levels, _ = profiles(sea, levels.height(levels.s))
    at_first = weight @ at_levels[:, 0] ** 2
    if at_first == 0.0:
        return 0.0
    middle = 0.5 * (levels.s[1:] + levels.s[:-1])
    between, _ = profiles(sea, levels.height(middle))
    for j in range(len(middle)):
        i = min(max(j - 1, 0), len(levels.s) - 4)
        weights = np.array(cubic(j + 0.5 - i - 1.0))
        between[:, j] -= at_levels[:, i : i + 4] @ weights
    return float(np.sqrt((weight @ between**2).max() / at_first))


def _fastest(sea: Sea, top: float) -> Complex:
    """Transfers (n,2) that vary most quickly over time: of the elevation and the velocity."""
    along, _ = profiles(sea, min(top, 0.0) if np.isfinite(top) else 0.0)
    return np.concatenate([np.ones_like(along), sea.frequency[:, None] * along], axis=1) + 0j


def _column_transfer(sea: Sea, place: Array, levels: _Levels, mode: int) -> Complex:
    """Transfers (n, 1 + 3p or 4 + 3p) of a row's part for one column."""
    velocity = _velocity(sea, *profiles(sea, levels.height(levels.s)))
    parts = [
        np.ones((len(sea.frequency), 1)),
        velocity.reshape(len(sea.frequency), 3 * len(levels.s)),
    ]
    if mode == _EXTRAPOLATION:
        along, upward = profiles(sea, 0.0)
        k = sea.wavenumber[:, None]
        parts.insert(1, _velocity(sea, k * upward, k * along)[:, 0])
    return np.asarray(np.concatenate(parts, axis=1) * sea.spread(place))


@njit(cache=True, error_model="numpy", fastmath=FAST)
def surface(row: Array, layout: Array, column: int, stretching: int) -> float:
    """Height m up to which there is water in a column."""
    return 0.0 if stretching == _NONE else row[int(layout[column, 0])]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def water_velocity(
    row: Array, layout: Array, column: int, z: float, stretching: int, depth: float
) -> tuple[float, float, float]:
    """Velocity of the water in a column at a height z m, at most that of its surface."""
    first, count = int(layout[column, 0]) + 1, int(layout[column, 1])
    above = max(z, 0.0)
    if stretching == _WHEELER:
        elevation = row[first - 1]
        z = (z - elevation) / (1.0 + elevation / depth)
    tangent = first
    if stretching == _EXTRAPOLATION:
        first += 3
    top, step, scale = layout[column, 2], layout[column, 3], layout[column, 4]
    position = min(max((np.log1p(-min(z, 0.0) / scale) - top) / step, 0.0), count - 1.0)
    i = min(max(int(position) - 1, 0), count - 4)
    w = cubic(position - i - 1.0)
    x = y = up = 0.0
    for m in range(4):
        k = first + 3 * (i + m)
        x += w[m] * row[k]
        y += w[m] * row[k + 1]
        up += w[m] * row[k + 2]
    if stretching == _EXTRAPOLATION:
        x += above * row[tangent]
        y += above * row[tangent + 1]
        up += above * row[tangent + 2]
    return x, y, up
