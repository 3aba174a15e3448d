"""A view of one block of a document: takes values out of it and says where a bad one stands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from math import inf, isfinite
from typing import Any

import numpy as np

from galerna.errors import InputError
from galerna.turbine.model import Array
from galerna.turbine.windio.yamlfile import Document, Keys

_REQUIRED: Any = object()
_LARGEST = 1e100  # beyond any quantity of a turbine; products of a few stay finite


class Block:
    """A mapping in a document, with the key path that leads to it."""

    def __init__(self, document: Document, data: Any = _REQUIRED, keys: Keys = ()) -> None:
        self.document, self.keys = document, keys
        self.data = document.data if data is _REQUIRED else data
        if not isinstance(self.data, dict):
            raise self.error(f"expected a block of keys, found {describe(self.data)}")

    def error(self, what: str, hint: str = "", *keys: str | int) -> InputError:
        """An error at this block or at ``keys`` inside it."""
        return self.document.error(self.keys + keys, what, hint)

    def has(self, key: str) -> bool:
        return self.data.get(key) is not None

    def value(self, key: str) -> Any:
        """The raw value of a key that must be there."""
        if not self.has(key):
            raise self.error(f"{key!r} is missing", meant(key, self.data))
        return self.data[key]

    def block(self, *path: str) -> Block:
        """The block at the end of a path of keys that must be there."""
        inner = self
        for key in path:
            inner = Block(self.document, inner.value(key), (*inner.keys, key))
        return inner

    def optional(self, *path: str) -> Block:
        """Like ``block``, empty where a key of the path is missing."""
        inner = self
        for key in path:
            data = inner.data[key] if inner.has(key) else {}
            inner = Block(self.document, data, (*inner.keys, key))
        return inner

    def blocks(self, key: str) -> Iterator[Block]:
        """The blocks of a list."""
        items = self.value(key)
        if not isinstance(items, list):
            raise self.error(f"expected a list of blocks, found {describe(items)}", "", key)
        for i, item in enumerate(items):
            yield Block(self.document, item, (*self.keys, key, i))

    def number(
        self, key: str, default: Any = _REQUIRED, low: float = -inf, high: float = inf
    ) -> Any:
        """A finite number between ``low`` and ``high``, or the default where the key is missing."""
        if default is not _REQUIRED and not self.has(key):
            return default
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(f"expected a number, found {describe(value)}", "", key)
        if not (abs(value) < _LARGEST and low <= value <= high):
            raise self.error(f"expected {_range(low, high)}, found {describe(value)}", "", key)
        return float(value)

    def text(self, key: str, default: Any = _REQUIRED) -> str:
        value = self.value(key) if default is _REQUIRED else self.data.get(key, default)
        if not isinstance(value, str):
            raise self.error(f"expected text, found {describe(value)}", "", key)
        return value

    def array(self, key: str, length: int | None = None, low: float = -inf) -> Array:
        """A row of finite numbers (n,) not below ``low``; of ``length`` numbers if given."""
        row = self.value(key)
        if not isinstance(row, list) or not row:
            raise self.error(f"expected a list of numbers, found {describe(row)}", "", key)
        wrong = next(
            (x for x in row if isinstance(x, bool) or not isinstance(x, int | float)), None
        )
        if wrong is not None:
            raise self.error(f"expected numbers alone, found {describe(wrong)}", "", key)
        try:
            values = np.array(row, dtype=float)
        except OverflowError as e:
            raise self.error("holds a number too large to compute with", "", key) from e
        if not np.isfinite(values).all():
            i = int(np.flatnonzero(~np.isfinite(values))[0])
            raise self.error(f"value {i + 1} is {values[i]}; all must be finite", "", key)
        if (np.abs(values) > _LARGEST).any():
            raise self.error("holds a number too large to compute with", "", key)
        if length is not None and len(values) != length:
            raise self.error(f"holds {len(values)} values where {length} are expected", "", key)
        if (values < low).any():
            raise self.error(f"holds {values.min():g}; the least possible is {low:g}", "", key)
        return values

    def grid(self, key: str = "grid", first: float = 0.0, last: float = 1.0) -> Array:
        """A strictly ascending row of at least two numbers from ``first`` to ``last``."""
        grid = self.array(key)
        if len(grid) < 2:
            raise self.error("needs at least two points", "", key)
        step = np.diff(grid)
        if (step <= 0).any():
            i = int(np.flatnonzero(step <= 0)[0])
            raise self.error(
                f"must ascend: value {i + 2} ({grid[i + 1]:g}) follows {grid[i]:g}", "", key
            )
        reach = 1e-4 * (last - first)
        if abs(grid[0] - first) > reach or abs(grid[-1] - last) > reach:
            raise self.error(
                f"covers {grid[0]:g} to {grid[-1]:g}; {first:g} to {last:g} is needed", "", key
            )
        return grid

    def curve(self, key: str, low: float = -inf) -> tuple[Array, Array]:
        """Grid and values, both (n,), of a distribution over the fractions 0 to 1."""
        inner = self.block(key)
        grid = inner.grid()
        return grid, inner.array("values", len(grid), low)


def merged_grid(*grids: Array) -> Array:
    """All points of several grids, ascending; points closer than rounding are one."""
    merged = np.unique(np.concatenate(grids))
    return merged[np.append(True, np.diff(merged) > 1e-9 * (merged[-1] - merged[0]))]


def meant(missing: str, found: Iterable[Any]) -> str:
    """Which of the keys that were found may be a misspelling of a missing one."""
    names = [str(key) for key in found]
    near = get_close_matches(missing, names, n=1, cutoff=0.6)
    return f"{near[0]!r} may be meant for it" if near else ""


def describe(value: Any) -> str:
    """What was found, in a few words."""
    if value is None:
        return "nothing"
    if isinstance(value, dict | list):
        return f"a {'block' if isinstance(value, dict) else 'list'} of {len(value)}"
    text = repr(value)
    return text if len(text) < 40 else text[:37] + "..."


def _range(low: float, high: float) -> str:
    if isfinite(low) and isfinite(high):
        return f"a number from {low:g} to {high:g}"
    if isfinite(low):
        return f"a number of at least {low:g}"
    return f"a number of at most {high:g}" if isfinite(high) else "a finite number"
