"""Viscous drag of the water on a platform's members (Morison), as a load model."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.contract import Array, Channel, Loads, Motion, Stations
from galerna.hydro.strips import Carrier, Strips, columns_of, platform_strips
from galerna.hydro.waves.kinematics import WaterColumns, surface, water_columns, water_velocity
from galerna.hydro.waves.sea import Sea
from galerna.hydro.waves.series import FAST, growth, sample
from galerna.turbine.platform import Platform

REACH = 10.0  #: m above and below a strip's place where the water's velocity is tabulated

_AXES = ("x", "y", "z")
CHANNELS = tuple(
    Channel(f"viscous_drag_{kind}_{axis}", unit, f"viscous drag on the platform, {kind} {place}")
    for kind, unit, place in (("force", "N", "along"), ("moment", "N m", "about"))
    for axis, place in ((axis, f"{place} {axis}") for axis in _AXES)
)

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]  # its rows
Integers = NDArray[np.int64]


class ViscousDrag:
    """Drag of waves and current on the strips of a platform's members; it has no memory.

    Per length 1/2 rho C_d D |v| v, v the water's velocity across the axis less the strip's own;
    of exposed ends the same along the axis with their area. Strips are wet up to the
    elevation, or without ``stretching`` up to the still water. As the theory is of first
    order, the water's velocity is that at the strip's place in the platform as described, but
    at the height where the strip is (``_columns``). ``carrier`` says what the strips ride
    on: the platform as one body unless given. The channels' moment is about its first frame.
    Error of the strips at 1 m ``spacing``: see docs/theory/waves.md.
    """

    channels: tuple[Channel, ...] = CHANNELS
    largest_step: float = inf

    def __init__(
        self,
        platform: Platform,
        sea: Sea,
        *,
        stretching: str = "wheeler",
        carrier: Carrier | None = None,
        spacing: float = 1.0,
    ) -> None:
        carrier = Carrier.rigid(platform) if carrier is None else carrier
        self.strips = platform_strips(platform.members, spacing)
        self.stations: tuple[Stations, ...] = (carrier.stations,)
        self.coordinates: Mapping[str, Array] = {}
        self._water, column = _columns(self.strips, sea, stretching)
        frame, geometry = _mounted(self.strips, carrier)
        self._index = np.stack([frame, column], axis=1)
        self._geometry = geometry
        self._figures = _figures(self.strips, sea)
        self._row = np.zeros(self._water.series.table.shape[1])
        self._trial, self._shown = np.zeros(6), np.zeros(6)

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Nothing to prepare."""

    def loads(self, time: float, motion: Motion) -> Loads:
        """Forces, moments and damping on the carrier's frames."""
        return self._dragged(time, self._water.series.ramp, motion, self._trial)

    def static_loads(self, motion: Motion) -> Loads:
        """The drag of the current alone, as before the waves grow, whatever their ramp is."""
        return self._dragged(0.0, 1.0, motion, np.empty(6))

    def _dragged(self, time: float, ramp: float, motion: Motion, total: Array) -> Loads:
        n = len(motion.position)
        force, moment, damping = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 6, 6))
        water = self._water
        _drag(
            time, water.series.table, water.series.step, ramp, water.layout,
            water.stretching, water.depth, self._index, self._geometry, self._figures,
            motion.position, motion.rotation, motion.velocity, motion.angular_velocity,
            self._row, total, force, moment, damping,
        )  # fmt: skip
        return Loads(force, moment, damping=damping)

    def end_step(self, time: float, motion: Motion) -> None:
        """Keep the drag of the last ``loads`` for the record."""
        self._shown[:] = self._trial

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        return dict(zip((c.name for c in CHANNELS), self._shown.tolist(), strict=True))

    def state(self) -> dict[str, np.ndarray]:
        """Empty: the next step depends on nothing of the last."""
        return {}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Nothing to take back."""


def _columns(strips: Strips, sea: Sea, stretching: str) -> tuple[WaterColumns, Integers]:
    """The water at the strips' places (c,2), which stand still, and each strip's column (m,)."""
    places, column = columns_of(strips.center)
    z = strips.center[:, 2]
    tops, bottoms = np.full(len(places), -inf), np.full(len(places), inf)
    np.maximum.at(tops, column, z)
    np.minimum.at(bottoms, column, z)
    tops = np.minimum(tops + REACH, 0.0)
    bottoms = np.maximum(np.minimum(bottoms, 0.0) - REACH, -sea.depth)
    return water_columns(sea, places, tops, bottoms, stretching), column


def _mounted(strips: Strips, carrier: Carrier) -> tuple[Integers, Array]:
    """Each strip's frame (m,), and in its axes (m,4,3) the strip's place and three axes."""
    away = strips.center[:, None] - carrier.position
    frame = np.argmin(np.linalg.norm(away, axis=2), axis=1).astype(np.int64)
    arm = away[np.arange(len(strips)), frame]
    vectors = np.concatenate([arm[:, None], strips.axes.transpose(0, 2, 1)], axis=1)
    return frame, np.ascontiguousarray(vectors @ carrier.rotation[frame])


def _figures(strips: Strips, sea: Sea) -> Array:
    """Rows (m,7): length, height, rho/2 times drag widths (2) and drag area, current (2)."""
    drag = 0.5 * sea.density * np.column_stack([strips.drag_width, strips.drag_area])
    current = sea.current.at(strips.center[:, 2])
    return np.column_stack([strips.length, strips.height, drag, current])


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _turned(R: Array, a: Array) -> Vector:
    """``R @ a`` as a tuple."""
    return (
        R[0, 0] * a[0] + R[0, 1] * a[1] + R[0, 2] * a[2],
        R[1, 0] * a[0] + R[1, 1] * a[1] + R[1, 2] * a[2],
        R[2, 0] * a[0] + R[2, 1] * a[1] + R[2, 2] * a[2],
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _wet(z: float, height: float, level: float) -> float:
    """Share of a strip about z, ``height`` m high, that stands below a level m."""
    return min(max((level - z) / height + 0.5, 0.0), 1.0)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _sum(a: float, x: Vector, b: float, y: Vector, c: float, z: Vector) -> Vector:
    """a x + b y + c z."""
    return (
        a * x[0] + b * y[0] + c * z[0],
        a * x[1] + b * y[1] + c * z[1],
        a * x[2] + b * y[2] + c * z[2],
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _force(
    v: Vector, d: Vector, e: Vector, axis: Vector, first: float, second: float, end: float
) -> tuple[Vector, Matrix]:
    """Force N in the relative velocity v m/s, and the rows of its slope over it.

    ``first`` and ``second`` kg/m belong to flow along the sides ``d`` and ``e``, ``end`` to that
    along the axis.
    """
    a, b, c = _dot(v, d), _dot(v, e), _dot(v, axis)
    speed = np.sqrt(a * a + b * b)
    ua, ub = (a / speed, b / speed) if speed > 0.0 else (0.0, 0.0)
    along = end * abs(c)
    over_a = _sum(first * (speed + a * ua), d, first * a * ub, e, 0.0, axis)
    over_b = _sum(second * b * ua, d, second * (speed + b * ub), e, 0.0, axis)
    slope = (
        _sum(d[0], over_a, e[0], over_b, 2.0 * along * axis[0], axis),
        _sum(d[1], over_a, e[1], over_b, 2.0 * along * axis[1], axis),
        _sum(d[2], over_a, e[2], over_b, 2.0 * along * axis[2], axis),
    )
    return _sum(first * speed * a, d, second * speed * b, e, along * c, axis), slope


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _turning(r: Vector, rows: Matrix) -> Matrix:
    """The rows of r x (each column of a matrix)."""
    x, y, z = rows
    return (
        _sum(r[1], z, -r[2], y, 0.0, x),
        _sum(r[2], x, -r[0], z, 0.0, y),
        _sum(r[0], y, -r[1], x, 0.0, z),
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _put(block: Array, i: int, j: int, rows: Matrix) -> None:
    """Add a matrix to a block from row i and column j on."""
    for k in range(3):
        block[i, j + k] += rows[0][k]
        block[i + 1, j + k] += rows[1][k]
        block[i + 2, j + k] += rows[2][k]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add(r: Vector, f: Vector, slope: Matrix, force: Array, moment: Array, damping: Array) -> None:
    """Add a force at ``r`` from the frame's origin, and its slope as damping (6,6) there."""
    m = _cross(r, f)
    for k in range(3):
        force[k] += f[k]
        moment[k] += m[k]
    spun = (_cross(r, slope[0]), _cross(r, slope[1]), _cross(r, slope[2]))
    _put(damping, 0, 0, slope)
    _put(damping, 0, 3, spun)
    _put(damping, 3, 0, _turning(r, slope))
    _put(damping, 3, 3, _turning(r, spun))


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _drag(
    time: float, table: NDArray[np.float32], step: float, ramp: float, layout: Array,
    stretching: int, depth: float, index: Integers, geometry: Array, figures: Array,
    position: Array, rotation: Array, velocity: Array, angular_velocity: Array,
    row: Array, total: Array, force: Array, moment: Array, damping: Array,
) -> None:  # fmt: skip
    """Loads of all strips; ``total`` (6,) is their sum about the first frame."""
    sample(table, time / step, growth(time, ramp), row)
    for i in range(len(index)):
        frame, column = index[i, 0], index[i, 1]
        length, height, first, second, end, cx, cy = figures[i]
        R = rotation[frame]
        r = _turned(R, geometry[i, 0])
        axis = _turned(R, geometry[i, 3])
        level = surface(row, layout, column, stretching)
        z = position[frame, 2] + r[2]
        wet = _wet(z, height, level)
        if wet == 0.0:
            continue
        down = 0.5 * (wet - 1.0) * length * axis[2]
        r = (r[0] + down * axis[0], r[1] + down * axis[1], r[2] + down * axis[2])
        z = min(position[frame, 2] + r[2], level)
        w = water_velocity(row, layout, column, z, stretching, depth)
        spin = (angular_velocity[frame, 0], angular_velocity[frame, 1], angular_velocity[frame, 2])
        u = _cross(spin, r)
        v = (
            w[0] + cx - velocity[frame, 0] - u[0],
            w[1] + cy - velocity[frame, 1] - u[1],
            w[2] - velocity[frame, 2] - u[2],
        )
        d, e, wide = _turned(R, geometry[i, 1]), _turned(R, geometry[i, 2]), wet * length
        f, slope = _force(v, d, e, axis, wide * first, wide * second, wet * end)
        _add(r, f, slope, force[frame], moment[frame], damping[frame])
    total[:3], total[3:] = 0.0, moment[0]
    for j in range(len(force)):
        f = (force[j, 0], force[j, 1], force[j, 2])
        away = (
            position[j, 0] - position[0, 0],
            position[j, 1] - position[0, 1],
            position[j, 2] - position[0, 2],
        )
        m = _cross(away, f)
        for k in range(3):
            total[k] += f[k]
            total[3 + k] += m[k] + (moment[j, k] if j > 0 else 0.0)
