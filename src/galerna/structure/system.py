"""The machine as equations: one residual for statics, rotation, dynamics and linearisation.

Every analysis asks ``System.balance`` for the same sum of inertia, weight, loads, internal
and constraint wrenches at the nodes. They differ in how the body twists and their rates
depend on the nodes' variations, and say so with two matrices a node: nothing in statics,
``ad(v)`` in steady rotation, the scheme's factors in time integration.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numba import njit

from galerna.contract import Array, Motion
from galerna.errors import InputError, did_you_mean

from .constraints import Constraint, constraint_rows
from .forces import Forces, add_load_tangents
from .frames import adjoint, log_se3
from .inertia import node_balance
from .pairs import Integers, PairAnswer, Pairs, answer, empty_answer, respond
from .solvers import LinearSolver, Rows, Solution, choose_solver


@dataclass(eq=False, slots=True)
class State:
    """Where the machine is, and everything the next step depends on.

    position (n,3) m, rotation (n,3,3), velocity and acceleration (n,6): body twists m/s,
    rad/s and their true rates; ``auxiliary`` (n,6) is the integrator's own acceleration;
    ``multiplier`` (m,6) N, N m per pair and ``constraint_multiplier`` (k,). Frame 0 is the
    ground.
    """

    time: float
    position: Array
    rotation: Array
    velocity: Array
    acceleration: Array
    auxiliary: Array
    multiplier: Array
    constraint_multiplier: Array

    def copy(self) -> State:
        return State(self.time, *(getattr(self, name).copy() for name in ARRAYS))

    def motion(self, nodes: Integers) -> Motion:
        """Motion of the frames ``nodes`` in global axes, as load models see it."""
        R, v, a = self.rotation[nodes], self.velocity[nodes], self.acceleration[nodes]
        turn = np.cross(v[:, 3:], v[:, :3])
        vectors = np.stack([v[:, :3], v[:, 3:], a[:, :3] + turn, a[:, 3:]], axis=-1)
        out = R @ vectors
        return Motion(self.position[nodes], R, *(out[:, :, k] for k in range(4)))


ARRAYS = tuple(name for name in State.__dataclass_fields__ if name != "time")


LoadFunction = Callable[[State], Forces]
SHORTLY = 1e-6  #: s, over which the velocity of a drive is taken: to the end of a path's piece
Placement = Callable[[float], tuple[Array, Array]]  #: time -> position (3,), rotation (3,3)


@dataclass(frozen=True, eq=False)
class Root:
    """A beam's first frame, and mass (6,6) and weight (4,) that the beam's root carries there."""

    node: int
    mass: Array
    weight: Array


@dataclass(eq=False, slots=True)
class Balance:
    """Residual wrench (n,6) of the nodes and what its derivative is made of."""

    residual: Array
    nodes: Array
    pairs: PairAnswer
    rows: Rows | None


@njit(cache=True)
def _add_pairs(ends: Integers, node_wrench: Array, residual: Array) -> None:
    for e in range(len(ends)):
        for k in range(6):
            residual[ends[e, 0], k] += node_wrench[e, k]
            residual[ends[e, 1], k] += node_wrench[e, 6 + k]


@dataclass(eq=False)
class System:
    """Frames, pairs and constraints ready for analysis; built by ``Structure``.

    ``mass`` (n,6,6) and ``weight`` (n,4: kg, kg m) of the frames, ``gravity`` (3,) m/s2,
    ``drives`` the pairs whose frame A moves in its node's axes as a function of time,
    ``roots`` what the beams bring to their first frames.
    """

    names: list[str]
    pair_names: list[str]
    pairs: Pairs
    mass: Array
    weight: Array
    gravity: Array
    position: Array
    rotation: Array
    drives: list[tuple[int, Placement]] = field(default_factory=list)
    constraints: list[tuple[Constraint, Integers]] = field(default_factory=list)
    roots: dict[str, Root] = field(default_factory=dict)

    @cached_property
    def solver(self) -> LinearSolver:
        return choose_solver(self.pairs, len(self), bool(self.constraints), self.names)

    @cached_property
    def _room(self) -> PairAnswer:
        return empty_answer(len(self.pairs.ends))

    @cached_property
    def constraint_sizes(self) -> list[int]:
        """Number of rows of each constraint beside the pairs."""
        x, R = self.position, self.rotation
        sizes = []
        for c, k in self.constraints:
            rows = len(c.violation(0.0, x[k], R[k], np.zeros((len(k), 6))))
            shape = np.shape(c.directions(0.0, x[k], R[k]))
            if shape != (rows, 6 * len(k)):
                raise InputError(
                    c.name, f"its directions have the shape {shape}, expected {(rows, 6 * len(k))}",
                    "a row for each violation, six columns for each frame",
                )  # fmt: skip
            sizes.append(rows)
        return sizes

    def __len__(self) -> int:
        return len(self.names)

    def initial_state(self) -> State:
        """The machine as it was described, at rest at time 0."""
        n, m = len(self), len(self.pairs.ends)
        rest = np.zeros((n, 6))
        multiplier, others = np.zeros((m, 6)), np.zeros(sum(self.constraint_sizes))
        x, R = self.position.copy(), self.rotation.copy()
        return State(0.0, x, R, rest, rest.copy(), rest.copy(), multiplier, others)

    def set_time(self, time: float) -> None:
        """Move the driven frames to where they are at ``time``; dampers see how fast they move."""
        for pair, placement in self.drives:
            x, R = placement(time)
            self.pairs.offset_position[pair, 0] = x
            self.pairs.offset_rotation[pair, 0] = R
            if self.pairs.damped[pair]:
                x0, R0 = placement(time - SHORTLY)
                self.pairs.drive_twist[pair] = log_se3(R0.T @ R, R0.T @ (x - x0)) / SHORTLY

    def balance(
        self,
        state: State,
        forces: Forces,
        velocity_tangent: Array,
        acceleration_tangent: Array,
        gravity_factor: float = 1.0,
        carried: Array | None = None,
    ) -> Balance:
        """The residual wrenches at a state, with tangents over the nodes' variations.

        ``velocity_tangent`` and ``acceleration_tangent`` (n,6,6) say how the analysis ties
        the twists and their rates to the variations; ``carried`` (m,6) see ``pairs.answer``.
        The pairs' part stays valid until the next call.
        """
        n = len(self)
        forces.check(n)
        residual, nodes = np.empty((n, 6)), np.empty((n, 6, 6))
        self.set_time(state.time)
        node_balance(
            self.mass, self.weight, gravity_factor * self.gravity, forces.dead, forces.follower,
            state.rotation, state.velocity, state.acceleration,
            velocity_tangent, acceleration_tangent, residual, nodes,
        )  # fmt: skip
        add_load_tangents(
            forces, state.rotation, state.velocity, velocity_tangent, acceleration_tangent, nodes
        )
        pairs = answer(
            self.pairs, state.multiplier, state.position, state.rotation, state.velocity,
            velocity_tangent, self._room, carried,
        )  # fmt: skip
        self.add_inertance(pairs, state.acceleration, acceleration_tangent)
        rows = self._add_internal(state, pairs, velocity_tangent, residual)
        return Balance(residual, nodes, pairs, rows)

    def residual(self, state: State, forces: Forces) -> Balance:
        """As ``balance``, at the time of its last call and without tangents."""
        residual, none = np.empty((len(self), 6)), np.empty((0, 6, 6))
        node_balance(
            self.mass, self.weight, self.gravity, forces.dead, forces.follower, state.rotation,
            state.velocity, state.acceleration, none, none, residual, none,
        )  # fmt: skip
        pairs = respond(
            self.pairs, state.multiplier, state.position, state.rotation, state.velocity,
            self._room,
        )  # fmt: skip
        self.add_inertance(pairs, state.acceleration)
        velocity_tangent = self.still() if self.constraints else none
        rows = self._add_internal(state, pairs, velocity_tangent, residual)
        return Balance(residual, none, pairs, rows)

    @cached_property
    def _gears(self) -> list[tuple[int, Integers, Array]]:
        """Pairs with an inertance, their nodes (2,), and their relative spin by twists (12,)."""
        found = []
        for pair in np.flatnonzero(self.pairs.inertance):
            axis_a, axis_b = self.pairs.offset_rotation[pair, :, :, 2]
            spin = np.concatenate([np.zeros(3), -axis_a, np.zeros(3), axis_b])
            found.append((int(pair), self.pairs.ends[pair], spin))
        return found

    def add_inertance(
        self, pairs: PairAnswer, rates: Array, acceleration_tangent: Array | None = None
    ) -> None:
        """Add to the pairs' node wrenches what resists twist ``rates`` (n,6); and tangents."""
        for pair, nodes, spin in self._gears:
            along = self.pairs.inertance[pair] * spin
            pairs.node_wrench[pair] += along * (spin @ rates[nodes].ravel())
            if acceleration_tangent is not None:
                follows = spin.reshape(2, 1, 6) @ acceleration_tangent[nodes]
                pairs.tangent[pair] += np.outer(along, follows)

    def inertia(self, twist: Array) -> Array:
        """Mass matrix of frames and gears times twists or rates (n,6), in body axes."""
        out: Array = (self.mass @ twist[:, :, None])[:, :, 0]
        for pair, nodes, spin in self._gears:
            along = self.pairs.inertance[pair] * spin * (spin @ twist[nodes].ravel())
            out[nodes] += along.reshape(2, 6)
        return out

    def _add_internal(
        self, state: State, pairs: PairAnswer, velocity_tangent: Array, residual: Array
    ) -> Rows | None:
        """Add the wrenches of pairs and constraints to the nodes' residual (n,6)."""
        _add_pairs(self.pairs.ends, pairs.node_wrench, residual)
        rows = None
        if self.constraints:
            rows, force = constraint_rows(
                self.constraints, state.time, state.constraint_multiplier,
                state.position, state.rotation, state.velocity, velocity_tangent,
            )  # fmt: skip
            residual += force.reshape(-1, 6)
        residual[0] = 0.0
        return rows

    def factorise(self, balance: Balance, scale: float) -> None:
        """Keep the matrix of a balance, constraints weighed with ``scale``, for ``correction``."""
        self.solver.factorise(balance.nodes, balance.pairs, scale, balance.rows)

    def correction(self, balance: Balance) -> Solution:
        """Variations (n,6), pair and constraint multipliers, with the matrix last factorised."""
        values = np.zeros(0) if balance.rows is None else balance.rows.residual
        return self.solver.solve(balance.residual, balance.pairs.motion, values)

    def solve(self, balance: Balance, scale: float) -> Solution:
        """Newton's correction: variations (n,6), pair and constraint multipliers."""
        self.factorise(balance, scale)
        return self.correction(balance)

    @cached_property
    def stiffness_scale(self) -> float:
        """A typical stiffness N/m, to weigh constraints with."""
        diagonal = np.einsum("mii->mi", self.pairs.stiffness)[:, :3]
        return float(diagonal[diagonal > 0].mean()) if (diagonal > 0).any() else 1.0

    @cached_property
    def mass_scale(self) -> float:
        """A typical mass of a frame, kg."""
        return float(self.mass[1:, 0, 0].mean()) if len(self) > 1 else 1.0

    def momentum(self, state: State) -> Array:
        """Linear and angular momentum (6,) about the origin, global axes."""
        local = np.einsum("nij,nj->ni", self.mass, state.velocity)
        linear = np.einsum("nij,nj->ni", state.rotation, local[:, :3])
        angular = np.einsum("nij,nj->ni", state.rotation, local[:, 3:])
        angular += np.cross(state.position, linear)
        return np.concatenate([linear.sum(axis=0), angular.sum(axis=0)])

    def energies(self, state: State) -> tuple[float, float, float]:
        """Kinetic, elastic and gravitational energy, J (gravity's is zero at the origin)."""
        kinetic = 0.5 * np.sum(state.velocity * self.inertia(state.velocity))
        strain = self.pair_motion(state) - self.pairs.reference
        elastic = 0.5 * np.einsum("mi,mij,mj->", strain, self.pairs.stiffness, strain)
        moment = self.weight[:, :1] * state.position + np.einsum(
            "nij,nj->ni", state.rotation, self.weight[:, 1:]
        )
        return float(kinetic), float(elastic), float(-(moment @ self.gravity).sum())

    def dissipation(self, state: State) -> float:
        """Power W that the damping of beams and joints takes."""
        rate = self.pair_answer(state).rate
        return float(np.einsum("mi,mij,mj->", rate, self.pairs.damping, rate))

    def pair(self, name: str) -> int:
        """The number of a joint or spring; raises InputError with the nearest names."""
        if name not in self.pair_names:
            raise InputError(name, "no such joint", did_you_mean(name, self.pair_names))
        return self.pair_names.index(name)

    def set_torque(self, name: str, torque: float) -> None:
        """Torque N m about a hinge's axis on its second frame, and its reaction on the first."""
        self.pairs.preload[self.pair(name), 5] = -torque

    def still(self) -> Array:
        """Tangent (n,6,6) of twists that do not depend on the variations."""
        return np.zeros((len(self), 6, 6))

    def pair_answer(self, state: State) -> PairAnswer:
        """Relative motions, wrenches and node wrenches of the pairs at a state."""
        self.set_time(state.time)
        pairs = answer(
            self.pairs, state.multiplier, state.position, state.rotation, state.velocity,
            self.still(), empty_answer(len(self.pairs.ends)),
        )  # fmt: skip
        self.add_inertance(pairs, state.acceleration)
        return pairs

    def node_wrenches(self, state: State) -> Array:
        """Wrenches (m,12) of the pairs in the residual of their nodes, in the nodes' axes."""
        self.set_time(state.time)
        pairs = respond(
            self.pairs, state.multiplier, state.position, state.rotation, state.velocity,
            empty_answer(len(self.pairs.ends)),
        )  # fmt: skip
        self.add_inertance(pairs, state.acceleration)
        return pairs.node_wrench

    def internal_loads(self, state: State, beam: str, forces: Forces | None = None) -> Array:
        """Force N and moment N m (n+1,6) that the outer part of a beam puts on the inner one.

        At the nodes of the beam, in their section axes. The first row is the whole load on the
        support, with mass, weight and ``forces`` of the first frame; the others up to the tip
        are just outside of their nodes.
        """
        elements = [e for e, name in enumerate(self.pair_names) if name.startswith(beam + ":")]
        if not elements:
            beams = {name.partition(":")[0] for name in self.pair_names if ":" in name}
            raise InputError(beam, "no such beam", did_you_mean(beam, beams))
        wrench = self.pair_answer(state).node_wrench[elements]
        wrench[0, :6] += self.root_balance(state, self.roots[beam], forces)
        root = elements[0]
        place = self.pairs.offset_rotation[root, 0], self.pairs.offset_position[root, 0]
        wrench[0, :6] = adjoint(*place).T @ wrench[0, :6]
        return np.vstack([-wrench[:, :6], wrench[-1:, 6:]])

    def root_balance(self, state: State, root: Root, forces: Forces | None = None) -> Array:
        """Inertia minus weight and loads (6,) of a beam's root, in the axes of its frame."""
        forces = forces or Forces.none(len(self))
        forces.check(len(self))
        at, still = slice(root.node, root.node + 1), np.zeros((1, 6, 6))
        residual = np.empty((1, 6))
        node_balance(
            root.mass[None], root.weight[None], self.gravity, forces.dead[at], forces.follower[at],
            state.rotation[at], state.velocity[at], state.acceleration[at],
            still, still, residual, np.empty((1, 6, 6)),
        )  # fmt: skip
        return residual[0]

    def pair_motion(self, state: State) -> Array:
        """Relative motions (m,6) of the pairs at a state."""
        return self.pair_answer(state).motion

    def violation(self, state: State) -> float:
        """Largest violation of the position constraints, m or rad."""
        motion = self.pair_motion(state)[self.pairs.locked]
        others = [
            c.violation(state.time, state.position[k], state.rotation[k], state.velocity[k])
            for c, k in self.constraints
            if c.holonomic
        ]
        return float(np.abs(np.concatenate([motion, *others])).max(initial=0.0))


def reach(system: System) -> float:
    """The structure's extent, m, at least 1."""
    return max(1.0, float(np.ptp(system.position, axis=0).max()))


def spin_twists(state: State, point: Array, angular_velocity: Array) -> Array:
    """Body twists (n,6) of a rigid rotation (3,) rad/s about a fixed point (3,) m."""
    spatial = np.concatenate([-np.cross(angular_velocity, point), angular_velocity])
    twists = np.zeros((len(state.position), 6))
    for i in range(1, len(twists)):
        R = state.rotation[i]
        twists[i] = adjoint(R.T.copy(), -R.T @ state.position[i]) @ spatial
    return twists


def with_spin(
    state: State, point: Array, angular_velocity: Array, nodes: Integers | None = None
) -> State:
    """The state turning steadily, as a whole or in some nodes; in body axes twists are constant."""
    velocity = spin_twists(state, point, angular_velocity)
    if nodes is not None:
        resting = np.setdiff1d(np.arange(len(velocity)), nodes)
        velocity[resting] = 0.0
    return replace(state, velocity=velocity, acceleration=np.zeros_like(state.acceleration))
