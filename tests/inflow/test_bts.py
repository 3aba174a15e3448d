"""TurbSim files: round trips, an independent reader, and headers that lie."""

import struct
import tracemalloc

import numpy as np
import pytest
from openfast_io.turbsim_file import TurbSimFile

from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.inflow.bts import HEADER, read_bts, write_bts
from galerna.inflow.mean import Profile

SHAPE = (6, 4, 5)


def whole_wind(tower_rows=0, **changes):
    rng = np.random.default_rng(11)
    settings = {
        "data": rng.standard_normal((3, *SHAPE)) + np.array([12, 0, 0]).reshape(3, 1, 1, 1),
        "tower": rng.standard_normal((3, SHAPE[0], tower_rows)) if tower_rows else None,
        "spacing": (3.0, 5.0, 4.0),
        "mean_speed": 12.0,
        "hub_height": 90.0,
        "center_above_hub": 6.0,
        "holds_mean": True,
    }
    return Box(**(settings | changes))


def half_a_step(box):
    """Largest error of 16-bit numbers over the range that grid and tower share, with some slack."""
    blocks = [box.data] if box.tower is None else [box.data, box.tower]
    wind = np.concatenate([block.reshape(3, -1) for block in blocks], axis=1)
    return 0.6 * np.ptp(wind, axis=1).max() / 65535


@pytest.mark.parametrize("tower_rows", [0, 3])
@pytest.mark.parametrize("periodic", [True, False])
def test_round_trip(tmp_path, tower_rows, periodic):
    box = whole_wind(tower_rows, periodic=periodic, lead=0.0 if periodic else 7.5)
    write_bts(tmp_path / "a.bts", box)
    back = read_bts(tmp_path / "a.bts")
    np.testing.assert_allclose(back.data, box.data, atol=half_a_step(box))
    assert back.spacing == pytest.approx(box.spacing)
    assert (back.mean_speed, back.hub_height, back.periodic) == (12.0, 90.0, periodic)
    assert (back.bottom, back.top, back.lead) == pytest.approx((box.bottom, box.top, box.lead))
    assert back.holds_mean
    if tower_rows:
        np.testing.assert_allclose(back.tower, box.tower, atol=half_a_step(box))
        assert back.lowest == box.bottom - 8.0


def test_independent_reader_finds_the_same_wind(tmp_path):
    box = whole_wind(tower_rows=2)
    write_bts(tmp_path / "a.bts", box)
    other = TurbSimFile(str(tmp_path / "a.bts"))
    np.testing.assert_allclose(other["u"], box.data, atol=half_a_step(box))
    np.testing.assert_allclose(other["uTwr"], box.tower, atol=half_a_step(box))
    np.testing.assert_allclose(other["y"], box.y)
    np.testing.assert_allclose(other["z"], box.z)
    np.testing.assert_allclose(other["zTwr"], [box.bottom, box.bottom - 4.0])
    np.testing.assert_allclose(other["t"], box.time)


def test_fluctuations_are_written_on_a_mean_wind(tmp_path):
    box = whole_wind(holds_mean=False, data=np.zeros((3, *SHAPE)))
    profile = Profile.power_law(90.0, 0.2)
    write_bts(tmp_path / "a.bts", box, profile)
    back = read_bts(tmp_path / "a.bts")
    wanted = 12.0 * (box.z / 90.0) ** 0.2
    np.testing.assert_allclose(back.data[0].mean(axis=(0, 1)), wanted, atol=1e-3)
    np.testing.assert_allclose(back.fluctuations().data, 0.0, atol=1e-6)
    with pytest.raises(InputError, match="holds the mean wind already"):
        write_bts(tmp_path / "b.bts", back, profile)


def changed(path, **fields):
    """The file with figures of its header changed."""
    names = ["identifier", "nz", "ny", "tower_rows", "nt", "dz", "dy", "dt", "hub_speed"]
    names += ["hub_height", "bottom", *(f"{k}_{c}" for c in "uvw" for k in ("scale", "offset"))]
    names.append("text_length")
    content = path.read_bytes()
    header = dict(zip(names, HEADER.unpack(content[: HEADER.size]), strict=True)) | fields
    path.write_bytes(HEADER.pack(*header.values()) + content[HEADER.size :])
    return path


@pytest.fixture
def file(tmp_path):
    write_bts(tmp_path / "a.bts", whole_wind())
    return tmp_path / "a.bts"


@pytest.mark.parametrize(
    ("fields", "complaint"),
    [
        ({"identifier": 3}, "starts with 3"),
        ({"nt": 10**9, "ny": 10**9, "nz": 10**9}, "is cut short"),
        ({"nt": 7}, "is cut short"),
        ({"nt": 5}, "is longer than its header says"),
        ({"ny": -4}, "points"),
        ({"nz": 1}, "points"),
        ({"text_length": -1}, "letters of text"),
        ({"text_length": 2**31 - 1}, "is cut short"),
        ({"dz": float("nan")}, "dz is nan"),
        ({"dy": 0.0}, "dy is 0"),
        ({"dt": -0.1}, "dt is -0.1"),
        ({"hub_speed": float("inf")}, "hub_speed is inf"),
        ({"hub_height": float("nan")}, "hub_height is nan"),
        ({"scale_v": 0.0}, "scale_v is 0"),
        ({"offset_w": float("nan")}, "offset_w is nan"),
        ({"scale_u": 1e-3}, "holds a wind of"),
    ],
)
def test_absurd_header(file, fields, complaint):
    tracemalloc.start()
    with pytest.raises(InputError, match=complaint):
        read_bts(changed(file, **fields))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1e6


@pytest.mark.parametrize("length", [0, 1, 40, HEADER.size, 200])
def test_truncated(file, length):
    file.write_bytes(file.read_bytes()[:length])
    with pytest.raises(InputError, match="is cut short"):
        read_bts(file)


def test_missing_file_and_folder(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_bts(tmp_path / "none.bts")
    with pytest.raises(InputError, match="cannot be read"):
        read_bts(tmp_path)
    with pytest.raises(InputError, match="cannot be written"):
        write_bts(tmp_path / "none" / "a.bts", whole_wind())


def test_header_is_the_published_one(file):
    content = file.read_bytes()
    assert struct.unpack("<h4i", content[:18]) == (8, 5, 4, 0, 6)
    assert struct.unpack("<3f", content[18:30]) == (4.0, 5.0, 0.25)
