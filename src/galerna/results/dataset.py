"""A result as a labelled dataset: from its log, or from its NetCDF file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array, Channel
from galerna.errors import InputError
from galerna.results.log import Layout, read_log

if TYPE_CHECKING:
    import xarray

COORDINATE_UNITS = {"time": "s", "radius": "m"}


def log_of(path: Path) -> Path:
    """The log that stands beside a result file while its simulation runs."""
    return path.with_name(path.name + ".log")


def checkpoint_of(path: Path) -> Path:
    """The checkpoint that stands beside a result file from which its run can go on."""
    return path.with_name(path.name + ".checkpoint")


def open_result(path: str | Path) -> xarray.Dataset:
    """A result as a labelled dataset, finished or half-written; attribute ``status`` tells.

    Raises InputError if there is none or it cannot be read.
    """
    path = Path(path)
    if path.suffix == ".log" and path.exists():
        return dataset_of(*read_log(path), "half-written")
    if not path.exists() and log_of(path).exists():
        return dataset_of(*read_log(log_of(path)), "half-written")
    if not path.is_file():
        raise InputError(str(path), "no such result", "galerna run CASE writes one")
    import xarray

    try:
        return xarray.load_dataset(path, engine="netcdf4")
    except (OSError, ValueError) as error:
        raise InputError(str(path), f"is not a NetCDF result ({error})") from error


def dataset_of(layout: Layout, rows: Array, status: str) -> xarray.Dataset:
    """The records as labelled arrays; those with dimensions beside time in single precision."""
    import xarray

    places = layout.slices()
    variables = {
        channel.name: (
            ("time", *channel.dims),
            _values(layout, channel, rows[:, places[channel.name]]),
            _describe(channel),
        )
        for channel in layout.channels
    }
    used = {name for channel in layout.channels for name in channel.dims}
    coordinates = {"time": rows[:, 0], **{n: layout.coordinates[n] for n in sorted(used)}}
    labelled = {
        name: (name, values, {"units": COORDINATE_UNITS.get(name, "")})
        for name, values in coordinates.items()
    }
    return xarray.Dataset(variables, labelled, {**layout.attributes, "status": status})


def _values(layout: Layout, channel: Channel, columns: Array) -> np.ndarray:
    if not channel.dims:
        return columns[:, 0].copy()
    return columns.reshape(len(columns), *layout.shape(channel)).astype(np.float32)


def _describe(channel: Channel) -> dict[str, str | float]:
    """Unit, meaning and OpenFAST's name of a channel, as attributes."""
    attributes: dict[str, str | float] = {"units": channel.unit, "long_name": channel.long_name}
    if channel.openfast:
        attributes |= {
            "openfast": channel.openfast,
            "openfast_unit": channel.openfast_unit,
            "openfast_scale": channel.openfast_scale,
        }
    return attributes
