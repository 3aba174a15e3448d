"""Rings and panels of a lattice, and the lift of its sections in plane flow."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.influence import normal_influence
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.wings import trapezoidal_wing, wing_corners
from galerna.errors import InputError


def test_rings_begin_at_quarter_chords_and_end_behind_the_trailing_edge() -> None:
    lattice = Lattice(trapezoidal_wing(4.0, 2.0, 2, 2))
    assert lattice.vertices[:, 0, 0] == pytest.approx([-0.25, 0.75, 1.75])
    assert lattice.collocation[:, 0, 0] == pytest.approx([0.25, 1.25])
    edges = Lattice(lattice.corners, rings="edges")
    assert edges.vertices is lattice.corners
    assert edges.collocation[:, 0, 0] == pytest.approx([0.0, 1.0])


def test_area_vectors_are_normals_times_areas() -> None:
    lattice = Lattice(trapezoidal_wing(4.0, 2.0, 2, 2, dihedral=0.2, spanwise_spacing="uniform"))
    assert np.linalg.norm(lattice.area_vectors, axis=-1) == pytest.approx(2.0 / np.cos(0.2))
    assert lattice.normals[0] == pytest.approx(
        np.array([[0.0, np.sin(0.2), np.cos(0.2)], [0.0, -np.sin(0.2), np.cos(0.2)]])
    )


def test_unknown_rings_are_refused() -> None:
    with pytest.raises(InputError, match="quarter_chord"):
        Lattice(trapezoidal_wing(4.0, 2.0, 2, 2), rings="quarter-chord")


@pytest.mark.parametrize("edges", [np.linspace(0.0, 1.0, 5), np.array([0.0, 0.1, 0.3, 0.6, 1.0])])
def test_normals_are_those_of_the_camber_line_at_the_collocation_points(
    edges: np.ndarray,
) -> None:
    height = 0.02
    line = 4.0 * height * edges * (1.0 - edges)
    y = np.array([0.0, 1.0, 3.0])
    corners = np.stack(np.broadcast_arrays(edges[:, None], y, line[:, None]), axis=2)
    lattice = Lattice(corners)
    normals, x = lattice.normals, lattice.collocation[..., 0]
    slope = 4.0 * height * (1.0 - 2.0 * x)
    assert -normals[..., 0] / normals[..., 2] == pytest.approx(slope, abs=1e-4)
    assert np.linalg.norm(normals, axis=2) == pytest.approx(1.0)


@pytest.mark.parametrize("panels", [2, 4, 8])
def test_lift_of_a_parabolic_camber_line_needs_few_panels(panels: int) -> None:
    """In plane flow it is 4 pi h at no incidence, for the height h over the chord."""
    height, width = 0.02, 2000.0
    corners = wing_corners(
        np.array([[0.0, -width, 0.0], [0.0, width, 0.0]]), 1.0, panels,
        camber=np.array([[x, 4.0 * height * x * (1.0 - x)] for x in np.linspace(0.0, 1.0, 401)]),
    )  # fmt: skip
    lattice = Lattice(corners)
    wake = lattice.vertices[-1] + np.array([0.0, 1e6])[:, None, None] * np.array([1.0, 0.0, 0.0])
    points, normals = lattice.collocation.reshape(-1, 3), lattice.normals.reshape(-1, 3)
    matrix = normal_influence(lattice.vertices, points, normals)
    matrix[:, -1:] += normal_influence(wake, points, normals)
    circulation = np.linalg.solve(matrix, -normals[:, 0])
    assert 2.0 * circulation[-1] == pytest.approx(4.0 * np.pi * height, rel=5e-3)
