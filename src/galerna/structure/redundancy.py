"""Find joints that hold the same motion twice, before they make a matrix singular."""

from __future__ import annotations

import numpy as np
from scipy.linalg import svd

from galerna.contract import Array
from galerna.errors import InputError

from .system import System


def check_constraints(system: System) -> None:
    """Raise InputError that names joints which hold a motion twice, or contradict each other."""
    names, directions, violation = _all_directions(system)
    if not names:
        return
    length = np.maximum(np.linalg.norm(directions, axis=1), 1e-300)
    scaled = directions / length[:, None]
    left, values, _ = svd(scaled, full_matrices=True)
    rank = int((values > 1e-9 * values[0]).sum())
    if rank == len(names):
        return
    combination = left[:, rank:]
    involved = np.abs(combination).max(axis=1) > 1e-6
    joints = list(dict.fromkeys(name for name, yes in zip(names, involved, strict=True) if yes))
    clash = np.abs(combination.T @ (violation / length)).max() > 1e-8
    raise InputError(
        ", ".join(joints),
        f"these joints {'contradict each other' if clash else 'hold the same motion twice'} "
        f"({len(names) - rank} too many constraints)",
        "free a component of one of them, for example a spherical joint in place of a hinge",
    )


def _all_directions(system: System) -> tuple[list[str], Array, Array]:
    """Name, direction over all nodes (k,6n) and violation (k,) of every locked component."""
    state = system.initial_state()
    answer = system.pair_answer(state)
    names: list[str] = []
    rows: list[Array] = []
    violation: list[float] = []
    width = 6 * len(system)
    for e, k in zip(*np.nonzero(system.pairs.locked), strict=True):
        row = np.zeros(width)
        for side, node in enumerate(system.pairs.ends[e]):
            row[6 * node : 6 * node + 6] += answer.direction[e, k, 6 * side : 6 * side + 6]
        names.append(system.pair_names[e])
        rows.append(row[6:])
        violation.append(answer.motion[e, k])
    for constraint, nodes in system.constraints:
        x, R, v = state.position[nodes], state.rotation[nodes], state.velocity[nodes]
        columns = (6 * nodes[:, None] + np.arange(6)).ravel()
        value = constraint.violation(0.0, x, R, v)
        for line, amount in zip(constraint.directions(0.0, x, R), value, strict=True):
            row = np.zeros(width)
            row[columns] += line
            names.append(constraint.name)
            rows.append(row[6:])
            violation.append(float(amount) if constraint.holonomic else 0.0)
    return names, np.array(rows), np.array(violation)
