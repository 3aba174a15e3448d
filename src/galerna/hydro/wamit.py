"""WAMIT's coefficient files .1, .3 and .hst, and mean drift .8 or .9 where it lies beside.

WAMIT User Manual, chapters 3 and 5. Forces are per wave amplitude with the time factor
exp(+i w t), waves go towards BETA, everything is over powers of rho, g and ULEN (and w for
damping). The first column holds periods in s, where -1 means zero frequency and 0 infinite
frequency; or frequencies, where 0 is zero and a negative number infinite frequency.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import Complex, HydroDatabase
from galerna.hydro.database_checks import checked
from galerna.hydro.wamit_checks import check_headings, check_phases, check_units
from galerna.units import DEG, SEA_WATER, STANDARD_GRAVITY

Column = Literal["period", "rad/s", "Hz"]
_TURN = 2.0 * np.pi
_FREQUENCY: dict[str, Callable[[Array], Array]] = {
    "period": lambda values: _TURN / values,
    "rad/s": lambda values: values,
    "Hz": lambda values: _TURN * values,
}
_DRIFT_FILES = (".8", ".9")
_SAME_HEADING = 1e-4  #: rad
_ROTATION = (np.arange(6) >= 3).astype(int)
_LENGTHS = _ROTATION[:, None] + _ROTATION[None, :]  # powers of ULEN beyond the translations'


def read_wamit(
    path: Path | str,
    *,
    displaced_volume: float,
    water_depth: float,
    reference_point: ArrayLike = (0.0, 0.0, 0.0),
    length: float = 1.0,
    water_density: float = SEA_WATER,
    gravity: float = STANDARD_GRAVITY,
    first_column: Column = "period",
    center_of_buoyancy: ArrayLike | None = None,
) -> HydroDatabase:
    """Read NAME.1, NAME.3 and NAME.hst; ``path`` is NAME or one of them.

    What the files do not say comes beside: displaced volume m3, depth m, the body origin
    (3,) m, ``length`` ULEN m, density, gravity and what ``first_column`` holds. The centre
    of buoyancy (3,) m comes from .hst where not given, its height then NaN. The stiffness
    must be of buoyancy alone: run WAMIT with zero mass, or with its centre in the origin.
    Raises InputError with the figures for what does not fit together.
    """
    files = {suffix: _with_suffix(path, suffix) for suffix in (".1", ".3", ".hst")}
    frequency, added, damping, limits = _radiation(files[".1"], first_column)
    heading, excitation = _excitation(files[".3"], first_column, frequency)
    mass = water_density * length ** (3 + _LENGTHS)
    force = water_density * gravity * length ** (2 + _ROTATION)
    weight = water_density * gravity
    stiffness = weight * length ** (2 + _LENGTHS) * _stiffness(files[".hst"])
    center = _center(stiffness, weight * displaced_volume, reference_point, center_of_buoyancy)
    base = HydroDatabase(
        frequency=frequency,
        added_mass=mass * added,
        damping=mass * frequency[:, None, None] * damping,
        added_mass_infinite=mass * limits["infinite"],
        added_mass_zero=mass * limits["zero"] if "zero" in limits else None,
        heading=heading,
        excitation=force * excitation,
        hydrostatic_stiffness=stiffness,
        displaced_volume=displaced_volume,
        center_of_buoyancy=center,
        reference_point=np.asarray(reference_point, dtype=float),
        water_depth=water_depth,
        water_density=water_density,
        gravity=gravity,
        settings={"program": "WAMIT", "files": _stem(path).name},
    )
    where = str(files[".1"])
    check_units(checked(base, where), files, first_column)
    return replace(base, mean_drift=_drift(path, first_column, base, length))


def _stem(path: Path | str) -> Path:
    path = Path(path)
    return path.with_suffix("") if path.suffix in (".1", ".3", ".hst") else path


def _with_suffix(path: Path | str, suffix: str) -> Path:
    stem = _stem(path)
    return stem.with_name(stem.name + suffix)


def _rows(path: Path) -> list[list[float]]:
    """Numbers of a file's lines; a first line of words is passed over."""
    try:
        lines = path.read_text().splitlines()
    except FileNotFoundError as error:
        raise InputError(str(path), "is not there", "WAMIT writes .1, .3 and .hst") from error
    rows = []
    for number, line in enumerate(lines, start=1):
        try:
            rows.append([float(word) for word in line.replace("D", "E").split()])
        except ValueError as error:
            if number > 1:
                raise InputError(
                    f"{path}, line {number}", f"is not numbers: {line!r}", ""
                ) from error
    return [row for row in rows if row]


def _radiation(path: Path, column: Column) -> tuple[Array, Array, Array, dict[str, Array]]:
    """Rising frequencies (n,), added mass and damping (n,6,6), and limits (6,6) of .1."""
    rows = _rows(path)
    found = sorted({row[0] for row in rows if not _limit_name(row[0], column)})
    values = _rising(np.array(found), column, path)
    place = {value: k for k, value in enumerate(values)}
    added, damping = np.zeros((2, len(values), 6, 6))
    limits: dict[str, Array] = {}
    for number, row in enumerate(rows, start=1):
        name = _limit_name(row[0], column)
        if len(row) < (4 if name else 5):
            raise InputError(f"{path}, line {number}", "has too few columns", "PER I J A B")
        i, j = int(row[1]) - 1, int(row[2]) - 1
        if name:
            limits.setdefault(name, np.zeros((6, 6)))[i, j] = row[3]
        else:
            added[place[row[0]], i, j], damping[place[row[0]], i, j] = row[3:5]
    if "infinite" not in limits:
        raise InputError(
            str(path),
            "lacks the added mass at infinite frequency",
            "run WAMIT with the period 0 among the others",
        )
    return _FREQUENCY[column](values), added, damping, limits


def _limit_name(value: float, column: Column) -> str:
    """'zero' or 'infinite' frequency for WAMIT's marks, else nothing."""
    marks = {"zero": value < 0.0, "infinite": value == 0.0}
    if column != "period":
        marks = {"zero": value == 0.0, "infinite": value < 0.0}
    return next((name for name, holds in marks.items() if holds), "")


def _rising(values: Array, column: Column, path: Path) -> Array:
    """The column's values in the order of rising frequency."""
    if not len(values):
        raise InputError(str(path), "holds no finite frequency", "")
    return values[::-1] if column == "period" else values


def _excitation(path: Path, column: Column, frequency: Array) -> tuple[Array, Complex]:
    """Headings (m,) rad and excitation (n,m,6) over rho g L^2, L^3 of .3."""
    table = _table(path, 7)
    check_phases(path, table)
    values = _rising(np.unique(table[:, 0]), column, path)
    degrees = np.unique(table[:, 1])
    _check_same(path, _FREQUENCY[column](values), frequency)
    force = np.zeros((len(values), len(degrees), 6), complex)
    k = np.searchsorted(-values if column == "period" else values, _signed(table[:, 0], column))
    m = np.searchsorted(degrees, table[:, 1])
    _check_full(
        path, len(values) * len(degrees), len(set(zip(k.tolist(), m.tolist(), strict=True)))
    )
    force[k, m, table[:, 2].astype(int) - 1] = table[:, 5] + 1j * table[:, 6]
    check_headings(path, degrees, force[0, :, 0], force[0, :, 1])
    return degrees * DEG, force


def _check_full(path: Path, wanted: int, found: int) -> None:
    if found < wanted:
        raise InputError(
            str(path),
            f"lacks {wanted - found} of {wanted} pairs of a frequency and a heading",
            "every heading of .3 must come at every frequency",
        )


def _signed(values: Array, column: Column) -> Array:
    return -values if column == "period" else values


def _table(path: Path, columns: int) -> Array:
    rows = _rows(path)
    short = next((n for n, row in enumerate(rows, start=1) if len(row) < columns), None)
    if short is not None:
        raise InputError(f"{path}, line {short}", f"has fewer than {columns} columns", "")
    return np.array([row[:columns] for row in rows])


def _check_same(path: Path, found: Array, frequency: Array) -> None:
    if found.shape != frequency.shape or np.abs(found / frequency - 1.0).max() > 1e-4:
        raise InputError(
            str(path),
            f"holds {len(found)} frequencies from {found[0]:.4g} to {found[-1]:.4g} rad/s, .1 "
            f"holds {len(frequency)} from {frequency[0]:.4g} to {frequency[-1]:.4g} rad/s",
            "both files must come from the same run",
        )


def _stiffness(path: Path) -> Array:
    """Matrix (6,6) over rho g L^2 ... of .hst."""
    matrix = np.zeros((6, 6))
    for i, j, value in _table(path, 3):
        matrix[int(i) - 1, int(j) - 1] = value
    return matrix


def _center(
    stiffness: Array, buoyancy: float, reference: ArrayLike, given: ArrayLike | None
) -> Array:
    """Centre of buoyancy: .hst has minus its buoyancy times x and y in C46 and C56."""
    if given is not None:
        return np.asarray(given, dtype=float)
    x, y = -stiffness[3, 5] / buoyancy, -stiffness[4, 5] / buoyancy
    return np.asarray(reference, dtype=float) + np.array([x, y, np.nan])


def _drift(path: Path | str, column: Column, base: HydroDatabase, length: float) -> Array | None:
    """Mean drift (n,m,6) of waves of one heading, from .8 or .9; None where neither lies there."""
    file = next((f for s in _DRIFT_FILES if (f := _with_suffix(path, s)).exists()), None)
    if file is None:
        return None
    table = _table(file, 8)
    table = table[table[:, 1] == table[:, 2]]
    frequency = _FREQUENCY[column](table[:, 0])
    k = np.abs(frequency[:, None] - base.frequency).argmin(axis=1)
    apart = np.abs(table[:, 1, None] * DEG - base.heading)
    m = apart.argmin(axis=1)
    _check_same(
        file, _FREQUENCY[column](_rising(np.unique(table[:, 0]), column, file)), base.frequency
    )
    here = apart.min(axis=1) < _SAME_HEADING
    _check_full(file, base.excitation[:, :, 0].size, len(set(zip(k[here], m[here], strict=True))))
    drift = np.zeros(base.excitation.shape)
    drift[k[here], m[here], table[here, 3].astype(int) - 1] = table[here, 6]
    return base.water_density * base.gravity * length ** (1 + _ROTATION) * drift


def write_wamit(base: HydroDatabase, path: Path | str, *, length: float = 1.0) -> None:
    """Write NAME.1, NAME.3, NAME.hst, and NAME.8 of mean drift; periods in the first column."""
    mass = base.water_density * length ** (3 + _LENGTHS)
    force = base.water_density * base.gravity * length ** (2 + _ROTATION)
    spring = base.water_density * base.gravity * length ** (2 + _LENGTHS)
    period = _TURN / base.frequency
    lines = []
    for mark, added in ((-1.0, base.added_mass_zero), (0.0, base.added_mass_infinite)):
        if added is not None:
            lines += [_line(mark, i, j, v) for i, j, v in _entries(added / mass)]
    for k, damping in enumerate(base.damping / base.frequency[:, None, None] / mass):
        lines += [
            _line(period[k], i, j, v, damping[i - 1, j - 1])
            for i, j, v in _entries(base.added_mass[k] / mass)
        ]
    _save(path, ".1", lines)
    _save(path, ".3", _force_lines(base, period, base.excitation / force, 1))
    matrix = base.hydrostatic_stiffness / spring
    _save(path, ".hst", [f"{i:6d}{j:6d}{v:18.9E}" for i, j, v in _entries(matrix, full=True)])
    if base.mean_drift is not None:
        scale = base.water_density * base.gravity * length ** (1 + _ROTATION)
        _save(path, ".8", _force_lines(base, period, base.mean_drift / scale, 2))


def _entries(matrix: Array, full: bool = False) -> list[tuple[int, int, float]]:
    return [
        (i + 1, j + 1, float(matrix[i, j]))
        for i in range(6)
        for j in range(6)
        if full or i == j or matrix[i, j] != 0.0
    ]


def _line(period: float, i: int, j: int, *values: float) -> str:
    return f"{period:18.9E}{i:6d}{j:6d}" + "".join(f"{v:18.9E}" for v in values)


def _force_lines(base: HydroDatabase, period: Array, force: ArrayLike, betas: int) -> list[str]:
    """Lines PER BETA (twice for drift) I MOD PHA RE IM."""
    lines = []
    for k, row in enumerate(np.asarray(force, dtype=complex)):
        for degrees, values in zip(base.heading / DEG, row, strict=True):
            for i, value in enumerate(values, start=1):
                parts = (abs(value), np.angle(value) / DEG, value.real, value.imag)
                lines.append(
                    f"{period[k]:18.9E}"
                    + betas * f"{degrees:18.9E}"
                    + f"{i:6d}"
                    + "".join(f"{part:18.9E}" for part in parts)
                )
    return lines


def _save(path: Path | str, suffix: str, lines: list[str]) -> None:
    _with_suffix(path, suffix).write_text("\n".join(lines) + "\n")
