"""The machine turning steadily in a steady wind: its shape, its loads, its power.

At every instant the structure is in balance with its weight, the inertia of the steady
rotation and the loads that blade-element momentum theory gives for a flow that has always
been as it is. The rotor is held at its speed; what holds it is the generator's torque.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import AT_ONCE, steady_options
from galerna.aero.body_drag import BodyDrag
from galerna.contract import Array, Inflow, LoadModel
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.floating import Pose
from galerna.coupling.paths import StepPath
from galerna.errors import ConvergenceError
from galerna.structure import TurbineOptions
from galerna.structure.foundation import held_at
from galerna.structure.frames import exp_so3
from galerna.structure.joints import ALL
from galerna.structure.pairs import Integers
from galerna.structure.statics import static_equilibrium
from galerna.structure.system import Forces, State, with_spin
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY

PASSES = 30  #: of loads and shape, at most
POSITION_TOLERANCE = 3e-6  #: of the rotor radius, between two passes
SMALLEST_SHARE, LARGEST_SHARE = 0.2, 2.0  #: of the change of the loads that is taken
AZIMUTHS = 2  #: in the sector of one blade, for means


@dataclass(frozen=True, eq=False)
class SteadyPoint:
    """A machine in steady operation; ``record`` has the rotor's channels, means over the azimuth.

    ``states`` are its shapes at equally spaced azimuths from the first one on, as far as the
    next blade.
    """

    rotor_speed: float
    pitch: Array
    record: Mapping[str, Array]
    states: tuple[State, ...]

    @property
    def torque(self) -> float:
        """Mean aerodynamic torque N m about the shaft."""
        return float(self.record["rotor_torque"])


class SteadyMachine:
    """A turbine that is asked for its equilibria in a wind; every part as ``options`` say.

    ``inflow`` is steady: it is asked at time 0. Loads are those of ``aerodynamics`` without
    what it remembers, and with ``drag`` those of tower and nacelle.
    """

    def __init__(
        self,
        turbine: Turbine,
        inflow: Inflow,
        options: TurbineOptions | None = None,
        *,
        air_density: float = AIR_DENSITY,
        aerodynamics: BemOptions | None = None,
        drag: bool = True,
    ) -> None:
        self.turbine = turbine
        self.rotor = BladeElementMomentum(
            turbine, inflow, air_density=air_density, options=steady_options(aerodynamics)
        )
        self._models: list[LoadModel] = [self.rotor]
        if drag:
            self._models.append(BodyDrag(turbine, inflow, air_density=air_density))
        self._not_started = self.rotor.state()
        chosen = options or TurbineOptions()
        self._built_pitch = chosen.pitch
        self._azimuth = StepPath(0.0)
        self._pitch = tuple(StepPath(0.0) for _ in range(turbine.number_of_blades))
        driven = replace(chosen, rotor_motion=self._azimuth, pitch_motion=self._pitch)
        self.machine = FlexibleMachine(
            turbine, [model.stations for model in self._models], _held(turbine, driven)
        )
        self.parts, self.system = self.machine.parts, self.machine.system
        names = self.system.names
        self._nacelle, self._hub = names.index("nacelle"), names.index("hub")
        self.rotor_nodes = rotor_nodes(self.machine)
        built = np.full(turbine.number_of_blades, chosen.pitch)
        self._known = {0.0: (self.machine.accepted, built)}

    def at(self, rotor_speed: float, pitch: Array, wake_pitch: Array | None = None) -> SteadyPoint:
        """The machine at a rotor speed rad/s and pitch (b,) rad.

        With ``wake_pitch`` the induced velocities are those of that pitch. Raises
        ConvergenceError where loads and shape find no balance.
        """
        sector = 2.0 * np.pi / self.turbine.number_of_blades
        states, records = [], []
        for k in range(AZIMUTHS):
            turned = sector * k / AZIMUTHS
            self.rotor.restore(self._not_started)
            if wake_pitch is not None:
                self.equilibrium(rotor_speed, wake_pitch, turned)
                self.rotor.begin_step(0.0, AT_ONCE, self.machine.motions[0])
            states.append(self.equilibrium(rotor_speed, pitch, turned))
            records.append(self._record())
        means = {
            name: np.mean([np.asarray(record[name]) for record in records], axis=0)
            for name in records[0]
        }
        return SteadyPoint(rotor_speed, np.asarray(pitch), means, tuple(states))

    def torque(self, rotor_speed: float, pitch: float) -> float:
        """Mean aerodynamic torque N m at a rotor speed rad/s and a pitch rad of all blades."""
        return self.at(rotor_speed, np.full(self.turbine.number_of_blades, pitch)).torque

    def equilibrium(
        self, rotor_speed: float, pitch: Array, turned: float = 0.0, time: float = 0.0
    ) -> State:
        """The shape at one azimuth, ``turned`` rad on from the first; velocities are the spin's."""
        state = self._near(pitch, turned, time)
        relaxed = Relaxed()
        for _ in range(PASSES):
            before = state.position.copy()
            self.machine.start(with_spin(state, *self._spin(state, rotor_speed)))
            state = static_equilibrium(
                self.system,
                state,
                Forces(np.zeros_like(state.velocity), relaxed(self.forces().follower)),
                tolerance=1e-8,
                spin=self._spin(state, rotor_speed),
            )
            moved = float(np.abs(state.position - before).max())
            if moved < POSITION_TOLERANCE * self.turbine.rotor_radius:
                break
        else:
            what = f"loads and shape find no balance at {rotor_speed:.4g} rad/s, pitch "
            raise ConvergenceError(
                "steady machine",
                f"{what}{np.degrees(np.mean(pitch)):.4g} deg: the last pass moved {moved:.3g} m",
            )
        state = with_spin(state, *self._spin(state, rotor_speed))
        self.machine.start(state)
        self._known[turned] = state, np.array(pitch)
        return state

    def carry(self, pose: Pose, to: Pose) -> None:
        """Take the base of this machine from the pose that holds it to another one."""
        turned = to.rotation @ pose.rotation.T
        everything = np.arange(1, len(self.system))
        for state, _ in self._known.values():
            turn(state, everything, pose.position, turned)
            state.position[everything] += to.position - pose.position
        pose.take(to)

    def forces(self) -> Forces:
        """The loads on the machine in its last shape, on its frames."""
        return self.machine.forces(
            [
                model.loads(0.0, motion)
                for model, motion in zip(self._models, self.machine.motions, strict=True)
            ]
        )

    def held_torque(self, state: State) -> float:
        """Torque N m that holds the low-speed shaft in a shape of this machine."""
        return float(state.multiplier[self.system.pair("main bearing"), 5])

    def shaft_axis(self, state: State) -> Array:
        """The shaft's direction (3,) downwind in a state."""
        return state.rotation[self._nacelle] @ self.parts.shaft_axis

    def _spin(self, state: State, speed: float) -> tuple[Array, Array, Integers]:
        """Point, angular velocity and nodes of the rotor's rotation in a state."""
        return state.position[self._hub], speed * self.shaft_axis(state), self.rotor_nodes

    def _record(self) -> Mapping[str, float | Array]:
        """The rotor's channels in the motion of the last equilibrium."""
        motion = self.machine.motions[0]
        self.rotor.loads(AT_ONCE, motion)
        self.rotor.end_step(AT_ONCE, motion)
        record = self.rotor.record()
        self.rotor.restore(self._not_started)
        return record

    def _near(self, pitch: Array, turned: float, time: float) -> State:
        """A shape that obeys the joints: the known one of the nearest azimuth, turned."""
        nearest = min(self._known, key=lambda known: abs(known - turned))
        known, old_pitch = self._known[nearest]
        state = replace(known.copy(), time=time)
        about_shaft = turn_about(self.shaft_axis(state), turned - nearest)
        turn(state, self.rotor_nodes, state.position[self._hub].copy(), about_shaft)
        for k, change in enumerate(np.asarray(pitch) - old_pitch):
            nodes = self.parts.parts[f"blade{k + 1}"]
            axis = state.rotation[self._hub] @ self._pitch_axis(k)
            turn(state, nodes, state.position[nodes[0]].copy(), turn_about(axis, change))
            self._pitch[k].hold(float(pitch[k]) - self._built_pitch)
        self._azimuth.hold(turned)
        return state

    def _pitch_axis(self, k: int) -> Array:
        """Axis (3,) about which blade ``k`` pitches towards feather, in the hub's axes."""
        _, axes = self.parts.places[f"blade{k + 1}"]
        return -self.parts.places["hub"][1].T @ axes[:, 2]


class Relaxed:
    """Loads on the way to their balance with the shape, by Aitken's relaxation of all of them."""

    def __init__(self) -> None:
        self._used: Array | None = None
        self._last: Array | None = None
        self._share = 1.0

    def __call__(self, loads: Array) -> Array:
        """What to put on the structure next, given the loads (n,6) on its last shape."""
        if self._used is None:
            self._used = loads.copy()
            return self._used
        error = loads - self._used
        if self._last is not None:
            change = error - self._last
            if size := float((change * change).sum()):
                share = -self._share * float((self._last * change).sum()) / size
                self._share = min(max(share, SMALLEST_SHARE), LARGEST_SHARE)
        self._last = error
        self._used = self._used + self._share * error
        return self._used


def _held(turbine: Turbine, options: TurbineOptions) -> TurbineOptions:
    """The options with a platform held: where it is moved to, or where it was described."""
    if turbine.platform is None:
        return options
    place = held_at(np.array(turbine.platform.reference_point))
    return replace(options, base_motion=options.base_motion or place, base_locked=ALL)


def rotor_nodes(machine: FlexibleMachine) -> Integers:
    """The frames that turn with the rotor: blades, hub, generator."""
    parts, names = machine.parts.parts, machine.system.names
    turning = [nodes for name, nodes in parts.items() if name.startswith(("blade", "hub"))]
    if "generator" in names:
        turning.append(np.array([names.index("generator")]))
    return np.concatenate(turning)


def turn_about(axis: Array, angle: float) -> Array:
    """Rotation (3,3) about an axis (3,) of unit length."""
    return exp_so3(float(angle) * axis)


def turn(state: State, nodes: Integers, point: Array, rotation: Array) -> None:
    """Turn some frames of a state rigidly about a point (3,) m by a rotation (3,3)."""
    state.position[nodes] = point + (state.position[nodes] - point) @ rotation.T
    state.rotation[nodes] = rotation @ state.rotation[nodes]
