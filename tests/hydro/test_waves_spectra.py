"""Spectra, the seas that are drawn from them, and their directions."""

import numpy as np
import pytest

from galerna.hydro.waves.irregular import Band, irregular, random_generator
from galerna.hydro.waves.sea import Sea
from galerna.hydro.waves.spectra import (
    default_peak_enhancement,
    jonswap,
    pierson_moskowitz,
    share_left_out,
)
from galerna.hydro.waves.spreading import density, directions, quantile

# Formula and integrals (0.001-2 Hz) as OpenFAST's SeaState has the spectrum (Waves.f90):
# Hs, Tp: gamma of IEC 61400-3, 4 sqrt(m0), Tz / Tp, density at the peak in m2/Hz
PUBLISHED = {
    (6.0, 10.0): (2.872390642918178, 6.003816760052758, 0.7694562628157579, 64.54591824075608),
    (2.44, 8.1): (1.0, 2.43997785846045, 0.7120777884756857, 4.317641613922908),
    (9.14, 13.6): (1.7802393170596726, 9.126755598288467, 0.7403637964079953, 151.1137888879946),
    (12.7, 14.1): (3.319988367122063, 12.715567342928557, 0.7782766952592861, 443.19141823132003),
    (3.66, 9.7): (1.0, 3.6599838507177544, 0.7115611277000693, 11.633645459736723),
}


def of(height=6.0, period=10.0, gamma=None):
    gamma = default_peak_enhancement(height, period) if gamma is None else gamma
    return lambda w: jonswap(w, height, period, gamma)


@pytest.mark.parametrize("sea", PUBLISHED)
def test_jonswap_has_the_published_integrals(sea):
    height, period = sea
    gamma, from_m0, crossing, at_peak = PUBLISHED[sea]
    f = np.linspace(0.001, 2.0, 400_001)
    s = 2.0 * np.pi * jonswap(2.0 * np.pi * f, height, period, gamma)
    m0, m2 = np.trapezoid(s, f), np.trapezoid(s * f**2, f)
    assert default_peak_enhancement(height, period) == pytest.approx(gamma, rel=1e-12)
    assert 4.0 * np.sqrt(m0) == pytest.approx(from_m0, rel=1e-6)
    assert np.sqrt(m0 / m2) / period == pytest.approx(crossing, rel=1e-4)
    peak = 2.0 * np.pi * float(jonswap(2.0 * np.pi / period, height, period, gamma))
    assert peak == pytest.approx(at_peak, rel=1e-9)


def test_iec_peak_enhancement_stays_between_one_and_five():
    assert default_peak_enhancement(9.0, 9.0) == 5.0
    assert default_peak_enhancement(1.0, 10.0) == 1.0


def test_share_left_out_is_that_of_pierson_and_moskowitz():
    peak = 2.0 * np.pi / 10.0
    shares = share_left_out(0.8 * peak, 2.0 * peak, peak)
    bands = np.geomspace(0.1, 0.8 * peak, 20_001), np.geomspace(2.0 * peak, 500.0, 20_001)
    found = [np.trapezoid(pierson_moskowitz(w, 4.0, 10.0), w) for w in bands]
    assert found == pytest.approx(shares, rel=1e-6)
    assert sum(share_left_out(0.5 * peak, 6.0 * peak, peak)) < 1e-3


@pytest.mark.parametrize("gamma", [1.0, 2.872, 5.0])
def test_mean_variance_over_seeds_is_that_of_the_sea(gamma):
    """Within 1 % of Hs^2/16; the mean over 2000 seeds of 1 h is known within 0.2 %."""
    band = Band(0.3, 6.0 * 2.0 * np.pi / 10.0, 3600.0)
    found = []
    for seed in range(2000):
        _, _, a = irregular(of(gamma=gamma), band, amplitudes="white_noise", seed=seed)
        found.append(0.5 * np.sum(np.abs(a) ** 2))
    w = np.linspace(band.lowest, band.highest, 100_001)
    target = np.trapezoid(of(gamma=gamma)(w), w)
    error = np.std(found) / np.sqrt(len(found)) / target
    assert error < 0.002
    assert abs(np.mean(found) / target - 1.0) < 3.0 * error
    assert np.mean(found) == pytest.approx(36.0 / 16.0, rel=0.01)


def test_random_phases_have_the_variance_of_the_spectrum_in_every_sea():
    band = Band(0.3, 4.0, 3600.0)
    w = np.linspace(0.3, 4.0, 100_001)
    for seed in range(5):
        _, _, a = irregular(of(), band, seed=seed)
        assert 0.5 * np.sum(np.abs(a) ** 2) == pytest.approx(np.trapezoid(of()(w), w), rel=1e-3)


def test_white_noise_has_rayleigh_amplitudes():
    """Of one frequency over the seeds: mean square 2 S dw, and median of Rayleigh."""
    band = Band(0.62, 0.64, 3600.0)
    drawn = [irregular(of(), band, amplitudes="white_noise", seed=s) for s in range(400)]
    w, a = drawn[0][0], np.array([sea[2] for sea in drawn])
    scaled = (np.abs(a) ** 2 / (2.0 * of()(w) * 2.0 * np.pi / band.period)).ravel()
    n = scaled.size
    assert scaled.mean() == pytest.approx(1.0, abs=4.0 / np.sqrt(n))
    assert np.mean(scaled < np.log(2.0)) == pytest.approx(0.5, abs=2.0 / np.sqrt(n))


def test_gaussian_sea_is_gaussian_and_crosses_zero_as_its_moments_say():
    density_of = of()
    band = Band(0.3, 6.0 * 2.0 * np.pi / 10.0, 12000.0)
    w, course, a = irregular(density_of, band, amplitudes="white_noise", seed=4)
    elevation = Sea(w, course, a, band.period, 320.0).elevation_at().table[:, 0].astype(float)
    scaled = elevation / elevation.std()
    assert np.mean(scaled**3) == pytest.approx(0.0, abs=0.1)
    assert np.mean(scaled**4) == pytest.approx(3.0, abs=0.2)
    up = np.count_nonzero((elevation[:-1] < 0.0) & (elevation[1:] >= 0.0))
    m0, m2 = np.sum(np.abs(a) ** 2), np.sum(np.abs(a) ** 2 * w**2)
    assert band.period / up == pytest.approx(2.0 * np.pi * np.sqrt(m0 / m2), rel=0.02)


def test_same_seed_same_sea_and_other_seeds_other_seas():
    band = Band(0.3, 3.0, 700.0)
    first, again, other = (irregular(of(), band, seed=seed)[2] for seed in (3, 3, -3))
    spread = irregular(of(), band, seed=3, spreading_exponent=4.0)[2]
    assert np.array_equal(first, again)
    assert np.array_equal(first, spread)
    assert not np.allclose(first, other)


@pytest.mark.parametrize("exponent", [0.7, 4.0, 25.0])
def test_spreading_is_a_distribution_and_its_quantiles_invert_it(exponent):
    angle = np.linspace(-np.pi, np.pi, 200_001)
    d = density(angle, exponent)
    assert np.trapezoid(d, angle) == pytest.approx(1.0, abs=1e-6)
    share = np.array([0.01, 0.2, 0.5, 0.77, 0.999])
    at = quantile(share, exponent)
    below = [np.trapezoid(d[angle <= x], angle[angle <= x]) for x in at]
    assert below == pytest.approx(share, abs=1e-4)


def test_directions_cover_the_distribution_already_in_a_narrow_band():
    main, exponent, n = 0.4, 5.0, 60
    drawn = directions(n, main, exponent, random_generator(1)) - main
    share = np.sort([np.trapezoid(density(np.linspace(-np.pi, x, 4001), exponent),
                                  np.linspace(-np.pi, x, 4001)) for x in drawn])  # fmt: skip
    worst = np.abs(share - (np.arange(n) + 0.5) / n).max()
    assert worst < 2.0 / n  # independent draws would miss by about 0.1


def test_short_crested_sea_has_the_spectrum_of_directions_and_is_the_same_everywhere():
    """Variance by direction, and the coherence of two places against the integral over angles."""
    exponent, band = 3.0, Band(0.4, 3.0, 7200.0)
    w, course, a = irregular(of(), band, spreading_exponent=exponent, seed=2)
    sea = Sea(w, course, a, band.period, 320.0)
    energy = 0.5 * np.abs(a) ** 2
    assert energy @ np.cos(course) / energy.sum() == pytest.approx(
        exponent / (exponent + 1.0), abs=0.01
    )
    places = np.array([[0.0, 0.0], [35.0, 0.0], [0.0, -60.0]])
    found = sea.elevation_at(places).table.astype(float)
    assert found.std(axis=0) ** 2 == pytest.approx([sea.variance] * 3, rel=1e-5)
    angle = np.linspace(-np.pi, np.pi, 721)
    for j, (x, y) in enumerate(places[1:], start=1):
        ahead = np.cos(angle) * x + np.sin(angle) * y
        phase = np.cos(np.outer(sea.wavenumber, ahead))
        expected = energy @ np.trapezoid(phase * density(angle, exponent), angle, axis=1)
        together = np.mean(found[:, 0] * found[:, j])
        assert together == pytest.approx(expected, abs=0.01 * sea.variance)
