"""Rotor and machine over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from galerna.errors import InputError
from galerna.report.style import (
    COLOURS,
    galerna_style,
    is_rigid,
    label,
    new_figure,
    shown,
    title_of,
    varies,
)

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: shown from top to bottom, as far as a result has them
ROTOR_CHANNELS = (
    "wind_speed",
    "rotor_speed",
    "pitch",
    "rotor_power",
    "rotor_thrust",
    "aerodynamic_root_out_of_plane_moment",
    "aerodynamic_root_in_plane_moment",
)
#: the same of a machine that moves
MACHINE_CHANNELS = (
    "wind_speed",
    "rotor_speed",
    "pitch",
    "electrical_power",
    "shaft_thrust",
    "blade_root_out_of_plane_moment",
    "blade_root_in_plane_moment",
    "tip_out_of_plane_displacement",
    "tower_top_fore_aft_displacement",
    "tower_base_fore_aft_moment",
)

#: the same of a platform that floats
FLOATING_CHANNELS = (
    "wave_elevation",
    "platform_surge",
    "platform_sway",
    "platform_heave",
    "platform_roll",
    "platform_pitch",
    "platform_yaw",
    "fairlead_tension",
)


def main_channels(dataset: xarray.Dataset) -> tuple[str, ...]:
    """What is shown first of a result: of the machine where it moves, of the rotor else."""
    moves = "blade_root_out_of_plane_moment" in dataset or "electrical_power" in dataset
    afloat = FLOATING_CHANNELS if floats(dataset) else ()
    return (MACHINE_CHANNELS if moves else ROTOR_CHANNELS) + afloat


def floats(dataset: xarray.Dataset) -> bool:
    """Whether a result is that of a platform in the sea."""
    return "wave_elevation" in dataset and "platform_surge" in dataset


def machine_figure(dataset: xarray.Dataset) -> Figure:
    """Operation, loads and displacements over time; see ``rotor_figure``."""
    return rotor_figure(dataset, MACHINE_CHANNELS, "Machine over time")


def floating_figure(dataset: xarray.Dataset) -> Figure:
    """Waves, platform and mooring lines over time; see ``rotor_figure``."""
    return rotor_figure(dataset, FLOATING_CHANNELS, "Platform over time")


def rotor_figure(
    dataset: xarray.Dataset,
    channels: tuple[str, ...] = ROTOR_CHANNELS,
    what: str = "Rotor over time",
) -> Figure:
    """Panels of channels over time, one below the other; blades share a panel.

    What does not change is told in the title; displacements of rigid parts are left out beside
    others. Raises InputError if the result has none of the channels.
    """
    present = [name for name in channels if name in dataset and dataset[name].ndim <= 2]
    if not present:
        raise InputError("plot", f"the result has none of the channels {', '.join(channels)}")
    present = [name for name in present if not is_rigid(dataset[name])] or present
    constant = [name for name in present if not varies(dataset[name])]
    names = [name for name in present if name not in constant] or present
    with galerna_style():
        figure, axes = new_figure(len(names), 1, (9.0, 1.2 + 1.45 * len(names)), sharex=True)
        for ax, name in zip(axes[:, 0], names, strict=True):
            _draw(ax, dataset[name])
        axes[-1, 0].set_xlabel("Time [s]")
        fixed = [_figure_of(dataset[name]) for name in constant if name not in names]
        figure.suptitle("\n".join([title_of(dataset, what), ", ".join(fixed)]).strip())
    return figure


def _figure_of(variable: xarray.DataArray) -> str:
    """A channel that does not change, in words."""
    values, unit = shown(variable)
    return f"{variable.attrs.get('long_name', variable.name)} {values.flat[0]:z.4g} {unit}"


def _draw(ax: Axes, variable: xarray.DataArray) -> None:
    values, unit = shown(variable)
    time = variable["time"].values
    ax.set_title(label(variable, unit))
    ax.margins(x=0.0)
    if variable.ndim == 1:
        ax.plot(time, values, color=COLOURS[0])
        return
    dim = variable.dims[1]
    if (values == values[:, :1]).all():
        ax.plot(time, values[:, 0], color=COLOURS[0], label=f"every {dim}")
    else:
        for i, place in enumerate(variable[dim].values):
            name = f"{dim} {place:g}".replace("_", " ")
            ax.plot(time, values[:, i], color=COLOURS[i % len(COLOURS)], label=name)
    ax.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 0.97), borderaxespad=0.0)
