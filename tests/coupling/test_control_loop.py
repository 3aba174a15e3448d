"""The controller in the loop of the moving machine: clock, modes, loads, states."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import galerna
from galerna.case import load
from galerna.control.interface import Demands
from galerna.errors import ControllerError, InputError
from galerna.machine import build_machine
from galerna.units import DEG, RPM

RIGID = {"blades": "rigid", "tower": "rigid", "shaft": "rigid", "yaw_bearing": "rigid"}


def case(**changes):
    """The NREL 5 MW as rigid parts in a steady wind."""
    return {
        "galerna": 1,
        "turbine": "nrel5mw",
        "duration_s": 10.0,
        "time_step_s": 0.05,
        "inflow": {"wind_speed_m_s": 15.0},
        "structure": RIGID,
        "control": "baseline",
        **changes,
    }


class Notes:
    """Holds pitch and torque, and writes down when it was asked."""

    def __init__(self, sample_time: float = 0.0) -> None:
        self.times: list[float] = []
        if sample_time:
            self.sample_time = sample_time

    def demands(self, measured):
        self.times.append(measured.time)
        return Demands(10.0 * DEG, 40e3)


def test_production_holds_rated_speed_and_accounts_for_its_losses():
    result = galerna.run(case(duration_s=20.0))
    last = result.isel(time=-1)
    assert float(last.rotor_speed) == pytest.approx(12.1 * RPM, rel=5e-3)
    assert float(last.electrical_power) == pytest.approx(5e6, rel=5e-3)
    mechanical = float(last.generator_torque * last.generator_speed)
    assert float(last.drivetrain_losses) == pytest.approx(0.056 * mechanical, rel=1e-9)
    assert float(last.control_mode) == 0.0


def test_the_controller_is_asked_once_a_step_also_where_the_step_is_halved():
    notes = Notes()
    with galerna.start(case(), notes) as sim:
        sim.step()
        model = next(iter(sim.simulation.load_models.values()))
        loads, failed = model.loads, []

        def fails_once(time, motion):
            if not failed:
                failed.append(time)
                raise galerna.ConvergenceError("rotor", "on purpose")
            return loads(time, motion)

        model.loads = fails_once
        before = sim.measure().pitch.mean()
        sim.step(pitch=before + 0.1 * DEG)
    assert failed
    assert notes.times == pytest.approx([0.0, 0.05])
    assert sim.measure().pitch == pytest.approx(before + 0.1 * DEG)


@pytest.mark.parametrize("own", [False, True])
def test_demands_hold_for_the_sample_time(own):
    notes = Notes(0.15 if own else 0.0)
    control = {"model": "external"} if own else {"model": "external", "sample_time_s": 0.15}
    with galerna.start(case(control=control), notes) as sim:
        for _ in range(10):
            sim.step()
    assert notes.times == pytest.approx([0.0, 0.15, 0.3, 0.45])


@pytest.mark.parametrize(("step", "steps_a_sample"), [(0.00625, 1), (0.025, 2)])
def test_the_clock_of_samples_does_not_drift_in_a_long_run(step, steps_a_sample, monkeypatch):
    """A sum of 93,000 steps of 0.00625 s is off by more than the clock's tolerance."""
    notes, steps = Notes(step * steps_a_sample), 95_000
    with galerna.start(case(control={"model": "external"}), notes) as sim:
        loop = sim.simulation.commander
        monkeypatch.setattr(loop, "measure", lambda time: SimpleNamespace(time=time))
        for n in range(steps):
            loop._demanded(n * step)
    assert notes.times == [n * step for n in range(0, steps, steps_a_sample)]


def test_a_sample_time_between_steps_is_refused():
    with pytest.raises(InputError, match="whole number of time steps"):
        galerna.run(case(control={"model": "baseline", "sample_time_s": 0.02}))


def test_the_generators_torque_lags():
    control = {"model": "external", "torque_time_constant_s": 0.5}
    with galerna.start(case(control=control)) as sim:
        start = sim.measure().generator_torque
        sim.step(torque=0.0)
        for _ in range(9):
            sim.step()
        assert sim.measure().generator_torque == pytest.approx(start * np.exp(-1.0), rel=1e-9)
        assert sim.record()["torque_demand"] == 0.0


@pytest.mark.parametrize(
    ("demands", "said"),
    [
        (Demands(np.zeros(2), 0.0), "shape .2,. for 3 blades"),
        (Demands(np.nan, 0.0), "must be numbers"),
        (Demands(0.0, "much"), "one number"),
        (Demands(0.0, 0.0, brake=-1.0), "brake of -1"),
    ],
)
def test_impossible_demands_name_controller_and_time(demands, said):
    notes = Notes()
    notes.demands = lambda measured: demands
    with galerna.start(case(), notes) as sim, pytest.raises(ControllerError, match=said) as error:
        sim.step()
    assert "Notes at t = 0 s" in str(error.value)


def test_a_controller_without_memory_says_why_it_cannot_be_resumed():
    assert build_machine(load(case())).simulation.commander.resumable == ""
    with galerna.start(case(), Notes()) as sim:
        assert "Notes has no state and no restore" in sim.simulation.commander.resumable


def test_a_python_controller_commands_from_a_case(tmp_path):
    (tmp_path / "mine.py").write_text(
        "from galerna.control.interface import Demands\n"
        "class Mine:\n"
        "    def __init__(self, turbine): pass\n"
        "    def demands(self, measured): return Demands(0.2, 1 / (measured.time < 0.2))\n"
    )
    loaded = load(case(control={"model": "python", "object": str(tmp_path / "mine.py:Mine")}))
    with pytest.raises(ControllerError, match=r"Mine at t = 0.2 s: raised ZeroDivisionError"):
        galerna.run(loaded)
    with pytest.raises(InputError, match="control"):
        galerna.run(case(control={"model": "python", "object": "mine.py:Nobody"}))


def test_an_emergency_stop_with_the_whole_machine():
    events = [{"time_s": 1.0, "mode": "emergency_stop"}]
    control = {"model": "baseline", "events": events, "emergency_brake": True}
    result = galerna.run(case(duration_s=12.0, control=control))
    speed = result.rotor_speed.values
    assert speed.max() < 1.08 * 12.1 * RPM
    assert abs(speed[-1]) < 0.1 * 12.1 * RPM
    assert result.pitch.values[-1] == pytest.approx(90.0 * DEG, abs=1.0 * DEG)
    assert float(result.brake_torque.max()) > 3e6
    assert result.generator_torque.values[-1] == 0.0


def test_a_start_with_the_whole_machine():
    control = {"model": "baseline", "mode": "start_up"}
    result = galerna.run(case(duration_s=60.0, time_step_s=0.1, control=control))
    assert float(result.rotor_speed[0]) == pytest.approx(0.0, abs=0.01)
    assert float(result.pitch[0, 0]) == pytest.approx(90.0 * DEG, abs=0.2 * DEG)
    assert float(result.rotor_speed[-1]) > 0.4 * 12.1 * RPM
    assert np.all(np.diff(result.rotor_speed.values[20:]) > 0.0)


def test_a_rotor_at_rest_is_feathered_as_far_as_its_actuators_go():
    control = {"model": "baseline", "mode": "idling", "pitch_actuator": {"highest_deg": 60}}
    result = galerna.run(case(duration_s=0.5, control=control))
    assert result.pitch.values == pytest.approx(60.0 * DEG, abs=1e-4)


def test_a_parked_rotor_stands_still_on_its_shaft():
    structure = {**RIGID, "shaft": "flexible"}
    control = {"model": "baseline", "mode": "parked"}
    inflow = {"wind_speed_m_s": 40.0}
    result = galerna.run(case(duration_s=20.0, structure=structure, control=control, inflow=inflow))
    assert abs(float(result.rotor_speed[-1])) < 1e-4
    azimuth = result.azimuth.values
    assert abs((azimuth[-1] - azimuth[0] + np.pi) % (2 * np.pi) - np.pi) < 1.0 * DEG


def once_per_turn(result) -> float:
    """Amplitude N m of the out-of-plane root moment at the rotor's own frequency."""
    late = result.sel(time=slice(35.0, None))
    moment = late.blade_root_out_of_plane_moment.values[:, 0]
    turns = np.exp(1j * late.azimuth.values)
    return 2.0 * abs(np.mean((moment - moment.mean()) * turns))


def test_individual_pitch_takes_the_shear_off_the_roots():
    inflow = {"wind_speed_m_s": 18.0, "shear": {"kind": "power_law", "exponent": 0.25}}
    common = {"duration_s": 60.0, "inflow": inflow}
    plain = galerna.run(case(**common))
    individual = galerna.run(case(**common, control={"model": "baseline", "individual_pitch": {}}))
    assert once_per_turn(individual) < 0.1 * once_per_turn(plain)
    assert float(individual.electrical_power[-1]) == pytest.approx(5e6, rel=0.01)
    spread = np.ptp(individual.pitch.values[-1])
    assert 0.1 * DEG < spread < 10.0 * DEG


class Counts(Notes):
    """Remembers in an array that it changes in place."""

    def __init__(self):
        super().__init__()
        self.count = np.zeros(1)

    def demands(self, measured):
        self.count += 1.0
        return super().demands(measured)

    def state(self):
        return {"count": self.count}

    def restore(self, state):
        self.count = state["count"]


def test_a_state_stays_what_it_was_whatever_a_controller_does_with_its_arrays():
    mine = Counts()
    with galerna.start(case(), mine) as sim:
        sim.step()
        here = sim.state()
        for _ in range(2):
            sim.step()
            assert mine.count == 2.0
            sim.restore(here)


def test_a_run_resumes_to_the_same_bits_with_all_states_of_the_loop():
    control = {
        "model": "baseline",
        "individual_pitch": {},
        "yaw": {},
        "pitch_actuator": {"frequency_hz": 1.0},
        "torque_time_constant_s": 0.1,
        "sample_time_s": 0.1,
    }
    with galerna.start(case(control=control)) as one, galerna.start(case(control=control)) as other:
        for _ in range(5):
            one.step()
        other.restore(one.state())
        for _ in range(5):
            first, second = one.step(), other.step()
        assert np.array_equal(first.pitch, second.pitch)
        assert first.rotor_speed == second.rotor_speed
        assert first.generator_torque == second.generator_torque


def test_the_nacelle_turns_into_the_wind():
    yaw = {"rate_deg_s": 1.0, "dead_band_deg": 5.0, "averaging_s": 1.0}
    inflow = {"wind_speed_m_s": 12.0, "direction_deg": 8.0}
    control = {"model": "baseline", "yaw": yaw}
    result = galerna.run(case(inflow=inflow, control=control))
    assert float(result.yaw_error[0]) == pytest.approx(-8.0 * DEG, abs=0.2 * DEG)
    assert float(result.yaw[-1]) == pytest.approx(8.0 * DEG, abs=0.1 * DEG)
    assert np.diff(result.yaw.values).max() == pytest.approx(0.1 * DEG, rel=1e-3)


def test_the_yaw_error_is_that_of_the_nacelle_against_the_wind():
    operation = {"operating_point": "steady", "yaw_deg": 30.0}
    with galerna.start(case(operation=operation)) as sim:
        assert sim.measure().yaw_error == pytest.approx(30.0 * DEG)


def test_the_wind_speed_is_the_horizontal_one():
    with galerna.start(case()) as sim:
        sim.simulation.commander._hub_wind = lambda time: np.array([3.0, 4.0, 12.0])
        assert sim.measure().wind_speed == pytest.approx(5.0)


def test_without_control_and_operation_a_case_says_what_to_give():
    with pytest.raises(InputError, match="control: baseline"):
        galerna.run({key: value for key, value in case().items() if key != "control"})
