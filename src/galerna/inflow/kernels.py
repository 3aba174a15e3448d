"""Compiled loops over points: the mean wind, and the box interpolated onto it.

Angles, axes and names are those of ``mean.HubWind``, ``mean.Profile`` and
``box.Box``; the frame of the wind has its origin at hub height on the tower axis.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from galerna.contract import Array
from galerna.inflow.box import Block
from galerna.inflow.mean import HubWind, Profile, Shear

NONE, POWER_LAW, LOGARITHMIC = int(Shear.NONE), int(Shear.POWER_LAW), int(Shear.LOGARITHMIC)
LINEAR = int(Shear.LINEAR)
INSIDE = -1  #: answer of ``wind_with_box`` if the box holds every point
FARTHEST = 1e15  #: cells from a box, where it may still be held beyond its sides
SLACK = 1e-4  #: cells that a point may stand beyond the last row: rounding of float32 headers

compiled = njit(
    cache=True, error_model="numpy", fastmath={"reassoc", "contract", "arcp", "nsz", "afn"}
)


class Grid(NamedTuple):
    """Where a box is: spacings m, left edge and bottom m, and what holds beyond it."""

    dx: float
    dy: float
    dz: float
    speed: float
    lead: float
    right_edge: float
    bottom: float
    periodic: bool
    held_below: bool
    held_beyond: bool


@compiled
def relative_speed(profile: Profile, height: float) -> float:
    """Mean speed at a height m over that at the hub."""
    if profile.shear == NONE:
        return 1.0
    if height <= 0.0:
        return 0.0
    if profile.shear == POWER_LAW:
        return (height / profile.hub_height) ** profile.parameter
    if profile.shear == LOGARITHMIC:
        ratio = math.log(height / profile.parameter)
        return max(0.0, ratio / math.log(profile.hub_height / profile.parameter))
    if profile.shear == LINEAR:
        return max(0.0, 1.0 + profile.parameter * (height - profile.hub_height))
    return 0.0


@compiled
def mean_speed(wind: HubWind, profile: Profile, lateral: float, height: float) -> float:
    """Speed m/s along the wind, ``lateral`` m to the left of the hub."""
    gradients = wind.lateral_gradient * lateral + wind.vertical_gradient * (
        height - profile.hub_height
    )
    return wind.speed * relative_speed(profile, height) + wind.gust + gradients


@compiled
def store(
    out: Array,
    i: int,
    wind: HubWind,
    profile: Profile,
    height: float,
    u: float,
    v: float,
    w: float,
) -> None:
    """Turn (u, v, w) m/s of the wind's frame into global axes: upflow, direction, veer."""
    direction = wind.direction + profile.veer * (height - profile.hub_height)
    c, s = math.cos(direction), math.sin(direction)
    cu, su = math.cos(wind.upflow), math.sin(wind.upflow)
    along = cu * u - su * w
    out[i, 0] = c * along - s * v
    out[i, 1] = s * along + c * v
    out[i, 2] = su * u + cu * w


@compiled
def mean_wind(points: Array, wind: HubWind, profile: Profile, out: Array) -> None:
    """Velocity (n,3) m/s of the mean wind at points (n,3) m."""
    c, s = math.cos(wind.direction), math.sin(wind.direction)
    for i in range(points.shape[0]):
        height = points[i, 2]
        lateral = c * points[i, 1] - s * points[i, 0]
        u = mean_speed(wind, profile, lateral, height)
        store(out, i, wind, profile, height, u, 0.0, wind.vertical_speed)


@compiled
def wind_with_box(
    points: Array,
    time: float,
    wind: HubWind,
    profile: Profile,
    data: Block,
    tower: Block,
    grid: Grid,
    out: Array,
) -> int:
    """Velocity (n,3) m/s at points (n,3) m of the mean wind with a box on top of it.

    Answers INSIDE, or the number of the first point that the box does not hold.
    """
    c, s = math.cos(wind.direction), math.sin(wind.direction)
    cu, su = math.cos(wind.upflow), math.sin(wind.upflow)
    for n in range(points.shape[0]):
        height = points[n, 2]
        above = height - profile.hub_height
        along = c * points[n, 0] + s * points[n, 1]
        lateral = c * points[n, 1] - s * points[n, 0]
        passed = grid.speed * time + grid.lead - (cu * along + su * above)
        place = profile.hub_height + cu * above - su * along
        held, u, v, w = fluctuation(data, tower, grid, passed, lateral, place)
        if not held:
            return n
        u += mean_speed(wind, profile, lateral, height)
        store(out, n, wind, profile, height, u, v, w + wind.vertical_speed)
    return INSIDE


@compiled
def fluctuation(
    data: Block, tower: Block, grid: Grid, passed: float, lateral: float, height: float
) -> tuple[bool, float, float, float]:
    """Whether the box holds a point, and (u, v, w) m/s there, trilinear.

    ``passed`` m of the box have gone by; NaN fails every comparison and is not held.
    """
    _, nx, ny, nz = data.shape
    rows = tower.shape[2]
    x = passed / grid.dx
    y = (lateral - grid.right_edge) / grid.dy
    z = (height - grid.bottom) / grid.dz
    if grid.periodic:
        x -= nx * math.floor(x / nx)
    in_time = x >= -SLACK and (grid.periodic or x <= nx - 1 + SLACK) and x <= nx
    inside = in_time and y >= -SLACK and y <= ny - 1 + SLACK and z <= nz - 1 + SLACK
    if not (inside or (grid.held_beyond and abs(x) + abs(y) + abs(z) < FARTHEST)):
        return False, 0.0, 0.0, 0.0
    i, fx = cell(x, nx, grid.periodic)
    next_i = i + 1 if i + 1 < nx else 0
    if z >= -SLACK or (grid.held_below and rows < 2):
        j, fy = cell(y, ny, False)
        k, fz = cell(z, nz, False)
        u = trilinear(data[0], i, next_i, j, k, fx, fy, fz)
        v = trilinear(data[1], i, next_i, j, k, fx, fy, fz)
        w = trilinear(data[2], i, next_i, j, k, fx, fy, fz)
        return True, u, v, w
    if rows >= 2 and (grid.held_below or -z <= rows - 1 + SLACK):
        k, fz = cell(-z, rows, False)
        u = bilinear(tower[0], i, next_i, k, fx, fz)
        v = bilinear(tower[1], i, next_i, k, fx, fz)
        w = bilinear(tower[2], i, next_i, k, fx, fz)
        return True, u, v, w
    return False, 0.0, 0.0, 0.0


@compiled
def cell(position: float, n: int, periodic: bool) -> tuple[int, float]:
    """Lower neighbour among n rows, and the fraction of the way to the next one."""
    last = n - 1 if periodic else n - 2
    lower = min(max(math.floor(position), 0), last)
    return lower, min(max(position - lower, 0.0), 1.0)


@compiled
def trilinear(
    f: Block, i: int, next_i: int, j: int, k: int, fx: float, fy: float, fz: float
) -> float:
    """Value between the eight points around a place in one component (nx,ny,nz)."""
    return (1.0 - fx) * bilinear(f[i], j, j + 1, k, fy, fz) + fx * bilinear(
        f[next_i], j, j + 1, k, fy, fz
    )


@compiled
def bilinear(f: Block, i: int, next_i: int, k: int, fi: float, fk: float) -> float:
    """Value between the points (i, next_i) and (k, k + 1) of a plane (n,m)."""
    low = (1.0 - fi) * f[i, k] + fi * f[next_i, k]
    high = (1.0 - fi) * f[i, k + 1] + fi * f[next_i, k + 1]
    return (1.0 - fk) * low + fk * high
