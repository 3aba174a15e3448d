"""The turbulence box: its axes, and what it refuses to be."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.inflow.box import Box

DATA = np.random.default_rng(1).standard_normal((3, 6, 4, 5))


def box(**changes):
    settings = {"data": DATA, "spacing": (2.0, 5.0, 4.0), "mean_speed": 8.0, "hub_height": 90.0}
    return Box(**(settings | changes))


def test_axes():
    b = box()
    np.testing.assert_allclose(b.y, [-7.5, -2.5, 2.5, 7.5])
    np.testing.assert_allclose(b.z, [82, 86, 90, 94, 98])
    np.testing.assert_allclose(b.time, np.arange(6) * 0.25)
    np.testing.assert_allclose(box(lead=4.0).time, np.arange(6) * 0.25 - 0.5)
    assert (b.bottom, b.top, b.lowest, b.width, b.height) == (82.0, 98.0, 82.0, 15.0, 16.0)


def test_a_periodic_box_is_one_step_longer():
    assert box().length == 12.0
    assert box(periodic=False).length == 10.0


def test_data_are_kept_in_single_precision_and_in_one_piece():
    b = box(data=DATA[:, ::-1])
    assert b.data.dtype == np.float32
    assert b.data.flags.c_contiguous
    same = b.data
    assert box(data=same).data is same


def test_moved_and_scaled_boxes_leave_the_first_alone():
    b = box()
    assert b.standing_on(0.0).bottom == 0.0
    np.testing.assert_array_equal(b.scaled(2.0).data, 2 * b.data)
    np.testing.assert_array_equal(box(tower=np.ones((3, 6, 2))).scaled(2.0).tower, 2.0)
    assert b.bottom == 82.0
    np.testing.assert_array_equal(b.data, DATA.astype(np.float32))


def test_fluctuations_have_no_mean():
    tower = np.ones((3, 6, 2))
    whole = box(data=DATA + 10, holds_mean=True, tower=tower)
    alone = whole.fluctuations()
    np.testing.assert_allclose(alone.data.mean(axis=1), 0, atol=1e-6)
    np.testing.assert_array_equal(alone.tower, 0)
    assert not alone.holds_mean
    assert alone.fluctuations() is alone
    with pytest.raises(InputError, match="fluctuations"):
        whole.scaled(2.0)


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"spacing": (2.0, 0.0, 4.0)}, "dy is 0"),
        ({"spacing": (np.nan, 5.0, 4.0)}, "dx is nan"),
        ({"mean_speed": -1.0}, "mean speed is -1"),
        ({"mean_speed": np.inf}, "mean speed is inf"),
        ({"hub_height": np.nan}, "hub height is nan"),
        ({"lead": np.inf}, "lead is inf"),
        ({"data": DATA[:2]}, "expected .3, nx, ny, nz"),
        ({"data": DATA[:, :1]}, "at least 2 points"),
        ({"data": np.where(DATA > 2, np.nan, DATA)}, "not finite"),
        ({"data": np.where(DATA > 2, np.inf, DATA)}, "not finite"),
        ({"data": np.where(DATA > 2, -1e30, DATA)}, "holds a wind of 1e.30 m/s"),
        ({"tower": np.zeros((3, 5, 2))}, "tower rows"),
    ],
)
def test_refused(changes, complaint):
    with pytest.raises(InputError, match=complaint):
        box(**changes)
