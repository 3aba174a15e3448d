"""Series over time against the sum of the waves; measured elevations; the current."""

import time

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.waves import Current, Sea, WaveProbe
from galerna.hydro.waves.irregular import Band, irregular
from galerna.hydro.waves.measured import from_elevation, read_elevation
from galerna.hydro.waves.spectra import jonswap


def sea_of(period=700.0, highest=3.77, ramp=0.0, **spread):
    band = Band(0.3, highest, period)
    w, course, a = irregular(lambda w: jonswap(w, 6.0, 10.0, 2.9), band, seed=5, **spread)
    return Sea(w, course, a, period, 320.0, ramp=ramp)


def summed(sea, transfer, times):
    spectrum = sea.amplitude[:, None] * transfer
    return np.stack(
        [(spectrum * np.exp(1j * sea.frequency * t)[:, None]).sum(0) for t in times]
    ).real


def test_series_is_the_sum_of_the_waves():
    sea = sea_of()
    transfer = np.stack([np.ones_like(sea.frequency), 1j * sea.frequency, 3.0 / sea.frequency], 1)
    series = sea.series(transfer)
    times = np.random.default_rng(1).uniform(-100.0, 1500.0, 2000)
    direct = summed(sea, transfer, times)
    error = np.std(series.over(times) - direct, axis=0) / np.std(direct, axis=0)
    assert error.max() < 3e-4


def test_interpolation_error_falls_with_the_fourth_power_of_the_step():
    sea = sea_of()
    transfer = np.ones((len(sea.frequency), 1))
    times = np.random.default_rng(1).uniform(0.0, 700.0, 2000)
    direct = summed(sea, transfer, times)
    n = 4000
    coarse, fine = (np.std(sea.tabulated(transfer, m).over(times) - direct) for m in (n, 2 * n))
    assert coarse / fine == pytest.approx(16.0, rel=0.1)


def test_ramp_starts_and_ends_smoothly():
    full, grown = sea_of().elevation_at(), sea_of(ramp=30.0).elevation_at()
    assert grown.at(0.0)[0] == 0.0
    assert grown.at(15.0) == pytest.approx(0.5 * full.at(15.0), rel=1e-12)
    assert grown.at(30.0)[0] == full.at(30.0)[0]
    assert abs(grown.at(0.3)[0]) < 1e-4
    assert abs(grown.at(29.7)[0] - full.at(29.7)[0]) < 1e-4


def test_regular_wave_travels_with_its_direction():
    sea = Sea.regular(4.0, 8.0, 50.0, direction=0.6, phase=0.3)
    k = float(sea.wavenumber[0])
    series = sea.elevation_at([[20.0, -7.0]])
    for t in (0.0, 3.3, 1234.5):
        ahead = 20.0 * np.cos(0.6) - 7.0 * np.sin(0.6)
        expected = 2.0 * np.cos(2.0 * np.pi / 8.0 * t - k * ahead + 0.3)
        assert series.at(t)[0] == pytest.approx(expected, abs=1e-3)


def test_still_water_is_still():
    sea = Sea.still(100.0)
    assert sea.is_still
    assert sea.variance == 0.0
    assert sea.elevation_at().at(12.3)[0] == 0.0


def test_a_step_costs_the_same_for_ten_thousand_frequencies():
    few, many = sea_of(), sea_of(3600.0, 2.0 * np.pi * 1e4 / 3600.0)
    assert len(many.frequency) > 9_500
    transfer = [np.ones((len(sea.frequency), 7)) for sea in (few, many)]
    series = [few.series(transfer[0]), many.series(transfer[1])]
    assert series[1].table.nbytes < 2e6

    def cost(one):
        one.at(1.0)
        best = np.inf
        for _ in range(30):
            start = time.perf_counter()
            for i in range(200):
                one.at(10.0 + 0.02 * i)
            best = min(best, time.perf_counter() - start)
        return best

    assert cost(series[1]) < 1.5 * cost(series[0])


def test_waves_off_the_grid_are_refused():
    with pytest.raises(InputError, match=r"multiples of 0\.0628319 rad/s"):
        Sea(np.array([0.5]), np.zeros(1), np.ones(1, complex), 100.0, 50.0)


def test_probe_shows_the_elevation_above_the_platform():
    sea = sea_of()
    probe = WaveProbe(sea)
    assert [c.openfast for c in probe.channels] == ["Wave1Elev"]
    assert probe.record(33.3)["wave_elevation"] == sea.elevation_at().at(33.3)[0]


def test_given_elevation_comes_back_at_its_own_times(tmp_path):
    times = np.arange(-4.0, 400.0, 0.5)
    rng = np.random.default_rng(2)
    given = 1.5 + np.cos(0.61 * times) + 0.3 * np.sin(1.3 * times + 1.0)
    given += 0.02 * rng.normal(size=times.size)
    path = tmp_path / "waves.csv"
    rows = [f"{t}, {eta}" for t, eta in zip(times, given, strict=True)]
    path.write_text("time s, elevation m\n" + "\n".join(rows) + "\n")
    w, a, period, mean = from_elevation(*read_elevation(path), duration=395.0)
    sea = Sea(w, np.zeros(len(w)), a, period, 320.0)
    direct = summed(sea, np.ones((len(w), 1)), times)[:, 0]
    assert mean == pytest.approx(given.mean(), rel=1e-12)
    assert direct == pytest.approx(given - mean, abs=1e-9)
    assert sea.elevation_at().at(100.0)[0] == pytest.approx(direct[208], abs=2e-3)


@pytest.mark.parametrize(
    ("times", "duration", "message"),
    [
        ([0.0, 1.0, 2.0, 3.5, 4.0], 4.0, "even steps"),
        ([0.0, 1.0, 2.0, 3.0, 4.0], 5.0, "from 0 to 4 s, the run is from 0 to 5 s"),
        ([1.0, 2.0, 3.0, 4.0, 5.0], 4.0, "from 1 to 5 s"),
        ([0.0, 1.0], 1.0, "4 at least"),
    ],
)
def test_elevations_that_cannot_be_used_are_refused(times, duration, message):
    with pytest.raises(InputError, match=message):
        from_elevation(times, np.zeros(len(times)), duration=duration)


def test_files_that_hold_something_else_are_refused(tmp_path):
    path = tmp_path / "waves.csv"
    path.write_text("0 1\n1 2\n2 x\n")
    with pytest.raises(InputError, match=r"line 3.*found '2 x'"):
        read_elevation(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_elevation(tmp_path / "none.csv")


def test_current_over_the_depth():
    power = Current.power_law(1.4, np.pi / 2, 50.0)
    assert power.at([0.0, 3.0]) == pytest.approx(np.array([[0.0, 1.4]] * 2), abs=1e-12)
    assert power.at([-25.0, -40.0])[:, 1] == pytest.approx(
        [1.4 * 0.5 ** (1 / 7), 1.4 * 0.2 ** (1 / 7)], rel=1e-4
    )
    table = Current.table([0.0, 10.0, 30.0], [1.0, 0.5, 0.1], [0.0, 0.0, np.pi])
    assert table.at([-5.0, -20.0, -99.0])[:, 0] == pytest.approx([0.75, 0.2, -0.1])
    assert Current.uniform(2.0, 0.0).at([-7.0])[0] == pytest.approx([2.0, 0.0])
    with pytest.raises(InputError, match="finite water depth"):
        Current.power_law(1.0, 0.0, np.inf)
    with pytest.raises(InputError, match="must rise"):
        Current.table([0.0, 10.0, 5.0], [1.0, 0.5, 0.1], 0.0)
