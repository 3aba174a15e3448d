"""The attached branch of polars: where it ends, and that it is the polar."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.vortex.section_polars import SectionPolars
from galerna.errors import InputError
from galerna.turbine.model import Polar

ANGLE = np.radians(np.linspace(-180.0, 180.0, 721))
STALL = np.radians(12.0)


def stalling_polar() -> Polar:
    """Thin airfoil to 12 deg, then a fall; drag grows with the square of the lift."""
    attached = np.clip(ANGLE, -STALL, STALL)
    beyond = np.abs(ANGLE) - np.abs(attached)
    lift = 2 * np.pi * np.sin(attached) * np.maximum(1.0 - 2.0 * beyond, 0.2)
    drag = 0.01 + 0.02 * lift**2 + 0.5 * beyond
    return Polar(1e6, ANGLE, lift, drag, np.zeros_like(ANGLE))


def test_the_branch_ends_at_least_and_greatest_lift() -> None:
    polars = SectionPolars.of_polar(stalling_polar(), 3)
    greatest = 2 * np.pi * np.sin(STALL)
    assert polars.lift_range == pytest.approx(np.tile([-greatest, greatest], (3, 1)), rel=1e-4)
    assert polars.branch[:, -1, 0] == pytest.approx(STALL, rel=1e-3)


def test_on_the_branch_lift_has_the_angle_and_drag_of_the_polar() -> None:
    polars = SectionPolars.of_polar(stalling_polar(), 5)
    angle = np.radians([-11.0, -4.0, 0.3, 7.0, 11.5])
    lift, drag, _ = polars.at_angle(angle).T
    found = polars.at_lift(lift)
    assert found.angle_of_attack == pytest.approx(angle, abs=2e-5)
    assert found.drag == pytest.approx(drag, abs=1e-5)
    assert not found.outside.any()


def test_beyond_the_branch_its_end_is_kept_and_flagged() -> None:
    found = SectionPolars.of_polar(stalling_polar(), 3).at_lift(np.array([-2.0, 0.5, 2.0]))
    assert found.outside.tolist() == [-1, 0, 1]
    assert np.degrees(found.angle_of_attack[[0, 2]]) == pytest.approx([-12.0, 12.0], abs=0.05)


def test_a_fall_of_scatter_does_not_end_the_branch() -> None:
    polar = stalling_polar()
    rough = polar.lift.copy()
    rough[(np.degrees(ANGLE) > 4.9) & (np.degrees(ANGLE) < 5.1)] -= 0.06  # 0.5 deg: 0.055 of lift
    polars = SectionPolars.of_polar(Polar(1e6, ANGLE, rough, polar.drag, polar.moment), 1)
    assert polars.lift_range[0, 1] == pytest.approx(2 * np.pi * np.sin(STALL), rel=1e-4)
    angles = polars.at_lift(np.linspace(-1.0, 1.2, 300)[:, None]).angle_of_attack[:, 0]
    assert np.all(np.diff(angles) > 0.0)


def test_the_greatest_lift_of_dtus_thick_airfoil_is_where_it_first_stalls() -> None:
    airfoil = turbine.load("dtu10mw").airfoils["FFA-W3-360"]  # rises again at 28 deg
    polars = SectionPolars.of_polar(airfoil.polars[0], 1)
    assert polars.lift_range[0, 1] == pytest.approx(1.859, abs=1e-3)
    assert np.degrees(polars.branch[0, -1, 0]) == pytest.approx(12.0, abs=0.1)


def test_a_cylinder_has_no_branch_and_is_never_outside() -> None:
    cylinder = Polar(1e6, ANGLE, 0.0 * ANGLE, 0.5 + 0.0 * ANGLE, 0.0 * ANGLE)
    polars = SectionPolars.of_polar(cylinder, 2)
    assert not polars.lifting.any()
    found = polars.at_lift(np.array([0.0, 1.0]))
    assert found.drag.tolist() == [0.5, 0.5]
    assert not found.outside.any()


def test_angles_beyond_the_circle_come_back() -> None:
    polars = SectionPolars.of_polar(stalling_polar(), 2)
    there, again = polars.at_angle(np.array([[0.1, -3.0], [0.1 + 2 * np.pi, -3.0 - 2 * np.pi]]))
    assert again == pytest.approx(there)


def test_blades_without_polars_are_refused() -> None:
    with pytest.raises(InputError, match="no polars"):
        SectionPolars.of_blade(None, "blade1")
