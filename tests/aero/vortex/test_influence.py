"""Rings and strips of unit circulation against the sheet that they are part of."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.influence import normal_influence, strip_influence
from galerna.aero.vortex.sheet import Sheet


@pytest.fixture
def vertices() -> np.ndarray:
    """A twisted sheet of 5 x 4 vertices."""
    i, j = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    return np.stack([i + 0.1 * j**2, 2.0 * j - 0.2 * i, 0.3 * np.sin(i + j)], axis=-1)


@pytest.fixture
def points() -> np.ndarray:
    return np.random.default_rng(5).uniform(-2.0, 6.0, (7, 3))


def test_a_sheet_is_the_sum_of_its_rings(vertices: np.ndarray, points: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    circulation, normals = rng.normal(size=(4, 3)), rng.normal(size=points.shape)
    whole = (direct_velocity([Sheet(vertices, circulation)], points) * normals).sum(axis=1)
    assert normal_influence(vertices, points, normals) @ circulation.ravel() == pytest.approx(whole)


@pytest.mark.parametrize("core", [0.0, 0.7])
def test_strips_are_columns_of_equal_rings(
    vertices: np.ndarray, points: np.ndarray, core: float
) -> None:
    strengths = np.array([1.0, -2.0, 0.5])
    whole = direct_velocity([Sheet(vertices, np.tile(strengths, (4, 1)), core)], points)
    strips = strip_influence(vertices, points, core)
    assert np.einsum("kjc,j->kc", strips, strengths) == pytest.approx(whole)
