"""Mann boxes: their modes against theory without chance, and single boxes against their seed."""

import math

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.inflow import mann
from galerna.inflow.mann import alpha_epsilon_isotropic, mann_box
from galerna.inflow.mann_modes import LateralModes
from galerna.inflow.spectra import mann_coherence, mann_spectra, mann_variances

LENGTH, GAMMA = 29.4, 3.9
SPACING = (1.5381, 4.6875, 4.6875)
K1_WIDTH = 2 * math.pi / (8192 * SPACING[0]) * LENGTH  # of the dissertation's table 5.4, times L
USUAL = {
    "length_scale": LENGTH,
    "shear_parameter": GAMMA,
    "mean_speed": 18.0,
    "hub_height": 90.0,
    "seed": 7,
}


def box_of(shape=(256, 8, 8), **changes):
    return mann_box(shape, SPACING, **(USUAL | {"alpha_epsilon": 0.33} | changes))


def modes_of(count, shear_parameter=GAMMA, point_values=True):
    period = count * SPACING[1] / LENGTH
    spacing = tuple(d / LENGTH for d in SPACING)
    return LateralModes((count, count), (period, period), spacing, shear_parameter, point_values)


def held_variance(planes, length):
    """Variance of u that the modes 1..planes/2-1 of a box stand for, over their full width."""
    width = 2 * math.pi / length
    k1 = np.geomspace(0.5, planes / 2 - 0.5, 200) * width
    return 2 * np.trapezoid(k1 * mann_spectra(k1, LENGTH, GAMMA)[:, 0], np.log(k1))


def powers(factors):
    """Power of u, v, w and the covariance of u and w in each mode."""
    uu, vu, wu, vv, wv, ww = factors.astype(float)
    return np.array([uu**2, vu**2 + vv**2, wu**2 + wv**2 + ww**2, uu * wu])


@pytest.mark.parametrize("shear_parameter", [0.0, GAMMA])
@pytest.mark.parametrize("count", [8, 32])
@pytest.mark.parametrize("plane", [20, 300, 3000])
def test_modes_of_a_plane_hold_the_spectra_at_a_point(shear_parameter, count, plane):
    """However narrow the box and however coarse its lateral grid."""
    k1 = plane * K1_WIDTH
    held = powers(modes_of(count, shear_parameter).factors(k1, K1_WIDTH)).sum(axis=(1, 2))
    expected = mann_spectra([k1], 1.0, shear_parameter)[0]
    np.testing.assert_allclose(held, expected, rtol=1e-3, atol=1e-5 * expected[0])


def test_first_plane_holds_the_mean_over_its_width():
    k1 = np.linspace(0.5, 1.5, 41) * K1_WIDTH
    spectra = mann_spectra(k1, 1.0, GAMMA)
    mean = 0.5 * (spectra[1:] + spectra[:-1]).mean(axis=0)
    held = powers(modes_of(32).factors(K1_WIDTH, K1_WIDTH)).sum(axis=(1, 2))
    np.testing.assert_allclose(held, mean, rtol=2e-3)


@pytest.mark.parametrize(("steps_y", "steps_z"), [(1, 0), (0, 1), (6, 0), (0, 6), (8, 8)])
def test_modes_hold_the_coherence(steps_y, steps_z):
    """But for what the cells of the modes lose; its phase is that of planes as they arrive."""
    count = 64
    kept = np.sinc(steps_y / count) * np.sinc(steps_z / count)
    for plane in (20, 80, 300):
        k1 = plane * K1_WIDTH
        covariance = np.fft.ifft2(powers(modes_of(count).factors(k1, K1_WIDTH))[:3]) * count**2
        coherence = covariance[:, steps_y, steps_z] / covariance[:, 0, 0].real
        expected = mann_coherence(
            [k1 / LENGTH], steps_y * SPACING[1], steps_z * SPACING[2], LENGTH, GAMMA
        )[0]
        np.testing.assert_allclose(coherence.conj(), expected, atol=1.0 - kept + 0.01)


def test_interpolation_between_nodes_keeps_the_spectra():
    spectrum, variance = mann._half_spectrum((512, 4, 4), modes_of(8), np.random.default_rng(1))
    expected = held_variance(512, 512 * SPACING[0]) / LENGTH ** (2 / 3)
    assert variance == pytest.approx(expected, rel=3e-3)
    assert spectrum.any()
    assert not spectrum[:, 0].any()


def test_same_seed_same_bits_whatever_the_batch(monkeypatch):
    first = box_of()
    monkeypatch.setattr(mann, "_MODES_AT_ONCE", 1)
    second = box_of()
    assert first.data.tobytes() == second.data.tobytes()
    assert first.data.dtype == np.float32


def test_other_seeds_make_other_boxes():
    boxes = [box_of(seed=seed).data for seed in (7, 8, -7)]
    for a, b in ((0, 1), (0, 2), (1, 2)):
        correlation = np.corrcoef(boxes[a].ravel(), boxes[b].ravel())[0, 1]
        assert abs(correlation) < 0.2


def test_energy_scales_with_alpha_epsilon():
    np.testing.assert_allclose(box_of(alpha_epsilon=4.0).data, 2 * box_of(alpha_epsilon=1.0).data)


def test_the_mean_over_x_is_zero():
    box = box_of()
    assert np.max(np.abs(box.data.mean(axis=1))) < 1e-5 * box.data.std()


def test_normalisation_by_theory_is_alpha_epsilon():
    alpha_epsilon = 1.5**2 / mann_variances(LENGTH, GAMMA)[0]
    by_theory = box_of(alpha_epsilon=None, standard_deviation=1.5)
    np.testing.assert_allclose(by_theory.data, box_of(alpha_epsilon=alpha_epsilon).data, rtol=1e-5)


def test_normalisation_by_the_sample_meets_the_intensity():
    box = box_of(alpha_epsilon=None, turbulence_intensity=0.11, normalise="sample")
    assert math.sqrt(np.mean(np.square(box.data[0], dtype=float))) == pytest.approx(
        0.11 * 18, rel=1e-5
    )


def test_normalisation_by_the_box_makes_up_for_what_it_cannot_hold():
    by_box, by_theory = (
        box_of(alpha_epsilon=None, standard_deviation=1.0, normalise=n).data.std()
        for n in ("box", "theory")
    )
    # 256 planes of 1.54 m hold little of the long waves: the share is known beforehand
    share = held_variance(256, 256 * SPACING[0]) / mann_variances(LENGTH, GAMMA)[0]
    assert share < 0.9
    assert by_theory / by_box == pytest.approx(math.sqrt(share), rel=3e-3)


def test_a_box_of_many_eddies_has_the_deviation_it_was_asked_for():
    """Eddies of 5 m, so that 2048 x 8 x 8 points hold thousands: the variance scatters by 1 %."""
    figures = {"alpha_epsilon": None, "standard_deviation": 1.5, "normalise": "box"}
    box = box_of((2048, 8, 8), length_scale=5.0, shear_parameter=0.0, **figures)
    np.testing.assert_allclose(box.data.std(axis=(1, 2, 3)), 1.5, rtol=0.03)


def test_opposite_sides_are_alike_only_with_a_lateral_period_of_one():
    def likeness(box):
        u = box.data[0]
        return np.corrcoef(u[:, 0].ravel(), u[:, -1].ravel())[0, 1]

    shape = (1024, 32, 4)  # 150 m wide: five length scales apart, and one step apart by period
    assert likeness(box_of(shape, lateral_period=1.0)) > 0.6
    assert likeness(box_of(shape)) < 0.4


def test_upper_wind_arrives_first():
    box = box_of((2048, 4, 16))
    low, high = (np.fft.rfft(box.data[0, :, :, k], axis=0) for k in (4, 12))
    lags = np.fft.irfft((low * high.conj()).sum(axis=1))  # mean of high(i) low(i + lag)
    lag = np.argmax(lags)
    assert 0 < lag < 40


def test_means_over_cells_have_less_energy_than_points():
    points = box_of((1024, 8, 8)).data
    cells = box_of((1024, 8, 8), high_frequency_compensation=False).data
    x = np.fft.fftfreq(1024) * 2  # in Nyquist's wavenumber
    fine = np.abs(x) > 0.75
    energy = [np.mean(np.abs(np.fft.fft(d, axis=1)[:, fine]) ** 2) for d in (points, cells)]
    assert energy[1] < 0.45 * energy[0]  # sinc^2(0.75/2) is 0.7 for x alone
    assert cells.std() < points.std()


def test_without_shear_no_direction_is_preferred():
    box = box_of((2048, 16, 16), shear_parameter=0.0)
    u, _, w = box.data.astype(float)
    deviation = box.data.std(axis=(1, 2, 3))
    assert np.ptp(deviation) / deviation.mean() < 0.15
    assert abs(np.mean(u * w)) < 0.1 * deviation.prod() ** (2 / 3)


def test_isotropic_alpha_epsilon_is_that_of_the_dissertation():
    """Its eq. 4.12 and table 4.2: I = 0.16 at 10.5 m/s and L = 29.4 m give 0.431."""
    assert alpha_epsilon_isotropic(0.16 * 10.5, 29.4) == pytest.approx(0.431, rel=2e-3)


@pytest.mark.parametrize("length_scale", [0.5, 2000.0])
@pytest.mark.parametrize("shear_parameter", [0.0, 8.0])
@pytest.mark.parametrize("lateral_period", [1.0, 2.0])
def test_extremes_give_the_energy_expected_of_them(length_scale, shear_parameter, lateral_period):
    box = box_of(
        (64, 2, 3),
        alpha_epsilon=None,
        standard_deviation=1.0,
        normalise="box",
        length_scale=length_scale,
        shear_parameter=shear_parameter,
        lateral_period=lateral_period,
    )
    assert 0.2 < box.data[0].std() < 3.0  # one short sample


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"shape": (255, 8, 8)}, "nx even"),
        ({"shape": (256, 1, 8)}, "at least 2"),
        ({"shape": (1 << 20, 1 << 10, 1 << 10)}, "expected at most"),
        ({"length_scale": 0.0}, "length scale is 0"),
        ({"mean_speed": math.nan}, "mean speed is nan"),
        ({"shear_parameter": -1.0}, "shear parameter is -1"),
        ({"alpha_epsilon": None}, "expected one of"),
        ({"standard_deviation": 1.0}, "found alpha_epsilon and standard_deviation"),
        ({"alpha_epsilon": -1.0}, "alpha epsilon is -1"),
        ({"normalise": "sampel"}, "did you mean 'sample'"),
        ({"lateral_period": 0.5}, "lateral period is 0.5"),
    ],
)
def test_arguments_without_sense_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        box_of(**changes)
