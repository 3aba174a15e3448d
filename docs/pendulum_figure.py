"""Draw the flexible double pendulum's figures: ``python -m docs.pendulum_figure``.

The counterparts of figures 3.3 to 3.5 of the dissertation that galerna follows: where the
first tip is, and the power spectral density of both tips' bending, for each scheme.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.signal import welch

from galerna.contract import Array
from galerna.structure.initial import with_initial_accelerations
from galerna.structure.integrators import Integrator
from galerna.structure.scheme import Scheme
from galerna.structure.system import State
from validation.multibody import flexible_pendulum

HERE = Path(__file__).parent
DURATION = 1.0


def bending(state: State, root: int, tip: int) -> float:
    """Displacement m of a tip across the axis of its beam's first frame."""
    return float(state.rotation[root][:, 0] @ (state.position[tip] - state.position[root]))


def history(dt: float, scheme: Scheme) -> tuple[Array, Array]:
    """Times (k,) s; first tip's x and both tips' bending (k,3) m."""
    system, first, second = flexible_pendulum()
    state = with_initial_accelerations(system, system.initial_state())
    rows = [
        (s.position[first][0], bending(s, 1, first), bending(s, first + 1, second))
        for s in Integrator(system, scheme).march(state, dt, round(DURATION / dt))
    ]
    return dt * np.arange(1, len(rows) + 1, dtype=float), np.array(rows)


def draw() -> Path:
    """Write figures/flexible_pendulum.png."""
    warnings.simplefilter("ignore", UserWarning)
    panels: list[tuple[str, list[tuple[str, float, Scheme]]]] = [
        ("both schemes, step 0.1 ms",
         [("Newmark 1e-4", 1e-4, Scheme.newmark(1e-4)),
          ("generalized-alpha 1", 1e-4, Scheme.generalized_alpha(1.0))]),
        ("Newmark, step 0.1 ms",
         [("1e-4", 1e-4, Scheme.newmark(1e-4)), ("1e-1", 1e-4, Scheme.newmark(0.1))]),
        ("generalized-alpha",
         [("0.5, 0.1 ms", 1e-4, Scheme.generalized_alpha(0.5)),
          ("0.5, 1 ms", 1e-3, Scheme.generalized_alpha(0.5)),
          ("1, 0.1 ms", 1e-4, Scheme.generalized_alpha(1.0))]),
    ]  # fmt: skip
    figure, axes = plt.subplots(3, 3, figsize=(12, 9), constrained_layout=True)
    for column, (title, runs) in enumerate(panels):
        axes[0, column].set_title(title)
        for label, dt, scheme in runs:
            times, rows = history(dt, scheme)
            axes[0, column].plot(times, rows[:, 0], label=label)
            for k in (1, 2):
                frequency, power = welch(rows[:, k], 1.0 / dt, nperseg=len(times))
                axes[k, column].loglog(frequency[1:], power[1:], lw=0.8)
        axes[0, column].legend()
        axes[0, column].set_xlabel("time [s]")
        axes[2, column].set_xlabel("frequency [Hz]")
    for row, label in enumerate(
        ("x of the first tip [m]", "first tip, bending PSD [m²/Hz]", "second tip [m²/Hz]")
    ):
        axes[row, 0].set_ylabel(label)
    path = HERE / "figures" / "flexible_pendulum.png"
    figure.savefig(path, dpi=110)
    return path


if __name__ == "__main__":
    print(draw())
