"""Every picture of a result, as files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from galerna.errors import InputError, did_you_mean
from galerna.report.inflow import RotorCircle, inflow_figure
from galerna.report.rotor import (
    MACHINE_CHANNELS,
    ROTOR_CHANNELS,
    floating_figure,
    floats,
    machine_figure,
    main_channels,
    rotor_figure,
)
from galerna.report.spanwise import spanwise_figure
from galerna.report.spectra import FEWEST_RECORDS, spectra_figure, varying
from galerna.report.style import save

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from galerna.contract import Inflow


def plot_result(
    dataset: xarray.Dataset,
    folder: Path,
    channels: Sequence[str] = (),
    wind: Inflow | None = None,
) -> list[Path]:
    """Write PNGs of a result into ``folder`` and return where they are.

    With ``channels`` only those, over time or along the span; ``wind`` adds slices of
    the inflow. Raises InputError for unknown channels or a result without records.
    """
    if dataset.sizes["time"] < 2:
        raise InputError("plot", f"the result holds {dataset.sizes['time']} records")
    for name in channels:
        if name not in dataset:
            valid = [str(n) for n in dataset.data_vars]
            raise InputError(f"channel {name!r}", "is not in the result", did_you_mean(name, valid))
    folder.mkdir(parents=True, exist_ok=True)
    figures = _chosen(dataset, tuple(channels)) if channels else _usual(dataset, wind)
    return [save(draw(), folder / f"{name}.png") for name, draw in figures]


def _usual(
    dataset: xarray.Dataset, wind: Inflow | None
) -> Iterator[tuple[str, Callable[[], Figure]]]:
    if MACHINE_CHANNELS[-1] in main_channels(dataset):
        yield "machine", lambda: machine_figure(dataset)
    if floats(dataset):
        yield "platform", lambda: floating_figure(dataset)
    if any(name in dataset for name in ROTOR_CHANNELS):
        yield "rotor", lambda: rotor_figure(dataset)
    if "radius" in dataset.dims:
        yield "spanwise", lambda: spanwise_figure(dataset)
    if dataset.sizes["time"] >= FEWEST_RECORDS and varying(dataset):
        yield "spectra", lambda: spectra_figure(dataset)
    if wind is not None:
        rotor = RotorCircle(dataset.attrs["hub_height_m"], dataset.attrs["rotor_radius_m"])
        duration, name = dataset.attrs["duration_s"], dataset.attrs["case_name"]
        yield "inflow", lambda: inflow_figure(wind, rotor, duration, name=name)


def _chosen(
    dataset: xarray.Dataset, channels: tuple[str, ...]
) -> Iterator[tuple[str, Callable[[], Figure]]]:
    """The channels asked for: those with a radius along the span, the others over time."""
    along = tuple(name for name in channels if "radius" in dataset[name].dims)
    over_time = tuple(name for name in channels if name not in along)
    if over_time:
        yield "rotor", lambda: rotor_figure(dataset, over_time)
        if dataset.sizes["time"] >= FEWEST_RECORDS and varying(dataset, over_time):
            yield "spectra", lambda: spectra_figure(dataset, over_time)
    if along:
        yield "spanwise", lambda: spanwise_figure(dataset, along)
