"""The start of a machine: it goes on as it begins."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.aero.bem.steady import UniformWind, steady_rotor
from galerna.case import parse
from galerna.coupling.equilibrium import Relaxed, SteadyMachine
from galerna.coupling.operating_point import OperatingPoint, Strategy, operating_point
from galerna.errors import ConvergenceError
from galerna.machine import build_machine
from galerna.structure import TurbineOptions
from galerna.structure.initial import velocity_violation
from galerna.units import DEG, RPM

NREL = turbines.load("nrel5mw")


def machine_in(wind: float, turbine: str = "nrel5mw", more: str = ""):
    text = (
        f"galerna: 1\nturbine: {turbine}\nduration_s: 20\ntime_step_s: 0.05\n"
        f"inflow: {{wind_speed_m_s: {wind}}}\nstructure: flexible\ncontrol: baseline\n{more}"
    )
    return build_machine(parse(text, "case", "."))


def figures(machine) -> np.ndarray:
    """Rotor speed, mean tip deflection out of plane, tower top downwind, pitch."""
    structure = machine.simulation.structure
    state, first = structure.accepted, structure.system
    hub = first.names.index("hub")
    tips = [structure.parts.parts[f"blade{k + 1}"][-1] for k in range(3)]
    now = (state.position[tips] - state.position[hub]) @ state.rotation[hub][:, 0]
    undeflected = (first.position[tips] - first.position[hub]) @ first.rotation[hub][:, 0]
    top = structure.parts.parts["nacelle"][0]
    return np.array(
        [
            structure.rotor_speed,
            (now - undeflected).mean(),
            (state.position - first.position)[top, 0],
            structure.pitch_angles(state.time)[0],
        ]
    )


def course(machine, duration: float) -> np.ndarray:
    """Figures at the start and after every step."""
    rows = [figures(machine)]
    while machine.simulation.time < duration - 1e-9:
        machine.simulation.advance()
        rows.append(figures(machine))
    return np.array(rows)


@pytest.mark.parametrize("wind", [5.0, 11.4, 18.0, 25.0])
def test_starts_without_a_transient(wind: float) -> None:
    """The first seconds ripple as later ones do, by gravity, tilt and tower, and not more."""
    rows = course(machine_in(wind), 9.0)
    first, later = rows[:90], rows[90:]
    margin = np.array([0.005 * rows[0, 0], 0.05, 0.008, 0.1 * DEG])
    assert np.all(first.max(axis=0) < later.max(axis=0) + margin)
    assert np.all(first.min(axis=0) > later.min(axis=0) - margin)


@pytest.mark.parametrize("turbine", ["iea15mw", "dtu10mw"])
def test_other_turbines_start_without_a_transient(turbine: str) -> None:
    rows = course(machine_in(9.0, turbine), 3.0)
    assert rows[:, 0] == pytest.approx(rows[0, 0], rel=0.005)
    assert rows[:, 1] == pytest.approx(rows[0, 1], rel=0.03)
    assert rows[:, 2] == pytest.approx(rows[0, 2], rel=0.05)


def test_velocities_keep_the_joints_in_a_yawed_sheared_wind() -> None:
    more = "operation: {operating_point: steady, yaw_deg: 20, azimuth_deg: 40}\n"
    built = machine_in(9.0, more=more)
    structure = built.simulation.structure
    assert structure.yaw == pytest.approx(20.0 * DEG, abs=0.5 * DEG)
    assert structure.azimuth == pytest.approx(40.0 * DEG, abs=0.5 * DEG)
    assert velocity_violation(structure.system, structure.accepted) < 1e-3
    built.simulation.advance()


def test_what_is_given_overrides() -> None:
    more = "operation: {operating_point: steady, rotor_speed_rpm: 10, pitch_deg: [3, 4, 5]}\n"
    structure = machine_in(9.0, more=more).simulation.structure
    assert structure.rotor_speed == pytest.approx(10.0 * RPM, rel=2e-3)
    assert structure.pitch_angles(0.0) == pytest.approx(np.array([3.0, 4.0, 5.0]) * DEG)


def test_a_prescribed_rotor_starts_bent() -> None:
    text = (
        "galerna: 1\nturbine: nrel5mw\nduration_s: 20\ntime_step_s: 0.05\n"
        "inflow: {wind_speed_m_s: 9}\nstructure: flexible\n"
        "operation: {rotor_speed_rpm: 10, pitch_deg: 2}\n"
    )
    rows = course(build_machine(parse(text, "case", ".")), 3.0)
    assert rows[0, 1] > 1.0
    assert rows[:, 1] == pytest.approx(rows[0, 1], rel=0.03)


def test_stands_still_feathered_where_it_is_to_start_up() -> None:
    base = "galerna: 1\nturbine: nrel5mw\nduration_s: 9\ninflow: {wind_speed_m_s: 12}\n"
    text = base + "structure: flexible\ncontrol: {mode: start_up}\n"
    built = build_machine(parse(text, "case", "."))
    structure = built.simulation.structure
    assert structure.pitch_angles(0.0) == pytest.approx(np.full(3, 90.0 * DEG))
    assert structure.rotor_speed == pytest.approx(0.0, abs=1e-6)
    built.simulation.advance()


def test_finds_a_start_far_outside_of_the_operating_range() -> None:
    beyond = machine_in(30.0, "iea15mw").simulation.structure
    assert beyond.rotor_speed == pytest.approx(7.56 * RPM, rel=1e-3)
    assert 20.0 * DEG < beyond.pitch_angles(0.0)[0] < 27.0 * DEG
    calm = machine_in(1.0).simulation.structure
    assert 0.0 < calm.rotor_speed < 5.0 * RPM
    askew = "operation: {operating_point: steady, yaw_deg: 90}\n"
    text = "galerna: 1\nturbine: nrel5mw\nduration_s: 9\ninflow: {wind_speed_m_s: 40}\n"
    text += "structure: flexible\ncontrol: {mode: idling}\n" + askew
    idle = build_machine(parse(text, "case", ".")).simulation.structure
    assert idle.pitch_angles(0.0) == pytest.approx(np.full(3, 90.0 * DEG))


def test_relaxation_finds_the_balance_of_loads_that_swing() -> None:
    """Loads that answer with -0.9 or -1.5 of their change: plain passes do not settle."""
    for gain in (-0.9, 0.4, -1.5):
        relaxed, loads = Relaxed(), np.zeros((1, 6))
        for _ in range(12):
            loads = 1.0 + gain * relaxed(loads)
        assert loads == pytest.approx(np.full((1, 6), 1.0 / (1.0 - gain)), rel=1e-6)


def test_flexible_equilibrium_of_stiff_parts_is_the_rigid_rotor() -> None:
    wind = UniformWind(np.array([18.0, 0.0, 0.0]))
    options = TurbineOptions(blade_elements=0, tower_elements=0, flexible_shaft=False)
    stiff = SteadyMachine(NREL, wind, options, drag=False)
    speed, pitch = 12.1 * RPM, 14.0 * DEG
    rigid = steady_rotor(NREL, 18.0, speed, pitch)
    assert stiff.torque(speed, pitch) == pytest.approx(float(rigid["torque"]), rel=3e-3)


def test_bearing_holds_the_aerodynamic_torque() -> None:
    still = TurbineOptions(gravity=(0.0, 0.0, 0.0))
    machine = SteadyMachine(NREL, UniformWind(np.array([10.0, 0.0, 0.0])), still)
    point = machine.at(11.0 * RPM, np.zeros(3))
    held = np.mean([machine.held_torque(state) for state in point.states])
    assert held == pytest.approx(point.torque, rel=2e-3)


def test_operating_point_of_known_torques() -> None:
    """Torque 2 - speed - pitch; the generator takes the speed's half."""
    strategy = Strategy(0.1, 1.0, lambda speed: 0.5 * speed)
    below = operating_point(lambda speed, pitch: 1.5 - speed - pitch, strategy)
    assert below.rotor_speed == pytest.approx(1.4 / 1.5, abs=1e-4)
    assert below.pitch == 0.1
    above = operating_point(lambda speed, pitch: 2.0 - speed - pitch, strategy)
    assert (above.rotor_speed, above.pitch) == pytest.approx((1.0, 0.5), abs=1e-4)
    guess = OperatingPoint(1.0, 0.5, 0.5)
    again = operating_point(lambda speed, pitch: 1.5 - speed - pitch, strategy, guess)
    assert again.rotor_speed == pytest.approx(1.4 / 1.5, abs=1e-4)


def test_says_where_no_pitch_holds_the_torque() -> None:
    strategy = Strategy(0.0, 1.0, lambda speed: 0.5)
    with pytest.raises(ConvergenceError, match="no pitch or speed"):
        operating_point(lambda speed, pitch: 2.0, strategy)
