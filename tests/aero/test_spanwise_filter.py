"""The spanwise filter on a finite tapered blade: constants, waves, ends and grids."""

import numpy as np
import pytest

from galerna.aero.bem.spanwise_filter import filter_matrix, filter_response, keep_total
from galerna.errors import InputError

LENGTH = 60.0


def blade(stations=241):
    span = np.linspace(0.0, LENGTH, stations)
    return span, 4.5 - 3.0 * span / LENGTH


def test_response_matches_the_published_reductions():
    # Dissertation 4.1.3: about 40 % less at 10 chords, about 90 % less at one chord.
    assert filter_response(1.0, 0.1) == pytest.approx(0.6, abs=0.03)
    assert filter_response(1.0, 1.0) == pytest.approx(0.1, abs=0.01)
    assert filter_response(3.0, 0.0) == 1.0


def test_a_constant_load_is_unchanged():
    span, chord = blade()
    np.testing.assert_allclose(filter_matrix(span, chord) @ np.ones(len(span)), 1.0, atol=1e-12)


@pytest.mark.parametrize("wavelength", [15.0, 6.0, 3.0])
@pytest.mark.parametrize("phase", [0.0, 1.0, 2.5])
def test_a_single_wavelength_is_damped_by_its_response(wavelength, phase):
    span, chord = blade(481)
    wave = np.exp(1j * (2 * np.pi * span / wavelength + phase))
    filtered = filter_matrix(span, chord) @ wave.real
    expected = filter_response(chord, 1.0 / wavelength) * wave.real
    inner = np.abs(span - LENGTH / 2) < LENGTH / 4
    assert np.abs(filtered - expected)[inner].max() < 0.02


def test_a_standing_wave_between_the_ends_is_an_exact_mode():
    span, chord = blade(961)
    wave = np.cos(np.pi * 7 * span / LENGTH)
    filtered = filter_matrix(span, chord) @ wave
    expected = filter_response(chord, 7 / (2 * LENGTH)) * wave
    np.testing.assert_allclose(filtered, expected, atol=3e-4)


def test_nothing_wraps_from_tip_to_root():
    span, chord = blade()
    load = np.exp(-(((span - LENGTH) / 4.0) ** 2))  # all of it at the tip
    filtered = filter_matrix(span, chord) @ load
    assert filtered[0] < 0.02 * filtered[-1]
    # With one chord throughout it only decays towards the root: no rise at the far end.
    filtered = filter_matrix(span, np.full_like(span, 3.0)) @ load
    assert np.all(np.diff(filtered) > 0.0)


def test_two_uniform_grids_and_two_station_sets_agree():
    span, chord = blade(121)
    load = 1.0 + 0.3 * np.sin(2 * np.pi * span / 13.0) + 0.2 * np.cos(2 * np.pi * span / 30.0)
    coarse = filter_matrix(span, chord, grid_points=1024) @ load
    fine = filter_matrix(span, chord, grid_points=4096) @ load
    np.testing.assert_allclose(coarse, fine, atol=1e-3)
    uneven = LENGTH * (1.0 - np.cos(np.linspace(0.0, np.pi, 181))) / 2.0
    same = 1.0 + 0.3 * np.sin(2 * np.pi * uneven / 13.0) + 0.2 * np.cos(2 * np.pi * uneven / 30.0)
    other = filter_matrix(uneven, 4.5 - 3.0 * uneven / LENGTH) @ same
    np.testing.assert_allclose(np.interp(span, uneven, other), coarse, atol=4e-3)


def test_constant_chord_keeps_the_total_and_taper_nearly():
    span, chord = blade(481)
    load = np.sqrt(np.clip(1.0 - (span / LENGTH) ** 8, 0.0, 1.0)) * (1 + 0.2 * np.sin(span))
    weight = np.full(len(span), span[1])
    weight[[0, -1]] /= 2.0
    even = filter_matrix(span, np.full_like(span, 3.0)) @ load
    assert weight @ even == pytest.approx(weight @ load, rel=2e-5)
    tapered = filter_matrix(span, chord)
    assert weight @ (tapered @ load) == pytest.approx(weight @ load, rel=0.01)
    assert weight @ keep_total(tapered, weight, load) == pytest.approx(weight @ load, rel=1e-12)


def test_shorter_waves_are_damped_more_and_longer_chords_damp_more():
    response = filter_response(np.array([[1.0], [3.0]]), np.linspace(0.01, 1.0, 50))
    assert np.all(np.diff(response, axis=1) < 0.0)
    assert np.all(response[1] < response[0])


@pytest.mark.parametrize(
    ("span", "chord", "ends"),
    [
        ([0.0, 2.0, 1.0], [1.0, 1.0, 1.0], None),
        ([0.0, 1.0, 2.0], [1.0, 0.0, 1.0], None),
        ([0.0, 1.0, 2.0], [1.0, 1.0], None),
        ([0.0, 1.0, np.nan], [1.0, 1.0, 1.0], None),
        ([0.0, 1.0, 2.0], [1.0, 1.0, 1.0], (0.5, 2.0)),
    ],
)
def test_unusable_stations_are_refused(span, chord, ends):
    with pytest.raises(InputError):
        filter_matrix(span, chord, ends)
