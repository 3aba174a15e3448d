"""Gains from the rotor's own sensitivity, beside the schedule of the NREL 5 MW report."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.control.pitch import PitchGains
from galerna.coupling.gains import (
    doubling_fit,
    optimal_mode_gain,
    power_sensitivity,
    rated_power_of_rotor,
    tuned_gains,
)
from galerna.errors import InputError
from galerna.units import DEG

NREL = turbines.load("nrel5mw")


class PowerLaw:
    """A rotor whose power is known: 3e6 at 12 m/s, growing with wind and falling with pitch."""

    def at(self, wind_speed, rotor_speed, pitch, wake_pitch=None):
        memory = 0.0 if wake_pitch is None else wake_pitch
        power = 6e6 * (wind_speed / 12.0) - 4e6 * (pitch - 0.5 * memory)
        return {"rotor_power": np.array(power)}


def test_sensitivity_is_the_slope_where_power_is_rated() -> None:
    found = power_sensitivity(NREL, PowerLaw(), [12.0, 14.0], "following")
    rated = rated_power_of_rotor(NREL)
    assert found.power == pytest.approx([rated, rated], rel=1e-6)
    assert found.pitch == pytest.approx([(6e6 * v / 12.0 - rated) / 4e6 for v in (12.0, 14.0)])
    assert found.power_by_pitch == pytest.approx([-4e6, -4e6])


def test_schedule_is_that_of_the_report() -> None:
    """NREL/TP-500-38060, section 7.3: -25.52 MW/rad at zero pitch, doubled at 6.30 deg.

    Its gains leave out the driving term of constant power, which adds 9 % to K_P.
    """
    tuning = tuned_gains(NREL, above_rated="constant_torque")
    at_zero, doubled = doubling_fit(tuning.sensitivity)
    assert at_zero == pytest.approx(-25.52e6, rel=0.1)
    assert doubled == pytest.approx(6.302 * DEG, rel=0.15)
    published = PitchGains.of_schedule(NREL.control.pitch_schedule)
    for pitch in (8.0 * DEG, 15.0 * DEG, 22.0 * DEG):
        assert tuning.gains.at(pitch)[:2] == pytest.approx(published.at(pitch)[:2], rel=0.1)


def test_wake_that_follows_takes_from_the_sensitivity() -> None:
    at = [18.0]
    frozen = tuned_gains(NREL, wind_speeds=at).sensitivity
    following = tuned_gains(NREL, wind_speeds=at, wake="following").sensitivity
    assert 0.5 < following.power_by_pitch[0] / frozen.power_by_pitch[0] < 0.9


def test_closed_loop_is_the_wanted_one_and_slower_afloat() -> None:
    ashore = tuned_gains(NREL, wind_speeds=[14.0, 20.0])
    frequency, damping = ashore.closed_loop()
    assert frequency == pytest.approx([0.6, 0.6])
    assert damping == pytest.approx([0.7, 0.7])
    afloat = tuned_gains(turbines.load("nrel5mw_oc3"), wind_speeds=[14.0, 20.0])
    assert afloat.closed_loop()[0] == pytest.approx([0.2, 0.2])
    assert ashore.gains.integral / afloat.gains.integral == pytest.approx([9.0, 9.0], rel=1e-3)


def test_optimal_mode_gain_is_the_published_one() -> None:
    assert optimal_mode_gain(NREL) == pytest.approx(2.332288, rel=0.01)


def test_says_what_it_lacks() -> None:
    light = replace(NREL, blade=replace(NREL.blade, structure=None))
    with pytest.raises(InputError, match="no blade masses"):
        tuned_gains(light, wind_speeds=[18.0])
    with pytest.raises(InputError, match="does not bring rated power"):
        tuned_gains(NREL, wind_speeds=[8.0])
    weak = replace(NREL, control=replace(NREL.control, rated_power=50e6))
    with pytest.raises(InputError, match="does not reach rated power"):
        tuned_gains(weak)
