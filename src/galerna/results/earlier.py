"""The records that a run has written before it goes on."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.results.dataset import log_of, open_result
from galerna.results.log import Layout, Log, Records


@dataclass(frozen=True)
class EarlierRecords:
    """The first so many records of a result, whole or half-written."""

    path: Path
    records: int

    def require_run(self, run: str) -> None:
        """InputError where the result does not come from the run of this name."""
        log = log_of(self.path)
        found = Records(log).layout.attributes if log.exists() else open_result(self.path).attrs
        if found.get("run") != run:
            what = "this result and its checkpoint come from different runs"
            raise InputError(str(self.path), what, "start again with galerna run")

    def log_at(self, path: Path, layout: Layout) -> Log:
        """A log with these records and no others, open for more.

        In place of the result's own log, or a new one; InputError where the result holds less.
        """
        if path == log_of(self.path) and path.exists():
            return Log(path, layout, keep=self.records)
        rows = self._rows(layout)
        log = Log(path, layout)
        log.extend(rows)
        return log

    def _rows(self, layout: Layout) -> Array:
        """Rows (records, width) as they stand in a log."""
        log = log_of(self.path)
        if log.exists():
            written = Records(log)
            self._require(len(written))
            return written.first(self.records)
        rows = self._finished_rows(layout)
        self._require(len(rows))
        return rows[: self.records]

    def _require(self, found: int) -> None:
        if found < self.records:
            what = f"holds {found} records, the checkpoint was written after {self.records}"
            raise InputError(str(self.path), what, "start again with galerna run")

    def _finished_rows(self, layout: Layout) -> Array:
        dataset = open_result(self.path)
        rows = np.zeros((len(dataset["time"]), layout.width))
        rows[:, 0] = dataset["time"]
        for name, place in layout.slices().items():
            rows[:, place] = dataset[name].values.reshape(rows[:, place].shape)
        return rows
