"""The attached line of a polar."""

import numpy as np
import pytest

from galerna.aero.bem.attached_flow import attached_line

ANGLE = np.linspace(-np.pi, np.pi, 1441)


def test_a_straight_polar_gives_itself():
    zero, slope = attached_line(ANGLE, 6.2 * (ANGLE + 0.05))
    assert zero == pytest.approx(-0.05)
    assert slope == pytest.approx(6.2)


def test_the_zero_nearest_to_the_hint_is_taken():
    lift = np.sin(4 * ANGLE)  # zeros that rise at 0 and +-90 deg
    assert attached_line(ANGLE, lift)[0] == pytest.approx(0.0, abs=0.02)
    assert attached_line(ANGLE, lift, near=1.5)[0] == pytest.approx(np.pi / 2, abs=0.02)


def test_a_kink_at_zero_lift_does_not_set_the_slope():
    lift = 6.0 * (ANGLE + 0.07)
    lift[(ANGLE > -0.075) & (ANGLE < -0.065)] *= 2.0
    assert attached_line(ANGLE, lift)[1] == pytest.approx(6.0, rel=0.02)


def test_a_cylinder_has_no_slope():
    assert attached_line(ANGLE, 0.0 * ANGLE, near=0.1) == (0.1, 0.0)
