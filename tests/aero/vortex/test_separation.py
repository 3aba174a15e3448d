"""Decambering in time: a plate that pitches beyond stall, purity, and states."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.vortex.ages import uniform_ages
from galerna.aero.vortex.blades import blade_lattice
from galerna.aero.vortex.decambering import Decambering
from galerna.aero.vortex.section_lift import SectionLift
from galerna.aero.vortex.section_polars import SectionPolars
from galerna.aero.vortex.separation import Separation, blade_separation
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.unsteady import UnsteadyLattice, UnsteadyOptions
from galerna.aero.vortex.wings import trapezoidal_wing
from galerna.case import load
from galerna.contract import Array
from galerna.machine import build_machine
from galerna.turbine.model import Polar

ANGLE = np.radians(np.linspace(-180.0, 180.0, 1441))
LIFT = 2 * np.pi * np.sin(np.clip(ANGLE, -0.2, 0.2))
POLAR = Polar(1e6, ANGLE, LIFT * np.clip(3.0 - np.abs(ANGLE), 0.0, 1.0), 0 * ANGLE, 0 * ANGLE)
PRESCRIBED = UnsteadyOptions(free=False, start="impulsive", tree_error=None, air_density=1.0)


class Wind:
    """10 m/s along x."""

    def velocity(self, points: Array, time: float) -> Array:
        return np.broadcast_to([10.0, 0.0, 0.0], points.shape)


def plate(angle: float) -> list[Surface]:
    corners = trapezoidal_wing(2000.0, 1.0, 4, 5, angle_of_attack=angle, spanwise_spacing="uniform")
    return [Surface.at_rest(corners)]


def stalling_lattice(options: UnsteadyOptions = PRESCRIBED) -> UnsteadyLattice:
    section = SectionLift.of_lattice(plate(0.0)[0].lattice)
    decambering = Decambering([SectionPolars.of_polar(POLAR, 5)], [section], ["wing"])
    return UnsteadyLattice(
        Wind(), uniform_ages(0.05, 4.0), options, separation=Separation(decambering)
    )


def middle_lift(lattice: UnsteadyLattice, angle: float, steps: int, first: int = 0) -> float:
    """Lift coefficient in the middle of the plate after steps at an angle rad."""
    force = 0.0
    for i in range(first, first + steps):
        lattice.begin_step(0.05 * i, 0.05, plate(angle))
        load = lattice.solve(0.05 * (i + 1), plate(angle)).loads[0]
        lattice.end_step(0.05 * (i + 1), plate(angle))
        force = float(load.strip_force[2, 2]) / (50.0 * 400.0)
    return force


def test_a_plate_held_beyond_stall_comes_to_the_lift_of_its_polar() -> None:
    lattice = stalling_lattice()
    wanted = 2 * np.pi * np.sin(0.2)
    assert middle_lift(lattice, 0.35, 80) == pytest.approx(wanted, rel=0.02)
    assert lattice.separation is not None
    assert lattice.separation.found is not None
    assert lattice.separation.found.wash[2] < -1.0
    assert middle_lift(lattice, 0.1, 80, 80) == pytest.approx(2 * np.pi * np.sin(0.1), rel=0.02)


def test_quasi_steady_flow_meets_the_polar_at_once() -> None:
    options = UnsteadyOptions(quasi_steady=True, free=False, tree_error=None, air_density=1.0)
    lift = middle_lift(stalling_lattice(options), 0.35, 1)
    assert lift == pytest.approx(2 * np.pi * np.sin(0.2), rel=0.005)


def test_solutions_of_a_step_do_not_depend_on_those_asked_before() -> None:
    asked, fresh = stalling_lattice(), stalling_lattice()
    for lattice in (asked, fresh):
        middle_lift(lattice, 0.3, 3)
        lattice.begin_step(0.15, 0.05, plate(0.3))
    asked.solve(0.2, plate(0.9))
    for one, other in zip(
        asked.solve(0.2, plate(0.32)).circulation,
        fresh.solve(0.2, plate(0.32)).circulation,
        strict=True,
    ):
        assert np.array_equal(one, other)


def test_a_state_gives_the_same_bits() -> None:
    lattice, again = stalling_lattice(), stalling_lattice()
    middle_lift(lattice, 0.3, 3)
    again.restore(lattice.state())
    assert middle_lift(lattice, 0.35, 3, 3) == middle_lift(again, 0.35, 3, 3)


def test_a_blade_has_its_own_polars_and_sections() -> None:
    machine = turbine.load("iea15mw")
    lattice = blade_lattice(machine, spanwise=12, chordwise=6)
    found = blade_separation(lattice, machine.blade, ["blade1", "blade2", "blade3"]).decambering
    assert len(found.polars) == 36
    assert lattice.sections is not None
    assert np.array_equal(found.polars.table[12:24], lattice.sections.table[lattice.bare_strips :])
    tilt = found.sections.tilt[:12]
    assert np.all(np.abs(tilt) < np.radians(0.5))  # FFA-W3-360: 0.006 chords at the trailing edge
    assert np.abs(tilt).max() > np.radians(0.1)
    assert np.all(found.sections.zero_lift_angle < 0.0)


def test_the_part_of_polars_is_theirs() -> None:
    polars = SectionPolars.of_polar(POLAR, 4)
    assert len(polars.part(1)) == 3
    assert np.array_equal(polars.part(1).branch, polars.branch[1:])


def deep_stall(aerodynamics: dict[str, object]) -> dict[str, float]:
    """Thrust and torque of the NREL 5 MW at 25 m/s, where it is stalled at 0 deg of pitch."""
    made = build_machine(
        load(
            {
                "galerna": 1,
                "turbine": "nrel5mw",
                "duration_s": 10.0,
                "time_step_s": 0.1,
                "inflow": {"wind_speed_m_s": 25.0},
                "operation": {"rotor_speed_rpm": 12.1, "pitch_deg": 0.0},
                "tower_and_nacelle_drag": False,
                "aerodynamics": {"tower_influence": False, **aerodynamics},
            }
        )
    )
    for _ in range(6):
        made.simulation.advance()
    record = made.simulation.record()
    return {name: float(record[name]) for name in ("rotor_thrust", "rotor_torque")}


def test_a_stalled_rotor_has_nearly_the_loads_of_blade_element_momentum() -> None:
    """Where induction is small both rest on the polars; without decambering thrust is far off."""
    lattice = {
        "model": "vortex_lattice",
        "spanwise_panels": 12,
        "chordwise_panels": 3,
        "wake_length_diameters": 1.5,
        "wake_step_deg": 10,
        "wake": "prescribed",
    }
    momentum = deep_stall({})
    stalled, attached = deep_stall({**lattice, "decambering": True}), deep_stall(lattice)
    for name, value in momentum.items():
        assert stalled[name] == pytest.approx(value, rel=0.1)
        assert attached[name] > 1.4 * value
