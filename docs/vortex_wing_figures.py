"""Draw the vortex lattice's plates and wings: ``python -m docs.vortex_wing_figures [NAME ...]``.

The counterparts of figures of sections 3.2 and 4.1 of the dissertation that galerna follows.
Names are those of ``FIGURES``; all where none is given.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from galerna.aero.bem.spanwise_filter import filter_response
from galerna.contract import Array
from galerna.units import DEG
from validation import lattice_plates as plates
from validation import lattice_wings as wings
from validation import spanwise
from validation.finite_wing import lifting_line, oblique_elliptic_lift, wave_loading
from validation.thin_airfoil import kuessner, pitch_lift, plunge_lift, wagner

HERE = Path(__file__).parent / "figures"
ANGLES, AMPLITUDES = (0.0, 4.0, 8.0), (0.05, 0.1, 0.2)
WAVELENGTHS = np.geomspace(1.0, 100.0, 17)
KINDS = {
    "drag": ("peak-to-peak drag", "vortex_wave_drag.png"),
    "moment": ("peak-to-peak moment", "vortex_wave_moment.png"),
    "side": ("peak-to-peak side force", "vortex_wave_side.png"),
}


def steps() -> Path:
    """Figs. 3.6 and 4.4: Wagner's and Kuessner's gusts, with a uniform and a growing wake."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    for axis, kind, theory in zip(axes, ("wagner", "kuessner"), (wagner, kuessner), strict=True):
        fine = np.linspace(0.0, 50.0, 1001)
        axis.plot(fine, theory(fine), color="black", lw=2.5, alpha=0.4, label="theory")
        for uniform, style in ((True, "-"), (False, "--")):
            s, lift, panels = plates.indicial(kind, uniform)
            name = "uniform" if uniform else "growing"
            axis.plot(s[1:], lift[1:], style, lw=1.2, label=f"{name} wake, {panels} panels")
        axis.set(ylim=(0.0, 1.1), title=kind.capitalize())
        _label(axis, "semichords travelled", "lift over its final value")
    return _save(figure, "vortex_plate_steps.png")


def turbulence() -> Path:
    """Fig. 3.7: a blade section in turbulence."""
    lift = plates.turbulent_section()
    figure, axis = plt.subplots(figsize=(9, 4), constrained_layout=True)
    axis.plot(lift["semichords"], lift["steady"], color="tab:gray", lw=1.0, label="steady sections")
    axis.plot(lift["semichords"], lift["convolution"], color="tab:orange", lw=3, alpha=0.6,
              label="convolution, eq. 3.4")  # fmt: skip
    axis.plot(lift["semichords"], lift["lattice"], "k--", lw=1.0, label="lattice")
    _label(axis, "semichords travelled", "lift coefficient")
    return _save(figure, "vortex_plate_turbulence.png")


def oscillation() -> Path:
    """Lift of a plate in pitch and plunge beside Theodorsen's."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    line, points = np.geomspace(0.03, 1.2, 100), (0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
    parts: tuple[Callable[[np.ndarray], np.ndarray], ...] = (np.abs, _degrees)
    for motion, colour in (("pitch", "tab:blue"), ("plunge", "tab:red")):
        theory = pitch_lift(line, -0.5) if motion == "pitch" else plunge_lift(line)
        found = np.array([plates.oscillating_lift(motion, k) for k in points])
        for axis, part in zip(axes, parts, strict=True):
            axis.semilogx(line, part(theory), color=colour, label=f"{motion}, Theodorsen")
            axis.semilogx(points, part(found), "o", color=colour, label=f"{motion}, lattice")
    _label(axes[0], "reduced frequency", "|lift coefficient| over amplitude [1/rad]")
    _label(axes[1], "reduced frequency", "phase [deg]")
    return _save(figure, "vortex_plate_oscillation.png")


def sideslip() -> Path:
    """Figs. 3.8 and 3.9: an elliptic wing at 45 deg, and its largest lift against sideslip."""
    figure, axes = plt.subplots(1, 3, figsize=(14, 4), constrained_layout=True)
    for ratio, colour in ((10.0, "tab:blue"), (40.0, "tab:red")):
        place, lift = wings.oblique_lift(45 * DEG, ratio)
        theory = oblique_elliptic_lift(place, 45 * DEG, ratio, 0.0)
        inner = np.abs(place) < 0.985
        axes[0].plot(
            place[inner], theory[inner], "--", color=colour, label=f"eq. 3.6, A = {ratio:g}"
        )
        axes[0].plot(place[inner], lift[inner], color=colour, label=f"lattice, A = {ratio:g}")
    _label(axes[0], "place over half span (downstream tip: 1)", "lift / 8 α cos Λ")
    sweeps = np.linspace(0.0, 45.0, 7)
    for ratio in (5.0, 10.0, 20.0):
        value, place = wings.trend(ratio, sweeps * DEG)
        axes[1].plot(sweeps, value, "o-", ms=3, label=f"span over chord {ratio:g}")
        axes[2].plot(sweeps, place, "o-", ms=3, label=f"lattice, {ratio:g}")
        eq_36 = [wings.peak_of_theory(ratio, sweep) for sweep in sweeps * DEG]
        axes[2].plot(sweeps, eq_36, "--", color=axes[2].lines[-1].get_color(), lw=1.0,
                     label=f"eq. 3.6, {ratio:g}")  # fmt: skip
    _label(axes[1], "sideslip [deg]", "largest lift over that at 0 deg")
    _label(axes[2], "sideslip [deg]", "its place over half span")
    return _save(figure, "vortex_wing_sideslip.png")


def wave() -> Path:
    """Fig. 3.10: a slender wing in an upwash that varies along it."""
    place, lift = wings.wave_wing()
    line = lifting_line(
        place / 50.0, lambda y: np.full_like(y, 0.02), lambda y: 0.01 * np.sin(10 * np.pi * y)
    )
    figure, axis = plt.subplots(figsize=(9, 4), constrained_layout=True)
    axis.plot(place, 0.02 * np.pi * np.sin(0.2 * np.pi * place), color="tab:gray", lw=1.0,
              label="isolated sections")  # fmt: skip
    axis.plot(place, line, color="tab:orange", lw=2.5, alpha=0.6, label="lifting line, eq. 3.8")
    axis.plot(place, lift, "k--", lw=1.2, label="lattice")
    _label(axis, "place along the span [chords]", "lift coefficient")
    return _save(figure, "vortex_wing_wave.png")


def wave_forces() -> Path:
    """Fig. 4.8: forces along two waves of 10 chords, 4 deg, A = 0.1."""
    found = spanwise.wave_forces(10.0, 4 * DEG)
    figure, axes = plt.subplots(1, 4, figsize=(15, 3.5), constrained_layout=True)
    axes[0].plot(found.place, found.sections, color="tab:gray", label="isolated sections")
    for axis, (name, values) in zip(
        axes,
        {"lift": found.lift, "drag": found.drag, "moment": found.moment, "side force": found.side}
        .items(),
        strict=True,
    ):  # fmt: skip
        axis.plot(found.place, values, color="black", label="lattice")
        _label(axis, "place [wavelengths]", f"{name} coefficient")
    return _save(figure, "vortex_wave_forces.png")


def kept_lift() -> Path:
    """Fig. 4.9 and eq. 4.11: the lift that is kept, and filters fitted to it."""
    figure, axes = plt.subplots(1, 3, figsize=(15, 4), constrained_layout=True)
    for axis, family in zip(axes, _families(), strict=False):
        for label, forces in family.items():
            axis.semilogx(WAVELENGTHS, [spanwise.kept_lift(f) for f in forces], "o-", ms=3,
                          label=label)  # fmt: skip
        _label(axis, "wavelength [chords]", "lift over that of isolated sections")
    kept = spanwise.responses()
    (a, b), free = spanwise.refit(spanwise.WAVELENGTHS, kept)
    fine = np.geomspace(0.7, 150.0, 200)
    exact = np.array([wave_loading(1.0 / x)[0] for x in fine])
    axis = axes[2]
    axis.semilogx(spanwise.WAVELENGTHS, kept, "ko", ms=4, label="lattice")
    for values, label, style in (
        (exact, "lifting surface, exact", "k-"),
        (filter_response(1.0, 1.0 / fine), "eq. 4.11: 0.47, 3.3", "tab:red"),
        (spanwise.second_order(1.0 / fine, (a, b)), f"refitted: {a:.2f}, {b:.2f}", "tab:blue"),
        (spanwise.both_limits(1.0 / fine, free), f"both limits: {free:.2f}", "tab:green"),
    ):
        if style == "k-":
            axis.semilogx(fine, values, "k-", lw=1.0, label=label)
        else:
            axis.semilogx(fine, values, color=style, lw=1.2, label=label)
    _label(axis, "wavelength [chords]", "lift over that of isolated sections")
    return _save(figure, "vortex_wave_filter.png")


def mean_drag() -> Path:
    """Fig. 4.10: the mean drag."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    for axis, family in zip(axes, _families(), strict=True):
        for label, forces in family.items():
            axis.semilogx(WAVELENGTHS, [f.drag.mean() for f in forces], "o-", ms=3, label=label)
        _label(axis, "wavelength [chords]", "mean drag coefficient")
    return _save(figure, "vortex_wave_mean_drag.png")


def peaks(kind: str) -> Path:
    """Figs. 4.11 to 4.13: peak-to-peak drag, moment or side force."""
    name, file = KINDS[kind]
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    for axis, family in zip(axes, _families(), strict=True):
        for label, forces in family.items():
            values = [np.ptp(getattr(f, kind)) for f in forces]
            axis.semilogx(WAVELENGTHS, values, "o-", ms=3, label=label)
        _label(axis, "wavelength [chords]", f"{name} coefficient")
    return _save(figure, file)


@cache
def _families() -> tuple[dict[str, list[spanwise.WaveForces]], ...]:
    """Forces over the wavelengths: for angles at A = 0.1, for amplitudes at 4 deg."""
    angles = {
        f"{a:g} deg, A = 0.1": [spanwise.wave_forces(w, a * DEG) for w in WAVELENGTHS]
        for a in ANGLES
    }
    amplitudes = {
        f"A = {a:g}, 4 deg": [spanwise.wave_forces(w, 4 * DEG, a) for w in WAVELENGTHS]
        for a in AMPLITUDES
    }
    return angles, amplitudes


def _degrees(values: Array) -> Array:
    return np.degrees(np.angle(values))


def _label(axis: Axes, x: str, y: str) -> None:
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)


def _save(figure: plt.Figure, name: str) -> Path:
    path = HERE / name
    figure.savefig(path, dpi=110)
    plt.close(figure)
    return path


FIGURES: dict[str, Callable[[], Path]] = {
    "steps": steps,
    "turbulence": turbulence,
    "oscillation": oscillation,
    "sideslip": sideslip,
    "wave": wave,
    "wave_forces": wave_forces,
    "kept_lift": kept_lift,
    "mean_drag": mean_drag,
    **{f"peaks_{kind}": partial(peaks, kind) for kind in KINDS},
}


def draw(names: list[str] | None = None) -> Path:
    """Write the figures of these names, all where none is given."""
    for name in names or FIGURES:
        print(FIGURES[name]())
    return HERE


if __name__ == "__main__":
    draw(sys.argv[1:])
