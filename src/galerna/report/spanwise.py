"""Mean and range of section quantities along the blade."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.report.style import BLUE, GREY, galerna_style, label, new_figure, shown, title_of

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

FILLING = (0.15, 0.985)  #: of the radius, where the theory holds
MOST_ADDED = 1.5  #: of the range there, what root and tip may widen a panel to


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
    inside = slice(None) if _is_force(variable) else _worth_showing(radius, samples)
    radius, samples = radius[inside], samples[:, inside]
    low, high = np.percentile(samples, [5.0, 95.0], axis=0)
    extremes = samples.min(axis=0), samples.max(axis=0)
    ax.fill_between(radius, *extremes, color=BLUE, alpha=0.12, lw=0.0, label="extremes")
    ax.fill_between(radius, low, high, color=BLUE, alpha=0.25, lw=0.0, label="5 to 95 %")
    ax.plot(radius, samples.mean(axis=0), color=BLUE, marker=".", ms=4, label="mean")
    cut = len(radius) < variable.sizes["radius"]
    ax.set_title(label(variable, unit) + (", without root and tip" if cut else ""))
    ax.margins(x=0.0)
    if _is_force(variable):
        ax.axhline(0.0, color=GREY, lw=0.6, zorder=0)


def _is_force(variable: xarray.DataArray) -> bool:
    return variable.attrs.get("units") == "N/m"


def _worth_showing(radius: Array, samples: Array) -> Array:
    """Stations (r,) bool whose values belong together.

    Angles and inductions run away at the cylinder of the root and at the very tip, where the
    theory ends; they are left out where they would flatten the curve of the blade between.
    """
    inner, outer = FILLING
    inside = (radius >= inner * radius[-1]) & (radius <= outer * radius[-1])
    everywhere = np.full(len(radius), True)
    if inside.sum() < 2 or np.ptp(samples) <= MOST_ADDED * np.ptp(samples[:, inside]):
        return everywhere
    return inside
