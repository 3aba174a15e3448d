"""Velocity of vortex sheets by clusters, at a cost that grows hardly faster than their size.

The fast multipole method of Greengard and Rokhlin (1987, J. Comput. Phys. 73) for sheets of
vortex rings: patches of the sheets (`clusters`) act on distant points by the moments of
their rings (`moments`, `expansions`), on near ones by their segments (`tiles`). Trees of
patches and of points are gone through together (`descent`) as Dehnen does (2002, J. Comput.
Phys. 179), so that neither has levels or cells, and flat sheets cost what they fill.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, log10

import numpy as np

from galerna.aero.vortex.clusters import (
    Groups,
    Integers,
    cut_sheets,
    group_points,
    group_vertices,
    join,
)
from galerna.aero.vortex.descent import Rule, add_far_and_near
from galerna.aero.vortex.expansions import indices
from galerna.aero.vortex.moments import patch_moments
from galerna.aero.vortex.segments import LANES as POINTS
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.tiles import make_tiles
from galerna.contract import Array
from galerna.errors import InputError

_TASKS = 64  # of about equal size, to be shared out among the threads
_REACH = 1e4  # m: what single precision can hold, see `segments`


def choose_rule(error: float) -> Rule:
    """The rule that keeps an error between 1e-1 and 1e-5 of the root mean square velocity.

    Measured on helical wakes, distorted or not: the 99.9th percentile of the error is then
    about half of what is asked. Far away a core is left out. It changes a velocity by
    (r_c/d)^4/2 beside a segment, but by r_c/d along its line: hence its steeper part.
    Raises InputError for any other error.
    """
    if not 1e-5 <= error <= 0.1:
        raise InputError(
            "error of the treecode", f"{error} is not between 1e-5 and 0.1", "use about 1e-3"
        )
    digits = -log10(error)
    return Rule(
        order=max(4, ceil(3.0 * digits - 1e-9)),
        opening=0.75 - 0.05 * digits,
        cores=max(4.0, 10.0 * 6.0 ** (digits - 3.0)),
        leaf_size=24,
    )


class Treecode:
    """Velocity of sheets by clusters of their rings, for as long as the sheets stay as they are.

    The error is at most ``error`` of the root mean square of the induced velocity at all but
    one in a thousand points; see `choose_rule`.
    """

    def __init__(
        self, sheets: Sequence[Sheet], error: float = 1e-3, *, rule: Rule | None = None
    ) -> None:
        self.rule = rule or choose_rule(error)
        self.panels = join(sheets)
        self.patches = cut_sheets(self.panels, self.rule.leaf_size)
        self.tiles = make_tiles(self.panels, self.patches)
        self.indices = indices(self.rule.order)
        self.moments = patch_moments(self.indices, self.panels, self.patches)

    def velocity(self, points: Array, precision: str = "double") -> Array:
        """Velocity (...,3) m/s at points (...,3) m."""
        points = np.asarray(points, dtype=float)
        if points.size == 0:
            return np.zeros(points.shape)
        groups = group_points(np.ascontiguousarray(points.reshape(-1, 3)), POINTS)
        return self._at(groups, np.zeros(1, np.int64), precision).reshape(points.shape)

    def vertex_velocities(
        self, which: Sequence[int] | None = None, precision: str = "double"
    ) -> list[Array]:
        """Velocity (r+1,c+1,3) m/s at the vertices of the sheets numbered ``which`` (all)."""
        shapes = self.panels.shapes
        numbers = np.arange(len(shapes)) if which is None else np.array(which, dtype=np.int64)
        velocity = self._at(group_vertices(self.panels, POINTS), numbers, precision)
        ends = shapes[:, 2] + (shapes[:, 0] + 1) * (shapes[:, 1] + 1)
        return [
            velocity[shapes[n, 2] : ends[n]].reshape(shapes[n, 0] + 1, shapes[n, 1] + 1, 3)
            for n in numbers
        ]

    def _at(self, groups: Groups, roots: Integers, precision: str) -> Array:
        farthest = max(float(np.abs(x).max()) for x in (groups.points, self.panels.vertices))
        single = precision == "single" and farthest < 0.5 * _REACH
        velocity = np.zeros((len(groups.points), 3))
        add_far_and_near(
            self.indices,
            self.rule,
            self.patches,
            self.tiles,
            self.moments,
            groups,
            _tasks(groups, roots),
            np.zeros(1, np.float32 if single else np.float64),
            velocity,
        )
        return velocity


def _tasks(groups: Groups, roots: Integers) -> Integers:
    """Groups that together hold all points of the roots, enough of them to share out."""
    tasks = roots
    while len(tasks) < _TASKS and groups.child[tasks].any():
        whole, first = tasks[groups.child[tasks] == 0], groups.child[tasks]
        parts = np.stack([first, first + 1], axis=1)[first > 0].ravel()
        tasks = np.concatenate([whole, parts])
    return tasks
