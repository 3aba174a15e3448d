"""Turbulence boxes as HAWC2 and the Mann generators exchange them, read and written.

Three files of float32 without a header, one per component, with z fastest and rising,
then y, then x. x points downwind, so the last plane of the file arrives first (older
readers took the first one first). y rises to the left looking downwind, where v is
positive, as in DTU's hipersim: so read, a Mann box is free of divergence. InflowWind
takes the first row of the file to be the left one; ``first_row="left"`` reads so too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.inflow.storage import check_size, open_binary

FirstRow = Literal["left", "right"]


def read_hawc2(
    paths: Sequence[Path | str],
    shape: tuple[int, int, int],
    spacing: tuple[float, float, float],
    *,
    mean_speed: float,
    hub_height: float,
    first_row: FirstRow = "right",
) -> Box:
    """The fluctuations of the files u, v, w with (nx, ny, nz) points, (dx, dy, dz) m apart.

    The box repeats along x, as the Mann generators make it, and is centred on the hub.
    Raises InputError if a file cannot be read or has not the size that the shape needs;
    the sizes are looked at before any memory is taken.
    """
    if len(paths) != 3:
        raise InputError("HAWC2 box", f"{len(paths)} files, expected three: u, v and w")
    if min(shape) < 2:
        what = f"shape {shape}, expected 2 points or more each way"
        raise InputError(str(paths[0]), what)
    for path in paths:
        with open_binary(path):
            check_size(path, 4 * math.prod(shape), f"a box of {shape} points holds float32 numbers")
    across = slice(None, None, -1) if first_row == "left" else slice(None)
    data = np.empty((3, *shape), dtype=np.float32)
    for component, path in zip(data, paths, strict=True):
        with open_binary(path) as file:
            component[:] = np.fromfile(file, dtype="<f4").reshape(shape)[::-1, across]
    return Box(data, spacing, mean_speed, hub_height, source=str(paths[0]))


def write_hawc2(
    stem: Path | str, box: Box, first_row: FirstRow = "right"
) -> tuple[Path, Path, Path]:
    """Write STEM_u.bin, STEM_v.bin and STEM_w.bin and answer their paths.

    Raises InputError if the box holds the mean wind, or a file cannot be written.
    """
    if box.holds_mean:
        what = "holds the mean wind, which a HAWC2 box leaves out"
        raise InputError(box.source, what, "write box.fluctuations()")
    across = slice(None, None, -1) if first_row == "left" else slice(None)
    u, v, w = (Path(f"{stem}_{name}.bin") for name in "uvw")
    for component, path in zip(box.data, (u, v, w), strict=True):
        with open_binary(path, "wb") as file:
            np.ascontiguousarray(component[::-1, across], dtype="<f4").tofile(file)
    return u, v, w
