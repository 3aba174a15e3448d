"""TurbSim's binary full-field wind (.bts), read and written.

Format: TurbSim User's Guide v2, appendix D (Jonkman, NREL, 2014). 16-bit numbers n
stand for the velocity (n - offset) / scale, one scale and offset per component.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.inflow.box import Block, Box
from galerna.inflow.kernels import relative_speed
from galerna.inflow.mean import Profile
from galerna.inflow.storage import check_size, finite, open_binary, positive

PLAIN, PERIODIC = 7, 8  #: identifiers of a file that does not, or does repeat in time
LOWEST, LEVELS = -32768, 65535
HEADER = struct.Struct("<h4i12fi")


class Header(NamedTuple):
    """The header as it stands in the file; lengths m, dt s, speed m/s."""

    identifier: int
    nz: int
    ny: int
    tower_rows: int
    nt: int
    dz: float
    dy: float
    dt: float
    hub_speed: float
    hub_height: float
    bottom: float
    scale_u: float
    offset_u: float
    scale_v: float
    offset_v: float
    scale_w: float
    offset_w: float
    text_length: int

    @property
    def scales(self) -> tuple[float, float, float]:
        return self.scale_u, self.scale_v, self.scale_w

    @property
    def offsets(self) -> tuple[float, float, float]:
        return self.offset_u, self.offset_v, self.offset_w

    @property
    def numbers_per_step(self) -> int:
        return 3 * (self.ny * self.nz + self.tower_rows)

    @property
    def file_size(self) -> int:
        """Bytes of the whole file that the header describes."""
        return HEADER.size + self.text_length + 2 * self.numbers_per_step * self.nt


def read_bts(path: Path | str) -> Box:
    """The whole wind of a .bts file, mean included, as it stands over the turbine.

    A file that is not periodic begins half its width early, so that every blade
    finds wind at time 0 (as InflowWind takes it). Raises InputError if the file
    cannot be read, is not one of TurbSim's, is cut short, or makes no sense; the
    header is held against the file's size before any memory is taken.
    """
    with open_binary(path) as file:
        header = _read_header(file, path)
        numbers = np.fromfile(file, dtype="<i2", count=header.numbers_per_step * header.nt)
    steps = numbers.reshape(header.nt, header.numbers_per_step)
    in_grid = 3 * header.ny * header.nz
    grid = steps[:, :in_grid].reshape(header.nt, header.nz, header.ny, 3)
    tower = steps[:, in_grid:].reshape(header.nt, header.tower_rows, 3)
    periodic = header.identifier == PERIODIC
    return Box(
        data=_velocities(grid.transpose(3, 0, 2, 1), header),
        spacing=(header.dt * header.hub_speed, header.dy, header.dz),
        mean_speed=header.hub_speed,
        hub_height=header.hub_height,
        center_above_hub=header.bottom + 0.5 * (header.nz - 1) * header.dz - header.hub_height,
        periodic=periodic,
        lead=0.0 if periodic else 0.5 * (header.ny - 1) * header.dy,
        holds_mean=True,
        tower=_velocities(tower.transpose(2, 0, 1), header) if header.tower_rows else None,
        source=str(path),
    )


def write_bts(path: Path | str, box: Box, profile: Profile | None = None) -> None:
    """Write a box, with the mean wind added by ``profile`` if it holds fluctuations only.

    The mean is uniform at the box's mean speed unless a profile is given. Raises
    InputError if the box holds the mean wind already, or the file cannot be written.
    """
    if box.holds_mean and profile is not None:
        raise InputError(box.source, "holds the mean wind already", "leave the profile out")
    nx, ny, nz = box.shape
    rows = 0 if box.tower is None else box.tower.shape[2]
    grid = np.empty((nx, nz, ny, 3), dtype="<i2")
    tower = np.empty((nx, rows, 3), dtype="<i2")
    coding: list[float] = []
    for c in range(3):
        on_grid, on_tower = _component(box, c, profile)
        scale, offset = _coding(on_grid, on_tower)
        grid[..., c] = _coded(on_grid, scale, offset).transpose(0, 2, 1)
        tower[..., c] = _coded(on_tower, scale, offset)
        coding += [scale, offset]
    numbers = np.concatenate([grid.reshape(nx, -1), tower.reshape(nx, -1)], axis=1)
    text = b"Turbulence box written by galerna."
    dx, dy, dz = box.spacing
    header = HEADER.pack(
        PERIODIC if box.periodic else PLAIN,
        *(nz, ny, rows, nx),
        *(dz, dy, dx / box.mean_speed),
        *(box.mean_speed, box.hub_height, box.bottom),
        *coding,
        len(text),
    )
    with open_binary(path, "wb") as file:
        file.write(header + text)
        numbers.tofile(file)


def _read_header(file: BinaryIO, path: Path | str) -> Header:
    packed = file.read(HEADER.size)
    if len(packed) < HEADER.size:
        what = f"is cut short: {len(packed)} bytes, the header alone has {HEADER.size}"
        raise InputError(str(path), what)
    header = Header(*HEADER.unpack(packed))
    if header.identifier not in (PLAIN, PERIODIC):
        what = f"starts with {header.identifier}, a TurbSim .bts file with {PLAIN} or {PERIODIC}"
        raise InputError(str(path), what)
    if min(header.nz, header.ny, header.nt) < 2 or min(header.tower_rows, header.text_length) < 0:
        what = (
            f"has {header.ny} x {header.nz} points, {header.tower_rows} tower points, "
            f"{header.nt} steps and {header.text_length} letters of text"
        )
        raise InputError(str(path), what, "two points each way and two steps are the least")
    positive(path, dz=header.dz, dy=header.dy, dt=header.dt, hub_speed=header.hub_speed)
    finite(path, hub_height=header.hub_height, bottom=header.bottom)
    for name, scale, offset in zip("uvw", header.scales, header.offsets, strict=True):
        positive(path, **{f"scale_{name}": abs(scale)})
        finite(path, **{f"offset_{name}": offset})
    check_size(path, header.file_size, "the simulation that wrote it may not have finished")
    file.seek(header.text_length, 1)
    return header


def _velocities(numbers: Array, header: Header) -> Block:
    """Velocities m/s of numbers, the components along the first axis of both."""
    velocities = np.empty(numbers.shape, dtype=np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        for c in range(3):
            velocities[c] = numbers[c]
            velocities[c] -= np.float32(header.offsets[c])
            velocities[c] /= np.float32(header.scales[c])
    return velocities


def _component(box: Box, c: int, profile: Profile | None) -> tuple[Array, Array]:
    """Component c of the whole wind on the grid (nx,ny,nz) and the tower (nx,nt), m/s."""
    tower = np.empty((box.shape[0], 0)) if box.tower is None else box.tower[c]
    if box.holds_mean or c > 0:
        return box.data[c], tower
    below = box.bottom - box.spacing[2] * np.arange(tower.shape[1])
    return box.data[c] + _mean(box, profile, box.z), tower + _mean(box, profile, below)


def _mean(box: Box, profile: Profile | None, height: Array) -> Array:
    profile = profile or Profile(box.hub_height)
    return np.array([box.mean_speed * relative_speed(profile, z) for z in height])


def _coding(*blocks: Array) -> tuple[float, float]:
    """Scale and offset, as float32 holds them, that spread the blocks over 16 bits."""
    low = min(float(block.min()) for block in blocks if block.size)
    high = max(float(block.max()) for block in blocks if block.size)
    scale = float(np.float32(LEVELS / (high - low))) if high > low else 1.0
    return scale, float(np.float32(LOWEST - scale * low))


def _coded(block: Array, scale: float, offset: float) -> Array:
    return np.clip(np.rint(block * scale + offset), LOWEST, LOWEST + LEVELS)
