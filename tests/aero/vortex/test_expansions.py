"""Series of 1/r and of harmonic polynomials against what defines them."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.expansions import (
    LANES,
    harmonic_polynomials,
    indices,
    inverse_distance_derivatives,
)


def series(order: int, near: np.ndarray, far: np.ndarray) -> float:
    """1/|far + near| as the sum of S_k(near) D_k(far)."""
    k = indices(order)
    s, d = np.zeros((len(k.exponents) + 1, 1)), np.zeros((len(k.exponents) + 1, LANES))
    harmonic_polynomials(k, order, near[:1], near[1:2], near[2:], s)
    inverse_distance_derivatives(k, np.repeat([*far, 0.0], LANES), d)
    return float(s[: k.independent, 0] @ d[: k.independent, 0])


def test_taylors_series_of_the_inverse_distance_converges_as_the_ratio_of_distances() -> None:
    near, far = np.array([0.3, -0.2, 0.4]), np.array([0.7, 1.6, -1.1])
    ratio = np.linalg.norm(near) / np.linalg.norm(far)
    exact = 1.0 / np.linalg.norm(near + far)
    for order in (4, 8, 12, 16):
        assert abs(series(order, near, far) - exact) < exact * ratio ** (order + 1)


def test_second_derivatives_of_the_inverse_distance_are_the_known_ones() -> None:
    k = indices(3)
    r = np.array([0.7, 1.6, -1.1])
    d = np.zeros((len(k.exponents) + 1, LANES))
    inverse_distance_derivatives(k, np.repeat([*r, 0.0], LANES), d)
    distance = np.linalg.norm(r)
    known = (3.0 * np.outer(r, r) - distance**2 * np.eye(3)) / distance**5
    for exponents, value in zip(k.exponents, d[:, 0], strict=False):
        if exponents.sum() == 2:
            axes = np.repeat(np.arange(3), exponents.astype(int))
            assert value == pytest.approx(known[axes[0], axes[1]], rel=1e-12)


def test_there_are_as_many_coefficients_as_spherical_harmonics() -> None:
    assert [indices(order).independent for order in (3, 6, 9)] == [16, 49, 100]
