"""Torque curve, pitch loop, actuators and gain design against the NREL 5 MW report."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.control.actuators import PitchActuator
from galerna.control.baseline import BaselineController, BaselineSettings
from galerna.control.interface import Measurements
from galerna.control.pitch import CollectivePitch, LowPass, PitchGains
from galerna.control.torque import torque_curve
from galerna.control.tuning import Sensitivity, closed_loop, pitch_gains
from galerna.errors import InputError
from galerna.units import DEG, RPM

NREL = turbines.load("nrel5mw")
# NREL/TP-500-38060, Table 7-1: pitch deg, dP/dpitch W/rad, at 12.1 rpm
REPORT = np.array([[0.0, -25.52e6], [10.45, -66.44e6], [23.47, -125.3e6]])
INERTIA = 43_784_725.0  # kg m2, the report's drivetrain inertia at the low-speed shaft


def measured(time: float, speed: float, pitch: float, torque: float = 40e3) -> Measurements:
    return Measurements(time, speed / 97.0, speed, torque, 5e6, np.full(3, pitch), 0.0)


def report_sensitivity() -> Sensitivity:
    pitch, slope = REPORT.T.copy()
    wind = np.array([11.4, 17.0, 25.0])
    return Sensitivity(wind, pitch * DEG, np.full(3, 5.296610e6), slope, 12.1 * RPM)


def test_torque_has_the_regions_of_the_report() -> None:
    curve = torque_curve(NREL.control, NREL.drivetrain)
    assert curve.rated == pytest.approx(1161.963 * RPM, rel=1e-5)
    assert curve.power == pytest.approx(5.296610e6, rel=1e-6)
    assert curve.torque(1000.0 * RPM) == pytest.approx(0.0255764 * 1000.0**2, rel=1e-5)
    assert curve.torque(1200.0 * RPM) == pytest.approx(5.296610e6 / (1200.0 * RPM), rel=1e-6)
    assert curve.torque(600.0 * RPM) == 0.0


@pytest.mark.parametrize("name", ["nrel5mw", "dtu10mw", "iea15mw"])
def test_torque_never_jumps_or_falls_below_rated(name: str) -> None:
    turbine = turbines.load(name)
    curve = torque_curve(turbine.control, turbine.drivetrain)
    speed = np.linspace(0.5 * curve.cut_in, curve.rated, 4001)
    torque = np.array([curve.torque(w) for w in speed])
    assert np.all(np.diff(torque) >= 0.0)
    assert np.diff(torque).max() < 0.02 * curve.rated_torque
    assert torque[-1] == pytest.approx(curve.rated_torque, rel=1e-6)


def test_a_constant_torque_is_that_of_the_rated_speed() -> None:
    """NREL/TP-500-47535: 43,093.55 N m, and so rated power at rated speed."""
    curve = torque_curve(NREL.control, NREL.drivetrain, "constant_torque")
    for speed in (1170.0, 1300.0):
        assert curve.torque(speed * RPM) == pytest.approx(43093.55, rel=1e-5)
    below = [curve.torque(share * curve.rated) for share in (1.0 - 1e-9, 1.0)]
    assert below[0] == pytest.approx(below[1], rel=1e-6)


def test_pitched_blades_hold_region_three() -> None:
    curve = torque_curve(NREL.control, NREL.drivetrain)
    speed = 0.97 * curve.rated
    assert curve.torque(speed, region_3=1.0) == pytest.approx(curve.power / speed)


def test_gains_without_the_generators_slope_are_the_reports() -> None:
    gains = pitch_gains(report_sensitivity(), INERTIA, 97.0, above_rated="constant_torque")
    assert gains.proportional[0] == pytest.approx(0.01882681, rel=1e-3)
    assert gains.integral[0] == pytest.approx(0.008068634, rel=1e-3)


@pytest.mark.parametrize("above_rated", ["constant_power", "constant_torque"])
def test_gains_give_the_frequency_and_damping_asked_for(above_rated: str) -> None:
    sensitivity = report_sensitivity()
    gains = pitch_gains(
        sensitivity, INERTIA, 97.0, natural_frequency=0.2, damping_ratio=1.1,
        above_rated=above_rated, derivative=0.01,
    )  # fmt: skip
    frequency, damping = closed_loop(gains, sensitivity, INERTIA, 97.0, above_rated)
    assert frequency == pytest.approx(0.2)
    assert damping == pytest.approx(1.1)


def test_power_that_grows_with_pitch_is_refused() -> None:
    wrong = report_sensitivity()
    wrong.power_by_pitch[1] *= -1.0
    with pytest.raises(InputError, match=r"10\.45 deg"):
        pitch_gains(wrong, INERTIA, 97.0)


def test_the_loop_on_a_rigid_rotor_oscillates_as_designed() -> None:
    """I w' = dP/dpitch / W * pitch: after a gust the speed follows exp(-z w t) cos(...)."""
    sensitivity = report_sensitivity()
    gains = pitch_gains(sensitivity, INERTIA, 97.0, above_rated="constant_torque")
    start, dt = 10.45 * DEG, 0.002
    still = PitchGains(*(np.full(2, v[1]) for v in vars(gains).values()))
    loop = CollectivePitch(still, 97.0 * 12.1 * RPM, 1.5)
    loop.start(start)
    slope = sensitivity.power_by_pitch[1] / sensitivity.rotor_speed / INERTIA
    error, crossing, path = 0.05, np.nan, []
    for i in range(20000):
        pitch = loop.hold_speed(97.0 * (12.1 * RPM + error), 0.0, dt)
        error += dt * slope * (pitch - start)
        path.append(error)
        if np.isnan(crossing) and error < 0.0:
            crossing = i * dt
    damped = 0.6 * np.sqrt(1.0 - 0.7**2)
    # x' starts at 0.05 with zero integral: x' = e^(-zwt) (cos - z w / wd sin)
    assert crossing == pytest.approx(np.arctan2(damped, 0.7 * 0.6) / damped, rel=0.01)
    assert abs(path[-1]) < 1e-6


def test_pitch_does_not_wind_up() -> None:
    loop = CollectivePitch(PitchGains.of_schedule(NREL.control.pitch_schedule), 122.9, 1.5)
    for _ in range(1000):
        assert loop.hold_speed(80.0, 0.0, 0.1) == 0.0
    assert loop.hold_speed(124.0, 0.0, 0.1) > 0.0


def test_pitch_at_its_fastest_does_not_wind_up_and_turns_back_at_once() -> None:
    gains = PitchGains.of_schedule(NREL.control.pitch_schedule)
    loop, dt, rate = CollectivePitch(gains, 122.9, 1.5, rate=0.02), 0.05, 0.02
    rising = [loop.hold_speed(122.9 + 15.0, 0.0, dt) for _ in range(100)]
    assert np.diff(rising) == pytest.approx(rate * dt)
    assert loop.integral <= rising[-1]
    falling = [loop.hold_speed(122.9 - 5.0, 0.0, dt) for _ in range(20)]
    assert np.diff([rising[-1], *falling]) == pytest.approx(-rate * dt)


def test_the_derivative_acts_on_the_filtered_speed() -> None:
    still = [np.array([0.0, 1.0]), np.zeros(2), np.zeros(2), np.full(2, 0.01)]
    loop = CollectivePitch(PitchGains(*still), 100.0, 1.5)
    loop.start(0.5)
    assert loop.hold_speed(101.0, 0.0, 0.1) == pytest.approx(0.5)
    assert loop.hold_speed(103.0, 0.0, 0.1) == pytest.approx(0.5 + 0.01 * 20.0)


def test_filter_has_its_corner() -> None:
    low, dt, corner = LowPass(1.5), 0.001, 1.5
    out = [low(np.sin(corner * i * dt), dt) for i in range(40000)]
    assert np.max(out[-10000:]) == pytest.approx(1 / np.sqrt(2), rel=2e-3)


def test_actuator_keeps_its_limits() -> None:
    actuator = PitchActuator(0.1, 0.0, 1.5, 0.14)
    pitch = np.zeros(3)
    for _ in range(10):
        pitch = actuator.after(pitch, np.array([1.0, -1.0, 0.001]), 0.1)
    assert pitch == pytest.approx([0.14, 0.0, 0.001], abs=1e-6)


def test_an_emergency_stop_feathers_without_torque() -> None:
    options = BaselineSettings(events=((5.0, "emergency_stop"),))
    controller = BaselineController(NREL, options)
    before = controller.demands(measured(4.9, 122.9, 0.2))
    after = controller.demands(measured(5.0, 122.9, 0.2))
    assert before.generator_torque > 40e3
    assert after.generator_torque == 0.0
    assert after.pitch == pytest.approx(0.2 + 0.1 * NREL.control.maximum_pitch_rate)


def test_a_controller_resumes_with_the_same_demands() -> None:
    one, other = BaselineController(NREL), BaselineController(NREL)
    for i in range(20):
        one.demands(measured(0.1 * i, 122.9 + np.sin(i), 0.2))
    other.restore(one.state())
    ahead = measured(2.0, 124.0, 0.21)
    assert other.demands(ahead).pitch == pytest.approx(one.demands(ahead).pitch, abs=0.0)


def test_an_unknown_mode_is_named() -> None:
    with pytest.raises(InputError, match="emergency_stop"):
        BaselineController(NREL, BaselineSettings(events=((1.0, "emergency"),)))
