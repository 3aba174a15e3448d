"""Results for other tools: OpenFAST's binary output and comma-separated values."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError

if TYPE_CHECKING:
    import xarray

PACKED_WITH_NAME_LENGTH = 4  #: OpenFAST's FileID: equidistant, int16, width of names given
NAME_LENGTH = 20


def to_outb(dataset: xarray.Dataset, path: str | Path) -> None:
    """Write the channels that OpenFAST knows, under its names and in its units, as .outb.

    The format packs every channel into 65536 steps between its extremes. Raises
    InputError if there is no such channel or the records are not equidistant.
    """
    time = _equidistant(dataset)
    columns = list(_openfast_columns(dataset))
    if not columns:
        raise InputError(str(path), "none of the channels has a name in OpenFAST")
    names = ["Time", *(name for name, _, _ in columns)]
    units = ["(s)", *(f"({unit})" for _, unit, _ in columns)]
    data = np.stack([values for *_, values in columns], axis=1)
    scale, offset = _packing(data)
    packed = np.clip(np.rint(data * scale + offset), -32768, 32767).astype("<i2")
    title = (
        f"galerna {dataset.attrs.get('galerna_version', '')}: {dataset.attrs.get('case_name', '')}"
    )
    with Path(path).open("wb") as file:
        file.write(struct.pack("<hh", PACKED_WITH_NAME_LENGTH, NAME_LENGTH))
        file.write(struct.pack("<ii", data.shape[1], data.shape[0]))
        file.write(struct.pack("<dd", time[0], _step(time)))
        file.write(scale.astype("<f4").tobytes() + offset.astype("<f4").tobytes())
        description = title.encode("ascii", "replace")
        file.write(struct.pack("<i", len(description)) + description)
        for text in (*names, *units):
            file.write(text.encode("ascii", "replace")[:NAME_LENGTH].ljust(NAME_LENGTH))
        file.write(packed.tobytes())


def to_csv(dataset: xarray.Dataset, path: str | Path) -> None:
    """Write every channel as a column in SI, with its unit in the head."""
    columns = [("time", "s", dataset["time"].values), *_columns(dataset)]
    head = ",".join(f"{name} [{unit}]" for name, unit, _ in columns)
    table = np.stack([values for *_, values in columns], axis=1)
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt="%.9g")


def _columns(dataset: xarray.Dataset) -> Iterator[tuple[str, str, Array]]:
    """Every channel along time, one column for each place, named by the place's numbers."""
    for name, variable in dataset.data_vars.items():
        for place, values in _places(variable):
            numbers = "".join(f"_{dim}{number}" for dim, number in place.items())
            yield f"{name}{numbers}", variable.attrs.get("units", ""), values


def _places(variable: xarray.DataArray) -> Iterator[tuple[dict[str, int], Array]]:
    """Every place of a channel as numbers from 1 by dimension, with its values over time."""
    shape, dims = variable.shape[1:], variable.dims[1:]
    columns = variable.values.reshape(len(variable), -1).astype(float)
    for column, index in enumerate(np.ndindex(shape)):
        yield {str(d): i + 1 for d, i in zip(dims, index, strict=True)}, columns[:, column]


def _openfast_columns(dataset: xarray.Dataset) -> Iterator[tuple[str, str, Array]]:
    """Channels with an OpenFAST name, scaled to its unit; blades and nodes count from 1."""
    for variable in dataset.data_vars.values():
        pattern = variable.attrs.get("openfast")
        if not pattern:
            continue
        scale, unit = variable.attrs["openfast_scale"], variable.attrs["openfast_unit"]
        for place, values in _places(variable):
            blade = place.pop("blade", 0)
            name = pattern.format(blade=blade, node=next(iter(place.values()), 0))
            yield name, unit, scale * values


def _packing(data: Array) -> tuple[Array, Array]:
    """Scale and offset (n,) that spread each column over int16, as single precision holds them."""
    low, high = data.min(axis=0), data.max(axis=0)
    spread = high - low
    # A channel whose spread drowns in single precision is constant, and kept by its offset.
    constant = spread <= 1e-6 * np.maximum(np.abs(low), np.abs(high))
    scale = np.where(constant, 1.0, 65535.0 / np.where(constant, 1.0, spread))
    offset = np.where(constant, -low, -32768.0 - low * scale)
    return scale.astype("<f4").astype(float), offset.astype("<f4").astype(float)


def _step(time: Array) -> float:
    return float(time[-1] - time[0]) / (len(time) - 1) if len(time) > 1 else 0.0


def _equidistant(dataset: xarray.Dataset) -> Array:
    time = dataset["time"].values
    if len(time) == 0:
        raise InputError("result", "holds no records")
    if len(time) > 2 and np.ptp(np.diff(time)) > 1e-6 * _step(time):
        raise InputError("result", "its records are not equidistant, which .outb needs")
    return time
