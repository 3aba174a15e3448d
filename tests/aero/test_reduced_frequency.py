"""Reduced frequencies: the definition, its shape and the split of a spectrum."""

import numpy as np
import pytest

from galerna.aero.reduced_frequency import (
    blade_passing_frequencies,
    energy_fractions,
    peak_frequency,
    reduced_frequency,
)
from galerna.errors import InputError


def test_the_definition_and_its_shape():
    frequency = blade_passing_frequencies(0.945)
    k = reduced_frequency(frequency, [40.0, 80.0], [5.0, 3.0], 10.5, 0.945)
    assert k.shape == (2, 2)
    assert k[0, 0] == pytest.approx(0.945 * 5.0 / (2 * np.hypot(10.5, 0.945 * 40.0)))
    np.testing.assert_allclose(k[1], 3.0 * k[0])


def test_a_spectrum_is_split_at_the_limits():
    frequency = np.linspace(0.0, 10.0, 10001)
    share = energy_fractions(
        frequency, np.where(frequency <= 1.0, 1.0, 0.0), [10.0], [2.0], 0.0, 1.0
    )
    per_hertz = 2 * np.pi * 2.0 / 20.0
    np.testing.assert_allclose(
        share[0], [0.05 / per_hertz, 0.6 / per_hertz - 0.05 / per_hertz, 0.045], atol=1e-3
    )
    assert share.sum() == pytest.approx(1.0)


def test_peak_of_the_energy_per_octave():
    frequency = np.geomspace(1e-3, 10.0, 2000)
    density = 1.0 / (1.0 + 1.5 * frequency / 0.05) ** (5.0 / 3.0)
    assert peak_frequency(frequency, density) == pytest.approx(0.05, rel=0.01)


def test_nothing_moving_is_refused():
    with pytest.raises(InputError):
        reduced_frequency(1.0, [0.0], [1.0], 0.0, 1.0)
    with pytest.raises(InputError):
        peak_frequency([1.0, 2.0], [0.0, 0.0])
