"""What a tower stands on: the ground, a foot that is moved, or a platform.

A platform is one rigid body, or one of two models of a spar (dissertation, eqs. 3.12-3.15):
``concentrated_spar`` lumps all but the piece between still water and the tower into one mass;
``flexible_spar`` is two beams and a ballast. Both keep mass, centre and moments of inertia.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.model import SectionProperties, Tower
from galerna.turbine.platform import Platform

from .assembly import GROUND, Structure
from .beam import discretise, straight, uniform
from .bodies import rigid_body
from .constraints import HeldAlong
from .frames import rotation_about
from .joints import ALL, Joint, Path

PlatformModel = Literal["rigid", "concentrated_spar", "flexible_spar"]
FOOT_MASS = 1.0  #: kg and kg m2, of a foot that is moved
STIFFER = 100.0  #: times the tower's foot: a spar, by the dissertation
DOWNWARDS = rotation_about(1, np.pi)  #: axes of a spar's beam, z to the keel
BASE_ELEMENTS = 2  #: between still water and the tower
LONGEST_ELEMENT = 10.0  #: m, of a flexible spar


@dataclass(frozen=True, eq=False)
class Part:
    """A part's frames, root first, their fractions of its axis, its origin (3,) and axes (3,3)."""

    frames: list[str]
    span: Array
    origin: Array
    axes: Array


@dataclass(frozen=True, eq=False)
class Foundation:
    """The frame that carries the tower, and the parts below it by name."""

    base: str
    parts: dict[str, Part]


def add_ground(structure: Structure, foot: Array, path: Path | None) -> Foundation:
    """The ground, or a light foot at ``foot`` (3,) m that follows a path."""
    if path is None:
        return Foundation(GROUND, {})
    body = rigid_body(FOOT_MASS, None, FOOT_MASS * np.ones(3))
    structure.frame("foot", foot, mass=body)
    structure.join(_moved_base("foot", foot, path, ALL))
    return Foundation("foot", {})


def add_platform(
    structure: Structure,
    platform: Platform,
    tower: Tower,
    model: PlatformModel = "rigid",
    path: Path | None = None,
    locked: tuple[int, ...] = ALL,
) -> Foundation:
    """A platform, free to move but for the ``locked`` directions where a ``path`` is given.

    Raises InputError where a spar model does not suit it.
    """
    place = np.array(platform.reference_point)
    center = np.subtract(platform.center_of_mass, place)
    base, parts = "platform", dict[str, Part]()
    if model == "rigid":
        body = rigid_body(platform.mass, center, np.array(platform.inertia))
        structure.frame("platform", place, mass=body)
    else:
        spar = Spar.of(platform, tower, model)
        structure.frame("platform", place, mass=spar.body)
        base, parts = _add_spar(structure, spar, place)
    if path is not None:
        _hold(structure, "platform", place, path, locked)
    return Foundation(
        base, {"platform": Part(["platform"], np.zeros(1), place, np.eye(3)), **parts}
    )


@dataclass(frozen=True, eq=False)
class Spar:
    """A spar about a point at still water: ``body`` (6,6) there, a base above, a beam below.

    ``above`` and ``below`` m are the lengths; ``linear_mass`` kg/m and ``rotary`` kg m are those
    of both beams, ``ballast`` kg stands ``ballast_depth`` m below.
    """

    above: float
    below: float
    linear_mass: float
    rotary: Array
    body: Array
    stiffness: Array
    tower_stiffness: Array
    ballast: float = 0.0
    ballast_depth: float = 0.0

    @property
    def span(self) -> Array:
        """Fractions (k,) at which the beam below has nodes: its ends, the ballast, and between."""
        return np.unique(np.concatenate(list(_spans(self))))

    @classmethod
    def of(cls, platform: Platform, tower: Tower, model: PlatformModel) -> Spar:
        """The model of a platform; InputError where there is none with its figures."""
        foot = tower.structure
        where = f"platform, {model}"
        if foot is None:
            raise InputError(where, "the tower gives no section at its foot", "use model: rigid")
        place = np.array(platform.reference_point)
        above = float(tower.axis[0, 2] - place[2])
        center = np.subtract(platform.center_of_mass, place)
        if not above > 0.0 or np.abs(center[:2]).max() > 1e-6 or not center[2] < 0.0:
            what = "a spar has its centre below the reference point and the tower's foot above it"
            raise InputError(where, what, "use model: rigid")
        make = _concentrated if model == "concentrated_spar" else _flexible
        spar = make(platform, foot, above, float(center[2]))
        if spar is None:
            what = "no ballast and beam have its mass, centre and moments of inertia"
            raise InputError(where, what, "use model: rigid")
        return spar


def _concentrated(
    platform: Platform, foot: SectionProperties, above: float, center: float
) -> Spar | None:
    """Eqs. 3.12-3.14; the moment of inertia about z is the platform's, not that of a lamina."""
    linear, rotary = float(foot.mass[0]), np.diag(foot.inertia[0])[3:]
    mass = platform.mass - linear * above
    depth = (platform.mass * center - 0.5 * linear * above**2) / mass
    inertia = np.array(platform.inertia) - above * rotary
    about_water = platform.mass * center**2 - linear * above**3 / 3.0
    inertia[:2] += about_water - mass * depth**2
    if not (mass > 0.0 and inertia.min() > 0.0):
        return None
    stiff = STIFFER * foot.stiffness[0]
    body = rigid_body(mass, np.array([0.0, 0.0, depth]), inertia)
    return Spar(above, 0.0, linear, rotary, body, stiff, stiff)


def _flexible(
    platform: Platform, foot: SectionProperties, above: float, center: float
) -> Spar | None:
    """Eq. 3.15, with the sum of both cubes: the base stands on the other side of still water."""
    below, length = platform.draft, above + platform.draft
    polar = platform.inertia[2] / length
    rotary = np.array([0.5, 0.5, 1.0]) * polar
    first = platform.mass * center
    second = platform.inertia[0] + platform.mass * center**2 - length * rotary[0]
    lever, square = 0.5 * (above**2 - below**2), (above**3 + below**3) / 3.0
    # (first - m lever)^2 = (mass - m length) (second - m square)
    quadratic = np.array(
        [
            lever**2 - length * square,
            -2.0 * first * lever + length * second + platform.mass * square,
            first**2 - platform.mass * second,
        ]
    )
    for linear in sorted(float(r.real) for r in np.roots(quadratic) if abs(r.imag) < 1e-9):
        ballast = platform.mass - linear * length
        if linear > 0.0 and ballast > 0.0:
            depth = -(first - linear * lever) / ballast
            if 0.0 < depth < below:
                small = rigid_body(FOOT_MASS, None, FOOT_MASS * np.ones(3))
                stiff = STIFFER * foot.stiffness[0]
                own = foot.stiffness[0]
                return Spar(above, below, linear, rotary, small, stiff, own, ballast, depth)
    return None


def _add_spar(structure: Structure, spar: Spar, place: Array) -> tuple[str, dict[str, Part]]:
    """Beams above and below the platform's frame; the frame that carries the tower."""
    inertia = np.diag([*(3 * [spar.linear_mass]), *spar.rotary])
    up = SectionProperties(
        np.array([0.0, 1.0]),
        np.stack([spar.stiffness, spar.tower_stiffness]),
        np.tile(inertia, (2, 1, 1)),
        np.zeros(2),
    )
    base = discretise(
        straight(place, np.eye(3), spar.above), spar.above, up,
        np.linspace(0.0, 1.0, BASE_ELEMENTS + 1), "base",
    )  # fmt: skip
    names = structure.beam("base", base, root="platform")
    if not spar.below:
        return names[-1], {}
    axes = DOWNWARDS
    span = spar.span
    below = discretise(
        straight(place, axes, spar.below),
        spar.below,
        uniform(spar.stiffness, inertia),
        span,
        "spar",
    )
    frames = structure.beam("spar", below, root="platform")
    at = frames[int(np.argmin(np.abs(span * spar.below - spar.ballast_depth)))]
    structure.add_mass(at, rigid_body(spar.ballast))
    return names[-1], {"spar": Part(frames, span, place, axes)}


def _spans(spar: Spar) -> Iterator[Array]:
    """Fractions of the beam below: its ends and the ballast, and equal elements between them."""
    stops = np.array([0.0, spar.ballast_depth, spar.below]) / spar.below
    for first, last in pairwise(stops):
        elements = int(np.ceil((last - first) * spar.below / LONGEST_ELEMENT))
        yield np.linspace(first, last, elements + 1)


def _hold(
    structure: Structure, frame: str, place: Array, path: Path, locked: tuple[int, ...]
) -> None:
    """Lock some directions of a frame that may turn: along the global axes, about its path's."""
    along, about = (tuple(k for k in locked if k // 3 == kind) for kind in (0, 1))
    if 0 < len(along) < 3 and len(about) < 3:
        structure.constrain(HeldAlong("base, along", frame, along, path))
        locked = about
    if locked:
        structure.join(_moved_base(frame, place, path, locked))


def _moved_base(frame: str, place: Array, path: Path, locked: tuple[int, ...]) -> Joint:
    """A frame that was described at ``place`` (3,) m, unturned, and follows a path."""

    def travelled(time: float) -> tuple[Array, Array]:
        x, R = path(time)
        return x - place, R

    return Joint("base", GROUND, frame, place, np.eye(3), locked, placement=travelled)


def held_at(place: Array) -> Path:
    """A path that stays at ``place`` (3,) m, unturned."""
    return lambda time: (place, np.eye(3))
