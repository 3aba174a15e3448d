"""From the block of a case to the wind at a rotor."""

import math

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.inflow.bts import write_bts
from galerna.inflow.build import build
from galerna.inflow.hawc2 import write_hawc2
from galerna.inflow.options import InflowOptions
from galerna.inflow.sizing import RotorExtent, mean_deviation, require_room, size_for

ROTOR = RotorExtent(90.0, 63.0, reach=math.hypot(63.0, 8.0), upstream=8.0, margin=6.3)
GRID = {"points": [64, 16, 26], "spacing_m": [12.0, 10.0, 8.0], "below_box": "hold"}
MANN = {"kind": "mann", "turbulence_class": "B", **GRID}
KAIMAL = {"kind": "kaimal", "turbulence_intensity": 0.12, **GRID}


def built(duration=30.0, folder=".", seed=1, **block):
    options = InflowOptions.model_validate(block)
    return build(options, ROTOR, duration, base_folder=folder, seed=seed)


def rotor_points(n=200):
    rng = np.random.default_rng(4)
    r, angle = 63.0 * np.sqrt(rng.random(n)), 2 * np.pi * rng.random(n)
    return np.stack([np.full(n, -5.0), r * np.sin(angle), 90 + r * np.cos(angle)], axis=1)


def test_steady_sheared_yawed_wind():
    wind = built(
        wind_speed_m_s=12, direction_deg=-30, shear={"kind": "power_law", "exponent": 0.14}
    )
    velocity = wind.field.velocity(np.array([[0.0, 0.0, 45.0]]), 0.0)[0]
    assert np.hypot(*velocity[:2]) == pytest.approx(12 * 0.5**0.14)
    assert np.degrees(np.arctan2(velocity[1], velocity[0])) == pytest.approx(-30)
    assert wind.mean_speed == 12.0
    assert "12 m/s" in wind.description[0]


def test_time_series_takes_the_direction_of_the_case_on_top():
    series = {"time_s": [0, 30], "wind_speed_m_s": [8, 12], "direction_deg": [0, 20]}
    wind = built(time_series=series, direction_deg=10, upflow_deg=5)
    middle = wind.field.hub_wind(15.0)
    assert np.degrees([middle.direction, middle.upflow]) == pytest.approx([20, 5])
    assert wind.mean_speed == pytest.approx(10.0)


def test_gust_has_the_size_of_the_standard():
    gust = {"kind": "EOG", "start_s": 10, "turbulence_class": "B"}
    wind = built(wind_speed_m_s=12, gust=gust)
    top = wind.field.hub_velocity(10 + 10.5 / 2)[0]
    assert top == pytest.approx(12 + 0.74 * 3.3 * 2.044 / 1.3)
    turn = built(wind_speed_m_s=12, gust={"kind": "ECD", "start_s": 0, "sign": "negative"})
    assert np.degrees(turn.field.hub_wind(20.0).direction) == pytest.approx(-60)


@pytest.mark.parametrize("turbulence", [MANN, KAIMAL], ids=["mann", "kaimal"])
def test_same_seed_same_wind_other_seed_other_wind(turbulence):
    points = rotor_points()
    first, again, other = (
        built(wind_speed_m_s=12, turbulence=turbulence, seed=seed).field.velocity(points, 7.3)
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 0.1
    own = built(wind_speed_m_s=12, turbulence=turbulence | {"seed": 2}, seed=1)
    np.testing.assert_array_equal(own.field.velocity(points, 7.3), other)


def test_a_shorter_run_meets_the_same_wind():
    rotor = ROTOR.with_margin(0.0)
    short, long = (size_for(rotor, duration, 12.0) for duration in (10.0, 600.0))
    assert short == long


def test_fitting_box_holds_the_rotor_and_the_tower_and_is_not_larger_than_needed():
    size = size_for(ROTOR, 700.0, 12.0, points_across=16)
    box = Box(np.zeros((3, *size.shape), np.float32), size.spacing, 12.0, 90.0)
    box = box.standing_on(size.bottom)
    require_room(box, ROTOR, 700.0, held_below=False)
    assert box.bottom == 0.0
    assert box.width == pytest.approx(2 * ROTOR.half_width)
    assert 0.0 <= box.top - (90.0 + ROTOR.half_width) < size.spacing[2]
    assert 700.0 <= box.length / 12.0 < 1.05 * (700.0 + 2 * ROTOR.half_width / 12.0)


def test_room_of_a_turbine():
    from galerna.turbine import load

    turbine = load("nrel5mw")
    rotor = RotorExtent.of(turbine)
    assert rotor.radius == pytest.approx(turbine.rotor_radius)
    assert rotor.radius < rotor.reach < 1.02 * rotor.radius
    assert rotor.margin == pytest.approx(0.1 * rotor.radius)
    assert rotor.lowest == pytest.approx(turbine.tower.axis[0, 2])


def test_box_too_small_names_every_side():
    small = MANN | {"points": [64, 8, 12], "below_box": "error"}
    with pytest.raises(InputError) as caught:
        built(wind_speed_m_s=12, turbulence=small)
    missing = f"{ROTOR.half_width - 35:.3g} m are missing to the"
    assert f"{missing} left" in str(caught.value)
    assert f"{missing} right" in str(caught.value)
    assert f"{ROTOR.half_width - 44:.3g} m are missing above" in str(caught.value)
    assert "46 m are missing below" in str(caught.value)


def test_box_that_only_ends_above_the_ground_may_be_held_down():
    high = MANN | {"points": [64, 16, 19], "below_box": "error"}
    with pytest.raises(InputError, match=r"18 m are missing below\n.*below_box: hold"):
        built(wind_speed_m_s=12, turbulence=high)
    held = built(wind_speed_m_s=12, turbulence=high | {"below_box": "hold"})
    assert np.isfinite(held.field.velocity(np.array([[0.0, 0.0, 5.0]]), 3.0)).all()


@pytest.fixture
def file(tmp_path):
    """A TurbSim file of 30 s that does not repeat, wide enough, down to the ground."""
    data = np.random.default_rng(8).standard_normal((3, 61, 17, 17)).astype(np.float32)
    data[0] += 11.0
    box = Box(data, (5.5, 10.0, 10.0), 11.0, 90.0, -10.0, periodic=False, holds_mean=True)
    write_bts(tmp_path / "wind.bts", box)
    return tmp_path


def test_file_brings_its_mean_wind(file):
    turbulence = {"kind": "file", "path": "wind.bts"}
    wind = built(duration=20.0, folder=file, turbulence=turbulence, direction_deg=90)
    velocity = wind.field.velocity(rotor_points() * [0, 0, 1], 3.0)
    assert wind.mean_speed == 11.0
    assert velocity[:, 1].mean() == pytest.approx(11.0, abs=1.5)


def test_file_about_the_mean_wind_of_the_case(file):
    turbulence = {"kind": "file", "path": "wind.bts", "mean": "case"}
    wind = built(duration=20.0, folder=file, wind_speed_m_s=20, turbulence=turbulence)
    assert wind.field.box.data[0].mean() == pytest.approx(0.0, abs=1e-5)
    assert wind.field.hub_wind(0.0).speed == 20


def test_file_too_short_says_how_many_seconds_are_missing(file):
    # 60 intervals of 0.5 s, from which half the width (80 m) is taken at the start; the rotor
    # stands 8 m upstream and meets the wind that much earlier.
    missing = 40.0 - (30.0 - (80.0 + 8.0) / 11.0)
    with pytest.raises(InputError, match=f"{missing:.3g} s are missing after its end"):
        built(duration=40.0, folder=file, turbulence={"kind": "file", "path": "wind.bts"})


def test_hawc2_files_scaled_to_an_intensity(tmp_path):
    data = np.random.default_rng(8).standard_normal((3, 16, 17, 21)).astype(np.float32)
    write_hawc2(tmp_path / "box", Box(data, (5.0, 10.0, 10.0), 10.0, 90.0))
    turbulence = {
        "kind": "hawc2",
        "paths": [f"box_{name}.bin" for name in "uvw"],
        "points": [16, 17, 21],
        "spacing_m": [5, 10, 10],
        "turbulence_intensity": 0.15,
    }
    wind = built(folder=tmp_path, wind_speed_m_s=14, turbulence=turbulence)
    assert mean_deviation(wind.field.box) == pytest.approx(0.15 * 14, rel=1e-5)
    assert wind.field.box.bottom == pytest.approx(90 - 100)  # centred on the hub
    lower = built(
        folder=tmp_path, wind_speed_m_s=14, turbulence=turbulence | {"bottom_m": -12.5}
    ).field.box
    assert lower.bottom == pytest.approx(-12.5)


def test_uniform_file_brings_its_exponent(tmp_path):
    (tmp_path / "gust.wnd").write_text("0 8 10 0 0 0.2 0 0\n")
    file = {"path": "gust.wnd"}
    wind = built(folder=tmp_path, time_series_file=file)
    low = wind.field.velocity(np.array([[0.0, 0.0, 45.0]]), 0.0)[0]
    assert np.hypot(*low[:2]) == pytest.approx(8 * 0.5**0.2)
    assert np.degrees(np.arctan2(low[1], low[0])) == pytest.approx(-10)
    with pytest.raises(InputError, match="shear too"):
        built(folder=tmp_path, time_series_file=file, shear={"kind": "linear", "gradient_per_m": 0})


def test_still_air_has_no_turbulence_and_no_gust():
    with pytest.raises(InputError, match="mean wind speed is 0"):
        built(wind_speed_m_s=0, turbulence={"kind": "mann", "turbulence_class": "A"})
    with pytest.raises(InputError, match="above 0"):
        built(wind_speed_m_s=0, gust={"kind": "ECD", "start_s": 0})
