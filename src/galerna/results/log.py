"""The append-only log of a running simulation.

One line of magic, one line of JSON that describes the records, then the records:
rows of little-endian float64, the time first. Every row goes to the system in one
write, so a run that is killed leaves all of them but the one in the making.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from io import FileIO
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO

import numpy as np

from galerna.contract import Array, Channel
from galerna.errors import ConvergenceError, InputError

MAGIC = b"galerna log 1\n"
LONGEST_HEADER = 64 * 1024 * 1024
BLOCK = 4 * 1024 * 1024  #: bytes that are read at a time


@dataclass(frozen=True, eq=False)
class Layout:
    """The channels of a record, the coordinates of their dimensions and the run's attributes."""

    channels: tuple[Channel, ...]
    coordinates: Mapping[str, Array]
    attributes: Mapping[str, str | float]

    def shape(self, channel: Channel) -> tuple[int, ...]:
        """Shape of one record of a channel."""
        return tuple(len(self.coordinates[name]) for name in channel.dims)

    def slices(self) -> dict[str, slice]:
        """Where each channel stands in a row."""
        sizes = [int(np.prod(self.shape(channel), dtype=int)) for channel in self.channels]
        ends = np.cumsum([1, *sizes])
        return {
            channel.name: slice(int(first), int(end))
            for channel, (first, end) in zip(self.channels, pairwise(ends), strict=True)
        }

    @property
    def width(self) -> int:
        """Number of values in a row, time included."""
        return 1 + sum(int(np.prod(self.shape(c), dtype=int)) for c in self.channels)

    def to_json(self) -> str:
        return json.dumps(
            {
                "channels": [asdict(channel) for channel in self.channels],
                "coordinates": {k: np.asarray(v).tolist() for k, v in self.coordinates.items()},
                "attributes": dict(self.attributes),
            }
        )

    @classmethod
    def from_json(cls, text: bytes) -> Layout:
        entries = json.loads(text)
        channels = tuple(
            Channel(**{**entry, "dims": tuple(entry["dims"])}) for entry in entries["channels"]
        )
        coordinates = {k: np.array(v, dtype=float) for k, v in entries["coordinates"].items()}
        return cls(channels, coordinates, entries["attributes"])


class Log:
    """The log of a run, open for writing.

    With ``keep``, it goes on after so many records of the log that stands there; those that
    follow are cut off. Raises InputError where that holds less, it cannot be written, or another
    run is writing it.
    """

    def __init__(self, path: Path, layout: Layout, keep: int | None = None) -> None:
        self.path = path
        self.records = keep or 0  #: in it
        self._slices = tuple(layout.slices().items())
        self._row = np.zeros(layout.width, dtype="<f8")
        self._file = _opened(path)
        _claim(self._file, path)
        if keep is not None:
            self._file.truncate(Records(path).end_of(keep))
            return
        self._file.truncate(0)
        self._write(MAGIC + layout.to_json().encode() + b"\n")

    def append(self, time: float, record: Mapping[str, float | Array]) -> None:
        """Add the record at ``time`` s.

        Raises ConvergenceError if a channel is not a number, InputError if the disk is full.
        """
        row = self._row
        row[0] = time
        for name, place in self._slices:
            value = record[name]
            row[place] = value.ravel() if isinstance(value, np.ndarray) else value
        if not np.isfinite(row.sum()):
            bad = next(
                (n for n, place in self._slices if not np.isfinite(row[place]).all()), "time"
            )
            raise ConvergenceError("results", f"channel {bad!r} is not a number", time=time)
        self._write(row.tobytes())
        self.records += 1

    def extend(self, rows: Array) -> None:
        """Add the rows (n, width) of another log."""
        self._write(np.ascontiguousarray(rows, dtype="<f8").tobytes())
        self.records += len(rows)

    def sync(self) -> None:
        """Bring what was written to the disk itself."""
        os.fsync(self._file.fileno())

    def close(self) -> None:
        self._file.close()

    def _write(self, data: bytes) -> None:
        try:
            written = self._file.write(data)
        except OSError as error:
            raise InputError(str(self.path), f"cannot be written: {error.strerror}") from error
        if written != len(data):  # what a disk does with its last bytes
            raise InputError(str(self.path), "cannot be written: the disk is full")


def _opened(path: Path) -> FileIO:
    try:
        return path.open("ab", buffering=0)
    except OSError as error:
        raise InputError(str(path), f"cannot be written: {error.strerror}") from error


def _claim(file: FileIO, path: Path) -> None:
    """Keep other runs out until the file is closed or the process is gone, where a system can.

    Raises InputError if another run is in.
    """
    try:
        import fcntl
    except ImportError:  # Windows
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        hint = "name another file with --output, or let that run end"
        raise InputError(str(path), "another run is writing this result", hint) from None
    except OSError:  # a file system without locks
        return


class Records:
    """The records of a log on disk, read as they are wanted; one cut short at the end is left out.

    Raises InputError if the file is not a log.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with path.open("rb") as file:
            self.layout = _read_layout(file, path)
            self._start = file.tell()
        self._count = (path.stat().st_size - self._start) // (8 * self.layout.width)

    def __len__(self) -> int:
        return self._count

    def blocks(self) -> Iterator[tuple[slice, Array]]:
        """Rows (n, width) in turn, a few megabytes each, and which of all they are."""
        width = self.layout.width
        many = max(1, BLOCK // (8 * width))
        with self.path.open("rb") as file:
            file.seek(self._start)
            for first in range(0, self._count, many):
                rows = slice(first, min(first + many, self._count))
                values = np.fromfile(file, dtype="<f8", count=(rows.stop - first) * width)
                yield rows, values.reshape(-1, width)

    def end_of(self, count: int) -> int:
        """Where the first ``count`` end, in bytes; InputError if the log holds less."""
        if count > len(self):
            raise InputError(str(self.path), f"holds less than the {count} records that it had")
        return self._start + 8 * self.layout.width * count

    def first(self, count: int) -> Array:
        """The first ``count`` rows (count, width)."""
        with self.path.open("rb") as file:
            file.seek(self._start)
            values = np.fromfile(file, dtype="<f8", count=count * self.layout.width)
        return values.reshape(count, self.layout.width)


def _read_layout(file: BinaryIO, path: Path) -> Layout:
    """Read up to the first record."""
    if file.readline(len(MAGIC)) != MAGIC:
        raise InputError(str(path), "is not a log of galerna")
    try:
        layout = Layout.from_json(file.readline(LONGEST_HEADER))
        layout.slices()  # a channel without its coordinate shows here
    except (ValueError, KeyError, TypeError) as error:
        found = f"the description of the records is damaged ({error})"
        raise InputError(str(path), found) from error
    return layout
