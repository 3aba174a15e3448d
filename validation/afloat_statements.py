"""What the dissertation says of the OC3 turbine at work, beside what happens here: 3.4.3, 5.3."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
import xarray

from .afloat_operation import QUANTITIES, energy, operated, peak, series, spectrum, statistic
from .framework import Case, Check, statement

MULTIPHYSICS = "dissertation 3.4.3, Figs. 3.26 to 3.28"
OC3 = "OC3 codes (Jonkman and Musial 2010), as the dissertation's 3.4.3 describes them"
FLOATING = "dissertation 5.3, Figs. 5.21 to 5.24"
SPECTRA = "dissertation 5.3, Figs. 5.25 to 5.29"
AS_LONG = 150.0  #: s, of the dissertation's runs
PITCHING, WAVES, TOWER = (0.022, 0.050), (0.075, 0.130), (0.40, 0.56)  #: Hz, about their peaks
TWICE, MINOR = (0.058, 0.080), (0.14, 0.18)  #: Hz, where the dissertation has more
FLAPWISE = (0.62, 0.85)  #: Hz

#: mean at the start, in calm sea and steady wind
EQUILIBRIUM = {"surge": 11.6, "platform pitch": 2.3, "blade pitch": 14.6, "rotor speed": 12.1,
               "generator power": 5.3}  # fmt: skip
#: kind, quantity, and by how much the second run differs from the first
Claim = tuple[str, str, float]
FROM_OPEN_TO_CLOSED: tuple[Claim, ...] = (
    ("mean", "generator power", 1.0 / 0.90 - 1.0),
    ("mean", "rotor speed", 1.0 / 0.90 - 1.0),
    ("mean", "surge", 1.0 / 0.84 - 1.0),
    ("mean", "platform pitch", 1.0 / 0.84 - 1.0),
    ("range", "surge", -0.20),
    ("range", "generator power", -0.14),
    ("range", "rotor speed", -0.14),
    ("standard deviation", "tower-top fore-aft displacement", -0.05),
    ("standard deviation", "tip displacement out of plane", 0.08),
    ("mean", "root moment out of plane", 0.20),
    ("mean", "root moment in plane", 0.02),
    ("standard deviation", "root moment out of plane", 0.03),
    ("standard deviation", "root moment in plane", -0.12),
)
FROM_REFERENCE_TO_REDESIGN: tuple[Claim, ...] = (
    ("mean", "blade pitch", -0.01),
    ("mean", "generator power", 0.0),
    ("mean", "rotor speed", 0.0),
    ("mean", "surge", 0.05),
    ("mean", "platform pitch", 0.08),
    ("mean", "root moment out of plane", 0.03),
    ("standard deviation", "root moment out of plane", -0.08),
    ("standard deviation", "root moment in plane", -0.11),
    ("standard deviation", "surge", 0.09),
    ("standard deviation", "platform pitch", -0.09),
    ("standard deviation", "tower-top fore-aft displacement", -0.18),
    ("standard deviation", "tip displacement out of plane", -0.06),
    ("standard deviation", "blade pitch", 0.23),
    ("standard deviation", "rotor speed", -0.18),
)
UNCHANGED = 0.02  #: of a mean: what counts as the same
SHOWN = ("surge", "platform pitch", "blade pitch", "rotor speed", "generator power",
         "tower-top fore-aft displacement", "tip displacement out of plane",
         "root moment out of plane", "root moment in plane",
         "fore-aft moment of the tower base")  # fmt: skip


def multiphysics() -> Iterator[Check]:
    """Where the spectra have their peaks."""
    run = operated("reference")
    mean = statistic(run, "mean", "rotor speed")
    yield Check("mean rotor speed", mean, 12.1, MULTIPHYSICS, 0.01, "rpm", relative=True)
    for quantity in ("surge", "heave", "platform pitch"):
        yield has(run, quantity, "the platform's pitching, 0.034 Hz", PITCHING, judged=True)
        yield has(run, quantity, "the waves, 0.1 Hz", WAVES, judged=True)
        yield has(run, quantity, "twice the pitching, 0.07 Hz", TWICE, absent=True)
        yield has(run, quantity, "0.15 and 0.17 Hz", MINOR, absent=True)
    for quantity in ("sway", "roll", "tower-top fore-aft displacement"):
        yield has(run, quantity, "the platform's pitching or rolling, 0.034 Hz", PITCHING)
        yield has(run, quantity, "the tower's bending, 0.47 Hz", TOWER)
    yield has(run, "tower-top fore-aft displacement", "the waves, 0.1 Hz", WAVES, judged=True)
    yield has(run, "tip displacement out of plane", "flapwise bending, 0.71 Hz", FLAPWISE)
    yield has(run, "rotor speed", "the waves, 0.1 Hz", WAVES)
    yield has(run, "rotor speed", "between tower and blades' passing", (0.35, 0.80))


def has(
    run: xarray.Dataset,
    quantity: str,
    text: str,
    band: tuple[float, float],
    *,
    absent: bool = False,
    judged: bool = False,
) -> Check:
    """Whether a spectrum has a peak in a band Hz; those of the codes of OC3 have none if absent."""
    found = not np.isnan(peak(run, quantity, *band))
    if absent:
        return statement(f"{quantity}: no peak at {text}", not found, OC3, judged=judged)
    return statement(f"{quantity}: a peak at {text}", found, MULTIPHYSICS, judged=judged)


def floating(model: str) -> Iterator[Check]:
    """Equilibrium, and how open loop, reference and redesign differ."""
    for quantity, value in EQUILIBRIUM.items():
        first = float(series(operated("reference", model), quantity)[0])
        unit = QUANTITIES[quantity][1]
        yield Check(f"equilibrium, {quantity}", first, value, FLOATING, None, unit, relative=True)
    windows = (AS_LONG,) if model == "lattice" else (np.inf, AS_LONG)
    for end in windows:
        open_loop, reference, redesign = (
            operated(name, model).sel(time=slice(0.0, end))
            for name in ("open loop", "reference", "redesign")
        )
        length = f"{float(reference.time[-1]):.0f} s"
        pair = f"{length}, from open loop to reference"
        yield from changes(pair, open_loop, reference, FROM_OPEN_TO_CLOSED)
        pair = f"{length}, from reference to redesign"
        yield from changes(pair, reference, redesign, FROM_REFERENCE_TO_REDESIGN)
    if model == "BEM":
        yield from spectra()


def changes(
    text: str, before: xarray.Dataset, after: xarray.Dataset, claims: tuple[Claim, ...]
) -> Iterator[Check]:
    """By how much statistics differ, and how many of the text's go the same way here."""
    same = 0
    for kind, quantity, value in claims:
        found = statistic(after, kind, quantity) / statistic(before, kind, quantity) - 1.0
        agrees = abs(found) < UNCHANGED if value == 0.0 else found * value > 0.0
        same += agrees
        yield Check(f"{text}: {kind} of {quantity}", found, value, FLOATING, None, "-")
    yield Check(f"{text}: changes that go the text's way", same, len(claims), FLOATING)


def spectra() -> Iterator[Check]:
    """What the text reads from its spectra."""
    open_loop, reference, redesign = map(operated, ("open loop", "reference", "redesign"))
    deviation = partial(statistic, reference, "standard deviation")
    largest = deviation("surge") > max(deviation("sway"), deviation("heave"))
    yield statement("surge is the largest displacement", largest, SPECTRA, judged=True)
    turning = deviation("platform pitch") > max(deviation("roll"), deviation("yaw"))
    yield statement("pitch is the largest rotation", turning, SPECTRA)
    for quantity in ("sway", "roll", "yaw"):
        share = energy(reference, quantity, *WAVES) / deviation(quantity) ** 2
        yield Check(f"{quantity}: share of the waves' frequencies in the variance", share, 0.0,
                    SPECTRA, None, "-")  # fmt: skip
    for quantity in ("surge", "platform pitch", "tower-top fore-aft displacement"):
        calmer = energy(open_loop, quantity, *PITCHING) < energy(reference, quantity, *PITCHING)
        yield statement(
            f"{quantity}: less at the platform's pitching in open loop", calmer, SPECTRA
        )
        lower = energy(redesign, quantity, *WAVES) < energy(reference, quantity, *WAVES)
        yield statement(f"{quantity}: less at the waves with the redesign", lower, SPECTRA)
    frequency, power = spectrum(reference, "tip displacement out of plane")
    top = float(frequency[power.argmax()])
    yield Check("tip out of plane: frequency of the largest density", top, 0.1, SPECTRA, None, "Hz")


def rosco() -> Iterator[Check]:
    """ROSCO's statistics beside those of the baseline controller with the same gains."""
    own = operated("reference")
    for name in ("ROSCO detuned", "ROSCO on land"):
        for kind in ("mean", "standard deviation"):
            for quantity in SHOWN:
                here, there = (
                    statistic(own, kind, quantity),
                    statistic(operated(name), kind, quantity),
                )
                yield Check(f"{kind} of {quantity}", there, here, f"galerna's baseline; {name}",
                            None, QUANTITIES[quantity][1], relative=True)  # fmt: skip


STORY = ""
CASES = (
    Case("afloat-operation", "afloat", "The OC3 turbine at 18 m/s in turbulence and waves",
         lambda: list(multiphysics()), 200, STORY),
    Case("afloat-operation-bem", "afloat", "Open loop, reference and redesigned gains, by BEM",
         partial(lambda model: list(floating(model)), "BEM"), 600, STORY),
    Case("afloat-operation-lattice", "afloat",
         "Open loop, reference and redesigned gains, by the vortex lattice",
         partial(lambda model: list(floating(model)), "lattice"), 600, STORY),
    Case("afloat-operation-rosco", "afloat", "The OC3 turbine under ROSCO",
         lambda: list(rosco()), 600, STORY),
)  # fmt: skip
