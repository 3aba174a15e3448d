"""Draw the machine beside others: ``python -m docs.machine_figures``; a few minutes."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from docs.drawing import draw_all
from galerna.report.style import BLUE, DOTS_PER_INCH, GREEN, GREY, VERMILION
from validation.machine import in_openfast_units
from validation.machine_base_motion import FORE_AFT, FREQUENCY, OUT, TIP, moved, spectrum
from validation.machine_land import LOADS, OPERATION, turbulent_run
from validation.rotors import columns, table

MOTIONS = {
    "fixed": (GREY, ()),
    "±2° at 0.034 Hz": (BLUE, ("pitch_deg", 4.0, FREQUENCY)),
    "±2° at 0.068 Hz": (VERMILION, ("pitch_deg", 4.0, 2.0 * FREQUENCY)),
}
SPECTRA = ((FORE_AFT, "Tower top, fore-aft [m²/Hz]"), (TIP, "Tip, out of plane [m²/Hz]"),
           (OUT, "Root moment, out of plane [(N m)²/Hz]"))  # fmt: skip


def base_motion() -> Figure:
    """Spectra of tower top, tip and root moment on a platform that is made to pitch."""
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), layout="constrained")
    for ax, (channel, label) in zip(axes, SPECTRA, strict=True):
        for name, (colour, motion) in MOTIONS.items():
            frequency, power = spectrum(moved(*motion)[channel])
            ax.loglog(frequency[1:], power[1:], color=colour, lw=1.1, label=name)
        for turns in (1, 3):
            ax.axvline(turns * 12.1 / 60.0, color=GREY, lw=0.7, ls=":")
        ax.set(xlim=(0.02, 2.0), xlabel="Frequency [Hz]; dotted: 1P and 3P", title=label)
        ax.set_ylim(bottom=ax.get_ylim()[1] * 1e-12)
    axes[0].legend()
    return figure


def openfast() -> Figure:
    """Rotor speed, pitch, power and two moments in the turbulence that OpenFAST had."""
    result, rows = turbulent_run(), table("machine/openfast_land_turbulent.csv")
    (time,) = columns(rows, "Time")
    shown = (*OPERATION[:3], LOADS[0], LOADS[2])
    figure, axes = plt.subplots(5, 1, figsize=(10.0, 9.5), sharex=True, layout="constrained")
    for ax, (here, there, text, unit) in zip(axes, shown, strict=True):
        for code, name, colour in (
            ("ed", "OpenFAST, linear modes", GREEN),
            ("bd", "OpenFAST, BeamDyn", VERMILION),
        ):
            ax.plot(time, columns(rows, f"{code}_{there}")[0], color=colour, lw=1.0, label=name)
        ax.plot(result["time"], in_openfast_units(result, here), color=BLUE, lw=1.0,
                label="galerna")  # fmt: skip
        ax.set_title(f"{text} [{unit}]", loc="left", fontsize=9)
        ax.margins(x=0.0)
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=3, loc="outside upper center")
    axes[-1].set_xlabel("Time [s]")
    return figure


FIGURES: dict[str, Callable[[], Figure]] = {
    "machine_base_motion": base_motion,
    "machine_openfast": openfast,
}


def draw(names: list[str] | None = None) -> Path:
    """Draw the figures of these names, or all."""
    return draw_all(FIGURES, names, DOTS_PER_INCH)


if __name__ == "__main__":
    draw(sys.argv[1:])
