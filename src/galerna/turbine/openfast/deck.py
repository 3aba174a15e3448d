"""One file of an OpenFAST deck: values by keyword, tables by header, errors by line.

OpenFAST files are lines of ``value Keyword - description``; airfoil files have
``value Keyword ! description`` and ROSCO's DISCON.IN ``values ! Keyword - description``.
The line a keyword stands on changes from version to version, so nothing here
counts lines; case, underscores and brackets of a keyword do not matter either
(``Wake_Mod`` is ``WakeMod``, ``BldFile(1)`` is ``BldFile1``).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import pairwise
from math import inf
from pathlib import Path

import numpy as np

from galerna.errors import InputError, did_you_mean
from galerna.turbine.model import Array

LARGEST_FILE = 10_000_000  #: bytes; the largest real deck file is a few hundred kB
LONGEST_LINE = 100_000  #: characters
LARGEST_NUMBER = 1e30  #: in any unit: more is a slip, and its square must not overflow
MOST_NAMES_IN_A_HINT = 20
_WORD = re.compile(r"""@?"[^"]*"|@?'[^']*'|[^\s,]+""")
_NAME = re.compile(r"[A-Za-z_][\w()\[\]]*")
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdDqQ]?([+-]?\d+))?")
_RULE = ("---", "===", "!", "#")
_FLAGS = {"true": True, "t": True, ".true.": True, "false": False, "f": False, ".false.": False}
_NOTHING = {"", "none", "na", "n/a", "unused", "nan", "null"}


@dataclass(frozen=True)
class Entry:
    """The values before a keyword, and the line they stand on."""

    keyword: str
    values: tuple[str, ...]
    line: int


class Deck:
    """A file, or a part of one, with its keywords."""

    def __init__(self, path: Path, lines: Sequence[str], first_line: int = 1) -> None:
        self.path, self.lines, self.first_line = path, lines, first_line
        self.entries: dict[str, list[Entry]] = {}
        for number, line in enumerate(lines, first_line):
            words, comment = split_line(line)
            if words and words[0].lower() == "outlist":
                break
            entry = _entry(words, comment, number)
            if entry:
                self.entries.setdefault(_plain(entry.keyword), []).append(entry)

    @classmethod
    def open(cls, path: Path, asked_by: str = "") -> Deck:
        """Read a file; ``asked_by`` says which line names it. Raises InputError."""
        where = asked_by or str(path)
        try:
            if not path.is_file():
                raise InputError(where, f"there is no file {path}", "is the deck complete?")
            if path.stat().st_size > LARGEST_FILE:
                raise InputError(where, f"{path} is larger than {LARGEST_FILE // 10**6} MB")
            text = path.read_bytes().decode("utf-8", errors="replace")
        except (OSError, ValueError) as e:
            raise InputError(where, f"{str(path)!r} cannot be read: {e}") from e
        lines = text.splitlines()
        if any(len(line) > LONGEST_LINE for line in lines):
            raise InputError(where, f"{path} is not a deck file: a line is endless")
        return cls(path, lines)

    def error(self, what: str, hint: str = "", line: int | None = None) -> InputError:
        where = str(self.path) if line is None else f"{self.path}, line {line}"
        return InputError(where, what, hint)

    # values by keyword --------------------------------------------------------

    def has(self, keyword: str) -> bool:
        return _plain(keyword) in self.entries

    def entry(self, keyword: str) -> Entry:
        """The first line with this keyword."""
        found = self.entries.get(_plain(keyword))
        if not found:
            names = [entries[0].keyword for entries in self.entries.values()]
            near = get_close_matches(keyword, names) or names[:MOST_NAMES_IN_A_HINT]
            raise self.error(f"keyword {keyword!r} is missing", did_you_mean(keyword, near))
        return found[0]

    def is_default(self, keyword: str) -> bool:
        """Whether the keyword is absent or says DEFAULT."""
        return not self.has(keyword) or self.text(keyword).lower() == "default"

    def text(self, keyword: str) -> str:
        return _unquoted(self.entry(keyword).values[0])

    def number(
        self, keyword: str, default: float | None = None, low: float = -inf, high: float = inf
    ) -> float:
        """A finite number; ``default`` where the keyword is absent or says DEFAULT."""
        if default is not None and self.is_default(keyword):
            return default
        return self.numbers(keyword, 1, low, high)[0]

    def integer(
        self, keyword: str, default: int | None = None, low: int = 0, high: float = inf
    ) -> int:
        value = self.number(keyword, default, low, high)
        if value != int(value):
            entry = self.entry(keyword)
            raise self.error(f"{keyword} is {value:g}; expected a whole number", "", entry.line)
        return int(value)

    def numbers(
        self, keyword: str, count: int, low: float = -inf, high: float = inf
    ) -> list[float]:
        """The first ``count`` values before the keyword, all finite and within the bounds."""
        entry = self.entry(keyword)
        if len(entry.values) < count:
            raise self.error(
                f"{keyword} has {len(entry.values)} values; expected {count}", "", entry.line
            )
        found = [self._number(word, keyword, entry.line) for word in entry.values[:count]]
        for value in found:
            if not low <= value <= high:
                raise self.error(
                    f"{keyword} is {value:g}; expected {_range(low, high)}", "", entry.line
                )
        return found

    def flag(self, keyword: str, default: bool) -> bool:
        if self.is_default(keyword):
            return default
        word = self.text(keyword).lower()
        if word not in _FLAGS:
            line = self.entry(keyword).line
            raise self.error(f"{keyword} is {word!r}; expected True or False", "", line)
        return _FLAGS[word]

    # other files ---------------------------------------------------------------

    def names_file(self, keyword: str) -> bool:
        return self.has(keyword) and self.text(keyword).lower() not in _NOTHING

    def file(self, keyword: str) -> Deck:
        """The file that a keyword names, relative to this one."""
        return self.file_at(self.text(keyword), keyword, self.entry(keyword).line)

    def file_at(self, name: str, keyword: str, line: int) -> Deck:
        return Deck.open(self.beside(name), f"{self.path}, line {line} ({keyword})")

    def beside(self, name: str) -> Path:
        """A path relative to this file's folder, written with either slash."""
        return self.path.parent / name.strip().replace("\\", "/")

    def listed_files(self, count_keyword: str, keyword: str) -> list[tuple[str, int]]:
        """Names and line numbers of a list of files: the first has the keyword, the others none."""
        count = self.integer(count_keyword, low=1)
        start = self.entry(keyword).line
        found = []
        for line in range(start, min(start + count, self.first_line + len(self.lines))):
            words, _ = split_line(self.lines[line - self.first_line])
            if not words or words[0].startswith(_RULE):
                break
            found.append((_unquoted(words[0]), line))
        if len(found) < count:
            raise self.error(
                f"{count_keyword} says {count} files; {len(found)} are listed", "", start
            )
        return found

    # tables --------------------------------------------------------------------

    def rows(self, after: int, count: int, columns: int, what: str) -> tuple[Array, int]:
        """``count`` rows of at least ``columns`` numbers after line ``after``, and the last line.

        Blank lines and comments between the rows are passed over.
        """
        found: list[list[float]] = []
        line = after
        for line in range(after + 1, self.first_line + len(self.lines)):
            if len(found) == count:
                line -= 1
                break
            words, _ = split_line(self.lines[line - self.first_line])
            if not words:
                continue
            if len(words) < columns or not _NUMBER.fullmatch(words[0]):
                break
            found.append([self._number(word, what, line) for word in words[:columns]])
        if len(found) < count:
            raise self.error(
                f"{what}: expected {count} rows of {columns} numbers, found {len(found)}",
                "the count and the table must agree",
                line,
            )
        return np.array(found).reshape(count, columns), line

    def table(self, count_keyword: str, header: str, least: int = 1) -> dict[str, Array]:
        """Columns by (plain) name of the table whose header starts with ``header``."""
        count = self.integer(count_keyword, low=least)
        line, names = self.header(header)
        values, _ = self.rows(self._after_units(line), count, len(names), f"table {header} ...")
        return {_plain(name): values[:, i] for i, name in enumerate(names)}

    def column(self, table: dict[str, Array], name: str) -> Array:
        """A column of ``table`` that must be there."""
        if _plain(name) not in table:
            raise self.error(f"the table has no column {name!r}", did_you_mean(name, table))
        return table[_plain(name)]

    def header(self, first: str) -> tuple[int, list[str]]:
        """Line number and words of the header that starts with a column's name."""
        for line, text in enumerate(self.lines, self.first_line):
            words, _ = split_line(text)
            if words and _plain(words[0]) == _plain(first):
                return line, words
        raise self.error(f"there is no table whose header starts with {first!r}")

    def parts(self, keyword: str) -> Iterator[Deck]:
        """The file cut at each line with a keyword, from the first of them on."""
        starts = [entry.line for entry in self.entries.get(_plain(keyword), [])]
        for start, end in pairwise([*starts, self.first_line + len(self.lines)]):
            lines = self.lines[start - self.first_line : end - self.first_line]
            yield Deck(self.path, lines, start)

    def _after_units(self, header: int) -> int:
        """The last line before the rows: that of the units, where there is one."""
        following = header - self.first_line + 1
        words = split_line(self.lines[following])[0] if following < len(self.lines) else []
        return header if words and _NUMBER.fullmatch(words[0]) else header + 1

    def _number(self, word: str, what: str, line: int) -> float:
        match = _NUMBER.fullmatch(_unquoted(word))
        value = float(f"{match[1]}e{match[2] or 0}") if match else inf
        if abs(value) > LARGEST_NUMBER:
            raise self.error(f"{what}: expected a finite number, found {word!r}", "", line)
        return value


def split_line(line: str) -> tuple[list[str], str]:
    """Words before the comment, and the comment with the ``!`` or ``-`` that starts it."""
    words: list[str] = []
    for match in _WORD.finditer(line):
        word = match[0]
        if word.startswith("!") or word == "-" or re.match(r"-[A-Za-z]", word):
            return words, line[match.start() :]
        if word[0] not in "\"'@" and "!" in word:
            return [*words, word.partition("!")[0]], line[match.start() + word.index("!") :]
        words.append(word)
        if len(words) > 1 and _NAME.match(word) and word.endswith("-"):
            words[-1] = word.rstrip("-")
            return words, "-" + line[match.end() :]
    return words, ""


def _entry(words: list[str], comment: str, line: int) -> Entry | None:
    """The keyword of a line: the last word before the comment, or the first one inside it."""
    if not words or words[0].startswith(_RULE[:2]):
        return None
    if not comment:
        named = len(words) > 1 and _is_keyword(words[1])
        return Entry(words[1], (words[0],), line) if named else None
    if len(words) > 1 and _is_keyword(words[-1]):
        return Entry(words[-1], tuple(words[:-1]), line)
    inside = comment[1:].split(maxsplit=1)
    if comment.startswith("!") and inside and _is_keyword(inside[0]):
        return Entry(inside[0], tuple(words), line)
    return None


def _is_keyword(word: str) -> bool:
    return bool(_NAME.fullmatch(word)) and word.lower() not in (*_FLAGS, "default")


def _plain(keyword: str) -> str:
    return re.sub(r"[()\[\]_]", "", keyword).lower()


def _unquoted(word: str) -> str:
    return word.lstrip("@").strip("\"'").strip()


def _range(low: float, high: float) -> str:
    if high == inf:
        return f"at least {low:g}"
    return f"at most {high:g}" if low == -inf else f"between {low:g} and {high:g}"
