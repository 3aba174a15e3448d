"""Drag and bare strips: directions, places, flags, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.vortex.blades import BladeLattice, blade_lattice
from galerna.aero.vortex.viscous import PolarForces, StripAir
from galerna.errors import InputError
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Turbine
from tests.machines import FLAT_PLATE, small_turbine

DENSITY = 1.2


@pytest.fixture(scope="module")
def nrel() -> Turbine:
    return turbine.load("nrel5mw")


def air_at_rest(forces: PolarForces, machine: Turbine, wind: np.ndarray) -> StripAir:
    position, rotation = blade_frames(machine.blade, forces.lattice.stations)
    still = np.zeros_like(position)
    strips = np.broadcast_to(wind, (len(position) - 1, 3))
    return forces.air(position, rotation, still, still, strips)


def no_lattice_force(lattice: BladeLattice) -> np.ndarray:
    return np.zeros((len(lattice.span) - 1, 3))


def straight_blade(twist: float = 0.0, **polar: np.ndarray) -> Turbine:
    """Chord 1 m, quarter chord on the axis, 10 m long, with a changed flat-plate polar."""
    machine = small_turbine()
    plate = replace(FLAT_PLATE, polars=(replace(FLAT_PLATE.polars[0], **polar),))
    shape = replace(
        machine.blade.shape,
        twist=np.full(3, twist),
        chord=np.ones(3),
        leading_edge_offset=np.full(3, 0.25),
    )
    axis = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 5.0], [0.0, 0.0, 10.0]])
    blade = replace(machine.blade, axis=axis, shape=shape)
    return replace(machine, blade=blade, airfoils={"plate": plate})


def test_the_air_is_taken_relative_to_the_moving_strip() -> None:
    machine = straight_blade(twist=0.15)
    forces = PolarForces(blade_lattice(machine), DENSITY)
    position, rotation = blade_frames(machine.blade, forces.lattice.stations)
    spin = np.tile([1.2, 0.0, 0.0], (len(position), 1))
    velocity = np.cross(spin, position + np.array([0.0, 0.0, machine.hub.radius]))
    wind = np.tile([9.0, 0.0, 2.0], (len(position) - 1, 1))
    air = forces.air(position, rotation, velocity, spin, wind)
    radius = machine.hub.radius + 10.0 * forces.lattice.sections.span
    assert air.speed == pytest.approx(np.hypot(9.0, 1.2 * radius))
    assert air.angle == pytest.approx(np.arctan2(9.0, 1.2 * radius) - 0.15)
    assert np.sum(air.lift * air.velocity, axis=1) == pytest.approx(0.0, abs=1e-9)
    assert np.all(air.lift[:, 0] > 0.0)  # downwind, towards the suction side


def test_drag_lies_along_the_wind_and_belongs_to_the_lift(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, spanwise=10)
    forces = PolarForces(lattice, DENSITY)
    air = air_at_rest(forces, nrel, np.array([1.0, 60.0, 0.0]))
    k, chord = lattice.bare_strips, 0.5 * (lattice.chord[1:] + lattice.chord[:-1])
    scale = 0.5 * DENSITY * air.speed**2 * chord * np.linalg.norm(air.span, axis=1)
    found = forces.loads(air, (0.6 * scale[:, None] * air.lift + 7.0 * air.velocity)[k:])
    assert found.lift_coefficient[k:] == pytest.approx(0.6)
    expected = forces.polars.at_lift(np.full(len(chord), 0.6)).drag
    assert found.drag_coefficient[k:] == pytest.approx(expected[k:])
    drag = scale * found.drag_coefficient / air.speed
    assert found.force.sum(axis=0) == pytest.approx((drag[:, None] * air.velocity).sum(axis=0))


def test_bare_strips_have_the_drag_of_the_cylinder(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel)
    forces = PolarForces(lattice, DENSITY)
    air = air_at_rest(forces, nrel, np.array([10.0, 0.0, 0.0]))
    found = forces.loads(air, no_lattice_force(lattice))
    assert found.drag_coefficient[0] == pytest.approx(0.5)
    assert not found.outside[: lattice.bare_strips].any()
    width = lattice.stations[1] * nrel.blade.length
    expected = 0.5 * DENSITY * 100.0 * 0.5 * width * 0.5 * lattice.chord[:2].sum()
    assert found.force[0, 0] == pytest.approx(0.5 * expected, rel=1e-3)  # its axis leans by 2 deg


def test_a_bare_strip_lifts_and_turns_as_its_polar_says() -> None:
    machine = straight_blade(moment=np.full(73, 0.1), drag=np.zeros(73))
    lattice = blade_lattice(machine, root_span=0.5, spanwise=1)
    forces = PolarForces(lattice, DENSITY)
    wind = 20.0 * np.array([np.sin(0.1), np.cos(0.1), 0.0])
    found = forces.loads(air_at_rest(forces, machine, wind), no_lattice_force(lattice))
    pressure_area = 0.5 * DENSITY * 400.0 * 5.0
    lift = pressure_area * found.lift_coefficient[0]
    assert found.angle_of_attack[0] == pytest.approx(0.1)
    assert found.lift_coefficient[0] == pytest.approx(np.sin(0.2), abs=2e-3)  # 73 angles
    direction = np.array([np.cos(0.1), -np.sin(0.1), 0.0])
    assert found.force.sum(axis=0) == pytest.approx(lift * direction, rel=2e-3)
    assert found.moment.sum(axis=0) == pytest.approx([0.0, 0.0, 0.1 * pressure_area])  # nose up


def test_forces_on_frames_have_the_moment_of_the_strips(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, root_span=0.0)  # cylinders have drag alone
    forces = PolarForces(lattice, DENSITY)
    position, rotation = blade_frames(nrel.blade, lattice.stations)
    still, wind = np.zeros_like(position), np.tile([3.0, 40.0, 1.0], (len(position) - 1, 1))
    air = forces.air(position, rotation, still, still, wind)
    found = forces.loads(air, no_lattice_force(lattice))
    total = np.cross(position, found.force).sum(axis=0) + found.moment.sum(axis=0)
    chord = 0.5 * (lattice.chord[1:] + lattice.chord[:-1])
    area = 0.5 * DENSITY * air.speed * chord * np.linalg.norm(air.span, axis=1)
    strips = (area * found.drag_coefficient)[:, None] * air.velocity
    middles = forces.points(position, rotation)
    assert total == pytest.approx(np.cross(middles, strips).sum(axis=0))


def test_sections_that_leave_the_branch_are_flagged_and_named(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, spanwise=10)
    forces = PolarForces(lattice, DENSITY)
    air = air_at_rest(forces, nrel, np.array([0.0, 60.0, 0.0]))
    k, chord = lattice.bare_strips, 0.5 * (lattice.chord[1:] + lattice.chord[:-1])
    scale = 0.5 * DENSITY * air.speed**2 * chord * np.linalg.norm(air.span, axis=1)
    lift = np.zeros(len(chord))
    lift[[k + 3, k + 5]] = 3.0, -3.0
    found = forces.loads(air, (lift * scale)[k:, None] * air.lift[k:])
    assert np.flatnonzero(found.outside).tolist() == [k + 3, k + 5]
    assert found.outside[[k + 3, k + 5]].tolist() == [1, -1]
    sentence = forces.describe_outside("blade2", k + 3, 3.0)
    assert sentence.startswith(f"blade2, at {lattice.sections.span[k + 3]:.1%} of the span")
    assert "3.00 is above the greatest" in sentence
    assert "below the least" in forces.describe_outside("blade2", k + 5, -3.0)


def test_a_known_angle_of_attack_gives_the_drag_of_separated_flow(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, spanwise=10)
    forces = PolarForces(lattice, DENSITY)
    air = air_at_rest(forces, nrel, np.array([0.0, 60.0, 0.0]))
    k, angle = lattice.bare_strips, np.radians(90.0)
    found = forces.loads(air, no_lattice_force(lattice), np.full(10, angle))
    assert np.all(found.drag_coefficient[k:] > 1.2)
    assert found.angle_of_attack[k:] == pytest.approx(angle)
    assert not found.outside.any()


def test_all_blades_at_once_are_each_alone(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel, spanwise=6)
    forces = PolarForces(lattice, DENSITY)
    rng = np.random.default_rng(3)
    position, rotation = blade_frames(nrel.blade, lattice.stations)
    velocity, spin = rng.normal(size=(2, 3, len(position), 3))
    wind = np.array([8.0, 40.0, 0.0]) + rng.normal(size=(3, len(position) - 1, 3))
    push = 500.0 * rng.normal(size=(3, 6, 3))
    places = np.broadcast_to(position, velocity.shape)
    turns = np.broadcast_to(rotation, (3, *rotation.shape))
    together = forces.loads(forces.air(places, turns, velocity, spin, wind), push)
    for b in range(3):
        alone = forces.loads(forces.air(position, rotation, velocity[b], spin[b], wind[b]), push[b])
        for one, all_of_them in zip(alone, together, strict=True):
            assert np.array_equal(one, all_of_them[b])


def test_calm_air_gives_no_loads_and_no_missing_numbers(nrel: Turbine) -> None:
    lattice = blade_lattice(nrel)
    forces = PolarForces(lattice, DENSITY)
    found = forces.loads(air_at_rest(forces, nrel, np.zeros(3)), no_lattice_force(lattice))
    assert not found.force.any()
    assert not found.moment.any()
    assert np.isfinite(np.concatenate([v.ravel() for v in found])).all()


def test_drag_without_polars_is_refused_and_a_lattice_without_them_is_not() -> None:
    plate = replace(FLAT_PLATE, polars=(), camber=np.array([[0.0, 0.0], [1.0, 0.0]]))
    machine = replace(small_turbine(), airfoils={"plate": plate})
    lattice = blade_lattice(machine)
    with pytest.raises(InputError, match="no polars"):
        PolarForces(lattice, DENSITY)
    with pytest.raises(InputError, match=r"'plate'.*neither polars nor"):
        blade_lattice(machine, camber="polar")
