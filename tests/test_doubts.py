"""What is said of a case that can be run but is hardly meant."""

import pytest

from galerna.case import load
from galerna.machine import build_machine

CASE = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 2.0,
    "time_step_s": 0.02,
    "inflow": {"wind_speed_m_s": 8.0},
    "operation": {"rotor_speed_rpm": 9.16, "pitch_deg": 0.0},
}


def doubts(**changes):
    return list(build_machine(load({**CASE, **changes})).doubts())


def operation(**changes):
    return {**CASE["operation"], **changes}


def steady(wind_speed):
    wind = {"wind_speed_m_s": wind_speed}
    return {"inflow": wind, "operation": {"operating_point": "steady"}}


def swinging(frequency, time_step):
    swing = {"amplitude": 0.1, "frequency_hz": frequency}
    slow = {"rotor_speed_rpm": 6.0, "pitch_deg": 0.0}  # few degrees of azimuth in a step
    steps = {"time_step_s": time_step, "duration_s": 10 * time_step}
    return {"base_motion": {"surge_m": swing, "heave_m": 1.0}, "operation": slow, **steps}


def stopping_at(time):
    event = {"time_s": time, "mode": "normal_stop"}
    return {"structure": "rigid", "control": {"model": "baseline", "events": [event]}}


def test_a_plain_case_raises_none():
    assert doubts() == []


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"operation": operation(rotor_speed_rpm=20.0)}, "blade tips move at 13"),  # rated 80 m/s
        ({"operation": operation(rotor_speed_rpm=-9.0)}, "turns backwards, at -9 rpm"),
        ({"operation": operation(pitch_deg=-11.0)}, "pitched to -11 deg"),
        ({"operation": operation(pitch_deg=[0.0, 101.0, 0.0])}, "pitched to 101 deg"),
        ({"time_step_s": 0.2}, "10.99 deg in a time step of 0.2 s"),  # 6 deg/s per rpm
        ({"duration_s": 2.007}, "not a whole number of steps of 0.02 s: the run ends at 2 s"),
        ({"turbine": "nrel5mw_oc3"}, "the platform is held still: give a sea for it to float in"),
        (
            {"structure": "flexible", "time_step_s": 0.17, "duration_s": 1.7},
            "edgewise bending of the blades takes 0.948 s, 5.6 time steps",
        ),
        (swinging(1.0, 0.2), "surge_m: a swing takes 1 s, 5 time steps: below 6"),
        (stopping_at(2.0), "normal_stop at 2 s does not come: the run ends at 2 s"),
        (steady(2.0), "2 m/s is below cut-in, 3 m/s"),
        (steady(26.0), "26 m/s is above cut-out, 25 m/s"),
    ],
)
def test_each_doubt_is_said_alone(changes, expected):
    (doubt,) = doubts(**changes)
    assert expected in doubt


@pytest.mark.parametrize(
    "changes",
    [
        {"structure": "flexible", "time_step_s": 0.15, "duration_s": 1.5},
        {"structure": {"blades": "rigid"}, "time_step_s": 0.18, "duration_s": 1.8},
        {"operation": operation(rotor_speed_rpm=18.0)},  # 1.49 times rated
        {"operation": operation(pitch_deg=-10.0)},
        {"operation": operation(pitch_deg=100.0)},
        {"time_step_s": 0.18, "duration_s": 1.8},
        swinging(1.0, 1.0 / 6.0),
        stopping_at(1.9),
        steady(3.0),
        steady(25.0),
        {"inflow": {"wind_speed_m_s": 40.0}},  # given speed and pitch: a parked turbine, perhaps
    ],
)
def test_what_lies_within_the_limits_is_not_in_doubt(changes):
    assert doubts(**changes) == []


def test_a_slow_rotor_is_in_doubt_by_the_vortex_lattice_alone():
    slow = {"operation": operation(rotor_speed_rpm=3.0)}
    lattice = {"model": "vortex_lattice", "spanwise_panels": 4, "chordwise_panels": 1}
    assert doubts(**slow) == []
    (doubt,) = doubts(**slow, aerodynamics=lattice)
    assert "tips move at 19.77 m/s in a wind of 8 m/s: most sections will stall" in doubt
    assert doubts(aerodynamics=lattice) == []


def test_the_whole_of_a_series_is_looked_at():
    series = {"time_s": [0.0, 1.0], "values": [9.0, 25.0]}
    assert "25 rpm" in doubts(operation=operation(rotor_speed_rpm=series))[0]
