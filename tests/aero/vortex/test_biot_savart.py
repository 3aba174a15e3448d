"""Velocities of single vortices, and the lift of a long plate."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.sheet import Sheet


def test_a_plate_of_large_aspect_ratio_has_the_lift_of_prandtls_line() -> None:
    chordwise, spanwise, span, angle = 4, 40, 20.0, 0.05
    corners = np.zeros((chordwise + 1, spanwise + 1, 3))
    along = np.linspace(0.0, 1.0, chordwise + 1)[:, None]
    place = np.linspace(-np.pi / 2, np.pi / 2, spanwise + 1)
    chord = np.cos(place)  # elliptic
    corners[..., 0] = (along - 0.25) * chord * np.cos(angle)
    corners[..., 1] = 0.5 * span * np.sin(place)
    corners[..., 2] = -(along - 0.25) * chord * np.sin(angle)
    corners[:, [0, -1], :] += 1e-3 * np.array([1.0, 0.0, 0.0]) * along[..., None]
    lattice = Lattice(corners)
    edge = lattice.vertices[-1]

    def normal_velocity(circulation: np.ndarray) -> np.ndarray:
        wake = Sheet(np.stack([edge, edge + np.array([1e4, 0.0, 0.0])]), circulation[-1:])
        sheets = [Sheet(lattice.vertices, circulation), wake]
        return (direct_velocity(sheets, lattice.collocation) * lattice.normals).sum(-1).ravel()

    unit = np.eye(chordwise * spanwise).reshape(-1, chordwise, spanwise)
    influence = np.stack([normal_velocity(g) for g in unit], axis=1)
    wind = lattice.normals @ np.array([1.0, 0.0, 0.0])
    circulation = np.linalg.solve(influence, -wind.ravel()).reshape(chordwise, spanwise)

    middle = circulation[-1, spanwise // 2]
    aspect_ratio = span / (np.pi / 4.0)
    assert 2.0 * middle == pytest.approx(2.0 * np.pi * angle / (1.0 + 2.0 / aspect_ratio), rel=0.02)


def test_a_straight_vortex_without_core_induces_circulation_over_its_length() -> None:
    long = np.array([[[-1e5, 0.0, 0.0], [1e5, 0.0, 0.0]], [[-1e5, 0.0, -1e7], [1e5, 0.0, -1e7]]])
    velocity = direct_velocity([Sheet(long, np.ones((1, 1)))], np.array([0.0, 0.0, 1.0]))
    assert velocity == pytest.approx([0.0, -0.5 / np.pi, 0.0], rel=2e-4, abs=1e-6)
