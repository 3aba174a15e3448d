"""Panels of even size on a surface of triangles: for panel codes.

Edges are split, collapsed and flipped and vertices moved along the surface until all have
about one length; edges where the surface bends sharply, or ends, stay where they are. Botsch
and Kobbelt, A remeshing approach to multiresolution modeling, SGP 2004.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import dist

import numpy as np

from galerna.errors import InputError
from galerna.hydro.hull import Hull
from galerna.hydro.nearest import onto
from galerna.hydro.triangle_mesh import (
    SHARP,
    ChangingMesh,
    Corners,
    Edge,
    Point,
    cosine,
    edge_of,
    norm,
)

_LONG, _SHORT, _TINY = 4.0 / 3.0, 4.0 / 5.0, 0.3  #: of the size: split, collapse, collapse always
_SWEEPS = 6
_MOST_PANELS = 50_000


@dataclass(frozen=True)
class Quality:
    """Panels: their number, smallest angle rad, largest ratio of longest edge to height."""

    panels: int
    smallest_angle: float
    largest_aspect: float


def quality(hull: Hull) -> Quality:
    """How even the triangles of a surface are."""
    corners = hull.vertices[hull.triangles]
    edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    edges.sort(axis=1)
    area = np.linalg.norm(hull.area_vectors(), axis=1)
    sine = 2.0 * area / (edges[:, 1] * edges[:, 2])
    aspect = edges[:, 2] ** 2 / np.maximum(2.0 * area, 1e-300)
    smallest = float(np.arcsin(np.clip(sine, 0.0, 1.0)).min())
    return Quality(len(corners), smallest, float(aspect.max()))


def even_panels(hull: Hull, size: float) -> Hull:
    """The same surface with edges of about ``size`` m. Raises InputError for too many panels."""
    expected = hull.area / (0.433 * size * size) if size > 0.0 else np.inf
    if expected > _MOST_PANELS:
        what = f"edges of {size:g} m make about {expected:.3g} panels"
        raise InputError("panel size", what, f"at most {_MOST_PANELS} can be computed")
    mesh = ChangingMesh(hull)
    for _ in range(_SWEEPS):
        _split_long(mesh, _LONG * size)
        _collapse_short(mesh, size)
        _flip(mesh)
        _smooth(mesh, hull)
    return _with_volume_of(hull, mesh.hull())


def _split_long(mesh: ChangingMesh, longest: float) -> None:
    """Halve edges until none is too long."""
    while long := sorted((e for e in mesh.edges() if mesh.length(e) > longest), key=mesh.length):
        touched: set[int] = set()
        for edge in reversed(long):
            beside = mesh.beside(edge)
            if not beside & touched and all(t in mesh.triangles for t in beside):
                touched |= beside
                _split(mesh, edge)


def _split(mesh: ChangingMesh, edge: Edge) -> None:
    p, q = (mesh.points[i] for i in edge)
    middle = len(mesh.points)
    mesh.points.append((0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])))
    mesh.around.append(set())
    for t in mesh.beside(edge):
        corners = mesh.remove(t)
        for end in edge:
            a, b, c = (middle if i == end else i for i in corners)
            mesh.add(a, b, c)
    if edge in mesh.features:
        mesh.features.discard(edge)
        mesh.features |= {edge_of(edge[0], middle), edge_of(edge[1], middle)}


def _collapse_short(mesh: ChangingMesh, size: float) -> None:
    """Merge the ends of short edges, the shortest first, where the surface allows it."""
    short = [e for e in mesh.edges() if mesh.length(e) < _SHORT * size]
    for edge in sorted(short, key=mesh.length):
        if not mesh.beside(edge) or mesh.length(edge) > _SHORT * size:
            continue
        for kept, gone in _directions(mesh, edge, mesh.length(edge) < _TINY * size):
            if _can_collapse(mesh, kept, gone, size):
                _collapse(mesh, kept, gone)
                break


def _directions(mesh: ChangingMesh, edge: Edge, tiny: bool) -> Iterator[Edge]:
    """Which end may move to which: corners stay, features stay on their line."""
    for kept, gone in (edge, edge[::-1]):
        if gone in mesh.corners and not (tiny and kept in mesh.corners):
            continue
        if tiny or not mesh.lines(gone) or edge in mesh.features:
            yield kept, gone


def _can_collapse(mesh: ChangingMesh, kept: int, gone: int, size: float) -> bool:
    """Whether the surface stays one: no fold, no edge shared by three, no long edge."""
    shared = mesh.neighbours(kept) & mesh.neighbours(gone)
    if len(shared) != len(mesh.beside(edge_of(kept, gone))):
        return False
    for t in mesh.around[gone] - mesh.around[kept]:
        old = mesh.triangles[t]
        a, b, c = (kept if i == gone else i for i in old)
        before, after = mesh.normal(old), mesh.normal((a, b, c))
        is_sliver = norm(before) < 0.02 * size * size
        if norm(after) < 1e-3 * size * size or (not is_sliver and cosine(before, after) < 0.5):
            return False
        if max(dist(mesh.points[i], mesh.points[kept]) for i in (a, b, c)) > _LONG * size:
            return False
    return True


def _collapse(mesh: ChangingMesh, kept: int, gone: int) -> None:
    lines = mesh.lines(gone)
    for j in lines:
        mesh.features.discard(edge_of(gone, j))
    for t in list(mesh.around[gone]):
        corners = mesh.remove(t)
        if kept not in corners:
            a, b, c = (kept if i == gone else i for i in corners)
            mesh.add(a, b, c)
    mesh.features |= {edge_of(kept, j) for j in lines if j != kept}
    if gone in mesh.corners:
        mesh.corners.add(kept)


def _flip(mesh: ChangingMesh) -> None:
    """Turn the diagonal of two triangles where that opens their angles."""
    for edge in mesh.edges() - mesh.features:
        beside = mesh.beside(edge)
        if len(beside) != 2:
            continue
        t, s = beside
        one, other = (next(i for i in mesh.triangles[k] if i not in edge) for k in (t, s))
        if edge_of(one, other) in mesh.features or other in mesh.neighbours(one):
            continue
        a, b = _in_order(mesh.triangles[t], edge)
        new = ((one, a, other), (other, b, one))
        if _opens(mesh, (t, s), new):
            mesh.remove(t)
            mesh.remove(s)
            for corners in new:
                mesh.add(*corners)


def _in_order(corners: Corners, edge: Edge) -> Edge:
    """The ends of an edge as a triangle passes them."""
    i = corners.index(edge[0])
    return edge if corners[(i + 1) % 3] == edge[1] else (edge[1], edge[0])


def _opens(mesh: ChangingMesh, old: tuple[int, int], new: tuple[Corners, Corners]) -> bool:
    """Whether the smallest angle grows and the surface keeps its shape."""
    before = [mesh.triangles[t] for t in old]
    if min(map(mesh.smallest_angle, new)) <= min(map(mesh.smallest_angle, before)) + 1e-9:
        return False
    reference = max((mesh.normal(t) for t in before), key=norm)
    return all(cosine(reference, mesh.normal(t)) > SHARP for t in new)


def _smooth(mesh: ChangingMesh, surface: Hull) -> None:
    """Move free vertices to the middle of their neighbours, on the original surface."""
    free = [i for i, t in enumerate(mesh.around) if t and not mesh.lines(i)]
    if not free:
        return
    middles = np.array([_middle(mesh, i) for i in free])
    for i, point in zip(free, onto(surface, middles).tolist(), strict=True):
        x, y, z = point
        _move(mesh, i, (x, y, z))


def _middle(mesh: ChangingMesh, i: int) -> Point:
    """Mean of the triangles' centres around a vertex, weighted by their areas."""
    x = y = z = weight = 0.0
    for t in mesh.around[i]:
        corners = mesh.triangles[t]
        area = norm(mesh.normal(corners)) / 3.0
        for j in corners:
            point = mesh.points[j]
            x, y, z = x + area * point[0], y + area * point[1], z + area * point[2]
        weight += 3.0 * area
    return x / weight, y / weight, z / weight


def _move(mesh: ChangingMesh, i: int, point: Point) -> None:
    """Move a vertex unless that folds the surface."""
    before = [mesh.normal(mesh.triangles[t]) for t in mesh.around[i]]
    old, mesh.points[i] = mesh.points[i], point
    after = [mesh.normal(mesh.triangles[t]) for t in mesh.around[i]]
    if any(cosine(a, b) < 0.5 for a, b in zip(before, after, strict=True)):
        mesh.points[i] = old


def _with_volume_of(surface: Hull, panels: Hull) -> Hull:
    """Panels moved out of the chords that they are of a curved surface.

    A panel's mean distance from the surface is that of its edges' middles (exact for a
    quadratic surface); every vertex moves, by least squares, as far along its panels' normals.
    """
    corners = panels.vertices[panels.triangles]
    middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
    areas = panels.area_vectors()
    size = np.linalg.norm(areas, axis=1)
    normals = areas / size[:, None]
    away = (onto(surface, middles.reshape(-1, 3)) - middles.reshape(-1, 3)).reshape(-1, 3, 3)
    distance = np.einsum("tki,ti->t", away, normals) / 3.0
    matrix, wanted = np.zeros((len(panels.vertices), 3, 3)), np.zeros((len(panels.vertices), 3))
    outer = size[:, None, None] * np.einsum("ti,tj->tij", normals, normals)
    for k in range(3):
        np.add.at(matrix, panels.triangles[:, k], outer)
        np.add.at(wanted, panels.triangles[:, k], distance[:, None] * areas)
    matrix += 1e-3 * np.trace(matrix, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    moves = np.linalg.solve(matrix, wanted[..., None])[..., 0]
    moves[panels.vertices[:, 2] >= 0.0, 2] = 0.0  # the still water stays level
    return Hull(panels.vertices + moves, panels.triangles)
