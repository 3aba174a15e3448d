"""What the blade-element momentum model shows: its channels and how they are filled."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2

import numpy as np
from numba import njit

from galerna.aero.bem import rotor as r
from galerna.aero.bem import strips as s
from galerna.aero.rotor_channels import (
    BLADE_CHANNELS,
    CALM,
    ROTOR_CHANNELS,
    STRIP_CHANNELS,
    rotor_values,
)
from galerna.contract import Array

CHANNELS = ROTOR_CHANNELS + BLADE_CHANNELS + STRIP_CHANNELS
STRIP_NAMES = tuple(channel.name for channel in STRIP_CHANNELS)


@njit(cache=True, error_model="numpy")
def _fill(strips: Array, out: Array) -> None:
    """Copy the strips' columns into ``out`` (channels, m) in the order of STRIP_CHANNELS."""
    for i in range(strips.shape[0]):
        strip = strips[i]
        out[0, i], out[1, i] = strip[s.ANGLE_OF_ATTACK], atan2(strip[s.ACROSS], strip[s.ALONG])
        out[2, i] = strip[s.SPEED]
        out[3, i], out[4, i], out[5, i] = strip[s.LIFT], strip[s.DRAG], strip[s.MOMENT]
        out[6, i], out[7, i] = strip[s.NORMAL_FORCE], strip[s.TANGENTIAL_FORCE]
        out[8, i] = _ratio(strip[s.INDUCED_NORMAL], strip[s.NORMAL_WIND])
        out[9, i] = _ratio(strip[s.INDUCED_SWIRL], strip[s.TANGENTIAL_WIND])


@njit(cache=True, error_model="numpy")
def _ratio(induced: float, undisturbed: float) -> float:
    return induced / undisturbed if abs(undisturbed) > CALM else 0.0


def record(rotor: r.Rotor, strips: Array, totals: Array) -> Mapping[str, float | Array]:
    """Every channel's value from the strip table (m,31) and the totals of one evaluation."""
    blades = rotor.blades
    along = np.empty((len(STRIP_NAMES), blades, rotor.strips_per_blade))
    _fill(strips, along.reshape(len(along), -1))
    values: dict[str, float | Array] = dict(zip(STRIP_NAMES, along, strict=True))
    root = totals[r.ROOT_MOMENTS :].reshape(blades, 2).copy()
    values["aerodynamic_root_in_plane_moment"] = root[:, 0]
    values["aerodynamic_root_out_of_plane_moment"] = root[:, 1]
    wind, speed = float(totals[r.MEAN_WIND]), float(totals[r.ROTOR_SPEED])
    loads = float(totals[r.THRUST]), float(totals[r.TORQUE])
    induced = float(totals[r.MEAN_INDUCED])
    values.update(rotor_values(rotor.air_density, rotor.radius, wind, speed, *loads, induced))
    return values
