"""The OC3 spar in waves without wind: beside its linear response, and what steps and damping do."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import xarray
from scipy.signal import csd, welch

from galerna.case import load
from galerna.contract import Array
from galerna.coupling.floating_modes import response
from galerna.hydro.database import HydroDatabase
from galerna.machine import Machine, build_machine

from .afloat import MOTIONS, NO_AIR, PARKED, UNITS, harmonic, motion, parked
from .framework import Check

LINEAR = "linear response of the same machine in the frequency domain, from its database"
HEIGHT, PERIOD = 6.0, 10.0  #: m and s, of the dissertation's waves
REGULAR = {"waves": {"kind": "regular", "height_m": HEIGHT, "period_s": PERIOD}}
JONSWAP = {"waves": {"kind": "jonswap", "significant_height_m": HEIGHT, "peak_period_s": PERIOD}}
WITHOUT_DRAG, WITH_DRAG, TRANSFER = 0.02, 0.05, 0.05  #: as was asked for
FEWEST = 0.05  #: m or deg: smaller motions are shown
BAND, COHERENCE = (0.05, 0.2), 0.9  #: Hz
SETTLED, HOUR, STEP = 1200.0, 3600.0, 0.1  #: s
SEGMENT = 400.0  #: s of a spectrum's windows
IN_PLANE = ("surge", "heave", "pitch")


@cache
def still_machine(structure: str) -> Machine:
    """The machine of ``parked`` at rest."""
    case = {
        "galerna": 1,
        "turbine": "nrel5mw_oc3",
        "duration_s": 1.0,
        "inflow": {"wind_speed_m_s": 1.0},
        "air_density_kg_m3": NO_AIR,
        "tower_and_nacelle_drag": False,
        "structure": structure,
        "operation": PARKED,
        "sea": {"drag": False},
    }
    return build_machine(load(case))


def database() -> HydroDatabase:
    """The coefficients of that machine."""
    return still_machine("rigid").simulation.load_models["hydrodynamics"].database


@cache
def linear_response(frequency: float, structure: str = "rigid") -> dict[str, complex]:
    """Amplitudes m, deg of the platform's motions and of the tower's top (m) for 1 m of wave."""
    machine, simulation = still_machine(structure), still_machine(structure).simulation
    flexible = simulation.structure
    loads = [
        model.loads(0.0, at)
        for model, at in zip(simulation.load_models.values(), flexible.motions, strict=True)
    ]
    excitation = machine.simulation.load_models["hydrodynamics"].database.excitation_at(
        [frequency], 0.0
    )[0]
    moved = response(
        flexible, flexible.accepted, loads, database(), frequency, excitation
    )  # fmt: skip
    node = int(flexible.parts.parts["platform"][0])
    scales = [scale for _, scale in MOTIONS.values()]
    found = dict(zip(MOTIONS, moved[node] * scales, strict=True))
    top = flexible.system.names.index("nacelle")
    lever = flexible.accepted.position[top, 2] - flexible.accepted.position[node, 2]
    found["tower top"] = moved[top, 0] - moved[node, 0] - lever * moved[node, 4]
    return found


def regular() -> Iterator[Check]:
    """First harmonics of the motions in a regular wave."""
    frequency = 2.0 * np.pi / PERIOD
    linear = linear_response(frequency)
    for drag, tolerance in ((False, WITHOUT_DRAG), (True, WITH_DRAG)):
        result = parked(800.0, {**REGULAR, "drag": drag}, time_step_s=0.05)
        late = result.sel(time=slice(500.0, None))
        wave = harmonic(late["time"].values, late["wave_elevation"].values, frequency)
        yield Check(
            f"amplitude of the wave, drag {'on' if drag else 'off'}", abs(wave), HEIGHT / 2.0,
            "half the height", 1e-3, "m", True,
        )  # fmt: skip
        for name in IN_PLANE:
            found = harmonic(late["time"].values, motion(late, name), frequency) / wave
            wanted = linear[name]
            what = f"{name} per metre of wave, drag {'on' if drag else 'off'}"
            yield Check(what, abs(found), abs(wanted), LINEAR, tolerance, UNITS[name], True)
            phase = np.degrees(np.angle(found / wanted))
            yield Check(f"phase of {what}", phase, 0.0, LINEAR, 2.0 if not drag else None, "deg")


@cache
def irregular(structure: str = "rigid", step: float = STEP, **parts: Any) -> xarray.Dataset:
    """An hour of the irregular sea, after the transient."""
    blocks = {"structure": {"blades": "rigid", **parts}} if structure == "flexible" else {}
    return parked(
        SETTLED + HOUR,
        {**JONSWAP, "drag": False},
        time_step_s=step,
        outputs={"interval_s": 0.2, "start_s": SETTLED},
        **blocks,
    )


def transfer(result: xarray.Dataset, values: Array) -> tuple[Array, Array, Array]:
    """Frequencies Hz, transfer function from the elevation, and coherence."""
    time = result["time"].values
    rate = 1.0 / (time[1] - time[0])
    wave = result["wave_elevation"].values
    segment = int(SEGMENT * rate)
    options = {"fs": rate, "nperseg": segment, "noverlap": segment // 2}
    f, cross = csd(wave, values, **options)
    own, other = welch(wave, **options)[1], welch(values, **options)[1]
    return f, cross / own, np.abs(cross) ** 2 / (own * other)


def transfer_functions() -> Iterator[Check]:
    """Motions over elevation in the irregular sea, between 0.05 and 0.2 Hz."""
    result = irregular()
    height = 4.0 * result["wave_elevation"].values.std()
    yield Check("significant height of the hour", height, HEIGHT, "asked for", None, "m", True)
    for name in IN_PLANE:
        f, found, coherence = transfer(result, motion(result, name))
        band = (f >= BAND[0]) & (f <= BAND[1]) & (coherence > COHERENCE)
        wanted = np.array([linear_response(2.0 * np.pi * hz)[name] for hz in f[band]])
        weight = np.abs(wanted) > 0.05 * np.abs(wanted).max()
        gap = np.abs(np.abs(found[band]) / np.abs(wanted) - 1.0)[weight]
        yield Check(
            f"{name} over elevation: largest deviation of the modulus at {int(weight.sum())} "
            "frequencies", float(gap.max()), 0.0, LINEAR, TRANSFER, "-",
        )  # fmt: skip
        yield Check(
            f"{name} over elevation: mean deviation", float(gap.mean()), 0.0, LINEAR, None, "-"
        )
