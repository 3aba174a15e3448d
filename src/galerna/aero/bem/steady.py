"""Steady tools on the blade-element momentum model: a point of operation, a power curve.

They work in shaft axes with the quasi-steady model, without tower and shear. Where the
wind is askew (tilt, yaw error) figures are means over the azimuth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from galerna.aero.bem.channels import STRIP_CHANNELS
from galerna.aero.bem.checks import require_turbine
from galerna.aero.bem.dataset import dataset
from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.surface import performance_surface
from galerna.aero.rigid_rotor import rigid_rotor_motion, wind_in_shaft_axes
from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY

if TYPE_CHECKING:
    import xarray

AZIMUTHS = 8  #: per sector of one blade, where the wind is askew
ASKEW = 1e-9  #: share of the wind in the rotor plane that counts as askew
PITCH_TOLERANCE = 1e-7  #: rad
AT_ONCE = 1e-9  #: s, in which no wake changes


@dataclass(frozen=True)
class UniformWind:
    """The same wind (3,) m/s everywhere and always."""

    wind: Array

    def velocity(self, points: Array, time: float) -> Array:
        return np.tile(self.wind, (len(points), 1))


class SteadyRotor:
    """A turbine's rotor that can be asked for points of operation.

    ``yaw_error`` rad is nacelle yaw minus wind direction.
    """

    def __init__(
        self,
        turbine: Turbine,
        options: BemOptions | None = None,
        air_density: float = AIR_DENSITY,
        yaw_error: float = 0.0,
    ) -> None:
        require_turbine(turbine)
        self.turbine, self.air_density, self.yaw_error = turbine, air_density, yaw_error
        self._model = BladeElementMomentum(
            turbine,
            UniformWind(np.zeros(3)),
            air_density=air_density,
            options=steady_options(options),
        )
        self._not_started = self._model.state()

    @property
    def radius(self) -> Array:
        """Stations (n,) m from the shaft along the blade."""
        return self._model.coordinates["radius"]

    def at(
        self,
        wind_speed: float,
        rotor_speed: float,
        pitch: float,
        wake_pitch: float | None = None,
    ) -> dict[str, Array]:
        """Channels of the model, means over the azimuth and the blades; SI and rad.

        With ``wake_pitch`` rad the induced velocities are those of that pitch angle: what the
        blades see at once after they have pitched from there, while the wake is still the old.
        """
        wind = wind_in_shaft_axes(self.turbine, wind_speed, self.yaw_error)
        self._model.inflow = UniformWind(wind)
        askew = np.hypot(wind[1], wind[2]) > ASKEW * np.linalg.norm(wind)
        sector = 2.0 * np.pi / self.turbine.number_of_blades
        azimuths = sector * np.arange(AZIMUTHS) / AZIMUTHS if askew else np.zeros(1)
        before = pitch if wake_pitch is None else wake_pitch
        records = [self._record(azimuth, rotor_speed, pitch, before) for azimuth in azimuths]
        means = {
            name: np.mean([np.asarray(record[name]) for record in records], axis=0)
            for name in records[0]
        }
        return {name: v.mean(axis=0) if v.ndim else v for name, v in means.items()}

    def _record(
        self, azimuth: float, rotor_speed: float, pitch: float, wake_pitch: float
    ) -> Mapping[str, float | Array]:
        model = self._model
        place = self.turbine, model.sections, azimuth, rotor_speed
        model.restore(self._not_started)
        model.begin_step(0.0, AT_ONCE, rigid_rotor_motion(*place, wake_pitch))
        motion = rigid_rotor_motion(*place, pitch)
        model.loads(AT_ONCE, motion)
        model.end_step(AT_ONCE, motion)
        return model.record()


def steady_options(options: BemOptions | None) -> BemOptions:
    """Options of a model without tower whose only memory is its wake."""
    return (options or BemOptions()).model_copy(
        update={
            "quasi_steady": False,
            "dynamic_inflow": "oye",
            "unsteady_airfoil": "none",
            "tower_influence": False,
        }
    )


def steady_rotor(
    turbine: Turbine,
    wind_speed: float,
    rotor_speed: float,
    pitch: float,
    *,
    yaw_error: float = 0.0,
    air_density: float = AIR_DENSITY,
    options: BemOptions | None = None,
) -> xarray.Dataset:
    """The rotor at one point of operation, m/s, rad/s and rad: integrals and spanwise loads.

    Spanwise variables have the dimension ``radius`` m; ``c_in`` and ``c_out`` 1/m are the
    in-plane and out-of-plane forces per length over 1/2 rho V^2 pi R^2 (dissertation eq.
    3.9), so their integrals over the blades are C_T and, times r Omega / V, C_P; all
    coefficients are with ``wind_speed``. Raises InputError.
    """
    rotor = SteadyRotor(turbine, options, air_density, yaw_error)
    point = rotor.at(wind_speed, rotor_speed, pitch)
    force = 0.5 * air_density * wind_speed**2 * np.pi * turbine.rotor_radius**2
    along = {channel.name: ("radius", point[channel.name]) for channel in STRIP_CHANNELS}
    along["c_out"] = ("radius", point["normal_force"] / force)
    along["c_in"] = ("radius", point["tangential_force"] / force)
    values = {name: ((), value) for name, value in _integrals(point, rotor, wind_speed).items()}
    operation = {
        "wind_speed": ((), wind_speed),
        "rotor_speed": ((), rotor_speed),
        "pitch": ((), pitch),
    }
    return dataset({**values, **operation, **along}, {"radius": rotor.radius})


def power_curve(
    turbine: Turbine,
    wind_speeds: ArrayLike | None = None,
    *,
    air_density: float = AIR_DENSITY,
    options: BemOptions | None = None,
) -> xarray.Dataset:
    """Steady operation over the wind speed (n,) m/s, by the turbine's own strategy.

    The rotor follows the optimal tip-speed ratio within its speed limits, at the fine pitch
    or, where there is one, at the pitch of the turbine's minimum pitch table, which also
    shaves the peak of the thrust. Where this gives more than rated power, the blades pitch
    towards feather until it is rated. ``power`` is aerodynamic, ``electrical_power`` is it
    times gearbox and generator efficiency, and it is the electrical one that is rated.
    Raises InputError, and ConvergenceError where no pitch gives rated power.
    """
    require_turbine(turbine)
    control = turbine.control
    if wind_speeds is None:
        wind_speeds = np.arange(control.cut_in_wind_speed, control.cut_out_wind_speed + 0.25, 0.5)
    rotor = SteadyRotor(turbine, options, air_density)
    winds = np.atleast_1d(np.asarray(wind_speeds, dtype=float))
    if not np.all(winds > 0.0):
        raise InputError("wind_speeds", "must be positive")
    ratio = control.optimal_tip_speed_ratio or optimal_tip_speed_ratio(turbine, options)
    rows = []
    for wind in winds:
        speed = strategy_speed(turbine, ratio, float(wind))
        pitch = _power_limited_pitch(rotor, float(wind), speed)
        integrals = _integrals(rotor.at(float(wind), speed, pitch), rotor, float(wind))
        rows.append({"rotor_speed": speed, "pitch": pitch, **integrals})
    columns = {name: ("wind_speed", np.array([row[name] for row in rows])) for name in rows[0]}
    electrical = efficiency(turbine) * columns["power"][1]
    return dataset(
        {**columns, "electrical_power": ("wind_speed", electrical)}, {"wind_speed": winds}
    )


def efficiency(turbine: Turbine) -> float:
    """Share of the rotor's power that reaches the grid."""
    return turbine.drivetrain.gearbox_efficiency * turbine.drivetrain.generator_efficiency


def strategy_speed(turbine: Turbine, tip_speed_ratio: float, wind_speed: float) -> float:
    """Rotor speed rad/s of a tip-speed ratio, within the turbine's limits of speed."""
    control = turbine.control
    wanted = tip_speed_ratio * wind_speed / turbine.rotor_radius
    return float(np.clip(wanted, control.minimum_rotor_speed, control.rated_rotor_speed))


def minimum_pitch(turbine: Turbine, wind_speed: float) -> float:
    """The pitch below rated power, rad: the fine pitch or the minimum pitch table's."""
    table = turbine.control.minimum_pitch_table
    if table is None:
        return turbine.control.fine_pitch
    return max(float(np.interp(wind_speed, table[:, 0], table[:, 1])), turbine.control.fine_pitch)


def optimal_tip_speed_ratio(turbine: Turbine, options: BemOptions | None = None) -> float:
    """The tip-speed ratio of the largest power coefficient at fine pitch."""
    ratios = np.linspace(3.0, 15.0, 121)
    surface = performance_surface(turbine, ratios, [turbine.control.fine_pitch], options=options)
    return float(ratios[int(surface["power_coefficient"].values[:, 0].argmax())])


def _power_limited_pitch(rotor: SteadyRotor, wind_speed: float, rotor_speed: float) -> float:
    turbine = rotor.turbine
    rated = turbine.control.rated_power / efficiency(turbine)
    fine = minimum_pitch(turbine, wind_speed)

    def excess(pitch: float) -> float:
        return float(rotor.at(wind_speed, rotor_speed, pitch)["rotor_power"]) / rated - 1.0

    if excess(fine) <= 0.0:
        return fine
    step, low = np.radians(2.0), fine
    while excess(low + step) > 0.0:
        low += step
        if low > turbine.control.maximum_pitch:
            where = f"power curve of {turbine.name!r} at {wind_speed:.4g} m/s"
            raise ConvergenceError(where, "no pitch angle brings the power down to rated")
    return float(brentq(excess, low, low + step, xtol=PITCH_TOLERANCE))


def _integrals(point: dict[str, Array], rotor: SteadyRotor, wind_speed: float) -> dict[str, float]:
    """Power, thrust and torque of a point with their coefficients on the wind speed."""
    radius = rotor.turbine.rotor_radius
    force = 0.5 * rotor.air_density * wind_speed**2 * np.pi * radius**2
    power, thrust, torque = (
        float(point[name]) for name in ("rotor_power", "rotor_thrust", "rotor_torque")
    )
    return {
        "power": power,
        "thrust": thrust,
        "torque": torque,
        "power_coefficient": power / (force * wind_speed),
        "thrust_coefficient": thrust / force,
        "torque_coefficient": torque / (force * radius),
    }
