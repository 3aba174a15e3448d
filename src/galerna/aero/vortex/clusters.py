"""Trees of clusters: patches of vortex sheets that induce, groups of points that are asked.

A sheet is a lattice, so a patch of it is cut in two across its longer side, in rows or
columns, until few panels are left: a patch is a few numbers, and no panel is sorted or copied.
Points without an order are cut at the median along the longest side of their box.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.simd import FASTMATH
from galerna.contract import Array

Integers = NDArray[np.int64]


class Panels(NamedTuple):
    """Sheets one behind the other: vertices (V,3) m, their cores (V,) m, circulation (P,) m2/s.

    ``shapes`` (sheets,4): rows and columns of panels, first vertex and first panel of each.
    """

    vertices: Array
    cores: Array
    circulation: Array
    shapes: Integers


class Patches(NamedTuple):
    """A forest of patches: rows [r0,r1) and columns [c0,c1) of panels of a sheet.

    ``limits`` (n,5): sheet, r0, r1, c0, c1; ``child`` (n,): the first of two, or 0; ``parent``
    (n,): -1 for the whole sheets, which come first. A ball of ``radius`` (n,) about
    ``centre`` (n,3) holds a patch's vertices; ``core`` (n,) is its thickest vortex core.
    """

    limits: Integers
    child: Integers
    parent: Integers
    centre: Array
    radius: Array
    core: Array


class Groups(NamedTuple):
    """A forest of groups of points: ``points`` (k,3), stored at ``order`` (k,) by the caller.

    A group without children holds the points [first,last); for the rest see `Patches`.
    """

    points: Array
    order: Integers
    child: Integers
    parent: Integers
    centre: Array
    radius: Array
    first: Integers
    last: Integers


def join(sheets: Sequence[Sheet]) -> Panels:
    """The sheets behind one another, as kernels want them."""
    shapes, vertex, panel = [], 0, 0
    for sheet in sheets:
        rows, columns = sheet.circulation.shape
        shapes.append((rows, columns, vertex, panel))
        vertex, panel = vertex + (rows + 1) * (columns + 1), panel + rows * columns
    vertices, cores, circulation = np.empty((vertex, 3)), np.empty(vertex), np.empty(panel)
    for sheet, (rows, columns, v, p) in zip(sheets, shapes, strict=True):
        block = slice(v, v + (rows + 1) * (columns + 1))
        vertices[block] = np.reshape(sheet.vertices, (-1, 3))
        cores[block].reshape(rows + 1, columns + 1)[...] = sheet.core_radius
        circulation[p : p + rows * columns] = np.ravel(sheet.circulation)
    return Panels(vertices, cores, circulation, np.array(shapes).reshape(-1, 4))


def cut_sheets(panels: Panels, leaf_size: int) -> Patches:
    """The patches of the sheets, down to at most ``leaf_size`` panels each."""
    limits, child, parent = _cut(panels, leaf_size, 0)
    centre, radius, core = _fit(panels, limits, 1)
    return Patches(limits, child, parent, centre, radius, core)


def group_vertices(panels: Panels, leaf_size: int) -> Groups:
    """The vertices of the sheets in groups of at most ``leaf_size``, the whole sheets first."""
    limits, child, parent = _cut(panels, leaf_size, 1)
    centre, radius, _ = _fit(panels, limits, 0)
    order, first, last = _list_vertices(panels, limits, child)
    return Groups(panels.vertices[order], order, child, parent, centre, radius, first, last)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _cut(panels, leaf_size, more):  # type: ignore[no-untyped-def]
    """Limits, children and parents of parts of lattices with ``more`` rows than panels."""
    sheets = len(panels.shapes)
    capacity = 4 * sheets + 16 * (len(panels.vertices) // leaf_size + 1)
    limits = np.zeros((capacity, 5), np.int64)
    child, parent = np.zeros(capacity, np.int64), np.full(capacity, -1)
    for sheet in range(sheets):
        rows, columns = panels.shapes[sheet, 0] + more, panels.shapes[sheet, 1] + more
        limits[sheet] = sheet, 0, rows, 0, columns
    node, nodes = 0, sheets
    while node < nodes:
        size = (limits[node, 2] - limits[node, 1]) * (limits[node, 4] - limits[node, 3])
        if size > leaf_size:
            limits[nodes : nodes + 2] = limits[node]
            low = 1 if _is_longer_along_rows(panels, limits[node]) else 3
            middle = limits[node, low] + _first_part(
                limits[node, low + 1] - limits[node, low], size, leaf_size
            )
            limits[nodes, low + 1] = limits[nodes + 1, low] = middle
            child[node] = nodes
            parent[nodes : nodes + 2] = node
            nodes += 2
        node += 1
    return limits[:nodes].copy(), child[:nodes].copy(), parent[:nodes].copy()


@njit(cache=True)
def _first_part(count, size, leaf_size):  # type: ignore[no-untyped-def]
    """Of a side of ``count``, what makes the leaves of both parts nearly full."""
    leaves = (size + leaf_size - 1) // leaf_size
    return min(max(round(count * (leaves // 2) / leaves), 1), count - 1)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _is_longer_along_rows(panels, limits):  # type: ignore[no-untyped-def]
    sheet, r0, r1, c0, c1 = limits
    if r1 - r0 == 1 or c1 - c0 == 1:
        return c1 - c0 == 1
    stride, first = panels.shapes[sheet, 1] + 1, panels.shapes[sheet, 2]
    down, across = 0.0, 0.0
    for c in (c0, (c0 + c1) // 2, c1 - 1):
        for at in range(first + r0 * stride + c, first + (r1 - 1) * stride + c, stride):
            down += _distance(panels.vertices, at, at + stride)
    for r in (r0, (r0 + r1) // 2, r1 - 1):
        for at in range(first + r * stride + c0, first + r * stride + c1 - 1):
            across += _distance(panels.vertices, at, at + 1)
    return down > across


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _distance(x, i, j):  # type: ignore[no-untyped-def]
    return sqrt((x[i, 0] - x[j, 0]) ** 2 + (x[i, 1] - x[j, 1]) ** 2 + (x[i, 2] - x[j, 2]) ** 2)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _fit(panels, limits, more):  # type: ignore[no-untyped-def]
    """Balls about the boxes of all parts, ``more`` vertices than limits, and thickest cores."""
    nodes = len(limits)
    centre, radius, core = np.empty((nodes, 3)), np.empty(nodes), np.empty(nodes)
    for node in range(nodes):
        radius[node], core[node] = _fit_one(panels, limits[node], more, centre[node])
    return centre, radius, core


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _fit_one(panels, limits, more, centre):  # type: ignore[no-untyped-def]
    sheet, r0, r1, c0, c1 = limits
    stride, first = panels.shapes[sheet, 1] + 1, panels.shapes[sheet, 2]
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    core, radius_squared = 0.0, 0.0
    for r in range(r0, r1 + more):
        for at in range(first + r * stride + c0, first + r * stride + c1 + more):
            core = max(core, panels.cores[at])
            for i in range(3):
                low[i] = min(low[i], panels.vertices[at, i])
                high[i] = max(high[i], panels.vertices[at, i])
    for i in range(3):
        centre[i] = 0.5 * (low[i] + high[i])
    for r in range(r0, r1 + more):
        for at in range(first + r * stride + c0, first + r * stride + c1 + more):
            x, y, z = panels.vertices[at]
            away = (x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2
            radius_squared = max(radius_squared, away)
    return sqrt(radius_squared), core


@njit(cache=True)
def _list_vertices(panels, limits, child):  # type: ignore[no-untyped-def]
    """The vertices of the groups without children, one group behind the other."""
    order = np.empty(len(panels.vertices), np.int64)
    first, last = np.zeros(len(child), np.int64), np.zeros(len(child), np.int64)
    n = 0
    for node in range(len(child)):
        first[node] = n
        if child[node] == 0:
            sheet, r0, r1, c0, c1 = limits[node]
            for r in range(r0, r1):
                start = panels.shapes[sheet, 2] + r * (panels.shapes[sheet, 1] + 1)
                for c in range(c0, c1):
                    order[n] = start + c
                    n += 1
        last[node] = n
    return order, first, last


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def group_points(points, leaf_size):  # type: ignore[no-untyped-def]
    """Groups of at most ``leaf_size`` points (k,3)."""
    count = len(points)
    capacity = 4 * (count // leaf_size + 1)
    order = np.arange(count)
    child, parent = np.zeros(capacity, np.int64), np.full(capacity, -1)
    centre, radius = np.zeros((capacity, 3)), np.zeros(capacity)
    first, last = np.zeros(capacity, np.int64), np.zeros(capacity, np.int64)
    last[0] = count
    node, nodes = 0, 1
    while node < nodes:
        members = order[first[node] : last[node]]
        size = np.zeros(3)
        for i in range(3):
            low, high = np.inf, -np.inf
            for m in members:
                low, high = min(low, points[m, i]), max(high, points[m, i])
            centre[node, i], size[i] = 0.5 * (low + high), high - low
        for m in members:
            x, y, z = points[m] - centre[node]
            radius[node] = max(radius[node], sqrt(x * x + y * y + z * z))
        if len(members) > leaf_size:
            members[:] = members[np.argsort(points[members, np.argmax(size)], kind="mergesort")]
            child[node] = nodes
            parent[nodes : nodes + 2] = node
            first[nodes], last[nodes + 1] = first[node], last[node]
            middle = first[node] + _first_part(len(members), len(members), leaf_size)
            last[nodes] = first[nodes + 1] = middle
            nodes += 2
        node += 1
    return Groups(
        points[order],
        order,
        child[:nodes].copy(),
        parent[:nodes].copy(),
        centre[:nodes].copy(),
        radius[:nodes].copy(),
        first[:nodes].copy(),
        last[:nodes].copy(),
    )
