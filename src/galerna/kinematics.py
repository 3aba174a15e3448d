"""The rigid machine: where every station is when rotor speed, pitch and yaw are prescribed.

This is the simplest 'structure' of the time loop: the tower stands still, the nacelle
yaws on it, the shaft turns in the nacelle, the blades pitch on the hub. Positions,
velocities and accelerations are exact, and so is the azimuth, the integral of the speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numba import njit

from galerna.contract import Array, Channel, Loads, Motion, Stations
from galerna.errors import InputError
from galerna.signals import Signal, evaluate
from galerna.turbine.geometry import part_frames
from galerna.turbine.model import Turbine
from galerna.units import DEG, RPM

FIXED, NACELLE, HUB, BLADE = 0, 1, 2, 3  #: the body of a station; blade k is BLADE + k
ROTOR_SPEED, YAW, PITCH = 0, 1, 2  #: the kernel's signals; the pitch of blade k is PITCH + k

CHANNELS = (
    Channel("rotor_speed", "rad/s", "rotor speed", (), "RotSpeed", "rpm", 1.0 / RPM),
    Channel("azimuth", "rad", "azimuth of blade 1, 0 is up", (), "Azimuth", "deg", 1.0 / DEG),
    Channel("pitch", "rad", "blade pitch angle", ("blade",), "BldPitch{blade}", "deg", 1.0 / DEG),
    Channel("yaw", "rad", "nacelle yaw", (), "NacYaw", "deg", 1.0 / DEG),
)


@dataclass(frozen=True, eq=False)
class PrescribedOperation:
    """What the machine is made to do, in rad/s and rad; ``pitch`` has a signal per blade."""

    rotor_speed: Signal
    pitch: tuple[Signal, ...]
    yaw: Signal = field(default_factory=lambda: Signal.constant(0.0))
    azimuth: float = 0.0  #: of blade 1 at time 0, rad


@njit(cache=True, inline="always")
def _cross(a: Array, b: Array, out: Array) -> None:
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def _attach(parent: int, child: int, arm: Array, bodies: Array) -> None:
    """Fix the origin of ``child`` to ``parent`` at ``arm`` (3,), in global axes.

    A body's rows are position, velocity, acceleration, angular velocity, angular acceleration.
    """
    spin, bend, swing = np.empty(3), np.empty(3), np.empty(3)
    _cross(bodies[parent, 3], arm, spin)
    _cross(bodies[parent, 3], spin, bend)
    _cross(bodies[parent, 4], arm, swing)
    bodies[child, 0] = bodies[parent, 0] + arm
    bodies[child, 1] = bodies[parent, 1] + spin
    bodies[child, 2] = bodies[parent, 2] + swing + bend


@njit(cache=True)
def _hinge(
    parent: int, child: int, axis: Array, rate: float, acceleration: float, bodies: Array
) -> None:
    """Let ``child`` turn on ``parent`` about ``axis`` (3,), in global axes."""
    swing = np.empty(3)
    _cross(bodies[parent, 3], axis, swing)
    bodies[child, 3] = bodies[parent, 3] + rate * axis
    bodies[child, 4] = bodies[parent, 4] + acceleration * axis + rate * swing


@njit(cache=True)
def _rotate(axes: Array, axis: int, angle: float) -> None:
    """Turn the frame ``axes`` (3,3) by ``angle`` rad about its own axis 0, 1 or 2."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    for row in range(3):
        along_i, along_j = axes[row, i], axes[row, j]
        axes[row, i] = c * along_i + s * along_j
        axes[row, j] = c * along_j - s * along_i


@njit(cache=True)
def _place_bodies(
    time: float, knots: Array, offsets: Array, geometry: Array, bodies: Array, axes: Array
) -> None:
    """Motion of tower, nacelle, hub and blades; ``geometry`` is as ``_geometry`` packs it."""
    azimuth_start, tilt, shaft_height, overhang, hub_radius, cone = geometry[:6]
    blades = bodies.shape[0] - BLADE
    speed, speed_rate, azimuth = evaluate(knots, offsets[0], offsets[1], time)
    yaw, yaw_rate, _ = evaluate(knots, offsets[1], offsets[2], time)
    bodies[FIXED] = 0.0
    bodies[FIXED, 0] = geometry[6:9]
    axes[FIXED] = np.eye(3)

    axes[NACELLE] = axes[FIXED]
    _rotate(axes[NACELLE], 2, yaw)
    _attach(FIXED, NACELLE, np.zeros(3), bodies)
    _hinge(FIXED, NACELLE, axes[FIXED, :, 2], yaw_rate, 0.0, bodies)

    axes[HUB] = axes[NACELLE]
    _rotate(axes[HUB], 1, tilt)
    shaft = axes[HUB, :, 0]
    _attach(NACELLE, HUB, shaft_height * axes[NACELLE, :, 2] - overhang * shaft, bodies)
    _hinge(NACELLE, HUB, shaft, speed, speed_rate, bodies)
    _rotate(axes[HUB], 0, azimuth_start + azimuth)

    for k in range(blades):
        blade = BLADE + k
        pitch, pitch_rate, _ = evaluate(knots, offsets[PITCH + k], offsets[PITCH + k + 1], time)
        axes[blade] = axes[HUB]
        _rotate(axes[blade], 0, 2.0 * np.pi * k / blades)
        _rotate(axes[blade], 1, -cone)
        _attach(HUB, blade, hub_radius * axes[blade, :, 2], bodies)
        _hinge(HUB, blade, -axes[blade, :, 2], pitch_rate, 0.0, bodies)
        _rotate(axes[blade], 2, -pitch)


@njit(cache=True)
def _place(
    time: float,
    knots: Array,
    offsets: Array,
    geometry: Array,
    body: Array,
    arms: Array,
    orientation: Array,
    vectors: Array,
    rotation: Array,
) -> None:
    """Motion of the stations, rigid on their bodies: v = v0 + w x r, a = a0 + w' x r + w x (w x r).

    ``vectors`` (5,n,3) stacks the rows of a body for every station, ``rotation`` (n,3,3) the axes.
    """
    count = BLADE + len(offsets) - 1 - PITCH
    bodies, axes = np.empty((count, 5, 3)), np.empty((count, 3, 3))
    _place_bodies(time, knots, offsets, geometry, bodies, axes)
    arm, spin, bend, swing = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(len(body)):
        b = body[i]
        for row in range(3):
            arm[row] = 0.0
            for k in range(3):
                arm[row] += axes[b, row, k] * arms[i, k]
            for column in range(3):
                total = 0.0
                for k in range(3):
                    total += axes[b, row, k] * orientation[i, k, column]
                rotation[i, row, column] = total
        _cross(bodies[b, 3], arm, spin)
        _cross(bodies[b, 3], spin, bend)
        _cross(bodies[b, 4], arm, swing)
        for row in range(3):
            vectors[0, i, row] = bodies[b, 0, row] + arm[row]
            vectors[1, i, row] = bodies[b, 1, row] + spin[row]
            vectors[2, i, row] = bodies[b, 2, row] + swing[row] + bend[row]
            vectors[3, i, row] = bodies[b, 3, row]
            vectors[4, i, row] = bodies[b, 4, row]


def _geometry(turbine: Turbine, azimuth: float) -> Array:
    """What the kernel needs of the machine: azimuth, tilt, lengths, cone and the tower top."""
    nacelle, hub = turbine.nacelle, turbine.hub
    lengths = [azimuth, nacelle.tilt, nacelle.shaft_height, nacelle.overhang, hub.radius, hub.cone]
    return np.concatenate([lengths, turbine.tower.axis[-1]])


def _locate(turbine: Turbine, stations: Stations) -> tuple[int, Array, Array]:
    """The body of one part's stations, their origins (n,3) m and axes (n,3,3) on that body."""
    part, top = stations.part, turbine.tower.axis[-1]
    position, rotation = part_frames(turbine, part, stations.span)
    if part in ("nacelle", "hub"):
        return {"nacelle": NACELLE, "hub": HUB}[part], position, rotation
    if part == "tower":
        return FIXED, position - top, rotation
    if part == "platform" and turbine.platform is not None:
        return FIXED, position + (np.array(turbine.platform.reference_point) - top), rotation
    blades = [f"blade{k + 1}" for k in range(turbine.number_of_blades)]
    if part not in blades:
        raise InputError("stations", f"the turbine {turbine.name!r} has no part {part!r}")
    return BLADE + blades.index(part), position, rotation


class PrescribedMotion:
    """A rigid machine that does as it is told; loads have no effect on it.

    ``stations`` holds the stations of every load model; ``motions`` answers one
    ``Motion`` for every load model, in the same order. Raises InputError for a part
    that the turbine does not have.
    """

    channels = CHANNELS

    def __init__(
        self,
        turbine: Turbine,
        operation: PrescribedOperation,
        stations: Sequence[Sequence[Stations]],
    ) -> None:
        blades = turbine.number_of_blades
        if len(operation.pitch) != blades:
            found = f"{len(operation.pitch)} pitch angles for {blades} blades"
            raise InputError("operation", found)
        signals = (operation.rotor_speed, operation.yaw, *operation.pitch)
        tables = [signal.knots() for signal in signals]
        self.coordinates: Mapping[str, Array] = {"blade": np.arange(1.0, blades + 1.0)}
        self._knots = np.vstack(tables)
        self._offsets = np.cumsum([0, *(len(table) for table in tables)])
        self._geometry = _geometry(turbine, operation.azimuth)
        located = [(s, *_locate(turbine, s)) for group in stations for s in group]
        self._body = np.repeat([b for _, b, _, _ in located], [len(s) for s, *_ in located])
        self._arms = np.concatenate([arms for _, _, arms, _ in located])
        self._orientation = np.concatenate([axes for *_, axes in located])
        self._vectors = np.zeros((5, len(self._body), 3))
        self._rotation = np.zeros((len(self._body), 3, 3))
        self.motions = self._views([sum(map(len, group)) for group in stations])
        self.move(0.0)

    def _views(self, counts: Sequence[int]) -> tuple[Motion, ...]:
        """One motion for every group of stations, as views of the kernel's arrays."""
        ends = np.cumsum(counts)
        groups = [slice(end - count, end) for end, count in zip(ends, counts, strict=True)]
        x, v, a, w, dw = self._vectors
        return tuple(Motion(x[g], self._rotation[g], v[g], w[g], a[g], dw[g]) for g in groups)

    def move(self, time: float) -> None:
        """Write the motion at ``time`` s into ``motions``."""
        self._time = time
        _place(
            time,
            self._knots,
            self._offsets,
            self._geometry,
            self._body,
            self._arms,
            self._orientation,
            self._vectors,
            self._rotation,
        )

    def predict(self, time: float, dt: float) -> None:
        """Move to the end of the step of ``dt`` s that starts at ``time`` s."""
        self.move(time + dt)

    def balance(self, loads: Sequence[Loads]) -> bool:
        """Whether the motion is in balance with the loads: prescribed motion always is."""
        return True

    def accept(self) -> None:
        """Commit the step: the motion is a function of time alone."""

    def reject(self, time: float) -> None:
        """Return to the accepted motion at ``time`` s."""
        self.move(time)

    def record(self) -> Mapping[str, float | Array]:
        """The channels at the present time."""
        (speed, _, turned), (yaw, _, _), *pitch = (
            evaluate(self._knots, first, end, self._time)
            for first, end in zip(self._offsets[:-1], self._offsets[1:], strict=True)
        )
        return {
            "rotor_speed": speed,
            "azimuth": (self._geometry[0] + turned) % (2.0 * np.pi),
            "pitch": np.array([angle for angle, _, _ in pitch]),
            "yaw": yaw,
        }

    def state(self) -> dict[str, np.ndarray]:
        """All that the next step depends on."""
        return {"time": np.array(self._time)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.move(float(state["time"]))
