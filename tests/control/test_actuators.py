"""Lags are exact for a held demand, limits hold, and the brake holds still what it can hold."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from galerna.control.actuators import PitchActuator
from galerna.control.brake import Brake
from galerna.errors import InputError

DEMAND = np.array([0.1, 0.2, -0.05])


@pytest.mark.parametrize("damping", [0.0, 0.7, 1.0, 1.8])
def test_the_second_order_lag_is_exact_at_any_step(damping):
    frequency, end = 3.0, 1.2
    exact = solve_ivp(
        lambda t, y: [y[1], frequency**2 * (0.1 - y[0]) - 2.0 * damping * frequency * y[1]],
        (0.0, end), [0.02, 0.0], rtol=1e-11, atol=1e-13,
    ).y[0, -1]  # fmt: skip
    for steps in (1, 7, 60):
        actuator = PitchActuator(frequency=frequency, damping_ratio=damping)
        pitch = np.array([0.02])
        for _ in range(steps):
            pitch = actuator.after(pitch, np.array([0.1]), end / steps)
        assert pitch[0] == pytest.approx(exact, abs=1e-9)


def test_the_first_order_lag_is_exact_at_any_step():
    for steps in (1, 9):
        actuator, pitch = PitchActuator(0.3), np.zeros(3)
        for _ in range(steps):
            pitch = actuator.after(pitch, DEMAND, 0.6 / steps)
        assert pitch == pytest.approx(DEMAND * (1.0 - np.exp(-2.0)), rel=1e-12)


@pytest.mark.parametrize("options", [{}, {"time_constant": 0.2}, {"frequency": 20.0}])
def test_no_actuator_breaks_its_limits(options):
    actuator = PitchActuator(lowest=-0.02, highest=0.15, rate=0.1, **options)
    pitch, dt = np.zeros(3), 0.02
    for _ in range(400):
        after = actuator.after(pitch, DEMAND, dt)
        assert np.abs(after - pitch).max() <= 0.1 * dt + 1e-15
        pitch = after
    assert pitch == pytest.approx([0.1, 0.15, -0.02], abs=1e-6)


@pytest.mark.parametrize("options", [{}, {"time_constant": 0.2}, {"frequency": 20.0}])
@pytest.mark.parametrize("demand", [0.1, 0.3])
def test_a_blade_beyond_its_limits_comes_back_at_the_rate(options, demand):
    actuator = PitchActuator(lowest=-0.02, highest=0.15, rate=0.1, **options)
    pitch, dt = np.array([0.2]), 0.02
    for _ in range(200):
        after = actuator.after(pitch, np.array([demand]), dt)
        assert np.abs(after - pitch).max() <= 0.1 * dt + 1e-15
        pitch = after
    assert pitch == pytest.approx([min(demand, 0.15)], abs=1e-6)


def test_an_overdamped_lag_may_be_as_stiff_as_it_likes():
    actuator = PitchActuator(frequency=1000.0, damping_ratio=5.0)
    slow = 1000.0 * (5.0 - np.sqrt(24.0))  # rad/s, of the two decays
    after = actuator.after(np.zeros(1), np.array([0.1]), 0.05)
    assert after[0] == pytest.approx(0.1 * (1.0 - np.exp(-slow * 0.05)), rel=0.02)
    assert actuator.after(np.zeros(1), np.array([0.1]), 1.0)[0] == pytest.approx(0.1)


def test_the_second_order_lag_resumes_with_its_speed():
    one, other = (PitchActuator(frequency=2.0) for _ in range(2))
    pitch = one.after(np.zeros(3), DEMAND, 0.1)
    other.restore(one.state())
    assert np.array_equal(one.after(pitch, DEMAND, 0.1), other.after(pitch, DEMAND, 0.1))


@pytest.mark.parametrize(
    "options",
    [{"time_constant": -1.0}, {"rate": 0.0}, {"lowest": 1.0, "highest": 0.5},
     {"frequency": 0.0}, {"frequency": 1.0, "time_constant": 0.1}, {"damping_ratio": -0.1}],
)  # fmt: skip
def test_impossible_actuators_are_refused(options):
    with pytest.raises(InputError, match="pitch_actuator"):
        PitchActuator(**options)


@pytest.mark.parametrize("inertia", [1.0, 30.0])
def test_the_brake_stops_a_rotor_and_holds_it_against_a_torque(inertia):
    """Of the inertia it was made for and of a larger one: down by friction, then still."""
    brake, speed, dt = Brake(1.0), 2.0, 0.02
    speeds = []
    for _ in range(round(10.0 * inertia / dt)):
        speed += dt / inertia * (0.4 - brake.torque(1.0, speed, dt))
        speeds.append(speed)
    assert speeds[round(inertia / dt)] == pytest.approx(2.0 - 0.6, abs=0.05)
    assert np.abs(speeds[-100:]).max() < 1e-9


def test_a_brake_that_is_too_weak_slips_with_its_full_torque():
    brake, speed, dt = Brake(1.0), 0.0, 0.01
    for _ in range(1000):
        speed += dt * (1.5 - brake.torque(1.0, speed, dt))
    assert speed == pytest.approx(0.5 * 10.0, rel=0.02)
    assert brake.torque(0.0, speed, dt) == 0.0
