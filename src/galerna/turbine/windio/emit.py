"""YAML out: plain blocks, numbers in rows, every float read back to the same bits."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import Any

_STEP = "  "


def to_yaml(data: Mapping[str, Any]) -> str:
    """A mapping as YAML text."""
    return "\n".join(_mapping(data, "")) + "\n"


def _mapping(data: Mapping[str, Any], indent: str) -> Iterator[str]:
    for key, value in data.items():
        if isinstance(value, Mapping) and value:
            yield f"{indent}{key}:"
            yield from _mapping(value, indent + _STEP)
        elif _is_list_of_blocks(value):
            yield f"{indent}{key}:"
            yield from _blocks(value, indent + _STEP)
        else:
            yield f"{indent}{key}: {_scalar(value)}"


def _blocks(items: Sequence[Mapping[str, Any]], indent: str) -> Iterator[str]:
    for item in items:
        lines = list(_mapping(item, indent + _STEP))
        yield f"{indent}- {lines[0].lstrip()}"
        yield from lines[1:]


def _is_list_of_blocks(value: Any) -> bool:
    if not isinstance(value, list) or not value:
        return False
    return all(isinstance(item, Mapping) and item for item in value)


def _scalar(value: Any) -> str:
    match value:
        case bool() | None:
            return json.dumps(value)
        case float():
            text = repr(float(value))  # a NumPy scalar prints its type
            if not isfinite(value):
                return text.replace("nan", ".nan").replace("inf", ".inf")
            return text.replace("e", ".0e") if "e" in text and "." not in text else text
        case int():
            return str(value)
        case str():
            return json.dumps(value, ensure_ascii=False)
        case list() | tuple():
            return "[" + ", ".join(map(_scalar, value)) + "]"
        case Mapping():
            pairs = (f"{json.dumps(key)}: {_scalar(item)}" for key, item in value.items())
            return "{" + ", ".join(pairs) + "}"
        case _:
            raise TypeError(f"{type(value).__name__} has no YAML form here")
