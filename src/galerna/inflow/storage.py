"""What the readers and writers of wind files share: opening, and checks of headers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from galerna.errors import InputError


@contextmanager
def open_binary(path: Path | str, mode: str = "rb") -> Iterator[BinaryIO]:
    """The open file; what the system answers when it cannot is an InputError."""
    try:
        with open(path, mode) as file:
            yield file  # type: ignore[misc]
    except OSError as error:
        doing = "written" if "w" in mode else "read"
        raise InputError(str(path), f"cannot be {doing}: {error.strerror or error}") from error


def check_size(path: Path | str, expected: int, hint: str = "") -> None:
    """InputError unless the file has the size in bytes that its header describes."""
    found = Path(path).stat().st_size
    if found != expected:
        what = "is cut short" if found < expected else "is longer than its header says"
        raise InputError(str(path), f"{what}: {found} bytes, expected {expected}", hint)


def positive(path: Path | str, **figures: float) -> None:
    """InputError naming the first figure that is not a finite number above 0."""
    for name, value in figures.items():
        if not (math.isfinite(value) and value > 0.0):
            what = f"{name} is {value:g}, expected a number above 0"
            raise InputError(str(path), what, "the header is damaged")


def finite(path: Path | str, **figures: float) -> None:
    """InputError naming the first figure that is not a finite number."""
    for name, value in figures.items():
        if not math.isfinite(value):
            what = f"{name} is {value:g}, expected a finite number"
            raise InputError(str(path), what, "the header is damaged")
