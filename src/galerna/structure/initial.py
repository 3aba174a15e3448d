"""Accelerations and joint forces that fit the positions and velocities of a start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError

from .forces import Forces, in_body_axes
from .frames import ad, exp_se3
from .scheme import Scheme
from .system import Balance, State, System, reach


def with_initial_accelerations(system: System, state: State, forces: Forces | None = None) -> State:
    """The state with accelerations and multipliers that fit its positions and velocities.

    ``forces`` are those of body twists that stay constant; their mass blocks take part.
    Raises InputError, with the joint named, where positions or velocities violate a constraint.
    """
    check_positions(system, state)
    n = len(system)
    rest = replace(state.copy(), acceleration=np.zeros((n, 6)))
    rest.multiplier[:], rest.constraint_multiplier[:] = 0.0, 0.0
    identity = np.tile(np.eye(6), (n, 1, 1))
    rates, accelerations = _along_the_flow(system, rest, 1e-3)
    _check_velocities(system, rest, rates)
    forces = forces or Forces.none(n)
    balance = system.balance(rest, forces, system.still(), identity)
    balance.nodes = system.mass.copy()
    if forces.mass is not None:
        balance.nodes += in_body_axes(forces.mass, rest.rotation)
    balance.pairs.tangent[:] = 0.0
    system.add_inertance(balance.pairs, rest.acceleration, identity)
    balance.pairs.motion[:] = accelerations[: len(system.pairs.ends)]
    if balance.rows is not None:
        kept = balance.rows
        balance.rows = replace(
            kept, residual=accelerations[len(system.pairs.ends) :, 0], jacobian=kept.direction,
            tangent=0.0 * kept.tangent,
        )  # fmt: skip
    rate, rest.multiplier, rest.constraint_multiplier = system.solve(balance, system.mass_scale)
    rest.acceleration, rest.auxiliary = rate, rate.copy()
    return rest


def with_fitting_velocities(system: System, state: State) -> State:
    """The state with the nearest velocities that joints which hold positions permit.

    What is added has the least kinetic energy.
    """
    rates, _ = _along_the_flow(system, state, 1e-4)
    change = _least(system, _masses_in_joints(system, state), rates)
    return replace(state, velocity=state.velocity + change)


def under_way(system: System, state: State, scheme: Scheme, dt: float) -> State:
    """A start with what generalized-alpha has of joints that move when it has run for long.

    Its own accelerations are those of another time, and its velocities those that lead to where
    the joints are a step of ``dt`` s later. From exact ones the accelerations of a driven joint
    ring for dozens of steps, by what they change in a few. Source: Arnold, Bruls and Cardona,
    Numer. Math. 129 (2015) 149.
    """
    later = scheme.alpha_m - scheme.alpha_f
    share = 1.0 / 6.0 - scheme.beta - 0.5 * later
    balance = _masses_in_joints(system, state)
    bent = np.array([ad(v) @ a for v, a in zip(state.velocity, state.acceleration, strict=True)])
    jerks = _third_rate(system, state, dt)
    velocities = dt**2 * (share * jerks - _rate_of_motions(system, balance, bent) / 12.0)
    jerk, change = (_least(system, balance, rates) for rates in (jerks, velocities))
    return replace(
        state,
        velocity=state.velocity + change,
        auxiliary=state.auxiliary + later * dt * jerk,
    )


def _masses_in_joints(system: System, state: State) -> Balance:
    """The equations of masses and joints alone, factorised: nothing pulls and nothing is stiff."""
    n = len(system)
    identity = np.tile(np.eye(6), (n, 1, 1))
    balance = system.balance(state, Forces.none(n), system.still(), identity)
    balance.nodes, balance.residual = system.mass.copy(), np.zeros((n, 6))
    balance.pairs.tangent[:] = 0.0
    system.add_inertance(balance.pairs, np.zeros((n, 6)), identity)
    if balance.rows is not None:
        kept = balance.rows
        balance.rows = replace(kept, jacobian=kept.direction, tangent=0.0 * kept.tangent)
    system.factorise(balance, system.mass_scale)
    return balance


def _least(system: System, balance: Balance, rates: Array) -> Array:
    """The twists (n,6) of least energy that take ``rates`` away from the constrained motions."""
    pairs = len(system.pairs.ends)
    balance.pairs.motion[:] = rates[:pairs]
    if balance.rows is not None:
        balance.rows = replace(balance.rows, residual=rates[pairs:, 0])
    return system.correction(balance)[0]


def _rate_of_motions(system: System, balance: Balance, twist: Array) -> Array:
    """How fast the constrained motions change by twists (n,6)."""
    both = twist[system.pairs.ends].reshape(-1, 12, 1)
    rates = (balance.pairs.direction @ both)[:, :, 0]
    if balance.rows is None:
        return rates
    others = balance.rows.direction @ twist.ravel()
    return np.vstack([rates, np.pad(others[:, None], ((0, 0), (0, 5)))])


def _third_rate(system: System, state: State, step: float) -> Array:
    """Third rate of all constrained motions while the rates of the twists stay constant."""
    v, a = state.velocity, state.acceleration
    values = []
    for t in (-2.0 * step, -step, step, 2.0 * step):
        bent = np.array([ad(x) @ y for x, y in zip(v, a, strict=True)])
        moved = _moved(state, t * v + t**2 / 2.0 * a + t**3 / 12.0 * bent, state.time + t)
        values.append(_constrained_motions(system, moved))
    first, second, third, fourth = values
    rate: Array = (fourth - 2.0 * third + 2.0 * second - first) / (2.0 * step**3)
    rate[_velocity_rows(system)] = 0.0
    return rate


def velocity_violation(system: System, state: State) -> float:
    """Largest rate m/s or rad/s at which the state leaves its constraints."""
    rates, _ = _along_the_flow(system, state, 1e-4)
    held = rates[: len(system.pairs.ends)][system.pairs.locked]
    others = rates[len(system.pairs.ends) :, 0]
    return float(np.abs(np.concatenate([held, others])).max(initial=0.0))


def _along_the_flow(system: System, state: State, step: float) -> tuple[Array, Array]:
    """First and second rate of all constrained motions while the body twists stay constant.

    By central differences over ``step`` s, or the time in which a frame turns by as many rad.
    """
    step /= max(1.0, float(np.abs(state.velocity[:, 3:]).max()))
    values = []
    for sign in (-1.0, 0.0, 1.0):
        moved = _moved(state, sign * step * state.velocity, state.time + sign * step)
        values.append(_constrained_motions(system, moved))
    before, now, after = values
    first = (after - before) / (2.0 * step)
    second = (after - 2.0 * now + before) / step**2
    velocity_level = _velocity_rows(system)
    second[velocity_level] = first[velocity_level]
    first[velocity_level] = now[velocity_level]
    return first, second


def _moved(state: State, increment: Array, time: float) -> State:
    """The state at another time, its frames moved by increments (n,6) of their own."""
    moved = state.copy()
    moved.time = time
    for i in range(1, len(increment)):
        turn, shift = exp_se3(increment[i])
        moved.position[i] = state.position[i] + state.rotation[i] @ shift
        moved.rotation[i] = state.rotation[i] @ turn
    return moved


def _velocity_rows(system: System) -> NDArray[np.bool_]:
    """Rows of ``_constrained_motions`` that are constraints on velocities."""
    kinds = [not constraint.holonomic for constraint, _ in system.constraints]
    others = np.repeat(np.array(kinds, dtype=bool), system.constraint_sizes)
    return np.concatenate([np.zeros(len(system.pairs.ends), dtype=bool), others])


def _constrained_motions(system: System, state: State) -> Array:
    """Pair motions (m,6) and below them the constraints' values in the first column."""
    motion = system.pair_motion(state)
    values = [
        c.violation(state.time, state.position[k], state.rotation[k], state.velocity[k])
        for c, k in system.constraints
    ]
    column = np.concatenate([*values, np.zeros(0)])
    return np.vstack([motion, np.pad(column[:, None], ((0, 0), (0, 5)))])


def check_positions(system: System, state: State) -> None:
    """Raise InputError, with the joint named, where positions violate a constraint.

    The limit is 1e-5 of the structure's extent, or of 1 m where that is more.
    """
    values = _constrained_motions(system, state)
    values[_velocity_rows(system)] = 0.0
    _check(system, values, 1e-5 * reach(system), "positions", "m, rad")


def _check_velocities(system: System, state: State, rates: Array) -> None:
    limit = 1e-5 * (1.0 + np.abs(state.velocity).max())
    _check(system, rates, limit, "velocities", "m/s, rad/s")


def _check(system: System, values: Array, limit: float, kind: str, units: str) -> None:
    """Name the joint or constraint whose value is the largest, if that is above the limit."""
    m = len(system.pairs.ends)
    held = np.where(system.pairs.locked, np.abs(values[:m]), 0.0).max(axis=1)
    size = np.concatenate([held, np.abs(values[m:, 0])])
    if size.max(initial=0.0) <= limit:
        return
    worst = int(size.argmax())
    rows = [name for (c, _), r in zip(system.constraints, system.constraint_sizes, strict=True)
            for name in [c.name] * r]  # fmt: skip
    raise InputError(
        [*system.pair_names, *rows][worst],
        f"the initial {kind} violate this constraint by {size[worst]:.3g} ({units})",
        f"give {kind} that it permits",
    )
