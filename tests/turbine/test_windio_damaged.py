"""Damaged files: always an InputError, never another exception, a hang or a memory without end."""

from __future__ import annotations

import copy
import random
import resource
import time
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_windio
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from galerna.errors import InputError
from galerna.turbine import Turbine, windio
from galerna.turbine.windio.emit import to_yaml

DOCUMENT = small_windio.document()
TEXT = to_yaml(DOCUMENT)
COMPANION = (
    "sources: {hub: a book}\npublished: [{quantity: hub_height, value: 32.0, unit: m, source: b}]\n"
    "nacelle: {yaw_damping: 5.0}\n"
)
ODD_VALUES = [
    None, True, 0, -1, 1e308, -1e308, 10**400, float("nan"), float("inf"), "", "text", [], {},
    [None], [float("nan")], [[1.0]], {"a": 1}, [0.0, 1.0], "2024-01-01", 5,
]  # fmt: skip
QUIET = settings(
    deadline=None, max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def read_or_refuse(path: Path) -> None:
    """The one promise: a turbine without a NaN, or an InputError."""
    try:
        turbine = windio.read(path)
    except InputError:
        return
    assert isinstance(turbine, Turbine)
    assert not [where for where, value in numbers(turbine) if np.isnan(value).any()]


def numbers(value: Any, where: str = "turbine") -> Iterator[tuple[str, Any]]:
    """Every number and array of a turbine, with its place."""
    if isinstance(value, float | np.ndarray):
        yield where, value
    elif is_dataclass(value):
        for f in fields(value):
            yield from numbers(getattr(value, f.name), f"{where}.{f.name}")
    elif isinstance(value, dict | tuple):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from numbers(item, f"{where}[{key}]")


def places(data: Any) -> list[tuple[Any, Any]]:
    """Every (container, key) of a document."""
    found = []
    items = data.items() if isinstance(data, dict) else enumerate(data)
    for key, value in items:
        found.append((data, key))
        if isinstance(value, dict | list):
            found += places(value)
    return found


@QUIET
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 3))
def test_values_dropped_or_replaced(seed: int, count: int, tmp_path: Path) -> None:
    chance = random.Random(seed)
    data = copy.deepcopy(DOCUMENT)
    for _ in range(count):
        container, key = chance.choice(places(data))
        if chance.random() < 0.3:
            del container[key]
        else:
            container[key] = copy.deepcopy(chance.choice(ODD_VALUES))
    path = tmp_path / "damaged.yaml"
    path.write_text(to_yaml(data))
    read_or_refuse(path)


@QUIET
@given(
    cut=st.integers(0, len(TEXT)),
    at=st.integers(0, len(TEXT)),
    noise=st.text(max_size=6),
)
def test_text_cut_off_or_written_over(cut: int, at: int, noise: str, tmp_path: Path) -> None:
    path = tmp_path / "damaged.yaml"
    path.write_text((TEXT[:at] + noise + TEXT[at:])[:cut], encoding="utf-8")
    read_or_refuse(path)


@QUIET
@given(data=st.binary(max_size=60), at=st.integers(0, len(TEXT)))
def test_bytes_that_are_no_text(data: bytes, at: int, tmp_path: Path) -> None:
    path = tmp_path / "damaged.yaml"
    path.write_bytes(TEXT[:at].encode() + data + TEXT[at:].encode())
    read_or_refuse(path)


@QUIET
@given(cut=st.integers(0, len(COMPANION)), at=st.integers(0, len(COMPANION)), noise=st.text())
def test_a_damaged_companion(cut: int, at: int, noise: str, tmp_path: Path) -> None:
    path = tmp_path / "good.yaml"
    path.write_text(TEXT)
    damaged = (COMPANION[:at] + noise + COMPANION[at:])[:cut]
    path.with_name("good.companion.yaml").write_text(damaged, encoding="utf-8")
    read_or_refuse(path)


def alias_bomb() -> str:
    """Ten levels of ten references each: ten thousand million values in a few hundred bytes."""
    levels = ["a0: &a0 [1, 2, 3, 4, 5, 6, 7, 8, 9, 0]"]
    for i in range(1, 11):
        levels.append(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]")
    return "\n".join(levels) + "\n" + TEXT


BOMBS = {
    "aliases": alias_bomb(),
    "a list in itself": "windIO_version: '2.1'\ncomponents: &c [*c]\n",
    "a block in itself": "windIO_version: '2.1'\ncomponents: &c {blade: *c}\n",
    "merged into itself": "a: &a {<<: *a}\n",
    "deep lists": "[" * 20_000,
    "much text": "#" * 5_000_000,
    "deep blocks": "{a: " * 50_000,
    "deep indents": "\n".join(" " * i + "a:" for i in range(3_000)),
    "a long number": "windIO_version: " + "9" * 100_000,
    "a long row": "windIO_version: '2.1'\nx: [" + "1.0, " * 20_000 + "1.0",
    "many brackets": "x: [" + "1 " * 50_000 + "y",
    "a tag of Python": "!!python/object/apply:os.system ['true']",
    "a tag of nobody": "windIO_version: !row 7\n",
    "an include of a folder": "a: !include ..yaml\n",
    "an include of a list": "a: !include [b.yaml]\n",
    "two documents": TEXT + "---\n" + TEXT,
    "one key twice": TEXT + "name: again\n",
    "no block": "- 1\n- 2\n",
    "a word": "turbine",
    "nothing": "",
}


@pytest.mark.parametrize("name", BOMBS)
def test_bombs_are_refused_soon_and_small(name: str, tmp_path: Path) -> None:
    path = tmp_path / "bomb.yaml"
    path.write_text(BOMBS[name])
    before, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    with pytest.raises(InputError):
        windio.read(path)
    assert time.process_time() - start < 20.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 1_000_000  # kB


def test_files_that_include_many_that_include_many_end(tmp_path: Path) -> None:
    for i in range(4):
        lines = [f"k{j}: !include level{i + 1}.yaml" for j in range(200)]
        (tmp_path / f"level{i}.yaml").write_text("\n".join(lines))
    (tmp_path / "level4.yaml").write_text("end: 1\n")
    with pytest.raises(InputError, match="values once aliases are followed"):
        windio.read(tmp_path / "level0.yaml")


def test_a_file_too_large_is_not_opened(tmp_path: Path) -> None:
    path = tmp_path / "large.yaml"
    with path.open("wb") as file:
        file.truncate(10**12)  # sparse: no disk is filled
    with pytest.raises(InputError, match="larger than"):
        windio.read(path)
