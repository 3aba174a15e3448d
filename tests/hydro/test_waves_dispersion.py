"""How long and fast waves are: limits, rounding, group velocity."""

import numpy as np
import pytest

from galerna.hydro.waves.dispersion import group_velocity, wavelength, wavenumber

G = 9.80665


@pytest.mark.parametrize("depth", [0.3, 20.0, 320.0, 5000.0])
def test_solves_the_dispersion_relation_to_rounding(depth):
    w = np.geomspace(1e-4, 60.0, 4000)
    k = wavenumber(w, depth, G)
    assert np.abs(G * k * np.tanh(k * depth) / w**2 - 1.0).max() < 2e-15


def test_goes_to_the_deep_and_shallow_limits():
    assert wavenumber(3.0, 1000.0, G) == pytest.approx(9.0 / G, rel=1e-15)
    assert wavenumber(3.0, np.inf, G) == pytest.approx(9.0 / G, rel=1e-15)
    w, h = 1e-3, 10.0
    assert wavenumber(w, h, G) == pytest.approx(w / np.sqrt(G * h), rel=w**2 * h / G)
    assert wavenumber(0.0, h, G) == 0.0


def test_group_velocity_is_the_slope_of_frequency():
    h, k = 30.0, np.geomspace(1e-3, 2.0, 50)

    def frequency(k):
        return np.sqrt(G * k * np.tanh(k * h))

    slope = (frequency(k * (1 + 1e-5)) - frequency(k * (1 - 1e-5))) / (2e-5 * k)
    assert group_velocity(frequency(k), h, G) == pytest.approx(slope, rel=1e-8)


def test_length_of_a_ten_second_wave_in_deep_water():
    assert wavelength(10.0, 320.0, G) == pytest.approx(G * 100.0 / (2.0 * np.pi), rel=1e-10)
