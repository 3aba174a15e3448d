"""From a turbine's data to frames, beams, bodies and joints.

The tower stands on the ground or on the platform; the nacelle yaws on its top; the
generator turns in the nacelle and drives the hub through the shaft's torsion spring; the
blades pitch on the hub. Every part may be flexible or rigid.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.geometry import axis_positions, axis_tangents, section_rotations
from galerna.turbine.model import Drivetrain, SectionProperties, Turbine

from .assembly import GROUND, Structure
from .beam import Beam, Curve, damped, discretise
from .bodies import moved, rigid_body
from .foundation import PlatformModel, add_ground, add_platform
from .frames import rotation_about
from .joints import ALL, Angle, Path, hinge, turning
from .modes import natural_modes
from .pairs import Integers
from .system import System

BLADE_ELEMENTS, TOWER_ELEMENTS = 20, 10
SMALL_ARM = 0.1  #: m, radius of gyration where the data give no moment of inertia


@dataclass(frozen=True, eq=False)
class TurbineOptions:
    """What is flexible, how finely, and what turns.

    ``blade_elements`` and ``tower_elements`` 0 make the part rigid. ``rotor`` is "free"
    (a torque drives it), "locked", or a speed rad/s as a function of time; ``pitch`` rad and
    ``azimuth`` rad are the first shape's. ``rotor_motion``, ``pitch_motion`` and ``yaw_motion``
    rad turn rotor, blades and nacelle on from there as functions of time. ``base_motion`` says
    where the tower's foot or the platform's reference point is, (3,) m, and how it is turned,
    (3,3); without it a platform is free and a foot stands still. Of a platform the directions
    ``base_locked`` alone follow it (0 to 2 along, 3 to 5 about the axes). ``platform`` says how
    it is modelled. Without ``flexible_shaft`` hub and generator are one.
    """

    blade_elements: int = BLADE_ELEMENTS
    tower_elements: int = TOWER_ELEMENTS
    flexible_shaft: bool = True
    flexible_yaw: bool = True
    rotor: Literal["free", "locked"] | Angle = "free"
    azimuth: float = 0.0
    pitch: float = 0.0
    rotor_motion: Angle | None = None
    pitch_motion: tuple[Angle, ...] | None = None
    yaw_motion: Angle | None = None
    base_motion: Path | None = None
    base_locked: tuple[int, ...] = ALL
    platform: PlatformModel = "rigid"
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.80665)

    def __post_init__(self) -> None:
        for name in ("blade_elements", "tower_elements"):
            n = getattr(self, name)
            if not isinstance(n, int | np.integer) or n < 0:
                raise InputError(name, f"{n!r} is not a whole number from 0 on")


@dataclass(frozen=True, eq=False)
class TurbineSystem:
    """A turbine ready for analysis, and where its parts are among the frames.

    ``parts`` maps "tower", "nacelle", "hub", "blade1", ... to frame numbers, root first;
    ``span`` has their fractions of the part's axis, ``places`` the origin (3,) and the axes
    (3,3) of each part as it was described.
    """

    system: System
    parts: Mapping[str, Integers]
    span: Mapping[str, Array]
    places: Mapping[str, tuple[Array, Array]]
    shaft_axis: Array
    hub_center: Array


def turbine_system(turbine: Turbine, options: TurbineOptions | None = None) -> TurbineSystem:
    """Frames, beams, bodies and joints of a turbine.

    Raises InputError where a flexible part has no sectional data.
    """
    return _Builder(turbine, options or TurbineOptions()).build()


@dataclass(eq=False)
class _Builder:
    turbine: Turbine
    options: TurbineOptions
    parts: dict[str, list[str]] = field(default_factory=dict)
    span: dict[str, Array] = field(default_factory=dict)
    places: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    damping: dict[str, Array] = field(default_factory=dict)  # all blades have the same

    def build(self) -> TurbineSystem:
        self.structure = Structure(self.options.gravity)
        self._foundation()
        self._tower()
        self._nacelle()
        self._hub()
        for k in range(self.turbine.number_of_blades):
            self._blade(k)
        index = self.structure.index
        return TurbineSystem(
            self.structure.build(),
            {part: np.array([index(name) for name in names]) for part, names in self.parts.items()},
            self.span,
            self.places,
            self.shaft,
            self.hub_center,
        )

    def _foundation(self) -> None:
        platform, options, tower = self.turbine.platform, self.options, self.turbine.tower
        if platform is None:
            below = add_ground(self.structure, tower.axis[0], options.base_motion)
        else:
            below = add_platform(
                self.structure, platform, tower,
                options.platform, options.base_motion, options.base_locked,
            )  # fmt: skip
        self.base = below.base
        for name, part in below.parts.items():
            self._note(name, part.frames, part.span, part.origin, part.axes)

    def _tower(self) -> None:
        tower = self.turbine.tower
        curve = axis_curve(tower.axis_span, tower.axis, np.eye(3), np.zeros(3), tower.structure)
        length = float(np.linalg.norm(np.diff(tower.axis, axis=0), axis=1).sum())
        self.top_position = tower.axis[-1]
        elements = self.options.tower_elements
        beam = self._discretised("tower", curve, length, tower.structure, elements)
        if elements and beam is not None:
            names = self.structure.beam("tower", beam, root=self.base)
            span = beam.span
        else:
            names, span = [self.base], np.zeros(1)
            if beam is not None:
                self._lump(self.base, beam)
        self.top = names[-1]
        for height, mass in tower.extra_masses:
            position = np.array([*tower.axis[-1][:2], height])
            nearest = min(names, key=lambda name: abs(self._at(name)[2] - height))
            self._attach(nearest, rigid_body(mass), position, np.eye(3))
        self._note("tower", names, span, np.zeros(3), np.eye(3))

    def _nacelle(self) -> None:
        nacelle, s = self.turbine.nacelle, self.structure
        center = np.array(nacelle.center_of_mass)
        about_yaw = nacelle.yaw_inertia - nacelle.mass * (center[0] ** 2 + center[1] ** 2)
        small = SMALL_ARM**2 * nacelle.mass
        body = rigid_body(nacelle.mass, center, np.array([small, small, max(about_yaw, small)]))
        body += rigid_body(nacelle.yaw_bearing_mass)
        s.frame("nacelle", self.top_position, mass=body)
        spring = nacelle.yaw_stiffness if self.options.flexible_yaw else 0.0
        bearing = hinge(
            "yaw bearing", self.top, "nacelle", self.top_position, np.array([0.0, 0, 1]),
            angle=None if spring else _still, stiffness=spring, damping=nacelle.yaw_damping,
        )  # fmt: skip
        if self.options.yaw_motion is not None:
            bearing = replace(bearing, placement=turning(self.options.yaw_motion))
        s.join(bearing)
        self._note("nacelle", ["nacelle"], np.zeros(1), self.top_position, np.eye(3))

    def _hub(self) -> None:
        t, s = self.turbine, self.structure
        nacelle, drivetrain = t.nacelle, t.drivetrain
        tilted = rotation_about(1, nacelle.tilt)
        self.shaft = tilted[:, 0]
        self.hub_center = (
            self.top_position
            + np.array([0.0, 0.0, nacelle.shaft_height])
            - nacelle.overhang * self.shaft
        )
        self.hub_axes = tilted @ rotation_about(0, self.options.azimuth)
        small = SMALL_ARM**2 * t.hub.mass
        inertia = np.array([max(t.hub.inertia, small), small, small])
        hub = rigid_body(t.hub.mass, np.array([t.hub.center_of_mass, 0.0, 0.0]), inertia)
        own, geared = generator_inertias(drivetrain)
        s.frame("hub", self.hub_center, self.hub_axes, hub)
        self._note("hub", ["hub"], np.zeros(1), self.hub_center, self.hub_axes)
        driven = (
            "generator" if self.options.flexible_shaft and drivetrain.shaft_stiffness else "hub"
        )
        if driven == "generator":
            light = rigid_body(1.0, None, np.array([max(own, 1.0), 1.0, 1.0]))
            s.frame("generator", self.hub_center, self.hub_axes, light)
            s.join(
                hinge("shaft", "generator", "hub", self.hub_center, self.shaft,
                      stiffness=drivetrain.shaft_stiffness, damping=drivetrain.shaft_damping)
            )  # fmt: skip
        else:
            s.add_mass("hub", np.diag([0.0, 0.0, 0.0, own, 0.0, 0.0]), weighs=False)
        angle, speed = self._turning()
        s.join(
            hinge("main bearing", "nacelle", driven, self.hub_center, self.shaft, angle, speed,
                  inertance=geared)
        )  # fmt: skip

    def _turning(self) -> tuple[Angle | None, Angle | None]:
        """Angle and speed of the main bearing as functions of time, where it is driven."""
        rotor = self.options.rotor
        if self.options.rotor_motion is not None:
            return self.options.rotor_motion, None
        if rotor == "free":
            return None, None
        if rotor == "locked":
            return _still, None
        if callable(rotor):
            return None, rotor
        raise InputError("rotor", f"{rotor!r} is neither 'free', 'locked' nor a speed of time")

    def _blade(self, k: int) -> None:
        blade, hub, s = self.turbine.blade, self.turbine.hub, self.structure
        name = f"blade{k + 1}"
        axes = (
            self.hub_axes
            @ rotation_about(0, 2.0 * np.pi * k / self.turbine.number_of_blades)
            @ rotation_about(1, -hub.cone)
        )
        root = self.hub_center + hub.radius * axes[:, 2]
        pitched = axes @ rotation_about(2, -self.options.pitch)
        curve = axis_curve(blade.axis_span, blade.axis, pitched, root, blade.structure)
        elements = self.options.blade_elements
        beam = self._discretised(name, curve, blade.length, blade.structure, elements)
        if beam is None:
            return
        if elements:
            names, span = s.beam(name, beam), beam.span
        else:
            names, span = [s.frame(f"{name}[0]", beam.position[0], beam.rotation[0])], np.zeros(1)
            self._lump(names[0], beam)
        inertia = np.diag([0.0, 0, 0, 0, 0, hub.pitch_system_inertia])
        s.add_mass(names[0], inertia, weighs=False)
        motion = self.options.pitch_motion
        angle = _still if motion is None else motion[k]
        s.join(hinge(f"pitch bearing {k + 1}", "hub", names[0], root, -axes[:, 2], angle=angle))
        self._note(name, names, span, root, pitched)

    def _discretised(
        self, name: str, curve: Curve, length: float, sections: SectionProperties | None, n: int
    ) -> Beam | None:
        if sections is None:
            if n:
                raise InputError(
                    f"{self.turbine.name}, {name}", "no sectional stiffness and inertia are given",
                    f"make it rigid with {name.rstrip('0123456789')}_elements: 0",
                )  # fmt: skip
            return None
        span = np.linspace(0.0, 1.0, (n or BLADE_ELEMENTS) + 1)
        beam = discretise(curve, length, sections, span, name)
        if sections.damping_ratio is None or n == 0:
            return beam
        kind = name.rstrip("0123456789")
        if kind not in self.damping:
            self.damping[kind] = damping_of(beam, sections.damping_ratio)
        return damped(beam, self.damping[kind])

    def _lump(self, frame: str, beam: Beam) -> None:
        """All of a beam's mass on one frame."""
        for mass, x, R in zip(beam.mass, beam.position, beam.rotation, strict=True):
            self._attach(frame, mass, x, R)

    def _attach(self, frame: str, mass: Array, position: Array, rotation: Array) -> None:
        i = self.structure.index(frame)
        if i == 0:
            return
        x, R = self.structure.place(frame, position, rotation)
        self.structure.add_mass(frame, moved(mass, R, x))

    def _at(self, frame: str) -> Array:
        return self.structure.position(frame)

    def _note(self, part: str, names: list[str], span: Array, origin: Array, axes: Array) -> None:
        self.parts[part], self.span[part], self.places[part] = names, span, (origin, axes)


def generator_inertias(drivetrain: Drivetrain) -> tuple[float, float]:
    """What of a generator's inertia kg m2, at the low-speed shaft, turns with the shaft and what
    resists its speed in the nacelle.

    With an inertia J and a ratio n its energy is J (n s + (1 - n) r)^2 / 2 for spins s of the
    shaft and r of the nacelle about it: n J turning with the shaft and n (n - 1) J between both,
    but for the nacelle's own part, (1 - n) J. So it adds n J alone to the gyroscopic moments,
    and the gearbox's housing passes to the nacelle what speeds the generator up.
    """
    inertia, ratio = drivetrain.generator_inertia, drivetrain.gear_ratio
    between = inertia * min(max(ratio * (ratio - 1.0), 0.0), ratio**2)
    return inertia * ratio**2 - between, between


def axis_curve(
    axis_span: Array, axis: Array, rotation: Array, origin: Array,
    sections: SectionProperties | None,
) -> Curve:  # fmt: skip
    """The reference axis of a part, given in its own axes, with the elastic section axes."""

    def curve(span: Array) -> tuple[Array, Array]:
        twist = np.zeros(len(span))
        if sections is not None:
            twist = np.interp(span, sections.span, sections.twist)
        local = section_rotations(axis_tangents(axis_span, axis, span), twist)
        return origin + axis_positions(axis_span, axis, span) @ rotation.T, rotation @ local

    return curve


def damping_of(beam: Beam, ratio: float) -> Array:
    """Stiffness-proportional damping (6,) s that gives the first two bending modes ``ratio``.

    The lower of the two cantilever modes that move along x sets Fx, Fz, My and Mz, the
    other one Fy and Mx.
    """
    s = Structure((0.0, 0.0, 0.0))
    s.beam("beam", beam, root=GROUND)
    system = s.build()
    modes = natural_modes(system, system.initial_state(), 2)
    tip = np.abs(modes.shape[:, -1, :2])
    order = np.argsort(tip[:, 1] / (tip[:, 0] + tip[:, 1]))
    flap, edge = ratio / (np.pi * modes.frequency[order])
    return np.array([flap, edge, flap, edge, flap, flap])


def _still(time: float) -> float:
    return 0.0
