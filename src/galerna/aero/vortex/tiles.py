"""The near field: the rings of a small patch as one tile of segments.

A tile has the circulation of its own rings alone, unlike a tile of a whole sheet: the far field
of a patch is that of closed rings, so its near field must be, and where two patches meet the
sides that they share cancel in the sum, whichever way each of them was evaluated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from galerna.aero.vortex.clusters import Integers, Panels, Patches
from galerna.aero.vortex.segments import NUMBERS, set_segment
from galerna.aero.vortex.simd import FASTMATH
from galerna.contract import Array


class Tiles(NamedTuple):
    """Vertices and segments (k,NUMBERS) as `segments.add_tile` reads them.

    Those of a patch start at ``first`` (patches,), in ``shape`` (patches,2) rows and columns.
    """

    table: Array
    first: Integers
    shape: Integers


def make_tiles(panels: Panels, patches: Patches) -> Tiles:
    """The tiles of all patches without children."""
    shape = patches.limits[:, 2::2] - patches.limits[:, 1::2] + 1
    sizes = np.where(patches.child == 0, shape[:, 0] * shape[:, 1], 0)
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    tiles = Tiles(np.empty((sizes.sum(), NUMBERS)), first, shape)
    _fill(tiles, panels, patches)
    return tiles


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _fill(tiles, panels, patches):  # type: ignore[no-untyped-def]
    for node in range(len(patches.child)):
        if patches.child[node] == 0:
            _fill_one(tiles.table, tiles.first[node], panels, patches.limits[node])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _fill_one(table, k, panels, limits):  # type: ignore[no-untyped-def]
    sheet, r0, r1, c0, c1 = limits
    _, columns, vertex, panel = panels.shapes[sheet]
    circulation = panels.circulation
    for r in range(r0, r1 + 1):
        for c in range(c0, c1 + 1):
            at, ring = vertex + r * (columns + 1) + c, panel + r * columns + c
            table[k, :3] = panels.vertices[at]
            table[k, 3:] = 0.0
            if c > c0:
                strength = circulation[ring - 1] if r < r1 else 0.0
                strength -= circulation[ring - 1 - columns] if r > r0 else 0.0
                _set(table[k, 3:9], panels, at - 1, at, strength)
            if r > r0:
                strength = circulation[ring - columns - 1] if c > c0 else 0.0
                strength -= circulation[ring - columns] if c < c1 else 0.0
                _set(table[k, 9:15], panels, at - columns - 1, at, strength)
            k += 1


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _set(numbers, panels, start, end, strength):  # type: ignore[no-untyped-def]
    core_squared = 0.5 * (panels.cores[start] ** 2 + panels.cores[end] ** 2)
    set_segment(numbers, panels.vertices[start], panels.vertices[end], core_squared, strength)
