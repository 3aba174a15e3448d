"""Individual pitch and yaw control on the load and the wind they are made for."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.control.baseline import BaselineController, BaselineSettings
from galerna.control.individual_pitch import (
    IndividualPitch,
    IndividualPitchSettings,
    blade_azimuths,
    to_blades,
    to_rotor,
)
from galerna.control.interface import Measurements
from galerna.control.yawing import YawControl, YawSettings, wrapped
from galerna.errors import InputError
from galerna.turbine import load
from galerna.units import DEG

SLOPE = 2e7  # N m/rad, that pitch takes off a root


@pytest.mark.parametrize("blades", [3, 4])
def test_the_coleman_transform_and_back(blades):
    parts = np.array([0.3, -1.2])
    on_blades = to_blades(parts, 0.7, blades) + 5.0  # a common part stays out
    assert to_rotor(on_blades, 0.7) == pytest.approx(parts)


def loaded(control: IndividualPitch, above: float = 1.0, lag: float = 0.0) -> np.ndarray:
    """Root moments (n,3) N m over time of a rotor in a shear, whose blades lag by an angle."""
    dt, moments = 0.05, []
    for i in range(1600):
        azimuth = 1.2 * i * dt
        around = blade_azimuths(azimuth, 3)
        moment = 8e6 + 1.5e6 * np.cos(around) - 0.4e6 * np.sin(around)
        tilt, yaw = control.integral
        delayed = to_blades(np.array([tilt, yaw]), azimuth - lag + control.settings.azimuth_offset,
                            3)  # fmt: skip
        moment -= SLOPE * delayed
        control(moment, azimuth, above, dt)
        moments.append(moment)
    return np.array(moments)


def test_a_sheared_load_goes_with_its_time_constant():
    time = 5.0
    control = IndividualPitch(IndividualPitchSettings(1.0 / (time * SLOPE)))
    moments = loaded(control)
    assert np.ptp(moments[-200:, 0]) < 1e-3 * np.ptp(moments[:105, 0])
    assert control.integral == pytest.approx([1.5e6 / SLOPE, -0.4e6 / SLOPE], rel=1e-3)


def test_the_azimuth_offset_makes_up_for_a_lag():
    gain = 1.0 / (5.0 * SLOPE)
    late = IndividualPitch(IndividualPitchSettings(gain))
    offset = IndividualPitch(IndividualPitchSettings(gain, azimuth_offset=1.0))
    slow, quick = loaded(late, lag=1.0), loaded(offset, lag=1.0)
    part = slice(200, 300)
    assert np.ptp(quick[part, 0]) < 0.8 * np.ptp(slow[part, 0])


def test_it_fades_at_the_lowest_pitch_and_keeps_its_amplitude():
    settings = IndividualPitchSettings(1.0 / SLOPE, amplitude=1.0 * DEG)
    free, faded = IndividualPitch(settings), IndividualPitch(settings)
    loaded(free)
    loaded(faded, above=0.0)
    assert np.hypot(*free.integral) == pytest.approx(1.0 * DEG)
    assert faded.integral == pytest.approx([0.0, 0.0])


def test_a_stop_leaves_nothing_of_it_to_begin_with_again():
    """Angles of before a stop would come back at once, whatever the wind is by then."""
    events = ((10.0, "idling"), (20.0, "production"))
    blades = IndividualPitchSettings(1e-8)
    options = BaselineSettings(events=events, individual_pitch=blades)
    controller, spread = BaselineController(load("nrel5mw"), options), []
    for time in np.arange(0.0, 20.05, 0.1):
        now = Measurements(time, 1.27, 122.9, 4e4, 5e6, np.full(3, 0.2), 0.0)
        now.root_moments[0, 0] = 1e6 if time < 10.0 else 0.0
        spread.append(np.ptp(controller.demands(now).pitch))
    assert spread[90] > 2.0 * DEG
    assert max(spread[102:]) < 1e-9


def turning(control: YawControl, wind: float, seconds: float, dt: float = 0.5):
    """Yaw (n,) of a nacelle that follows at once, in a wind from one side."""
    yaw, path = 0.0, []
    for _ in range(round(seconds / dt)):
        yaw += control(yaw - wind, dt) * dt
        path.append(yaw)
    return np.array(path)


@pytest.mark.parametrize("wind", [20.0 * DEG, -20.0 * DEG])
def test_the_nacelle_turns_into_the_wind_at_its_rate(wind):
    settings = YawSettings(rate=0.5 * DEG, dead_band=5.0 * DEG, averaging=0.0)
    path = turning(YawControl(settings), wind, 200.0)
    assert path[-1] == pytest.approx(wind, abs=0.5 * DEG)
    assert np.abs(np.diff(path)).max() <= 0.25 * DEG * (1 + 1e-9)


def test_small_errors_and_gusts_leave_it_alone():
    settings = YawSettings(dead_band=8.0 * DEG, averaging=60.0)
    assert np.all(turning(YawControl(settings), 7.9 * DEG, 600.0) == 0.0)
    control = YawControl(settings)
    rates = [control(0.3 * np.sin(2.0 * np.pi * t / 20.0), 0.5) for t in np.arange(0, 300, 0.5)]
    assert not any(rates)


def test_the_yaw_error_is_nacelle_minus_wind():
    """Nacelle turned to the left, +z: the way back is to the right."""
    control = YawControl(YawSettings(averaging=0.0))
    assert control(+20.0 * DEG, 0.1) < 0.0
    assert wrapped(350.0 * DEG) == pytest.approx(-10.0 * DEG)


def test_impossible_settings_are_refused():
    with pytest.raises(InputError, match="yaw"):
        YawSettings(rate=0.0)
    with pytest.raises(InputError, match="individual_pitch"):
        IndividualPitchSettings(-1.0)
