"""A platform's coefficients from whichever file holds them."""

from __future__ import annotations

from pathlib import Path

from galerna.errors import InputError
from galerna.hydro.database import HydroDatabase
from galerna.hydro.netcdf import read_netcdf
from galerna.hydro.wamit import read_wamit
from galerna.turbine.platform import Platform


def read_database(path: Path | str, platform: Platform) -> HydroDatabase:
    """Coefficients about the platform's reference point, symmetrised.

    From galerna's NetCDF, or WAMIT's NAME.1 with NAME.3 and NAME.hst beside it (not
    dimensional, ULEN 1 m, periods, body origin at still water on the tower's axis; volume and
    depth are the platform's). Raises InputError.
    """
    match Path(path).suffix:
        case ".nc":
            base = read_netcdf(path)
        case ".1" | ".3" | ".hst":
            if platform.displaced_volume <= 0.0 or platform.water_depth <= 0.0:
                raise InputError(
                    str(path),
                    "needs the platform's displaced volume and water depth, which WAMIT's files "
                    "do not hold",
                    "give platform.displaced_volume and platform.water_depth in the turbine's file",
                )
            base = read_wamit(
                path,
                displaced_volume=platform.displaced_volume,
                water_depth=platform.water_depth,
            )
        case suffix:
            raise InputError(
                str(path),
                f"ends with {suffix!r}; hydrodynamic coefficients are .nc (galerna hydro) or "
                "WAMIT's .1",
                "compute them: galerna hydro TURBINE",
            )
    return base.symmetrised().moved(platform.reference_point)
