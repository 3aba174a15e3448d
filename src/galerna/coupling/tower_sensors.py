"""What tower, nacelle and base show: loads from the foot to the yaw bearing, and motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.contract import Array, Channel
from galerna.coupling import channels as c
from galerna.coupling.snapshot import (
    Snapshot,
    about,
    displacements,
    interpolation,
    named,
    true_acceleration,
    turned,
)
from galerna.structure.beam import discretise
from galerna.structure.bodies import moved, rigid_body, weight_of
from galerna.structure.frames import log_so3, roll_pitch_yaw
from galerna.structure.system import Root, State
from galerna.structure.turbine import TOWER_ELEMENTS, TurbineSystem, axis_curve
from galerna.turbine.model import Turbine


class TowerSensors:
    """Loads and displacements of the tower; sections where it is flexible.

    ``stations`` are fractions of the tower's axis.
    """

    def __init__(self, turbine: Turbine, parts: TurbineSystem, stations: Array) -> None:
        system, described = parts.system, parts.system.initial_state()
        self._system, self.nodes = system, parts.parts["tower"]
        self.base, self.nacelle = int(self.nodes[0]), system.names.index("nacelle")
        self.bearing = system.pair("yaw bearing")
        self.head = int(system.pairs.ends[self.bearing, 0])  # the tower's top carries this side
        self.platform = int(parts.parts["platform"][0]) if "platform" in parts.parts else self.base
        self._base_place = described.position[self.base].copy()
        self._platform_place = described.position[self.platform].copy()
        self._head_turn = described.rotation[self.head].copy()
        self._top = described.position[self.nacelle] - self._base_place
        self._foot = turbine.tower.axis[0] - self._base_place
        self._axis = turbine.tower.axis - self._base_place
        self._radius = 0.5 * turbine.tower.diameter
        self._elements = [
            e for e, name in enumerate(system.pair_names) if name.startswith("tower:")
        ]
        self._root = system.roots["tower"] if self._elements else self._rigid_root(turbine)
        self._place = described.position[self.nodes] - self._base_place
        self._turn = described.rotation[self.nodes]
        self._weights = None
        if self._elements:
            span = parts.span["tower"]
            self._weights = interpolation(span, stations)
            self._radius = np.interp(span, turbine.tower.axis_span, self._radius)

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Those of a rigid tower, or all; of the base where it can move."""
        found: tuple[Channel, ...] = c.YAW_BEARING + c.TOWER_TOP + c.TOWER_BASE
        if self._weights is not None:
            found += c.TOWER_SECTION_DISPLACEMENTS + c.TOWER_SECTION_LOADS
        return found + c.BASE + c.BASE_RATES if self.base else found

    def record(self, at: Snapshot) -> dict[str, float | Array]:
        """All channels."""
        state = at.state
        bearing = at.node_wrench[self.bearing, 6:]  # the nacelle's load, in its own axes
        foot = self._foot_load(at, bearing)
        values = {**self._bearing(state, bearing), **self._top_motion(state)}
        values.update(named(c.TOWER_BASE, foot))
        if self._weights is not None:
            moved = displacements(
                state.position, state.rotation, self.nodes, self._place, self._turn, np.eye(3)
            )
            along = (self._weights @ moved[:, :3]).T
            values.update(named(c.TOWER_SECTION_DISPLACEMENTS, along))
            loads = (self._weights @ self._loads(at, foot)).T
            values.update(named(c.TOWER_SECTION_LOADS, loads))
        if self.base:
            values.update(named(c.BASE, self.base_motion(state)))
            rates = [self.base_velocity(state), self.base_acceleration(state)]
            values.update(named(c.BASE_RATES, np.concatenate(rates)))
        return values

    def top_acceleration(self, state: State) -> Array:
        """Acceleration (3,) m/s2 of the tower's top in the axes of the nacelle."""
        return true_acceleration(state, self.nacelle)

    def nacelle_angular_acceleration(self, state: State) -> Array:
        """Angular acceleration (3,) rad/s2 of the nacelle in its own axes."""
        return state.acceleration[self.nacelle, 3:].copy()

    def base_velocity(self, state: State) -> Array:
        """Velocity m/s and angular velocity rad/s (6,) of the base in global axes."""
        at = self.platform
        return (state.velocity[at].reshape(2, 3) @ state.rotation[at].T).ravel()

    def base_acceleration(self, state: State) -> Array:
        """Acceleration m/s2 and angular acceleration rad/s2 (6,) of the base in global axes."""
        at = self.platform
        own = np.stack([true_acceleration(state, at), state.acceleration[at, 3:]])
        return (own @ state.rotation[at].T).ravel()

    def base_motion(self, state: State) -> Array:
        """Displacement m and rotation rad (6,) of the base; about z first, about x last."""
        shift = state.position[self.platform] - self._platform_place
        return np.concatenate([shift, roll_pitch_yaw(state.rotation[self.platform])])

    def surface(self, state: State) -> tuple[Array, Array]:
        """Points (n,3) m along the tower's axis and its radius (n,) m there."""
        R, x = state.rotation[self.base], state.position[self.base]
        if self._weights is None:
            return x + self._axis @ R.T, self._radius
        axis = state.position[self.nodes]
        axis[0] = x + R @ self._foot
        return axis, self._radius

    def _rigid_root(self, turbine: Turbine) -> Root:
        """All of a rigid tower's mass, in the axes of the frame that carries it."""
        tower, total = turbine.tower, np.zeros((6, 6))
        place = self._base_place
        if tower.structure is not None:
            length = float(np.linalg.norm(np.diff(tower.axis, axis=0), axis=1).sum())
            curve = axis_curve(tower.axis_span, tower.axis, np.eye(3), np.zeros(3), tower.structure)
            sections = replace(tower.structure, damping_ratio=None)
            beam = discretise(curve, length, sections, np.linspace(0, 1, 2 * TOWER_ELEMENTS + 1))
            for mass, x, axes in zip(beam.mass, beam.position, beam.rotation, strict=True):
                total += moved(mass, axes, x - place)
        for height, mass in tower.extra_masses:
            point = np.array([*tower.axis[-1][:2], height])
            total += moved(rigid_body(mass), np.eye(3), point - place)
        return Root(self.base, total, weight_of(total))

    def _foot_load(self, at: Snapshot, bearing: Array) -> Array:
        """Load (6,) of the tower on what carries it, at its foot, in the base's axes."""
        state = at.state
        if self._elements:
            load = -at.node_wrench[self._elements[0], :6]
        else:
            R = state.rotation[self.base]
            arm = R.T @ (state.position[self.base] - state.position[self.nacelle])
            load = about(turned(state.rotation[self.nacelle].T @ R, bearing), arm)
        load = load + at.tower_loads - self._system.root_balance(state, self._root)
        return about(load, self._foot)

    def _bearing(self, state: State, bearing: Array) -> dict[str, float | Array]:
        nacelle, tower = state.rotation[self.nacelle], self._head_axes(state)
        fixed = turned(nacelle.T @ tower, bearing)
        return named(c.YAW_BEARING, np.concatenate([fixed, bearing[[0, 1, 3, 4]]]))

    def _head_axes(self, state: State) -> Array:
        """Axes (3,3) of the tower's top, those of the base where nothing is bent."""
        return state.rotation[self.head] @ self._head_turn.T

    def _top_motion(self, state: State) -> dict[str, float | Array]:
        R = state.rotation[self.base]
        top = self._head_axes(state)
        shift = state.position[self.nacelle] - state.position[self.base]
        acceleration = state.rotation[self.nacelle] @ self.top_acceleration(state)
        rows = np.concatenate([R.T @ shift - self._top, log_so3(R.T @ top), top.T @ acceleration])
        return named(c.TOWER_TOP, rows)

    def _loads(self, at: Snapshot, foot: Array) -> Array:
        """Loads (n,6) at the nodes, in their axes: the mean of those beside each node."""
        beside = at.node_wrench[self._elements]
        loads = np.empty((len(self.nodes), 6))
        loads[0] = foot
        loads[1:-1] = 0.5 * (beside[:-1, 6:] - beside[1:, :6])
        loads[-1] = -at.node_wrench[self.bearing, :6]
        return loads
