"""Panels of any hull: the wetted union of its members, of which symmetry leaves a part."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.hydro.hull import Hull, build_hull, wetted_surface
from galerna.hydro.hydrostatics import hydrostatics
from galerna.hydro.panels import Displacement, Panels, hull_panels
from galerna.hydro.remesh import even_panels
from galerna.turbine.platform import Member, Platform

_SAME = 0.01  # m between a member and another's image; files round their figures
_WELD = 1e-5  # m between vertices that are one
_NEAR = 0.2  # panels from a plane within which an open edge's end belongs to it
_FOLDS = (4, 3, 2)  # of the symmetries that are looked for


def platform_panels(platform: Platform, size: float) -> tuple[Panels, Displacement]:
    """Panels of about ``size`` m of a platform, about its reference point, and what it displaces.

    The displacement is the members' own: panels lie inside curved sides. Raises InputError.
    """
    reference = np.array([*platform.reference_point[:2], 0.0])
    hull = build_hull(platform.members)
    statics = hydrostatics(hull, reference)
    wet = wetted_surface(Hull(hull.vertices - reference, hull.triangles))
    folds, mirrored = symmetry(platform.members, reference)
    part = even_panels(wet, size) if not mirrored else _even_half_wedge(wet, folds, size)
    held = hull_panels(part.vertices, part.triangles)
    lid = _lid(wet.vertices[_open_edges(wet)], np.pi / folds if mirrored else 2.0 * np.pi, size)
    panels = Panels(held.vertices, held.faces, *lid, folds if mirrored else 1, mirrored)
    first = statics.area * statics.center_of_flotation
    xx, yy, xy = statics.moments
    second = np.array([[xx, xy], [xy, yy]])
    center = statics.center_of_buoyancy - reference
    return panels, Displacement(statics.volume, center, statics.area, first, second)


def symmetry(members: Sequence[Member], reference: Array) -> tuple[int, bool]:
    """How many equal wedges about the vertical, and whether x z is a plane of symmetry."""
    shapes = [_shape(member, reference) for member in members]
    mirror = np.diag([1.0, -1.0, 1.0])
    folds = next((n for n in _FOLDS if _same(shapes, _turn(2.0 * np.pi / n))), 1)
    return folds, _same(shapes, mirror)


def _turn(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _shape(member: Member, reference: Array) -> Array:
    """Stations (k,5) of a member: place and sides, from its lower or farther end."""
    axis = member.start + np.outer(member.span, member.end - member.start) - reference
    return np.hstack([axis, np.asarray(member.sides)])


def _same(shapes: Sequence[Array], matrix: Array) -> bool:
    """Whether every shape has a twin where a turn or a mirror takes it."""

    def twin(moved: Array) -> bool:
        return any(
            shape.shape == moved.shape
            and min(np.abs(shape - moved).max(), np.abs(shape[::-1] - moved).max()) < _SAME
            for shape in shapes
        )

    return all(twin(np.hstack([s[:, :3] @ matrix.T, s[:, 3:]])) for s in shapes)


def _even_half_wedge(wet: Hull, folds: int, size: float) -> Hull:
    """Even panels of half a wedge whose open edges lie on the cuts and on the still water.

    Evening moves them a little, along the surface; they are put back.
    """
    part = even_panels(_half_wedge(wet, folds), size)
    edge = np.unique(_open_edges(part))
    points = part.vertices.copy()
    normals = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], *_far_side(folds)])
    for _ in range(2):  # to the nearest plane, and into the corner of two
        away = points[edge] @ normals.T
        for k, normal in enumerate(normals):
            nearest = np.abs(away).argmin(axis=1) == k
            moved = nearest | (np.abs(away[:, k]) < _NEAR * size)
            points[edge[moved]] -= np.outer(away[moved, k], normal)
    return Hull(points, part.triangles)


def _far_side(folds: int) -> list[list[float]]:
    """Normal of the plane at half a wedge's angle; none where that is the plane of symmetry."""
    angle = np.pi / folds
    return [] if folds == 1 else [[-np.sin(angle), np.cos(angle), 0.0]]


def _half_wedge(hull: Hull, folds: int) -> Hull:
    """The part between the plane of symmetry, y > 0, and half a wedge's angle from it."""
    half = _behind(hull, np.array([0.0, -1.0, 0.0]))
    for normal in _far_side(folds):
        half = _behind(half, np.array(normal))
    return half


def _behind(hull: Hull, normal: Array) -> Hull:
    """The part of a surface against a horizontal direction, cut as the still water cuts."""
    along = np.cross(normal, [0.0, 0.0, 1.0])
    frame = np.stack([along, np.cross(normal, along), normal])  # rows: right-handed, normal up
    cut = wetted_surface(Hull(hull.vertices @ frame.T, hull.triangles))
    return _welded(Hull(cut.vertices @ frame, cut.triangles))


def _welded(hull: Hull) -> Hull:
    """The same with equal vertices made one and triangles without area left out."""
    _, first, number = np.unique(
        np.round(hull.vertices / _WELD).astype(int), axis=0, return_index=True, return_inverse=True
    )
    welded = Hull(hull.vertices[first], number.reshape(-1)[hull.triangles])
    a, b, c = welded.triangles.T
    apart = (a != b) & (b != c) & (c != a)
    return Hull(welded.vertices, welded.triangles[apart])


def _lid(lines: Array, angle: float, size: float) -> tuple[Array, np.ndarray]:
    """Vertices and quads on the still water inside the waterlines, of a wedge from x on.

    Rings about the z axis, divided evenly, so that a wedge's copies do not overlap.
    """
    reach = float(np.linalg.norm(lines[:, :, :2], axis=2).max())
    rings = [
        _ring(inner, inner + size, angle, max(1, round(angle * (inner + 0.5 * size) / size)))
        for inner in size * np.arange(int(reach / size))
    ]
    cells = np.concatenate(rings)
    cells = cells[_inside(cells, lines).all(axis=1)]
    return cells.reshape(-1, 3), np.arange(4 * len(cells)).reshape(-1, 4)


def _ring(inner: float, outer: float, angle: float, parts: int) -> Array:
    """Corners (parts,4,3) of the cells of a ring, which look down."""
    edges = np.linspace(0.0, angle, parts + 1)
    corners = [(inner, edges[:-1]), (inner, edges[1:]), (outer, edges[1:]), (outer, edges[:-1])]
    return np.stack(
        [np.stack([r * np.cos(a), r * np.sin(a), 0.0 * a], axis=1) for r, a in corners], 1
    )


def _inside(points: Array, lines: Array) -> NDArray[np.bool_]:
    """Which points (...,3) an odd number of the segments (k,2,3) shut in."""
    x, y = points[..., 0, None], points[..., 1, None]
    (ax, ay), (bx, by) = lines[:, 0, :2].T, lines[:, 1, :2].T
    crosses = (ay > y) != (by > y)
    rise = np.where(by == ay, 1.0, by - ay)
    return np.asarray((crosses & (x < ax + (y - ay) / rise * (bx - ax))).sum(axis=-1) % 2 == 1)


def _open_edges(hull: Hull) -> np.ndarray:
    """Ends (k,2), by number, of the edges with a triangle on one side alone."""
    edges = {(int(t[i - 1]), int(t[i])) for t in hull.triangles for i in range(3)}
    return np.array(sorted(e for e in edges if e[::-1] not in edges))
