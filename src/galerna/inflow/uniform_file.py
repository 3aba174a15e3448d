"""OpenFAST's uniform wind over time (.wnd, .hh), read.

Format: InflowWind manual, "uniform wind files". Its wind direction is positive towards
-y and is turned to galerna's sign here, with the horizontal shear that goes with it.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.inflow.mean import TimeSeries
from galerna.inflow.options import LARGEST_EXPONENT, LEAST_EXPONENT
from galerna.inflow.storage import open_binary
from galerna.units import DEG

COLUMNS = 8  #: time, speed, direction, vertical speed, three shears, gust; upflow may follow


def read_uniform(path: Path | str, reference_length: float) -> tuple[TimeSeries, float]:
    """The wind over time of a file, and its power-law exponent.

    ``reference_length`` m is what the file's linear shears stand on (RefLength in the
    InflowWind input, often the rotor's diameter). Raises InputError with the line for
    text that is not numbers, and if the exponent changes over time.
    """
    rows = _rows(path)
    time, speed, direction, vertical, across, exponent, linear, gust, upflow = rows.T
    if np.ptp(exponent) > 0.0:
        raise InputError(str(path), "the power-law exponent changes over time, which is not read")
    if not LEAST_EXPONENT <= exponent[0] <= LARGEST_EXPONENT:
        expected = f"expected {LEAST_EXPONENT:g} to {LARGEST_EXPONENT:g}"
        raise InputError(str(path), f"the power-law exponent is {exponent[0]:g}, {expected}")
    series = TimeSeries(
        time,
        source=str(path),
        speed=speed,
        direction=-direction * DEG,
        upflow=upflow * DEG,
        gust=gust,
        lateral_gradient=speed * across / reference_length,
        vertical_gradient=speed * linear / reference_length,
        vertical_speed=vertical,
    )
    return series, float(exponent[0])


def _check_row(row: list[float], where: str) -> None:
    if len(row) < COLUMNS:
        raise InputError(where, f"expected {COLUMNS} numbers, found {len(row)}")
    if not all(map(math.isfinite, row)):
        raise InputError(where, "holds values that are not finite numbers")
    if row[1] < 0.0:
        raise InputError(where, f"a wind speed of {row[1]:g} m/s, expected 0 or more")


def _rows(path: Path | str) -> Array:
    """Numbers (n,9) of the lines that are not comments; upflow is 0 where it is not given."""
    with open_binary(path) as file:
        lines = file.read().decode("utf-8", errors="replace").splitlines()
    rows: list[list[float]] = []
    for number, line in enumerate(lines, start=1):
        words = line.split("!")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            row = [float(word.lower().replace("d", "e")) for word in words[: COLUMNS + 1]]
        except ValueError:
            if rows:
                what = f"expected {COLUMNS} numbers, found {line.strip()[:60]!r}"
                raise InputError(f"{path}:{number}", what) from None
            continue  # a title before the first row
        _check_row(row, f"{path}:{number}")
        rows.append([*row, 0.0][: COLUMNS + 1])
    if not rows:
        raise InputError(str(path), "holds no row of numbers")
    if len(rows) == 1:  # one row is a steady wind
        rows.append([rows[0][0] + 1.0, *rows[0][1:]])
    return np.array(rows)
