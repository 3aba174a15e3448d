"""What makes a lattice unusable, and where on the surface it is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError

SMALLEST_AREA = 1e-9  #: of a panel, over the square of its longest diagonal
PARALLEL = 1e-6  #: sine under which a segment lies in a plane and does not cross it


class Fault(NamedTuple):
    """The first unusable panel of a surface: chordwise row, spanwise column, what is wrong."""

    row: int
    column: int
    what: str


def find_fault(corners: Array, thorough: bool = True) -> Fault | None:
    """The first fault of a surface with ``corners`` (m+1,n+1,3) m, None where it is sound.

    In this order: a coordinate that is no number, a panel without area, a panel whose sides
    cross, neighbours folded on each other by more than a right angle, strips that pierce
    others. A side of a panel may be a point, as at the tip of an elliptic wing. The last is not
    looked for unless ``thorough``, and takes most of the time.
    """
    missing = np.asarray(~np.isfinite(corners).all(axis=2))
    if missing.any():
        return _first(missing, "has a coordinate that is not a number")
    diagonals = corners[1:, 1:] - corners[:-1, :-1], corners[:-1, 1:] - corners[1:, :-1]
    area = 0.5 * np.cross(*diagonals)
    size = np.maximum(*(np.sum(d**2, axis=2) for d in diagonals))
    empty = np.linalg.norm(area, axis=2) <= SMALLEST_AREA * size
    if empty.any():
        return _first(empty, "has no area")
    crossed = _has_crossed_sides(corners, area, SMALLEST_AREA * size)
    if crossed.any():
        return _first(crossed, "has sides that cross")
    folded = np.zeros(area.shape[:2], dtype=bool)
    folded[1:] |= np.sum(area[1:] * area[:-1], axis=2) < 0.0
    folded[:, 1:] |= np.sum(area[:, 1:] * area[:, :-1], axis=2) < 0.0
    if folded.any():
        return _first(folded, "is folded onto its neighbour")
    return _piercing_strip(corners[[0, -1]]) if thorough else None


def require_sound_lattice(
    corners: Array, surface: str, span: Array | None = None, thorough: bool = True
) -> None:
    """Raise InputError that names the ``surface`` and the place of the first fault.

    ``corners`` (m+1,n+1,3) m; ``span`` (n+1,) are the fractions of the reference axis at which
    the columns stand; without it the column is named. ``thorough`` as in `find_fault`.
    """
    if corners.ndim != 3 or corners.shape[2] != 3 or min(corners.shape[:2]) < 2:
        raise InputError(surface, f"corners must be (m+1,n+1,3), found {corners.shape}")
    fault = find_fault(corners, thorough)
    if fault is not None:
        place = describe_place(fault, span)
        hint = "check chord, twist, offsets and the spacing of the panels there"
        raise InputError(surface, f"the panel {place} {fault.what}", hint)


def describe_place(fault: Fault, span: Array | None = None) -> str:
    """Where a fault lies, in words: row from the leading edge and column or span."""
    if span is None:
        return f"in row {fault.row + 1}, column {fault.column + 1}"
    ends = span[fault.column], span[min(fault.column + 1, len(span) - 1)]
    return f"in row {fault.row + 1} at {ends[0]:.1%} to {ends[1]:.1%} of the span"


def _first(bad: NDArray[np.bool_], what: str) -> Fault:
    row, column = np.argwhere(bad)[0]
    return Fault(int(row), int(column), what)


def _has_crossed_sides(corners: Array, area: Array, small: Array) -> NDArray[np.bool_]:
    """Panels (m,n) whose triangle at one of the corners turns against the whole."""
    ring = corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]
    direction = area / np.linalg.norm(area, axis=2, keepdims=True)
    crossed = np.zeros(area.shape[:2], dtype=bool)
    for k in range(4):
        to_next, to_last = ring[(k + 1) % 4] - ring[k], ring[k - 1] - ring[k]
        crossed |= np.sum(np.cross(to_next, to_last) * direction, axis=2) < -small
    return crossed


def _piercing_strip(edges: Array) -> Fault | None:
    """The first strip pierced by a chord or an edge of a strip that is not its neighbour.

    ``edges`` (2,n+1,3): leading and trailing edge; camber plays no part.
    """
    leading, trailing = edges
    strips = len(leading) - 1
    starts = np.concatenate([leading, leading[:-1], trailing[:-1]])
    ends = np.concatenate([trailing, leading[1:], trailing[1:]])
    columns = np.arange(strips + 1)
    first = np.concatenate([columns, columns[:-1], columns[:-1]])
    last = np.concatenate([columns, columns[1:], columns[1:]])
    for j in range(strips):
        apart = (last < j) | (first > j + 1)
        a, b, c, d = leading[j], trailing[j], trailing[j + 1], leading[j + 1]
        for triangle in ((a, b, c), (a, c, d)):
            if _pierced(triangle, starts[apart], ends[apart]).any():
                return Fault(0, j, "meets another part of the surface")
    return None


def _pierced(triangle: tuple[Array, Array, Array], starts: Array, ends: Array) -> NDArray[np.bool_]:
    """Which segments (k,3) to (k,3) pass through a triangle (Moller and Trumbore 1997)."""
    a, b, c = triangle
    along, ab, ac, to_start = ends - starts, b - a, c - a, starts - a
    normal = np.cross(along, ac)
    determinant = normal @ ab
    size = np.linalg.norm(along, axis=1) * np.linalg.norm(ac) * np.linalg.norm(ab)
    crosses = np.abs(determinant) > PARALLEL * size
    safe = np.where(crosses, determinant, 1.0)
    u = np.sum(to_start * normal, axis=1) / safe
    across = np.cross(to_start, ab)
    v = np.sum(along * across, axis=1) / safe
    t = across @ ac / safe
    inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t >= 0.0) & (t <= 1.0)
    return crosses & inside
