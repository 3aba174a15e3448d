"""The analytical references of the wings, each against another evaluation of the same theory."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0, j1

from galerna.contract import Array
from validation.finite_wing import lifting_line, oblique_elliptic_lift, wave_loading
from validation.thin_airfoil import (
    gust_lift,
    kuessner,
    pitch_lift,
    plunge_lift,
    sears,
    theodorsen,
    wagner,
)


def sine_transform(real_part, s: float) -> float:  # type: ignore[no-untyped-def]
    """Step response at ``s`` from the real part of a frequency response."""
    integral = quad(lambda k: real_part(k) / k, 1e-12, np.inf, weight="sin", wvar=s, limlst=500)
    return 2 / np.pi * integral[0]


@pytest.mark.filterwarnings("ignore::scipy.integrate.IntegrationWarning")
@pytest.mark.parametrize("s", [0.5, 2.0, 10.0])
def test_step_responses_are_the_transforms_of_the_frequency_responses(s: float) -> None:
    half = sine_transform(lambda k: theodorsen(k).real - 0.5, s)
    assert wagner(s) == pytest.approx(0.5 + half, abs=1e-6)
    assert kuessner(s) == pytest.approx(sine_transform(lambda k: sears(k).real, s), abs=1e-8)


def test_step_responses_begin_and_end_as_they_must() -> None:
    assert wagner([-1.0, 0.0]) == pytest.approx([0.0, 0.5], abs=1e-9)
    assert kuessner([-1.0, 0.0]) == pytest.approx([0.0, 0.0], abs=2e-3)
    early = 1e-3  # a gust's front: psi ~ sqrt(2 s)/pi, from the transform at large p
    assert kuessner(early) == pytest.approx(np.sqrt(2 * early) / np.pi, rel=0.02)
    late = 1e4  # the starting vortex: 1 - 1/s
    assert s_times_lack(wagner, late) == pytest.approx(1.0, rel=2e-3)
    assert s_times_lack(kuessner, late) == pytest.approx(1.0, rel=2e-3)


def s_times_lack(response, s: float) -> float:  # type: ignore[no-untyped-def]
    return float(s * (1.0 - response(s)))


def test_wagner_follows_garricks_approximation() -> None:
    s = np.linspace(0.0, 40.0, 200)
    assert np.abs(wagner(s) - (s + 2) / (s + 4)).max() < 0.021  # his own figure: within 2 %


def test_sears_is_theodorsen_with_the_gusts_own_pattern() -> None:
    k = np.array([0.1, 1.0, 3.0])
    pattern = theodorsen(k) * (j0(k) - 1j * j1(k)) + 1j * j1(k)
    np.testing.assert_allclose(sears(k), np.exp(-1j * k) * pattern, rtol=1e-12)


def test_a_convolved_sine_ends_as_searss_lift() -> None:
    k, s = 0.4, np.arange(0.0, 400.0, 0.05)
    lift = gust_lift(s, np.sin(k * s))
    expected = 2 * np.pi * np.imag(sears(k) * np.exp(1j * k * s))
    assert np.abs(lift - expected)[s > 300.0].max() < 0.02  # transient ~ 1/s, sampling ~ step


def test_a_convolved_step_is_kuessners_lift() -> None:
    s = np.concatenate([[-1e-9], np.linspace(0.0, 20.0, 41)])
    lift = gust_lift(s, np.where(s < 0.0, 0.0, 1.0))
    np.testing.assert_allclose(lift[1:], 2 * np.pi * kuessner(s[1:]), atol=1e-3)


def test_pitch_about_an_axis_far_ahead_is_plunge() -> None:
    k, far = 0.3, -1e6
    arm = -1j * k * far  # downward velocity of the section per angle: here s is the time
    assert pitch_lift(k, far) / arm == pytest.approx(plunge_lift(k), rel=1e-5)


def ellipse(y: Array) -> Array:
    return np.sqrt(1.0 - y**2)


def test_an_elliptic_wing_has_prandtls_lift_everywhere() -> None:
    aspect_ratio = 4.0 * 5.0 / np.pi
    angle = np.radians(5.7106)
    y = np.linspace(-0.95, 0.95, 9)
    lift = lifting_line(y, lambda y: 0.4 * ellipse(y), lambda y: np.full_like(y, angle), 20, 60)
    np.testing.assert_allclose(lift, 2 * np.pi * angle / (1 + 2 / aspect_ratio), rtol=1e-9)


def test_a_sine_on_a_slender_wing_is_damped_by_its_own_downwash() -> None:
    y = np.linspace(-0.3, 0.3, 201)
    chord, wavelength = 0.01, 0.1  # of half the span
    wave = np.sin(2 * np.pi * y / wavelength)
    lift = lifting_line(
        y, lambda y: np.full_like(y, chord), lambda y: np.sin(2 * np.pi * y / wavelength)
    )
    expected = 2 * np.pi * wave / (1 + np.pi**2 / 2 * chord / wavelength)
    assert np.abs(lift - expected).max() < 0.01 * 2 * np.pi


def test_waves_join_the_lifting_line_and_slender_strips() -> None:
    k = 1e-3  # the line: 1/(1 + pi^2 k/2) to first order in k
    assert wave_loading(k)[0] == pytest.approx(1 - np.pi**2 / 2 * k, abs=1e-4)
    # Waves much shorter than the chord: the potential is w/kappa on each side of the plate.
    assert wave_loading(5.0)[0] == pytest.approx(1 / (np.pi**2 * 5.0), rel=1e-4)
    assert wave_loading(5.0)[1] == pytest.approx(0.25 * wave_loading(5.0)[0], rel=0.2)


def test_waves_converge_along_the_chord() -> None:
    for k in (0.03, 0.3, 3.0):
        assert wave_loading(k, 20) == pytest.approx(wave_loading(k, 80), abs=1e-5)


def oblique_lift_by_quadrature(place: float, sweep: float, chord: float, axis: float) -> float:
    """First-order lift of an ellipse of span 2, its downwash summed trailing line by line."""
    half = 0.5 * chord * np.sqrt(1 - place**2)
    angle = (np.arange(60) + 0.5) * np.pi / 60
    downwash = 0.0
    for theta in angle:
        behind = -half * (1 + np.cos(theta))  # of the trailing edge, normal to the span

        def trailing(s: float, x: float = behind) -> float:
            y = place - s
            along, across = (
                x * np.cos(sweep) + y * np.sin(sweep),
                y * np.cos(sweep) - x * np.sin(sweep),
            )
            # 1 + along/R over across, without the difference of equal numbers ahead of the line
            radius = np.hypot(x, y)
            share = (
                across / (radius * (radius - along)) if along < 0 else (1 + along / radius) / across
            )
            return -np.pi * chord * s * share

        graded = np.concatenate(
            [
                [-np.pi / 2],
                np.arcsin(place) + np.outer([-1, 1], np.geomspace(1e-5, 0.05, 9)).ravel(),
                [np.pi / 2],
            ]
        )
        graded = np.sort(graded)
        total = sum(
            quad(lambda a: trailing(np.sin(a)), low, high)[0] for low, high in pairwise(graded)
        )
        downwash += -total / (4 * np.pi) * (1 - np.cos(theta)) / len(angle)
    ellipse_here, slope = np.sqrt(1 - place**2), -chord * place / np.sqrt(1 - place**2)
    along_chord = slope * ellipse_here * (0.5 + 0.5 - axis)  # int d(mu)/dy dx over pi c0 U alpha
    return ellipse_here * (1 + downwash) + np.tan(sweep) * along_chord


@pytest.mark.parametrize("place", [-0.6, 0.3, 0.6])
@pytest.mark.parametrize("axis", [0.0, 0.25])
def test_oblique_ellipse_against_its_trailing_vortices(place: float, axis: float) -> None:
    sweep, chord = np.radians(45.0), 2e-3
    ratio = 2.0 * np.cos(sweep) / chord
    found = oblique_elliptic_lift(place, sweep, ratio, axis)
    expected = oblique_lift_by_quadrature(place, sweep, chord, axis)
    assert (found - ellipse(np.array(place))) * ratio == pytest.approx(
        (expected - ellipse(np.array(place))) * ratio, abs=0.02
    )


def test_an_ellipse_without_sweep_is_prandtls_to_first_order() -> None:
    y, ratio = np.linspace(-0.9, 0.9, 7), 50.0
    lift = oblique_elliptic_lift(y, 0.0, ratio, 0.25)
    np.testing.assert_allclose(lift, ellipse(y) / (1 + np.pi / (2 * ratio)), atol=1e-3)
    turned = oblique_elliptic_lift(y, 0.5, ratio, 0.25)
    np.testing.assert_allclose(turned[::-1], oblique_elliptic_lift(y, -0.5, ratio, 0.25))
