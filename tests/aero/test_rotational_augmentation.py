"""Stall delay: published factors, attached flow untouched, stall later, deep stall untouched."""

import numpy as np
import pytest

from galerna.aero.bem.rotational_augmentation import (
    FADE_END,
    augment,
    augment_polar,
    augmentation_factors,
)
from galerna.errors import InputError
from galerna.turbine.model import Polar

ANGLE = np.radians(np.linspace(-180.0, 180.0, 721))
ZERO = np.radians(-1.5)
POINT = 1.0 / (1.0 + np.exp((np.abs(ANGLE - ZERO) - 0.25) / 0.02))
LIFT = np.where(
    np.abs(ANGLE) < 1.0,
    2 * np.pi * (ANGLE - ZERO) * ((1 + np.sqrt(POINT)) / 2) ** 2,
    np.sin(2 * ANGLE),
)
DRAG = 0.01 + 1.3 * np.sin(ANGLE) ** 2 * (1.0 - POINT)


def test_du_selig_factors_by_hand():
    # c/r = 0.5, r/R = 0.3, tip-speed ratio 4: Lambda = 4/sqrt(17).
    exponent = np.sqrt(17.0) / 4.0 / 0.3
    x, y = 0.5**exponent, 0.5 ** (exponent / 2)
    lift, drag = augmentation_factors("du_selig", 0.5, 0.3, 4.0)
    assert lift == pytest.approx((0.8 / 0.1267 * (1 - x) / (1 + x) - 1) / (2 * np.pi))
    assert drag == pytest.approx((0.8 / 0.1267 * (1 - y) / (1 + y) - 1) / (2 * np.pi))
    assert augmentation_factors("snel", 0.3, 0.3, 4.0) == (pytest.approx(0.27), 0.0)
    assert augmentation_factors("none", 0.3, 0.3, 4.0) == (0.0, 0.0)


@pytest.mark.parametrize("method", ["snel", "du_selig"])
def test_inboard_stall_is_delayed_and_the_rest_kept(method):
    lift, drag = augment(ANGLE, LIFT, DRAG, method, 0.4, 0.25, 6.0)
    stalled = (np.radians(18) < ANGLE) & (np.radians(30) > ANGLE)
    assert np.all(lift[stalled] > LIFT[stalled] + 0.1)
    assert np.all(lift[stalled] < 2 * np.pi * (ANGLE[stalled] - ZERO))
    if method == "du_selig":
        assert np.all(drag[stalled] < DRAG[stalled])
    attached = np.abs(ANGLE - ZERO) < np.radians(6)
    np.testing.assert_allclose(lift[attached], LIFT[attached], atol=2e-3)
    kept = (ANGLE > FADE_END) | (ANGLE < ZERO)
    assert np.array_equal(lift[kept], LIFT[kept])
    assert np.array_equal(drag[kept], DRAG[kept])
    assert np.abs(np.diff(lift)).max() < 1.5 * np.abs(np.diff(LIFT)).max()


def test_effect_falls_towards_the_tip():
    stations = ((0.45, 0.2), (0.2, 0.4), (0.06, 0.8))
    at_20_deg = np.argmin(np.abs(ANGLE - np.radians(20.0)))
    gain = [
        (augment(ANGLE, LIFT, DRAG, "du_selig", c, x, 6.0)[0] - LIFT)[at_20_deg]
        for c, x in stations
    ]
    assert gain[0] > gain[1] > gain[2]


def test_a_cylinder_is_left_alone():
    drag = np.full_like(ANGLE, 0.5)
    lift, same = augment(ANGLE, 0 * ANGLE, drag, "snel", 0.8, 0.1, 6.0)
    assert not lift.any()
    assert np.array_equal(same, drag)


def test_polar_in_polar_out():
    polar = Polar(1e6, ANGLE, LIFT, DRAG, 0.1 * ANGLE)
    turned = augment_polar(polar, "snel", 0.4, 0.25, 6.0)
    assert turned.moment is polar.moment
    assert turned.lift.max() > polar.lift.max()
    assert np.array_equal(polar.lift, LIFT)


def test_unusable_input_is_refused():
    with pytest.raises(InputError, match="du_selig"):
        augmentation_factors("du_sellig", 0.3, 0.3, 4.0)
    with pytest.raises(InputError):
        augmentation_factors("snel", 0.3, np.nan, 4.0)
