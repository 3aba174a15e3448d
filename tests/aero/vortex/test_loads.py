"""Loads on corners, columns and strips: the same force, moment and work as on the segments."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.loads import SurfaceLoads, lattice_loads
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface, segment_middles, segment_points
from galerna.aero.vortex.wings import trapezoidal_wing

M, N = 3, 4
DENSITY = 1.1


@pytest.fixture(params=["quarter_chord", "edges"])
def surface(request: pytest.FixtureRequest) -> Surface:
    corners = trapezoidal_wing(5.0, 1.0, M, N, taper=0.5, sweep=0.4, angle_of_attack=0.1)
    noise = 0.03 * np.random.default_rng(0).standard_normal(corners.shape)
    return Surface.at_rest(corners + noise, request.param)


@pytest.fixture
def circulation() -> np.ndarray:
    return np.random.default_rng(1).uniform(1.0, 2.0, (M, N))


@pytest.fixture
def loads(surface: Surface, circulation: np.ndarray) -> SurfaceLoads:
    velocity = np.random.default_rng(2).standard_normal(segment_points([surface]).shape)
    return lattice_loads([surface], [circulation], velocity, DENSITY)[0]


def segment_forces(
    surface: Surface, circulation: np.ndarray, share: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Middles and forces of the borne part of the segments, written out again."""
    velocity = np.random.default_rng(2).standard_normal(segment_points([surface]).shape)
    x, sheet = surface.lattice.vertices, Sheet(surface.lattice.vertices, circulation)
    across, along = x[:-1, 1:] - x[:-1, :-1], x[1:] - x[:-1]
    strength = [sheet.spanwise_strength[:-1].ravel(), sheet.streamwise_strength.ravel()]
    part = share[:, None, None] * along
    lines = np.concatenate([across.reshape(-1, 3), part.reshape(-1, 3)])
    place = segment_middles(x)
    place[M * N :] -= 0.5 * (along - part).reshape(-1, 3)
    return place, DENSITY * np.concatenate(strength)[:, None] * np.cross(velocity, lines)


def test_force_moment_and_work_are_those_of_the_segments(surface, circulation, loads) -> None:
    share = np.ones(M)
    if surface.lattice.rings == "quarter_chord":
        share[-1] = 0.75
    place, force = segment_forces(surface, circulation, share)
    about = np.array([0.3, -0.2, 2.0])
    assert loads.force == pytest.approx(force.sum(axis=0), rel=1e-12)
    assert loads.moment(about) == pytest.approx(
        np.cross(place - about, force).sum(axis=0), rel=1e-12
    )
    assert loads.strip_force.sum(axis=0) == pytest.approx(loads.force, rel=1e-12)


def test_the_moment_moves_with_the_point(loads) -> None:
    about = np.array([1.0, -3.0, 0.5])
    assert loads.moment(about) == pytest.approx(loads.moment() - np.cross(about, loads.force))


def test_columns_do_the_work_of_the_corners_when_their_frames_move(surface, loads) -> None:
    columns = np.random.default_rng(5)
    origins, shift, turn = columns.standard_normal((3, N + 1, 3))
    force, moment = loads.column_loads(origins)
    corner_motion = shift + np.cross(turn, surface.lattice.corners - origins)
    work = np.sum(force * shift + moment * turn)
    assert work == pytest.approx(np.sum(loads.corner_force * corner_motion), rel=1e-12)


def test_corner_loads_are_the_transpose_of_the_corners_motion() -> None:
    corners = trapezoidal_wing(5.0, 1.0, M, N)
    motion = np.random.default_rng(6).standard_normal(corners.shape)
    surface = Surface.at_rest(corners)
    circulation, velocity = np.zeros((M, N)), np.zeros((len(segment_points([surface])), 3))
    circulation[:] = 1.0  # one leading-edge vortex and the two sides
    velocity[:N] = [1.0, 0.0, 0.0]  # only the leading edge meets air
    loads = lattice_loads([surface], [circulation], velocity, 1.0)[0]
    x, moving = surface.lattice.vertices, Lattice(motion).vertices
    force = np.cross([1.0, 0.0, 0.0], x[0, 1:] - x[0, :-1])
    work = np.sum(force * 0.5 * (moving[0, 1:] + moving[0, :-1]))
    assert np.sum(loads.corner_force * motion) == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize(("rings", "share"), [("quarter_chord", 0.5), ("edges", 0.5 + 0.5 / M)])
def test_a_potential_jump_that_rises_along_the_chord_presses_with_its_mean(rings, share) -> None:
    surface = Surface.at_rest(trapezoidal_wing(5.0, 1.0, M, N), rings)
    rate = np.repeat(np.arange(1, M + 1)[:, None] / M, N, axis=1)  # where rings end
    at_rest = np.zeros((len(segment_points([surface])), 3))
    loads = lattice_loads([surface], [np.zeros((M, N))], at_rest, DENSITY, [rate])[0]
    assert loads.force == pytest.approx([0.0, 0.0, DENSITY * share * 5.0], abs=1e-12)
    assert loads.strip_force.sum(axis=0) == pytest.approx(loads.force, abs=1e-12)


def test_several_surfaces_are_loaded_as_each_alone(surface, circulation) -> None:
    other = Surface.at_rest(trapezoidal_wing(2.0, 0.5, 1, 2))
    air = np.random.default_rng(7).standard_normal((len(segment_points([surface, other])), 3))
    both = lattice_loads([surface, other], [circulation, np.ones((1, 2))], air, DENSITY)
    alone = lattice_loads(
        [other], [np.ones((1, 2))], air[len(segment_points([surface])) :], DENSITY
    )
    assert np.array_equal(both[1].corner_force, alone[0].corner_force)
