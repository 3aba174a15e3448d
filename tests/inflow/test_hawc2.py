"""HAWC2 boxes: the order of the numbers, and files of another size."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.inflow.field import WindField
from galerna.inflow.hawc2 import read_hawc2, write_hawc2
from galerna.inflow.mean import HubWind, Profile, Steady

SHAPE, SPACING = (5, 3, 4), (10.0, 6.0, 5.0)
PLACE = {"mean_speed": 10.0, "hub_height": 80.0}


@pytest.fixture
def files(tmp_path):
    """Files in which u counts x, v counts y and w counts z, in the order of the numbers."""
    numbers = np.meshgrid(*(np.arange(n) for n in SHAPE), indexing="ij")
    paths = [tmp_path / f"{name}.bin" for name in "uvw"]
    for path, values in zip(paths, numbers, strict=True):
        values.astype("<f4").tofile(path)
    return paths


def test_order_of_the_numbers(files):
    field = WindField(
        Steady(HubWind(0.0)), Profile(80.0), read_hawc2(files, SHAPE, SPACING, **PLACE)
    )
    first = field.velocity(np.array([[0.0, -6.0, 72.5]]), 0.0)[0]
    np.testing.assert_allclose(first, [4, 0, 0], atol=1e-6)  # last plane first; right; bottom
    later = field.velocity(np.array([[0.0, 6.0, 87.5]]), 1.0)[0]
    np.testing.assert_allclose(later, [3, 2, 3], atol=1e-6)


def test_first_row_on_the_left(files):
    left = read_hawc2(files, SHAPE, SPACING, **PLACE, first_row="left")
    right = read_hawc2(files, SHAPE, SPACING, **PLACE)
    np.testing.assert_array_equal(left.data[:, :, ::-1], right.data)


@pytest.mark.parametrize("first_row", ["left", "right"])
def test_round_trip(tmp_path, first_row):
    data = np.random.default_rng(2).standard_normal((3, *SHAPE)).astype(np.float32)
    box = Box(data, SPACING, 10.0, 80.0)
    paths = write_hawc2(tmp_path / "box", box, first_row)
    back = read_hawc2(paths, SHAPE, SPACING, **PLACE, first_row=first_row)
    np.testing.assert_array_equal(back.data, data)
    assert (back.bottom, back.top) == (72.5, 87.5)


def test_mean_wind_is_not_written(tmp_path):
    box = Box(np.ones((3, *SHAPE)), SPACING, 10.0, 80.0, holds_mean=True)
    with pytest.raises(InputError, match="holds the mean wind"):
        write_hawc2(tmp_path / "box", box)


@pytest.mark.parametrize(
    ("shape", "spacing", "complaint"),
    [
        ((6, 3, 4), SPACING, "is cut short"),
        ((4, 3, 4), SPACING, "is longer"),
        ((10**9, 10**9, 10**9), SPACING, "is cut short"),
        ((1, 15, 4), SPACING, "2 points or more"),
        (SHAPE, (10.0, float("nan"), 5.0), "dy is nan"),
        (SHAPE, (0.0, 6.0, 5.0), "dx is 0"),
    ],
)
def test_shape_and_spacing_that_do_not_fit(files, shape, spacing, complaint):
    with pytest.raises(InputError, match=complaint):
        read_hawc2(files, shape, spacing, **PLACE)


def test_numbers_that_are_none(files):
    np.full(SHAPE, np.nan, dtype="<f4").tofile(files[1])
    with pytest.raises(InputError, match="not finite"):
        read_hawc2(files, SHAPE, SPACING, **PLACE)


def test_numbers_of_another_machine(files):
    np.linspace(1.0, 3.0, 60).astype(">f4").tofile(files[2])
    with pytest.raises(InputError, match="holds a wind of"):
        read_hawc2(files, SHAPE, SPACING, **PLACE)


def test_missing_file(files):
    with pytest.raises(InputError, match="cannot be read"):
        read_hawc2([*files[:2], files[2].with_name("none.bin")], SHAPE, SPACING, **PLACE)
    with pytest.raises(InputError, match="three"):
        read_hawc2(files[:2], SHAPE, SPACING, **PLACE)
