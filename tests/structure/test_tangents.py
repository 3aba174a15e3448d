"""The tangent of the one residual against central differences, and what it must balance."""

from dataclasses import replace

import numpy as np
import pytest

from galerna.structure.assembly import Structure
from galerna.structure.beam import discretise, straight
from galerna.structure.bodies import rigid_body
from galerna.structure.constraints import RollingWithoutSlip, TouchesPlane
from galerna.structure.frames import exp_se3, log_so3
from galerna.structure.joints import hinge, spherical, spring
from galerna.structure.solvers import SparseSolver
from galerna.structure.system import Forces

from .models import coupled_sections, disturbed


def machine():
    """A damped coupled beam on a body that hangs by a hinge, with a spring and a ball joint."""
    s = Structure()
    s.frame("body", [1.0, 0.3, 2.0], mass=rigid_body(5.0, [0.1, 0.2, 0.3], [2.0, 3.0, 4.0]))
    s.frame("weight", [1.0, 0.0, 6.5], mass=rigid_body(3.0, None, [1.0, 1.0, 2.0]))
    beam = discretise(straight(np.array([1.0, 0.0, 2.5]), np.eye(3), 4.0), 4.0,
                      coupled_sections(damping=0.01), np.linspace(0, 1, 3))  # fmt: skip
    names = s.beam("beam", beam, root="body")
    s.join(hinge("pin", "ground", "body", np.array([0.5, 0.1, 2.0]), np.array([0.3, 1.0, 0.2]),
                 stiffness=50.0, damping=3.0))  # fmt: skip
    s.join(spherical("ball", names[-1], "weight", np.array([1.0, 0.0, 6.5])))
    stiffness = np.diag([9.0, 8.0, 7.0, 6.0, 5.0, 4.0])
    place = np.array([1.2, 0.1, 5.0])
    s.join(spring("bush", "body", "weight", place, stiffness, 0.1 * np.eye(6)))
    return s


def whole_tangent(system, balance):
    """Derivative (6n-6, 6n-6) of the residual over the variations, at constant multipliers."""
    held = int(system.pairs.locked.sum())
    solver = SparseSolver(system.pairs, len(system))
    matrix = solver.matrix(balance.nodes, balance.pairs, 1.0, balance.rows).toarray()
    size = 6 * (len(system) - 1)
    assert matrix.shape[0] >= size + held
    return matrix[:size, :size]


def difference(system, state, forces, change):
    """Central difference of the residual along ``change(state, node, component, step)``."""
    step, still = 1e-6, system.still()
    columns = []
    for node in range(1, len(system)):
        for k in range(6):
            ahead, back = (
                system.balance(change(state, node, k, sign * step), forces, still, still).residual
                for sign in (1, -1)
            )
            columns.append(((ahead - back) / (2 * step))[1:].ravel())
    return np.array(columns).T


def moved(state, node, k, step):
    out = state.copy()
    turn, shift = exp_se3(step * np.eye(6)[k])
    out.position[node] += out.rotation[node] @ shift
    out.rotation[node] = out.rotation[node] @ turn
    return out


def faster(state, node, k, step):
    out = state.copy()
    out.velocity[node, k] += step
    return out


@pytest.mark.parametrize("rolling", [False, True])
def test_tangents_are_the_derivatives_of_the_residual(rolling):
    s = machine()
    if rolling:
        s.constrain(TouchesPlane("floor", "weight", 0.4, np.array([0.0, 0.6, 0.8]), 6.0))
        s.constrain(RollingWithoutSlip("grip", "weight", 0.4, np.array([0.0, 0.6, 0.8])))
    system = s.build(check=False)
    state = disturbed(system, 0.2)
    state.constraint_multiplier[:] = 10.0
    random = np.random.default_rng(2)
    n = len(system)
    forces = Forces(random.normal(size=(n, 6)) * 50, random.normal(size=(n, 6)) * 50)
    still, one = system.still(), np.tile(np.eye(6), (n, 1, 1))
    stiffness = whole_tangent(system, system.balance(state, forces, still, still))
    moving = whole_tangent(system, system.balance(state, forces, one, still))
    by_position = difference(system, state, forces, moved)
    by_velocity = difference(system, state, forces, faster)
    size = np.abs(by_position).max()
    assert np.allclose(stiffness, by_position, atol=1e-8 * size, rtol=0)
    assert np.allclose(moving - stiffness, by_velocity, atol=1e-8 * size, rtol=0)


def test_a_rigid_motion_changes_no_internal_force_and_forces_balance():
    system = machine().build()
    state = disturbed(system, 0.2)
    turn, shift = exp_se3(np.array([100.0, -200.0, 50.0, 0.5, 2.0, -1.0]))
    inner = ~(system.pairs.ends == 0).any(axis=1)
    away = replace(
        state.copy(),
        position=state.position @ turn.T + shift,
        rotation=turn @ state.rotation,
    )
    first, second = system.pair_answer(state), system.pair_answer(away)
    largest = np.abs(first.node_wrench).max()
    assert np.allclose(first.node_wrench[inner], second.node_wrench[inner], atol=1e-9 * largest)
    for e in np.flatnonzero(inner):
        sums = np.zeros(6)
        for side, node in enumerate(system.pairs.ends[e]):
            R, x = state.rotation[node], state.position[node]
            force, moment = (R @ first.node_wrench[e, 6 * side : 6 * side + 6].reshape(2, 3).T).T
            sums += np.concatenate([force, moment + np.cross(x, force)])
        assert np.abs(sums).max() < 1e-12 * largest


def test_stiff_loads_enter_the_tangent_as_they_are_defined():
    system = machine().build()
    n = len(system)
    state = disturbed(system, 0.1)
    random = np.random.default_rng(5)
    K, C = random.normal(size=(2, n, 6, 6))
    origin = state.copy()

    def loads(at):
        velocity = np.concatenate(
            [np.einsum("nij,nj->ni", at.rotation, at.velocity[:, k : k + 3]) for k in (0, 3)],
            axis=1,
        )
        shift = np.zeros((n, 6))
        shift[:, :3] = at.position - origin.position
        for i in range(n):
            shift[i, 3:] = log_so3(at.rotation[i] @ origin.rotation[i].T)
        dead = -np.einsum("nij,nj->ni", K, shift) - np.einsum("nij,nj->ni", C, velocity)
        return Forces(dead, np.zeros((n, 6)), K, C)

    still, one = system.still(), np.tile(np.eye(6), (n, 1, 1))
    tangent = whole_tangent(system, system.balance(state, loads(state), one, still))
    step = 1e-6
    columns = []
    for node in range(1, n):
        for k in range(6):
            change = []
            for sign in (1, -1):
                at = faster(moved(state, node, k, sign * step), node, k, sign * step)
                change.append(system.balance(at, loads(at), still, still).residual)
            columns.append(((change[0] - change[1]) / (2 * step))[1:].ravel())
    assert np.allclose(tangent, np.array(columns).T, atol=1e-8 * np.abs(tangent).max(), rtol=0)
