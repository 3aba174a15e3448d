"""Tower dam effect and shadow: potential theory, momentum, moving and leaning towers, the top."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from galerna.aero.tower_influence import across_tower, add_tower_influence, tower_sections
from galerna.turbine.model import Tower

HEIGHT, RADIUS, DRAG, WIND = 80.0, 2.0, 0.6, np.array([10.0, 0.0, 0.0])
AXIS = np.stack([np.zeros(9), np.zeros(9), np.linspace(0.0, HEIGHT, 9)], axis=1)
SECTION = np.tile([RADIUS, DRAG], (9, 1))
STILL = np.zeros((9, 3))


def disturbed(points, wind=WIND, axis=AXIS, motion=STILL, shadow=True):
    points = np.atleast_2d(np.asarray(points, dtype=float))
    velocity = np.tile(wind, (len(points), 1))
    inside = add_tower_influence(points, axis, motion, SECTION, shadow, velocity)
    return velocity, inside


def circle(radius, height=40.0, n=90):
    theta = (np.arange(n) + 0.5) * 2 * np.pi / n
    return np.stack(
        [radius * np.cos(theta), radius * np.sin(theta), np.full(n, height)], axis=1
    ), np.stack([np.cos(theta), np.sin(theta), 0 * theta], axis=1)


def test_no_flow_through_the_towers_surface():
    points, normal = circle(RADIUS * (1 + 1e-12))
    velocity, inside = disturbed(points, shadow=False)
    assert inside == -1
    np.testing.assert_allclose(np.sum(velocity * normal, axis=1), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(velocity, axis=1).max(), 2 * WIND[0], rtol=1e-3)


def test_potential_flow_has_no_source_and_no_swirl():
    points, normal = circle(3.0 * RADIUS, n=360)
    velocity, _ = disturbed(points, shadow=False)
    assert np.sum(velocity * normal) == pytest.approx(0.0, abs=1e-9)
    tangent = np.stack([-normal[:, 1], normal[:, 0], 0 * normal[:, 0]], axis=1)
    assert np.sum(velocity * tangent) == pytest.approx(0.0, abs=1e-9)


def test_the_wind_is_dammed_upstream_and_falls_off_with_the_square():
    velocity, _ = disturbed([[-2 * RADIUS, 0, 40.0], [-4 * RADIUS, 0, 40.0]])
    np.testing.assert_allclose(velocity[:, 0], WIND[0] * (1 - np.array([1 / 4, 1 / 16])))


def test_the_shadows_momentum_is_the_towers_drag():
    y = np.linspace(-12.0, 12.0, 48001)
    for x in (6.0, 12.0):
        deficit = [
            across_tower(x, yi, DRAG, False)[0] - across_tower(x, yi, DRAG, True)[0] for yi in y
        ]
        # The width follows r, not x, which adds a little away from the centre line.
        assert np.trapezoid(deficit, y) == pytest.approx(DRAG, rel=0.02)


def test_a_moving_tower_feels_the_relative_wind():
    points, _ = circle(2.5 * RADIUS)
    drift = np.array([-3.0, 1.0, 0.5])
    still, _ = disturbed(points, wind=WIND - drift)
    moving, _ = disturbed(points, wind=WIND, motion=STILL + drift)
    np.testing.assert_allclose(moving, still + drift, atol=1e-12)


def test_a_leaning_tower_is_a_turned_one():
    turn = Rotation.from_rotvec([0.1, -0.2, 0.3]).as_matrix()
    points, _ = circle(2.5 * RADIUS)
    upright, _ = disturbed(points)
    leaning, _ = disturbed(points @ turn.T, wind=turn @ WIND, axis=AXIS @ turn.T)
    np.testing.assert_allclose(leaning, upright @ turn.T, atol=1e-12)


def test_the_influence_ends_smoothly_above_the_top():
    z = np.linspace(HEIGHT - 3.0, HEIGHT + 3.0, 1201)
    points = np.stack([np.full_like(z, 3 * RADIUS), np.full_like(z, 0.3), z], axis=1)
    change = disturbed(points)[0] - WIND
    assert np.all(change[z > HEIGHT + RADIUS] == 0.0)
    assert np.abs(np.diff(change[:, 0])).max() < 0.01 * np.abs(change).max()
    assert np.ptp(change[z < HEIGHT, 0]) < 1e-12


def test_points_inside_are_reported_and_left():
    velocity, inside = disturbed([[-9.0, 0, 40.0], [0.5, 0.5, 40.0], [0.0, 0.0, 41.0]])
    assert inside == 1
    assert np.array_equal(velocity[1], WIND)
    assert disturbed([[0.0, 0.0, HEIGHT + 0.1]])[1] == -1


def test_shadow_is_downwind_only_and_never_turns_the_flow():
    upwind, _ = disturbed([[-6.0, 0.5, 40.0]])
    without, _ = disturbed([[-6.0, 0.5, 40.0]], shadow=False)
    assert np.array_equal(upwind, without)
    assert across_tower(1.0, 0.0, 5.0, True)[0] == pytest.approx(-1.0 - 0.5)
    y = np.linspace(0.0, 4.0, 4001)
    along = np.array([across_tower(3.0, yi, DRAG, True)[0] for yi in y])
    assert np.abs(np.diff(along)).max() < 1e-3


def test_calm_and_a_real_towers_sections():
    velocity, inside = disturbed([[3.0, 0.0, 40.0]], wind=np.zeros(3))
    assert inside == -1
    assert not velocity.any()
    tower = Tower(np.array([0.0, 1.0]), AXIS[[0, -1]], np.array([6.0, 4.0]), np.array([0.5, 0.7]))
    np.testing.assert_allclose(tower_sections(tower, np.array([0.5])), [[2.5, 0.6]])
