"""A mesh of triangles that changes, with the lines on it that stay."""

from __future__ import annotations

from math import acos, cos, dist, radians, sqrt

import numpy as np

from galerna.hydro.hull import Hull

SHARP = cos(radians(30.0))  #: of the angle between two facets that makes an edge a feature
_CORNER = cos(radians(40.0))  #: of the turn of a feature that holds its vertex

Point = tuple[float, float, float]
Edge = tuple[int, int]
Corners = tuple[int, int, int]


class ChangingMesh:
    """Triangles that change: points, corners by triangle, triangles by vertex, features."""

    def __init__(self, hull: Hull) -> None:
        self.points: list[Point] = [(float(x), float(y), float(z)) for x, y, z in hull.vertices]
        self.triangles: dict[int, Corners] = {}
        self.around: list[set[int]] = [set() for _ in self.points]
        self.next = 0
        for a, b, c in hull.triangles.tolist():
            self.add(a, b, c)
        self.features = {edge for edge in self.edges() if self._is_feature(edge)}
        self.corners = {i for i in range(len(self.points)) if self._is_corner(i)}

    def add(self, a: int, b: int, c: int) -> None:
        self.triangles[self.next] = (a, b, c)
        for i in (a, b, c):
            self.around[i].add(self.next)
        self.next += 1

    def remove(self, t: int) -> Corners:
        for i in self.triangles[t]:
            self.around[i].discard(t)
        return self.triangles.pop(t)

    def edges(self) -> set[Edge]:
        return {edge_of(t[i], t[i - 1]) for t in self.triangles.values() for i in range(3)}

    def beside(self, edge: Edge) -> set[int]:
        """Triangles at an edge."""
        return self.around[edge[0]] & self.around[edge[1]]

    def neighbours(self, i: int) -> set[int]:
        return {j for t in self.around[i] for j in self.triangles[t]} - {i}

    def length(self, edge: Edge) -> float:
        return dist(self.points[edge[0]], self.points[edge[1]])

    def normal(self, corners: Corners) -> Point:
        """Twice the area vector of a triangle."""
        a, b, c = (self.points[i] for i in corners)
        return cross(minus(b, a), minus(c, a))

    def smallest_angle(self, corners: Corners) -> float:
        """Smallest angle of a triangle, rad."""
        points = [self.points[i] for i in corners]
        angles = (
            cosine(minus(points[i - 1], points[i]), minus(points[i - 2], points[i]))
            for i in range(3)
        )
        return acos(min(1.0, max(angles)))

    def lines(self, i: int) -> list[int]:
        """Vertices to which features lead from one."""
        return [j for j in self.neighbours(i) if edge_of(i, j) in self.features]

    def _is_feature(self, edge: Edge) -> bool:
        beside = [self.normal(self.triangles[t]) for t in self.beside(edge)]
        return len(beside) != 2 or cosine(*beside) < SHARP

    def _is_corner(self, i: int) -> bool:
        lines = self.lines(i)
        if len(lines) != 2:
            return bool(lines)
        first, second = (minus(self.points[j], self.points[i]) for j in lines)
        return -cosine(first, second) < _CORNER

    def hull(self) -> Hull:
        used = sorted({i for t in self.triangles.values() for i in t})
        number = {i: n for n, i in enumerate(used)}
        triangles = [[number[i] for i in t] for t in self.triangles.values()]
        return Hull(np.array([self.points[i] for i in used]), np.array(triangles, dtype=np.int64))


def edge_of(a: int, b: int) -> Edge:
    return (a, b) if a < b else (b, a)


def minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a: Point, b: Point) -> Point:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def norm(a: Point) -> float:
    return sqrt(dot(a, a))


def cosine(a: Point, b: Point) -> float:
    return dot(a, b) / max(norm(a) * norm(b), 1e-300)
