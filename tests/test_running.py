"""Whole runs of the built-in turbine: what comes out, and what is left when one fails."""

import numpy as np
import pytest

import galerna
from galerna import ConvergenceError, InputError
from galerna.case import load
from galerna.machine import build_machine
from galerna.results import open_result
from galerna.running import simulate
from galerna.simulation import Callback

CASE = {
    "galerna": 1,
    "name": "steady",
    "turbine": "nrel5mw",
    "duration_s": 2.0,
    "time_step_s": 0.05,
    "inflow": {"wind_speed_m_s": 8.0},
    "operation": {"rotor_speed_rpm": 9.16, "pitch_deg": 0.0},
}
TURBULENT = {
    **CASE,
    "inflow": {
        "wind_speed_m_s": 8.0,
        "turbulence": {
            "kind": "mann",
            "turbulence_class": "B",
            "points_across": 8,
            "time_step_s": 0.4,
        },
    },
}


class At(Callback):
    """Does something at a time."""

    def __init__(self, time, action):
        self.time, self.action = time, action

    def accepted(self, simulation):
        if simulation.time >= self.time:
            self.action(simulation)


def raise_(error):
    raise error


def test_a_run_gives_the_rotor_over_time():
    result = galerna.run(CASE)
    assert result.attrs["status"] == "complete"
    np.testing.assert_allclose(result["time"], 0.1 * np.arange(1, 21), atol=1e-12)
    assert 1.5e6 < float(result["rotor_power"].mean()) < 2.2e6
    assert float(result["wind_speed"].mean()) == pytest.approx(8.0)
    assert result["azimuth"].values[-1] == pytest.approx(2.0 * 9.16 * np.pi / 30.0)
    assert result.attrs["turbine"] == "NREL 5 MW"
    assert "Ning" in result.attrs["references"]


def test_a_result_holds_all_that_makes_it_again(tmp_path):
    first = galerna.run(TURBULENT, tmp_path / "first.nc")
    kept = open_result(tmp_path / "first.nc")
    again = galerna.run(galerna.case.parse(kept.attrs["case"], "kept"))
    for name in first.data_vars:
        np.testing.assert_array_equal(first[name], again[name])


def test_another_seed_is_another_wind():
    first, second = (galerna.run({**TURBULENT, "seed": seed}) for seed in (1, 2))
    assert np.abs(first["wind_speed"] - second["wind_speed"]).max() > 0.1


def test_a_resumed_run_gives_the_same_bits():
    straight = build_machine(load(TURBULENT)).simulation
    straight.run(1.5)
    first = build_machine(load(TURBULENT)).simulation
    first.run(0.7)
    second = build_machine(load(TURBULENT)).simulation
    second.restore({key: value.copy() for key, value in first.state().items()})
    second.run(1.5)
    for name, value in straight.record().items():
        np.testing.assert_array_equal(second.record()[name], value)


def test_records_start_and_step_as_asked():
    outputs = {"start_s": 1.0, "interval_s": 0.25, "channels": ["rotor_*", "wind_speed"]}
    result = galerna.run({**CASE, "outputs": outputs})
    np.testing.assert_allclose(result["time"], [1.0, 1.25, 1.5, 1.75, 2.0], atol=1e-12)
    assert "angle_of_attack" not in result
    assert {"rotor_speed", "rotor_thrust", "wind_speed"} <= set(result.data_vars)


def test_a_channel_that_does_not_exist_is_refused_before_the_run():
    with pytest.raises(InputError, match=r"(?s)channels\[0\].*did you mean 'rotor_thrust'"):
        galerna.run({**CASE, "outputs": {"channels": ["rotor_trust"]}})


def test_a_failed_step_leaves_a_readable_result(tmp_path):
    fail = At(1.0, lambda s: raise_(ConvergenceError("rotor", "no balance", time=s.time)))
    with pytest.raises(ConvergenceError, match="t = 1 s") as caught:
        simulate(build_machine(load(CASE)), tmp_path / "r.nc", callbacks=[fail])
    assert str(tmp_path / "r.nc") in caught.value.__notes__[0]
    result = open_result(tmp_path / "r.nc")
    assert result.sizes["time"] == 10
    assert result.attrs["status"].startswith("stopped at 1 s: rotor at t = 1 s: no balance")


def test_an_interrupted_run_leaves_a_readable_result(tmp_path):
    interrupt = At(1.0, lambda s: raise_(KeyboardInterrupt()))
    with pytest.raises(KeyboardInterrupt):
        simulate(build_machine(load(CASE)), tmp_path / "r.nc", callbacks=[interrupt])
    assert open_result(tmp_path / "r.nc").attrs["status"] == "stopped at 1 s: interrupted"


def test_wind_outside_the_box_ends_the_run_with_the_point(tmp_path):
    machine = build_machine(load(TURBULENT))
    machine.simulation.structure._geometry[8] += 200.0  # the tower top, out of the box
    with pytest.raises(InputError, match="does not hold the point"):
        simulate(machine, tmp_path / "r.nc")
    assert open_result(tmp_path / "r.nc").attrs["status"].startswith("stopped at 0 s")


def test_the_steady_operating_point_comes_from_the_turbine():
    machine = build_machine(load({**CASE, "operation": {"operating_point": "steady"}}))
    control = machine.turbine.control
    speed = float(machine.operation.rotor_speed.value[0])
    expected = control.optimal_tip_speed_ratio * 8.0 / machine.turbine.rotor_radius
    assert speed == pytest.approx(expected)


def test_a_rotor_turned_in_still_air_takes_power():
    result = galerna.run({**CASE, "inflow": {"wind_speed_m_s": 0.0}})
    assert -1e6 < float(result["rotor_power"].max()) < 0.0
    assert abs(float(result["rotor_thrust"][-1])) < 1e5


def test_pitch_given_for_the_wrong_number_of_blades_is_refused():
    operation = {"rotor_speed_rpm": 9.0, "pitch_deg": [0.0, 1.0]}
    with pytest.raises(InputError, match=r"operation.*pitch_deg: 2 values for 3 blades"):
        build_machine(load({**CASE, "operation": operation}))


def test_an_unknown_turbine_is_answered_with_the_nearest():
    with pytest.raises(InputError, match=r"(?s)turbine.*did you mean 'nrel5mw'"):
        build_machine(load({**CASE, "turbine": "nrel5m"}))
