"""Kaimal boxes: the embedding against the coherence it stands for, boxes against the standard."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from galerna.errors import InputError
from galerna.inflow.kaimal import embedded_power, kaimal_box
from galerna.inflow.spectra import KAIMAL_DEVIATIONS, kaimal_coherence_decay, kaimal_spectra

USUAL = {"mean_speed": 12.0, "hub_height": 90.0, "seed": 7, "standard_deviation": 1.8}


def box_of(shape=(1024, 8, 8), spacing=(1.2, 8.0, 8.0), **changes):
    return kaimal_box(shape, spacing, **(USUAL | changes))


@settings(max_examples=40, deadline=None)
@given(
    shape=st.tuples(st.integers(2, 20), st.integers(2, 20)),
    spacing=st.tuples(st.floats(3.0, 10.0), st.floats(3.0, 10.0)),
    decay=st.floats(0.004, 5.0),
)
def test_embedding_holds_the_coherence(shape, spacing, decay):
    power = embedded_power(shape, spacing, decay)
    covariance = np.fft.fft2(power).real[: shape[0], : shape[1]]
    y, z = (np.arange(n) * d for n, d in zip(shape, spacing, strict=True))
    expected = np.exp(-decay * np.hypot(y[:, None], z))
    assert np.all(power >= 0.0)
    np.testing.assert_allclose(covariance, expected, atol=1e-3)


def test_spectra_are_those_of_the_standard():
    """Ensemble of points without coherence; bands of n modes scatter by 1/sqrt(points n)."""
    shape, dx = (1024, 8, 8), 1.2
    box = box_of(shape, (dx, 400.0, 400.0))
    modes = np.fft.rfft(box.data, axis=1)[:, 1:-1] / shape[0]
    duration = shape[0] * dx / 12.0
    f = np.arange(1, 512) / duration
    found = 2 * duration * np.mean(np.abs(modes) ** 2, axis=(2, 3)).T
    ratio = found / kaimal_spectra(f, 12.0, 90.0, 1.8)
    for first, last in ((0, 16), (16, 64), (64, 256), (256, 511)):
        scatter = 1 / math.sqrt(64 * (last - first))
        np.testing.assert_allclose(ratio[first:last].mean(axis=0), 1.0, atol=4 * scatter)


def test_coherence_of_u_is_that_of_the_standard_and_v_and_w_have_none():
    shape, dx, step = (4096, 12, 12), 1.2, 6.0
    box = box_of(shape, (dx, step, step))
    modes = np.fft.rfft(box.data, axis=1)[:, 1:-1]
    f = np.arange(1, 2048) * 12.0 / (shape[0] * dx)
    power = np.mean(np.abs(modes) ** 2, axis=(2, 3))
    for lag in (1, 5):
        cross = np.mean(modes[:, :, lag:] * modes[:, :, :-lag].conj(), axis=(2, 3)).real
        expected = np.exp(-kaimal_coherence_decay(f, 12.0, 90.0) * lag * step)
        for first, last in ((30, 120), (120, 500)):
            band = slice(first, last)
            coherence = cross[:, band].sum(axis=1) / power[:, band].sum(axis=1)
            weights = kaimal_spectra(f[band], 12.0, 90.0, 1.0)[:, 0]
            # points of one plane count as two independent ones at least
            scatter = 1 / math.sqrt(2 * (last - first))
            wanted = np.average(expected[band], weights=weights)
            assert coherence[0] == pytest.approx(wanted, abs=3 * scatter)
            assert np.max(np.abs(coherence[1:])) < 3 * scatter


def test_all_components_cohere_where_asked():
    """Mean over 190 modes of the coherence, each with the weight one: scatter below 0.05."""
    box = box_of((4096, 8, 8), coherent="uvw")
    modes = np.fft.rfft(box.data, axis=1)[:, 10:200]
    f = np.arange(10, 200) * 12.0 / (4096 * 1.2)
    power = kaimal_spectra(f, 12.0, 90.0, 1.8).T * (4096**2 * f[0] / 20)
    cross = np.mean((modes[:, :, 1:] * modes[:, :, :-1].conj()).real, axis=(2, 3))
    expected = np.exp(-kaimal_coherence_decay(f, 12.0, 90.0) * 8.0)
    np.testing.assert_allclose(np.mean(cross / power, axis=1), expected.mean(), atol=0.15)
    assert expected.mean() > 0.2


def test_components_are_independent():
    u, v, w = box_of().data.astype(float)
    for a, b in ((u, v), (u, w), (v, w)):
        assert abs(np.mean(a * b)) < 0.1 * a.std() * b.std()


def test_same_seed_same_bits():
    assert box_of().data.tobytes() == box_of().data.tobytes()
    assert box_of().data.tobytes() != box_of(seed=8).data.tobytes()


def test_normalisation_by_the_sample_meets_every_deviation():
    box = box_of(normalise="sample")
    np.testing.assert_allclose(box.data.std(axis=(1, 2, 3)), 1.8 * KAIMAL_DEVIATIONS, rtol=1e-4)


def test_normalisation_by_the_box_raises_the_energy_by_what_is_missing():
    by_box, by_theory = (box_of(normalise=n).data[0].std() for n in ("box", "theory"))
    f = np.arange(1, 512) * 12.0 / (1024 * 1.2)
    held = kaimal_spectra(f, 12.0, 90.0, 1.0)[:, 0].sum() * f[0]
    assert by_theory / by_box == pytest.approx(math.sqrt(held), rel=1e-4)
    assert held < 0.9


def test_turbulence_class_is_the_normal_turbulence_model():
    by_class = box_of(standard_deviation=None, turbulence_class="B")
    by_figure = box_of(standard_deviation=0.14 * (0.75 * 12.0 + 5.6))
    np.testing.assert_allclose(by_class.data, by_figure.data, rtol=1e-6)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"shape": (3, 8, 8)}, "nx even"),
        ({"spacing": (0.0, 8.0, 8.0)}, "dx is 0"),
        ({"hub_height": -1.0}, "hub height is -1"),
        ({"standard_deviation": None}, "expected one of"),
        ({"turbulence_intensity": 0.1}, "turbulence_intensity and standard_deviation"),
        ({"standard_deviation": None, "turbulence_class": "D"}, "turbulence class is 'D'"),
        ({"standard_deviation": 0.0}, "amount of turbulence is 0"),
        ({"coherent": "all"}, "coherent is 'all'"),
        ({"normalise": "none"}, "normalise is 'none'"),
    ],
)
def test_arguments_without_sense_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        box_of(**changes)
