"""From a turbine to its database, and what the command says of it."""

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.errors import InputError
from galerna.hydro.computation import (
    compute_database,
    default_frequencies,
    hydro_command,
    table,
)
from galerna.hydro.netcdf import read_netcdf
from galerna.hydro.rigid_machine import rigid_machine
from galerna.turbine import library
from galerna.turbine.summary import summary

SHIPPED = library.FOLDER / "nrel5mw_oc3.hydro.nc"


def test_frequencies_rise_and_begin_where_the_depth_allows():
    every = default_frequencies()
    assert len(every) == 101
    assert (np.diff(every) > 0.0).all()
    assert every[-1] == 5.0
    shallow = default_frequencies(3.0, 20.0)
    assert shallow[0] >= 0.09
    assert shallow[-1] == 3.0
    assert default_frequencies(6.0)[-1] == pytest.approx(6.0)


def test_the_shipped_spar_tells_what_its_report_does():
    rows = {row.quantity: row for row in table(read_netcdf(SHIPPED))}
    assert rows["displaced volume"].value == "8029.21 m3"
    assert rows["buoyancy"].value == "80.708 MN"
    assert rows["A(inf) 11"].value.startswith("7.754")
    assert float(rows["damping over Haskind's"].value) == pytest.approx(1.0, abs=0.005)
    assert float(rows["heave force over C33 + a_z m"].value) == pytest.approx(1.0, abs=0.002)
    assert float(rows["surge force over a_x m"].value) == pytest.approx(1.0, abs=0.002)
    assert SHIPPED.stat().st_size < 300_000


def test_headings_too_far_apart_are_doubted():
    spar = read_netcdf(SHIPPED)
    wrong = replace(spar, damping=0.8 * spar.damping)
    row = next(r for r in table(wrong) if r.quantity == "damping over Haskind's")
    assert "headings too far apart" in row.remark


def test_the_shipped_spar_is_what_the_command_computes():
    """One frequency of the shipped database again, with a coarser mesh of the same members."""
    pytest.importorskip("capytaine")
    machine = turbines.load("nrel5mw_oc3")
    shipped = read_netcdf(SHIPPED)
    again = compute_database(machine, np.array([0.5]), panel_size=4.0, sectors=32)
    k = int(np.abs(shipped.frequency - 0.5).argmin())
    assert shipped.frequency[k] == 0.5
    for name in ("added_mass", "damping", "excitation"):
        a, b = getattr(shipped, name)[k], getattr(again, name)[0]
        np.testing.assert_allclose(b, a, atol=0.02 * np.abs(a).max(), err_msg=name)
    assert again.displaced_volume == pytest.approx(shipped.displaced_volume, rel=1e-6)
    assert again.settings["hull"] == machine.name


def test_the_command_writes_what_it_tells(tmp_path):
    pytest.importorskip("capytaine")
    base, path, rows = hydro_command(
        "nrel5mw_oc3", tmp_path / "spar.nc", last_frequency=0.05, heading_step_deg=60.0,
        panel_size=8.0, sectors=12,
    )  # fmt: skip
    again = read_netcdf(path)
    np.testing.assert_array_equal(again.added_mass, base.added_mass)
    assert len(again.frequency) == 3
    assert len(again.heading) == 7
    volume = next(row for row in rows if row.quantity == "displaced volume")
    assert "of the stated" in volume.remark


def test_what_cannot_be_computed():
    land = turbines.load("nrel5mw")
    with pytest.raises(InputError, match="has no platform"):
        compute_database(land)
    machine = turbines.load("nrel5mw_oc3")
    with pytest.raises(InputError, match=r"120 m deep in 100 m of water"):
        compute_database(machine, panel_size=8.0, sectors=12, water_depth=100.0)
    assert machine.platform is not None
    with pytest.raises(InputError, match=r"water_depth: is not given"):
        compute_database(replace(machine, platform=replace(machine.platform, water_depth=0.0)))
    with pytest.raises(InputError, match="does not divide 360"):
        hydro_command("nrel5mw_oc3", heading_step_deg=50.0)


def test_the_rigid_machine_weighs_what_the_turbine_does():
    """OC3 Phase IV: 7,466,330 kg of platform, 599,718 kg of tower, nacelle and rotor."""
    moving = rigid_machine(turbines.load("nrel5mw_oc3"))
    mass = moving.inertia[0, 0]
    assert mass == pytest.approx(7_466_330.0 + 599_718.0, rel=1e-3)
    height = moving.inertia[0, 4] / mass
    assert height == pytest.approx(-78.0, abs=0.3)
    assert moving.restoring[4, 4] == pytest.approx(-mass * 9.80665 * height, rel=1e-6)
    np.testing.assert_allclose(moving.inertia, moving.inertia.T, rtol=1e-12)


def test_the_rigid_machine_leaves_nothing_out():
    """Its mass is the sum of the turbine's own figures: the yaw bearing is in it too."""
    turbine = turbines.load("iea15mw_volturnus")
    assert turbine.nacelle.yaw_bearing_mass > 20e3
    figures = {row.quantity: row.value for row in summary(turbine)}
    whole = sum(figures[f"{part}_mass"] for part in ("platform", "tower", "rotor_nacelle"))
    assert rigid_machine(turbine).inertia[0, 0] == pytest.approx(whole, rel=1e-12)
