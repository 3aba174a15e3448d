"""Larger turbines from cut-in to cut-out, with every setting as it comes."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
import xarray

from galerna.turbine import load
from galerna.units import DEG, RPM

from .framework import Case, Check, statement
from .machine import late, simulate
from .rotors import table

DURATION, SETTLED = 30.0, 15.0  #: s
HAWCSTAB = "DTU 10 MW operational data (HAWCStab2)"
IEA_REPORT = "NREL/TP-5000-75698, Table ES-1: rated power, speeds and peak power coefficient 0.489"
PEAK_POWER_COEFFICIENT = 0.489
BELOW_RATED, ABOVE_RATED = 0.05, 0.02
SPEED_ABOVE_RATED = 0.01
PITCH = 1.0  #: deg; the reference's gains and blades differ, its twist with them


def operating(name: str, wind_speed: float) -> xarray.Dataset:
    """The last 15 s of a run with nothing set but turbine and wind."""
    result = simulate(
        turbine=name,
        duration_s=DURATION,
        inflow={"wind_speed_m_s": wind_speed},
        structure="flexible",
        control="baseline",
    )
    return late(result, SETTLED)


def dtu10mw(wind_speeds: tuple[int, ...]) -> Iterator[Check]:
    """Power, speed, pitch and thrust beside the published steady table."""
    rows = {int(row["wind_speed_m_s"]): row for row in table("dtu10mw_steady.csv")}
    for wind in wind_speeds:
        run, row = operating("dtu10mw", wind), rows[wind]
        above, judged = wind >= 12, wind >= 8
        power = ABOVE_RATED if above else BELOW_RATED
        for text, value, key, tolerance, unit in (
            ("aerodynamic power", mean(run.rotor_power) / 1e3, "power_kw",
             power if judged else None, "kW"),
            ("rotor speed", mean(run.rotor_speed) / RPM, "rotor_speed_rpm",
             SPEED_ABOVE_RATED if above else None, "rpm"),
            ("aerodynamic thrust", mean(run.rotor_thrust) / 1e3, "thrust_kn", None, "kN"),
        ):  # fmt: skip
            reference = float(row[key])
            yield Check(f"{wind} m/s: {text}", value, reference, HAWCSTAB, tolerance, unit, True)
        pitch = float(row["pitch_deg"])
        yield Check(f"{wind} m/s: pitch", mean(run.pitch) / DEG, pitch, HAWCSTAB,
                    PITCH if above else None, "deg")  # fmt: skip
        yield steady_in_the_end(wind, run)


def iea15mw(wind_speeds: tuple[float, ...]) -> Iterator[Check]:
    """Power and speed beside the figures of the report's table."""
    turbine = load("iea15mw")
    rated, drivetrain = turbine.control, turbine.drivetrain
    area = np.pi * turbine.rotor_radius**2
    for wind in wind_speeds:
        run, above = operating("iea15mw", wind), wind > 11.0
        available = 0.5 * 1.225 * area * wind**3 * drivetrain.generator_efficiency
        power = min(PEAK_POWER_COEFFICIENT * available, rated.rated_power)
        tolerance = ABOVE_RATED if above else None
        yield Check(f"{wind:g} m/s: electrical power", mean(run.electrical_power) / 1e3,
                    power / 1e3, IEA_REPORT, tolerance, "kW", True)  # fmt: skip
        if above:
            speed = rated.rated_rotor_speed / RPM
            yield Check(f"{wind:g} m/s: rotor speed", mean(run.rotor_speed) / RPM, speed,
                        IEA_REPORT, SPEED_ABOVE_RATED, "rpm", True)  # fmt: skip
        yield steady_in_the_end(wind, run)


def steady_in_the_end(wind: float, run: xarray.Dataset) -> Check:
    """Whether power varies by less than 2 % of its mean over the last 15 s."""
    power = run.electrical_power
    held = bool(np.isfinite(power).all()) and float(power.std() / power.mean()) < 0.02
    return statement(f"{wind:g} m/s: power varies by less than 2 %", held, "steady wind")


def mean(values: xarray.DataArray) -> float:
    """Mean over time and blades."""
    return float(values.mean())


STORY = """
Structure flexible, the baseline controller, uniform wind; nothing else is set, at any wind speed.
30 s from a start in equilibrium, the last 15 s count.
"""

CASES = (
    Case("machine-dtu10mw", "machine", "DTU 10 MW from cut-in to cut-out",
         partial(dtu10mw, (4, 8, 11, 12, 18, 25)), 150,
         STORY + "HAWCStab2 tracks a tip-speed ratio of 7.5 exactly and pitches below 7 m/s, where "
         "galerna's controller stays at fine pitch: cut-in is shown, and rotor speed and pitch "
         "below rated."),
    Case("machine-iea15mw", "machine", "IEA 15 MW from cut-in to cut-out",
         partial(iea15mw, (3.0, 8.0, 10.6, 12.0, 18.0, 25.0)), 200,
         STORY + "Below rated the report's peak power coefficient is shown: up to about 7 m/s the "
         "lowest rotor speed keeps the turbine from its best tip-speed ratio, and the blade's "
         "twist under load, which the report's curve does not have, costs power."),
)  # fmt: skip
