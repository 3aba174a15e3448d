"""Camber lines against thin-airfoil theory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.vortex.camber import (
    airfoil_line,
    has_lift,
    mean_line,
    parabolic_arc,
    polar_zero_lift,
    thin_airfoil_zero_lift,
    zero_lift_angles,
)
from tests.machines import FLAT_PLATE, small_turbine

ALONG = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 201))


def naca_23012() -> np.ndarray:
    m, k = 0.2025, 15.957
    nose = k / 6.0 * (ALONG**3 - 3 * m * ALONG**2 + m**2 * (3 - m) * ALONG)
    return np.column_stack([ALONG, np.where(m > ALONG, nose, k * m**3 / 6.0 * (1.0 - ALONG))])


def test_the_zero_lift_angle_of_naca_23012_is_the_textbooks() -> None:
    # Anderson, Fundamentals of Aerodynamics, example 4.5: -1.09 deg.
    assert np.degrees(thin_airfoil_zero_lift(naca_23012())) == pytest.approx(-1.09, abs=0.01)


def test_a_parabolic_arc_has_the_zero_lift_angle_it_was_made_for() -> None:
    line = np.column_stack([ALONG, parabolic_arc(-0.06, ALONG)])
    assert thin_airfoil_zero_lift(line) == pytest.approx(-0.06, rel=1e-3)
    assert line[100, 1] == pytest.approx(0.03)


def test_the_zero_lift_angle_is_found_at_second_order_in_the_points() -> None:
    def error(points: int) -> float:
        x = np.linspace(0.0, 1.0, points + 1)
        return abs(thin_airfoil_zero_lift(np.column_stack([x, parabolic_arc(0.1, x)])) - 0.1)

    assert np.log2(error(20) / error(40)) > 1.3  # the nose costs half an order


def test_a_mean_line_meets_its_ends_exactly() -> None:
    line = np.array([[0.002, 0.001], [0.4, 0.03], [0.998, 0.004]])
    height = mean_line(line, np.array([0.0, 1.0]))
    assert height.tolist() == [0.001, 0.004]


def test_the_polars_zero_lift_is_where_lift_rises_through_zero_nearest_to_zero_angle() -> None:
    assert polar_zero_lift(FLAT_PLATE) == pytest.approx(0.0, abs=1e-12)
    polar = FLAT_PLATE.polars[0]
    shifted = replace(polar, lift=np.sin(2.0 * (polar.angle_of_attack + 0.05)))
    cambered = replace(FLAT_PLATE, polars=(shifted,))
    assert polar_zero_lift(cambered) == pytest.approx(-0.05, abs=1e-3)


def test_a_cylinder_has_no_lift_and_no_camber() -> None:
    polar = FLAT_PLATE.polars[0]
    cylinder = replace(FLAT_PLATE, polars=(replace(polar, lift=1e-4 * np.ones(73)),))
    assert has_lift(FLAT_PLATE)
    assert not has_lift(cylinder)
    assert not airfoil_line(replace(cylinder, camber=naca_23012()), "coordinates", ALONG).any()


def test_coordinates_come_first_and_the_polar_stands_in() -> None:
    polar = FLAT_PLATE.polars[0]
    shifted = replace(polar, lift=np.sin(2.0 * (polar.angle_of_attack + 0.05)))
    airfoil = replace(FLAT_PLATE, polars=(shifted,), camber=naca_23012())
    by_coordinates = airfoil_line(airfoil, "coordinates", ALONG)
    by_polar = airfoil_line(airfoil, "polar", ALONG)
    assert by_coordinates == pytest.approx(naca_23012()[:, 1])
    assert by_polar == pytest.approx(parabolic_arc(polar_zero_lift(airfoil), ALONG))
    without = replace(airfoil, camber=None)
    assert np.array_equal(airfoil_line(without, "coordinates", ALONG), by_polar)
    assert not airfoil_line(airfoil, "none", ALONG).any()


def test_camber_and_polar_of_nrels_thick_airfoil_differ_and_cylinders_are_left_out() -> None:
    angles = {a.airfoil: a for a in zero_lift_angles(turbine.load("nrel5mw"))}
    assert "Cylinder1" not in angles
    assert np.degrees(angles["DU35_A17"].by_camber) == pytest.approx(-3.5, abs=0.05)
    assert np.degrees(angles["DU35_A17"].by_polar) == pytest.approx(-1.4, abs=0.05)
    plate = zero_lift_angles(small_turbine())[0]
    assert plate.by_camber is None
    assert plate.by_polar == pytest.approx(0.0, abs=1e-9)
