"""Draw the steady flexible rotor: ``python -m docs.flexible_rotor_figures [NAME ...]``.

The counterparts of figures 5.2 to 5.8 of the dissertation that galerna follows, and the start of
the machine. Names are those of ``FIGURES``; all where none is given.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import cast

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from galerna import turbine as turbines
from galerna.case import parse
from galerna.contract import Array
from galerna.control.tuning import Sensitivity
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.gains import Wake, power_sensitivity
from galerna.coupling.steady import FlexibleRotor, steady_flexible
from galerna.machine import build_machine
from galerna.report.style import BLUE, DOTS_PER_INCH, GREEN, VERMILION
from galerna.units import DEG
from validation.flexible_rotor import MODELS, SPEED, TURBINE, WIND, at_pitch

HERE = Path(__file__).parent / "figures"
PITCHES = {10.0: ":", 15.0: "-", 20.0: "--"}
STARTS = (5.0, 8.0, 11.4, 18.0)  #: m/s
COLOURS = {"rigid": BLUE, "flexible": VERMILION, "100 GJ": GREEN}
#: Table 7-1 of NREL/TP-500-38060: wind speed m/s, pitch deg
SCHEDULE = np.array(
    [[12, 3.823], [14, 8.70], [16, 12.06], [18, 14.92], [20, 17.47], [22, 19.94], [24, 22.35]]
)


def span() -> Path:
    """Figs. 5.2 to 5.4: force coefficients, deflections and twist along the blade."""
    panels = {
        "c_out": ("out-of-plane force, R c_out [-]", None),
        "c_in": ("in-plane force, R c_in [-]", None),
        "out_of_plane": ("out-of-plane deflection over R [%]", 100.0),
        "twist": ("twist towards feather [deg]", 1.0 / DEG),
    }
    radius = turbines.load(TURBINE).rotor_radius
    figure, axes = plt.subplots(2, 2, figsize=(11, 7), constrained_layout=True, sharex=True)
    for axis, (name, (label, scale)) in zip(axes.flat, panels.items(), strict=True):
        for model, colour in COLOURS.items():
            for pitch, style in PITCHES.items():
                point = at_pitch(model, WIND, pitch)
                factor = radius if scale is None else scale / (radius if scale == 100.0 else 1.0)
                text = f"{model}, {pitch:g} deg"
                values = factor * point[name].values
                axis.plot(point["radius"] / radius, values, style, color=colour, label=text)
        _label(axis, "radius over R", label)
    axes[1, 1].legend(fontsize=8, frameon=False, loc="upper left")
    return _save(figure, "flexible_rotor_span.png")


def power() -> Path:
    """Figs. 5.5, 5.6 and 5.8: power at the report's pitch, pitch of rated power, sensitivity."""
    figure, axes = plt.subplots(1, 3, figsize=(14, 4.2), constrained_layout=True)
    wind, pitch = SCHEDULE.T
    for model, colour in COLOURS.items():
        at_report = _at(model, pitch_deg=tuple(pitch))
        axes[0].plot(wind, at_report["power"] / 1e6, "o-", color=colour, ms=4, label=model)
        rated = _at(model)
        axes[1].plot(wind, rated["pitch"] / DEG, "o-", color=colour, ms=4, label=model)
    wakes: tuple[tuple[Wake, str], ...] = (("frozen", "-"), ("following", "--"))
    for wake, style in wakes:
        for model in ("rigid", "flexible"):
            found = _sensitivity(model, wake)
            label = f"{model}, {wake} wake"
            slope = found.power_by_pitch / 1e6
            axes[2].plot(wind, slope, style, color=COLOURS[model], label=label)
    line = -25.52 * (1.0 + pitch / 6.302)
    axes[2].plot(wind, line, color="black", lw=2.5, alpha=0.35, label="NREL report's line")
    axes[1].plot(wind, pitch, color="black", lw=2.5, alpha=0.35, label="NREL report")
    _label(axes[0], "wind speed [m/s]", "power at the report's pitch [MW]")
    _label(axes[1], "wind speed [m/s]", "pitch of rated power [deg]")
    _label(axes[2], "wind speed [m/s]", "dP/dpitch [MW/rad]")
    for axis in axes:
        axis.legend(frameon=False, fontsize=8)
    return _save(figure, "flexible_rotor_power.png")


def start() -> Path:
    """The first seconds of the flexible machine under its controller, at four wind speeds."""
    names = ("rotor speed", "tip deflection, mean of the blades", "tower top, downwind", "pitch")
    figure, axes = plt.subplots(1, 4, figsize=(14, 3.6), constrained_layout=True)
    for wind in STARTS:
        time, rows = _started(wind)
        reference = np.array([rows[0, 0], 5.3, 0.4, 1.0])  # speed; deflections at 11.4 m/s; rad
        change = (rows - rows[0]) / reference * np.array([100.0, 100.0, 100.0, 1.0 / DEG])
        for axis, values in zip(axes, change.T, strict=True):
            axis.plot(time, values, lw=1.1, label=f"{wind:g} m/s")
    units = ("[% of it]", "[% of that at 11.4 m/s]", "[% of that at 11.4 m/s]", "[deg]")
    for axis, name, unit in zip(axes, names, units, strict=True):
        _label(axis, "time [s]", f"change since the start {unit}")
        axis.set_title(name, fontsize=10)
    axes[0].legend(frameon=False, fontsize=8)
    return _save(figure, "machine_start.png")


def _started(wind: float) -> tuple[Array, Array]:
    """Time (n,) and rotor speed, mean tip deflection, tower top and pitch (n,4) of a run."""
    text = (
        f"galerna: 1\nturbine: {TURBINE}\nduration_s: 20\ntime_step_s: 0.025\n"
        f"inflow: {{wind_speed_m_s: {wind}}}\nstructure: flexible\ncontrol: baseline\n"
    )
    simulation = build_machine(parse(text, "start", ".")).simulation
    structure = cast(FlexibleMachine, simulation.structure)
    parts, first = structure.parts.parts, structure.system
    hub, top = int(parts["hub"][0]), int(parts["nacelle"][0])
    tips = [int(parts[f"blade{k}"][-1]) for k in (1, 2, 3)]
    rows = []
    while True:
        state = structure.accepted
        now = (state.position[tips] - state.position[hub]) @ state.rotation[hub][:, 0]
        before = (first.position[tips] - first.position[hub]) @ first.rotation[hub][:, 0]
        downwind = (state.position - first.position)[top, 0]
        pitch = structure.pitch_angles(state.time)[0]
        rows.append([structure.rotor_speed, (now - before).mean(), downwind, pitch])
        if simulation.time > 20.0 - 1e-6:
            return 0.025 * np.arange(len(rows), dtype=float), np.array(rows)
        simulation.advance()


def _at(model: str, pitch_deg: tuple[float, ...] | None = None) -> xarray.Dataset:
    blades, torsion = MODELS[model]
    pitch = None if pitch_deg is None else DEG * np.array(pitch_deg)
    speed = None if pitch_deg is None else SPEED
    return steady_flexible(
        turbines.load(TURBINE), SCHEDULE[:, 0], rotor_speed=speed, pitch=pitch, blades=blades,
        torsion=torsion,
    )  # fmt: skip


@cache
def _sensitivity(model: str, wake: Wake) -> Sensitivity:
    turbine = turbines.load(TURBINE)
    blades, torsion = MODELS[model]
    rotor = FlexibleRotor(turbine, blades=blades, torsion=torsion)
    return power_sensitivity(turbine, rotor, SCHEDULE[:, 0], wake)


def _label(axis: Axes, x: str, y: str) -> None:
    axis.set(xlabel=x, ylabel=y)
    axis.grid(True, color="#e4e4e4")
    axis.spines[["top", "right"]].set_visible(False)


def _save(figure: Figure, name: str) -> Path:
    path = HERE / name
    figure.savefig(path, dpi=DOTS_PER_INCH)
    plt.close(figure)
    return path


FIGURES: dict[str, Callable[[], Path]] = {"span": span, "power": power, "start": start}


def draw(names: list[str] | None = None) -> Path:
    """Write the figures of these names, all where none is given."""
    for name in names or FIGURES:
        print(FIGURES[name]())
    return HERE


if __name__ == "__main__":
    draw(sys.argv[1:])
