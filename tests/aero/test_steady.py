"""Steady tools: known points of the NREL 5 MW, consistency between the tools, units."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import (
    efficiency,
    minimum_pitch,
    optimal_tip_speed_ratio,
    power_curve,
    steady_rotor,
)
from galerna.aero.bem.surface import performance_surface
from galerna.errors import InputError
from galerna.units import DEG, RPM


@pytest.fixture(scope="module")
def nrel():
    return turbine.load("nrel5mw")


@pytest.fixture(scope="module")
def axial(nrel):
    """The same rotor without tilt: the wind blows along the shaft."""
    return replace(nrel, nacelle=replace(nrel.nacelle, tilt=0.0))


@pytest.mark.parametrize("name", ["nrel5mw", Path("my_turbine.yaml")])
@pytest.mark.parametrize(
    "tool",
    [
        power_curve,
        lambda t: performance_surface(t, [7.0], [0.0]),
        lambda t: steady_rotor(t, 8.0, 1.0, 0.0),
    ],
    ids=["power_curve", "performance_surface", "steady_rotor"],
)
def test_a_name_in_place_of_a_turbine_is_told_how_to_load_it(tool, name):
    with pytest.raises(InputError, match=rf"galerna\.load_turbine\('{name}'\)"):
        tool(name)


def test_surface_and_point_agree(axial):
    speed, wind, pitch = 9.16 * RPM, 8.0, 2.0 * DEG
    ratio = speed * axial.rotor_radius / wind
    point = steady_rotor(axial, wind, speed, pitch)
    surface = performance_surface(axial, [ratio], [pitch])
    for name in ("power_coefficient", "thrust_coefficient", "torque_coefficient"):
        assert surface[name].item() == pytest.approx(point[name].item(), rel=1e-7)


def test_surface_peaks_where_the_nrel_5mw_does(nrel):
    surface = performance_surface(
        nrel, np.linspace(4.0, 12.0, 33), np.linspace(-5.0, 15.0, 21) * DEG
    )
    best = surface["power_coefficient"]
    at = best.where(best == best.max(), drop=True)
    assert 0.46 < float(best.max()) < 0.50
    assert 7.0 <= at["tip_speed_ratio"].item() <= 8.2
    assert abs(at["pitch"].item()) < 1.5 * DEG
    assert best.attrs["units"] == "1"
    assert best.max() < 16 / 27
    high = surface["thrust_coefficient"].sel(pitch=0.0, method="nearest")
    assert np.all(np.diff(high) > 0.0)  # thrust rises with the tip-speed ratio


def test_spanwise_coefficients_integrate_to_thrust_and_power(axial):
    straight = replace(axial, hub=replace(axial.hub, cone=0.0))
    wind, speed = 8.0, 9.16 * RPM
    point = steady_rotor(straight, wind, speed, 0.0)
    radius = point["radius"].values
    thrust = 3 * np.trapezoid(point["c_out"], radius)
    power = 3 * np.trapezoid(point["c_in"] * radius, radius) * speed / wind
    assert thrust == pytest.approx(point["thrust_coefficient"].item(), rel=1e-9)
    assert power == pytest.approx(point["power_coefficient"].item(), rel=0.01)  # r F is quadratic
    assert point["c_in"].attrs["units"] == "1/m"


def test_power_curve_follows_the_turbines_strategy(nrel):
    winds = np.array([4.0, 8.0, 10.0, 13.0, 20.0])
    curve = power_curve(nrel, winds)
    control = nrel.control
    rated = control.rated_power / efficiency(nrel)
    assert curve["rotor_speed"].values[0] == pytest.approx(control.minimum_rotor_speed)
    ratio = curve["rotor_speed"].values * nrel.rotor_radius / winds
    assert ratio[1] == pytest.approx(control.optimal_tip_speed_ratio)
    assert np.all(curve["rotor_speed"].values[3:] == control.rated_rotor_speed)
    assert np.all(curve["pitch"].values[:3] == control.fine_pitch)
    assert np.all(np.diff(curve["pitch"].values[2:]) > 0.0)
    assert curve["power"].values[3:] == pytest.approx(rated, rel=1e-5)
    assert curve["electrical_power"].values[3:] == pytest.approx(control.rated_power, rel=1e-5)
    power = curve["torque"] * curve["rotor_speed"]
    assert np.allclose(curve["power"], power, rtol=1e-9)
    thrust = curve["thrust"].values
    assert thrust[2] > thrust[3] > thrust[4]


def test_minimum_pitch_table_shaves_the_peak(nrel):
    table = np.array([[9.0, 0.0], [11.0, 4.0 * DEG], [14.0, 4.0 * DEG]])
    shaved = replace(nrel, control=replace(nrel.control, minimum_pitch_table=table))
    assert minimum_pitch(shaved, 10.0) == pytest.approx(2.0 * DEG)
    plain, less = (power_curve(machine, [11.0]) for machine in (nrel, shaved))
    assert less["pitch"].item() == pytest.approx(4.0 * DEG)
    assert less["thrust"].item() < 0.9 * plain["thrust"].item()


def test_optimal_tip_speed_ratio_is_found(nrel):
    assert 7.0 < optimal_tip_speed_ratio(nrel) < 8.2


def test_yaw_costs_power(nrel):
    straight, askew = (
        steady_rotor(nrel, 8.0, 9.16 * RPM, 0.0, yaw_error=angle) for angle in (0.0, 30.0 * DEG)
    )
    ratio = askew["power"].item() / straight["power"].item()
    assert ratio == pytest.approx(np.cos(30.0 * DEG) ** 3, abs=0.06)


def test_options_reach_the_tools(nrel):
    free = BemOptions(tip_loss=False, root_loss=False)
    with_loss, without = (
        performance_surface(nrel, [7.5], [0.0], options=o)["power_coefficient"].item()
        for o in (BemOptions(), free)
    )
    assert without > 1.02 * with_loss


def test_wind_speed_must_be_positive(nrel):
    with pytest.raises(InputError, match="wind_speeds"):
        power_curve(nrel, [-1.0])
