"""A steady free wake, found by marching downstream along it again and again.

A row lies where the one before it was carried to, so a wrong row misplaces all behind it. One
*sweep* therefore goes from the trailing edge downstream and moves each row, with all rows behind
it, by Heun's rule for eq. (8): with the velocity of the row before, then with the mean of that
and the velocity found there. Then the circulation is solved anew. What is downstream acts
upstream only weakly, and a few sweeps agree. (Moving all rows at once, with velocities of the
last iteration, spreads a change downstream row by row and lets it grow on the way.)

Far downstream a steady helix of vortices is unstable and has no place of its own to be found.
Beyond ``FreeWake.length`` rows keep the mean velocity that the last free revolution has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.aero.vortex.helix import turns
from galerna.aero.vortex.steady_flow import SteadyFlow
from galerna.contract import Array
from galerna.errors import ConvergenceError

RUNAWAY = 0.5  #: of the size, by which no row moves beyond the one before it in a sound sweep


@dataclass(frozen=True)
class FreeWake:
    """How a steady free wake is found.

    Rows are free up to ``length`` rotor diameters or spans downstream of the trailing edge, at
    the wind's speed. The wake is found when in a sweep no row moves, beyond the row before it, by
    more than ``tolerance`` of the rotor's radius or the span (root mean square over the row).
    ``relaxation`` is the share of its way that a row goes in a sweep; ``precision`` that of the
    velocities on the wake.
    """

    length: float = 1.0
    tolerance: float = 1e-4
    sweeps: int = 60
    relaxation: float = 1.0
    precision: str = "double"


def find_free_wake(flow: SteadyFlow, free: FreeWake) -> list[float]:
    """Sweep until the wake is found; returns the largest move of a row in each sweep.

    Raises ConvergenceError when it runs away, stands still in the wind, or takes too long.
    """
    history: list[float] = []
    while not history or history[-1] > free.tolerance:
        if len(history) == free.sweeps:
            what = (
                f"the free wake is not found in {free.sweeps} sweeps: a row moved "
                f"{history[-1]:.2g} of the size in the last one, {free.tolerance:.2g} is wanted"
            )
            raise _no_wake(what)
        history.append(_sweep(flow, free))
        flow.solve()
    return history


def _sweep(flow: SteadyFlow, free: FreeWake) -> float:
    """Place all rows once, first to last; the largest move of a row beyond the row before it."""
    turn = turns(flow.ages, flow.axis)
    last = _last_free_row(flow, free)
    velocity = [np.zeros_like(e) for e in flow.drifts]  # R(a) u, the slope of the drift
    _store(velocity, 0, _seen(flow, 0, turn, free))
    largest = 0.0
    for k in range(last):
        moves = _place(flow, k, velocity, 0.0, free, turn)
        _store(velocity, k + 1, _seen(flow, k + 1, turn, free))
        correction = _place(flow, k, velocity, 0.5, free, turn)
        both = [a + b for a, b in zip(moves, correction, strict=True)]
        moved = max(float(np.sqrt(np.sum(m**2, axis=1).mean())) for m in both) / flow.size
        _require_sound_row(flow, k + 1, velocity, moved)
        largest = max(largest, moved)
    _extend(flow, velocity, last, turn)
    return largest


def _place(
    flow: SteadyFlow, row: int, velocity: list[Array], weight: float, free: FreeWake, turn: Array
) -> list[Array]:
    """Move the next row, and all behind it, to where the velocity takes it from this one.

    The velocity is this row's, with the ``weight`` of the next one's.
    """
    width = flow.ages[row + 1] - flow.ages[row]
    moves = []
    for s, (drift, u) in enumerate(zip(flow.drifts, velocity, strict=True)):
        mean = u[row] + weight * (u[row + 1] - u[row])
        moves.append(free.relaxation * (drift[row] + width * mean - drift[row + 1]))
        flow.shift(s, row + 1, moves[-1], turn)
    return moves


def _seen(flow: SteadyFlow, row: int, turn: Array, free: FreeWake) -> list[Array]:
    """Induced velocity (n+1,3) m/s at a row of each wake, turned back by R(a)."""
    edges = [x[row] for x in flow.rows]
    induced = flow.induced(np.concatenate(edges), free.precision) @ turn[row].T
    return np.split(induced, np.cumsum([len(e) for e in edges])[:-1])


def _store(velocity: list[Array], row: int, values: list[Array]) -> None:
    for own, value in zip(velocity, values, strict=True):
        own[row] = value


def _extend(flow: SteadyFlow, velocity: list[Array], last: int, turn: Array) -> None:
    """Let the rows behind the last free one keep the mean velocity of the revolution before it."""
    ages = flow.ages
    if last == len(ages) - 1:
        return
    recent = slice(max(0, min(last - 1, np.searchsorted(ages, ages[last] - flow.period))), last + 1)
    span = ages[recent][-1] - ages[recent][0]
    for s, own in enumerate(velocity):
        mean = np.trapezoid(own[recent], ages[recent], axis=0) / span
        wanted = flow.drifts[s][last] + (ages[last + 1 :] - ages[last])[:, None, None] * mean
        flow.place_drift(s, last + 1, wanted, turn)


def _last_free_row(flow: SteadyFlow, free: FreeWake) -> int:
    scale = flow.size if flow.axis is None else 2.0 * flow.size
    until = free.length * scale / np.linalg.norm(flow.wind)
    return int(np.clip(np.searchsorted(flow.ages, until), 1, len(flow.ages) - 1))


def _require_sound_row(flow: SteadyFlow, row: int, velocity: list[Array], moved: float) -> None:
    """Raise ConvergenceError where a wake runs away or the wind no longer carries it."""
    along = flow.wind / np.linalg.norm(flow.wind)
    for number, own in enumerate(velocity):
        where = f"row {row} of the wake of surface {number + 1}"
        if not np.isfinite(own[row]).all() or moved > RUNAWAY:
            raise _no_wake(f"the free wake runs away at {where}")
        if own[row].mean(axis=0) @ along <= -np.linalg.norm(flow.wind):
            raise _no_wake(
                f"the wind no longer carries {where}: the load is too high for a steady wake"
            )


def _no_wake(what: str) -> ConvergenceError:
    hint = "use thicker vortex cores, a smaller relaxation, a shorter free length or no free wake"
    return ConvergenceError("steady vortex lattice", what, hint)
