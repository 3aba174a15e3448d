"""Power spectral density of rotor and blade loads, with the multiples of the rotor speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.signal import welch

from galerna.contract import Array
from galerna.errors import InputError
from galerna.report.style import BLUE, GREY, galerna_style, label, new_figure, shown, title_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SPECTRA_CHANNELS = (
    "wind_speed",
    "rotor_thrust",
    "rotor_power",
    "aerodynamic_root_out_of_plane_moment",
)
FEWEST_RECORDS = 32


def power_spectrum(dataset: xarray.Dataset, channel: str) -> tuple[Array, Array, str]:
    """Frequencies Hz, one-sided density and its unit of a channel; of blades, the mean.

    Welch's method with half-overlapping Hann windows over a quarter of the record.
    Raises InputError for fewer than 32 records.
    """
    values, unit = shown(dataset[channel])
    time = dataset["time"].values
    if len(time) < FEWEST_RECORDS:
        raise InputError("plot", f"{len(time)} records are too few for a spectrum")
    rate = (len(time) - 1) / (time[-1] - time[0])
    frequency, density = welch(
        values, rate, nperseg=len(time) // 4, axis=0, detrend="linear", scaling="density"
    )
    return frequency[1:], density.reshape(len(frequency), -1).mean(axis=1)[1:], f"({unit})²/Hz"


def spectra_figure(dataset: xarray.Dataset, channels: tuple[str, ...] = SPECTRA_CHANNELS) -> Figure:
    """Spectra of channels with marks at 1P and the blades' passing.

    Raises InputError if the result has none of the channels or too few records.
    """
    names = [name for name in channels if name in dataset]
    if not names:
        raise InputError("plot", f"the result has none of the channels {', '.join(channels)}")
    with galerna_style():
        figure, axes = new_figure(len(names), 1, (9.0, 1.0 + 2.0 * len(names)), sharex=True)
        for ax, name in zip(axes[:, 0], names, strict=True):
            frequency, density, unit = power_spectrum(dataset, name)
            ax.loglog(frequency, density, color=BLUE)
            ax.set_title(label(dataset[name], unit))
            ax.set_xlim(frequency[0], frequency[-1])
            _mark_rotation(ax, dataset, frequency[-1])
        axes[-1, 0].set_xlabel("Frequency [Hz]")
        figure.suptitle(title_of(dataset, "Power spectral density"))
    return figure


def _mark_rotation(ax: Axes, dataset: xarray.Dataset, highest: float) -> None:
    """Lines at 1P and at the multiples of the blade passing frequency, as far as they fit."""
    if "rotor_speed" not in dataset:
        return
    rotation = float(dataset["rotor_speed"].mean()) / (2.0 * np.pi)
    blades = dataset.sizes.get("blade", 3)
    for multiple in (1, blades, 2 * blades, 3 * blades):
        if 0.0 < multiple * rotation < highest:
            ax.axvline(multiple * rotation, color=GREY, lw=0.8, ls=(0, (4, 3)), zorder=0)
            ax.annotate(
                f"{multiple}P",
                (multiple * rotation, 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(2, -2),
                textcoords="offset points",
                va="top",
                color=GREY,
                fontsize="small",
            )
