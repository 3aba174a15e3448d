"""The flexible machine: beams, bodies and joints of a turbine as the structure of the time loop.

Load models see their stations ride on the frames; what they answer goes back to the frames
by the transpose. One ``balance`` is one step of Newton's method of the whole structure.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from galerna.contract import Array, Loads, Stations
from galerna.coupling.energy import CHANNELS as ENERGY_CHANNELS
from galerna.coupling.energy import EnergyLedger
from galerna.coupling.paths import StepPath
from galerna.coupling.sensors import Gauges, Sensors, rows_of
from galerna.errors import ConvergenceError, InputError, did_you_mean
from galerna.kinematics import CHANNELS
from galerna.structure.attachment import Attachment
from galerna.structure.frames import rotation_about
from galerna.structure.integrators import Integrator, Trial
from galerna.structure.joints import Angle
from galerna.structure.pairs import Integers
from galerna.structure.placing import placed
from galerna.structure.scheme import Scheme, Tolerance
from galerna.structure.system import ARRAYS, Forces, State, System
from galerna.structure.turbine import TurbineOptions, TurbineSystem, turbine_system
from galerna.turbine.geometry import part_frames
from galerna.turbine.model import Turbine
from galerna.units import STANDARD_GRAVITY

#: what a coupled step leaves out of balance: of most responses in turbulence, less than 0.05 % of
#: their standard deviation (docs/theory/structure.md)
TOLERANCE = Tolerance(
    relative=1e-4, displacement=1e-6, rotation=1e-6, velocity=1e-4, angular_velocity=1e-4,
    iterations=25,
)  # fmt: skip
FLOATING = ("platform", "spar")  #: parts on which loads may have tangents
UNBALANCED = 1.5e-6  #: of the weight: force N, and N m, which a coupled step leaves over


def tolerance_for(system: System) -> Tolerance:
    """When a coupled step of a machine, large or small, has converged."""
    left = UNBALANCED * STANDARD_GRAVITY * float(system.weight[:, 0].sum())
    return replace(TOLERANCE, force=left, moment=left)


def attach(turbine: Turbine, system: TurbineSystem, group: Sequence[Stations]) -> Attachment:
    """The stations of one load model on the frames of the structure, as it was described.

    Raises InputError for a part that the structure does not have.
    """
    placed = [_placed(turbine, system, stations) for stations in group]
    ends, fraction, position, rotation = (
        np.concatenate(column) for column in zip(*placed, strict=True)
    )
    return Attachment(system.system.initial_state(), ends, fraction, position, rotation)


def _placed(
    turbine: Turbine, system: TurbineSystem, stations: Stations
) -> tuple[Integers, Array, Array, Array]:
    """Frames (n,2), fraction (n,) between them, position and rotation of one part's stations."""
    part = stations.part
    if part not in system.parts:
        hint = did_you_mean(part, system.parts)
        raise InputError("stations", f"the turbine {turbine.name!r} has no part {part!r}", hint)
    nodes, span = system.parts[part], system.span[part]
    last = len(span) - 1
    left = np.clip(np.searchsorted(span, stations.span, side="right") - 1, 0, max(last - 1, 0))
    right = np.minimum(left + 1, last)
    width = np.where(right > left, span[right] - span[left], 1.0)
    fraction = np.where(right > left, (stations.span - span[left]) / width, 0.0)
    ends = np.stack([nodes[left], nodes[right]], axis=1)
    origin, axes = system.places[part]
    position, rotation = part_frames(turbine, part, stations.span)
    return ends, fraction, origin + position @ axes.T, axes @ rotation


def _riding(
    turbine: Turbine, system: TurbineSystem, group: Sequence[Stations], part: str
) -> tuple[Attachment, Integers] | None:
    """A load model's stations on one part, and their rows in its loads."""
    chosen, rows = rows_of(group, part)
    return (attach(turbine, system, chosen), rows) if chosen else None


def _afloat(riders: Sequence[Attachment], stations: Sequence[Sequence[Stations]]) -> Integers:
    """The frames (k,) on which loads of the water act, which are stiff."""
    frames = [np.zeros(0, dtype=np.int64)]
    for riding, group in zip(riders, stations, strict=True):
        for part in FLOATING:
            frames.append(riding.frames[rows_of(group, part)[1]])
    return np.unique(np.concatenate(frames))


def _in_words(parts: TurbineSystem, frame: str) -> str:
    """A frame's name, with its place on a part that has several."""
    name, _, rest = frame.partition("[")
    if not rest or name not in parts.span:
        return frame
    return f"{name} at {parts.span[name][int(rest.rstrip(']'))]:.1%} of its span"


class FlexibleMachine:
    """A turbine's structure under its load models; see ``simulation.Structure``.

    ``stations`` holds the stations of every load model. Blades and nacelle turn as
    ``options.pitch_motion`` and ``options.yaw_motion`` say, or are moved by ``go_pitch`` and
    ``go_yaw``. With ``loose`` coupling the loads of a step are those of the predicted motion.
    Raises InputError for a part that the turbine does not have. With ``energy`` it keeps an
    account of the wind's work.
    """

    def __init__(
        self,
        turbine: Turbine,
        stations: Sequence[Sequence[Stations]],
        options: TurbineOptions | None = None,
        *,
        scheme: Scheme | None = None,
        tolerance: Tolerance | None = None,
        gauges: Gauges | None = None,
        energy: bool = False,
        loose: bool = False,
    ) -> None:
        options = options or TurbineOptions()
        blades = turbine.number_of_blades
        self._pitch_offset = options.pitch
        self.pitch: tuple[Angle, ...] = options.pitch_motion or tuple(
            StepPath(0.0) for _ in range(blades)
        )
        self.yaw_drive: Angle = options.yaw_motion or StepPath(0.0)
        self._loose = loose
        self.parts = turbine_system(
            turbine, replace(options, pitch_motion=self.pitch, yaw_motion=self.yaw_drive)
        )
        self.system = self.parts.system
        self.integrator = Integrator(
            self.system,
            scheme or Scheme.generalized_alpha(),
            tolerance or tolerance_for(self.system),
        )
        self._riders = [attach(turbine, self.parts, group) for group in stations]
        self.motions = tuple(riders.motion for riders in self._riders)
        afloat = _afloat(self._riders, stations)
        self._forces = Forces.stiff_on(len(self.system), afloat)
        self.loads: Sequence[Loads] = ()  #: of the load models, in the last balance
        tower = [_riding(turbine, self.parts, group, "tower") for group in stations]
        self.sensors = Sensors(turbine, self.parts, options.pitch, tower, gauges or Gauges())
        self.ledger = EnergyLedger(self.system, self.integrator.scheme) if energy else None
        self.given: Callable[[float], Array] = lambda speed: np.zeros(3)  #: W, see EnergyLedger
        accounts = ENERGY_CHANNELS if energy else ()
        self.channels = CHANNELS + self.sensors.channels + accounts
        numbers = np.arange(1.0, blades + 1.0)
        self.coordinates: Mapping[str, Array] = {"blade": numbers, **self.sensors.coordinates}
        names = self.system.names
        self._nacelle, self._hub = names.index("nacelle"), names.index("hub")
        self._driven = names.index("generator") if "generator" in names else self._hub
        self._tilted = rotation_about(1, turbine.nacelle.tilt)
        self.shaft_torque = 0.0  #: N m that drives the low-speed shaft; a generator's is negative
        self.start(placed(self.system, 0.0))

    def start(self, state: State) -> None:
        """Take a state as accepted: an equilibrium, or one that was saved."""
        self.accepted: State = state
        self._follow(state)

    def set_shaft_torque(self, torque: float) -> None:
        """Torque N m that drives the low-speed shaft; a generator's is negative."""
        self.shaft_torque = torque
        self.system.set_torque("main bearing", torque)

    def go_pitch(self, pitch: Array, time: float, dt: float) -> None:
        """Pitch the blades (b,) rad within the ``dt`` s after ``time``."""
        for path, angle in zip(self.pitch, pitch, strict=True):
            assert isinstance(path, StepPath), "the pitch is prescribed"
            path.go(angle - self._pitch_offset, time, dt)

    def go_yaw(self, angle: float, time: float, dt: float) -> None:
        """Drive the yaw bearing to ``angle`` rad within the ``dt`` s after ``time``."""
        assert isinstance(self.yaw_drive, StepPath), "the yaw is prescribed"
        self.yaw_drive.go(angle, time, dt)

    def pitch_angles(self, time: float) -> Array:
        """Pitch (b,) rad at a time in s."""
        return np.array([self._pitch_offset + path(time) for path in self.pitch])

    @property
    def rotor_speed(self) -> float:
        """Speed rad/s of the hub in the nacelle."""
        return self._turning_rate(self._hub)

    @property
    def drive_speed(self) -> float:
        """Speed rad/s of the generator in the nacelle, at the low-speed shaft."""
        return self._turning_rate(self._driven)

    @property
    def azimuth(self) -> float:
        """Azimuth rad of blade 1, from 0 to 2 pi."""
        R = self.accepted.rotation
        turned = (R[self._nacelle] @ self._tilted).T @ R[self._hub]
        return float(np.arctan2(turned[2, 1], turned[1, 1]) % (2.0 * np.pi))

    @property
    def yaw(self) -> float:
        """Yaw rad of the nacelle, with that of the tower's top."""
        forward = self.accepted.rotation[self._nacelle][:, 0]
        return float(np.arctan2(forward[1], forward[0]))

    def _turning_rate(self, frame: int) -> float:
        R, v = self.accepted.rotation, self.accepted.velocity
        axis = R[self._nacelle] @ self._tilted[:, 0]
        return float(axis @ (R[frame] @ v[frame, 3:] - R[self._nacelle] @ v[self._nacelle, 3:]))

    def predict(self, time: float, dt: float) -> None:
        """Begin a step of ``dt`` s from the accepted state."""
        self._trial: Trial = self.integrator.begin(self.accepted, dt)
        self._corrections = 0
        self._follow(self._trial.state)

    def balance(self, loads: Sequence[Loads]) -> bool:
        """Correct the trial under the loads; True where that did not move it any more.

        Raises ConvergenceError, with the frame that is furthest from balance.
        """
        forces = self.forces(loads)
        balanced = self._corrected(forces)
        while self._loose and not balanced:
            balanced = self._corrected(forces)
        if not balanced:
            self._follow(self._trial.state)
        return balanced

    def _corrected(self, forces: Forces) -> bool:
        self._corrections += 1
        try:
            if self._corrections > self.integrator.tolerance.iterations:
                raise self._trial.failure(self._corrections - 1)
            return self._trial.correct(forces)
        except ConvergenceError as error:
            where = f"structure, {_in_words(self.parts, error.where)}"
            raise ConvergenceError(where, error.what, error.hint, error.time) from error

    def accept(self) -> None:
        """Commit the step."""
        self.start(self._trial.settled())
        if self.ledger is not None:
            self.ledger.add(self.accepted, self._forces, self.given(self.drive_speed))

    def reject(self, time: float) -> None:
        """Return to the accepted state."""
        self._follow(self.accepted)

    def forces(self, loads: Sequence[Loads]) -> Forces:
        """Loads on the stations as loads on the frames; the array is used again."""
        self.loads = loads
        self._forces.clear()
        for riders, load in zip(self._riders, loads, strict=True):
            riders.add_loads(load, self._forces)
        return self._forces

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted state."""
        return {
            "rotor_speed": self.rotor_speed,
            "azimuth": self.azimuth,
            "pitch": self.pitch_angles(self.accepted.time),
            "yaw": self.yaw,
            **self.sensors.record(self.accepted, self.loads, self.rotor_speed),
            **(self.ledger.values() if self.ledger is not None else {}),
        }

    def root_moments(self) -> Array:
        """Moments (b,2) N m out of plane and in plane at the blades' roots."""
        return self.sensors.blades.root_moments(self.accepted)

    def tower_top_acceleration(self) -> Array:
        """Acceleration (3,) m/s2 of the tower's top in the axes of the nacelle."""
        return self.sensors.tower.top_acceleration(self.accepted)

    def platform_motion(self) -> Array:
        """Displacement m and rotation rad (6,) of the base; about z first, about x last."""
        return self.sensors.tower.base_motion(self.accepted)

    def platform_velocity(self) -> Array:
        """Velocity m/s and angular velocity rad/s (6,) of the base in global axes."""
        return self.sensors.tower.base_velocity(self.accepted)

    def platform_acceleration(self) -> Array:
        """Acceleration m/s2 and angular acceleration rad/s2 (6,) of the base in global axes."""
        return self.sensors.tower.base_acceleration(self.accepted)

    def nacelle_angular_acceleration(self) -> Array:
        """Angular acceleration (3,) rad/s2 of the nacelle in its own axes."""
        return self.sensors.tower.nacelle_angular_acceleration(self.accepted)

    def state(self) -> dict[str, np.ndarray]:
        """All that the next step depends on."""
        arrays = {name: getattr(self.accepted, name).copy() for name in ARRAYS}
        paths = np.array([path.state() for path in self._driven_paths])
        commands = {"shaft_torque": np.array(self.shaft_torque), "paths": paths}
        account = self.ledger.state() if self.ledger is not None else {}
        return {"time": np.array(self.accepted.time), **arrays, **commands, **account}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.set_shaft_torque(float(state["shaft_torque"]))
        for path, saved in zip(self._driven_paths, state["paths"], strict=True):
            path.restore(saved)
        self.start(State(float(state["time"]), *(state[name].copy() for name in ARRAYS)))
        if self.ledger is not None:
            self.ledger.restore(state, self.accepted)

    @property
    def _driven_paths(self) -> list[StepPath]:
        """What a controller moves."""
        return [path for path in (*self.pitch, self.yaw_drive) if isinstance(path, StepPath)]

    def _follow(self, state: State) -> None:
        for riders in self._riders:
            riders.follow(state)
