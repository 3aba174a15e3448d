"""The steady flexible rotor: what bending and twist do to loads and power."""

from __future__ import annotations

import pytest

from galerna import turbine as turbines
from galerna.aero.bem.steady import steady_rotor
from galerna.cli import main
from galerna.coupling.gains import power_sensitivity
from galerna.coupling.steady import FlexibleRotor, steady_flexible, stiffened
from galerna.errors import InputError
from galerna.units import DEG, RPM

NREL = turbines.load("nrel5mw")
SPEED, PITCH, WIND = 12.1 * RPM, 15.0 * DEG, 18.0


def at_15_deg(**more):
    return steady_flexible(NREL, [WIND], rotor_speed=SPEED, pitch=PITCH, **more).isel(wind_speed=0)


def test_rigid_blades_are_the_rigid_rotor() -> None:
    rigid, reference = at_15_deg(blades="rigid"), steady_rotor(NREL, WIND, SPEED, PITCH)
    for name in ("power", "thrust", "power_coefficient"):
        assert float(rigid[name]) == pytest.approx(float(reference[name]), rel=3e-3)
    assert rigid["c_out"].values == pytest.approx(reference["c_out"].values, abs=2e-6)
    assert float(rigid["tip_twist"]) == pytest.approx(0.0, abs=1e-9)


def test_twist_to_feather_unloads_and_stiff_torsion_does_not() -> None:
    rigid, flexible, stiff = at_15_deg(blades="rigid"), at_15_deg(), at_15_deg(torsion=100.0)
    drop = 1.0 - flexible["root_out_of_plane_moment"] / rigid["root_out_of_plane_moment"]
    assert 0.2 < float(drop) < 0.4
    assert 1.0 * DEG < float(flexible["tip_twist"]) < 3.0 * DEG
    assert abs(float(stiff["tip_twist"])) < 0.05 * DEG
    assert float(stiff["power"]) == pytest.approx(float(rigid["power"]), rel=0.03)
    assert float(stiff["tip_out_of_plane"]) > float(flexible["tip_out_of_plane"]) > 0.0


def test_deflections_are_those_of_the_tip_and_with_the_driving_force() -> None:
    flexible = at_15_deg()
    assert float(flexible["out_of_plane"][-1]) == pytest.approx(float(flexible["tip_out_of_plane"]))
    assert float(flexible["tip_in_plane"]) > 0.0  # c_in drives the rotor
    assert flexible["twist"].values[0] == pytest.approx(0.0, abs=0.02 * DEG)


def test_rated_power_takes_less_pitch() -> None:
    rigid, flexible = (
        steady_flexible(NREL, [WIND], blades=blades).isel(wind_speed=0)
        for blades in ("rigid", "flexible")
    )
    assert float(rigid["power"]) == pytest.approx(float(flexible["power"]), rel=1e-4)
    less = (float(rigid["pitch"]) - float(flexible["pitch"])) / DEG
    assert 0.5 < less < 1.0


def test_frozen_wake_answers_more_than_one_that_follows() -> None:
    rotor = FlexibleRotor(NREL)
    frozen, following = (
        power_sensitivity(NREL, rotor, [WIND], wake).power_by_pitch[0]
        for wake in ("frozen", "following")
    )
    assert frozen < following < 0.0


def test_refuses_what_cannot_be() -> None:
    with pytest.raises(InputError, match="neither 'flexible' nor"):
        FlexibleRotor(NREL, blades="soft")
    with pytest.raises(InputError, match="not a positive factor"):
        stiffened(NREL, 0.0)
    with pytest.raises(InputError, match="must be positive"):
        steady_flexible(NREL, [0.0])
    torsional = [t.blade.structure.stiffness[:, 5, 5] for t in (stiffened(NREL, 4.0), NREL)]
    assert torsional[0] == pytest.approx(4.0 * torsional[1])


def test_power_curve_is_printed_with_the_bending(tmp_path, capsys) -> None:
    file = tmp_path / "curve.csv"
    with pytest.raises(SystemExit) as ended:
        main(["power-curve", "nrel5mw", "--flexible", "--step", "11", "--csv", str(file)])
    assert not ended.value.code
    assert "tip twist [deg]" in capsys.readouterr().out
    header, *rows = file.read_text().splitlines()
    assert "tip_out_of_plane [m]" in header
    assert len(rows) == 3
