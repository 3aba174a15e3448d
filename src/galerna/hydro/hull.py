"""The hull of a platform: members as closed surfaces, and their union, nothing twice.

A round section is a polygon of the circle's own area, so that a lone member's volume is exact
and its waterplane's second moment is too large by t^4 / 180, t being the angle of a facet
(tests/hydro/test_hull.py). Where members meet, their curves of intersection are polygons too;
the volume of VolturnUS-S errs by 2e-6 with 32 facets, less by the third power with more.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.platform import Member

FACETS = 48  #: around a round member
_WATERPLANE = 1e-6  #: m from z = 0 within which a facet lies on the still water


@dataclass(frozen=True, eq=False)
class Hull:
    """A surface of ``triangles`` (f,3) between ``vertices`` (v,3) m, seen from outside
    counterclockwise; global axes, upright, z = 0 at the still water."""

    vertices: Array
    triangles: np.ndarray

    def area_vectors(self) -> Array:
        """Areas times outward normals (f,3) m2."""
        a, b, c = np.moveaxis(self.vertices[self.triangles], 1, 0)
        return 0.5 * np.cross(b - a, c - a)

    @property
    def volume(self) -> float:
        """Enclosed volume m3."""
        centers = self.vertices[self.triangles].mean(axis=1)
        return float((centers * self.area_vectors()).sum() / 3.0)

    @property
    def area(self) -> float:
        """Area of the surface m2."""
        return float(np.linalg.norm(self.area_vectors(), axis=1).sum())


def build_hull(members: Sequence[Member], facets: int = FACETS) -> Hull:
    """The closed outside of members, where they overlap of their union.

    Raises InputError without members, or if members overlap and manifold3d is missing.
    """
    if not members:
        raise InputError("platform", "has no members, so no hull", "describe it by members")
    if facets < 8:
        raise InputError("hull", f"{facets} facets around a member", "at least 8")
    solids = [_member_surface(member, facets) for member in members]
    if len(members) == 1 or not _any_close(members):
        return _joined(solids)
    manifold = _manifold()
    whole = manifold.Manifold.batch_boolean(
        [_solid(manifold, m.name, s) for m, s in zip(members, solids, strict=True)],
        manifold.OpType.Add,
    )
    return _from_manifold(whole)


def wetted_surface(hull: Hull) -> Hull:
    """The part of a hull below z = 0, open at the still water. Raises InputError if it is dry."""
    height = hull.vertices[:, 2]
    if height.min() >= 0.0:
        raise InputError("hull", f"lies above the water, from z = {height.min():g} m on")
    pieces = [hull.triangles[(height[hull.triangles] <= 0.0).all(axis=1)]]
    vertices, cut = _cut(hull)
    wet = Hull(vertices, np.concatenate([*pieces, cut]))
    on_water = np.abs(wet.vertices[wet.triangles][:, :, 2]).max(axis=1) < _WATERPLANE
    return _without_loose_vertices(Hull(wet.vertices, wet.triangles[~on_water]))


def _member_surface(member: Member, facets: int) -> Hull:
    """Rings of a member's sections, joined, and closed at the ends."""
    loop = _loop(member, facets)
    n, axes = len(loop), member.axes()
    centers = member.start + member.span[:, None] * (member.end - member.start)
    rings = centers[:, None] + (member.sides[:, None] * loop) @ axes[:, :2].T
    vertices = np.concatenate([rings.reshape(-1, 3), centers[[0, -1]]])
    bottom, top = len(vertices) - 2, len(vertices) - 1
    first, last = np.arange(n), (len(rings) - 1) * n + np.arange(n)
    ends = [_fan(bottom, np.roll(first, -1), first), _fan(top, last, np.roll(last, -1))]
    sides = [_band(k * n + np.arange(n), n) for k in range(len(rings) - 1)]
    return Hull(vertices, np.concatenate([*sides, *ends]))


def _loop(member: Member, facets: int) -> Array:
    """A section (n,2) of sides 1, counterclockwise about the axis."""
    if not member.round:
        return 0.5 * np.array([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
    angle = 2.0 * np.pi / facets
    radius = 0.5 * np.sqrt(angle / np.sin(angle))
    around = angle * np.arange(facets)
    return radius * np.stack([np.cos(around), np.sin(around)], axis=1)


def _fan(center: int, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.stack([np.full(len(first), center), first, second], axis=1)


def _band(ring: np.ndarray, step: int) -> np.ndarray:
    """Triangles between a ring and the next one, ``step`` vertices further on."""
    following = np.roll(ring, -1)
    lower = np.stack([ring, following, following + step], axis=1)
    return np.concatenate([lower, np.stack([ring, following + step, ring + step], axis=1)])


def _joined(parts: Sequence[Hull]) -> Hull:
    """Separate surfaces as one."""
    starts = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    triangles = [part.triangles + start for part, start in zip(parts, starts, strict=True)]
    return Hull(np.concatenate([p.vertices for p in parts]), np.concatenate(triangles))


def _any_close(members: Sequence[Member]) -> bool:
    """Whether two members may touch: their axes come nearer than their half diagonals."""
    return any(_distance(a, b) < _reach(a) + _reach(b) for a, b in combinations(members, 2))


def _reach(member: Member) -> float:
    factor = 0.5 * np.sqrt(2.0 * np.pi / FACETS / np.sin(2.0 * np.pi / FACETS))
    diagonal = np.hypot(*member.sides.T) / (np.sqrt(2.0) if member.round else 1.0)
    return float(factor * diagonal.max() * 1.01)


def _distance(a: Member, b: Member, points: int = 200) -> float:
    """Distance m of two axes, from below: that of points on them less their spacing."""
    along = np.linspace(0.0, 1.0, points)[:, None]
    pa, pb = (m.start + along * (m.end - m.start) for m in (a, b))
    nearest = np.linalg.norm(pa[:, None] - pb[None], axis=2).min()
    return float(nearest - 0.5 * (a.length + b.length) / (points - 1))


def _manifold() -> Any:
    try:
        import manifold3d
    except ImportError as e:
        what = "members overlap, and their union needs the package manifold3d"
        raise InputError("hull", what, "pip install 'galerna[hydro]'") from e
    return manifold3d


def _solid(manifold: Any, name: str, surface: Hull) -> Any:
    mesh = manifold.Mesh64(
        np.ascontiguousarray(surface.vertices), surface.triangles.astype(np.uint64)
    )
    solid = manifold.Manifold(mesh)
    if solid.status() != manifold.Error.NoError:
        raise InputError(f"member {name!r}", f"has no proper outside: {solid.status().name}")
    return solid


def _from_manifold(solid: Any) -> Hull:
    mesh = solid.to_mesh64()
    vertices = np.array(mesh.vert_properties, dtype=float)[:, :3]
    return Hull(vertices, np.array(mesh.tri_verts, dtype=np.int64))


def _cut(hull: Hull) -> tuple[Array, np.ndarray]:
    """All vertices and those on the water, and triangles (k,3) of what it cuts off below."""
    height = hull.vertices[:, 2]
    vertices = list(hull.vertices)
    known: dict[tuple[int, int], int] = {}

    def crossing(a: int, b: int) -> int:
        a, b = min(a, b), max(a, b)
        if (a, b) not in known:
            part = height[a] / (height[a] - height[b])
            point = hull.vertices[a] + part * (hull.vertices[b] - hull.vertices[a])
            known[a, b] = len(vertices)
            vertices.append(np.array([point[0], point[1], 0.0]))
        return known[a, b]

    found = [piece for t in hull.triangles for piece in _pieces_below(t, height, crossing)]
    return np.array(vertices), np.array(found, dtype=np.int64).reshape(-1, 3)


def _pieces_below(t: np.ndarray, height: Array, crossing: Any) -> Iterator[tuple[int, int, int]]:
    """What is below the water of a triangle that crosses it."""
    sides = np.sign(height[t])
    if sides.min() >= 0.0 or sides.max() <= 0.0:
        return
    polygon: list[int] = []
    for i in range(3):
        a, b = int(t[i]), int(t[(i + 1) % 3])
        if height[a] <= 0.0:
            polygon.append(a)
        if height[a] * height[b] < 0.0:
            polygon.append(crossing(a, b))
    for k in range(1, len(polygon) - 1):
        yield polygon[0], polygon[k], polygon[k + 1]


def _without_loose_vertices(hull: Hull) -> Hull:
    used, triangles = np.unique(hull.triangles, return_inverse=True)
    return Hull(hull.vertices[used], triangles.reshape(-1, 3))
