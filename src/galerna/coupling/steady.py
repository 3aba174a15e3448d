"""The steady flexible rotor: how blades bend and twist in a steady wind, and what that costs.

Blades bend under the loads of blade-element momentum theory and under the rotation; tower and
shaft are rigid and nothing weighs, so that what remains over the azimuth is the tilt's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import UniformWind, efficiency
from galerna.aero.sections import strip_weights
from galerna.contract import Array
from galerna.coupling.equilibrium import SteadyMachine
from galerna.coupling.operating_point import general_strategy, operating_point
from galerna.errors import InputError
from galerna.structure import TurbineOptions
from galerna.structure.frames import log_so3, rotation_about
from galerna.structure.system import State
from galerna.structure.turbine import BLADE_ELEMENTS
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY

if TYPE_CHECKING:
    import xarray

Blades = Literal["flexible", "rigid"]

UNITS = {
    "wind_speed": ("m/s", "wind speed"),
    "radius": ("m", "distance from the shaft along the blade"),
    "rotor_speed": ("rad/s", "rotor speed"),
    "pitch": ("rad", "blade pitch angle"),
    "power": ("W", "aerodynamic power"),
    "electrical_power": ("W", "electrical power"),
    "thrust": ("N", "aerodynamic thrust along the shaft"),
    "torque": ("N m", "aerodynamic torque about the shaft"),
    "power_coefficient": ("1", "power coefficient"),
    "thrust_coefficient": ("1", "thrust coefficient"),
    "tip_out_of_plane": ("m", "tip deflection out of the rotor plane, downwind"),
    "tip_in_plane": ("m", "tip deflection in the rotor plane, with the rotation"),
    "tip_twist": ("rad", "elastic twist of the tip towards feather"),
    "root_out_of_plane_moment": ("N m", "moment of the out-of-plane forces about the root"),
    "root_in_plane_moment": ("N m", "moment of the in-plane forces about the root"),
    "c_out": ("1/m", "out-of-plane force per length over the rotor's dynamic force"),
    "c_in": ("1/m", "in-plane force per length over the rotor's dynamic force"),
    "out_of_plane": ("m", "deflection out of the rotor plane, downwind"),
    "in_plane": ("m", "deflection in the rotor plane, with the rotation"),
    "twist": ("rad", "elastic twist towards feather"),
}


@dataclass(frozen=True, eq=False)
class Deflection:
    """Of a blade's nodes (k,): out of plane and in plane m, twist towards feather rad."""

    out_of_plane: Array
    in_plane: Array
    twist: Array


class FlexibleRotor:
    """A rotor of flexible or rigid blades that can be asked for points of operation.

    ``torsion`` multiplies the torsional stiffness of the blades. It answers as
    ``aero.bem.steady.SteadyRotor`` does.
    """

    def __init__(
        self,
        turbine: Turbine,
        *,
        blades: Blades = "flexible",
        torsion: float = 1.0,
        air_density: float = AIR_DENSITY,
        options: BemOptions | None = None,
    ) -> None:
        if blades not in ("flexible", "rigid"):
            raise InputError("blades", f"{blades!r} is neither 'flexible' nor 'rigid'")
        self.turbine, self.air_density = stiffened(turbine, torsion), air_density
        self._machine = SteadyMachine(
            self.turbine,
            UniformWind(np.zeros(3)),
            TurbineOptions(
                blade_elements=BLADE_ELEMENTS if blades == "flexible" else 0,
                tower_elements=0,
                flexible_shaft=False,
                flexible_yaw=False,
                gravity=(0.0, 0.0, 0.0),
            ),
            air_density=air_density,
            aerodynamics=options,
            drag=False,
        )
        rotor = self._machine.rotor
        self.radius = rotor.coordinates["radius"]
        span = rotor.sections.span * turbine.blade.length
        self._weight, self._offset = strip_weights(span, turbine.blade.length)
        self._first = self._machine.system.initial_state()

    def at(
        self, wind_speed: float, rotor_speed: float, pitch: float, wake_pitch: float | None = None
    ) -> dict[str, Array]:
        """Channels of the aerodynamic model, means over azimuth and blades; SI and rad."""
        record = self._point(wind_speed, rotor_speed, pitch, wake_pitch)[0]
        means = {name: np.asarray(value) for name, value in record.items()}
        return {name: v.mean(axis=0) if v.ndim else v for name, v in means.items()}

    def torque(self, wind_speed: float, rotor_speed: float, pitch: float) -> float:
        """Aerodynamic torque N m about the shaft."""
        return float(self._point(wind_speed, rotor_speed, pitch)[0]["rotor_torque"])

    def deflected(
        self, wind_speed: float, rotor_speed: float, pitch: float
    ) -> tuple[dict[str, Array], Deflection]:
        """The channels, and the deflection of the blades' nodes, mean over azimuth and blades."""
        states = self._point(wind_speed, rotor_speed, pitch)[1]
        blades = range(1, self.turbine.number_of_blades + 1)
        all_of_them = [self._deflection(s, f"blade{b}", pitch) for s in states for b in blades]
        mean = Deflection(
            *(
                np.mean([getattr(d, name) for d in all_of_them], axis=0)
                for name in ("out_of_plane", "in_plane", "twist")
            )
        )
        return self.at(wind_speed, rotor_speed, pitch), mean

    def root_moment(self, force: Array) -> float:
        """Moment N m about the root of a force (n,) N/m along the undeflected blade."""
        lever = self.radius - self.turbine.hub.radius + self._offset
        return float(self._weight @ (force * lever))

    @property
    def node_radius(self) -> Array:
        """Distance (k,) m of a blade's nodes from the shaft along the blade."""
        span = self._machine.parts.span["blade1"]
        return self.turbine.hub.radius + span * self.turbine.blade.axis[-1, 2]

    def _point(
        self, wind_speed: float, rotor_speed: float, pitch: float, wake_pitch: float | None = None
    ) -> tuple[Mapping[str, Array], tuple[State, ...]]:
        blades = self.turbine.number_of_blades
        self._machine.rotor.inflow = UniformWind(np.array([wind_speed, 0.0, 0.0]))
        wake = None if wake_pitch is None else np.full(blades, wake_pitch)
        point = self._machine.at(rotor_speed, np.full(blades, pitch), wake)
        return point.record, point.states

    def _deflection(self, state: State, blade: str, pitch: float) -> Deflection:
        """Of one blade, against its own root, in the axes of the unpitched, coned blade."""
        nodes, axes = self._machine.parts.parts[blade], self._machine.parts.places[blade][1]
        first, root = self._first, nodes[0]
        R, R0 = state.rotation[root], first.rotation[root]
        arm = (state.position[nodes] - state.position[root]) @ R
        arm0 = (first.position[nodes] - first.position[root]) @ R0
        in_pitched = (arm - arm0) @ (axes.T @ R0).T
        x, y, _ = (in_pitched @ rotation_about(2, -pitch).T).T
        turned = [log_so3((R0.T @ first.rotation[n]).T @ (R.T @ state.rotation[n])) for n in nodes]
        return Deflection(x, -y, -np.array(turned)[:, 2])


def steady_flexible(
    turbine: Turbine,
    wind_speeds: ArrayLike,
    *,
    rotor_speed: ArrayLike | None = None,
    pitch: ArrayLike | None = None,
    blades: Blades = "flexible",
    torsion: float = 1.0,
    air_density: float = AIR_DENSITY,
    options: BemOptions | None = None,
) -> xarray.Dataset:
    """The rotor with flexible blades over the wind speed (n,) m/s.

    ``rotor_speed`` rad/s and ``pitch`` rad, one or (n,), are the turbine's strategy with these
    blades if not given: its tip-speed ratio and rated power. ``torsion`` multiplies the blades'
    torsional stiffness. Along ``radius`` stand ``c_out`` and ``c_in`` (dissertation eq. 3.9), from
    which the root moments are integrated, and the deflections. Raises InputError and
    ConvergenceError.
    """
    rotor = FlexibleRotor(
        turbine, blades=blades, torsion=torsion, air_density=air_density, options=options
    )
    winds = np.atleast_1d(np.asarray(wind_speeds, dtype=float))
    if not np.all(winds > 0.0):
        raise InputError("wind_speeds", "must be positive")
    speeds, pitches = (_each(value, len(winds)) for value in (rotor_speed, pitch))
    rows = []
    for wind, speed, angle in zip(winds, speeds, pitches, strict=True):
        if speed is None or angle is None:
            found = _strategy_point(rotor, float(wind))
            speed = found[0] if speed is None else speed
            angle = found[1] if angle is None else angle
        rows.append(_row(rotor, float(wind), speed, angle))
    return _dataset(rows, winds, rotor.radius)


def stiffened(turbine: Turbine, torsion: float) -> Turbine:
    """The turbine with the torsional stiffness of its blades multiplied."""
    sections = turbine.blade.structure
    if torsion == 1.0 or sections is None:
        return turbine
    if not torsion > 0.0:
        raise InputError("torsion", f"{torsion:g} is not a positive factor")
    factor = np.ones(6)
    factor[5] = np.sqrt(torsion)
    stiffness = sections.stiffness * np.outer(factor, factor)
    blade = replace(turbine.blade, structure=replace(sections, stiffness=stiffness))
    return replace(turbine, blade=blade)


def _strategy_point(rotor: FlexibleRotor, wind: float) -> tuple[float, float]:
    strategy = general_strategy(rotor.turbine, wind)
    point = operating_point(lambda speed, pitch: rotor.torque(wind, speed, pitch), strategy)
    return point.rotor_speed, point.pitch


def _each(value: ArrayLike | None, n: int) -> list[float | None]:
    if value is None:
        return [None] * n
    return [float(v) for v in np.broadcast_to(np.asarray(value, dtype=float), n)]


def _row(rotor: FlexibleRotor, wind: float, speed: float, pitch: float) -> dict[str, Array]:
    """Every variable at one point of operation."""
    record, deflection = rotor.deflected(wind, speed, pitch)
    turbine = rotor.turbine
    force = 0.5 * rotor.air_density * wind**2 * np.pi * turbine.rotor_radius**2
    power, thrust = float(record["rotor_power"]), float(record["rotor_thrust"])
    normal, tangential = record["normal_force"], record["tangential_force"]
    along = {
        name: np.interp(rotor.radius, rotor.node_radius, getattr(deflection, name))
        if len(rotor.node_radius) > 1
        else np.zeros_like(rotor.radius)
        for name in ("out_of_plane", "in_plane", "twist")
    }
    return {
        "rotor_speed": np.array(speed),
        "pitch": np.array(pitch),
        "power": np.array(power),
        "electrical_power": np.array(power * efficiency(turbine)),
        "thrust": np.array(thrust),
        "torque": record["rotor_torque"],
        "power_coefficient": np.array(power / (force * wind)),
        "thrust_coefficient": np.array(thrust / force),
        "tip_out_of_plane": deflection.out_of_plane[-1],
        "tip_in_plane": deflection.in_plane[-1],
        "tip_twist": deflection.twist[-1],
        "root_out_of_plane_moment": np.array(rotor.root_moment(normal)),
        "root_in_plane_moment": np.array(rotor.root_moment(tangential)),
        "c_out": normal / force,
        "c_in": tangential / force,
        **along,
    }


def _dataset(rows: list[dict[str, Array]], winds: Array, radius: Array) -> xarray.Dataset:
    import xarray

    columns = {}
    for name in rows[0]:
        values = np.array([row[name] for row in rows])
        dims = ("wind_speed",) if values.ndim == 1 else ("wind_speed", "radius")
        columns[name] = (dims, values)
    result = xarray.Dataset(columns, coords={"wind_speed": winds, "radius": radius})
    for variable in result.variables:
        unit, text = UNITS[str(variable)]
        result[variable].attrs.update(units=unit, long_name=text)
    return result
