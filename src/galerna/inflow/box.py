"""A turbulence box: a block of wind that the mean wind carries past the machine."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError

Block = NDArray[np.float32]

FASTEST_WIND = 500.0  #: m/s; faster than this is a damaged file


@dataclass(frozen=True, eq=False)
class Box:
    """Wind velocity on a regular grid, moved by Taylor's hypothesis.

    ``data`` (3,nx,ny,nz) float32 m/s holds u, v, w along the axes of the wind:
    downwind, to the left looking downwind, up. Plane ``i`` of the nx passes the
    tower axis at the time ``(i dx - lead) / mean_speed``: the planes stand in the
    order of their arrival, *against* the downwind axis. y rises to the left, z
    upwards. ``spacing`` (dx, dy, dz) m. The grid's centre stands on the tower axis,
    ``center_above_hub`` m above ``hub_height`` m.

    ``periodic`` boxes repeat along x for ever. One that is not needs a ``lead`` m,
    the wind that has passed at time 0, for points downwind of the tower. With
    ``holds_mean`` the data are the whole wind, else they are fluctuations about a
    mean given elsewhere. ``tower`` (3,nx,nt) float32 m/s continues the grid's
    middle down from its bottom, where its first row stands, with one row every dz.
    Raises InputError if a figure or a shape makes no sense.
    """

    data: Block
    spacing: tuple[float, float, float]
    mean_speed: float
    hub_height: float
    center_above_hub: float = 0.0
    periodic: bool = True
    lead: float = 0.0
    holds_mean: bool = False
    tower: Block | None = None
    source: str = "turbulence box"

    def __post_init__(self) -> None:
        self._check_numbers()
        self._check_blocks()

    def _check_numbers(self) -> None:
        for name, value in (
            *zip(("dx", "dy", "dz"), self.spacing, strict=True),
            ("mean speed", self.mean_speed),
        ):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(self.source, f"{name} is {value:g}, expected a positive number")
        for name, value in (
            ("hub height", self.hub_height),
            ("lead", self.lead),
            ("centre above hub", self.center_above_hub),
        ):
            if not math.isfinite(value):
                raise InputError(self.source, f"{name} is {value:g}, expected a finite number")

    def _check_blocks(self) -> None:
        if self.data.ndim != 4 or self.data.shape[0] != 3 or min(self.data.shape[1:]) < 2:
            raise InputError(
                self.source,
                f"velocities have shape {self.data.shape}, expected (3, nx, ny, nz) "
                "with at least 2 points each way",
            )
        if self.tower is not None and self.tower.shape[:2] != self.data.shape[:2]:
            raise InputError(
                self.source,
                f"tower rows have shape {self.tower.shape}, expected (3, {self.data.shape[1]}, n)",
            )
        for name in ("data", "tower"):
            block = getattr(self, name)
            if block is None:
                continue
            block = np.ascontiguousarray(block, dtype=np.float32)
            _check_speed(block, self.source)
            object.__setattr__(self, name, block)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of points (nx, ny, nz)."""
        nx, ny, nz = self.data.shape[1:]
        return nx, ny, nz

    @property
    def length(self) -> float:
        """Length m of wind that passes before the box repeats or ends."""
        nx = self.shape[0]
        return (nx if self.periodic else nx - 1) * self.spacing[0]

    @property
    def width(self) -> float:
        """Distance m between the outermost points in y."""
        return (self.shape[1] - 1) * self.spacing[1]

    @property
    def height(self) -> float:
        """Distance m between the lowest and the highest point of the grid."""
        return (self.shape[2] - 1) * self.spacing[2]

    @property
    def time_step(self) -> float:
        """Time s from one plane to the next."""
        return self.spacing[0] / self.mean_speed

    @property
    def time(self) -> Array:
        """Times (nx,) s at which the planes pass the tower axis."""
        return (
            np.arange(self.shape[0], dtype=np.float64) * self.time_step
            - self.lead / self.mean_speed
        )

    @property
    def y(self) -> Array:
        """Lateral positions (ny,) m, to the left looking downwind."""
        return np.arange(self.shape[1], dtype=np.float64) * self.spacing[1] - 0.5 * self.width

    @property
    def z(self) -> Array:
        """Heights (nz,) m above the ground or still water."""
        return np.arange(self.shape[2], dtype=np.float64) * self.spacing[2] + self.bottom

    @property
    def bottom(self) -> float:
        """Height m of the lowest row of the grid."""
        return self.hub_height + self.center_above_hub - 0.5 * self.height

    @property
    def top(self) -> float:
        """Height m of the highest row of the grid."""
        return self.bottom + self.height

    @property
    def lowest(self) -> float:
        """Lowest height m at which the box has wind: its bottom, or its last tower row."""
        rows = 0 if self.tower is None else max(self.tower.shape[2] - 1, 0)
        return self.bottom - rows * self.spacing[2]

    def missing(self, x: float, y: float, z: float, time: float) -> list[str]:
        """What the box lacks to hold a point m of the wind's axes at ``time`` s, per side."""
        half = 0.5 * self.width
        gaps = {
            "to the left": y - half,
            "to the right": -half - y,
            "above": z - self.top,
            "below": self.lowest - z,
        }
        lacks = [f"{gap:.3g} m are missing {side}" for side, gap in gaps.items() if gap > 0.0]
        if self.periodic:
            return lacks
        passed = self.mean_speed * time + self.lead - x
        gaps = {"before its start": -passed, "after its end": passed - self.length}
        return lacks + [
            f"{gap / self.mean_speed:.3g} s are missing {side}"
            for side, gap in gaps.items()
            if gap > 0.0
        ]

    def standing_on(self, bottom: float) -> Box:
        """The same box with its lowest row at the height ``bottom`` m."""
        return replace(self, center_above_hub=bottom + 0.5 * self.height - self.hub_height)

    def scaled(self, factor: float) -> Box:
        """The same fluctuations times ``factor``; InputError if the box holds the mean wind."""
        if self.holds_mean:
            raise InputError(
                self.source,
                "holds the mean wind too and cannot be scaled",
                "take the fluctuations first: box.fluctuations()",
            )
        tower = None if self.tower is None else self.tower * np.float32(factor)
        return replace(self, data=self.data * np.float32(factor), tower=tower)

    def fluctuations(self) -> Box:
        """The box without the mean over time of each component at each point."""
        if not self.holds_mean:
            return self
        tower = None if self.tower is None else _without_mean(self.tower)
        return replace(self, data=_without_mean(self.data), tower=tower, holds_mean=False)

    def mean_over_time(self) -> Box:
        """The mean of each component at each point, as a box that does not change."""
        tower = None if self.tower is None else _mean(self.tower)
        return replace(self, data=_mean(self.data), tower=tower, periodic=True)


def _check_speed(block: Block, source: str) -> None:
    """InputError if a velocity is not a number, or no wind on earth."""
    fastest = float(np.maximum(block.max(initial=0.0), -block.min(initial=0.0)))  # passes a NaN on
    if not math.isfinite(fastest):
        raise InputError(source, "holds velocities that are not finite numbers")
    if fastest > FASTEST_WIND:
        what = f"holds a wind of {fastest:g} m/s"
        raise InputError(source, what, "the file is damaged, or is not what it is taken for")


def _mean(block: Block) -> Block:
    """The mean over time, as two planes that are the same."""
    mean = block.mean(axis=1, keepdims=True, dtype=np.float64).astype(np.float32)
    return np.repeat(mean, 2, axis=1)


def _without_mean(block: Block) -> Block:
    return block - block.mean(axis=1, keepdims=True, dtype=np.float64).astype(np.float32)
