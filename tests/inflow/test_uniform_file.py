"""OpenFAST's uniform wind files: columns, signs and complaints."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.inflow.field import WindField
from galerna.inflow.mean import Profile
from galerna.inflow.uniform_file import read_uniform

TEXT = """! Wind file with a gust
!Time  Speed  Dir  VertSpd HorShr PwrLaw LinShr Gust Upflow
0.0    12.0   0.0   0.0    0.0    0.14   0.0    0.0   0.0
10.0   14.0  30.0   1.0    0.1    0.14   0.2    3.0   8.0
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "gust.wnd"
    path.write_text(TEXT)
    return path


def test_columns_and_the_sign_of_the_direction(file):
    series, exponent = read_uniform(file, 100.0)
    end = series.at(10.0)
    assert exponent == 0.14
    assert (end.speed, end.gust, end.vertical_speed) == (14.0, 3.0, 1.0)
    assert np.degrees([end.direction, end.upflow]) == pytest.approx([-30.0, 8.0])
    gradients = (end.lateral_gradient, end.vertical_gradient)
    assert gradients == pytest.approx((14 * 0.1 / 100, 14 * 0.2 / 100))


def test_velocity_is_that_of_inflowwind(file):
    """InflowWind manual: V1 along the wind, which turns towards -y, lifted by the upflow."""
    series, exponent = read_uniform(file, 100.0)
    field = WindField(series, Profile.power_law(90.0, exponent))
    x, y, z = 3.0, -20.0, 110.0
    delta, upflow = np.radians([30.0, 8.0])
    sheared = (z / 90) ** 0.14 + (0.1 * (y * np.cos(delta) + x * np.sin(delta)) + 0.2 * 20) / 100
    along = 14.0 * sheared + 3.0
    horizontal = along * np.cos(upflow) - np.sin(upflow)
    wanted = [
        horizontal * np.cos(delta),
        -horizontal * np.sin(delta),
        along * np.sin(upflow) + np.cos(upflow),
    ]
    np.testing.assert_allclose(field.velocity(np.array([[x, y, z]]), 10.0)[0], wanted, rtol=1e-9)


def test_one_row_is_a_steady_wind(tmp_path):
    (tmp_path / "steady.hh").write_text("0 8 0 0 0 0.2 0 0\n")
    series, _ = read_uniform(tmp_path / "steady.hh", 100.0)
    assert series.at(0.0) == series.at(1000.0)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("0 8 0 0 0 0.2 0 0\n1 8 0 0 zero 0.2 0 0\n", r":2: expected 8 numbers"),
        ("0 8 0 0 0\n", r":1: expected 8 numbers, found 5"),
        ("! nothing\n", "no row of numbers"),
        ("0 8 0 0 0 0.2 0 0\n1 8 0 0 0 0.3 0 0\n", "exponent changes"),
        ("1 8 0 0 0 0.2 0 0\n0 8 0 0 0 0.2 0 0\n", "each later"),
        ("0 nan 0 0 0 0.2 0 0\n1 8 0 0 0 0.2 0 0\n", "not finite"),
        ("0 8 0 0 0 nan 0 0\n1 8 0 0 0 nan 0 0\n", ":1: holds values that are not finite"),
        ("0 8 0 0 0 0.2 0 0\n1 8 0 0 0 nan 0 0\n", ":2: holds values that are not finite"),
        ("0 8 0 0 0 0.2 0 0\n1 -999 0 0 0 0.2 0 0\n", ":2: a wind speed of -999 m/s"),
        ("0 8 0 0 0 900 0 0\n", "power-law exponent is 900, expected -1 to 2"),
    ],
)
def test_complaints(tmp_path, text, complaint):
    (tmp_path / "bad.wnd").write_text(text)
    with pytest.raises(InputError, match=complaint):
        read_uniform(tmp_path / "bad.wnd", 100.0)
