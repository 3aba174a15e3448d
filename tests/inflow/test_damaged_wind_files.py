"""Damaged wind files: an InputError or a sane wind, never anything else."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from galerna.errors import InputError
from galerna.inflow.box import FASTEST_WIND, Box
from galerna.inflow.bts import HEADER, read_bts, write_bts
from galerna.inflow.hawc2 import read_hawc2
from galerna.inflow.uniform_file import read_uniform

often = settings(
    max_examples=150, deadline=2000, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
MEMORY = 4e6  #: bytes that reading a damaged file of a few kilobytes may take


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("damaged")


@pytest.fixture(scope="module")
def whole(folder):
    data = 12 + np.random.default_rng(1).standard_normal((3, 5, 3, 4))
    write_bts(folder / "whole.bts", Box(data, (3, 5, 4), 12.0, 90.0, holds_mean=True))
    return (folder / "whole.bts").read_bytes()


def read_or_complain(read, *arguments, **named):
    """What a reader answers, or None if it complains as it should; memory is watched."""
    tracemalloc.start()
    try:
        return read(*arguments, **named)
    except InputError:
        return None
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < MEMORY


@often
@given(changes=st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255)), max_size=8))
def test_bts_with_bytes_changed(folder, whole, changes):
    content = bytearray(whole)
    for place, byte in changes:
        content[place % HEADER.size if place % 3 else place % len(content)] = byte
    (folder / "changed.bts").write_bytes(content)
    box = read_or_complain(read_bts, folder / "changed.bts")
    assert box is None or np.isfinite(box.data).all()


@often
@given(length=st.integers(0, 10**6), tail=st.binary(max_size=64))
def test_bts_cut_and_continued(folder, whole, length, tail):
    content = whole[: length % len(whole)] + tail
    (folder / "cut.bts").write_bytes(content)
    box = read_or_complain(read_bts, folder / "cut.bts")
    assert box is None or len(content) == len(whole)


@often
@given(content=st.binary(max_size=400))
def test_bts_of_any_bytes(folder, content):
    (folder / "any.bts").write_bytes(b"\x07\x00" + content)
    read_or_complain(read_bts, folder / "any.bts")


@often
@given(
    numbers=st.binary(max_size=4 * 70),
    shape=st.tuples(*[st.integers(-2, 10**9) | st.integers(2, 5)] * 3),
    spacing=st.tuples(*[st.floats(width=32)] * 3),
)
def test_hawc2_of_any_bytes_and_shape(folder, numbers, shape, spacing):
    paths = [folder / f"{name}.bin" for name in "uvw"]
    for path in paths:
        path.write_bytes(numbers)
    box = read_or_complain(read_hawc2, paths, shape, spacing, mean_speed=10.0, hub_height=80.0)
    assert box is None or np.isfinite(box.data).all()


@often
@given(numbers=st.binary(min_size=96, max_size=96))
def test_hawc2_with_numbers_changed(folder, numbers):
    paths = [folder / f"{name}.bin" for name in "uvw"]
    for path in paths:
        path.write_bytes(numbers)
    box = read_or_complain(
        read_hawc2, paths, (2, 3, 4), (1.0, 1.0, 1.0), mean_speed=10.0, hub_height=80.0
    )
    sane = np.abs(np.frombuffer(numbers, "<f4")) <= FASTEST_WIND  # no NaN is
    assert (box is None) == (not sane.all())


@often
@given(content=st.text(alphabet="0123456789.eE+-dD!, \t\r\nnaif\0", max_size=300))
def test_uniform_file_of_any_text(folder, content):
    path = folder / "any.wnd"
    path.write_bytes(content.encode())
    answer = read_or_complain(read_uniform, path, 126.0)
    if answer is not None:
        series, exponent = answer
        assert np.isfinite([*series.at(0.0), exponent]).all()
