"""The fit of attached-flow and stall parameters on polars whose parameters are known."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.turbine import load, unsteady
from galerna.turbine.model import Polar
from galerna.units import DEG


def kirchhoff_polar(zero: float, slope: float, stall: float) -> Polar:
    """Kirchhoff flow whose separation point falls from 1 to 0 around the stall angle."""
    alpha = np.linspace(-np.pi, np.pi, 1441)
    angle = np.abs(alpha - zero)
    separation = 1.0 / (1.0 + np.exp((angle - stall) / (0.5 * DEG)))
    normal = slope * ((1.0 + np.sqrt(separation)) / 2.0) ** 2 * np.sin(alpha - zero)
    drag = np.full_like(alpha, 0.008)
    lift = (normal - drag * np.sin(alpha)) / np.where(
        np.abs(np.cos(alpha)) < 0.1, 1.0, np.cos(alpha)
    )
    return Polar(1e6, alpha, lift, drag, np.full_like(alpha, -0.05))


@pytest.mark.parametrize("zero_deg", [-4.0, 0.0, 2.0])
def test_known_parameters_are_found(zero_deg: float) -> None:
    stall = 12.0 * DEG
    fitted = unsteady.fit(kirchhoff_polar(zero_deg * DEG, 6.2, stall))
    # f = 0.7 lies where the logistic curve is 0.7: ln(3/7)/2 deg before the middle
    expected = stall + 0.5 * DEG * np.log(0.3 / 0.7)
    assert fitted.zero_lift_angle == pytest.approx(zero_deg * DEG, abs=0.1 * DEG)
    assert fitted.normal_force_slope == pytest.approx(6.2, rel=0.01)
    above, below = np.array(fitted.separation_angles) - zero_deg * DEG
    assert above == pytest.approx(expected, abs=0.3 * DEG)
    assert below == pytest.approx(-expected, abs=0.3 * DEG)
    assert fitted.critical_normal_force[0] == pytest.approx(6.2 * expected, rel=0.04)
    assert fitted.zero_lift_drag == pytest.approx(0.008)
    assert fitted.zero_lift_moment == pytest.approx(-0.05)
    assert "fitted" in fitted.origin


def test_a_cylinder_has_no_attached_flow() -> None:
    alpha = np.array([-np.pi, np.pi])
    fitted = unsteady.fit(Polar(1e6, alpha, np.zeros(2), np.full(2, 0.5), np.zeros(2)))
    assert fitted.normal_force_slope == 0.0
    assert fitted.separation_angles == (0.0, 0.0)
    assert fitted.zero_lift_drag == 0.5


@pytest.mark.parametrize("name", ["DU25_A17", "DU21_A17", "NACA64_A17"])
def test_fits_come_near_the_published_parameters_where_flow_is_attached(name: str) -> None:
    """Thin sections only: the published slopes are lower as they are taken over more angles."""
    airfoil = load("nrel5mw").airfoils[name]
    fitted, published = unsteady.fit(airfoil.polars[0]), airfoil.unsteady
    assert published.origin == "published"
    assert fitted.zero_lift_angle == pytest.approx(published.zero_lift_angle, abs=0.7 * DEG)
    assert fitted.normal_force_slope == pytest.approx(published.normal_force_slope, rel=0.25)
    assert fitted.separation_angles[0] == pytest.approx(
        published.separation_angles[0], abs=1.5 * DEG
    )
