"""Where the frames stand when every driven joint is where it is to be: a shape to start from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .pairs import Integers
from .solvers import spanning_tree
from .system import State, System


def placed(system: System, time: float) -> State:
    """The machine as it was described, at rest, its driven joints where they are at ``time`` s.

    Everything beyond a joint, seen from the ground, goes along rigidly. With closed loops the
    frames stay where they were described.
    """
    state = replace(system.initial_state(), time=time)
    tree = spanning_tree(system.pairs, len(system))
    if tree is None:
        return state
    system.set_time(time)
    for pair, _ in system.drives:
        _close(system, pair, tree[0], state)
    return state


def _close(system: System, pair: int, parent: Integers, state: State) -> None:
    """Move what is beyond a joint so that its two sides meet."""
    pairs, sides = system.pairs, []
    for side, node in enumerate(pairs.ends[pair]):
        R, x = state.rotation[node], state.position[node]
        arm, turn = pairs.offset_position[pair, side], pairs.offset_rotation[pair, side]
        sides.append((R @ turn, x + R @ arm))
    first, second = pairs.ends[pair]
    outer, (target, other) = second, sides
    if first != 0 and parent[first] == second:
        outer, (other, target) = first, sides
    rotation = target[0] @ other[0].T
    beyond = _beyond(outer, parent)
    state.position[beyond] = target[1] + (state.position[beyond] - other[1]) @ rotation.T
    state.rotation[beyond] = rotation @ state.rotation[beyond]


def _beyond(node: int, parent: Integers) -> Integers:
    """The frames on the outer side of a node, and the node."""
    inside = np.arange(len(parent)) == node
    while True:
        grown = inside | inside[parent]
        grown[0] = False
        if np.array_equal(grown, inside):
            return np.flatnonzero(inside)
        inside = grown
