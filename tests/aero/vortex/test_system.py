"""The bound circulation: when a factorisation serves again, and that it serves right."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.influence import normal_influence
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface, collocation_normals, collocation_points
from galerna.aero.vortex.symmetry import RotationalSymmetry
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.wings import trapezoidal_wing
from galerna.errors import ConvergenceError

SHAPES = ((3, 5), (2, 4), (2, 6))


@pytest.fixture
def surfaces() -> list[Surface]:
    wings = [
        trapezoidal_wing(span, 1.0, *shape, taper=0.6, sweep=0.3)
        for span, shape in zip((4.0, 2.0, 3.0), SHAPES, strict=True)
    ]
    return [Surface.at_rest(w + np.array([1.7 * i, 0.0, 0.6 * i])) for i, w in enumerate(wings)]


@pytest.fixture
def onset(surfaces: list[Surface]) -> np.ndarray:
    return np.random.default_rng(1).standard_normal(len(collocation_points(surfaces)))


def moved(surfaces: list[Surface], turn: np.ndarray, shift: np.ndarray) -> list[Surface]:
    return [Surface.at_rest(s.lattice.corners @ turn.T + shift) for s in surfaces]


def bent(surfaces: list[Surface], size: float, seed: int = 2) -> list[Surface]:
    noise = np.random.default_rng(seed)
    return [
        Surface.at_rest(c + size * noise.standard_normal(c.shape))
        for c in (s.lattice.corners for s in surfaces)
    ]


def residual(surfaces: list[Surface], circulation: np.ndarray, onset: np.ndarray) -> float:
    points, normals = collocation_points(surfaces), collocation_normals(surfaces)
    matrix = np.hstack([normal_influence(s.lattice.vertices, points, normals) for s in surfaces])
    return float(np.linalg.norm(matrix @ circulation - onset) / np.linalg.norm(onset))


def test_a_rigid_motion_keeps_the_factorisation_and_the_answer(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    before = system.solve(onset)
    turn = Rotation.from_rotvec([0.4, 2.0, -1.3]).as_matrix()
    system.place(moved(surfaces, turn, np.array([30.0, -5.0, 12.0])))
    assert system.solve(onset) == pytest.approx(before, rel=1e-12)
    assert (system.factorisations, system.refinements) == (1, 1)


def test_a_surface_that_moves_against_another_is_not_rigid(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    system.solve(onset)
    other = [Surface.at_rest(surfaces[0].lattice.corners + np.array([0.0, 0.0, 1e-4]))]
    system.place(other + surfaces[1:])
    assert residual(other + surfaces[1:], system.solve(onset), onset) < 1e-9
    assert system.refinements > 0


def test_a_mirror_image_is_not_taken_for_a_rigid_motion(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    system.solve(onset)
    reflected = moved(surfaces, np.diag([1.0, -1.0, 1.0]), np.zeros(3))
    system.place(reflected)
    assert residual(reflected, system.solve(onset), onset) < 1e-9


def test_deformed_surfaces_are_solved_by_the_last_factorisation(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    system.solve(onset)
    deformed = bent(surfaces, 0.0005)
    system.place(deformed)
    assert residual(deformed, system.solve(onset), onset) < 1e-9
    assert system.factorisations == 1
    assert 0 < system.refinements <= 4


def test_strong_deformation_factorises_anew(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    system.solve(onset)
    deformed = bent(surfaces, 0.08)
    system.place(deformed)
    both = np.stack([onset, onset[::-1]], axis=1)
    circulation = system.solve(both)
    assert residual(deformed, circulation[:, 0], onset) < 1e-9
    assert residual(deformed, circulation[:, 1], onset[::-1]) < 1e-9
    assert system.factorisations == 2


def test_a_rejected_factorisation_and_a_restored_one_give_the_same_bits(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    system.accept()
    near, far = bent(surfaces, 0.004), bent(surfaces, 0.08)
    system.place(near)
    wanted = system.solve(onset)
    system.place(far)
    system.solve(onset)
    system.reject()
    system.place(near)
    assert np.array_equal(system.solve(onset), wanted)

    resumed = BoundSystem()
    resumed.restore(system.state(), surfaces)
    resumed.place(near)
    assert np.array_equal(resumed.solve(onset), wanted)


def test_strips_of_a_wake_are_solved_as_if_they_stood_in_the_matrix(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    count = sum(n for _, n in SHAPES)
    strips = 0.3 * np.random.default_rng(3).standard_normal((len(onset), count))
    circulation = system.solve(onset, strips)
    whole = system.influence()
    whole[:, system.trailing_rings] += strips
    assert whole @ circulation == pytest.approx(onset, abs=1e-11)


def test_strips_behind_deformed_surfaces_are_solved_by_refinement(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    strips = -0.3 * system.influence()[:, system.trailing_rings]
    system.solve(onset, strips)
    deformed = bent(surfaces, 0.0005)
    system.place(deformed)
    strips *= 1.01
    circulation = system.solve(onset, strips)
    matrix = system.influence()
    matrix[:, system.trailing_rings] += strips
    assert matrix @ circulation == pytest.approx(onset, abs=1e-8)
    assert system.factorisations == 1
    assert 0 < system.refinements <= 4


def test_a_sector_solves_for_all_of_a_symmetric_rotor() -> None:
    blade = trapezoidal_wing(4.0, 1.0, 2, 4, angle_of_attack=0.2) + np.array([0.0, 3.0, 0.0])
    symmetry = RotationalSymmetry(3, np.array([1.0, 0.0, 0.0]), np.array([0.1, 0.2, 0.3]))
    blades = [Surface.at_rest(c) for c in symmetry.images(blade)]
    onset = np.random.default_rng(4).standard_normal(8)
    one, all_three = BoundSystem(symmetry), BoundSystem()
    one.place(blades[:1])
    all_three.place(blades)
    repeated = all_three.solve(np.tile(onset, 3)).reshape(3, -1)
    assert repeated == pytest.approx(np.tile(one.solve(onset), (3, 1)), rel=1e-9)


def test_no_flow_crosses_the_surface_nor_the_mirror(surfaces) -> None:
    mirror = MirrorPlane(np.array([0.0, 0.0, -0.7]), np.array([0.0, 0.0, 1.0]))
    system = BoundSystem(mirror=mirror)
    surfaces = surfaces[:1]
    system.place(surfaces)
    points, normals = collocation_points(surfaces), collocation_normals(surfaces)
    wind = np.array([1.0, 0.0, 0.1])
    sheet = Sheet(surfaces[0].lattice.vertices, system.solve(-normals @ wind).reshape(SHAPES[0]))
    image = mirror.reflect_vectors(direct_velocity([sheet], mirror.reflect_points(points)))
    through = np.sum((direct_velocity([sheet], points) + image + wind) * normals, axis=1)
    assert np.abs(through).max() < 1e-13

    here = system.solve(through + 1.0)
    system.place(moved(surfaces, np.eye(3), np.array([0.0, 0.0, 1.0])))
    higher = system.solve(through + 1.0)
    assert np.abs(higher / here - 1.0).max() > 0.01, "nearer to the mirror is another flow"


def test_wind_that_is_not_a_number_is_named(surfaces, onset) -> None:
    system = BoundSystem()
    system.place(surfaces)
    onset[15 + 5] = np.nan
    with pytest.raises(ConvergenceError, match="surface 2, row 2, column 2"):
        system.solve(onset)
