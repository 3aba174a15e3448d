"""Blade lattices: where they begin, how they stand in the frames, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.vortex.blades import blade_lattice, lifting_start
from galerna.aero.vortex.lattice import Lattice
from galerna.errors import InputError
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Turbine
from tests.machines import FLAT_PLATE, small_turbine


@pytest.fixture(scope="module")
def nrel() -> Turbine:
    return turbine.load("nrel5mw")


def no_lift(name: str) -> object:
    polar = replace(FLAT_PLATE.polars[0], lift=np.zeros(73))
    return replace(FLAT_PLATE, name=name, relative_thickness=1.0, polars=(polar,))


def test_the_lattice_begins_midway_between_cylinder_and_first_airfoil(nrel: Turbine) -> None:
    shape = nrel.blade.shape
    cylinder = list(shape.airfoil_names).index("DU40_A17") - 1
    assert lifting_start(nrel) == pytest.approx(shape.airfoil_span[cylinder : cylinder + 2].mean())
    lattice = blade_lattice(nrel)
    assert lattice.span[0] == pytest.approx(lifting_start(nrel))
    assert lattice.span[-1] == 1.0
    assert lifting_start(small_turbine()) == 0.0


def test_bare_strips_and_lattice_share_the_whole_blade(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, spanwise=12, chordwise=3)
    stations = lattice.stations
    assert stations[0] == 0.0
    assert np.all(np.diff(stations) > 0.0)
    assert np.array_equal(stations[lattice.bare_strips :], lattice.span)
    assert lattice.bare_strips == 2
    assert len(lattice.sections) == len(stations) - 1 == len(lattice.chord) - 1
    assert lattice.sections.span == pytest.approx(0.5 * (stations[1:] + stations[:-1]))
    assert lattice.offsets.shape == (4, 13, 3)
    whole = blade_lattice(nrel, root_span=0.0)
    assert whole.bare_strips == 0
    assert np.array_equal(whole.stations, whole.span)


def test_leading_and_trailing_edge_stand_where_the_blade_has_them() -> None:
    machine = small_turbine()
    shape = replace(machine.blade.shape, normal_offset=np.array([0.02, 0.03, 0.0]))
    machine = replace(machine, blade=replace(machine.blade, shape=shape))
    lattice = blade_lattice(machine, spanwise=[0.0, 0.5, 1.0], chordwise=2)
    first, last = lattice.offsets[0], lattice.offsets[-1]
    assert first[:, 1] == pytest.approx(-shape.leading_edge_offset)
    assert last[:, 1] - first[:, 1] == pytest.approx(shape.chord)
    assert first[:, 0] == pytest.approx(shape.normal_offset)
    assert not lattice.offsets[..., 2].any()
    assert lattice.quarter_chord[:, 1] == pytest.approx(0.75 * first[:, 1] + 0.25 * last[:, 1])


def test_placed_panels_look_to_the_suction_side_and_turn_with_twist(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, camber="none", chordwise=2)
    position, rotation = blade_frames(nrel.blade, lattice.span)
    corners = lattice.place(position, rotation)
    chord = corners[-1] - corners[0]
    twist = np.interp(lattice.span, nrel.blade.shape.span, nrel.blade.shape.twist)
    assert np.arctan2(chord[:, 0], chord[:, 1]) == pytest.approx(twist)
    assert np.all(Lattice(corners).normals[..., 0] > 0.9)


def test_velocities_are_the_derivative_of_places() -> None:
    lattice = blade_lattice(small_turbine(), spanwise=3, chordwise=2)
    rng = np.random.default_rng(1)
    position, rotation = blade_frames(small_turbine().blade, lattice.span)
    velocity, spin = rng.normal(size=(2, 4, 3))
    h = 1e-6

    def after(time: float) -> np.ndarray:
        cross = np.cross(spin[:, None], rotation.transpose(0, 2, 1)).transpose(0, 2, 1)
        return lattice.place(position + time * velocity, rotation + time * cross)

    rate = (after(h) - after(-h)) / (2.0 * h)
    assert lattice.velocity(rotation, velocity, spin) == pytest.approx(rate, abs=1e-8)


def test_camber_is_blended_as_the_polars_are(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, spanwise=[0.5, 0.53333333, 0.56666667, 1.0], chordwise=4)
    flat = blade_lattice(nrel, spanwise=lattice.span, chordwise=4, camber="none")
    camber = (lattice.offsets - flat.offsets)[..., 0] / lattice.chord[lattice.bare_strips :]
    assert camber[:, 1] == pytest.approx(0.5 * (camber[:, 0] + camber[:, 2]), abs=1e-7)
    assert np.all(camber[1:-1] > 0.0)
    assert not camber[[0, -1]].any()


def test_polars_stand_in_for_missing_coordinates_with_a_note() -> None:
    polar = FLAT_PLATE.polars[0]
    lifting = replace(polar, lift=np.sin(2.0 * (polar.angle_of_attack + 0.08)))
    machine = replace(small_turbine(), airfoils={"plate": replace(FLAT_PLATE, polars=(lifting,))})
    lattice = blade_lattice(machine, chordwise=2)
    assert "'plate' has no coordinates" in lattice.notes[0]
    assert lattice.offsets[1, :, 0] == pytest.approx(0.04 * lattice.chord, rel=0.01)
    assert blade_lattice(machine, camber="polar").notes == ()


def test_what_cannot_be_a_lattice_is_refused() -> None:
    machine = small_turbine()
    with pytest.raises(InputError, match="coordinates"):
        blade_lattice(machine, camber="coordinate")
    with pytest.raises(InputError, match="chordwise panels"):
        blade_lattice(machine, chordwise=0)
    with pytest.raises(InputError, match="root_span"):
        blade_lattice(machine, root_span=1.0)
    with pytest.raises(InputError, match="not at the tip"):
        blade_lattice(machine, spanwise=[0.1, 0.9])
    bare = replace(machine, airfoils={"plate": no_lift("plate")})
    with pytest.raises(InputError, match="no lift"):
        blade_lattice(bare)
    shape = replace(machine.blade.shape, chord=np.array([1.0, -0.8, 0.3]))
    with pytest.raises(InputError, match=r"'small'.*span"):
        blade_lattice(replace(machine, blade=replace(machine.blade, shape=shape)))
