"""Secants make an iteration converge whose tangent leaves much out."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.structure.quasi_newton import DEPTH, Secants


def test_a_linear_problem_is_solved_in_as_many_steps_as_it_has_unknowns() -> None:
    rng = np.random.default_rng(1)
    unknown = rng.normal(size=DEPTH)
    matrix = np.eye(DEPTH) + 2.0 * rng.normal(size=(DEPTH, DEPTH))  # the tangent is 1: it diverges
    secants, x = Secants(DEPTH), np.zeros(DEPTH)
    for _ in range(DEPTH + 1):
        x = x + secants.step(matrix @ (unknown - x))
    assert x == pytest.approx(unknown, rel=1e-6)


def test_what_is_not_judged_follows() -> None:
    secants, x = Secants(1), np.zeros(2)
    for _ in range(3):  # the second entry obeys the first: y = 5 x, x = 4 - 3 x
        x = x + secants.step(np.array([4.0 - 4.0 * x[0], 5.0 * (4.0 - 3.0 * x[0]) - x[1]]))
    assert x == pytest.approx([1.0, 5.0])


def test_what_is_not_a_number_is_passed_on() -> None:
    secants = Secants(1)
    secants.step(np.ones(2))
    assert np.isnan(secants.step(np.full(2, np.nan))).all()
