"""What the machine's validation stands on: means over turns, the wind of the reference, peaks."""

import numpy as np
import pytest
import xarray

from galerna.inflow.bts import read_bts
from validation.machine import openfast_land, over_whole_turns, write_wind_of_openfast
from validation.machine_base_motion import FREQUENCY, ROTATION, has_peak, largest_peak


def test_a_part_of_a_turn_does_not_move_the_mean():
    azimuth = np.linspace(0.0, 2.3 * 2.0 * np.pi, 400)
    mean, periodic = over_whole_turns(500.0 + 2500.0 * np.sin(azimuth + 0.3), azimuth)
    assert mean == pytest.approx(500.0)
    assert periodic == pytest.approx(2500.0 / np.sqrt(2.0))


def test_the_reference_wind_is_that_of_its_class(tmp_path):
    box = read_bts(write_wind_of_openfast(tmp_path))
    _, deviation, _ = openfast_land("ed", "turbulent")["Wind1VelX"]
    at_hub = box.data[0, 240:800, 13:15, 13:15].mean(axis=(1, 2))  # from 60 to 200 s
    assert at_hub.std() == pytest.approx(deviation, rel=0.02)
    assert box.y[0] == pytest.approx(-box.y[-1])


def test_small_peaks_beside_a_large_one_are_told_from_its_flanks():
    time = np.arange(1, 1177) * 0.1
    swing = 0.3 * np.sin(2.0 * np.pi * ROTATION * time)
    noise = 1e-3 * np.random.default_rng(1).standard_normal(len(time))
    sidebands = sum(
        0.03 * np.sin(2.0 * np.pi * (ROTATION + side) * time) for side in (-FREQUENCY, FREQUENCY)
    )

    def series(values):
        return xarray.DataArray(values, coords={"time": time})

    with_both, alone = series(swing + sidebands + noise), series(swing + noise)
    assert largest_peak(with_both) == pytest.approx(ROTATION, abs=0.01)
    for side in (-FREQUENCY, FREQUENCY):
        assert has_peak(with_both, ROTATION + side)
        assert not has_peak(alone, ROTATION + side)
