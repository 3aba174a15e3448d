"""Mixed-up units and signs in WAMIT files, found by what water must do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import Complex, HydroDatabase
from galerna.hydro.database_checks import haskind_ratio, long_waves
from galerna.units import DEG

_TURN = 2.0 * np.pi


def check_phases(path: Path, table: Array) -> None:
    """Columns MOD and PHA (degrees) of .3 say the same as RE and IM. Raises InputError."""
    modulus, phase, force = table[:, 3], table[:, 4], table[:, 5] + 1j * table[:, 6]
    size = np.maximum(np.abs(force), 1e-3 * np.abs(force).max() + 1e-300)
    degrees = (np.abs(modulus * np.exp(1j * phase * DEG) - force) / size).max()
    radians = (np.abs(modulus * np.exp(1j * phase) - force) / size).max()
    if degrees > 0.01:
        found = "in radians" if radians < 0.01 else f"off by {100 * degrees:.3g} %"
        raise InputError(
            str(path),
            f"the modulus and phase do not give the real and imaginary parts: phases are {found}",
            "columns are PER BETA I MOD PHA RE IM, phases and headings in degrees",
        )


def check_headings(path: Path, degrees: Array, surge: Complex, sway: Complex) -> None:
    """Headings of .3 are degrees: the longest waves push where they go. Raises InputError.

    ``surge`` and ``sway`` (m,) are the excitation at the lowest frequency.
    """
    if len(degrees) < 3 or np.abs(degrees).max() > _TURN + 0.01:
        return

    def misfit(angle: Array) -> float:
        wanted = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        found = np.stack([surge, sway], axis=1)
        scale = np.vdot(wanted, found) / np.vdot(wanted, wanted)
        return float(np.linalg.norm(found - scale * wanted) / np.linalg.norm(found))

    if misfit(degrees) < 0.5 * misfit(degrees * DEG):
        raise InputError(
            str(path),
            f"headings from {degrees[0]:.4g} to {degrees[-1]:.4g} are radians: the force of the "
            "longest waves turns with them so",
            "WAMIT's headings are degrees",
        )


def check_units(base: HydroDatabase, files: Mapping[str, Path], column: str) -> None:
    """Lengths, masses and frequencies belong together. Raises InputError with the figures."""
    _check_stiffness(base, files[".hst"])
    _check_mass(base, files[".1"])
    ratio = haskind_ratio(base)
    fits = ratio is None or 0.5 < ratio < 2.0
    better = [] if fits else [name for name, w in _readings(base, column).items() if _fits(base, w)]
    if not better:  # the excitation's own units come first
        _check_long_waves(base, files)
    if not fits:
        hint = f"read it with first_column={better[0]!r}" if better else "look at its units"
        raise InputError(
            str(files[".1"]),
            f"damping is {ratio:.3g} times that of the waves which the excitation implies, with "
            f"the first column as {column} ({base.frequency[0]:.4g} to {base.frequency[-1]:.4g} "
            "rad/s)",
            hint,
        )


def _check_stiffness(base: HydroDatabase, path: Path) -> None:
    """A waterplane is not 50 times larger than the displaced volume's cube's side."""
    weight = base.water_density * base.gravity
    area, side = base.hydrostatic_stiffness[2, 2] / weight, base.displaced_volume ** (2.0 / 3.0)
    if area > 50.0 * side:
        raise InputError(
            str(path),
            f"C33 means a waterplane of {area:.4g} m2 for {base.displaced_volume:.4g} m3 displaced"
            f"; over rho g = {weight:.5g} it is {area / weight:.4g} m2",
            "the file is dimensional; WAMIT's holds C over rho g ULEN^2, L^3, L^4",
        )
    if area < 0.0:
        raise InputError(str(path), f"C33 means a waterplane of {area:.4g} m2", "look at the signs")


def _check_mass(base: HydroDatabase, path: Path) -> None:
    added, displaced = base.added_mass_infinite, base.water_density * base.displaced_volume
    ratio = max(added[0, 0], added[1, 1], added[2, 2]) / displaced
    if not 0.02 < ratio < 30.0:
        raise InputError(
            str(path),
            f"the largest added mass at infinite frequency is {ratio:.3g} of the displaced mass "
            f"{displaced:.4g} kg",
            "the file holds A over rho ULEN^3, L^4, L^5: give its ULEN, density and volume",
        )


def _check_long_waves(base: HydroDatabase, files: Mapping[str, Path]) -> None:
    long = long_waves(base)
    if long is None:
        return
    if long.surge.real < 0.0:
        raise InputError(
            str(files[".3"]),
            f"the longest waves' force along x is {long.surge.real:.3g} times what their "
            "acceleration gives: it has the other sign",
            "the file has the time factor exp(-i w t) or waves that come from BETA; WAMIT has "
            "exp(+i w t) and waves towards BETA",
        )
    for name, ratio in (("heave over C33 + a_z m", long.heave), ("surge over a_x m", long.surge)):
        if np.isfinite(ratio.real) and not 0.2 < abs(ratio) < 3.0:
            raise InputError(
                f"{files['.3']} and {files['.hst']}",
                f"the force of the longest waves ({base.frequency[0]:.4g} rad/s), {name}, is "
                f"{abs(ratio):.4g} times what it must be",
                "look at ULEN and at which of the files are dimensional",
            )


def _readings(base: HydroDatabase, column: str) -> dict[str, Array]:
    """Frequencies rad/s if the first column held something else."""
    w = base.frequency
    first = {"period": _TURN / w, "rad/s": w, "Hz": w / _TURN}[column]
    every = {"period": _TURN / first, "rad/s": first, "Hz": _TURN * first}
    return {name: value for name, value in every.items() if name != column}


def _fits(base: HydroDatabase, frequency: Array) -> bool:
    damping = base.damping * (frequency / base.frequency)[:, None, None]
    order = np.argsort(frequency)
    other = replace(
        base,
        frequency=frequency[order],
        damping=damping[order],
        added_mass=base.added_mass[order],
        excitation=base.excitation[order],
    )
    ratio = haskind_ratio(other)
    return ratio is not None and 0.5 < ratio < 2.0
