"""A simulation stepped from Python."""

from __future__ import annotations

import numpy as np
import pytest

import galerna
from galerna.errors import ControllerError
from galerna.units import DEG

CASE = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 5.0,
    "time_step_s": 0.05,
    "inflow": {"wind_speed_m_s": 15.0},
    "structure": "rigid",
    "control": "external",
}


@pytest.fixture(scope="module")
def sim():
    with galerna.start(CASE) as session:
        yield session


def test_what_is_told_holds_until_something_else_is(sim):
    measured = sim.step(pitch=0.2, torque=30e3)
    assert measured.time == sim.time == pytest.approx(0.05)
    assert measured.generator_torque == 30e3
    assert sim.step().generator_torque == 30e3
    again = sim.step(pitch=[0.2, 0.15, 0.2])
    assert again.generator_torque == 30e3
    assert again.pitch[1] < again.pitch[0]
    assert sim.record()["generator_torque"] == 30e3


def test_less_torque_lets_the_rotor_speed_up(sim):
    here = sim.state()
    heavy = [sim.step(torque=50e3).rotor_speed for _ in range(10)][-1]
    sim.restore(here)
    light = [sim.step(torque=0.0).rotor_speed for _ in range(10)][-1]
    assert light > heavy
    sim.restore(here)
    assert [sim.step(torque=50e3).rotor_speed for _ in range(10)][-1] == heavy


def test_what_cannot_be_met_is_said_and_forgotten(sim):
    with pytest.raises(ControllerError, match=r"^step at t = .*shape"):
        sim.step(pitch=[0.0, 0.1])
    sim.step(pitch=0.2)


def test_a_controller_of_the_case_fills_in_what_is_not_told():
    with galerna.start({**CASE, "control": "baseline"}) as sim:
        own = sim.step()
        assert own.generator_torque == pytest.approx(43.1e3, rel=0.01)
        assert sim.step(torque=1e3).generator_torque == 1e3
        assert sim.record()["torque_demand"] == 1e3
        assert sim.step().generator_torque > 1e3
        assert sim.record()["torque_demand"] > 1e3


def test_a_case_without_a_controller_is_stepped_from_where_it_stands():
    values = {k: v for k, v in CASE.items() if k not in ("control", "structure")}
    values["operation"] = {"rotor_speed_rpm": 10.0, "pitch_deg": 5.0}
    with galerna.start(values) as sim:
        assert sim.measure().rotor_speed == pytest.approx(10.0 * np.pi / 30.0, rel=1e-6)
        assert sim.step().pitch == pytest.approx(5.0 * DEG)
