"""Draw a mooring line of the OC3-Hywind over its distance: ``python -m docs.mooring_figure``.

The counterpart of figure 2.7 of the dissertation that galerna follows, beside the OC3 project's
own table, and the shape of the line at a few distances.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from galerna.hydro.mooring import catenary, line_shape
from galerna.report.style import COLOURS, GREY, galerna_style, new_figure
from validation.afloat_mooring import LINE, RISE
from validation.rotors import columns, table

HERE = Path(__file__).parent
SHOWN = (653.0, 803.0, 848.67, 873.0)  #: m


def tensions(ax: Axes) -> None:
    """Tension and suspended length over the distance."""
    distance = np.concatenate([np.linspace(650.0, 850.0, 200), np.linspace(850.0, 880.0, 200)])
    lines = [catenary(float(x), RISE, *LINE) for x in distance]
    x, tension, suspended = columns(
        table("afloat/oc3_mooring_line.csv"), "distance_m", "fast_tension_kN", "fast_suspended_m"
    )
    kept = x <= 880.0
    ax.plot(distance, [line.tension_b / 1e6 for line in lines], color=COLOURS[0])
    ax.plot(x[kept], tension[kept] / 1e3, "o", mfc="none", color=COLOURS[0])
    ax.set_ylabel("tension at the platform [MN]", color=COLOURS[0])
    ax.set_xlabel("distance from anchor to fairlead [m]")
    other = ax.twinx()
    other.grid(False)
    other.plot(distance, [LINE[0] - line.resting for line in lines], color=COLOURS[1])
    other.plot(x[kept], suspended[kept], "s", mfc="none", color=COLOURS[1])
    other.set_ylabel("suspended length [m]", color=COLOURS[1])
    other.spines["right"].set_visible(True)
    ax.plot([], [], color=GREY, label="galerna")
    ax.plot([], [], "o", mfc="none", color=GREY, label="FAST, table of the OC3 project")
    ax.axvline(848.67, color=GREY, lw=0.8, ls=":")
    ax.annotate("at rest", (848.67, 5.4), (-6, 0), textcoords="offset points", ha="right",
                color=GREY)  # fmt: skip
    ax.legend(loc="upper left")


def shapes(ax: Axes) -> None:
    """The line itself."""
    for x, color in zip(SHOWN, COLOURS, strict=False):
        points, _ = line_shape(x, RISE, *LINE, count=200)
        ax.plot(points[:, 0], points[:, 1], color=color, label=f"{x:g} m")
    ax.axhline(0.0, color=GREY, lw=0.8)
    ax.set_xlabel("distance from the anchor [m]")
    ax.set_ylabel("height above the seabed [m]")
    ax.legend(loc="upper left")


def draw() -> Path:
    """Write figures/mooring_line.png."""
    with galerna_style():
        figure, axes = new_figure(1, 2, (12.0, 4.4))
        tensions(axes[0, 0])
        shapes(axes[0, 1])
        path = HERE / "figures" / "mooring_line.png"
        figure.savefig(path, dpi=110)
    return path


if __name__ == "__main__":
    print(draw())
