"""Drag of the tower and the nacelle in the undisturbed wind, as a load model."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from galerna.aero.bem.lag import FASTMATH
from galerna.aero.sections import strip_weights
from galerna.aero.tower_influence import tower_sections
from galerna.aero.vectors import axis, combine, cross, dot, length, put, row, scale, subtract
from galerna.contract import Array, Channel, Inflow, Loads, Motion, Stations
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY

_TOWER = ("tower_span",)

CHANNELS = (
    Channel("tower_drag_x", "N/m", "tower drag per length along x", _TOWER, "TwN{node}Fdx", "N/m"),
    Channel("tower_drag_y", "N/m", "tower drag per length along y", _TOWER, "TwN{node}Fdy", "N/m"),
    Channel("tower_drag_force", "N", "drag of the tower along x"),
    Channel("nacelle_drag_force", "N", "drag of the nacelle along x"),
)


class BodyDrag:
    """Drag of the tower's stations and of the nacelle; it has no memory.

    Tower: 1/2 rho C_d D |V| V per length, V the relative wind across the tower's axis.
    Nacelle: 1/2 rho |V| times the drag areas along its own axes times V, at the height of
    the shaft. ``air_density`` kg/m3; ``tower_stations`` (m,) are fractions of the tower's
    axis, its own unless given.
    """

    channels: tuple[Channel, ...] = CHANNELS
    largest_step: float = inf

    def __init__(
        self,
        turbine: Turbine,
        inflow: Inflow,
        *,
        air_density: float = AIR_DENSITY,
        tower_stations: ArrayLike | None = None,
    ) -> None:
        tower, nacelle = turbine.tower, turbine.nacelle
        given = tower.axis_span if tower_stations is None else tower_stations
        span = np.asarray(given, dtype=float)
        self.inflow = inflow
        self.stations = (Stations("tower", span), Stations("nacelle"))
        self.coordinates: Mapping[str, Array] = {"tower_span": span}
        extent = float(np.linalg.norm(np.diff(tower.axis, axis=0), axis=1).sum())
        radius, drag = tower_sections(tower, span).T
        weight, offset = strip_weights(span * extent, extent)
        self._strips = np.stack([air_density * drag * radius, weight, offset], axis=1)
        self._nacelle = np.array([nacelle.shaft_height, *nacelle.drag_area])
        self._nacelle[1:] *= 0.5 * air_density
        self._points = np.zeros((len(span) + 1, 3))
        self._trial = np.zeros((len(span) + 1, 3))
        self._shown = np.zeros((len(span) + 1, 3))

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Nothing to prepare."""

    def loads(self, time: float, motion: Motion) -> Loads:
        """Forces and moments on the tower's stations and the nacelle."""
        self._points[:] = motion.position
        self._points[-1] += self._nacelle[0] * motion.rotation[-1, :, 2]
        loads = Loads.zero(len(self._points))
        _drag(
            self.inflow.velocity(self._points, time),
            motion.rotation,
            motion.velocity,
            motion.angular_velocity,
            self._strips,
            self._nacelle,
            self._trial,
            loads.force,
            loads.moment,
        )
        return loads

    def end_step(self, time: float, motion: Motion) -> None:
        """Keep the drag of the last ``loads`` for the record."""
        self._shown[:] = self._trial

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        tower, nacelle = self._shown[:-1], self._shown[-1]
        return {
            "tower_drag_x": tower[:, 0].copy(),
            "tower_drag_y": tower[:, 1].copy(),
            "tower_drag_force": float(tower[:, 0] @ self._strips[:, 1]),
            "nacelle_drag_force": float(nacelle[0]),
        }

    def state(self) -> dict[str, np.ndarray]:
        """Empty: the next step depends on nothing of the last."""
        return {}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Nothing to take back."""


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _drag(
    wind: Array,
    rotation: Array,
    velocity: Array,
    angular_velocity: Array,
    strips: Array,
    nacelle: Array,
    drag: Array,
    force: Array,
    moment: Array,
) -> None:
    """Fill ``drag`` (m+1,3), N/m of the tower's stations and N of the nacelle, and the loads.

    ``strips`` (m,3) holds rho C_d D / 2 in kg/m2, weight m and offset m; ``nacelle`` (4,) the
    shaft's height m and rho / 2 times the drag areas, kg/m.
    """
    last = len(strips)
    for i in range(last):
        along = axis(rotation, i, 2)
        relative = subtract(row(wind, i), row(velocity, i))
        across = combine(1.0, relative, -dot(relative, along), along)
        put(drag, i, scale(strips[i, 0] * length(across), across))
        put(force, i, scale(strips[i, 1], row(drag, i)))
        put(moment, i, cross(scale(strips[i, 2], along), row(force, i)))
    arm = scale(nacelle[0], axis(rotation, last, 2))
    moving = combine(1.0, row(velocity, last), 1.0, cross(row(angular_velocity, last), arm))
    relative = subtract(row(wind, last), moving)
    speed = length(relative)
    total = (0.0, 0.0, 0.0)
    for k in range(3):
        direction = axis(rotation, last, k)
        part = nacelle[1 + k] * speed * dot(relative, direction)
        total = combine(1.0, total, part, direction)
    put(drag, last, total)
    put(force, last, total)
    put(moment, last, cross(arm, total))
