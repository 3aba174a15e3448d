"""Tables for a terminal: statistics of a result, a turbine, validation, references."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from galerna.channel_names import openfast_names
from galerna.report.rotor import main_channels
from galerna.report.style import is_rigid, shown

if TYPE_CHECKING:
    import xarray

    from galerna.contract import Array, Channel
    from galerna.coupling.gains import Tuning
    from galerna.turbine.summary import Row


def table(title: str, *headings: str, numbers_from: int = 1) -> Table:
    """An empty table whose columns from ``numbers_from`` on are numbers."""
    made = Table(title=escape(title), title_justify="left", title_style="bold", box=None)
    made.padding = (0, 2, 0, 0)
    for i, heading in enumerate(headings):
        made.add_column(escape(heading), justify="right" if i >= numbers_from else "left")
    return made


def print_table(made: Table) -> None:
    """Print a table as wide as it needs where the output is not a terminal."""
    console = Console()
    if not console.is_terminal:
        console.width = 200
    console.print(made)


def statistics(dataset: xarray.Dataset) -> Table:
    """Mean, standard deviation and extremes of the main channels; of blades, over all blades.

    Displacements of rigid parts are left out.
    """
    name = dataset.attrs.get("case_name", "result")
    made = table(name, "quantity", "unit", "mean", "std", "min", "max", numbers_from=2)
    for channel in main_channels(dataset):
        if channel not in dataset or is_rigid(dataset[channel]):
            continue
        values, unit = shown(dataset[channel])
        meaning = str(dataset[channel].attrs.get("long_name", channel))
        spread = values.std(axis=0).mean() if np.ptp(values) > 1e-9 * np.abs(values).max() else 0.0
        figures = (values.mean(), spread, values.min(), values.max())
        made.add_row(meaning, escape(unit), *(f"{figure:z.4g}" for figure in figures))
    return made


def print_statistics(dataset: xarray.Dataset, path: Path | None = None) -> None:
    """The table of a run and where its result is."""
    print_table(statistics(dataset))
    time = dataset["time"].values
    if len(time):
        print(f"{len(time)} records from {time[0]:g} to {time[-1]:g} s")
    if path is not None:
        print(f"result: {path}")


def print_channels(channels: Iterable[Channel], coordinates: Mapping[str, Array]) -> None:
    """The table of channels: what each means, its places, and what OpenFAST calls it."""
    rows = (
        (
            channel.name,
            channel.unit,
            " x ".join(f"{len(coordinates[dim])} {dim}" for dim in channel.dims),
            openfast_names(channel),
            channel.long_name,
        )
        for channel in channels
    )
    print_rows("", ("channel", "unit", "places", "OpenFAST", "meaning"), rows, numbers_from=5)


def print_curve(name: str, curve: xarray.Dataset) -> None:
    """The table of a steady operating curve."""
    bent = [name for name in ("tip_out_of_plane", "tip_twist") if name in curve]
    columns = ("rotor_speed", "pitch", "power", "electrical_power", "thrust", *bent)
    coefficients = ("power_coefficient", "thrust_coefficient")
    values = [shown(curve[column]) for column in columns]
    headings = [f"{c.replace('_', ' ')} [{u}]" for c, (_, u) in zip(columns, values, strict=True)]
    figures = [v for v, _ in values] + [curve[c].values for c in coefficients]
    rows = (
        [f"{wind:g}", *(f"{column[i]:.4g}" for column in figures)]
        for i, wind in enumerate(curve["wind_speed"].values)
    )
    print_rows(name, ("wind speed [m/s]", *headings, "C_P", "C_T"), rows, numbers_from=0)


def print_gains(tuning: Tuning) -> None:
    """The table of gains with what they were computed from and the loop that they close."""
    sensitivity, gains = tuning.sensitivity, tuning.gains
    columns = (
        sensitivity.wind_speed,
        np.degrees(sensitivity.pitch),
        sensitivity.power_by_pitch / 1e6,
        gains.proportional,
        gains.integral,
        *tuning.closed_loop(),
    )
    headings = (
        "wind speed [m/s]", "pitch [deg]", "dP/dpitch [MW/rad]", "K_P [s]", "K_I [-]",
        "frequency [rad/s]", "damping [-]",
    )  # fmt: skip
    rows = ([f"{column[i]:.4g}" for column in columns] for i in range(len(gains.pitch)))
    print_rows(tuning.turbine, headings, rows, numbers_from=0)
    print(f"inertia at the rotor: {tuning.inertia:.4g} kg m2")
    print(f"optimal-mode gain: {tuning.optimal_mode_gain:.6g} N m s2 at the generator")


def print_figures(name: str, figures: Iterable[Row]) -> None:
    """The table of a turbine's figures beside the published ones."""
    rows = (
        (
            row.quantity,
            row.unit,
            number(row.value),
            number(row.published),
            "" if row.difference is None else f"{100.0 * row.difference:+.2f} %",
            row.source,
        )
        for row in figures
    )
    headings = ("quantity", "unit", "galerna", "published", "difference", "source of published")
    print_rows(name, headings, rows, numbers_from=2)


def print_pairs(pairs: Iterable[tuple[str, str]]) -> None:
    """Headings with their texts, one a line; a heading is not repeated."""
    before = ""
    for heading, text in pairs:
        print(f"{'' if heading == before else heading:<12}{text}")
        before = heading


def number(value: float | None) -> str:
    """A figure for a table, empty where there is none."""
    return "" if value is None or not np.isfinite(value) else f"{value:.6g}"


def print_rows(
    title: str, headings: Sequence[str], rows: Iterable[Sequence[str]], numbers_from: int = 1
) -> None:
    """A table of texts; the columns from ``numbers_from`` on stand to the right."""
    made = table(title, *headings, numbers_from=numbers_from)
    for row in rows:
        made.add_row(*(escape(cell) for cell in row))
    print_table(made)
