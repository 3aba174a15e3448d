"""A radiation fit beside the coefficients it was made of, so that a run need not make it again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from galerna.contract import Array
from galerna.hydro.database import HydroDatabase

from .fit import fit_radiation
from .state_space import RadiationStateSpace

_PREFIX = "radiation_"


def store_radiation(base: HydroDatabase, path: Path | str) -> RadiationStateSpace:
    """Fit a database and append the fit to its NetCDF file."""
    fit = fit_radiation(base.symmetrised())
    variables = {}
    for name, values in fit.arrays().items():
        dims = tuple(f"{_PREFIX}{name}_{k}" for k in range(values.ndim))
        variables[_PREFIX + name] = (dims, values, {"long_name": "passive radiation fit"})
    packed = {name: {"zlib": True, "complevel": 9} for name in variables}
    xr.Dataset(variables).to_netcdf(path, mode="a", engine="netcdf4", encoding=packed)
    return fit


def stored_radiation(
    path: Path | str, reference_point: Array, water_density: float
) -> RadiationStateSpace | None:
    """The fit in a file, for a density kg/m3; None where there is none about that point."""
    if Path(path).suffix != ".nc":
        return None
    with xr.open_dataset(path, engine="netcdf4") as data:
        if _PREFIX + "A" not in data:
            return None
        if np.abs(data["reference_point"].values - reference_point).max() > 1e-9:
            return None
        factor = water_density / float(data["water_density"])
        names = (str(name) for name in data.data_vars if str(name).startswith(_PREFIX))
        arrays = {name.removeprefix(_PREFIX): data[name].values for name in names}
    fit = RadiationStateSpace.of_arrays(arrays)
    return replace(
        fit, B=np.sqrt(factor) * fit.B, added_mass_infinite=factor * fit.added_mass_infinite
    )
