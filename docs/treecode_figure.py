"""Draw how the cost of a wake's velocity grows with it: ``python -m docs.treecode_figure``."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from benchmarks.vortex import SIZES, tree_seconds

HERE = Path(__file__).parent
ERRORS = (1e-4, 1e-3, 1e-2)
SUMMED = 30_000  # panels, the most that are summed directly


def draw() -> Path:
    """Write figures/treecode_scaling.png."""
    figure, axes = plt.subplots(figsize=(6, 4.5), constrained_layout=True)
    size, cost = np.array([tree_seconds(n, None) for n in SIZES if n <= SUMMED]).T
    axes.loglog(size, cost, "ks", label="direct sum, single precision")
    large = np.array([size[0], SIZES[-1]])
    axes.loglog(large, cost[-1] * (large / size[-1]) ** 2, "k:", lw=0.8, label="square of panels")
    for error in ERRORS:
        size, cost = np.array([tree_seconds(n, error) for n in SIZES]).T
        slope = np.polyfit(np.log(size), np.log(cost), 1)[0]
        axes.loglog(size, cost, "o-", label=f"treecode, error {error:g}: panels$^{{{slope:.2f}}}$")
    axes.set_xlabel("panels of a helical wake")
    axes.set_ylabel("CPU time of the velocities at its vertices [s]")
    axes.grid(which="both", lw=0.3)
    axes.legend()
    path = HERE / "figures" / "treecode_scaling.png"
    figure.savefig(path, dpi=110)
    return path


if __name__ == "__main__":
    print(draw())
