"""The command ``galerna hydro``: a turbine's hull to coefficients, and what they look like."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.capytaine_runs import HEADINGS, Progress, compute, lowest_frequency
from galerna.hydro.database import HydroDatabase
from galerna.hydro.database_checks import haskind_ratio, long_waves, smallest_damping
from galerna.hydro.hull_mesh import platform_panels
from galerna.hydro.netcdf import write_netcdf
from galerna.hydro.panels import (
    Displacement,
    Panels,
    is_revolution,
    revolution_panels,
    revolution_profile,
)
from galerna.hydro.radiation.stored import store_radiation
from galerna.hydro.rigid_machine import afloat, rigid_machine
from galerna.turbine import load
from galerna.turbine.model import Turbine
from galerna.turbine.platform import Platform
from galerna.units import DEG, STANDARD_GRAVITY


@dataclass(frozen=True)
class HydroRow:
    """A figure of a computed database: its name, value as text, and a remark."""

    quantity: str
    value: str
    remark: str = ""


def default_frequencies(last: float = 5.0, depth: float = np.inf) -> Array:
    """About a hundred frequencies rad/s up to ``last``, densest where waves and hulls meet.

    They begin where capytaine can, in a depth m.
    """
    parts = [
        np.array([0.03, 0.04, 0.05, 0.065, 0.08]),
        0.1 + 0.02 * np.arange(5),
        0.2 + 0.03 * np.arange(60),
        2.0 + 0.1 * np.arange(31),
    ]
    every = np.round(np.concatenate(parts), 4)
    beyond = np.arange(5.1, last + 1e-9, 0.1)
    least = lowest_frequency(depth, STANDARD_GRAVITY)
    return np.concatenate([every[(every >= least) & (every <= last + 1e-9)], beyond])


def compute_database(
    turbine: Turbine,
    frequencies: Array | None = None,
    headings: Array = HEADINGS,
    *,
    last_frequency: float = 5.0,
    panel_size: float = 2.0,
    sectors: int = 96,
    water_depth: float | None = None,
    progress: Progress | None = None,
) -> HydroDatabase:
    """Coefficients of a floating turbine's hull by capytaine, with its mean drift.

    A stack of round members on one vertical axis is a body of revolution of ``sectors``
    wedges; any other hull is the union of its members in even panels of ``panel_size`` m.
    ``water_depth`` m replaces the platform's. Raises InputError.
    """
    platform = afloat(turbine)
    depth = platform.water_depth if water_depth is None else water_depth
    if depth <= 0.0:
        raise InputError("platform.water_depth", "is not given", "give the depth of the water in m")
    panels, displaced = _panels(platform, panel_size, sectors)
    _check_draft(panels, depth)
    if frequencies is None:
        frequencies = default_frequencies(last_frequency, depth)
    base = compute(
        panels,
        frequencies,
        headings,
        reference_point=platform.reference_point,
        water_depth=depth,
        displaced=displaced,
        moving=rigid_machine(turbine),
        progress=progress,
    )
    return replace(base, settings={"hull": turbine.name, **base.settings})


def _panels(platform: Platform, size: float, sectors: int) -> tuple[Panels, Displacement | None]:
    if is_revolution(platform.members):
        corners, axis = revolution_profile(platform.members)
        if np.abs(axis - np.asarray(platform.reference_point)[:2]).max() < 1e-6:
            return revolution_panels(corners, size, sectors), None
    return platform_panels(platform, size)


def _check_draft(panels: Panels, depth: float) -> None:
    draft = -float(panels.vertices[:, 2].min())
    if draft > depth:
        raise InputError("platform", f"is {draft:.4g} m deep in {depth:.4g} m of water", "")


def hydro_command(
    turbine: str | Path,
    output: Path | None = None,
    *,
    last_frequency: float = 5.0,
    heading_step_deg: float = 30.0,
    panel_size: float = 2.0,
    sectors: int = 96,
    water_depth: float | None = None,
    progress: Progress | None = None,
) -> tuple[HydroDatabase, Path, list[HydroRow]]:
    """Compute and write the coefficients of a turbine by name or file; tell what they are.

    The file is NAME.hydro.nc in the working directory unless ``output`` names one.
    """
    machine = load(turbine)
    base = compute_database(
        machine,
        headings=_headings(heading_step_deg),
        last_frequency=last_frequency,
        panel_size=panel_size,
        sectors=sectors,
        water_depth=water_depth,
        progress=progress,
    )
    path = output if output is not None else Path(f"{Path(turbine).stem}.hydro.nc")
    write_netcdf(base, path)
    store_radiation(base, path)
    return base, path, table(base, afloat(machine))


def _headings(step: float) -> Array:
    count = round(360.0 / step) if step > 0.0 else 0
    if not count or abs(count * step - 360.0) > 1e-6:
        raise InputError("--heading-step-deg", f"{step:g} does not divide 360", "such as 30 or 15")
    return np.asarray((np.arange(count + 1) * step - 180.0) * DEG)


def table(base: HydroDatabase, platform: Platform | None = None) -> list[HydroRow]:
    """The figures by which a reader judges a database."""
    stated = platform.displaced_volume if platform is not None else 0.0
    volume = f"{100 * (base.displaced_volume / stated - 1):+.3f} % of the stated" if stated else ""
    rows = [
        HydroRow("panels", f"{base.settings.get('panels', 0):.0f}", _resolution(base)),
        HydroRow("displaced volume", f"{base.displaced_volume:.2f} m3", volume),
        HydroRow("buoyancy", f"{base.buoyancy / 1e6:.3f} MN"),
        HydroRow("centre of buoyancy", _triple(base.center_of_buoyancy) + " m"),
    ]
    rows += _diagonal("C", base.hydrostatic_stiffness, (2, 3, 4), ("N/m", "N m/rad"))
    rows += _diagonal("A(inf)", base.added_mass_infinite, range(6), ("kg", "kg m2"))
    return rows + _judgements(base)


def _triple(values: Array) -> str:
    return "({:.3f}, {:.3f}, {:.3f})".format(*(np.round(values, 3) + 0.0))


def _diagonal(
    name: str, matrix: Array, modes: Sequence[int], units: tuple[str, str]
) -> list[HydroRow]:
    return [
        HydroRow(f"{name} {i + 1}{i + 1}", f"{matrix[i, i]:.4e} {units[i >= 3]}") for i in modes
    ]


def _resolution(base: HydroDatabase) -> str:
    shortest = 2.0 * np.pi / float(base.wavenumber[-1])
    return f"shortest wave {shortest:.3g} m at {base.frequency[-1]:.3g} rad/s"


def _judgements(base: HydroDatabase) -> list[HydroRow]:
    """What theory knows of any hull."""
    smallest, at = smallest_damping(base)
    rows = [HydroRow("smallest eigenvalue of damping", f"{smallest:.1e}", f"at {at:.3g} rad/s")]
    ratio, long = haskind_ratio(base), long_waves(base)
    if ratio is not None:
        doubt = "; headings too far apart, or panels too large" if abs(ratio - 1.0) > 0.05 else ""
        rows.append(HydroRow("damping over Haskind's", f"{ratio:.4f}", "1 in theory" + doubt))
    if long is not None:
        at_first = f"1 for long waves; at {base.frequency[0]:.3g} rad/s"
        rows.append(HydroRow("heave force over C33 + a_z m", f"{long.heave.real:.4f}", at_first))
        rows.append(HydroRow("surge force over a_x m", f"{long.surge.real:.4f}", at_first))
    return rows
