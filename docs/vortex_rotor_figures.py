"""Draw the vortex lattice's rotors: ``python -m docs.vortex_rotor_figures [NAME ...]``.

The counterparts of figures of sections 3.3 and 4.2 of the dissertation that galerna follows,
for the rotors that are public. Names are the functions below; all where none is given.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter, ScalarFormatter

from validation import lattice_rotors as rotors
from validation import lattice_sharpy as sharpy
from validation import lattice_turbulence as turbulence
from validation import lattice_yaw as yaw
from validation.rotors import columns, like_the_avatar, table

FIGURES = Path(__file__).parent / "figures"
STYLES = {
    "UVLM": {"color": "black", "lw": 1.6},
    "UVLM quasi-steady": {"color": "tab:gray", "lw": 1.0},
    "BEM": {"color": "tab:green", "lw": 1.0},
    "BEM + filter": {"color": "tab:red", "lw": 1.0},
    "BEM quasi-steady + filter": {"color": "tab:orange", "lw": 1.0, "ls": "--"},
    "BEM skew": {"color": "tab:blue", "lw": 1.2},
    "BEM no skew": {"color": "tab:blue", "lw": 1.2, "ls": "--"},
    "BEM vortex cylinder": {"color": "tab:red", "lw": 1.2},
}
LABELS = {
    "c_out": "$c_{out}$ [1/m]",
    "c_in": "$c_{in}$ [1/m]",
    "M_out": "$M_{out}$ [MN m]",
    "M_in": "$M_{in}$ [MN m]",
    "C_T": "$C_T$",
    "C_P": "$C_P$",
}


def sharpy_lattice() -> Path:
    """Circulation of the trailing edge and forces along the span, beside SHARPy and OpenFAST."""
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), constrained_layout=True)
    reference, ours = sharpy.reference(), sharpy.on_sharpys_lattice(7)
    radius = reference["corners"][0, :, 2]
    strips, own = 0.5 * (radius[1:] + radius[:-1]), sharpy.on_sharpys_lattice(7, "quarter_chord")
    for values, label, style in (
        (reference["circulation_7"][-1], "SHARPy 2.4", "o"),
        (ours.circulation[0][-1], "galerna, same rings", "-"),
        (own.circulation[0][-1], "galerna, own rings and normals", "--"),
    ):
        axes[0].plot(strips, values, style, ms=4, label=label)
    _label(axes[0], "radius [m]", "circulation at the trailing edge [m²/s]")
    place, out, inside = columns(
        table("openfast_nrel5mw_zero_drag.csv"), "r_over_R", "out_of_plane", "in_plane"
    )
    lattices = (
        ("8 x 20, free wake", sharpy.FREE, "-"),
        ("8 x 20, prescribed", sharpy.Mesh(), "--"),
        ("32 x 40, prescribed", sharpy.FINE, ":"),
    )
    for axis, theirs, name in ((axes[1], out, "c_out"), (axes[2], inside, "c_in")):
        axis.plot(place, theirs, "ko", ms=4, label="OpenFAST, no drag")
        for label, mesh, style in lattices:
            rotor = sharpy.example(mesh)
            along = rotor.radius / sharpy.RADIUS
            axis.plot(along, getattr(rotor, name) * sharpy.RADIUS, style, label=label)
        _label(axis, "r/R", f"d{LABELS[name][:-6]} / d(r/R)")
    axes[0].legend(fontsize=8)
    axes[1].legend(fontsize=8)
    return _save(figure, "vortex_sharpy")


def convergence() -> Path:
    """Figs. 3.11 to 3.13: errors of thrust and power by the size of the lattice."""
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), constrained_layout=True)
    best = rotors.study("chordwise", rotors.CHORDWISE[-1])
    edges = {m: rotors.edges(m) for m in (16, 32, 64)}
    for i, (name, color) in enumerate((("C_T", "tab:blue"), ("C_P", "tab:red"))):
        for sizes, label, style in (
            ({m: rotors.study("chordwise", m) for m in rotors.CHORDWISE[:-1]}, "galerna", "o-"),
            (edges, "rings on edges", "s--"),
        ):
            errors = [100 * abs(rotors.error(mesh, best)[i]) for mesh in sizes.values()]
            axes[0].loglog(list(sizes), errors, style, color=color, label=f"{name}, {label}")
        for axis, field, counts, wanted in (
            (axes[0], "", (), rotors.CHORDWISE_ERRORS),
            (axes[1], "spanwise", rotors.SPANWISE, rotors.SPANWISE_ERRORS),
            (axes[2], "revolutions", rotors.REVOLUTIONS, rotors.WAKE_ERRORS),
        ):
            if counts:
                last = rotors.study(field, counts[-1])
                errors = [
                    100 * abs(rotors.error(rotors.study(field, n), last)[i]) for n in counts[:-1]
                ]
                axis.loglog(counts[:-1], errors, "o-", color=color)
            theirs = [100 * abs(pair[i]) for pair in wanted.values()]
            axis.loglog(list(wanted), theirs, "x:", color=color, label=f"{name}, dissertation")
    for axis, text, ticks in zip(
        axes,
        ("panels of chord", "panels of span", "revolutions in the wake"),
        ((4, 8, 16, 32, 64), (7, 14, 28), (1, 3, 5, 7, 10)),
        strict=True,
    ):
        _label(axis, text, "error [%]")
        axis.xaxis.set_major_formatter(ScalarFormatter())
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.set_xticks(ticks)
    axes[0].legend(fontsize=7)
    return _save(figure, "vortex_rotor_convergence")


def wake_models() -> Path:
    """Fig. 4.18: force coefficients along the span by wake model, drag and BEM."""
    figure, axes = plt.subplots(2, 2, figsize=(10, 8), constrained_layout=True)
    radius = like_the_avatar()[0].rotor_radius
    for row, point in zip(axes, rotors.POINTS, strict=True):
        bem = rotors.bem_point(point)
        for axis, name in zip(row, ("c_out", "c_in"), strict=True):
            for free, color in ((True, "tab:red"), (False, "tab:blue")):
                rotor = rotors.at_point(point, free=free)
                wake = "free" if free else "prescribed"
                for suffix, style in (("", "--"), ("_with_drag", "-")):
                    label = f"{wake}, {'drag' if suffix else 'no drag'}"
                    values = getattr(rotor, name + suffix)
                    axis.plot(rotor.radius / radius, values, style, color=color, label=label)
            axis.plot(bem["radius"] / radius, bem[name], "k-", lw=1, label="BEM")
            axis.set_title(point, fontsize=9)
            _label(axis, "r/R", LABELS[name])
    axes[0, 0].legend(fontsize=8)
    return _save(figure, "vortex_wake_models")


def yaw_azimuths() -> Path:
    """Figs. 4.21, 4.22, 4.24 to 4.26: one turn at 30 degrees of yaw error."""
    figure, axes = plt.subplots(5, 2, figsize=(10, 14), constrained_layout=True)
    turbine = like_the_avatar()[0]
    for model in yaw.MODELS:
        turn, style = yaw.yawed(model, 30.0), STYLES[model]
        for column, name in enumerate(("c_out", "c_in")):
            along = turn["radius"] / turbine.rotor_radius
            axes[0, column].plot(along, turn[f"mean_{name}"], label=model, **style)
            for row, place in ((1, 1), (2, 0)):
                axes[row, column].plot(turn["azimuth"], turn[name][:, place], **style)
                axes[row, column].set_title(f"{yaw.RADII[place]:g} R", fontsize=9)
        for row, names, scale in ((3, ("M_out", "M_in"), 1e-6), (4, ("C_T", "C_P"), 1.0)):
            for column, name in enumerate(names):
                axes[row, column].plot(turn["azimuth"], scale * turn[name], **style)
    for row, names in enumerate((("c_out", "c_in"),) * 3 + (("M_out", "M_in"), ("C_T", "C_P"))):
        for column, name in enumerate(names):
            _label(axes[row, column], "r/R" if row == 0 else "azimuth [deg]", LABELS[name])
            if row:
                axes[row, column].set_xticks(range(0, 361, 90))
    axes[0, 0].legend(fontsize=8)
    axes[0, 0].set_title("means over the turn", fontsize=9)
    return _save(figure, "vortex_yaw_30deg")


def yaw_sweep() -> Path:
    """Figs. 4.27 to 4.33: mean, fluctuation and place of the extremes over the yaw error."""
    rows: list[tuple[str, str, int | None]] = [
        ("c_out", "0.45 R", 0), ("c_in", "0.45 R", 0), ("c_out", "0.75 R", 1),
        ("c_in", "0.75 R", 1), ("M_out", "", None), ("M_in", "", None),
        ("C_T", "", None), ("C_P", "", None),
    ]  # fmt: skip
    figure, axes = plt.subplots(len(rows), 3, figsize=(11, 17), constrained_layout=True)
    for model in yaw.MODELS:
        for row, (name, _, place) in zip(axes, rows, strict=True):
            turns = [yaw.yawed(model, angle) for angle in yaw.YAWS]
            values = [t[name] if place is None else t[name][:, place] for t in turns]
            values = [1e-6 * v if name.startswith("M_") else v for v in values]
            style = {**STYLES[model], "marker": "o", "ms": 3}
            row[0].plot(yaw.YAWS, [v.mean() for v in values], label=model, **style)
            row[1].plot(yaw.YAWS, [v.std() for v in values], **style)
            if name.startswith("C_"):
                continue
            near = 0.0 if place == 0 else 270.0
            row[2].plot(
                yaw.YAWS[1:],
                [
                    yaw.extreme_azimuth(t, v, True, near)
                    for t, v in zip(turns[1:], values[1:], strict=True)
                ],
                **style,
            )
    for row, (name, where, _) in zip(axes, rows, strict=True):
        for axis, text in zip(row, ("mean", "standard deviation", "largest at [deg]"), strict=True):
            _label(axis, "yaw error [deg]", text)
        row[2].set_visible(not name.startswith("C_"))
        row[0].set_title(f"{LABELS[name]} {where}", fontsize=9, loc="left")
    axes[0, 0].legend(fontsize=8)
    return _save(figure, "vortex_yaw_sweep")


def turbulence_spectra() -> Path:
    """Figs. 4.38 and 4.58: power spectral densities over the reduced frequency."""
    figure, axes = plt.subplots(2, 2, figsize=(10, 8), sharex=True, constrained_layout=True)
    for place, row in enumerate(axes):
        for axis, name in zip(row, ("c_out", "c_in"), strict=True):
            for model in turbulence.MODELS:
                axis.loglog(*turbulence.spectrum(model, name, place), label=model, **STYLES[model])
            for limit in (turbulence.UNSTEADY, turbulence.HIGHLY_UNSTEADY):
                axis.axvline(limit, color="0.7", lw=0.8)
            _label(axis, "reduced frequency $k$", f"density of {LABELS[name][:-6]} [1/m²]")
            axis.set_title(f"{turbulence.RADII[place]:g} R", fontsize=9)
    axes[0, 0].legend(fontsize=8)
    return _save(figure, "vortex_turbulence_spectra")


def turbulence_series() -> Path:
    """Figs. 4.39 to 4.42, 4.49 to 4.53: the last seven revolutions, and deviations on the span."""
    figure, axes = plt.subplots(5, 1, figsize=(10, 14), constrained_layout=True)
    turbine = like_the_avatar()[0]
    shown = slice(-7 * turbulence.LONG.steps, None)
    for model in turbulence.MODELS:
        series, style = turbulence.series(model), STYLES[model]
        for axis, name in zip(axes[:4], turbulence.NAMES, strict=True):
            axis.plot(series["time"][shown], series[name][shown], label=model, **style)
            _label(axis, "time [s]", LABELS[name])
        axes[4].plot(series["radius"] / turbine.rotor_radius, series["c_out_deviation"], **style)
    _label(axes[4], "r/R", "deviation of $c_{out}$ [1/m]")
    axes[0].legend(fontsize=8, ncols=3)
    return _save(figure, "vortex_turbulence_series")


def _label(axis: Axes, across: str, up: str) -> None:
    axis.set_xlabel(across)
    axis.set_ylabel(up)
    axis.grid(alpha=0.3)


def _save(figure: plt.Figure, name: str) -> Path:
    path = FIGURES / f"{name}.png"
    figure.savefig(path, dpi=110)
    plt.close(figure)
    return path


FUNCTIONS: dict[str, Callable[[], Path]] = {
    f.__name__: f
    for f in (
        sharpy_lattice,
        convergence,
        wake_models,
        yaw_azimuths,
        yaw_sweep,
        turbulence_spectra,
        turbulence_series,
    )
}


def draw() -> Path:
    """Draw all of them, which takes some twenty minutes."""
    for function in FUNCTIONS.values():
        function()
    return FIGURES


if __name__ == "__main__":
    for function in sys.argv[1:] or FUNCTIONS:
        print(FUNCTIONS[function]())
