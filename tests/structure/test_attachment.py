"""Stations between frames: exact when rigid, true derivatives, and no work lost."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.contract import Loads
from galerna.structure.attachment import Attachment
from galerna.structure.forces import Forces
from galerna.structure.frames import exp_se3, exp_so3
from galerna.structure.system import State

rng = np.random.default_rng(3)
ENDS = np.array([[1, 2], [1, 2], [2, 3], [3, 3], [1, 1]])
FRACTION = np.array([0.0, 0.3, 0.8, 0.0, 0.0])


def a_state() -> State:
    n = 4
    rotation = np.stack([exp_so3(np.array([0.1, -0.3, 0.2]) * k) for k in range(n)])
    position = np.array([[0.0, 0, 0], [1.0, 2, 3], [1.2, 2.3, 5.0], [1.1, 2.9, 7.0]])
    twists = [rng.normal(size=(n, 6)) for _ in range(3)]
    return State(0.0, position, rotation, *twists, np.zeros((2, 6)), np.zeros(0))


def attached(state: State) -> Attachment:
    position = rng.normal(size=(len(ENDS), 3))
    rotation = np.stack([exp_so3(rng.normal(size=3)) for _ in ENDS])
    return Attachment(state, ENDS, FRACTION, position, rotation)


def moved(state: State, step: float) -> State:
    """Every frame carried on along its twist."""
    new = state.copy()
    for i in range(len(state.position)):
        turn, shift = exp_se3(step * state.velocity[i])
        new.rotation[i] = state.rotation[i] @ turn
        new.position[i] = state.position[i] + state.rotation[i] @ shift
    return new


def test_stations_start_where_they_are_put() -> None:
    state = a_state()
    position = rng.normal(size=(len(ENDS), 3))
    rotation = np.stack([exp_so3(rng.normal(size=3)) for _ in ENDS])
    motion = Attachment(state, ENDS, FRACTION, position, rotation).motion
    assert motion.position == pytest.approx(position, abs=1e-13)
    assert motion.rotation == pytest.approx(rotation, abs=1e-13)


def test_velocities_are_the_derivatives_of_places() -> None:
    state = a_state()
    stations, h = attached(state), 1e-6
    motion = stations.motion
    velocity, spin = motion.velocity.copy(), motion.angular_velocity.copy()
    stations.follow(moved(state, h))
    ahead, turned = motion.position.copy(), motion.rotation.copy()
    stations.follow(moved(state, -h))
    assert velocity == pytest.approx((ahead - motion.position) / (2 * h), abs=1e-8)
    rate = np.einsum("nij,nkj->nik", (turned - motion.rotation) / (2 * h), stations.motion.rotation)
    vector = np.stack([rate[:, 2, 1], rate[:, 0, 2], rate[:, 1, 0]], axis=1)
    assert spin == pytest.approx(vector, abs=1e-5)


def test_loads_do_the_same_work_on_stations_and_frames() -> None:
    state = a_state()
    stations, n = attached(state), len(ENDS)
    loads = Loads(rng.normal(size=(n, 3)), rng.normal(size=(n, 3)))
    motion, forces = stations.motion, Forces.none(4)
    stations.add_loads(loads, forces)
    power = (loads.force * motion.velocity).sum() + (loads.moment * motion.angular_velocity).sum()
    assert (forces.follower * state.velocity).sum() == pytest.approx(power, rel=1e-12)


def test_a_rigid_turn_has_its_centripetal_acceleration() -> None:
    state, spin = a_state(), np.array([0.2, -0.5, 0.9])
    for i, R in enumerate(state.rotation):
        state.velocity[i] = np.concatenate([R.T @ np.cross(spin, state.position[i]), R.T @ spin])
        state.acceleration[i] = 0.0  # body twists of a steady turn do not change
    motion = attached(state).motion
    assert motion.velocity == pytest.approx(np.cross(spin, motion.position))
    centripetal = np.cross(spin, np.cross(spin, motion.position))
    assert motion.acceleration == pytest.approx(centripetal, abs=1e-12)


def test_accelerations_are_the_derivatives_of_velocities() -> None:
    """Frames that turn fast and deform slowly along constant twists."""
    state, h = a_state(), 1e-5
    spin = np.array([0.5, -1.0, 2.0])
    state.acceleration[:] = 0.0
    for i, R in enumerate(state.rotation):
        state.velocity[i] *= 0.1
        state.velocity[i] += np.concatenate([R.T @ np.cross(spin, state.position[i]), R.T @ spin])
    stations = attached(state)
    motion = stations.motion
    acceleration, spin_rate = motion.acceleration.copy(), motion.angular_acceleration.copy()
    stations.follow(moved(state, h))
    velocity, turning = motion.velocity.copy(), motion.angular_velocity.copy()
    stations.follow(moved(state, -h))
    of_velocity = (velocity - motion.velocity) / (2.0 * h)
    assert acceleration == pytest.approx(of_velocity, abs=1e-4 * np.abs(of_velocity).max())
    of_spin = (turning - motion.angular_velocity) / (2.0 * h)
    assert spin_rate == pytest.approx(of_spin, abs=1e-5 * spin @ spin)
