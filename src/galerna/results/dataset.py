"""A result as a labelled dataset: from its log, or from its NetCDF file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Channel
from galerna.errors import InputError
from galerna.results.log import Layout, Records

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
        return _half_written(path)
    if not path.exists() and log_of(path).exists():
        return _half_written(log_of(path))
    if not path.is_file():
        raise InputError(str(path), "no such result", "galerna run CASE writes one")
    import xarray

    try:
        return xarray.load_dataset(path, engine="netcdf4")
    except (OSError, ValueError) as error:
        raise InputError(str(path), f"is not a NetCDF result ({error})") from error


def _half_written(log: Path) -> xarray.Dataset:
    records = Records(log)
    return dataset_of(records.layout, records, "half-written")


def dataset_of(layout: Layout, records: Records, status: str) -> xarray.Dataset:
    """The records as labelled arrays; those with dimensions beside time in single precision.

    They are read block by block, as those of a long run fill as much memory as the run itself.
    """
    import xarray

    count, places = len(records), layout.slices()
    time = np.empty(count)
    values = {
        channel.name: np.empty(
            (count, *layout.shape(channel)), np.float32 if channel.dims else np.float64
        )
        for channel in layout.channels
    }
    for rows, block in records.blocks():
        time[rows] = block[:, 0]
        for name, place in places.items():
            part = values[name][rows]
            part[...] = block[:, place].reshape(part.shape)
    variables = {
        channel.name: (("time", *channel.dims), values[channel.name], _describe(channel))
        for channel in layout.channels
    }
    used = {name for channel in layout.channels for name in channel.dims}
    coordinates = {"time": time, **{n: layout.coordinates[n] for n in sorted(used)}}
    labelled = {
        name: (name, along, {"units": COORDINATE_UNITS.get(name, "")})
        for name, along in coordinates.items()
    }
    return xarray.Dataset(variables, labelled, {**layout.attributes, "status": status})


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
