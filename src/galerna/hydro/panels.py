"""Panels on the wetted hull: of bodies of revolution, and the hydrostatics of any panels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.platform import Member

_GROWTH = 0.25  # of a panel's length per length along the hull: neighbours differ by a quarter
_CONVEX = 0.5  # rad; a sharper edge of the profile has fine panels
_FINE = 20.0  # panels at the still water and at sharp edges are this much shorter


@dataclass(frozen=True, eq=False)
class Panels:
    """Panels of a wetted hull, ``vertices`` (v,3) m and ``faces`` (f,4), normals outwards.

    A triangle has one index twice. ``lid_vertices`` and ``lid_faces`` cover the still
    water inside. ``sectors`` above 1: the whole is that many equal wedges about the z axis,
    of which one is held; of a ``mirrored`` wedge only the half of y > 0. ``revolution``: the
    wedges stand for a body of revolution.
    """

    vertices: Array
    faces: np.ndarray
    lid_vertices: Array
    lid_faces: np.ndarray
    sectors: int = 1
    mirrored: bool = False
    revolution: bool = False

    @property
    def count(self) -> int:
        """Number of panels of the whole hull, without the lid."""
        return len(self.faces) * self.sectors * (1 + self.mirrored)

    def whole(self) -> tuple[Array, np.ndarray]:
        """Vertices and faces of the whole hull."""
        vertices, faces = self.vertices, self.faces
        if self.mirrored:
            other = faces[:, [0, 3, 2, 1]] + len(vertices)
            faces = np.append(faces, other, axis=0)
            vertices = np.append(vertices, vertices * [1.0, -1.0, 1.0], axis=0)
        angles = 2.0 * np.pi / self.sectors * np.arange(self.sectors)
        steps = len(vertices) * np.arange(self.sectors)
        turned = np.concatenate([vertices @ _about_z(a).T for a in angles])
        return turned, np.concatenate([faces + step for step in steps])


def _about_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def hull_panels(vertices: ArrayLike, faces: ArrayLike) -> Panels:
    """A wetted hull from vertices (v,3) m and faces (f,3) or (f,4), without a lid."""
    corners = np.asarray(faces, dtype=int)
    if corners.shape[1] == 3:
        corners = corners[:, [0, 1, 2, 2]]
    return Panels(np.asarray(vertices, float), corners, np.zeros((0, 3)), np.zeros((0, 4), int))


def revolution_profile(members: Sequence[Member]) -> tuple[Array, Array]:
    """Corners (p,2) m of radius and height of round members stacked on one vertical axis.

    From the still water down to the axis at the keel, and the axis' (x, y). Raises
    InputError where the members are not such a body.
    """
    if not members:
        raise InputError("platform members", "there are none", "describe the hull by members")
    axis = members[0].start[:2]
    pieces = sorted((_upwards(member, axis) for member in members), key=lambda p: -p[0, 1])
    for upper, lower in pairwise(pieces):
        if abs(upper[-1, 1] - lower[0, 1]) > 1e-6:
            raise InputError(
                "platform members",
                f"the stack has a gap or an overlap between z = {upper[-1, 1]:.4g} and "
                f"{lower[0, 1]:.4g} m",
                "let one member begin where the other ends",
            )
    corners = _wetted(np.concatenate(pieces))
    keel = corners[-1]
    end = [] if keel[0] == 0.0 else [[0.0, keel[1]]]
    return np.append(corners, np.reshape(end, (-1, 2)), axis=0), axis


def is_revolution(members: Sequence[Member]) -> bool:
    """Whether the members are one stack of round ones on one vertical axis."""
    try:
        revolution_profile(members)
    except InputError:
        return False
    return True


def _upwards(member: Member, axis: Array) -> Array:
    """Radius and height (k,2) of a member's outside, from its upper end down."""
    ends = np.stack([member.start, member.end])
    if not member.round or np.abs(ends[:, :2] - axis).max() > 1e-6:
        raise InputError(
            f"member {member.name!r}",
            "is not a round member on the vertical axis of the others",
            "a body of revolution is a stack of round members on one axis",
        )
    height = member.start[2] + member.span * (member.end[2] - member.start[2])
    piece = np.stack([0.5 * np.asarray(member.sides)[:, 0], height], axis=1)
    return piece[::-1] if height[-1] > height[0] else piece


def _wetted(corners: Array) -> Array:
    """The part of a profile below z = 0, without doubled corners."""
    if corners[0, 1] <= 0.0:
        raise InputError("platform members", "the body ends below the still water", "")
    below = corners[corners[:, 1] < 0.0]
    if not len(below):
        raise InputError("platform members", "no part lies below z = 0", "")
    last = corners[corners[:, 1] >= 0.0][-1]
    part = last[1] / (last[1] - below[0, 1])
    cut = np.array([[last[0] + part * (below[0, 0] - last[0]), 0.0]])
    wet = np.append(cut, below, axis=0)
    keep = np.append(True, np.linalg.norm(np.diff(wet, axis=0), axis=1) > 1e-9)
    return np.asarray(wet[keep])


def revolution_panels(corners: Array, size: float, sectors: int = 96) -> Panels:
    """Panels of a body of revolution from its profile's corners (p,2), radius and height m.

    Along the profile they are at most ``size`` m long, a twentieth of it at the still water
    and at sharp edges, where potentials bend. Vertices lie on polygons of the circles' areas,
    so volume and waterplane area are exact whatever the number of ``sectors``.
    """
    if size <= 0.0 or sectors < 6:
        raise InputError("panels", f"size {size:g} m and {sectors} sectors make no mesh", "")
    profile = _divided(corners, size)
    waterline = corners[0, 0]
    rings = max(3, sectors // 12)
    lid = np.stack([np.linspace(waterline, 0.0, rings + 1), np.zeros(rings + 1)], axis=1)
    held = (*_wedge(profile, sectors), *_wedge(lid, sectors))
    return Panels(*held, sectors, revolution=True)


def _wedge(profile: Array, sectors: int) -> tuple[Array, np.ndarray]:
    """Vertices (2p,3) and quads (p-1,4) between two meridians; a quad on the axis is a triangle."""
    angle = 2.0 * np.pi / sectors
    radius = profile[:, 0] * np.sqrt(angle / np.sin(angle))
    first = np.stack([radius, np.zeros(len(profile)), profile[:, 1]], axis=1)
    lower = np.arange(len(profile) - 1)
    faces = np.stack([lower, lower + 1, lower + 1 + len(profile), lower + len(profile)], axis=1)
    return np.append(first, first @ _about_z(angle).T, axis=0), faces


def _divided(corners: Array, size: float) -> Array:
    """The profile's points: sizes grow from the fine corners by ``_GROWTH``."""
    fine = np.full(len(corners), size)
    fine[0] = size / _FINE
    sides = np.diff(corners, axis=0)
    heading = np.unwrap(np.arctan2(sides[:, 1], sides[:, 0]))
    fine[1:-1] = np.where(np.abs(np.diff(heading)) > _CONVEX, size / _FINE, size / 4.0)
    parts = [
        corners[i] + _steps(float(np.linalg.norm(sides[i])), fine[i], fine[i + 1], size) * sides[i]
        for i in range(len(sides))
    ]
    return np.append(np.concatenate(parts), corners[-1:], axis=0)


def _steps(length: float, first: float, last: float, size: float) -> Array:
    """Fractions (k,1) of a side where panels begin, equal steps of the integral of 1/size."""
    s = np.linspace(0.0, length, 2001)
    local = np.minimum(np.minimum(first + _GROWTH * s, last + _GROWTH * (length - s)), size)
    count = np.append(0.0, np.cumsum(0.5 * (1 / local[1:] + 1 / local[:-1]) * np.diff(s)))
    number = max(1, round(float(count[-1])))
    ends = np.interp(np.linspace(0.0, count[-1], number + 1), count, s)
    return np.asarray(ends[:-1, None] / length)


@dataclass(frozen=True, eq=False)
class Displacement:
    """Volume m3, its centre (3,) m and the waterplane's area m2 and moments of a wetted hull.

    ``first`` (2,) m3 and ``second`` (2,2) m4 are of the waterplane about the z axis.
    """

    volume: float
    center: Array
    area: float
    first: Array
    second: Array

    def stiffness(self, weight: float, reference: Array) -> Array:
        """Stiffness (6,6) of buoyancy alone about ``reference`` (3,) m; ``weight`` rho g N/m3."""
        first = self.first - self.area * reference[:2]
        mixed = np.outer(self.first, reference[:2])
        second = self.second - mixed - mixed.T + self.area * np.outer(reference[:2], reference[:2])
        plane = np.zeros((6, 6))
        lever = np.array([first[1], -first[0]])  # heave per roll and pitch, over the area
        plane[2, 2] = self.area
        plane[2, 3:5] = plane[3:5, 2] = lever
        plane[3:5, 3:5] = [[second[1, 1], -second[0, 1]], [-second[0, 1], second[0, 0]]]
        x, y, z = self.volume * (self.center - reference)
        plane[3, 3] += z
        plane[4, 4] += z
        plane[3, 5], plane[4, 5] = -x, -y
        return weight * plane


def displacement(vertices: Array, faces: np.ndarray) -> Displacement:
    """What a wetted hull displaces, from its panels (f,4) with normals outwards.

    Surface integrals of the divergence theorem, exact for triangles; the waterplane closes
    the hull at z = 0.
    """
    split = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    a, b, c = np.moveaxis(vertices[split], 1, 0)
    normal = 0.5 * np.cross(b - a, c - a)[:, 2]
    middles = np.stack([a + b, b + c, c + a]) / 2.0  # exact for polynomials of second degree

    def integral(values: Array) -> float:
        return float(values.mean(axis=0) @ normal)

    x, y, z = np.moveaxis(middles, 2, 0)
    volume = integral(z)
    center = np.array([integral(x * z), integral(y * z), integral(0.5 * z * z)]) / volume
    second = -np.array([[integral(x * x), integral(x * y)], [integral(x * y), integral(y * y)]])
    area, first = -integral(np.ones_like(z)), -np.array([integral(x), integral(y)])
    return Displacement(volume, center, area, first, second)
