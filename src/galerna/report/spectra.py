"""Power spectral density of rotor and blade loads, with the multiples of the rotor speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.signal import welch

from galerna.contract import Array
from galerna.errors import InputError
from galerna.report.style import (
    BLUE,
    GREY,
    galerna_style,
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

SPECTRA_CHANNELS = (
    "wind_speed",
    "rotor_thrust",
    "rotor_power",
    "aerodynamic_root_out_of_plane_moment",
    "blade_root_out_of_plane_moment",
    "tower_base_fore_aft_moment",
)
FEWEST_RECORDS = 32
TURNS = 5  #: of the rotor in a segment, for 1P to stand clear of the lowest frequencies
DECADES = 10  #: below the peak, further down is rounding


def power_spectrum(dataset: xarray.Dataset, channel: str) -> tuple[Array, Array, str]:
    """Frequencies Hz, one-sided density and its unit of a channel; of blades, the mean.

    Welch's method (1967) with half-overlapping Hann windows over whole turns of the rotor, so
    that its multiples fall on frequencies: a quarter of the record, at least five turns where
    it has them. Raises InputError for fewer than 32 records.
    """
    values, unit = shown(dataset[channel])
    time = dataset["time"].values
    if len(time) < FEWEST_RECORDS:
        raise InputError("plot", f"{len(time)} records are too few for a spectrum")
    rate = (len(time) - 1) / (time[-1] - time[0])
    segment = _segment(len(time), rate / max(_rotation(dataset), 1e-9))
    frequency, density = welch(values, rate, nperseg=segment, axis=0, scaling="density")
    return frequency[1:], density.reshape(len(frequency), -1).mean(axis=1)[1:], f"({unit})²/Hz"


def _segment(records: int, turn: float) -> int:
    """Records of a segment, where a turn of the rotor takes ``turn`` records."""
    turns = min(max(TURNS, int(records / 4 / turn)), int(records / turn))
    return round(turns * turn) if turns else records // 4


def _rotation(dataset: xarray.Dataset) -> float:
    """Mean rotor frequency Hz; 0 where the result does not hold it."""
    if "rotor_speed" not in dataset:
        return 0.0
    return float(abs(dataset["rotor_speed"].mean())) / (2.0 * np.pi)


def varying(dataset: xarray.Dataset, channels: tuple[str, ...] = SPECTRA_CHANNELS) -> list[str]:
    """Those of the channels that the result has and that change over time."""
    return [name for name in channels if name in dataset and varies(dataset[name])]


def spectra_figure(dataset: xarray.Dataset, channels: tuple[str, ...] = SPECTRA_CHANNELS) -> Figure:
    """Spectra of channels with marks at multiples of the rotor's frequency.

    Raises InputError if none of the channels varies or there are too few records.
    """
    from matplotlib.ticker import NullLocator

    names = varying(dataset, channels)
    if not names:
        raise InputError("plot", f"in the result none of {', '.join(channels)} varies")
    with galerna_style():
        figure, axes = new_figure(len(names), 1, (9.0, 1.0 + 2.0 * len(names)), sharex=True)
        for ax, name in zip(axes[:, 0], names, strict=True):
            frequency, density, unit = power_spectrum(dataset, name)
            ax.loglog(frequency, density, color=BLUE)
            ax.set_title(label(dataset[name], unit))
            ax.set_xlim(frequency[0], frequency[-1])
            ax.set_ylim(*_limits(density))
            ax.yaxis.set_minor_locator(NullLocator())
            _mark_rotation(ax, dataset, name, frequency)
        axes[-1, 0].set_xlabel("Frequency [Hz]")
        figure.suptitle(title_of(dataset, "Power spectral density"))
    return figure


def _limits(density: Array) -> tuple[float, float]:
    """Limits of a logarithmic axis, with room for the marks above the peak."""
    peak = float(density.max())
    bottom = max(float(density.min()), peak * 10.0**-DECADES)
    span = np.log10(peak / bottom) if peak > bottom else 1.0
    return bottom * 10.0 ** (-0.04 * span), peak * 10.0 ** (0.18 * span)


def _mark_rotation(ax: Axes, dataset: xarray.Dataset, channel: str, frequency: Array) -> None:
    """Lines up to 9P for three blades: at 1P and the blades' passing, on a blade more of them.

    A mark outside the axes would take the room of the panels: a parked rotor has its 1P there.
    """
    lowest, highest = frequency[0], frequency[-1]
    rotation, blades = _rotation(dataset), dataset.sizes.get("blade", 3)
    multiples = {1, blades, 2 * blades, 3 * blades}
    if "blade" in dataset[channel].dims:
        multiples |= {2, 3, 4}
    for multiple in sorted(multiples):
        if lowest <= multiple * rotation < highest:
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
