"""The OC3 spar's own coefficients beside WAMIT's, closed forms and what theory ties together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import h2vp, jvp

from galerna.contract import Array
from galerna.hydro.database import Complex, HydroDatabase
from galerna.hydro.database_checks import haskind_ratio, long_waves, smallest_damping
from galerna.hydro.netcdf import read_netcdf
from galerna.turbine import library

from .framework import Case, Check
from .rotors import table

WAMIT = (
    "WAMIT, OC3 Hywind (NREL/TP-500-47535): spar.1, spar.3 of OpenFAST's regression tests "
    "(Apache-2.0), 26 of its frequencies from 0.05 to 5 rad/s; over the largest of each"
)
REPORT = "NREL/TP-500-47535, Table 4-2"
THEORY = "Haskind's relation (Newman, J. Ship Res. 6, 1962) and long-wave limits"
CYLINDER = (
    "MacCamy and Fuchs' cylinder (Beach Erosion Board TM 69, 1954) of 6.5 m in deep water, "
    "momentum of the waves that it sends away"
)
MODES = {"1": 0, "3": 2, "5": 4}


def shipped() -> HydroDatabase:
    """The database that comes with the turbine nrel5mw_oc3."""
    return read_netcdf(library.FOLDER / "nrel5mw_oc3.hydro.nc")


def against_wamit() -> Sequence[Check]:
    rows = table("afloat/wamit_oc3_spar.csv")
    finite, limit = rows[:-1], rows[-1]
    frequency = np.array([float(row["frequency"]) for row in finite])
    base = shipped()
    added, damping = base.coefficients_at(frequency)
    force = base.excitation_at(frequency, 0.0)
    checks = []
    for letter, found, tolerance in (("A", added, 0.01), ("B", damping, 0.02)):
        for pair in ("11", "15", "33", "55"):
            i, j = (MODES[digit] for digit in pair)
            reference = np.array([float(row[letter + pair]) for row in finite])
            checks += _differences(letter + pair, found[:, i, j], reference, tolerance)
    for mode, i in MODES.items():
        reference = np.array(
            [float(r[f"X{mode}_re"]) + 1j * float(r[f"X{mode}_im"]) for r in finite]
        )
        checks += _differences("X" + mode, force[:, i], reference, 0.01)
    for pair in ("11", "15", "33", "55"):
        i, j = (MODES[digit] for digit in pair)
        value = float(base.added_mass_infinite[i, j])
        checks.append(
            Check(f"A{pair}(inf)", value, float(limit["A" + pair]), WAMIT, 0.01, "SI", True)
        )
    return checks


def _differences(
    name: str, found: Array | Complex, reference: Array | Complex, tolerance: float
) -> list[Check]:
    apart = np.abs(found - reference) / np.abs(reference).max()
    root = float(np.sqrt(np.mean(apart**2)))
    return [
        Check(f"{name}, largest difference", float(apart.max()), 0.0, WAMIT, tolerance, "1"),
        Check(f"{name}, root mean square", root, 0.0, WAMIT, None, "1"),
    ]


def by_theory() -> Sequence[Check]:
    base = shipped()
    long, ratio = long_waves(base), haskind_ratio(base)
    assert long is not None
    assert ratio is not None
    stiffness = base.hydrostatic_stiffness
    return [
        Check("displaced weight", base.buoyancy, 80_708_100.0, REPORT, 1e-4, "N", True),
        Check("C33", float(stiffness[2, 2]), 332_941.0, REPORT, 0.003, "N/m", True),
        Check("C55", float(stiffness[4, 4]), -4_999_180_000.0, REPORT, 0.003, "N m/rad", True),
        Check("damping over that of the sent waves", ratio, 1.0, THEORY, 0.01, "1"),
        Check("heave force over C33 + a_z m, 0.03 rad/s", long.heave.real, 1.0, THEORY, 0.01, "1"),
        Check("surge force over a_x m, 0.03 rad/s", long.surge.real, 1.0, THEORY, 0.01, "1"),
        Check("smallest eigenvalue of damping", smallest_damping(base)[0], 0.0, THEORY, 1e-3, "1"),
        *[_drift(base, w, tolerance) for w, tolerance in ((3.0, 0.05), (4.0, None), (5.0, None))],
    ]


def _drift(base: HydroDatabase, frequency: float, tolerance: float | None) -> Check:
    drift = base.drift_at(np.array([frequency]), 0.0)
    assert drift is not None
    number = frequency**2 / base.gravity
    reference = cylinder_drift(number, 3.25) * base.water_density * base.gravity
    name = f"mean drift at {frequency:g} rad/s"
    return Check(name, float(drift[0, 0]), reference, CYLINDER, tolerance, "N/m2", True)


def cylinder_drift(wavenumber: float, radius: float) -> float:
    """Mean force over rho g (m) on a deep cylinder: far field f(theta) of the sent waves.

    Integral |f|^2 (1 - cos theta) d theta / (2 pi k).
    """
    order, x = np.arange(60), wavenumber * radius
    part = np.where(order == 0, 1.0, 2.0) * jvp(order, x) / h2vp(order, x)
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    sent = (part[:, None] * np.cos(order[:, None] * angle)).sum(axis=0)
    return float(np.mean(np.abs(sent) ** 2 * (1.0 - np.cos(angle))) / wavenumber)


CASES = [
    Case(
        "afloat-database-wamit", "afloat", "Coefficients of the OC3 spar against WAMIT's",
        against_wamit, 2,
        "Our own panels (9024 in capytaine's direct method) against the published WAMIT run. "
        "Judged within 1 % of the largest (damping 2 %), what two panel codes with meshes of "
        "their own leave; halving the panels' width changes ours by 0.2 %.",
    ),
    Case(
        "afloat-database-theory", "afloat", "What theory knows of the OC3 spar's coefficients",
        by_theory, 1,
        "The report's C33 and C55 are 0.18 % smaller than those of the circles that it "
        "describes (pi/4 6.5^2 rho g is 333.55 kN/m), as of an inscribed polygon of 60 sides; "
        "ours are the circles'. Drift is judged where only the upper 4 m of the spar feel the "
        "waves and they are still eight panels long at the surface, within 5 %.",
    ),
]  # fmt: skip
