"""Plane flow about the sections of a lattice against thin-airfoil theory."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.camber import parabolic_arc
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.section_lift import SectionLift, strip_chords
from galerna.aero.vortex.wings import trapezoidal_wing

FINE = np.linspace(0.0, 1.0, 400)


def arc(height_angle: float) -> np.ndarray:
    return np.column_stack([FINE, parabolic_arc(height_angle, FINE)])


@pytest.mark.parametrize("panels", [1, 3, 16])
def test_a_flat_plate_has_the_slope_2_pi_with_any_number_of_panels(panels: int) -> None:
    lift = SectionLift.of_lattice(Lattice(trapezoidal_wing(4.0, 1.0, panels, 3)))
    assert lift.slope == pytest.approx(2 * np.pi)
    assert lift.wash_slope == pytest.approx(2 * np.pi)
    assert lift.zero_lift_angle == pytest.approx(0.0, abs=1e-12)


def test_the_zero_lift_angle_of_an_arc_is_thin_airfoil_theorys() -> None:
    corners = trapezoidal_wing(4.0, 2.0, 32, 3, camber=arc(-0.05), angle_of_attack=0.3)
    lift = SectionLift.of_lattice(Lattice(corners))
    assert lift.zero_lift_angle == pytest.approx(-0.05, rel=5e-3)
    assert lift.slope == pytest.approx(2 * np.pi, rel=5e-3)


def test_sections_are_seen_across_their_span_wherever_they_stand() -> None:
    rng = np.random.default_rng(5)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    corners = trapezoidal_wing(6.0, 2.0, 8, 4, camber=arc(-0.08), taper=0.5, sweep=0.4)
    here = SectionLift.of_lattice(Lattice(corners))
    there = SectionLift.of_lattice(Lattice(corners @ turn.T + 7.0))
    assert there.slope == pytest.approx(here.slope)
    assert there.zero_lift_angle == pytest.approx(here.zero_lift_angle)
    chord, aft = strip_chords(corners)
    span = np.diff(0.75 * corners[0] + 0.25 * corners[-1], axis=0)
    assert np.sum(aft * span, axis=1) == pytest.approx(0.0, abs=1e-12)
    assert np.all(chord < np.linalg.norm(corners[-1] - corners[0], axis=1).max())


def test_the_circulation_of_plane_flow_gives_angle_and_speed_back() -> None:
    corners = trapezoidal_wing(4.0, 2.0, 6, 3, camber=arc(-0.05))
    lift = SectionLift.of_lattice(Lattice(corners), tilt=0.01)
    angle, speed, wash = np.array([-0.4, 0.2, 1.2]), 30.0, np.array([0.5, -2.0, 1.0])
    across = speed * np.sin(angle - lift.zero_lift_angle)
    circulation = 0.5 * 2.0 * (lift.slope * across + lift.wash_slope * wash)
    flow = lift.effective_flow(lift.across(circulation, 2.0, wash), speed * np.cos(angle))
    assert flow.angle_of_attack == pytest.approx(angle + 0.01)
    assert flow.speed == pytest.approx(speed)
