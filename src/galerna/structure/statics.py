"""Static equilibrium and steady rotation: Newton's method with load steps and a line search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError

from .frames import ad, exp_se3
from .pairs import Integers, carried_on
from .system import Balance, Forces, LoadFunction, State, System, reach, with_spin

Correction = tuple[Array, Array, Array]
Spin = tuple[Array, Array] | tuple[Array, Array, Integers]


def static_equilibrium(
    system: System,
    state: State | None = None,
    loads: Forces | LoadFunction | None = None,
    steps: int = 1,
    tolerance: float = 1e-9,
    spin: Spin | None = None,
) -> State:
    """The state at which all forces balance, reached in ``steps`` equal load steps.

    ``loads`` are forces or a function of the state. ``spin`` is a point (3,) m and an
    angular velocity (3,) rad/s with which the machine turns steadily, as a whole or in the
    nodes that are given third; its inertia takes part. ``tolerance`` is the residual over the
    largest force at a frame. Raises ConvergenceError if even small load steps fail,
    InputError for loads that are not finite or no whole number of steps.
    """
    if steps < 1 or steps != int(steps):
        raise InputError("steps", f"{steps} is not a whole number from 1 on")
    state = system.initial_state() if state is None else state.copy()
    solved, step, smallest = 0.0, 1.0 / steps, 1.0 / (64 * steps)
    while solved < 1.0 - 1e-12:
        factor = min(solved + step, 1.0)
        try:
            state = _newton(system, state, loads, factor, spin, tolerance)
        except ConvergenceError:
            step *= 0.5
            if step < smallest:
                raise
            continue
        solved = factor
    return state


def _newton(
    system: System,
    state: State,
    loads: Forces | LoadFunction | None,
    factor: float,
    spin: Spin | None,
    tolerance: float,
) -> State:
    """Newton's method at one load factor, with the wrenches carried along as in ``carried_on``.

    A correction that turns a frame by more than a radian is shortened; from the tenth on,
    each is halved until the residual falls.
    """
    carried, size = None, np.inf
    for iteration in range(40):
        balance, state = _balance(system, state, loads, factor, spin, carried)
        size = _size(system, balance, tolerance)
        correction = system.solve(balance, system.stiffness_scale)
        distance = np.abs(correction[0][:, 3:]).max()
        if size < tolerance and distance < 1e-6:
            return state
        if not np.isfinite(size):
            break
        length = min(1.0, 1.0 / max(distance, 1e-300))
        before = balance.pairs.wrench.copy()
        after = carried_on(system.pairs, balance.pairs, correction[0], correction[1])
        if iteration >= 10:
            length = _searched(system, state, loads, factor, spin, correction, size, tolerance)
        carried = before + length * (after - before)
        state = _moved(state, length, correction)
    worst = int(np.nan_to_num(np.abs(balance.residual), nan=np.inf).max(axis=1).argmax())
    raise ConvergenceError(
        system.names[worst],
        f"no equilibrium found at {100 * factor:.3g} % of the load; relative residual {size:.3g}",
        "use more load steps, or check that the structure is supported",
        state.time,
    )


def _searched(
    system: System,
    state: State,
    loads: Forces | LoadFunction | None,
    factor: float,
    spin: Spin | None,
    correction: Correction,
    size: float,
    tolerance: float,
) -> float:
    """The longest of a few halvings of a correction that lowers the residual."""
    for length in 0.5 ** np.arange(6):
        trial = _moved(state, length, correction)
        balance, _ = _balance(system, trial, loads, factor, spin, None)
        if _size(system, balance, tolerance) < (1.0 - 0.1 * length) * size:
            break
    return float(length)


def _balance(
    system: System,
    state: State,
    loads: Forces | LoadFunction | None,
    factor: float,
    spin: Spin | None,
    carried: Array | None = None,
) -> tuple[Balance, State]:
    """The residual with weight, loads and the square of the speed at ``factor``."""
    velocity_tangent = system.still()
    if spin is not None:
        state = with_spin(state, spin[0], np.sqrt(factor) * np.asarray(spin[1]), *spin[2:])
        velocity_tangent = spin_tangent(state)
    forces = Forces.none(len(system)) if loads is None else loads
    if callable(forces):
        forces = forces(state)
    forces.check(len(system))
    finite = np.isfinite(np.hstack([forces.dead, forces.follower])).all(axis=1)
    if not finite.all() and np.isfinite(state.position).all():
        raise InputError(system.names[int(finite.argmin())], "the loads are not finite numbers")
    balance = system.balance(
        state, forces.scaled(factor), velocity_tangent, system.still(), factor, carried
    )
    return balance, state


def spin_tangent(state: State) -> Array:
    """How body twists (n,6,6) follow the variations while the spatial twist stays: ad(v)."""
    return np.array([ad(v) for v in state.velocity])


def _size(system: System, balance: Balance, tolerance: float) -> float:
    """Residual over the largest force at a frame, violations over the structure's size.

    Where stiffness times the rounding of positions is more than the tolerance of the
    force, that is the measure.
    """
    pairs = balance.pairs
    extent = reach(system)
    rounding = 1e-15 * extent * float(np.abs(system.pairs.stiffness).max(initial=0.0))
    force = 1e-6 + float(np.abs(pairs.node_wrench).max(initial=0.0)) + rounding / tolerance
    gap = np.abs(pairs.motion[system.pairs.locked]).max(initial=0.0) / extent
    if balance.rows is not None:
        gap = max(gap, np.abs(balance.rows.residual).max(initial=0.0) / extent)
    return max(float(np.abs(balance.residual).max()) / force, float(gap))


def _moved(state: State, length: float, correction: Correction) -> State:
    """The state after ``length`` times a correction."""
    variation, multiplier, constraint = (length * part for part in correction)
    moved = replace(
        state.copy(),
        multiplier=state.multiplier + multiplier,
        constraint_multiplier=state.constraint_multiplier + constraint,
    )
    for i in range(1, len(variation)):
        turn, shift = exp_se3(variation[i])
        moved.position[i] = state.position[i] + state.rotation[i] @ shift
        moved.rotation[i] = state.rotation[i] @ turn
    return moved
