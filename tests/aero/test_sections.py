"""The strip view: weights, blending, tables, and what it refuses."""

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.sections import (
    airfoil_blend,
    blade_sections,
    section_coefficients,
    strip_weights,
    tabulate_polar,
)
from galerna.errors import InputError
from galerna.turbine.model import Polar
from tests.machines import small_turbine


@pytest.fixture(scope="module")
def nrel():
    return turbine.load("nrel5mw")


@pytest.mark.parametrize(
    "position",
    [
        np.array([0.0, 0.3, 1.0, 2.5, 6.0]),
        np.array([0.4, 0.9, 2.0, 5.5]),  # short of both ends
        np.linspace(0.5, 5.5, 6),
    ],
)
def test_strip_weights_are_exact_for_force_and_moment_of_linear_loads(position):
    length = 6.0
    weight, offset = strip_weights(position, length)
    for constant, slope in ((1.0, 0.0), (2.0, -0.7), (-1.0, 3.0)):
        load = constant + slope * position
        force = weight @ load
        moment = (weight * load) @ (position + offset)
        assert force == pytest.approx(constant * length + slope * length**2 / 2, rel=1e-12)
        assert moment == pytest.approx(constant * length**2 / 2 + slope * length**3 / 3, rel=1e-12)


def test_default_stations_are_the_turbines_own(nrel):
    sections = blade_sections(nrel)
    assert np.array_equal(sections.span, nrel.blade.shape.span)
    assert len(blade_sections(nrel, 7)) == 7
    assert np.array_equal(blade_sections(nrel, (0.1, 0.5, 0.9)).span, [0.1, 0.5, 0.9])


@pytest.mark.parametrize("stations", [(0.5,), (0.2, 0.1), (0.0, 1.2), (-0.1, 0.5), (0.3, 0.3)])
def test_stations_must_rise_within_the_blade(nrel, stations):
    with pytest.raises(InputError, match="stations"):
        blade_sections(nrel, stations)


@pytest.mark.parametrize("stations", [(0.9, 1.0), (0.0, 0.1, 0.2), (0.3, 0.5, 0.7, 0.9)])
def test_loads_are_not_continued_further_than_the_stations_know(nrel, stations):
    """Straight lines from two stations at the tip would give nine times the thrust."""
    with pytest.raises(InputError, match="short of"):
        blade_sections(nrel, stations)


def test_table_reproduces_the_polars_own_points(nrel):
    sections = blade_sections(nrel)
    station = int(np.argmax(sections.span > 0.9))
    assert sections.airfoil_at(station) == "NACA64_A17"
    polar = nrel.airfoils["NACA64_A17"].polars[0]
    for k in range(0, len(polar.lift), 5):
        cl, cd, cm = section_coefficients(sections.table, station, polar.angle_of_attack[k])
        assert cl == pytest.approx(polar.lift[k], abs=1e-3)
        assert cd == pytest.approx(polar.drag[k], abs=1e-3)
        assert cm == pytest.approx(polar.moment[k], abs=1e-3)


def test_lookup_wraps_around_the_circle(nrel):
    table = blade_sections(nrel).table
    for angle in (-3.0, 0.1, 3.1):
        turned = section_coefficients(table, 12, angle + 2.0 * np.pi)
        assert turned == pytest.approx(section_coefficients(table, 12, angle), abs=1e-12)


def test_blend_follows_relative_thickness_then_position():
    machine = small_turbine()
    plate = machine.airfoils["plate"]
    airfoils = {
        "thick": replace(plate, name="thick", relative_thickness=0.4),
        "thin": replace(plate, name="thin", relative_thickness=0.2),
        "other": replace(plate, name="other", relative_thickness=0.2),
    }
    shape = replace(
        machine.blade.shape,
        airfoil_span=np.array([0.0, 0.5, 1.0]),
        airfoil_names=("thick", "thin", "other"),
    )
    span, thickness = np.array([0.25, 0.75]), np.array([0.25, 0.2])
    names, blend = airfoil_blend(shape, airfoils, span, thickness)
    assert names == ("thick", "thin", "other")
    assert blend[0] == pytest.approx([0.25, 0.75, 0.0])  # by thickness, not by position
    assert blend[1] == pytest.approx([0.0, 0.5, 0.5])


def test_polars_of_several_reynolds_numbers_are_interpolated():
    machine = small_turbine()
    plate = machine.airfoils["plate"]
    low, high = plate.polars[0], replace(plate.polars[0], reynolds=1e30)
    two = replace(plate, polars=(low, replace(high, lift=2.0 * low.lift)))
    mixed = blade_sections(replace(machine, airfoils={"plate": two}))
    reference = blade_sections(machine)
    ratio = mixed.table[1, 10, 0] / reference.table[1, 10, 0]
    assert 1.0 <= ratio < 1.2  # near the lower Reynolds number, never beyond either


def test_aerodynamic_center_lies_a_quarter_chord_behind_the_leading_edge():
    machine = small_turbine()
    sections = blade_sections(machine)
    expected = 0.25 * sections.chord - np.array([0.3, 0.2, 0.1])
    assert sections.aerodynamic_center[:, 1] == pytest.approx(expected)


def test_unusable_polars_and_chords_are_named():
    machine = small_turbine()
    plate = machine.airfoils["plate"]
    good = plate.polars[0]
    broken = replace(good, lift=np.where(np.arange(73) == 40, np.nan, good.lift))
    with pytest.raises(InputError, match=r"plate.*missing value at 20\.0 deg"):
        blade_sections(replace(machine, airfoils={"plate": replace(plate, polars=(broken,))}))
    with pytest.raises(InputError, match="must rise"):
        tabulate_polar("plate", replace(good, angle_of_attack=good.angle_of_attack[::-1]), 720)
    blade = machine.blade
    flat = replace(blade, shape=replace(blade.shape, chord=np.array([1.0, 0.0, 0.3])))
    with pytest.raises(InputError, match=r"chord at span 0\.500"):
        blade_sections(replace(machine, blade=flat))


def test_angle_outside_the_polar_is_an_error_that_names_airfoil_and_angle():
    machine = small_turbine()
    angle = np.radians(np.linspace(-10.0, 20.0, 31))
    short = Polar(1e6, angle, 6.0 * angle, 0.01 + 0 * angle, 0 * angle)
    plate = replace(machine.airfoils["plate"], polars=(short,))
    sections = blade_sections(replace(machine, airfoils={"plate": plate}))
    sections.check_angles(np.radians([5.0, 6.0, 19.9]))
    with pytest.raises(InputError, match=r"plate.*25\.0 deg.*covers -10\.0 to 20\.0") as error:
        sections.check_angles(np.radians([5.0, 25.0, 0.0]))
    assert "Viterna" in error.value.hint
    with pytest.raises(InputError):
        sections.check_angles(np.array([0.0, np.nan, 0.0]))
