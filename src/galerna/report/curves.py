"""Steady performance: the power curve and the surfaces over pitch and tip-speed ratio."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array
from galerna.report.style import BLUE, VERMILION, galerna_style, label, new_figure, shown

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CURVES = (("electrical_power", "power"), ("thrust",), ("rotor_speed",), ("pitch",))
SURFACES = ("power_coefficient", "thrust_coefficient")


def power_curve_figure(curve: xarray.Dataset, name: str = "") -> Figure:
    """Power, thrust, rotor speed and pitch over the wind speed of a ``power_curve``."""
    with galerna_style():
        figure, axes = new_figure(2, 2, (9.0, 6.0), sharex=True)
        for ax, variables in zip(axes.flat, CURVES, strict=True):
            _draw(ax, curve, variables)
        for ax in axes[-1]:
            ax.set_xlabel("Wind speed at hub height [m/s]")
        figure.suptitle(f"Steady operation: {name}" if name else "Steady operation")
    return figure


def _draw(ax: Axes, curve: xarray.Dataset, variables: tuple[str, ...]) -> None:
    """Curves of one unit in one panel, named in a legend where there are several."""
    for variable, colour in zip(variables, (VERMILION, BLUE), strict=False):
        values, unit = shown(curve[variable])
        text = label(curve[variable], "")
        ax.plot(curve["wind_speed"], values, color=colour, marker=".", ms=4, label=text)
        ax.set_title(label(curve[variable], unit))
    ax.margins(x=0.0)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    if len(variables) > 1:
        ax.set_title(f"Power [{unit}]")
        ax.legend(loc="lower right")


def performance_surface_figure(surface: xarray.Dataset, name: str = "") -> Figure:
    """Contours of the power and thrust coefficients of a ``performance_surface``.

    Only where the rotor takes power from the wind; the largest power coefficient is marked.
    """
    with galerna_style():
        figure, axes = new_figure(1, 2, (10.0, 4.4), sharey=True)
        power = surface["power_coefficient"]
        for ax, variable in zip(axes[0], SURFACES, strict=True):
            _contours(ax, surface[variable], power)
            ax.set_xlabel("Blade pitch angle [deg]")
        axes[0, 0].set_ylabel("Tip-speed ratio")
        _mark_best(axes[0, 0], power)
        figure.suptitle(f"Rotor performance: {name}" if name else "Rotor performance")
    return figure


def _contours(ax: Axes, variable: xarray.DataArray, power: xarray.DataArray) -> None:
    """Filled contours, covered where the power coefficient is negative."""
    from matplotlib.ticker import MaxNLocator

    pitch, _ = shown(variable["pitch"])
    over = pitch, variable["tip_speed_ratio"].values
    values, driven = (v.transpose("tip_speed_ratio", "pitch").values for v in (variable, power))
    levels = np.array(MaxNLocator(14).tick_values(0.0, float(values[driven > 0.0].max())))
    filled = ax.contourf(*over, values, levels, cmap="viridis")
    _label_contours(ax, over, np.where(driven > 0.0, values, np.nan), levels[1::2])
    if driven.min() < 0.0:
        ax.contourf(*over, driven, [driven.min(), 0.0], colors="white")
    ax.figure.colorbar(filled, ax=ax, format="%.2f")
    ax.set_title(label(variable, ""))
    ax.grid(False)


def _label_contours(ax: Axes, over: tuple[Array, Array], values: Array, levels: Array) -> None:
    """Lines with their values, dark where the filling is light."""
    colours = ["white" if level < 0.6 * levels[-1] else "black" for level in levels]
    lines = ax.contour(*over, values, levels, colors=colours, linewidths=0.6)
    ax.clabel(lines, fmt="%.2f", fontsize="small")


def _mark_best(ax: Axes, power: xarray.DataArray) -> None:
    """A dot at the largest power coefficient, and its figures in the title."""
    best = power.isel(power.argmax(...))  # type: ignore[arg-type]
    pitch, ratio = np.degrees(float(best["pitch"])), float(best["tip_speed_ratio"])
    ax.plot(pitch, ratio, "o", color="white", mec="black", ms=6)
    title = ax.get_title(loc="left")
    ax.set_title(f"{title}, largest {float(best):.3f} at {ratio:.2f}, {pitch:.1f} deg")
