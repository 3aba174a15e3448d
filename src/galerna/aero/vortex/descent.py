"""From the clusters to the points: what is far, what is near, and the velocity of both.

The groups of points are gone through from the largest to the smallest. A group keeps a series
of the potential of all patches that are far from it and were not far from a larger group that
holds it; the smallest sum the patches that never were far.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from galerna.aero.vortex.expansions import (
    LANES,
    add_gradient,
    add_local_series,
    complete,
    harmonic_polynomials,
    inverse_distance_derivatives,
    shift_local,
)
from galerna.aero.vortex.segments import LANES as POINTS
from galerna.aero.vortex.segments import add_tile, make_block, whole_vectors
from galerna.aero.vortex.simd import FASTMATH
from galerna.contract import Array

_DEEPEST = 64  # more than any tree of halves


class Rule(NamedTuple):
    """When a patch is far from a group of points, and how well it is then represented.

    It is far if the sum of their radii is less than ``opening`` of their distance and this is
    more than ``cores`` of the patch's core radii. Series go up to ``order``; patches have at
    most ``leaf_size`` panels if they are summed.
    """

    order: int
    opening: float
    cores: float
    leaf_size: int


class _Room(NamedTuple):
    """Room to work in."""

    far: Array  # patches
    near: Array
    waiting: Array  # of all groups that hold this one, one behind the other
    stack: Array
    offset: Array  # (4 LANES,) of some far patches
    moments: Array  # (independent of order-1,LANES)
    derivatives: Array  # (total+1,LANES)
    polynomials: Array  # (total+1,1)
    local: Array  # (_DEEPEST,total+1): series of the groups that hold this one


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FASTMATH)
def add_far_and_near(k, rule, patches, tiles, moments, groups, tasks, like, velocity):  # type: ignore[no-untyped-def]
    """Write the velocity (k,3) at the points of the groups ``tasks`` and all that they hold.

    Near patches are summed in the precision of the array ``like``. Every group is one thread's,
    so the result does not depend on how many there are.
    """
    for number in prange(len(tasks)):
        _descend(k, rule, patches, tiles, moments, groups, tasks[number], like, velocity)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _descend(k, rule, patches, tiles, moments, groups, task, like, velocity):  # type: ignore[no-untyped-def]
    path = _path_to(groups.parent, task)
    room, block = _make_room(k, patches), make_block(rule.leaf_size + 1, like)
    ends = np.zeros(_DEEPEST + 1, np.int64)  # of what each group of the path left waiting
    while ends[0] < len(patches.parent) and patches.parent[ends[0]] < 0:
        room.waiting[ends[0]] = ends[0]
        ends[0] += 1
    todo, levels = np.empty(2 * _DEEPEST, np.int64), np.empty(2 * _DEEPEST, np.int64)
    todo[0], levels[0], count = path[0], 1, 1
    while count > 0:
        count -= 1
        group, level = todo[count], levels[count]
        _inherit(k, groups, group, level, room)
        begin = ends[level - 2] if level > 1 else 0
        far, near, ends[level] = _look(rule, patches, groups, group, begin, ends[level - 1], room)
        _add_far(k, patches, moments, groups.centre[group], far, room, room.local[level])
        if level < len(path):
            todo[count], levels[count] = path[level], level + 1
            count += 1
        elif groups.child[group] > 0:
            for part in range(2):
                todo[count], levels[count] = groups.child[group] + part, level + 1
                count += 1
        else:
            _add_near(groups, group, tiles, room.near[:near], block)
            _write(k, groups, group, room.local[level], block, velocity)


@njit(cache=True)
def _path_to(parent, task):  # type: ignore[no-untyped-def]
    """The groups that hold the task, the largest first, and itself."""
    depth, group = 0, task
    while group >= 0:
        depth, group = depth + 1, parent[group]
    path, group = np.empty(depth, np.int64), task
    for n in range(depth):
        path[depth - 1 - n], group = group, parent[group]
    return path


@njit(cache=True)
def _make_room(k, patches):  # type: ignore[no-untyped-def]
    total, count = len(k.exponents) + 1, len(patches.child)
    return _Room(
        np.empty(count, np.int64),
        np.empty(count, np.int64),
        np.empty(count * _DEEPEST, np.int64),
        np.empty(2 * _DEEPEST, np.int64),
        np.empty(4 * LANES),
        np.zeros((k.up_to[k.order - 1], LANES)),
        np.empty((total, LANES)),
        np.empty((total, 1)),
        np.zeros((_DEEPEST, total)),
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _inherit(k, groups, group, level, room):  # type: ignore[no-untyped-def]
    """Begin a group's series with that of the group which holds it."""
    room.local[level] = 0.0
    if level > 1:
        away = groups.centre[group] - groups.centre[groups.parent[group]]
        s = room.polynomials
        harmonic_polynomials(k, k.order - 2, away[0:1], away[1:2], away[2:3], s)
        complete(k, room.local[level - 1])
        shift_local(k, room.local[level - 1], s, room.local[level])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _look(rule, patches, groups, group, begin, end, room):  # type: ignore[no-untyped-def]
    """Sort the patches waiting in [begin,end): how many are far, near; the end of those left.

    The larger of a group and a patch is cut, so that both stay of similar size.
    """
    smallest = groups.child[group] == 0
    x, y, z = groups.centre[group]
    radius = groups.radius[group]
    far, near, left, stack = 0, 0, end, room.stack
    for place in range(begin, end):
        stack[0], height = room.waiting[place], 1
        while height > 0:
            height -= 1
            patch = stack[height]
            px, py, pz = patches.centre[patch]
            distance_squared = (x - px) ** 2 + (y - py) ** 2 + (z - pz) ** 2
            reach = max(
                (radius + patches.radius[patch]) / rule.opening, rule.cores * patches.core[patch]
            )
            if reach * reach < distance_squared:
                room.far[far] = patch
                far += 1
            elif patches.child[patch] > 0 and (smallest or patches.radius[patch] > radius):
                stack[height] = patches.child[patch]
                stack[height + 1] = patches.child[patch] + 1
                height += 2
            elif smallest:
                room.near[near] = patch
                near += 1
            else:
                room.waiting[left] = patch
                left += 1
    return far, near, left


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _add_far(k, patches, moments, centre, far, room, local):  # type: ignore[no-untyped-def]
    """Add the moments of the first ``far`` patches of the list to a local series."""
    for first in range(0, far, LANES):
        count = min(LANES, far - first)
        for n in range(LANES):
            patch = room.far[first + min(n, count - 1)]
            for i in range(3):
                room.offset[i * LANES + n] = centre[i] - patches.centre[patch, i]
            for i in range(moments.shape[1]):
                room.moments[i, n] = moments[patch, i]
        inverse_distance_derivatives(k, room.offset, room.derivatives)
        add_local_series(k, room.moments, room.derivatives, count, local)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _add_near(groups, group, tiles, near, block):  # type: ignore[no-untyped-def]
    """Sum the near patches at a group's points, which count from its centre."""
    centre, count = groups.centre[group], groups.last[group] - groups.first[group]
    lanes = whole_vectors(count)
    for n in range(lanes):
        point = groups.first[group] + min(n, count - 1)
        for i in range(3):
            block.points[i * POINTS + n] = groups.points[point, i] - centre[i]
    block.velocity[:] = 0.0
    for patch in near:
        rows, columns = tiles.shape[patch]
        first = tiles.first[patch]
        add_tile(tiles.table, first, columns, rows, columns, (True, True), centre, lanes, block)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _write(k, groups, group, local, block, velocity):  # type: ignore[no-untyped-def]
    """Write what near patches induce at a group's points and the gradient of its series."""
    complete(k, local)
    first, count = groups.first[group], groups.last[group] - groups.first[group]
    away, u = np.empty((3, count)), np.zeros((3, count))
    for n in range(count):
        for i in range(3):
            away[i, n] = groups.points[first + n, i] - groups.centre[group, i]
    s = np.empty((len(k.exponents) + 1, count))
    harmonic_polynomials(k, k.order - 2, away[0], away[1], away[2], s)
    add_gradient(k, local, s, u[0], u[1], u[2])
    for n in range(count):
        for i in range(3):
            velocity[groups.order[first + n], i] = u[i, n] + block.velocity[i * POINTS + n]
