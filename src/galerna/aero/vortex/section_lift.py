"""What the sections of a lattice lift in plane flow, and the angle of attack that this tells.

In plane flow a strip of chord c has the circulation

    Gamma = c/2 (a_0 w + a_1 s)

in a relative velocity whose component across the zero-lift line is w, when a wash s is added to
the velocity through all of its panels. A flat plate has a_0 = a_1 = 2 pi, whatever its number
of panels (James 1972); camber changes them little, and all are found from the panels themselves.
Turned round, the circulation of a strip in any flow gives the velocity w that it feels, which
is what a polar calls its angle of attack, without asking for velocities next to vortices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from galerna.aero.vortex.lattice import Lattice
from galerna.contract import Array


class EffectiveFlow(NamedTuple):
    """The flow that sections (..., n) feel: angle of attack rad of the polar, and speed m/s."""

    angle_of_attack: Array
    speed: Array


@dataclass(frozen=True, eq=False)
class SectionLift:
    """Plane flow about the n strips of a surface, each with its own camber line.

    ``slope`` and ``wash_slope`` (n,) are a_0 and a_1; ``zero_lift_angle`` (n,) rad is measured
    from the line between leading and trailing edge, and ``tilt`` (n,) rad from there to the axis
    from which the polar's angle of attack is measured.
    """

    slope: Array
    wash_slope: Array
    zero_lift_angle: Array
    tilt: Array

    @classmethod
    def of_lattice(cls, lattice: Lattice, tilt: Array | float = 0.0) -> SectionLift:
        """From the panels of a surface anywhere in space."""
        strips = range(lattice.shape[1])
        plane = [_plane_lift(_section(lattice.corners, j), lattice.rings) for j in strips]
        slope, wash_slope, zero_lift = np.array(plane).T
        tilts = np.broadcast_to(np.asarray(tilt, dtype=float), len(strips))
        return cls(slope, wash_slope, zero_lift, tilts)

    @classmethod
    def joined(cls, parts: Sequence[SectionLift]) -> SectionLift:
        """The strips of several surfaces, one after the other."""
        return cls(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(cls)))

    def across(self, circulation: Array, chord: Array, wash: Array | float = 0.0) -> Array:
        """Velocity w (..., n) m/s across the zero-lift lines that gives circulations (..., n)."""
        return (2.0 * circulation / chord - self.wash_slope * wash) / self.slope

    def effective_flow(self, across: Array, chordwise: Array) -> EffectiveFlow:
        """The flow with w (..., n) m/s, and a velocity (..., n) m/s along the chord."""
        zero_lift = self.zero_lift_angle
        upwards = (across + chordwise * np.sin(zero_lift)) / np.cos(zero_lift)
        angle = np.arctan2(upwards, chordwise) + self.tilt
        return EffectiveFlow(angle, np.hypot(upwards, chordwise))


def strip_chords(corners: Array) -> tuple[Array, Array]:
    """Chords (n,) m of strips across their spans, and unit vectors (n,3) along them."""
    middle = 0.5 * (corners[:, 1:] + corners[:, :-1])
    along = _span_directions(corners)
    chord = middle[-1] - middle[0]
    chord = chord - np.sum(chord * along, axis=-1, keepdims=True) * along
    length = np.linalg.norm(chord, axis=-1)
    return length, chord / length[:, None]


def _span_directions(corners: Array) -> Array:
    quarter = 0.75 * corners[0] + 0.25 * corners[-1]
    span = np.diff(quarter, axis=0)
    return span / np.linalg.norm(span, axis=-1, keepdims=True)


def _section(corners: Array, strip: int) -> Array:
    """Camber line (m+1,2) of a strip across its span, leading edge at 0,0, trailing edge at 1,0."""
    part = corners[:, strip : strip + 2]
    chord, aft = strip_chords(part)
    up = np.cross(aft[0], _span_directions(part)[0])
    points = part.mean(axis=1)
    points = points - points[0]
    return np.stack([points @ aft[0], points @ up], axis=1) / chord[0]


def _plane_lift(line: Array, rings: str) -> tuple[float, float, float]:
    """a_0, a_1 and the zero-lift angle rad of a camber line's panels in plane flow."""
    corners = np.zeros((len(line), 2, 3))
    corners[..., 0], corners[..., 2] = line[:, :1], line[:, 1:]
    corners[:, 1, 1] = 1.0
    lattice = Lattice(corners, rings)
    vortex = lattice.vertices[:-1, 0, [0, 2]]
    point, normal = lattice.collocation[:, 0, [0, 2]], lattice.normals[:, 0, [0, 2]]
    arm = point[:, None] - vortex[None]
    turned = np.stack([arm[..., 1], -arm[..., 0]], axis=-1)
    induced = turned / (2.0 * np.pi * np.sum(arm**2, axis=-1, keepdims=True))
    influence = np.sum(induced * normal[:, None], axis=-1)
    onset = np.column_stack([normal, np.ones(len(normal))])
    by_x, by_z, by_wash = np.linalg.solve(influence, -onset).sum(axis=0)
    return 2.0 * np.hypot(by_x, by_z), 2.0 * by_wash, np.arctan2(-by_x, by_z)
