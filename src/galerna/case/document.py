"""YAML with line numbers: reads a case file and says where every problem is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from galerna.errors import InputError

LARGEST_FILE = 20_000_000  #: bytes
MOST_VALUES = 500_000  #: after aliases are expanded
DEEPEST = 40

KeyPath = tuple[str | int, ...]


@dataclass(frozen=True)
class Problem:
    """One thing wrong with a case: where in it, what, and what to do."""

    path: KeyPath
    what: str
    hint: str = ""

    @property
    def key(self) -> str:
        """The key path as a person writes it: ``operation.pitch_deg[2]``."""
        words = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in self.path)
        return "".join(words).removeprefix(".")


class CaseError(InputError):
    """Everything that is wrong with a case, in one error; ``problems`` lists it."""

    def __init__(self, document: Document, problems: list[Problem]) -> None:
        self.problems = tuple(problems)
        located = sorted(((document.line(p.path), p) for p in problems), key=lambda pair: pair[0])
        numbered = bool(document.lines)  # a case that is not a file has none
        if len(located) == 1:
            line, problem = located[0]
            where = document.name + (f":{line}" if numbered else "")
            where += f": {problem.key}" if problem.key else ""
            super().__init__(where, problem.what, problem.hint)
            return
        lines = [f"{len(located)} problems"]
        for line, problem in located:
            at = f"line {line}: " if numbered else ""
            key = f"{problem.key}: " if problem.key else ""
            lines.append(f"  {at}{key}{problem.what}")
            lines += [f"      {problem.hint}"] if problem.hint else []
        super().__init__(document.name, "\n".join(lines))


@dataclass
class Document:
    """A case as read: plain values, and the line of every key path."""

    name: str
    text: str
    values: Any = None
    lines: dict[KeyPath, int] = field(default_factory=dict)

    def line(self, path: KeyPath) -> int:
        """Line of a key path, or of the nearest key around it; 1 where there is none."""
        while path and path not in self.lines:
            path = path[:-1]
        return self.lines.get(path, 1)


def read_document(path: Path) -> Document:
    """Read a YAML file; InputError with every problem of its form."""
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise InputError(str(path), f"holds {size} bytes, expected a case below {LARGEST_FILE}")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(str(path), f"cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(str(path), "is not a text in UTF-8") from error
    return parse_document(text, str(path))


def parse_document(text: str, name: str) -> Document:
    """Read YAML from a string; InputError with every problem of its form."""
    document = Document(name, text)
    root = _compose(text, name)
    if root is None or root.id != "mapping":
        raise InputError(f"{name}:1", "expected a mapping of keys to values, as in the examples")
    reader = _Reader(document)
    document.values = reader.read(root, ())
    if reader.problems:
        raise CaseError(document, reader.problems)
    return document


def _compose(text: str, name: str) -> Any:
    """The YAML nodes of a text; InputError with the line where it is not YAML."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    try:
        return YAML(typ="rt", pure=True).compose(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        what = (error.problem or "is not YAML").strip()
        hint = "indent with spaces, not tabs" if "\\t" in what or _has_tab(text, line) else ""
        raise InputError(f"{name}:{line}", f"not valid YAML: {what}", hint) from error
    except RecursionError:
        raise InputError(name, "nested too deep to be a case") from None
    except (YAMLError, ValueError) as error:
        first_line = str(error).splitlines()[0]
        raise InputError(name, f"not valid YAML: {first_line}") from error


def _has_tab(text: str, line: int) -> bool:
    lines = text.splitlines()
    return 0 < line <= len(lines) and "\t" in lines[line - 1]


class _Reader:
    """Walks YAML nodes into plain values, remembering lines and collecting problems."""

    def __init__(self, document: Document) -> None:
        self.document, self.problems = document, list[Problem]()
        self._count = 0

    def read(self, node: Any, path: KeyPath) -> Any:
        self._count += 1
        if self._count > MOST_VALUES or len(path) > DEEPEST:
            raise InputError(
                f"{self.document.name}:{node.start_mark.line + 1}",
                "holds too many values, or aliases that refer to themselves",
            )
        self.document.lines.setdefault(path, node.start_mark.line + 1)
        if node.id == "mapping":
            return dict(self._pairs(node, path))
        if node.id == "sequence":
            return [self.read(child, (*path, i)) for i, child in enumerate(node.value)]
        return self._scalar(node, path)

    def _pairs(self, node: Any, path: KeyPath) -> Iterator[tuple[str, Any]]:
        seen: dict[str, int] = {}
        for key_node, value_node in node.value:
            key = str(key_node.value) if key_node.id == "scalar" else "?"
            line = key_node.start_mark.line + 1
            if key in ("?", "<<"):
                self.document.lines[(*path, key)] = line
                self.problems.append(Problem((*path, key), "keys must be plain names"))
                continue
            if key in seen:
                what = f"given twice, first in line {seen[key]}"
                self.document.lines[(*path, key)] = line
                self.problems.append(Problem((*path, key), what))
                continue
            seen[key] = line
            self.document.lines[(*path, key)] = line
            yield key, self.read(value_node, (*path, key))

    def _scalar(self, node: Any, path: KeyPath) -> Any:
        text, kind = node.value, str(node.tag).rpartition(":")[2]
        try:
            if kind == "int":
                return int(text.replace("_", ""), 0 if text.lstrip("+-").startswith("0x") else 10)
            if kind == "float":
                value = float(
                    text.replace("_", "").lower().replace(".inf", "inf").replace(".nan", "nan")
                )
                if not math.isfinite(value):
                    self.problems.append(Problem(path, f"expected a finite number, found {text}"))
                return value
        except ValueError:
            return text
        if kind == "bool":
            return text.lower() == "true"
        return None if kind == "null" else text
