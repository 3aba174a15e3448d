"""The wind field: mean wind, shear, direction, and a box carried by the mean wind."""

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from galerna.contract import Inflow
from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.inflow.field import WindField
from galerna.inflow.mean import HubWind, Profile, Steady, TimeSeries

HUB = 90.0
SPEED = 10.0


def random_box(**changes):
    data = np.random.default_rng(3).standard_normal((3, 40, 9, 11)).astype(np.float32)
    settings = {"data": data, "spacing": (2.0, 5.0, 4.0), "mean_speed": SPEED, "hub_height": HUB}
    return Box(**(settings | changes))


def field(box=None, *, profile=None, held_below=False, **wind):
    course = Steady(HubWind(**({"speed": SPEED} | wind)))
    return WindField(course, profile or Profile(HUB), box, held_below)


def points_in_rotor(n=50, radius=18.0):
    rng = np.random.default_rng(7)
    r, angle = radius * np.sqrt(rng.random(n)), 2 * np.pi * rng.random(n)
    return np.stack([rng.uniform(-5, 5, n), r * np.cos(angle), HUB + r * np.sin(angle)], axis=1)


def rotation_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def at_height(wind_field, z, y=0.0, time=0.0):
    return wind_field.velocity(np.array([[0.0, y, z]]), time)[0]


def test_answers_the_contract():
    assert isinstance(field(), Inflow)


def test_uniform_wind_blows_along_x_everywhere():
    velocity = field().velocity(points_in_rotor(), 3.0)
    np.testing.assert_array_equal(velocity, np.tile([SPEED, 0, 0], (50, 1)))


def test_positive_direction_turns_the_wind_about_the_vertical():
    velocity = at_height(field(direction=np.radians(30)), HUB)
    np.testing.assert_allclose(velocity, SPEED * np.array([np.cos(np.pi / 6), 0.5, 0]), atol=1e-12)


def test_upflow_lifts_the_wind_and_keeps_its_speed():
    velocity = at_height(field(upflow=np.radians(8), direction=1.0), HUB)
    assert velocity[2] == pytest.approx(SPEED * np.sin(np.radians(8)))
    assert np.linalg.norm(velocity) == pytest.approx(SPEED)


@pytest.mark.parametrize(
    ("profile", "height", "ratio"),
    [
        (Profile.power_law(HUB, 0.2), 45.0, 0.5**0.2),
        (Profile.power_law(HUB, 0.2), -1.0, 0.0),
        (Profile.logarithmic(HUB, 0.03), 30.0, np.log(1000) / np.log(3000)),
        (Profile.logarithmic(HUB, 0.03), 0.01, 0.0),
        (Profile.linear(HUB, 0.002), 140.0, 1.1),
        (Profile.power_law(HUB, 0.2), HUB, 1.0),
        (Profile.logarithmic(HUB, 0.03), HUB, 1.0),
    ],
)
def test_shear(profile, height, ratio):
    assert at_height(field(profile=profile), height)[0] == pytest.approx(SPEED * ratio)


def test_roughness_above_the_hub_is_refused():
    with pytest.raises(InputError, match="roughness length"):
        Profile.logarithmic(HUB, 100.0)


def test_veer_turns_the_wind_above_the_hub():
    veering = field(profile=Profile.power_law(HUB, 0.0, veer=0.01))
    assert np.arctan2(*at_height(veering, HUB + 20)[1::-1]) == pytest.approx(0.2)
    assert np.arctan2(*at_height(veering, HUB - 20)[1::-1]) == pytest.approx(-0.2)


def test_gradients_rise_to_the_left_and_upwards_and_follow_the_direction():
    sheared = field(lateral_gradient=0.1, vertical_gradient=0.05, direction=np.pi / 2)
    left = np.array([[-20.0, 0.0, HUB + 10]])  # left of a wind that blows along y
    assert sheared.velocity(left, 0.0)[0, 1] == pytest.approx(SPEED + 2.0 + 0.5)


def test_time_series_is_straight_between_times_and_held_beyond():
    series = TimeSeries([0, 10], speed=[8, 12], vertical_speed=1.0)
    assert [series.at(t).speed for t in (-5, 0, 2.5, 10, 99)] == [8, 8, 9, 12, 12]
    assert series.at(3.0).vertical_speed == 1.0
    assert series.mean_speed(20.0) == pytest.approx(11.0)


def test_time_series_turns_the_short_way():
    series = TimeSeries([0, 10], speed=8.0, direction=np.radians([170, -170]))
    assert series.at(5.0).direction == pytest.approx(np.pi)


@pytest.mark.parametrize(
    ("time", "speed"), [([0, 0], [1, 2]), ([0, 1], [1, 2, 3]), ([0, 1], [1, np.nan]), ([0], [1])]
)
def test_bad_time_series(time, speed):
    with pytest.raises(InputError):
        TimeSeries(time, speed=speed)


def test_box_is_interpolated_like_an_independent_trilinear_one():
    box, points, time = random_box(lead=10.0, periodic=False), points_in_rotor(), 1.7
    axes = (box.time, box.y, box.z)
    expected = [
        RegularGridInterpolator(axes, component)(
            np.stack([time - points[:, 0] / SPEED, points[:, 1], points[:, 2]], axis=1)
        )
        for component in box.data.astype(float)
    ]
    expected[0] += SPEED
    np.testing.assert_allclose(field(box).velocity(points, time), np.stack(expected, 1), atol=1e-9)


def test_box_is_frozen_and_moves_with_the_mean_wind():
    wind, points = field(random_box()), points_in_rotor()
    later = points + np.array([SPEED * 0.9, 0, 0])
    np.testing.assert_allclose(wind.velocity(later, 4.9), wind.velocity(points, 4.0), atol=1e-9)


def test_box_repeats_after_its_length_and_has_no_seam():
    box = random_box()
    wind, points = field(box), points_in_rotor()
    period = box.length / SPEED
    np.testing.assert_allclose(
        wind.velocity(points, 1.0 + period), wind.velocity(points, 1.0), atol=1e-9
    )
    before, after = (at_height(wind, HUB, time=period + dt) for dt in (-1e-7, 1e-7))
    np.testing.assert_allclose(before, after, atol=1e-5)


def test_box_turns_with_the_wind():
    angle, points = np.radians(35), points_in_rotor()
    straight = field(random_box()).velocity(points, 2.0)
    turned = field(random_box(), direction=angle).velocity(points @ rotation_z(angle).T, 2.0)
    np.testing.assert_allclose(turned, straight @ rotation_z(angle).T, atol=1e-9)


def test_box_tilts_with_the_upflow_about_the_hub():
    angle, hub = np.radians(8), np.array([0, 0, HUB])
    c, s = np.cos(angle), np.sin(angle)
    lift = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    points = points_in_rotor()
    straight = field(random_box()).velocity(points, 2.0)
    lifted = field(random_box(), upflow=angle).velocity((points - hub) @ lift.T + hub, 2.0)
    np.testing.assert_allclose(lifted, straight @ lift.T, atol=1e-9)


def test_box_stands_on_the_mean_wind_whatever_it_is():
    profile, points = Profile.power_law(HUB, 0.2), points_in_rotor()
    wind = {"gust": 2.0, "lateral_gradient": 0.1, "vertical_gradient": 0.2, "vertical_speed": 0.7}
    alone = field(random_box(), speed=0.0).velocity(points, 2.0)
    mean = field(profile=profile, **wind).velocity(points, 2.0)
    both = field(random_box(), profile=profile, **wind).velocity(points, 2.0)
    np.testing.assert_allclose(both, alone + mean, atol=1e-9)


@pytest.mark.parametrize(
    ("point", "lack"),
    [
        ((0, 23, HUB), "3 m are missing to the left"),
        ((0, -21.5, HUB), "1.5 m are missing to the right"),
        ((0, 0, HUB + 24), "4 m are missing above"),
        ((0, 0, HUB - 27), "7 m are missing below"),
        ((-50, 0, HUB), "1.2 s are missing after its end"),
        ((12, 0, HUB), "0.2 s are missing before its start"),
    ],
)
def test_point_outside_the_box_is_an_error_that_says_what_is_missing(point, lack):
    box = random_box(periodic=False, lead=0.0)
    points = np.vstack([points_in_rotor(5) * [0, 1, 1], point])
    time = 1.0 if point[0] > 0 else 4.0
    with pytest.raises(InputError, match=lack):
        field(box).velocity(points, time)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("axis", range(3))
def test_a_point_that_is_not_a_number_is_an_error(bad, periodic, axis):
    point = np.array([[0.0, 0.0, HUB]])
    point[0, axis] = bad
    with pytest.raises(InputError):
        field(random_box(periodic=periodic)).velocity(point, 1.0)
    with pytest.raises(InputError):
        field(random_box(periodic=periodic)).velocity(np.array([[0.0, 0.0, HUB]]), bad)


def test_points_on_the_outermost_rows_are_inside():
    box = random_box()
    corners = np.array([[0.0, y, z] for y in box.y[[0, -1]] for z in box.z[[0, -1]]])
    expected = box.data[:, 0][:, [0, 0, -1, -1], [0, -1, 0, -1]].T + np.array([SPEED, 0, 0])
    np.testing.assert_allclose(field(box).velocity(corners, 0.0), expected, atol=1e-6)


def test_lowest_row_may_be_held_down():
    box = random_box()
    wind = field(box, held_below=True)
    np.testing.assert_allclose(
        at_height(wind, 10.0, y=3.0, time=1.3), at_height(wind, box.bottom, y=3.0, time=1.3)
    )


def test_tower_rows_continue_the_box_downwards():
    tower = np.random.default_rng(5).standard_normal((3, 40, 6)).astype(np.float32)
    box = random_box(tower=tower)
    assert box.lowest == box.bottom - 20.0
    between = at_height(field(box), box.bottom - 6.0)
    expected = 0.5 * (tower[:, 0, 1] + tower[:, 0, 2]) + [SPEED, 0, 0]
    np.testing.assert_allclose(between, expected, atol=1e-6)
    last = at_height(field(box), box.lowest)
    np.testing.assert_allclose(last, tower[:, 0, -1] + [SPEED, 0, 0], atol=1e-6)
    with pytest.raises(InputError, match=r"2\.5 m are missing below"):
        at_height(field(box), box.lowest - 2.5)
    np.testing.assert_array_equal(at_height(field(box, held_below=True), box.lowest - 2.5), last)


def test_mean_wind_belongs_in_the_profile_or_in_the_box():
    with pytest.raises(InputError, match="holds the mean wind"):
        field(random_box(holds_mean=True))
    with pytest.raises(InputError, match="does not hold the mean wind"):
        field(random_box(), profile=Profile.in_box(HUB))
    whole = field(random_box(holds_mean=True), profile=Profile.in_box(HUB))
    apart = field(random_box(), speed=0.0)
    points = points_in_rotor()
    np.testing.assert_array_equal(whole.velocity(points, 1.0), apart.velocity(points, 1.0))


def test_hub_velocity_is_the_wind_at_the_hub():
    wind = field(random_box())
    np.testing.assert_array_equal(wind.hub_velocity(1.0), at_height(wind, HUB, time=1.0))
    assert wind.hub_wind(1.0).speed == SPEED


@pytest.mark.parametrize("periodic", [True, False])
def test_held_everywhere_it_is_the_same_inside_and_has_no_end(periodic):
    wind = field(random_box(periodic=periodic, lead=20.0))
    held, inside = wind.held_everywhere(), points_in_rotor()
    np.testing.assert_array_equal(held.velocity(inside, 1.0), wind.velocity(inside, 1.0))
    with pytest.raises(InputError, match="does not hold"):
        wind.velocity(np.array([[0.0, 300.0, HUB]]), 1.0)
    beyond = held.velocity(np.array([[0.0, 300.0, HUB], [0.0, 0.0, HUB + 300.0]]), 1.0)
    edges = wind.velocity(np.array([[0.0, 20.0, HUB], [0.0, 0.0, HUB + 20.0]]), 1.0)
    np.testing.assert_allclose(beyond, edges, atol=1e-6)


def test_held_everywhere_it_has_wind_before_the_box_begins():
    held = field(random_box(periodic=False)).held_everywhere()
    first = held.velocity(np.array([[0.0, 0.0, HUB]]), 0.0)
    np.testing.assert_allclose(held.velocity(np.array([[500.0, 0.0, HUB]]), 0.0), first, atol=1e-6)


def test_held_everywhere_a_place_that_is_no_number_is_still_refused():
    with pytest.raises(InputError, match="not a number"):
        field(random_box()).held_everywhere().velocity(np.array([[0.0, np.nan, HUB]]), 0.0)


def test_without_turbulence_the_mean_remains():
    points = points_in_rotor()
    plain = field(profile=Profile.power_law(HUB, 0.2))
    stirred = field(random_box(), profile=Profile.power_law(HUB, 0.2)).without_turbulence()
    np.testing.assert_array_equal(stirred.velocity(points, 2.0), plain.velocity(points, 2.0))


def test_without_turbulence_a_box_that_holds_the_mean_gives_its_own():
    whole = random_box(holds_mean=True)
    mean = field(whole, profile=Profile.in_box(HUB), speed=0.0).without_turbulence()
    at = np.array([[0.0, 5.0, HUB + 4.0]])
    expected = whole.data.mean(axis=1)[:, 5, 6]
    for time in (0.0, 1.7):
        np.testing.assert_allclose(mean.velocity(at, time)[0], expected, atol=1e-6)
