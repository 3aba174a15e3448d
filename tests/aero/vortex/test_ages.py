"""Ages of the rows of a wake."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.ages import growing_ages, revolution_ages, rotor_ages, uniform_ages
from galerna.aero.vortex.blades import blade_lattice
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.steady import solve_steady
from galerna.errors import InputError
from galerna.structure.frames import rotation_about
from galerna.turbine import load
from galerna.turbine.geometry import blade_frames
from galerna.units import DEG, RPM


def test_uniform_ages_reach_the_duration() -> None:
    assert uniform_ages(0.25, 1.0) == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    assert uniform_ages(0.3, 1.0)[-1] == pytest.approx(1.2)


def test_panels_grow_behind_the_near_wake_up_to_the_widest() -> None:
    width = np.diff(growing_ages(0.1, 20.0, near=1.0, growth=1.5, widest=0.6))
    assert width[:10] == pytest.approx(0.1)
    assert width[10:14] == pytest.approx([0.15, 0.225, 0.3375, 0.50625])
    assert width[14:] == pytest.approx(0.6)
    assert np.sum(width) >= 20.0 > np.sum(width[:-1])


def test_a_rotors_wake_is_as_long_as_asked_and_its_arcs_are_short() -> None:
    speed, wind, radius = 1.267, 11.4, 63.0
    ages = rotor_ages(speed, wind, radius, step_deg=5.0, diameters=3.0, widest_deg=30.0)
    assert ages[-1] * wind >= 3.0 * 2.0 * radius
    arcs = np.diff(ages) * speed
    assert arcs[0] == pytest.approx(5.0 * DEG)
    assert arcs.max() <= 30.0 * DEG * (1.0 + 1e-12)
    assert len(ages) < 0.4 * len(revolution_ages(speed, ages[-1] * speed / (2.0 * np.pi)))


def test_a_rotors_default_wake_gives_the_loads_of_seven_uniform_revolutions() -> None:
    """Thrust and power within 0.5 %, with a quarter of the panels."""
    turbine, speed, wind = load("nrel5mw"), 12.1 * RPM, np.array([11.4, 0.0, 0.0])
    blade = blade_lattice(turbine, chordwise=3, spanwise=12)
    position, rotation = blade_frames(turbine.blade, blade.span)
    corners = blade.place(position + np.array([0.0, 0.0, turbine.hub.radius]), rotation)
    turns = [rotation_about(0, 2.0 * np.pi * b / 3.0) for b in range(3)]
    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), speed)

    def thrust_and_torque(ages: np.ndarray) -> np.ndarray:
        flow = solve_steady([corners @ turn.T for turn in turns], wind, axis=axis, ages=ages)
        return np.array([flow.force[0], flow.moment()[0]])

    uniform, default = revolution_ages(speed, 7.0), rotor_ages(speed, 11.4, turbine.rotor_radius)
    assert thrust_and_torque(default) == pytest.approx(thrust_and_torque(uniform), rel=0.005)
    assert len(default) < 0.3 * len(uniform)


def test_a_parked_rotor_and_a_rotor_without_wind_have_finite_wakes() -> None:
    for speed, wind in ((0.0, 10.0), (1.0, 0.0), (-1.0, 8.0)):
        ages = rotor_ages(speed, wind, 63.0)
        assert np.all(np.diff(ages) > 0.0)
        assert 2 < len(ages) < 2000


def test_revolutions_of_equal_panels_are_counted() -> None:
    ages = revolution_ages(2.0, 7.0, 5.0)
    assert len(ages) == 7 * 72 + 1
    assert ages[-1] == pytest.approx(7.0 * np.pi)


@pytest.mark.parametrize(
    ("step", "duration", "growth"),
    [(0.0, 1.0, 1.0), (2.0, 1.0, 1.0), (0.1, 1.0, 0.9), (np.nan, 1.0, 1.0), (0.1, np.inf, 1.0)],
)
def test_ages_that_make_no_wake_are_refused(step: float, duration: float, growth: float) -> None:
    with pytest.raises(InputError, match="ages of the wake"):
        growing_ages(step, duration, growth=growth)


def test_a_wake_too_long_for_a_computer_is_refused_at_once() -> None:
    with pytest.raises(InputError, match=r"more than 100000 rows") as error:
        rotor_ages(1.0, 8.0, 63.0, diameters=3e9)
    assert "shorter" in error.value.hint


def test_a_rotor_without_wind_and_speed_is_refused() -> None:
    with pytest.raises(InputError, match="no wake away"):
        rotor_ages(0.0, 0.0, 63.0)
