"""What the blades show: loads at the root and along the span, displacements, clearance."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array, Channel
from galerna.coupling import channels as c
from galerna.coupling.snapshot import (
    Snapshot,
    displacements,
    distance_to_tower,
    interpolation,
    named,
    true_acceleration,
    turned,
)
from galerna.structure.forces import hats
from galerna.structure.frames import rotation_about
from galerna.structure.system import State
from galerna.structure.turbine import TurbineSystem
from galerna.turbine.model import Turbine


class BladeSensors:
    """Root, tip and section channels of all blades; sections where the blades are flexible.

    ``pitch`` rad is that of the structure as it was described; ``stations`` are fractions of
    the blade's axis.
    """

    def __init__(
        self, turbine: Turbine, parts: TurbineSystem, pitch: float, stations: Array
    ) -> None:
        system, described = parts.system, parts.system.initial_state()
        names = [f"blade{k + 1}" for k in range(turbine.number_of_blades)]
        self.nodes = np.array([parts.parts[name] for name in names])
        self.hub, self.top = system.names.index("hub"), system.names.index("nacelle")
        self.bearings = np.array([system.pair(f"pitch bearing {k + 1}") for k in range(len(names))])
        pairs = system.pairs
        self._bearing_axes = pairs.offset_rotation[self.bearings, 1]
        self._lever = hats(pairs.offset_position[self.bearings, 1])
        elements = self.nodes.shape[1] - 1
        self._elements = np.array(
            [[system.pair(f"{name}:{e}") for e in range(elements)] for name in names], dtype=int
        ).reshape(len(names), elements)
        pitched = np.array([parts.places[name][1] for name in names])
        roots = described.rotation[self.nodes[:, 0]]
        self.coned = described.rotation[self.hub].T @ pitched @ rotation_about(2, pitch)
        self.pitched = roots.transpose(0, 2, 1) @ pitched
        arms = described.position[self.nodes] - described.position[self.nodes[:, :1]]
        self._place = np.ascontiguousarray(arms @ roots)
        self._turn = roots.transpose(0, 2, 1)[:, None] @ described.rotation[self.nodes]
        rigid_tip = np.array([parts.places[name][1] @ turbine.blade.axis[-1] for name in names])
        self._rigid_tip = np.einsum("bji,bj->bi", roots, rigid_tip)
        self._weights = interpolation(parts.span["blade1"], stations) if elements else None

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Those of a rigid blade, or all."""
        always = c.BLADE_ROOT + c.BLADE_ROOT_PITCHING + c.BLADE_TIP
        if self._weights is None:
            return always
        return always + c.BLADE_SECTION_DISPLACEMENTS + c.BLADE_SECTION_LOADS

    def record(self, at: Snapshot, axis: Array, radius: Array) -> dict[str, float | Array]:
        """All channels; ``axis`` (n,3) and ``radius`` (n,) m are the tower's."""
        moved = self._displacements(at.state)
        root = at.node_wrench[self.bearings, 6:]
        values = self._roots(at.state, root)
        values.update(self._tips(at.state, moved[:, -1], axis, radius))
        if self._weights is not None:
            along = np.einsum("sn,bnk->kbs", self._weights, moved[:, :, (0, 1, 2, 5)])
            along[3] *= -1.0
            values.update(named(c.BLADE_SECTION_DISPLACEMENTS, along))
            loads = np.einsum("sn,bnk->kbs", self._weights, self._loads(at, root))
            values.update(named(c.BLADE_SECTION_LOADS, loads))
        return values

    def root_moments(self, state: State) -> Array:
        """Moments (b,2) N m out of plane and in plane at the roots, coned axes.

        They are the multipliers of the pitch bearings, which hold all that a blade does.
        """
        held = state.multiplier[self.bearings, 3:, None]
        return (self._coned_from_root(state) @ self._bearing_axes @ held)[:, (1, 0), 0]

    def _coned_from_root(self, state: State) -> Array:
        """What takes (b,3,3) vectors from the axes of the root frames into coned axes."""
        coned = state.rotation[self.hub] @ self.coned
        return coned.transpose(0, 2, 1) @ state.rotation[self.nodes[:, 0]]

    def _roots(self, state: State, root: Array) -> dict[str, float | Array]:
        root = root.copy()
        root[:, 3:] -= (self._lever @ root[:, :3, None])[:, :, 0]
        coned = turned(self._coned_from_root(state).transpose(0, 2, 1), root)
        pitching = turned(self.pitched, root)[:, (0, 1, 3, 4)]
        return {
            **named(c.BLADE_ROOT, coned.T.copy()),
            **named(c.BLADE_ROOT_PITCHING, pitching.T.copy()),
        }

    def _displacements(self, state: State) -> Array:
        """Displacements in pitching axes and rotations of the sections, (b,n,6)."""
        return np.array(
            [
                displacements(state.position, state.rotation, nodes, place, turn, axes)
                for nodes, place, turn, axes in zip(
                    self.nodes, self._place, self._turn, self.pitched, strict=True
                )
            ]
        )

    def _tips(
        self, state: State, moved: Array, axis: Array, radius: Array
    ) -> dict[str, float | Array]:
        roots, tips = self.nodes[:, 0], self.nodes[:, -1]
        rows = np.zeros((len(c.BLADE_TIP), len(roots)))
        to_coned = self._coned_from_root(state) @ self.pitched
        rows[:3] = (to_coned @ moved[:, :3, None])[:, :, 0].T
        rows[3], rows[4], rows[5] = moved[:, 0], moved[:, 1], -moved[:, 5]
        for k, tip in enumerate(tips):
            point = state.position[tip]
            if self._weights is None:
                point = state.position[roots[k]] + state.rotation[roots[k]] @ self._rigid_tip[k]
            else:
                rows[6:8, k] = true_acceleration(state, tip)[:2]
            rows[8, k] = self._from_yaw_axis(state, point)
            rows[9, k] = distance_to_tower(point, axis, radius)
        return named(c.BLADE_TIP, rows)

    def _from_yaw_axis(self, state: State, point: Array) -> float:
        """Distance m from the yaw axis to a point (3,), above the bearing from the bearing."""
        x, y, z = state.rotation[self.top].T @ (point - state.position[self.top])
        return float(np.sqrt(x * x + y * y + max(z, 0.0) ** 2))

    def _loads(self, at: Snapshot, root: Array) -> Array:
        """Loads (b,n,6) at the nodes, in their axes: the mean of those beside each node.

        The loads of an element are those half-way between its nodes.
        """
        beside = at.node_wrench[self._elements]
        loads = np.zeros((*self.nodes.shape, 6))
        loads[:, 0] = root
        loads[:, 1:-1] = 0.5 * (beside[:, :-1, 6:] - beside[:, 1:, :6])
        return loads
