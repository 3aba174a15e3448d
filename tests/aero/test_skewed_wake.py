"""The skewed-wake formulas against Biot-Savart integrals of a skewed vortex cylinder."""

import numpy as np
import pytest
from numpy import pi
from scipy.special import ellipe, ellipk

from galerna.aero.bem.skewed_wake import (
    LARGEST_SKEW,
    PITT_PETERS,
    half_skew_tangent,
    pitt_peters,
    skew_position,
    vortex_cylinder,
)

DELTAS = np.arange(24) * 2 * pi / 24
GROWTH = [0.2, 0.45, 0.75]


def filament_integrals(offset, direction):
    """Integrals of 1/d^3 and s/d^3 along a half line from each ``offset`` (n,3) backwards."""
    length = np.linalg.norm(offset, axis=1)
    gap = length - offset @ direction
    return 1.0 / (length * gap), 1.0 / gap


def ring_velocity(x, delta, chi, n=4000):
    """Velocity (3,) at the disc of skewed rings with strength 2 along the axis: mean 1."""
    theta = (np.arange(n) + 0.5) * 2 * pi / n
    rim = np.stack([np.cos(theta), np.sin(theta), 0 * theta], axis=1)
    along = np.stack([-np.sin(theta), np.cos(theta), 0 * theta], axis=1)
    wake = np.array([np.sin(chi), 0.0, np.cos(chi)])
    offset = x * np.array([np.cos(delta), np.sin(delta), 0.0]) - rim
    first, second = filament_integrals(offset, wake)
    field = np.cross(along, offset) * first[:, None] - np.cross(along, wake) * second[:, None]
    return 2.0 * field.sum(axis=0) * (2 * pi / n) / (4 * pi)


def root_velocity(x, delta, chi):
    """Velocity (3,) of the root vortex that gives the straight wake a swirl of 1 at x."""
    point = x * np.array([[np.cos(delta), np.sin(delta), 0.0]])
    wake = np.array([np.sin(chi), 0.0, np.cos(chi)])
    return x * np.cross(wake, point[0]) * filament_integrals(point, wake)[0]


def tangential(velocity, delta):
    return -np.sin(delta) * velocity[0] + np.cos(delta) * velocity[1]


def first_harmonic(values):
    c = np.fft.rfft(values) / len(values)
    return c[0].real, 2 * c[1].real, -2 * c[1].imag


@pytest.mark.parametrize("chi", np.radians([10.0, 30.0, 50.0]))
@pytest.mark.parametrize("x", GROWTH)
def test_rings_of_the_vortex_cylinder(chi, x):
    # The wake's velocity opposes the wind, so the exact field enters with a minus sign.
    exact = np.array([ring_velocity(x, d, chi) for d in DELTAS])
    t = np.tan(chi / 2)
    model = np.array([vortex_cylinder(1.0, 0.0, x, t, np.cos(d), np.sin(d)) for d in DELTAS])
    np.testing.assert_allclose(
        first_harmonic(model[:, 0]), first_harmonic(exact[:, 2]), atol=0.011 * t
    )
    swirl = np.array([tangential(u, d) for u, d in zip(exact, DELTAS, strict=True)])
    np.testing.assert_allclose(first_harmonic(model[:, 1]), first_harmonic(swirl), atol=1e-8)
    # What the model leaves out is of second order in the skew.
    assert np.abs(model[:, 0] - exact[:, 2]).max() < 0.5 * t**2
    assert np.abs(model[:, 1] - swirl).max() < 0.5 * t**2


@pytest.mark.parametrize("chi", np.radians([10.0, 30.0, 50.0]))
def test_root_vortex_is_exact(chi):
    t = np.tan(chi / 2)
    for d in DELTAS:
        exact = -root_velocity(0.4, d, chi)  # the wake turns against the rotor
        axial, swirl = vortex_cylinder(0.0, 1.0, 0.4, t, np.cos(d), np.sin(d))
        assert axial == pytest.approx(-exact[2], abs=1e-12)
        assert swirl == pytest.approx(-tangential(exact, d), abs=1e-12)


def test_growth_is_the_radial_velocity_of_the_straight_cylinder():
    for x in GROWTH:
        m = 4 * x / (1 + x) ** 2
        k = np.sqrt(m)
        radial = ((2 - m) / k * ellipk(m) - 2 / k * ellipe(m)) / (2 * pi * np.sqrt(x))
        axial, _ = vortex_cylinder(1.0, 0.0, x, 0.1, 1.0, 0.0)
        assert (axial - 1.0) / 0.1 == pytest.approx(4 * radial, rel=0.011)


def test_pitt_peters_has_the_cylinders_moment():
    # Both models give the rotor the same induced yawing moment: the first radial moment of K.
    x = (np.arange(2000) + 0.5) / 2000
    growth = np.array([vortex_cylinder(1.0, 0.0, xi, 0.1, 1.0, 0.0)[0] - 1 for xi in x]) / 0.1
    slope = (growth * x**2).sum() / (x * x**2).sum()
    assert slope == pytest.approx(PITT_PETERS, rel=5e-3)
    assert pitt_peters(2.0, 0.3, 0.5, 0.1, 1.0) == (pytest.approx(2.0 + PITT_PETERS * 0.1), 0.3)


def test_means_over_a_turn_are_kept():
    t = np.tan(np.radians(20.0))
    d = np.arange(360) * 2 * pi / 360
    values = np.array([vortex_cylinder(2.0, 0.4, 0.6, t, np.cos(a), np.sin(a)) for a in d])
    np.testing.assert_allclose(values.mean(axis=0), [2.0, 0.4], atol=1e-12)


def test_no_skew_changes_nothing():
    assert vortex_cylinder(2.0, 0.4, 0.6, 0.0, 0.6, 0.8) == (2.0, 0.4)
    assert pitt_peters(2.0, 0.4, 0.6, 0.0, 0.6) == (2.0, 0.4)


@pytest.mark.parametrize("yaw", np.radians([5.0, 20.0, 40.0]))
@pytest.mark.parametrize("induction", [0.0, 0.2, 0.33, -0.1])
def test_skew_angle_solves_colemans_equation(yaw, induction):
    t = half_skew_tangent(10 * np.cos(yaw), 10 * np.sin(yaw), 10 * induction)
    chi = 2 * np.arctan(t)
    if chi < LARGEST_SKEW:
        right = (np.sin(yaw) - induction * t) / (np.cos(yaw) - induction)
        assert np.tan(chi) == pytest.approx(right, rel=1e-10)
    # The handbook's fit to the same equation.
    assert chi == pytest.approx((0.6 * induction + 1) * yaw, rel=0.05)


def test_skew_is_continuous_and_bounded_over_all_yaw():
    yaw = np.linspace(0.0, pi, 3601)
    t = np.array([half_skew_tangent(10 * np.cos(g), 10 * np.sin(g), 2.0) for g in yaw])
    assert np.all((t >= 0.0) & (t <= np.tan(LARGEST_SKEW / 2) + 1e-12))
    assert np.abs(np.diff(t)).max() < 2e-3
    assert t[-1] == 0.0
    assert half_skew_tangent(0.0, 0.0, 0.0) == 0.0


def test_position_follows_the_wind_direction_in_the_plane():
    # x is the shaft, positive rotation takes y to z; the wind pushes towards +y.
    assert skew_position(3.0, 0.0, 5.0, 0.0) == pytest.approx((1.0, 0.0))
    assert skew_position(3.0, 0.0, 0.0, 5.0) == pytest.approx((0.0, 1.0))
    turn = 0.7  # turning wind and blade together changes nothing
    c, s = np.cos(turn), np.sin(turn)
    assert skew_position(3 * c, 3 * s, 5 * c, 5 * s) == pytest.approx((1.0, 0.0), abs=1e-12)
    assert skew_position(0.0, 0.0, 5.0, 0.0) == (1.0, 0.0)
