"""Rings and panels of a lattice, and the lift of its sections in plane flow."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.wings import trapezoidal_wing
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
