"""YAML in: safe, bounded, quick on long rows of numbers, with the line of every key on demand."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from galerna.errors import InputError

Keys = tuple[str | int, ...]

LARGEST_FILE = 64_000_000  #: bytes
LARGEST_TEXT = 4_000_000  #: characters beside rows of numbers: a parser in Python is slow
MOST_VALUES = 5_000_000  #: after aliases are followed: a small file can expand without end
DEEPEST_INCLUDE = 4

_ROW = re.compile(r"^( *(?:- )*\w+: )(\[[-+0-9.eE,\s]+\])[ \t]*$", re.MULTILINE)
_BLOCK_TEXT = re.compile(r":[ \t]+[|>]")


@dataclass(frozen=True)
class Document:
    """The content of a YAML file; knows where each key stands."""

    path: Path
    data: Any

    def error(self, keys: Keys, what: str, hint: str = "") -> InputError:
        """An error at a key path, with file and line."""
        file, line = _locate(self.path, keys)
        where = f"{file}, line {line}" if line else str(file)
        dotted = dotted_path(keys)
        return InputError(f"{where}, {dotted}" if dotted else where, what, hint)


def dotted_path(keys: Sequence[str | int]) -> str:
    """Keys as people write them: ``airfoils[2].polars[0].cl``."""
    text = "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in keys)
    return text.removeprefix(".")


def load(path: str | Path) -> Document:
    """Read a YAML file; ``!include NAME.yaml`` takes in another one, as in windIO.

    Raises InputError if the file cannot be read, is not YAML, nests or repeats
    itself without end, or holds more than a turbine can need.
    """
    path = Path(path)
    data = _load(path, 0, {})
    _bounded(path, data)
    return Document(path, data)


def read_text(path: Path) -> str:
    """The text of a UTF-8 file of reasonable size."""
    if not path.is_file():
        raise InputError(str(path), "is not there" if not path.exists() else "is not a file")
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise InputError(str(path), f"larger than {LARGEST_FILE // 1_000_000} MB")
        return path.read_text(encoding="utf-8")
    except OSError as e:
        raise InputError(str(path), f"cannot be read: {e.strerror or e}") from e
    except UnicodeDecodeError as e:
        raise InputError(str(path), f"is not a text file: byte {e.start} is not UTF-8") from e


def _load(path: Path, depth: int, known: dict[Path, Any]) -> Any:
    """The data of a file; ``known`` keeps what was included, so that no file is read twice."""
    if path not in known:
        known[path] = _parse(path, depth, known)
    return known[path]


def _parse(path: Path, depth: int, known: dict[Path, Any]) -> Any:
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    if depth > DEEPEST_INCLUDE:
        raise InputError(str(path), f"files include each other more than {DEEPEST_INCLUDE} deep")
    text, rows = _take_rows(read_text(path))
    if len(text) > LARGEST_TEXT:
        what = f"holds {len(text) // 1_000_000} MB beside rows of numbers, more than any turbine"
        raise InputError(str(path), what)
    try:
        return _parser(path, rows, depth, known).load(text)
    except MarkedYAMLError as e:
        line = f", line {e.problem_mark.line + 1}" if e.problem_mark else ""
        raise InputError(f"{path}{line}", f"is not valid YAML: {e.problem or e}") from e
    except (YAMLError, ValueError, TypeError, OverflowError, AttributeError, KeyError) as e:
        raise InputError(str(path), f"is not valid YAML: {str(e).partition(chr(10))[0]}") from e
    except RecursionError as e:
        raise InputError(str(path), "nests too deeply to be a turbine") from e


def _take_rows(text: str) -> tuple[str, list[list[float]]]:
    """Replace ``key: [1.0, 2.0]`` by a tag and parse the numbers on their own.

    A YAML parser in Python looks at every character of a number several times;
    this takes most of a turbine file out of its hands and leaves the lines as
    they are. A text that spans lines could look like a row, so it stays whole.
    """
    rows: list[list[float]] = []

    def take(match: re.Match[str]) -> str:
        try:
            rows.append(json.loads(match[2]))
        except ValueError:
            return match[0]
        return f"{match[1]}!row {len(rows) - 1}" + match[2].count("\n") * "\n"

    if "!row" in text or _BLOCK_TEXT.search(text):
        return text, rows
    return _ROW.sub(take, text), rows


def _parser(path: Path, rows: list[list[float]], depth: int, known: dict[Path, Any]) -> Any:
    from ruamel.yaml import YAML
    from ruamel.yaml.constructor import SafeConstructor

    class Constructor(SafeConstructor):
        pass

    if rows:
        Constructor.add_constructor("!row", lambda _, node: rows[int(node.value)])
    Constructor.add_constructor(
        "!include", lambda _, node: _load(_included(path, str(node.value)), depth + 1, known)
    )
    yaml = YAML(typ="safe", pure=True)
    yaml.Constructor = Constructor
    return yaml


def _included(path: Path, name: str) -> Path:
    if not name.endswith((".yaml", ".yml")):
        raise InputError(str(path), f"!include {name}: only YAML files can be included here")
    return path.parent / name


def _bounded(path: Path, data: Any) -> None:
    """Refuse documents that expand beyond measure or contain themselves."""
    sizes: dict[int, int] = {}

    def size(value: Any) -> int:
        if not isinstance(value, dict | list):
            return 1
        if id(value) not in sizes:
            sizes[id(value)] = MOST_VALUES + 1  # what a value that contains itself will see
            children = value.values() if isinstance(value, dict) else value
            sizes[id(value)] = 1 + sum(map(size, children))
        return sizes[id(value)]

    try:
        total = size(data)
    except RecursionError as e:
        raise InputError(str(path), "nests too deeply to be a turbine") from e
    if total > MOST_VALUES:
        raise InputError(
            str(path), f"holds more than {MOST_VALUES} values once aliases are followed"
        )


def _locate(path: Path, keys: Keys) -> tuple[Path, int]:
    """File and line (from 1; 0 where unknown) of a key path, through includes."""
    from ruamel.yaml import YAML
    from ruamel.yaml.nodes import MappingNode, SequenceNode

    file, line = path, 0
    try:
        node = YAML(typ="safe", pure=True).compose(read_text(path))
        for i, key in enumerate(keys):
            if isinstance(node, MappingNode):
                pair = next(((k, v) for k, v in node.value if k.value == str(key)), None)
                if pair is None:
                    break
                line, node = pair[0].start_mark.line + 1, pair[1]
            elif isinstance(node, SequenceNode) and isinstance(key, int) and key < len(node.value):
                node = node.value[key]
                line = node.start_mark.line + 1
            else:
                break
            if node.tag == "!include":
                inner_file, inner_line = _locate(path.parent / node.value, keys[i + 1 :])
                return (inner_file, inner_line) if keys[i + 1 :] else (file, line)
    except Exception:  # the place is a help to the reader; its own failure must not hide the error
        return path, 0
    return file, line
