"""What the cases afloat share: the OC3 spar in a sea, decays measured, transfer functions."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import xarray

import galerna
from galerna.case import load
from galerna.contract import Array
from galerna.coupling.afloat import Afloat, Floating
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.floating_modes import response
from galerna.hydro.database import Complex
from galerna.machine import Machine, build_machine

from .rotors import table

NO_AIR = 1e-9  #: kg/m3: cases without aerodynamics
#: name in results, unit, and its scale
MOTIONS = {
    "surge": ("platform_surge", 1.0),
    "sway": ("platform_sway", 1.0),
    "heave": ("platform_heave", 1.0),
    "roll": ("platform_roll", 180.0 / np.pi),
    "pitch": ("platform_pitch", 180.0 / np.pi),
    "yaw": ("platform_yaw", 180.0 / np.pi),
}
UNITS = {name: "m" if name in ("surge", "sway", "heave") else "deg" for name in MOTIONS}
PARKED: dict[str, Any] = {"rotor_speed_rpm": 0.0, "pitch_deg": 0.0}


def parked(duration: float, sea: Any, **blocks: Any) -> xarray.Dataset:
    """The OC3 spar with its rotor held and no air, in a sea for ``duration`` s."""
    return galerna.run(parked_case(duration, sea, **blocks))


def parked_case(duration: float, sea: Any, **blocks: Any) -> dict[str, Any]:
    """The case of ``parked``."""
    return {
        "galerna": 1,
        "turbine": "nrel5mw_oc3",
        "duration_s": duration,
        "inflow": {"wind_speed_m_s": 1.0},
        "air_density_kg_m3": NO_AIR,
        "tower_and_nacelle_drag": False,
        "structure": "rigid",
        "operation": PARKED,
        "sea": sea,
        **blocks,
    }


@cache
def still_machine(structure: str) -> Machine:
    """The machine of ``parked`` at rest."""
    return build_machine(load(parked_case(1.0, {"drag": False}, structure=structure)))


def afloat_of(machine: Machine) -> Afloat:
    """The water of a machine that has some."""
    assert machine.afloat is not None
    return machine.afloat


def floating_of(machine: Machine) -> Floating:
    """The platform of a machine that floats."""
    floating = afloat_of(machine).floating
    assert floating is not None
    return floating


class LinearMachine:
    """The machine of ``parked`` about its rest, in the frequency domain."""

    def __init__(self, structure: str) -> None:
        machine = still_machine(structure)
        moving = machine.simulation.structure
        assert isinstance(moving, FlexibleMachine)
        self.moving, self.database = moving, afloat_of(machine).database
        models = machine.simulation.load_models.values()
        self._loads = [
            model.loads(0.0, at) for model, at in zip(models, moving.motions, strict=True)
        ]
        self.platform = int(moving.parts.parts["platform"][0])
        self.top = moving.system.names.index("nacelle")

    def answer(self, frequency: float, force: Complex) -> Complex:
        """Motion (n,6) of all frames for Re[force exp(i w t)] (6,) on the platform, rad/s."""
        return response(
            self.moving, self.moving.accepted, self._loads, self.database, frequency, force
        )


@cache
def linear_machine(structure: str) -> LinearMachine:
    """That machine, once."""
    return LinearMachine(structure)


def motion(result: xarray.Dataset, name: str) -> Array:
    """A platform motion over time in m or deg."""
    channel, scale = MOTIONS[name]
    return np.asarray(scale * result[channel].values)


@cache
def openfast_decay(case: str) -> dict[str, Array]:
    """Time s and motions m, deg of a free decay by OpenFAST."""
    rows = [row for row in table("afloat/openfast_decays.csv") if row["case"] == case]
    return {name: np.array([float(row[name]) for row in rows]) for name in ("time", *MOTIONS)}


def turning_points(time: Array, values: Array) -> tuple[Array, Array]:
    """Times and values of the extremes of a swing, each by the parabola through three samples."""
    rises = np.diff(values) > 0.0
    at = 1 + np.flatnonzero(rises[1:] != rises[:-1])
    before, here, after = values[at - 1], values[at], values[at + 1]
    bend = before - 2.0 * here + after
    shift = 0.5 * (before - after) / bend
    step = time[1] - time[0]
    return time[at] + shift * step, here - 0.25 * (before - after) * shift


def swing(time: Array, values: Array, cycles: int, period: float) -> tuple[float, float]:
    """Period s and damping ratio of the first ``cycles`` of a decay that starts at its extreme.

    By the extremes that are the largest within half of the expected ``period`` s: their mean
    spacing, and the mean decrement of the ranges between neighbours, which needs no mean value.
    """
    smooth = values - values.mean()
    at, size = turning_points(time, smooth)
    kept = [(time[0], smooth[0])]
    for t, v in zip(at, size, strict=True):
        if t - kept[-1][0] > 0.35 * period:
            kept.append((t, v))
        if len(kept) == 2 * cycles + 1:
            break
    times, sizes = (np.array(column) for column in zip(*kept, strict=True))
    ranges = np.abs(np.diff(sizes))
    decrement = -np.polyfit(np.arange(len(ranges)), np.log(ranges), 1)[0]
    ratio = decrement / np.hypot(np.pi, decrement)
    return float(2.0 * np.mean(np.diff(times))), float(ratio)


def likeness(time: Array, values: Array, other_time: Array, other: Array) -> tuple[float, float]:
    """Factor by which ``values`` follow ``other`` about their means, and their correlation."""
    here = np.interp(other_time, time, values)
    a, b = here - here.mean(), other - other.mean()
    return float(a @ b / (b @ b)), float(a @ b / np.sqrt((a @ a) * (b @ b)))


def harmonic(time: Array, values: Array, frequency: float) -> complex:
    """Complex amplitude of a frequency rad/s: Re[a exp(i w t)] beside mean and second harmonic."""
    phases = frequency * time
    columns = [np.ones_like(time)]
    for n in (1, 2):
        columns += [np.cos(n * phases), -np.sin(n * phases)]
    fitted = least_squares_fit(np.stack(columns, axis=1), values)
    return complex(fitted[1], fitted[2])


def least_squares_fit(columns: Array, values: Array) -> Array:
    """Coefficients of a linear least-squares fit."""
    return np.asarray(np.linalg.lstsq(columns, values, rcond=None)[0])
