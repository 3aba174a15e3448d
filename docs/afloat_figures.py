"""Draw the OC3 turbine at work: ``python -m docs.afloat_figures``; half an hour from scratch."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from docs.drawing import draw_all
from galerna.report.style import BLUE, DOTS_PER_INCH, GREEN, GREY, VERMILION
from validation import afloat_operation
from validation.afloat_operation import QUANTITIES, series, spectrum

RUNS = {"open loop": GREEN, "reference": BLUE, "redesign": VERMILION}
NATURAL = (0.008, 0.034, 0.1, 0.47)  #: Hz: surge, pitch, waves, tower
SPECTRA = ("surge", "platform pitch", "rotor speed", "blade pitch",
           "tower-top fore-aft displacement", "tip displacement out of plane")  # fmt: skip
RANGES = ("surge", "platform pitch", "rotor speed", "blade pitch", "generator power",
          "tower-top fore-aft displacement", "tip displacement out of plane",
          "root moment out of plane")  # fmt: skip
OVER_TIME = ("rotor speed", "blade pitch", "generator power", "platform pitch")


def named(quantity: str) -> str:
    """A quantity with its unit."""
    return f"{quantity} [{QUANTITIES[quantity][1]}]"


def spectra() -> Figure:
    """Power spectral densities by BEM, 600 s, open loop and with two sets of gains."""
    figure, axes = plt.subplots(2, 3, figsize=(13.0, 7.0), layout="constrained", sharex=True)
    for ax, quantity in zip(axes.flat, SPECTRA, strict=True):
        for name, colour in RUNS.items():
            frequency, power = spectrum(afloat_operation.operated(name), quantity)
            if power.max() > 0.0:
                ax.loglog(frequency[1:], power[1:], color=colour, lw=1.1, label=name)
        for natural in NATURAL:
            ax.axvline(natural, color=GREY, lw=0.7, ls=":")
        ax.set(xlim=(0.005, 1.2), title=f"{quantity} [{QUANTITIES[quantity][1]}²/Hz]")
        ax.set_ylim(bottom=ax.get_ylim()[1] * 1e-8)
    for ax in axes[1]:
        ax.set_xlabel("Frequency [Hz]; dotted: surge, pitch, waves, tower")
    axes[0, 0].legend()
    return figure


def ranges() -> Figure:
    """Mean, deviation and range of each run, by BEM and by the lattice over the same 150 s."""
    figure, axes = plt.subplots(2, 4, figsize=(13.0, 6.0), layout="constrained")
    for ax, quantity in zip(axes.flat, RANGES, strict=True):
        for k, (name, colour) in enumerate(RUNS.items()):
            for model, shift, marker in (("BEM, short", 0.15, "o"), ("lattice", -0.15, "D")):
                run = afloat_operation.operated(name, model)
                _range(ax, series(run, quantity), -k + shift, colour, marker)
        ax.set_yticks([0, -1, -2], list(RUNS) if ax in axes[:, 0] else [])
        ax.set_title(named(quantity), fontsize=9)
    figure.supxlabel("150 s: range, thick: a deviation to either side; ● BEM, ◆ vortex lattice")
    return figure


def _range(ax: Axes, values: np.ndarray, at: float, colour: str, marker: str) -> None:
    mean, deviation = values.mean(), values.std()
    ax.plot([values.min(), values.max()], [at, at], color=colour, lw=1.0)
    ax.plot([mean - deviation, mean + deviation], [at, at], color=colour, lw=3.5, alpha=0.6)
    ax.plot(mean, at, color=colour, marker=marker, ms=5)


def rosco() -> Figure:
    """ROSCO beside the baseline controller over time."""
    runs = {"baseline": ("reference", BLUE), "ROSCO, same gains": ("ROSCO detuned", GREEN),
            "ROSCO, gains for land": ("ROSCO on land", VERMILION)}  # fmt: skip
    figure, axes = plt.subplots(len(OVER_TIME), 1, figsize=(10.0, 8.0), sharex=True,
                                layout="constrained")  # fmt: skip
    for ax, quantity in zip(axes, OVER_TIME, strict=True):
        for label, (name, colour) in runs.items():
            run = afloat_operation.operated(name)
            ax.plot(run.time, series(run, quantity), color=colour, lw=0.9, label=label)
        ax.set_title(named(quantity), loc="left", fontsize=9)
        ax.margins(x=0.0)
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=3, loc="outside upper center")
    axes[-1].set_xlabel("Time [s]")
    return figure


FIGURES: dict[str, Callable[[], Figure]] = {
    "afloat_operation_spectra": spectra,
    "afloat_operation_ranges": ranges,
    "afloat_operation_rosco": rosco,
}


def draw(names: list[str] | None = None) -> Path:
    """Draw the figures of these names, or all."""
    return draw_all(FIGURES, names, DOTS_PER_INCH)


if __name__ == "__main__":
    draw(sys.argv[1:])
