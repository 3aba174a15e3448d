"""6x6 section matrices against sections put together from fibres and point masses."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from galerna.turbine.cross_section import (
    at_reference,
    center_of_mass,
    inertia_matrix,
    stiffness_matrix,
    transfer,
)

RANDOM = np.random.default_rng(20090201)
PLACES = RANDOM.normal(size=(12, 2)) @ [[0.3, 0.1], [0.0, 1.0]] + [0.2, -0.5]
WEIGHTS = RANDOM.uniform(1.0, 3.0, 12)  # axial stiffness N or mass kg/m of every fibre


def fibres() -> tuple[float, np.ndarray, np.ndarray, float]:
    """Sum, centre, principal moments and the angle of the first principal axis."""
    total, centre = WEIGHTS.sum(), WEIGHTS @ PLACES / WEIGHTS.sum()
    x, y = (PLACES - centre).T
    about_x, about_y, product = WEIGHTS @ y**2, WEIGHTS @ x**2, WEIGHTS @ (x * y)
    moments, axes = np.linalg.eigh([[about_x, -product], [-product, about_y]])
    return total, centre, moments, np.arctan2(axes[1, 0], axes[0, 0])


def test_axial_force_and_bending_of_a_bundle_of_fibres() -> None:
    axial, centre, bending, angle = fibres()
    k = stiffness_matrix(axial, tuple(bending), (0.0, 0.0), 0.0, centre, principal_angle=angle)[0]
    stretch = np.column_stack([np.ones(12), PLACES[:, 1], -PLACES[:, 0]])  # by eps, kx, ky
    assert_allclose(k[2:5, 2:5], stretch.T @ (WEIGHTS[:, None] * stretch), rtol=1e-12)
    assert_allclose(np.delete(k, [2, 3, 4], 0), 0.0, atol=1e-12)


def test_inertia_of_point_masses() -> None:
    x, y = PLACES.T
    built = inertia_matrix(
        WEIGHTS.sum(),
        WEIGHTS @ PLACES / WEIGHTS.sum(),
        (WEIGHTS @ y**2, WEIGHTS @ x**2),
        WEIGHTS @ (x * y),
    )[0]
    velocity = transfer(PLACES, 0.0)[:, :3]  # of every point, by v and omega
    summed = np.einsum("k,kai,kaj->ij", WEIGHTS, velocity, velocity)
    assert_allclose(built, summed, atol=1e-12)
    assert_allclose(center_of_mass(built), WEIGHTS @ PLACES / WEIGHTS.sum())


def test_force_through_the_shear_centre_does_not_twist() -> None:
    x_s, y_s = 0.1, -0.3
    flexibility = np.linalg.inv(
        stiffness_matrix(9.0, (2.0, 3.0), (4.0, 5.0), 6.0, (0.2, 0.4), (x_s, y_s), 0.5)[0]
    )
    for fx, fy in ((1.0, 0.0), (0.0, 1.0)):
        strain = flexibility @ [fx, fy, 0.0, 0.0, 0.0, x_s * fy - y_s * fx]
        assert_allclose(strain[5], 0.0, atol=1e-12)


def test_axial_force_through_the_elastic_centre_does_not_bend() -> None:
    x_e, y_e = 0.2, 0.4
    k = stiffness_matrix(9.0, (2.0, 3.0), (4.0, 5.0), 6.0, (x_e, y_e), (0.1, -0.3), 0.5)[0]
    strain = np.linalg.solve(k, [0.0, 0.0, 1.0, y_e, -x_e, 0.0])
    assert_allclose(strain, [0.0, 0.0, 1.0 / 9.0, 0.0, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_there_and_back(angle: float) -> None:
    matrix = RANDOM.normal(size=(1, 6, 6))
    point = np.array([0.4, -0.2])
    c, s = np.cos(angle), np.sin(angle)
    back = -np.array([c * point[0] + s * point[1], c * point[1] - s * point[0]])
    assert_allclose(at_reference(at_reference(matrix, back, -angle), point, angle), matrix)


def test_many_sections_at_once() -> None:
    points, angles = RANDOM.normal(size=(5, 2)), RANDOM.normal(size=5)
    together = transfer(points, angles)
    for k in range(5):
        assert_allclose(together[k], transfer(points[k], angles[k])[0])
