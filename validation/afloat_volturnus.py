"""A second floater from its windIO file: the IEA 15 MW on VolturnUS-S."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import xarray

import galerna
from galerna.case import load
from galerna.coupling.build import turbine_options
from galerna.coupling.floating_report import modes_of
from galerna.machine import Machine, build_machine

from .afloat import NO_AIR, PARKED, motion, swing
from .framework import Case, Check

REPORT = "Allen et al., NREL/TP-5000-76773 (2020), as commonly quoted; not checked against it"
TURBINE = "iea15mw_volturnus"
PRETENSION = 2437.0  #: kN
#: Hz, of the rigid turbine in still water
FREQUENCIES = {
    "surge": 0.007, "sway": 0.007, "heave": 0.049, "roll": 0.036, "pitch": 0.036, "yaw": 0.011,
}  # fmt: skip
#: quoted to two digits at most: half of the last one, and what mass and lines leave open
FREQUENCY_TOLERANCE = {
    "surge": 0.12, "sway": 0.12, "heave": 0.05, "roll": 0.05, "pitch": 0.05, "yaw": 0.12,
}  # fmt: skip
DECAYS = {"surge": 10.0, "heave": 2.0, "pitch": 5.0}  #: m, m, deg
PERIODS = {"surge": 140.0, "heave": 20.4, "pitch": 27.8}  #: s, about


def still(**blocks: Any) -> dict[str, Any]:
    """The machine with its rotor held, without air, in still water."""
    return {
        "galerna": 1,
        "turbine": TURBINE,
        "duration_s": 1.0,
        "time_step_s": 0.05,
        "inflow": {"wind_speed_m_s": 1.0},
        "air_density_kg_m3": NO_AIR,
        "tower_and_nacelle_drag": False,
        "structure": "rigid",
        "operation": PARKED,
        "sea": "still",
        **blocks,
    }


@cache
def machine() -> Machine:
    """The machine at rest."""
    return build_machine(load(still()))


def at_rest() -> Iterator[Check]:
    """Balance, line tension and natural frequencies in still water."""
    here = machine()
    report, afloat = here.report, here.afloat
    assert report is not None
    assert afloat is not None
    floating = afloat.floating
    assert floating is not None
    assert floating.burden is not None
    weight = floating.burden.mass * 9.80665
    upward = sum(float(load.force[:, 2].sum()) for load in report.loads_at_place())
    yield Check(
        "weight", weight / 1e6, 20093e3 * 9.80665 / 1e6, f"{REPORT}: 20,093 t", 0.01, "MN", True
    )
    yield Check(
        "buoyancy less the pull of the lines", upward / 1e6, weight / 1e6, "the weight", 0.005,
        "MN", True,
    )  # fmt: skip
    values = here.simulation.record()
    tension = np.asarray(values["fairlead_tension"])
    if not tension.any():
        here.simulation.advance()
        tension = np.asarray(here.simulation.record()["fairlead_tension"])
    yield Check("tension at a fairlead", tension.mean() / 1e3, PRETENSION, REPORT, 0.02, "kN", True)
    options = turbine_options(here.case, here.turbine, here.operation, afloat)
    modes = modes_of(
        here.turbine, options, floating.water, floating.burden, floating.settled, afloat.database
    )
    for mode in sorted(modes, key=lambda mode: mode.frequency):
        yield Check(
            f"natural frequency, {mode.name}", mode.frequency, FREQUENCIES[mode.name], REPORT,
            FREQUENCY_TOLERANCE[mode.name], "Hz", True,
        )  # fmt: skip


def decays() -> Iterator[Check]:
    """Free decays: their periods beside the natural frequencies, their damping."""
    for name, size in DECAYS.items():
        unit = "deg" if name == "pitch" else "m"
        period = PERIODS[name]
        case = still(
            duration_s=6.0 * period, platform={"start": {f"{name}_{unit}": size}},
            outputs={"interval_s": 0.2},
        )  # fmt: skip
        result = galerna.run(case)
        found = swing(result["time"].values, motion(result, name), 4, period)
        yield Check(
            f"period of the decay in {name}", found[0], 1.0 / FREQUENCIES[name],
            f"{REPORT}: natural frequency", FREQUENCY_TOLERANCE[name], "s", True,
        )  # fmt: skip
        yield Check(f"damping ratio of {name}", found[1], np.nan, "shown", None, "-")


@cache
def at_work() -> xarray.Dataset:
    """An operating case: the example, without its pictures."""
    example = load("volturnus").document.values
    outputs = {"interval_s": 0.2, "start_s": 50.0}
    return galerna.run({**example, "outputs": outputs})


def operation() -> Iterator[Check]:
    """Rotor, platform and lines in turbulence of 12 m/s and a short-crested sea."""
    result = at_work()
    power = result["electrical_power"].values / 1e6
    yield Check("mean electrical power", power.mean(), 15.0, "rated power", 0.05, "MW", True)
    speed = result["rotor_speed"].values * 30.0 / np.pi
    yield Check("mean rotor speed", speed.mean(), 7.56, "rated speed", 0.05, "rpm", True)
    for name, unit in (("surge", "m"), ("pitch", "deg"), ("yaw", "deg")):
        values = motion(result, name)
        yield Check(f"mean {name}", values.mean(), np.nan, "shown", None, unit)
        yield Check(f"standard deviation of {name}", values.std(), np.nan, "shown", None, unit)


CASES = [
    Case(
        "afloat-volturnus-rest", "afloat", "VolturnUS-S in still water", lambda: list(at_rest()),
        20.0,
        "Masses of the windIO file are 43 t (rotor and nacelle) and 14 t (tower) below the "
        "report's; the platform's mass is kept as published.",
    ),
    Case(
        "afloat-volturnus-decay", "afloat", "VolturnUS-S let go", lambda: list(decays()), 60.0,
    ),
    Case(
        "afloat-volturnus-operation", "afloat", "VolturnUS-S at work", lambda: list(operation()),
        90.0,
    ),
]  # fmt: skip
