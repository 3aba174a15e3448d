"""One look for every picture: quiet axes, and colours that colour-blind readers tell apart."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from galerna.contract import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

#: Okabe and Ito's palette without its yellow, which does not show on white
BLUE, VERMILION, GREEN, PURPLE, ORANGE = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"
COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE)
GREY = "#6f6f6f"
WIND_COLOURS = "viridis"
DOTS_PER_INCH = 150
SMALLEST_DISPLACEMENT = 1e-9  #: m, below which it is rounding

_SETTINGS: Any = {
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.titlesize": "medium",
    "axes.titlelocation": "left",
    "axes.formatter.useoffset": False,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.1,
    "font.size": 9.5,
    "legend.frameon": False,
    "savefig.dpi": DOTS_PER_INCH,
}

#: how quantities are shown: factor to the unit that a reader of the field expects
_SHOWN = {
    "W": (1e-6, "MW"),
    "N": (1e-3, "kN"),
    "N m": (1e-6, "MN m"),
    "rad": (180.0 / np.pi, "deg"),
    "rad/s": (30.0 / np.pi, "rpm"),
    "N/m": (1e-3, "kN/m"),
}


@contextmanager
def galerna_style() -> Iterator[None]:
    """The settings of every picture, for the time of drawing it."""
    import matplotlib

    with matplotlib.rc_context(_SETTINGS):
        yield


def new_figure(rows: int, columns: int, size: tuple[float, float], **options: Any) -> tuple:
    """A figure that no window owns, and its axes (rows, columns)."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, **options)


def shown(variable: xarray.DataArray) -> tuple[Array, str]:
    """Values and unit of a channel as a reader of the field expects them."""
    unit = str(variable.attrs.get("units", ""))
    factor, unit = _SHOWN.get(unit, (1.0, unit))
    return factor * variable.values.astype(float), unit


def varies(variable: xarray.DataArray) -> bool:
    """Whether a channel changes over time by more than rounding."""
    values = variable.values.astype(float)
    return bool((values.std(axis=0) > 1e-9 * np.abs(values.mean(axis=0))).any())


def is_rigid(variable: xarray.DataArray) -> bool:
    """Whether a channel is the displacement of a part that does not move: rounding alone."""
    if variable.attrs.get("units") != "m":
        return False
    return bool((np.abs(variable.values) < SMALLEST_DISPLACEMENT).all())


def label(variable: xarray.DataArray, unit: str) -> str:
    """Axis label: what the channel means and its unit, the meaning on a line of its own."""
    name = str(variable.attrs.get("long_name", variable.name))
    return f"{name[:1].upper()}{name[1:]}" + (f" [{unit}]" if unit and unit != "1" else "")


def title_of(dataset: xarray.Dataset, what: str) -> str:
    """What is shown, of which turbine and case."""
    parts = [dataset.attrs.get("turbine", ""), dataset.attrs.get("case_name", "")]
    named = ", ".join(part for part in parts if part)
    return f"{what}: {named}" if named else what


def save(figure: Figure, path: Path) -> Path:
    """Write a picture of the kind that the name ends with, and return where it is."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    with galerna_style():
        if path.suffix != ".png":
            figure.savefig(path)
            return path
        # Figure.savefig draws everything twice, first to lay it out; the canvas does it once.
        figure.set_dpi(DOTS_PER_INCH)
        FigureCanvasAgg(figure).print_png(path, pil_kwargs={"compress_level": 3})
    return path
