"""The figures of a turbine against closed forms."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import small_windio

from galerna.turbine import Turbine, windio
from galerna.turbine.model import Platform, Published
from galerna.turbine.summary import fitted_airfoils, point_masses, summary


@pytest.fixture
def turbine(tmp_path: Path) -> Turbine:
    return windio.read(small_windio.write(tmp_path, small_windio.document()))


def figures(turbine: Turbine) -> dict[str, float | None]:
    return {row.quantity: row.value for row in summary(turbine)}


def test_moments_of_a_tapered_beam_are_exact(turbine: Turbine) -> None:
    """Mass 100 (1 - s/2) kg/m over 10 m: closed forms of its first three moments."""
    structure = turbine.blade.structure
    inertia = structure.inertia * np.array([1.0, 0.5])[:, None, None]
    blade = replace(turbine.blade, structure=replace(structure, inertia=inertia))
    mass, position = point_masses(blade.axis_span, blade.axis, blade.structure)
    z = position[:, 2]
    assert mass.sum() == pytest.approx(750.0, rel=1e-14)
    assert mass @ z == pytest.approx(100.0 * (50.0 - 1000.0 / 60.0), rel=1e-14)
    assert mass @ z**2 == pytest.approx(100.0 * (1000.0 / 3.0 - 125.0), rel=1e-14)


def test_mass_follows_the_length_of_a_bent_axis(turbine: Turbine) -> None:
    axis = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 4.0]])
    mass, _ = point_masses(np.array([0.0, 1.0]), axis, turbine.blade.structure)
    assert mass.sum() == pytest.approx(500.0)


def test_rotor_inertia_of_coned_rods(turbine: Turbine) -> None:
    """Three rods of 1000 kg from 1 m to 11 m, coned 3 deg."""
    expected = 3.0 * 100.0 * (11.0**3 - 1.0) / 3.0 * np.cos(np.radians(3.0)) ** 2
    assert figures(turbine)["rotor_inertia"] == pytest.approx(expected)


def test_mass_centre_of_the_machine(turbine: Turbine) -> None:
    """Tower of 3000 kg at 15 m; rotor of 3000 kg on the shaft, coned upwind."""
    tilt, cone = np.radians(5.0), np.radians(3.0)
    ahead = 6.0 * np.sin(cone)  # blade centres from the hub, along the shaft upwind
    x = -3.0 - ahead * np.cos(tilt)
    z = 32.0 + ahead * np.sin(tilt)
    found = figures(turbine)
    assert found["overall_center_of_mass_x"] == pytest.approx(x / 2)
    assert found["overall_center_of_mass_z"] == pytest.approx((15.0 + z) / 2)


def test_a_platform_weighs_in(turbine: Turbine) -> None:
    alone = figures(turbine)["overall_center_of_mass_z"]
    platform = Platform((0.0, 0.0, 0.0), 6000.0, (0.0, 0.0, -10.0), (1.0, 1.0, 1.0))
    afloat = figures(replace(turbine, platform=platform))["overall_center_of_mass_z"]
    assert afloat == pytest.approx((alone - 10.0) / 2)


def test_disagreement_is_shown(turbine: Turbine) -> None:
    published = Published("blade_mass", 800.0, "kg", "a book")
    [row] = [r for r in summary(replace(turbine, published=(published,))) if r.source]
    assert (row.value, row.published) == (pytest.approx(1000.0), 800.0)
    assert row.difference == pytest.approx(0.25)


@pytest.mark.parametrize(
    "published",
    [
        Published("frequency_tower_1", 0.3, "Hz", "a book"),  # nothing computes it
        Published("blade_mass", 1.0, "t", "a book"),  # not the unit of the table
    ],
)
def test_what_cannot_be_compared_is_still_shown(turbine: Turbine, published: Published) -> None:
    [row] = [r for r in summary(replace(turbine, published=(published,))) if r.source]
    assert (row.value, row.difference) == (None, None)
    assert (row.published, row.unit) == (published.value, published.unit)


def test_a_rigid_blade_has_no_mass_to_show(turbine: Turbine) -> None:
    rigid = replace(turbine, blade=replace(turbine.blade, structure=None))
    assert "blade_mass" not in figures(rigid)
    assert "hub_height" in figures(rigid)


def test_fitted_airfoils_are_named(turbine: Turbine) -> None:
    assert fitted_airfoils(turbine) == ("round", "thin")
