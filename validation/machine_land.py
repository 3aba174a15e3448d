"""The NREL 5 MW on land under ROSCO, beside OpenFAST with the same controller and wind."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import xarray

from .framework import Case, Check
from .machine import (
    in_openfast_units,
    late,
    openfast_land,
    rosco_input,
    simulate,
    write_wind_of_openfast,
)
from .rotors import columns, table

BEAMDYN = "OpenFAST v5.0.0, BeamDyn blades of order 5, ROSCO 2.10"
ELASTODYN = "OpenFAST v5.0.0, ElastoDyn (three linear modes a blade, no torsion), ROSCO 2.10"
MEAN, DEVIATION = 0.03, 0.10  #: what was asked for: of the reference
STEADY, SETTLED = 80.0, 50.0  #: s of a run, and from where it counts
TURBULENT = (60.0, 200.0)  #: s

#: AeroDyn's settings in the deck of these runs
DECK: dict[str, Any] = {
    "skewed_wake": "pitt_peters",
    "drag_in_axial_induction": False,
    "drag_in_tangential_induction": False,
    "angle_of_attack_point": "aerodynamic_center",
    "quasi_steady": True,
    "tower_influence": False,
}

#: name in OpenFAST here and there, text, unit
RotorQuantity = tuple[str, str, str, str]
OPERATION: tuple[RotorQuantity, ...] = (
    ("RotSpeed", "RotSpeed", "rotor speed", "rpm"),
    ("BldPitch1", "BldPitch1", "pitch", "deg"),
    ("GenPwr", "GenPwr", "electrical power", "kW"),
    ("RtAeroFxh", "RtFldFxh", "aerodynamic thrust", "N"),
)
LOADS: tuple[RotorQuantity, ...] = (
    ("RootMyc1", "RootMyc1", "out-of-plane moment of the blade root", "kN m"),
    ("RootMxc1", "RootMxc1", "in-plane moment of the blade root", "kN m"),
    ("TwrBsMyt", "TwrBsMyt", "fore-aft moment of the tower base", "kN m"),
    ("TwrBsMxt", "TwrBsMxt", "side-side moment of the tower base", "kN m"),
)
DEFLECTIONS: tuple[RotorQuantity, ...] = (
    ("OoPDefl1", "OoPDefl1", "out-of-plane deflection of the tip", "m"),
    ("TTDspFA", "TTDspFA", "fore-aft deflection of the tower top", "m"),
)

#: Standard deviations that are not transients dying out: gravity and tilt over a turn
STEADY_DEVIATIONS = {"RootMxc1", "RootMyc1"}


def on_land(wind: dict[str, Any], duration: float) -> xarray.Dataset:
    """The turbine of the OpenFAST runs in a wind, for ``duration`` s."""
    controller = {"model": "discon", "library": "rosco", "input_file": str(rosco_input())}
    return simulate(
        turbine="nrel5mw",
        duration_s=duration,
        inflow=wind,
        aerodynamics=DECK,
        structure="flexible",
        control=controller,
        outputs={"interval_s": 0.1},
    )


def steady(wind_speed: float) -> Iterator[Check]:
    """Means, and the deviations that gravity makes, in uniform wind."""
    result = late(on_land({"wind_speed_m_s": wind_speed}, STEADY), SETTLED)
    for source, code in ((BEAMDYN, "bd"), (ELASTODYN, "ed")):
        reference = openfast_land(code, f"{wind_speed:g}")
        for quantity in (*OPERATION, *LOADS, *DEFLECTIONS):
            yield from _means(result, reference, quantity, source, code == "bd")
        for quantity in LOADS:
            judged = code == "bd" and quantity[1] in STEADY_DEVIATIONS
            yield _deviation(result, reference, quantity, source, judged)


@cache
def turbulent_run() -> xarray.Dataset:
    """The turbine in the box of the OpenFAST runs, from 60 to 200 s."""
    with TemporaryDirectory() as folder:
        path = write_wind_of_openfast(Path(folder))
        wind = {
            "turbulence": {"kind": "file", "path": str(path), "below_box": "hold", "margin_m": 6.0}
        }
        return late(on_land(wind, TURBULENT[1]), *TURBULENT)


def turbulent() -> Iterator[Check]:
    """Means and standard deviations in turbulence, and the series beside each other."""
    result = turbulent_run()
    for source, code in ((BEAMDYN, "bd"), (ELASTODYN, "ed")):
        reference = openfast_land(code, "turbulent")
        for quantity in (*OPERATION, *LOADS, *DEFLECTIONS):
            yield from _means(result, reference, quantity, source, code == "bd")
            judged = code == "bd" and quantity not in DEFLECTIONS
            yield _deviation(result, reference, quantity, source, judged)
        yield from _correlations(result, code, source)


def _means(
    result: xarray.Dataset,
    reference: dict[str, tuple[float, float]],
    quantity: RotorQuantity,
    source: str,
    judged: bool,
) -> Iterator[Check]:
    here, there, text, unit = quantity
    mean, _ = reference[there]
    value = float(in_openfast_units(result, here).mean())
    tolerance = MEAN if judged and quantity not in DEFLECTIONS else None
    yield Check(f"mean {text}", value, mean, source, tolerance, unit, relative=mean != 0.0)


def _deviation(
    result: xarray.Dataset,
    reference: dict[str, tuple[float, float]],
    quantity: RotorQuantity,
    source: str,
    judged: bool,
) -> Check:
    here, there, text, unit = quantity
    value = float(in_openfast_units(result, here).std())
    tolerance = DEVIATION if judged else None
    deviation = reference[there][1]
    return Check(f"standard deviation of {text}", value, deviation, source, tolerance, unit,
                 relative=True)  # fmt: skip


def _correlations(result: xarray.Dataset, code: str, source: str) -> Iterator[Check]:
    """How far the series go together, every 0.5 s."""
    rows = table("machine/openfast_land_turbulent.csv")
    (time,) = columns(rows, "Time")
    for here, there, text, _ in (*OPERATION[:3], LOADS[0], LOADS[2]):
        (series,) = columns(rows, f"{code}_{there}")
        own = np.interp(time, result["time"], in_openfast_units(result, here))
        correlation = float(np.corrcoef(own, series)[0, 1])
        yield Check(f"correlation of {text}", correlation, 1.0, source)


STORY = """
Structure flexible, quasi-steady sections that read their angle of attack at the aerodynamic
centre, no tower influence, drag of the tower, as in the deck of the reference; ROSCO and its input
are those of its wheel. Step 0.02 s, the reference 0.01 s. Judged against BeamDyn, which
twists; ElastoDyn's modes do not, so it needs 0.85 deg more pitch at 18 m/s. BeamDyn at order 5 is
3.6 % too stiff under a tip load of 50 kN. Its root moments are turned into coned axes by the
pitch. In steady wind the tower's deviations are transients dying out: shown.
"""

CASES = (
    *(
        Case(f"machine-land-{wind}", "machine", f"NREL 5 MW with ROSCO in steady {wind} m/s",
             partial(steady, float(wind)), 40, STORY)
        for wind in (8, 12, 18)
    ),
    Case("machine-land-turbulent", "machine", "NREL 5 MW with ROSCO in the same turbulence",
         turbulent, 90,
         STORY + "The wind is the reference's own TurbSim box, cut to 205 s and the rotor's 28 x "
         "28 points and rounded to 0.1 m/s in u and 0.2 m/s in v and w, from 60 to 200 s."),
)  # fmt: skip
