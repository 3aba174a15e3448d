"""IEC 61400-1 transient events, against the standard's equations worked out by hand."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.inflow.gusts import (
    ExtremeCoherentGust,
    ExtremeDirectionChange,
    ExtremeOperatingGust,
    ExtremeWindShear,
    WithGust,
)
from galerna.inflow.mean import HubWind, Steady

# Hub speed 12 m/s, class IB, rotor of 126 m at 90 m: sigma_1 = 0.14 (0.75 * 12 + 5.6) = 2.044 m/s,
# Lambda_1 = 42 m, sigma_1 / (1 + 0.1 * 126 / 42) = 1.572308 m/s.
WIND = HubWind(12.0, direction=0.1, gust=0.5)
EVENTS = {
    "EOG": ExtremeOperatingGust.iec(12.0, 90.0, 126.0, "I", "B"),
    "EDC": ExtremeDirectionChange.iec(12.0, 90.0, 126.0, "B"),
    "ECD": ExtremeCoherentGust.iec(12.0),
    "EWS": ExtremeWindShear.iec(12.0, 90.0, 126.0, "B", "vertical"),
}


def test_operating_gust_dips_rises_and_ends_where_it_began():
    gust = EVENTS["EOG"]
    assert gust.amplitude == pytest.approx(3.3 * 1.572308, rel=1e-6)
    change = [gust.on(WIND, s * 10.5).gust - 0.5 for s in (1 / 6, 0.5, 5 / 6, 1.0, 2.0)]
    wanted = gust.amplitude * np.array([-0.185, 0.74, -0.185, 0.0, 0.0])
    np.testing.assert_allclose(change, wanted, atol=1e-12)


def test_operating_gust_is_limited_by_the_yearly_extreme():
    assert ExtremeOperatingGust.iec(54.0, 90.0, 126.0, "I", "A").amplitude == pytest.approx(2.7)
    with pytest.raises(InputError, match="yearly extreme"):
        ExtremeOperatingGust.iec(45.0, 90.0, 126.0, "III", "A")


def test_direction_change_stays():
    angle = EVENTS["EDC"].angle
    assert angle == pytest.approx(4 * np.arctan(1.572308 / 12), rel=1e-6)
    turned = [EVENTS["EDC"].on(WIND, t).direction - 0.1 for t in (3.0, 6.0, 60.0)]
    np.testing.assert_allclose(turned, [angle / 2, angle, angle])
    assert ExtremeDirectionChange.iec(12.0, 90.0, 126.0, "B", sign=-1).angle == -angle


def test_coherent_gust_rises_by_15_and_turns_by_720_over_the_speed():
    end = EVENTS["ECD"].on(WIND, 10.0)
    assert end.gust - 0.5 == pytest.approx(15.0)
    assert np.degrees(end.direction - 0.1) == pytest.approx(60.0)
    assert np.degrees(ExtremeCoherentGust.iec(3.0).angle) == pytest.approx(180.0)


def test_wind_shear_is_largest_midway_and_vanishes_at_the_end():
    gradient = (2.5 + 0.2 * 6.4 * 2.044 * 3.0**0.25) / 126.0
    assert EVENTS["EWS"].on(WIND, 6.0).vertical_gradient == pytest.approx(2 * gradient)
    assert EVENTS["EWS"].on(WIND, 12.0) == WIND
    sideways = ExtremeWindShear.iec(12.0, 90.0, 126.0, "B", "horizontal", sign=-1).on(WIND, 6.0)
    assert sideways.lateral_gradient == pytest.approx(-2 * gradient)
    assert sideways.vertical_gradient == 0.0


@pytest.mark.parametrize("name", EVENTS)
def test_event_begins_at_its_start_without_a_jump(name):
    course = WithGust(Steady(WIND), EVENTS[name], start=20.0)
    assert course.at(0.0) == course.at(20.0) == WIND
    np.testing.assert_allclose(course.at(20.0 + 1e-6), WIND, atol=1e-5)
    end = 20.0 + EVENTS[name].period
    np.testing.assert_allclose(course.at(end - 1e-7), course.at(end + 1e-7), atol=1e-5)


def test_amplitudes_grow_with_the_turbulence_class():
    amplitudes = [
        ExtremeOperatingGust.iec(12.0, 90.0, 126.0, "I", name).amplitude
        for name in ("C", "B", "A", "A+")
    ]
    assert amplitudes == sorted(amplitudes)
