"""Result files: a log while the simulation runs, a NetCDF file when it has ended."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from galerna.contract import Array
from galerna.errors import InputError
from galerna.results.dataset import checkpoint_of, dataset_of, log_of
from galerna.results.earlier import EarlierRecords
from galerna.results.log import Layout, Log, Records

if TYPE_CHECKING:
    import xarray

#: bytes of each variable that HDF5 holds until a file is closed; its own 16 MB double the result
CHUNK_CACHE = 1 << 20


class ResultFile:
    """The result of one run on disk: append records, then ``finish``.

    A run that goes on has ``earlier`` records, which the result begins with. Raises InputError
    if a result stands there already, not the one that goes on, and ``overwrite`` is not set;
    with it, the old result stays until the new one is complete. Raises InputError too if
    another run is writing there.
    """

    def __init__(
        self,
        path: Path,
        layout: Layout,
        overwrite: bool = False,
        earlier: EarlierRecords | None = None,
    ) -> None:
        self.path, self._layout = path, layout
        if earlier is None or earlier.path != path:
            check_free(path, overwrite)
        path.parent.mkdir(parents=True, exist_ok=True)
        log = log_of(path)
        self._log = Log(log, layout) if earlier is None else earlier.log_at(log, layout)

    @property
    def records(self) -> int:
        """How many it holds."""
        return self._log.records

    def append(self, time: float, record: Mapping[str, float | Array]) -> None:
        """Add the record at ``time`` s."""
        self._log.append(time, record)

    def sync(self) -> None:
        """Bring the records to the disk itself."""
        self._log.sync()

    def finish(self, status: str = "complete") -> xarray.Dataset:
        """Turn the log into a NetCDF file and return what it holds.

        Raises InputError if the file cannot be written; the log stays then.
        """
        dataset = dataset_of(self._layout, Records(self._log.path), status)
        write_netcdf(dataset, self.path)
        self._log.close()  # not before: it keeps other runs out
        self._log.path.unlink()
        return dataset


def check_free(path: Path, overwrite: bool) -> None:
    """Raise InputError if a result, whole or half-written, stands at ``path`` already."""
    if path.is_dir():
        raise InputError(str(path), "is a folder, expected the name of a result file (.nc)")
    for existing in (path, log_of(path)):
        if existing.exists() and not overwrite:
            kind = "a result" if existing == path else "the half-written result of a stopped run"
            hint = "name another file with --output, or replace it with --overwrite"
            if checkpoint_of(path).exists():
                hint = f"galerna resume {path} goes on with it; or {hint}"
            raise InputError(str(existing), f"{kind} stands here already", hint)


def write_netcdf(dataset: xarray.Dataset, path: Path) -> None:
    """Write a NetCDF file, complete or not at all; InputError if the disk does not take it."""
    import netCDF4

    netCDF4.set_chunk_cache(CHUNK_CACHE)
    encoding = {name: {"zlib": True, "complevel": 1} for name in dataset.data_vars}
    unfinished = path.with_name(path.name + ".unfinished")
    try:
        dataset.to_netcdf(unfinished, engine="netcdf4", encoding=encoding)
        os.replace(unfinished, path)
    except (OSError, RuntimeError) as error:  # netCDF4 raises RuntimeError for a full disk
        unfinished.unlink(missing_ok=True)
        raise InputError(str(path), f"cannot be written: {error}") from error
