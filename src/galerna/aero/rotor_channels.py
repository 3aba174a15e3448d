"""What every aerodynamic model of a rotor shows: its channels by name, and its coefficients."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array, Channel
from galerna.units import DEG

CALM = 1e-3  #: m/s of wind, below which a ratio to it means nothing

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


def strip_channel(
    name: str, unit: str, text: str, openfast: str = "", other: str = "", scale: float = 1.0
) -> Channel:
    """A channel along the blades, with OpenFAST's name, unit and scale where it has one."""
    return Channel(name, unit, text, _ALONG, _NODE + openfast if openfast else "", other, scale)


STRIP_CHANNELS = (
    strip_channel("angle_of_attack", "rad", "angle of attack", "Alpha", "deg", 1.0 / DEG),
    strip_channel(
        "inflow_angle", "rad", "inflow angle to the rotor plane", "Phi", "deg", 1.0 / DEG
    ),
    strip_channel("relative_speed", "m/s", "relative speed in the section's plane", "VRel", "m/s"),
    strip_channel("lift_coefficient", "1", "lift coefficient", "Cl", "-"),
    strip_channel("drag_coefficient", "1", "drag coefficient", "Cd", "-"),
    strip_channel("moment_coefficient", "1", "moment coefficient", "Cm", "-"),
    strip_channel("normal_force", "N/m", "force per length across the rotor plane", "Fx", "N/m"),
    strip_channel(
        "tangential_force", "N/m", "driving force per length in the rotor plane", "Fy", "N/m"
    ),
    strip_channel("axial_induction", "1", "axial induction", "AxInd", "-"),
    strip_channel("tangential_induction", "1", "tangential induction", "TnInd", "-"),
)


def rotor_values(
    air_density: float,
    radius: float,
    wind: float,
    rotor_speed: float,
    thrust: float,
    torque: float,
    induced: float,
) -> dict[str, float | Array]:
    """The values of ROTOR_CHANNELS, in SI; ``wind`` and ``induced`` m/s are means over the disc."""
    calm = abs(wind) < CALM
    scale = 0.0 if calm else 1.0 / (0.5 * air_density * np.pi * radius**2 * wind**2)
    return {
        "rotor_thrust": thrust,
        "rotor_torque": torque,
        "rotor_power": torque * rotor_speed,
        "thrust_coefficient": thrust * scale,
        "power_coefficient": 0.0 if calm else torque * rotor_speed * scale / wind,
        "tip_speed_ratio": 0.0 if calm else rotor_speed * radius / wind,
        "rotor_wind_speed": wind,
        "rotor_axial_induction": 0.0 if calm else induced / wind,
    }
