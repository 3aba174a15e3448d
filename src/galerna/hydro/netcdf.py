"""Hydrodynamic databases as NetCDF: everything in SI with its unit, exact to the bit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import HydroDatabase
from galerna.hydro.database_checks import checked
from galerna.hydro.interpolation import refuse_failed
from galerna.hydro.rigid import MODES

FORMAT = 1
_PAIR = ("mode", "motion")
_MATRIX = "kg, kg m, kg m2 (force: translations, rotations)"

#: variable: dimensions, unit, meaning; complex ones have a further dimension "part".
_VARIABLES: dict[str, tuple[tuple[str, ...], str, str]] = {
    "added_mass": (("frequency", *_PAIR), _MATRIX, "added mass"),
    "damping": (("frequency", *_PAIR), "N s/m, N s, N m s", "radiation damping"),
    "added_mass_infinite": (_PAIR, _MATRIX, "added mass at infinite frequency"),
    "added_mass_zero": (_PAIR, _MATRIX, "added mass at zero frequency"),
    "excitation": (
        ("frequency", "heading", "mode", "part"),
        "N/m, N",
        "excitation per wave amplitude at the reference point, time factor exp(+i w t)",
    ),
    "hydrostatic_stiffness": (_PAIR, "N/m, N, N m", "stiffness of buoyancy alone"),
    "mean_drift": (
        ("frequency", "heading", "mode"),
        "N/m2, N/m",
        "mean second-order force over the square of the wave amplitude",
    ),
    "center_of_buoyancy": (("axis",), "m", "centre of the displaced water"),
    "reference_point": (("axis",), "m", "point of the motions and moments"),
    "displaced_volume": ((), "m3", "displaced volume"),
    "water_depth": ((), "m", "water depth"),
    "water_density": ((), "kg/m3", "density of the water"),
    "gravity": ((), "m/s2", "gravity"),
}
_OPTIONAL = ("added_mass_zero", "mean_drift")


def write_netcdf(base: HydroDatabase, path: Path | str) -> None:
    """Write a database. Raises InputError where frequencies failed."""
    refuse_failed(base.failed, "written")
    data = xr.Dataset(
        {name: _variable(base, name) for name in _VARIABLES if getattr(base, name) is not None},
        coords={
            "frequency": ("frequency", base.frequency, {"units": "rad/s"}),
            "heading": ("heading", base.heading, {"units": "rad", "long_name": "waves go there"}),
            "mode": list(MODES),
            "motion": list(MODES),
            "part": ["real", "imaginary"],
        },
        attrs={"galerna_hydrodynamics": FORMAT, **dict(base.settings)},
    )
    packed = {"zlib": True, "complevel": 9, "shuffle": True}
    encoding = {str(name): packed for name, v in data.data_vars.items() if v.ndim > 1}
    data.to_netcdf(path, engine="netcdf4", encoding=encoding)


def _variable(base: HydroDatabase, name: str) -> xr.Variable:
    dims, unit, meaning = _VARIABLES[name]
    values = np.asarray(getattr(base, name))
    if "part" in dims:
        values = np.stack([values.real, values.imag], axis=-1)
    return xr.Variable(dims, values, {"units": unit, "long_name": meaning})


def read_netcdf(path: Path | str) -> HydroDatabase:
    """Read a database. Raises InputError where the file is not one or does not hold together."""
    try:
        with xr.open_dataset(path, engine="netcdf4") as data:
            base = _database(data.load(), str(path))
    except FileNotFoundError as error:
        raise InputError(
            str(path), "is not there", "compute it: galerna hydro TURBINE --output FILE"
        ) from error
    except (OSError, ValueError) as error:
        raise InputError(str(path), f"is not a NetCDF file: {error}", "") from error
    return checked(base, str(path))


def _database(data: xr.Dataset, where: str) -> HydroDatabase:
    settings = dict(data.attrs)
    if settings.pop("galerna_hydrodynamics", None) != FORMAT:
        raise InputError(
            where,
            "is not a hydrodynamic database of galerna",
            "make one with galerna hydro TURBINE, or read WAMIT's .1, .3 and .hst",
        )
    missing = [n for n in _VARIABLES if n not in data and n not in _OPTIONAL]
    if missing:
        raise InputError(where, f"lacks {', '.join(missing)}", "compute it again: galerna hydro")
    fields: dict[str, Any] = {name: _values(data, name) for name in _VARIABLES if name in data}
    return replace(
        HydroDatabase(frequency=data["frequency"].values, heading=data["heading"].values, **fields),
        settings={key: _plain(value) for key, value in settings.items()},
    )


def _values(data: xr.Dataset, name: str) -> Array | float:
    values = data[name].values
    if "part" in data[name].dims:
        return np.asarray(values[..., 0] + 1j * values[..., 1])
    return float(values) if values.ndim == 0 else values


def _plain(value: Any) -> str | float:
    return value if isinstance(value, str) else float(value)
