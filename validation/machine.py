"""What the machine's validation cases share: short runs of cases, OpenFAST's figures and wind."""

from __future__ import annotations

import lzma
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray

import galerna
from galerna import examples
from galerna.contract import Array
from galerna.inflow.box import Box
from galerna.inflow.bts import write_bts

from .framework import NotRunError
from .rotors import DATA, table

BOX_STEPS = (0.1, 0.2, 0.2)  #: m/s between the numbers of the box's u, v and w
BOX_SHAPE = (3, 820, 28, 28)
BOX_SPACING = (4.5, 160.0 / 31.0, 160.0 / 31.0)  #: m

#: Mean, standard deviation and that of what repeats every turn, by OpenFAST's name of a channel
Reference = dict[str, tuple[float, float, float]]
HARMONICS = (1, 2, 3)  #: of the azimuth, in what repeats every turn


def simulate(**blocks: Any) -> xarray.Dataset:
    """Run a case of these blocks; the version of the format is added."""
    return galerna.run({"galerna": 1, **blocks})


def late(result: xarray.Dataset, start: float, end: float = np.inf) -> xarray.Dataset:
    """The records from ``start`` to ``end`` s."""
    return result.sel(time=slice(start, end))


def in_openfast_units(result: xarray.Dataset, name: str) -> Array:
    """A channel over time by its name in OpenFAST, in its unit; that of blade 1 has a 1 in it."""
    for variable in result.data_vars.values():
        pattern = variable.attrs.get("openfast", "")
        if not pattern or pattern.format(blade=1, node=1) != name:
            continue
        first = {dim: 0 for dim in variable.dims if dim != "time"}
        return np.asarray(variable.isel(first)) * float(variable.attrs["openfast_scale"])
    raise KeyError(f"no channel of the result is OpenFAST's {name}")


def openfast_land(code: str, case: str) -> Reference:
    """OpenFAST's figures of a case: ``code`` is ``ed`` or ``bd``."""
    return {
        row["channel"]: (float(row["mean"]), float(row["std"]), float(row["periodic"] or np.nan))
        for row in table("machine/openfast_land.csv")
        if (row["code"], row["case"]) == (code, case)
    }


def over_whole_turns(values: Array, azimuth: Array) -> tuple[float, float]:
    """Mean, and the standard deviation of what repeats every turn, of a channel at azimuths rad.

    Both of a least-squares fit of the azimuth's first harmonics: no part of a turn counts twice.
    """
    columns = [f(n * azimuth) for n in HARMONICS for f in (np.cos, np.sin)]
    design = np.column_stack([np.ones(len(azimuth)), *columns])
    fitted = np.linalg.lstsq(design, values, rcond=None)[0]
    return float(fitted[0]), float(np.sqrt(0.5 * np.sum(fitted[1:] ** 2)))


def write_wind_of_openfast(folder: Path) -> Path:
    """The turbulent wind of the OpenFAST runs as a file for a case, 205 s of it.

    TurbSim's box for IEC class B at 18 m/s (Kaimal, 32 x 32 points over 160 m, 0.25 s), cut to
    the rotor and rounded to 0.1 m/s in u and 0.2 m/s in v and w.
    """
    planes = np.frombuffer(lzma.decompress((DATA / "machine/kaimal18.xz").read_bytes()), np.uint8)
    differences = planes.reshape(2, -1).T.copy().view("<i2").reshape(BOX_SHAPE)
    numbers = np.cumsum(differences, axis=1, dtype=np.int32)
    velocity = numbers * np.array(BOX_STEPS)[:, None, None, None]
    box = Box(velocity.astype(np.float32), BOX_SPACING, 18.0, 90.0, holds_mean=True)
    path = folder / "kaimal18.bts"
    write_bts(path, box)
    return path


def rosco_input() -> Path:
    """ROSCO's own input for the NREL 5 MW; NotRunError where its library is not installed."""
    if find_spec("rosco") is None:
        raise NotRunError("needs ROSCO's library: pip install --no-deps rosco")
    return examples.folder() / "rosco_nrel5mw" / "DISCON.IN"
