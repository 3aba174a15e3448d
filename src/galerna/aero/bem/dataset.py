"""Steady results as labelled arrays with units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from galerna.aero.bem.channels import STRIP_CHANNELS

if TYPE_CHECKING:
    import xarray

UNITS = {
    "power": ("W", "aerodynamic power"),
    "thrust": ("N", "aerodynamic thrust along the shaft"),
    "torque": ("N m", "aerodynamic torque about the shaft"),
    "power_coefficient": ("1", "power coefficient"),
    "thrust_coefficient": ("1", "thrust coefficient"),
    "torque_coefficient": ("1", "torque coefficient"),
    "tip_speed_ratio": ("1", "tip-speed ratio"),
    "pitch": ("rad", "blade pitch angle"),
    "rotor_speed": ("rad/s", "rotor speed"),
    "wind_speed": ("m/s", "wind speed"),
    "electrical_power": ("W", "electrical power"),
    "radius": ("m", "distance from the shaft along the blade"),
    "c_in": ("1/m", "in-plane force per length over the rotor's dynamic force"),
    "c_out": ("1/m", "out-of-plane force per length over the rotor's dynamic force"),
    **{channel.name: (channel.unit, channel.long_name) for channel in STRIP_CHANNELS},
}


def dataset(variables: Mapping[str, Any], coordinates: Mapping[str, Any]) -> xarray.Dataset:
    """A dataset whose variables and coordinates carry ``units`` and ``long_name``."""
    import xarray

    result = xarray.Dataset(dict(variables), coords=dict(coordinates))
    for name in result.variables:
        unit, text = UNITS[str(name)]
        result[name].attrs.update(units=unit, long_name=text)
    return result
