"""Rotations and rigid motions: identities, through zero and near pi."""

import numpy as np
import pytest
from scipy.linalg import expm

from galerna.structure.frames import (
    ad,
    adjoint,
    bracket_by_twist,
    exp_se3,
    exp_so3,
    hat,
    inverse_tangent_slope,
    inverse_tangents,
    log_se3,
    log_so3,
    quaternion_from_rotation,
    rotation_about,
    rotation_from_quaternion,
    tangent,
)

ANGLES = [
    0.0,
    1e-12,
    1e-8,
    1e-5,
    9.9e-5,
    1.1e-4,
    0.0999,
    0.1001,
    0.999,
    1.001,
    2.0,
    3.1,
    np.pi - 1e-9,
]


def twist(angle, seed=0):
    """A twist of a given angle with a translation of order one."""
    random = np.random.default_rng(seed)
    axis = random.normal(size=3)
    return np.concatenate([random.normal(size=3), angle * axis / np.linalg.norm(axis)])


def as_matrix(d):
    H = np.zeros((4, 4))
    H[:3, :3], H[:3, 3] = hat(d[3:]), d[:3]
    return H


@pytest.mark.parametrize("angle", ANGLES)
def test_exponentials_are_matrix_exponentials(angle):
    d = twist(angle)
    R, x = exp_se3(d)
    H = expm(as_matrix(d))
    assert np.allclose(R, H[:3, :3], atol=3e-15, rtol=0)
    assert np.allclose(x, H[:3, 3], atol=3e-15, rtol=0)
    assert np.allclose(R @ R.T, np.eye(3), atol=2e-15, rtol=0)


@pytest.mark.parametrize("angle", ANGLES)
def test_logarithm_inverts_the_exponential(angle):
    d = twist(angle, 3)
    assert np.allclose(log_se3(*exp_se3(d)), d, atol=1e-14, rtol=0)


def test_logarithm_at_half_a_turn():
    for axis in range(3):
        phi = log_so3(rotation_about(axis, np.pi))
        assert np.allclose(np.abs(phi), np.pi * np.eye(3)[axis], atol=1e-15)


@pytest.mark.parametrize("angle", ANGLES)
def test_tangents_are_inverse_of_each_other_and_carried_by_the_adjoint(angle):
    d = twist(angle, 1)
    ahead, behind = inverse_tangents(d)
    assert np.allclose(ahead @ tangent(d), np.eye(6), atol=1e-13)
    assert np.allclose(behind @ tangent(-d), np.eye(6), atol=1e-13)
    assert np.allclose(tangent(-d), adjoint(*exp_se3(d)) @ tangent(d), atol=1e-13)
    assert np.allclose(adjoint(*exp_se3(d)), expm(ad(d)), atol=1e-13)


@pytest.mark.parametrize("angle", [1e-9, 0.3, 0.999, 1.001, 2.5])
def test_tangent_is_the_derivative_of_the_exponential(angle):
    d, step = twist(angle, 2), 1e-6
    R, x = exp_se3(d)
    for k in range(6):
        e = step * np.eye(6)[k]
        (R1, x1), (R0, x0) = exp_se3(d + e), exp_se3(d - e)
        moved = log_se3(R.T @ R1, R.T @ (x1 - x)) - log_se3(R.T @ R0, R.T @ (x0 - x))
        assert np.allclose(moved / (2 * step), tangent(d)[:, k], atol=1e-9)


@pytest.mark.parametrize("dual", [True, False])
@pytest.mark.parametrize("angle", [0.0, 1e-6, 0.3, 0.999, 1.001, 2.5, 3.1])
def test_slopes_of_the_inverse_tangents(angle, dual):
    d, y = twist(angle, 4), twist(1.0, 5)
    even, odd = inverse_tangent_slope(d, y, dual), 0.5 * bracket_by_twist(y, dual)
    slopes = (even + odd, even - odd)
    for side in (0, 1):
        step = 1e-6 * np.eye(6)

        def applied(e, side=side):
            operator = inverse_tangents(d + e)[side]
            return (operator.T if dual else operator) @ y

        difference = [(applied(e) - applied(-e)) / 2e-6 for e in step]
        assert np.allclose(slopes[side], np.array(difference).T, atol=2e-9)


@pytest.mark.parametrize("angle", ANGLES)
def test_quaternions_there_and_back(angle):
    R = exp_so3(twist(angle, 6)[3:])
    assert np.allclose(rotation_from_quaternion(quaternion_from_rotation(R)), R, atol=2e-15)
