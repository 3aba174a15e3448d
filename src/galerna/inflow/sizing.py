"""How large a turbulence box must be for a rotor, and whether one is."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.fft import next_fast_len

from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.turbine.model import Turbine

MARGIN_ON_LAND = 0.1  #: of the rotor radius, for flap, tilt and what is left of the last cell
MARGIN_AFLOAT = 0.25  #: of the rotor radius, for sway, heave and roll of the platform as well
SINGLE_PRECISION = 1e-6  #: relative; files hold spacings and heights as float32
SHORTEST_BOX = 600.0  #: s; a shorter one lacks the slow part of the spectrum


@dataclass(frozen=True)
class RotorExtent:
    """The space in which a machine asks for wind, lengths in m.

    ``reach`` is the largest distance of a blade tip from the tower axis at hub height,
    ``upstream`` how far the rotor stands before that axis, ``margin`` is kept free on
    every side, and ``lowest`` is the lowest height asked for (the tower's foot, less the
    margin where it floats).
    """

    hub_height: float
    radius: float
    reach: float
    upstream: float = 0.0
    margin: float = 0.0
    lowest: float = 0.0

    @classmethod
    def of(cls, turbine: Turbine, margin: float | None = None) -> RotorExtent:
        """Extent of a turbine; the margin depends on whether it floats unless given, m."""
        hub, tip = turbine.hub, turbine.blade.axis[-1]
        before_hub = math.sin(hub.cone) * (hub.radius + tip[2]) - math.cos(hub.cone) * tip[0]
        upstream = turbine.nacelle.overhang + max(0.0, float(before_hub))
        radius = turbine.rotor_radius
        if margin is None:
            margin = radius * (MARGIN_AFLOAT if turbine.platform else MARGIN_ON_LAND)
        foot = float(turbine.tower.axis[:, 2].min())
        lowest = max(0.0, foot - (margin if turbine.platform else 0.0))
        reach = math.hypot(radius, upstream)
        return cls(turbine.hub_height, radius, reach, upstream, margin, lowest)

    def with_margin(self, margin: float) -> RotorExtent:
        """The same extent with another margin, m."""
        return replace(self, margin=margin)

    @property
    def half_width(self) -> float:
        """Half the width m, and the height m above the hub, that a box needs."""
        return self.reach + self.margin


class BoxSize(NamedTuple):
    """Points and spacing m of a box, and the height m of its lowest row."""

    shape: tuple[int, int, int]
    spacing: tuple[float, float, float]
    bottom: float


def size_for(
    rotor: RotorExtent,
    duration: float,
    mean_speed: float,
    *,
    time_step: float = 0.1,
    points_across: int = 32,
) -> BoxSize:
    """A box for a rotor during ``duration`` s: as wide as needed, down to the tower's foot.

    ``time_step`` s is the time between two planes; ``points_across`` the points over the
    width, whose spacing holds for the height too. The box lasts 600 s at least, so that
    a shorter run meets the beginning of the same wind. Raises InputError unless the
    figures are positive.
    """
    figures = {"mean wind speed": mean_speed, "time step": time_step, "duration": duration}
    for name, value in figures.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError("turbulence box", f"{name} is {value:g}, expected more than 0")
    spacing = 2.0 * rotor.half_width / (points_across - 1)
    top = rotor.hub_height + rotor.half_width
    bottom = min(rotor.hub_height - rotor.half_width, rotor.lowest)
    rows = math.ceil((top - bottom) / spacing - 1e-9) + 1
    steps = max(duration, SHORTEST_BOX) / time_step + 2.0 * rotor.half_width / (
        mean_speed * time_step
    )
    planes = 2 * next_fast_len(math.ceil(steps / 2.0))
    return BoxSize(
        (planes, points_across, rows), (mean_speed * time_step, spacing, spacing), bottom
    )


def require_room(box: Box, rotor: RotorExtent, duration: float, held_below: bool) -> None:
    """InputError that names each side, and the time, by which a box is too small for a rotor."""
    half_width = rotor.half_width * (1.0 - SINGLE_PRECISION)
    top = rotor.hub_height + half_width
    bottom = min(rotor.hub_height - half_width, rotor.lowest + half_width * SINGLE_PRECISION)
    corners = [(-half_width, top, 0.0), (half_width, top, duration)]
    if not held_below:
        corners.append((0.0, bottom, 0.0))
    lacks: dict[str, None] = {}  # in order, each once
    for y, z, time in corners:
        x = -rotor.upstream if time > 0.0 else rotor.margin
        lacks |= dict.fromkeys(box.missing(x, y, z, time))
    if lacks:
        what = f"is too small for the rotor and its margin of {rotor.margin:.3g} m: "
        below = all(lack.endswith("below") for lack in lacks)
        hint = (
            "below_box: hold keeps the lowest row down to the ground"
            if below
            else "take a larger box, or a smaller margin_m"
        )
        raise InputError(box.source, what + "; ".join(lacks), hint)


def mean_deviation(box: Box) -> float:
    """Standard deviation m/s of u over time, the root of its mean variance over the grid."""
    rows = (np.var(box.data[0, :, j], axis=0, dtype=np.float64) for j in range(box.shape[1]))
    return float(np.sqrt(np.mean(list(rows))))
