"""Mean and range of section quantities along the blade."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.report.style import BLUE, galerna_style, label, new_figure, shown, title_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SPANWISE_CHANNELS = (
    "normal_force",
    "tangential_force",
    "angle_of_attack",
    "lift_coefficient",
    "axial_induction",
    "tangential_induction",
)

FILLING = (0.15, 0.98)  #: of the radius, what the limits of the axes are chosen for


def spanwise_figure(
    dataset: xarray.Dataset, channels: tuple[str, ...] = SPANWISE_CHANNELS
) -> Figure:
    """Mean, 5 to 95 % of the time and extremes of channels along the span, over all blades.

    Raises InputError if the result has none of the channels.
    """
    names = [name for name in channels if name in dataset and "radius" in dataset[name].dims]
    if not names:
        raise InputError("plot", f"the result has none of the channels {', '.join(channels)}")
    rows = (len(names) + 1) // 2
    with galerna_style():
        columns = min(2, len(names))
        figure, axes = new_figure(rows, columns, (9.0, 1.0 + 2.3 * rows), sharex=True)
        for ax, name in zip(axes.flat, names, strict=False):
            _draw(ax, dataset[name])
        for ax in axes.flat[len(names) :]:
            ax.set_visible(False)
        for ax in axes[-1]:
            ax.set_xlabel("Radius [m]")
        axes[0, 0].legend(loc="upper left")
        figure.suptitle(title_of(dataset, "Along the blade"))
    return figure


def _draw(ax: Axes, variable: xarray.DataArray) -> None:
    radius = variable["radius"].values
    values, unit = shown(variable.transpose(..., "radius"))
    samples = values.reshape(-1, len(radius))
    low, high = np.percentile(samples, [5.0, 95.0], axis=0)
    extremes = samples.min(axis=0), samples.max(axis=0)
    ax.fill_between(radius, *extremes, color=BLUE, alpha=0.12, lw=0.0, label="extremes")
    ax.fill_between(radius, low, high, color=BLUE, alpha=0.25, lw=0.0, label="5 to 95 %")
    ax.plot(radius, samples.mean(axis=0), color=BLUE, marker=".", ms=4, label="mean")
    ax.set_title(label(variable, unit))
    ax.margins(x=0.0)
    ax.set_ylim(*_limits(radius, *extremes))


def _limits(radius: Array, low: Array, high: Array) -> tuple[float, float]:
    """Limits that the outer blade fills; root and tip, where the theory ends, may leave them."""
    inner, outer = FILLING
    inside = (radius >= inner * radius[-1]) & (radius <= outer * radius[-1])
    if not inside.any():
        inside[:] = True
    bottom, top = float(low[inside].min()), float(high[inside].max())
    room = 0.06 * (top - bottom) or 1.0
    return bottom - room, top + room
