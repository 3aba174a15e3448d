"""The block ``sea:`` of a case, and what becomes of it."""

import numpy as np
import pytest
from pydantic import ValidationError

from galerna.errors import InputError
from galerna.hydro.sea_options import SeaOptions
from galerna.hydro.waves import build_sea
from galerna.hydro.waves.limits import require_irregular


def sea_of(waves, duration=600.0, depth=320.0, **other):
    step = other.pop("time_step", None)
    options = SeaOptions(waves=waves, **other)
    return build_sea(options, duration, 1, depth, time_step=step)


def jonswap(height=6.0, period=10.0, **other):
    return {"kind": "jonswap", "significant_height_m": height, "peak_period_s": period, **other}


def regular(height, period):
    return {"kind": "regular", "height_m": height, "period_s": period}


def test_still_water_is_the_default():
    sea = build_sea(SeaOptions(), 100.0, 0, 50.0)
    assert sea.is_still
    assert (sea.depth, sea.density, sea.ramp) == (50.0, 1025.0, 20.0)


def test_regular_waves_have_their_height_and_phase():
    sea = sea_of(regular(6.0, 10.0) | {"direction_deg": 90.0, "phase_deg": 180.0})
    assert sea.frequency == pytest.approx([2.0 * np.pi / 10.0])
    assert sea.amplitude[0] == pytest.approx(-3.0)
    assert sea.direction[0] == pytest.approx(np.pi / 2)


def test_jonswap_sea_has_its_variance_and_does_not_repeat_in_the_run():
    sea = sea_of(jonswap(), duration=3600.0)
    assert sea.variance == pytest.approx(36.0 / 16.0, rel=0.003)
    assert sea.period > 3600.0
    assert "0.096 % of the variance" in sea.notes[0]
    assert sea.frequency[-1] < 6.0 * 2.0 * np.pi / 10.0


def test_seed_of_the_waves_wins_over_that_of_the_case():
    own = sea_of(jonswap(seed=9))
    options = SeaOptions(waves=jonswap())
    assert np.array_equal(own.amplitude, build_sea(options, 600.0, 9, 320.0).amplitude)
    assert not np.allclose(own.amplitude, build_sea(options, 600.0, 1, 320.0).amplitude)


def test_pierson_moskowitz_is_jonswap_without_enhancement():
    waves = jonswap()
    plain = sea_of(waves | {"kind": "pierson_moskowitz"})
    assert np.array_equal(plain.amplitude, sea_of(waves | {"peak_enhancement": 1.0}).amplitude)


def test_given_elevation_and_its_mean(tmp_path):
    t = np.arange(0.0, 201.0)
    lists = {"time_s": tuple(t), "elevation_m": tuple(1.0 + np.cos(0.5 * t))}
    sea = sea_of({"kind": "elevation_series", **lists}, duration=200.0, ramp_s=0.0)
    mean = lists["elevation_m"] - sea.elevation_at().over(t)[:, 0]
    assert np.ptp(mean) < 0.01
    assert "mean of 0.9997 m is left out" in sea.warnings[0]
    assert np.mean(mean) == pytest.approx(0.9997, abs=1e-3)
    rows = [f"{a},{b}" for a, b in zip(*lists.values(), strict=True)]
    (tmp_path / "w.csv").write_text("\n".join(rows))
    options = SeaOptions(waves={"kind": "elevation_series", "path": "w.csv"})
    again = build_sea(options, 200.0, 1, 320.0, folder=tmp_path)
    assert np.allclose(again.amplitude, sea.amplitude)


@pytest.mark.parametrize(
    ("waves", "depth", "message"),
    [
        (regular(15.0, 8.0), 320.0, "99.89 m long: they break above 14.2 m"),
        (regular(8.1, 14.0), 10.0, "break above"),
        (jonswap(7.0, 8.0), 320.0, "significant steepness of 1/14.3; the steepest seas have 1/15"),
        (jonswap(9.0, 20.0), 11.0, "9 m on a depth of 11 m: waves break above 8.58 m"),
        (jonswap(lowest_frequency_hz=0.11), 320.0, "leave out the spectrum's peak at 0.1 Hz"),
    ],
)
def test_waves_that_cannot_exist_are_refused(waves, depth, message):
    with pytest.raises(InputError, match=message):
        sea_of(waves, depth=depth)


def test_seas_steeper_than_those_observed_are_doubted():
    assert require_irregular(9.14, 13.6, 320.0, 9.80665) == ()
    assert "1/20.3" in require_irregular(13.0, 13.0, 320.0, 9.80665)[0]


def test_waves_beyond_the_step_are_refused_and_coarse_steps_doubted():
    with pytest.raises(InputError, match=r"a step of 1 s resolves 3\.142 rad/s at most"):
        sea_of(jonswap(), time_step=1.0)
    assert "12.5 time steps per peak period" in sea_of(jonswap(), time_step=0.8).warnings[0]
    assert sea_of(jonswap(), time_step=0.1).warnings == ()


def test_unknown_depth_is_asked_for():
    with pytest.raises(InputError, match="neither the case nor the turbine"):
        sea_of({"kind": "still"}, depth=0.0)
    assert sea_of({"kind": "still"}, depth=0.0, water_depth_m=70.0).depth == 70.0


def test_current_of_each_profile():
    kinds = [
        ({"profile": "uniform", "speed_m_s": 1.0, "direction_deg": 90.0}, (0.0, 1.0)),
        ({"profile": "power", "speed_m_s": 1.0}, (0.5 ** (1.0 / 7.0), 0.0)),
        ({"profile": "table", "depth_m": (0.0, 320.0), "speed_m_s": (2.0, 1.0)}, (1.5, 0.0)),
    ]
    for current, expected in kinds:
        sea = sea_of({"kind": "still"}, current=current)
        assert sea.current.at([-160.0])[0] == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize(
    "block",
    [
        {"waves": {"kind": "elevation_series"}},
        {"waves": {"kind": "elevation_series", "time_s": (0.0, 1.0)}},
        {"waves": {"kind": "still", "height_m": 1.0}},
        {"waves": jonswap(lowest_frequency_hz=0.2, highest_frequency_hz=0.1)},
        {"current": {"profile": "table", "depth_m": (0.0, 9.0), "speed_m_s": (1.0,)}},
        {"stretching": "wheelr"},
    ],
)
def test_blocks_that_make_no_sense_are_refused(block):
    with pytest.raises(ValidationError):
        SeaOptions(**block)
