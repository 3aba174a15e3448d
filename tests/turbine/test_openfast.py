"""OpenFAST decks in: values, units, signs, spellings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_deck import FILES, edit, write_deck

from galerna.turbine import load
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Turbine
from galerna.turbine.openfast.elastodyn import RIGID
from galerna.turbine.unsteady import fit

DEG = np.pi / 180.0


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    return write_deck(tmp_path)


def use_beamdyn(deck: Path) -> None:
    edit(deck, "small.fst", '"NA"              BDBldFile(1)', '"parts/bd.dat" BDBldFile(1)')
    edit(deck, "small.fst", "1   CompElast", "2   CompElast")


def same(a: Turbine, b: Turbine) -> None:
    """Every number that a deck decides is the same."""
    for part in ("nacelle", "drivetrain", "hub"):
        assert getattr(a, part).__dict__ == getattr(b, part).__dict__
    for field in ("span", "chord", "twist", "leading_edge_offset", "normal_offset"):
        assert_allclose(getattr(a.blade.shape, field), getattr(b.blade.shape, field), atol=1e-12)
    assert a.blade.structure is not None
    assert b.blade.structure is not None
    assert_allclose(a.blade.structure.stiffness, b.blade.structure.stiffness)
    assert_allclose(a.blade.structure.inertia, b.blade.structure.inertia)
    for name, foil in a.airfoils.items():
        assert_allclose(foil.polars[0].lift, b.airfoils[name].polars[0].lift)
        assert foil.unsteady == b.airfoils[name].unsteady
    assert a.control.rated_torque == b.control.rated_torque


def test_signs_and_units_of_the_configuration(deck: Path) -> None:
    turbine = load(deck)
    assert turbine.nacelle.overhang == 5.0191
    assert_allclose(turbine.nacelle.tilt, 5 * DEG)
    assert_allclose(turbine.hub.cone, 2.5 * DEG)
    assert_allclose(turbine.hub_height, 90.0, atol=1e-4)
    assert_allclose(turbine.rotor_radius, 63.0 * np.cos(2.5 * DEG))
    assert turbine.nacelle.yaw_stiffness == 9.02832e9
    assert turbine.drivetrain.generator_efficiency == pytest.approx(0.944)
    assert turbine.number_of_blades == 3
    assert turbine.platform is None


def test_blade_shape(deck: Path) -> None:
    blade = load(deck).blade
    assert_allclose(blade.axis[-1], [0.0, 0.0, 61.5])
    assert_allclose(blade.shape.span, [0.0, 0.25, 0.5, 0.75, 1.0])
    assert_allclose(blade.shape.twist[0], 13.308 * DEG)
    assert blade.shape.airfoil_names == ("round", "wing", "wing", "wing", "wing")
    assert_allclose(blade.shape.leading_edge_offset, 0.25 * blade.shape.chord)


def test_aerodynamic_centres_beside_the_pitch_axis(deck: Path) -> None:
    """Centres 0.4 m ahead of the pitch axis along the chord, with 2 m of upwind prebend."""
    twist = 6.544 * DEG
    x, y = -2.0 - 0.4 * np.sin(twist), -0.4 * np.cos(twist)
    old = "30.7500E+00    0.0000E+00     0.0000E+00"
    edit(deck, "parts/ad_blade.dat", old, f"30.7500E+00    {x:.8f}     {y:.8f}")
    turbine = load(deck)
    blade = turbine.blade
    assert_allclose(blade.axis[2], [-2.0, 0.0, 30.75], atol=1e-6)
    assert_allclose(blade.shape.leading_edge_offset[2], 0.25 * 3.748 + 0.4, atol=1e-6)
    assert_allclose(blade.shape.normal_offset, 0.0, atol=1e-6)
    assert any("prebend" in note for note in turbine.notes)
    origin, axes = blade_frames(blade, blade.shape.span[2:3])
    behind_nose = 0.25 * 3.748 - blade.shape.leading_edge_offset[2]
    assert_allclose(origin[0] + behind_nose * axes[0, :, 1], [x, y, 30.75], atol=1e-2)


def test_polar_and_published_unsteady_parameters(deck: Path) -> None:
    wing = load(deck).airfoils["wing"]
    polar = wing.polars[0]
    assert polar.reynolds == 0.75e6
    assert_allclose(polar.angle_of_attack[[0, -1]], [-np.pi, np.pi])
    assert_allclose(np.interp(0.0, polar.angle_of_attack, polar.moment), -0.116)
    unsteady = wing.unsteady
    assert unsteady.origin == "published"
    assert_allclose(unsteady.zero_lift_angle, -4.432 * DEG)
    assert_allclose(unsteady.separation_angles, (9 * DEG, -9 * DEG))
    assert unsteady.critical_normal_force == (1.4073, -0.7945)
    assert (unsteady.pressure_lag, unsteady.separation_lag) == (1.5, 3.0)


def test_parameters_left_to_be_calculated_are_fitted(deck: Path) -> None:
    edit(deck, "parts/foils/wing.dat", "-4.432   alpha0", "Default  alpha0")
    wing = load(deck).airfoils["wing"]
    assert wing.unsteady == fit(wing.polars[0])
    assert "fitted" in wing.unsteady.origin


def test_outline_is_turned_to_the_suction_side_first(deck: Path) -> None:
    wing, round_ = (load(deck).airfoils[name] for name in ("wing", "round"))
    assert wing.coordinates is not None
    assert wing.camber is not None
    assert wing.coordinates[1, 1] == 0.06
    assert_allclose(wing.relative_thickness, 0.17)
    assert_allclose(np.interp(0.5, *wing.camber.T), 0.03, atol=2e-3)
    assert round_.relative_thickness == 1.0


def test_modal_blade_becomes_sections(deck: Path) -> None:
    """Mass factor, flap about y, edge about x; what is absent is rigid, and a note says so."""
    turbine = load(deck)
    s = turbine.blade.structure
    assert s is not None
    assert_allclose(s.mass, 1.04536 * np.array([678.935, 335.0, 277.0, 154.0, 10.319]))
    assert_allclose(s.stiffness[2, 4, 4], 5.29e8)
    assert_allclose(s.stiffness[2, 3, 3], 3.2e9)
    assert_allclose(s.twist[1], 10.162 * DEG)
    assert s.damping_ratio == pytest.approx(0.00477465)
    bending_flexibility = 61.5**3 / (3 * s.stiffness[:, 3, 3])
    assert_allclose(61.5 / s.stiffness[:, 0, 0], RIGID * bending_flexibility)
    assert any("ElastoDyn gives no shear" in note for note in turbine.notes)


def test_beamdyn_sections_are_preferred(deck: Path) -> None:
    use_beamdyn(deck)
    turbine = load(deck)
    s = turbine.blade.structure
    assert s is not None
    assert_allclose(turbine.blade.axis[:, 0], [0.0, -0.1, -1.0])
    assert_allclose(s.stiffness[1].diagonal(), 0.2 * np.array([1e9, 1e9, 1e10, 2e10, 1e10, 5e9]))
    assert_allclose(s.inertia[0, 0, 5], -500 * 0.2)
    assert_allclose(s.damping, [1e-3, 1e-3, 1e-3, 0.0014, 0.0022, 0.0022])
    assert_allclose(
        s.twist, np.interp(s.span, [0, 0.5, 1], [13.308, 6.544, 0.106]) * DEG, atol=2e-4
    )
    centre = turbine.blade.shape.normal_offset[2], turbine.blade.shape.leading_edge_offset[2]
    ahead = 0.1 * np.sin(6.544 * DEG)
    assert_allclose(centre, (0.1 * np.cos(6.544 * DEG), 0.25 * 3.748 - ahead), atol=2e-3)


def test_beamdyn_sections_are_preferred_even_where_not_in_use(deck: Path) -> None:
    """The deck's own ElastoDyn blade has another mass, and a note says so."""
    edit(deck, "small.fst", '"NA"              BDBldFile(1)', '"parts/bd.dat" BDBldFile(1)')
    turbine = load(deck)
    assert_allclose(turbine.blade.structure.mass, [500.0, 100.0, 5.0])
    assert any("weigh 10839 kg, ElastoDyn's 17838" in note for note in turbine.notes)


def test_beamdyn_file_that_is_not_in_use_may_be_missing(deck: Path) -> None:
    edit(deck, "small.fst", '"NA"              BDBldFile(1)', '"gone.dat" BDBldFile(1)')
    assert any("gone.dat" in note for note in load(deck).notes)


def test_tower(deck: Path) -> None:
    tower = load(deck).tower
    assert_allclose(tower.axis[[0, -1], 2], [0.0, 87.6])
    assert_allclose(tower.diameter, [6.0, 3.87])
    assert tower.structure is not None
    assert_allclose(tower.structure.mass[0], 5590.87)
    assert_allclose(tower.structure.stiffness[0, 4, 4], 6.14343e11)


def test_simple_torque_law(deck: Path) -> None:
    control = load(deck).control
    assert_allclose(control.rated_power, 5.0e6, rtol=1e-3)
    assert_allclose(control.rated_rotor_speed, 12.1 * np.pi / 30)
    assert control.optimal_mode_gain is not None
    assert_allclose(control.optimal_mode_gain * (1000 * np.pi / 30) ** 2, 0.025576 * 1000**2)


def test_rosco_gains_pitch_to_feather(deck: Path) -> None:
    edit(deck, "parts/svd.dat", "0   PCMode", "5   PCMode")
    control = load(deck).control
    assert control.pitch_schedule is not None
    assert_allclose(control.pitch_schedule[0], [0.057184, 0.01743, 0.005822])
    assert control.rated_power == 5.0e6
    assert_allclose(control.rated_rotor_speed, 122.90967 / 97)
    assert (control.cut_in_wind_speed, control.cut_out_wind_speed) == (3.0, 25.0)
    assert control.minimum_pitch_table is not None
    assert control.minimum_pitch_table.shape == (3, 2)


def test_a_deck_without_controller_says_so(deck: Path) -> None:
    edit(deck, "small.fst", "1   CompServo", "0   CompServo")
    turbine = load(deck)
    assert turbine.control.rated_power == 0.0
    assert any(note.startswith("control:") for note in turbine.notes)


def test_floating_platform(deck: Path) -> None:
    edit(deck, "parts/ed.dat", "False         PtfmPDOF", "True          PtfmPDOF")
    platform = load(deck).platform
    assert platform is not None
    assert platform.mass == 7.46633e6
    assert platform.center_of_mass == (0.0, 0.0, -89.9155)
    assert platform.inertia == (4.22923e9, 4.22923e9, 1.6423e8)
    assert platform.water_depth == 320.0


def _spell_otherwise(name: str, text: str) -> str:
    """The same file as another program or version writes it."""
    if name.endswith(".fst"):
        text = text.replace("parts/", "parts\\").replace('"', "'")
    text = text.replace("5.0191", "5.0191D+0").replace("4.652E+00", "4652.0d-3")
    text = text.replace("BldFile(1)", "BldFile1").replace("PreCone(1)", "PreCone1")
    text = text.replace("WakeMod", "Wake_Mod").replace("True ", ".TRUE. ").replace("False ", "F ")
    text = text.replace("HubMass     -", "HUBMASS\t-").replace("2.5000000E-01", "\t.25")
    text = text.replace("          5   NBlInpSt", "5.0E+00 nblinpst")
    lines = text.splitlines()
    lines[2:2] = ["", "! a remark", "        7   NewKeyword - Something of a later version, 1, 2"]
    return "\r\n".join(lines) + "\r\n"


def test_spelling_does_not_matter(deck: Path, tmp_path: Path) -> None:
    plain = load(deck)
    for name, text in FILES.items():
        if name.endswith((".dat", ".fst")) and "foils" not in name and "bd" not in name:
            (tmp_path / name).write_bytes(_spell_otherwise(name, text).encode("latin-1"))
    same(load(deck), plain)


def test_order_of_the_keywords_does_not_matter(deck: Path) -> None:
    plain = load(deck)
    path = deck.parent / "parts/ed.dat"
    head, rest = path.read_text().split("---------------------- OUTPUT")
    lines = head.splitlines()
    path.write_text("\n".join([*lines[:2], *reversed(lines[2:])]) + "\n------- OUTPUT" + rest)
    same(load(deck), plain)


def test_nrel5mw_deck_is_the_built_in_turbine(deck: Path) -> None:
    """The masses and lengths that the small deck shares with the full one are the library's."""
    small, full = load(deck), load("nrel5mw")
    assert_allclose(small.nacelle.yaw_inertia, full.nacelle.yaw_inertia, rtol=1e-5)
    assert_allclose(small.nacelle.overhang, full.nacelle.overhang, rtol=1e-6)
    assert_allclose(small.nacelle.tilt, full.nacelle.tilt)
    assert_allclose(small.nacelle.center_of_mass, full.nacelle.center_of_mass)
    assert_allclose(small.hub_height, full.hub_height, rtol=1e-6)
    assert_allclose(small.hub.inertia, full.hub.inertia)
    assert_allclose(small.rotor_radius, full.rotor_radius, rtol=1e-6)
    assert small.control.rated_torque == pytest.approx(full.control.rated_torque, rel=1e-4)
    assert small.control.optimal_mode_gain == pytest.approx(
        full.control.optimal_mode_gain, rel=1e-3
    )
    fast, built_in = (t.drivetrain for t in (small, full))
    assert fast.shaft_stiffness == built_in.shaft_stiffness
