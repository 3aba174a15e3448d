"""What the blade-element momentum model shows: its channels and how they are filled."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2

import numpy as np
from numba import njit

from galerna.aero.bem import rotor as r
from galerna.aero.bem import strips as s
from galerna.contract import Array, Channel
from galerna.units import DEG

_ALONG = ("blade", "radius")
_NODE = "AB{blade}N{node:03d}"

ROTOR_CHANNELS = (
    Channel("rotor_thrust", "N", "aerodynamic thrust along the shaft", (), "RtAeroFxh", "N"),
    Channel("rotor_torque", "N m", "aerodynamic torque about the shaft", (), "RtAeroMxh", "N-m"),
    Channel("rotor_power", "W", "aerodynamic power", (), "RtAeroPwr", "W"),
    Channel("thrust_coefficient", "1", "thrust coefficient", (), "RtAeroCt", "-"),
    Channel("power_coefficient", "1", "power coefficient", (), "RtAeroCp", "-"),
    Channel("tip_speed_ratio", "1", "tip-speed ratio", (), "RtTSR", "-"),
    Channel(
        "rotor_wind_speed", "m/s", "wind along the shaft, mean over the disc", (), "RtVAvgxh", "m/s"
    ),
    Channel("rotor_axial_induction", "1", "axial induction, mean over the disc"),
)
# Without OpenFAST's names: its B1AeroMx and B1AeroMy are about axes that pitch with the blade.
BLADE_CHANNELS = (
    Channel(
        "aerodynamic_root_in_plane_moment",
        "N m",
        "aerodynamic in-plane moment at the blade root",
        ("blade",),
    ),
    Channel(
        "aerodynamic_root_out_of_plane_moment",
        "N m",
        "aerodynamic out-of-plane moment at the blade root",
        ("blade",),
    ),
)


def _strip(
    name: str, unit: str, text: str, openfast: str, other: str, scale: float = 1.0
) -> Channel:
    return Channel(name, unit, text, _ALONG, _NODE + openfast, other, scale)


STRIP_CHANNELS = (
    _strip("angle_of_attack", "rad", "angle of attack", "Alpha", "deg", 1.0 / DEG),
    _strip("inflow_angle", "rad", "inflow angle to the rotor plane", "Phi", "deg", 1.0 / DEG),
    _strip("relative_speed", "m/s", "relative speed in the section's plane", "VRel", "m/s"),
    _strip("lift_coefficient", "1", "lift coefficient", "Cl", "-"),
    _strip("drag_coefficient", "1", "drag coefficient", "Cd", "-"),
    _strip("moment_coefficient", "1", "moment coefficient", "Cm", "-"),
    _strip("normal_force", "N/m", "force per length across the rotor plane", "Fx", "N/m"),
    _strip("tangential_force", "N/m", "driving force per length in the rotor plane", "Fy", "N/m"),
    _strip("axial_induction", "1", "axial induction", "AxInd", "-"),
    _strip("tangential_induction", "1", "tangential induction", "TnInd", "-"),
)
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
    return induced / undisturbed if abs(undisturbed) > 1e-3 else 0.0


def record(rotor: r.Rotor, strips: Array, totals: Array) -> Mapping[str, float | Array]:
    """Every channel's value from the strip table (m,31) and the totals of one evaluation."""
    blades = rotor.blades
    along = np.empty((len(STRIP_NAMES), blades, rotor.strips_per_blade))
    _fill(strips, along.reshape(len(along), -1))
    values: dict[str, float | Array] = dict(zip(STRIP_NAMES, along, strict=True))
    root = totals[r.ROOT_MOMENTS :].reshape(blades, 2).copy()
    values["aerodynamic_root_in_plane_moment"] = root[:, 0]
    values["aerodynamic_root_out_of_plane_moment"] = root[:, 1]
    values.update(_rotor_values(rotor, totals.tolist()))
    return values


def _rotor_values(rotor: r.Rotor, totals: list[float]) -> dict[str, float | Array]:
    wind, speed, thrust, torque = (
        totals[r.MEAN_WIND],
        totals[r.ROTOR_SPEED],
        totals[r.THRUST],
        totals[r.TORQUE],
    )
    calm = abs(wind) < 1e-3  # coefficients mean nothing without wind
    scale = 0.0 if calm else 1.0 / (0.5 * rotor.air_density * np.pi * rotor.radius**2 * wind**2)
    return {
        "rotor_thrust": thrust,
        "rotor_torque": torque,
        "rotor_power": torque * speed,
        "thrust_coefficient": thrust * scale,
        "power_coefficient": 0.0 if calm else torque * speed * scale / wind,
        "tip_speed_ratio": 0.0 if calm else speed * rotor.radius / wind,
        "rotor_wind_speed": wind,
        "rotor_axial_induction": 0.0 if calm else totals[r.MEAN_INDUCED] / wind,
    }
