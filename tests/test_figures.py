"""Figures of a turbine that take a solver, against publications and against the power curve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.aero.bem.steady import power_curve
from galerna.commands import show_turbine
from galerna.errors import InputError
from galerna.figures import frequencies, rated_point
from galerna.turbine.summary import summary

#: NREL/TP-500-38060, Table 9-1, parked: Hz by ADAMS, the model with flexible beams
ADAMS = {
    "tower_fore_aft_1": 0.3195,
    "tower_side_side_1": 0.3164,
    "drivetrain_1": 0.6094,
    "blade_flap_yaw_1": 0.6296,
    "blade_flap_pitch_1": 0.6686,
    "blade_flap_collective_1": 0.7019,
    "blade_edge_pitch_1": 1.0740,
    "blade_edge_yaw_1": 1.0877,
    "blade_flap_yaw_2": 1.6507,
    "blade_flap_pitch_2": 1.8558,
    "blade_flap_collective_2": 1.9601,
    "tower_fore_aft_2": 2.8590,
    "tower_side_side_2": 2.9408,
}


def test_the_rated_point_of_the_nrel_5_mw_is_the_reports() -> None:
    """NREL/TP-500-38060, Tables 1-1, 5-1 and 7-2."""
    found = rated_point(turbines.load("nrel5mw"))
    assert found["rated_wind_speed"] == pytest.approx(11.4, rel=0.01)
    assert found["rated_rotor_speed"] == pytest.approx(12.1)
    assert found["rated_tip_speed"] == pytest.approx(80.0, rel=0.005)
    assert found["rated_generator_torque"] == pytest.approx(43093.55, rel=1e-5)
    assert found["peak_power_coefficient"] == pytest.approx(0.482, rel=0.005)
    assert found["optimal_tip_speed_ratio"] == pytest.approx(7.55, abs=0.15)


@pytest.mark.parametrize("name", ["dtu10mw", "iea15mw", "nrel5mw"])
def test_the_power_curve_bends_at_the_rated_point(name: str) -> None:
    turbine = turbines.load(name)
    found, rated = rated_point(turbine), turbine.control.rated_power
    winds = found["rated_wind_speed"] + np.array([-0.05, 0.0, 0.05])
    curve = power_curve(turbine, winds)
    before, there, after = curve["electrical_power"].values
    assert before < 0.995 * rated
    assert [there, after] == pytest.approx([rated, rated], rel=1e-5)
    assert curve["rotor_speed"].values[1] * 30 / np.pi == pytest.approx(found["rated_rotor_speed"])
    shaft = found["rated_generator_torque"] * found["rated_generator_speed"] * np.pi / 30
    assert shaft * turbine.drivetrain.generator_efficiency == pytest.approx(rated)


def test_a_rotor_that_never_gives_rated_power_has_no_rated_wind_speed() -> None:
    turbine = turbines.load("nrel5mw")
    weak = replace(turbine, control=replace(turbine.control, rated_power=1e9))
    assert set(rated_point(weak)) == {"optimal_tip_speed_ratio", "peak_power_coefficient"}
    idle = replace(turbine.control, rated_power=1.0, minimum_rotor_speed=0.0)
    tiny = replace(turbine, control=idle)
    assert "rated_wind_speed" not in rated_point(tiny)
    unknown = replace(turbine, control=replace(turbine.control, rated_power=0.0))
    assert rated_point(unknown) == {}


def test_frequencies_come_near_the_published_ones() -> None:
    """Within 4 %: the report states no shear stiffness and no weight for its own."""
    turbine = turbines.load("nrel5mw")
    found = frequencies(turbine)
    for name, published in ADAMS.items():
        assert found[f"frequency_{name}"] == pytest.approx(published, rel=0.04), name
    rows = [r for r in summary(turbine, found) if r.quantity.startswith("frequency_")]
    assert len(rows) == len(ADAMS)
    assert all(row.difference is not None for row in rows)


def test_without_published_frequencies_none_are_computed() -> None:
    assert frequencies(turbines.load("dtu10mw")) == {}


def test_the_table_shows_computed_beside_published(capsys: pytest.CaptureFixture[str]) -> None:
    show_turbine("iea15mw")
    lines = {line.split()[0]: line.split() for line in capsys.readouterr().out.splitlines()[1:]}
    assert float(lines["rated_wind_speed"][2]) == pytest.approx(10.59, rel=0.01)
    assert lines["rated_wind_speed"][3] == "10.59"
    assert float(lines["peak_power_coefficient"][2]) == pytest.approx(0.487, abs=0.005)


def test_what_the_reader_decided_and_what_failed_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from galerna import figures

    def fail(turbine: object) -> dict[str, float]:
        raise InputError("polar", "is torn")

    noted = replace(turbines.load("nrel5mw"), notes=("tower: counts as rigid",))
    monkeypatch.setattr(turbines, "load", lambda name: noted)
    monkeypatch.setattr(figures, "rated_point", fail)
    monkeypatch.setattr(figures, "frequencies", fail)
    show_turbine("any")
    out, err = capsys.readouterr()
    assert "note: tower: counts as rigid" in out
    assert "blade_mass" in out
    assert "not computed: polar: is torn" in err
