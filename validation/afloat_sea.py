"""The OC3 spar in waves without wind: beside its linear response, and what steps and damping do."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import xarray
from scipy.signal import csd, welch

from galerna.contract import Array

from .afloat import MOTIONS, UNITS, harmonic, linear_machine, motion, parked
from .framework import Case, Check

LINEAR = "linear response of the same machine in the frequency domain, from its database"
HEIGHT, PERIOD = 6.0, 10.0  #: m and s, of the dissertation's waves
REGULAR = {"waves": {"kind": "regular", "height_m": HEIGHT, "period_s": PERIOD}}
JONSWAP = {"waves": {"kind": "jonswap", "significant_height_m": HEIGHT, "peak_period_s": PERIOD}}
WITHOUT_DRAG, WITH_DRAG, TRANSFER = 0.02, 0.05, 0.05  #: as was asked for

BAND, COHERENCE = (0.05, 0.2), 0.9  #: Hz
SETTLED, HOUR, STEP = 1200.0, 3600.0, 0.1  #: s
SEGMENT = 400.0  #: s of a spectrum's windows
IN_PLANE = ("surge", "heave", "pitch")


@cache
def linear_response(frequency: float, structure: str = "rigid") -> dict[str, complex]:
    """Amplitudes m, deg of the platform's motions and of the tower's top (m) for 1 m of wave."""
    machine = linear_machine(structure)
    moved = machine.answer(frequency, machine.database.excitation_at([frequency], 0.0)[0])
    node, top = machine.platform, machine.top
    scales = [scale for _, scale in MOTIONS.values()]
    found = dict(zip(MOTIONS, moved[node] * scales, strict=True))
    height = machine.moving.accepted.position[:, 2]
    lever = height[top] - height[node]
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


#: what the dissertation varies in 600 s of the sea: flexible tower, rigid blades
STUDIED, STUDY_FROM = 600.0, 100.0  #: s
STEPS = (0.07, 0.14)  #: s: 5 and 10 deg of azimuth at rated speed
FINE = 0.035  #: s
DISSIPATION = (0.01, 0.05, 0.1)  #: alpha_N of Newmark-beta
DISSERTATION = "dissertation, 3.4.2"


@cache
def study(step: float, alpha_n: float | None = None) -> xarray.Dataset:
    """The flexible tower in the irregular sea."""
    newmark = {} if alpha_n is None else {"alpha_n": alpha_n}
    return parked(
        STUDIED,
        JONSWAP,
        structure={"blades": "rigid", **newmark},
        time_step_s=step,
        outputs={"interval_s": 4.0 * FINE, "start_s": STUDY_FROM},
    )


def deviations(result: xarray.Dataset) -> dict[str, float]:
    """Standard deviations m, deg of the platform's motions and the tower's top."""
    found = {name: float(motion(result, name).std()) for name in IN_PLANE}
    found["tower top"] = float(result["tower_top_fore_aft_displacement"].std())
    return found


def band_deviation(time: Array, values: Array, low: float, high: float) -> float:
    """Standard deviation of values over time s between two frequencies Hz."""
    f, density = welch(values, 1.0 / (time[1] - time[0]), nperseg=len(values) // 4)
    inside = (f >= low) & (f <= high)
    return float(np.sqrt(np.trapezoid(density[inside], f[inside])))


def tower_bending(result: xarray.Dataset) -> float:
    """Standard deviation m of the tower top's displacement about the tower's own frequency."""
    values = result["tower_top_fore_aft_displacement"].values
    return band_deviation(result["time"].values, values, 0.4, 0.55)


def steps() -> Iterator[Check]:
    """What a larger step changes."""
    fine = deviations(study(FINE))
    for step in STEPS:
        found = deviations(study(step))
        for name, value in found.items():
            tolerance = 0.02 if name != "tower top" or step == STEPS[0] else None
            yield Check(
                f"standard deviation of {name}, step {step:g} s", value, fine[name],
                f"the same at {FINE:g} s", tolerance, "m or deg", True,
            )  # fmt: skip


def dissipation() -> Iterator[Check]:
    """What the dissipation of Newmark-beta changes."""
    reference = study(STEPS[0])
    own = deviations(reference)
    for alpha_n in DISSIPATION:
        result = study(STEPS[0], alpha_n)
        found = deviations(result)
        for name in IN_PLANE:
            yield Check(
                f"standard deviation of {name}, alpha_N {alpha_n:g}", found[name], own[name],
                "generalized-alpha, rho_inf 0.9", 0.02, "m or deg", True,
            )  # fmt: skip
        yield Check(
            f"tower top between 0.4 and 0.55 Hz, alpha_N {alpha_n:g}",
            tower_bending(result), tower_bending(reference),
            "generalized-alpha, rho_inf 0.9", None, "m", True,
        )  # fmt: skip


def rigid_and_flexible() -> Iterator[Check]:
    """The platform with a rigid and a flexible tower, and the tower's top."""
    rigid = parked(
        STUDIED, JONSWAP, structure="rigid", time_step_s=STEPS[0],
        outputs={"interval_s": 4.0 * FINE, "start_s": STUDY_FROM},
    )  # fmt: skip
    flexible = study(STEPS[0])
    for name in IN_PLANE:
        soft, stiff = motion(flexible, name), motion(rigid, name)
        time = rigid["time"].values
        yield Check(
            f"standard deviation of {name} between 0.06 and 0.2 Hz: flexible beside rigid tower",
            band_deviation(time, soft, 0.06, 0.2), band_deviation(time, stiff, 0.06, 0.2),
            f"{DISSERTATION}: both very close", None, UNITS[name], True,
        )  # fmt: skip
    frequency = 2.0 * np.pi / PERIOD
    late = parked(
        800.0, {**REGULAR, "drag": False}, structure={"blades": "rigid"}, time_step_s=0.05
    ).sel(time=slice(500.0, None))
    time = late["time"].values
    wave = harmonic(time, late["wave_elevation"].values, frequency)
    wanted = linear_response(frequency, "flexible")
    for name in IN_PLANE:
        found = abs(harmonic(time, motion(late, name), frequency) / wave)
        what = f"{name} per metre of a regular wave of 10 s, flexible tower"
        yield Check(what, found, abs(wanted[name]), LINEAR, WITHOUT_DRAG, UNITS[name], True)
        yield Check(
            what, abs(wanted[name]), abs(linear_response(frequency)[name]),
            "the same linear response with a rigid tower", None, UNITS[name], True,
        )  # fmt: skip
    top = harmonic(time, late["tower_top_fore_aft_displacement"].values, frequency) / wave
    yield Check(
        "tower top, fore-aft, per metre of a regular wave of 10 s", abs(top),
        abs(wanted["tower top"]), LINEAR, WITHOUT_DRAG, "m", True,
    )  # fmt: skip


CASES = [
    Case(
        "afloat-regular-wave", "afloat", "OC3 spar in a regular wave of 6 m and 10 s",
        lambda: list(regular()), 60.0,
        "Rigid, no air. The linear response is solved with the same structure, lines and database "
        "at the wave's frequency; in time the water's memory is the fitted state space.",
    ),
    Case(
        "afloat-transfer-functions", "afloat", "OC3 spar in an hour of JONSWAP, 6 m and 10 s",
        lambda: list(transfer_functions()), 120.0,
        "Rigid, no air, drag off, from the same elevation, by Welch's method with windows of "
        f"{SEGMENT:g} s after {SETTLED:g} s. Judged where the coherence is above 0.9 and the "
        "linear response above a twentieth of its largest value in the band.",
    ),
    Case(
        "afloat-flexible-tower", "afloat", "Rigid and flexible tower in waves",
        lambda: list(rigid_and_flexible()), 150.0,
        "The flexible tower takes 4 % of the surge and 5 % of the pitch at the waves, in time as "
        "in the linear response. The dissertation has both machines equal, on logarithmic plots; a "
        "judgement by 3 % was tried first and failed.",
    ),
    Case(
        "afloat-steps", "afloat", "Time steps in an irregular sea", lambda: list(steps()), 120.0,
        "Dissertation 3.4.2, Fig. 3.24: 5 and 10 deg of azimuth, flexible tower, drag on.",
    ),
    Case(
        "afloat-dissipation", "afloat", "Numerical dissipation in an irregular sea",
        lambda: list(dissipation()), 120.0, "Dissertation 3.4.2, Fig. 3.23.",
    ),
]  # fmt: skip
