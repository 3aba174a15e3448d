"""Gains for a turbine: how its power answers to pitch, and what follows for the controller.

The sensitivity of power to pitch is asked of any steady rotor, rigid or flexible, with the
wake that follows the pitch or with the one that was there before (the NREL 5 MW report
freezes it: NREL/TP-500-38060, section 7.3).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import (
    PITCH_TOLERANCE,
    SteadyRotor,
    efficiency,
    minimum_pitch,
)
from galerna.aero.bem.surface import performance_surface
from galerna.contract import Array
from galerna.control.pitch import PitchGains
from galerna.control.torque import AboveRated
from galerna.control.tuning import (
    DAMPING_RATIO,
    NATURAL_FREQUENCY,
    Sensitivity,
    closed_loop,
    pitch_gains,
)
from galerna.errors import ConvergenceError, InputError
from galerna.turbine.model import Turbine
from galerna.turbine.summary import rotor_inertia
from galerna.units import AIR_DENSITY, DEG

Wake = Literal["frozen", "following"]

FLOATING_FREQUENCY = 0.2  #: rad/s: below the platform's pitch mode (NREL/TP-500-47535)
POINTS = 12  #: wind speeds of a schedule
PITCH_STEP = 0.5 * DEG  #: each way, of the derivative
LARGEST_STEP = 4.0 * DEG  #: of the search for rated power
TIP_SPEED_RATIOS = np.linspace(3.0, 15.0, 241)


class Rotor(Protocol):
    """A rotor in steady operation: ``at`` gives its "rotor_power" W among other quantities."""

    def at(
        self,
        wind_speed: float,
        rotor_speed: float,
        pitch: float,
        wake_pitch: float | None = None,
    ) -> dict[str, Array]: ...


@dataclass(frozen=True, eq=False)
class Tuning:
    """Gains, what they were computed from, and what they are to give.

    ``inertia`` kg m2 of rotor and generator at the rotor; ``optimal_mode_gain`` N m s2 at the
    generator.
    """

    turbine: str
    gains: PitchGains
    sensitivity: Sensitivity
    inertia: float
    gear_ratio: float
    above_rated: AboveRated
    natural_frequency: float
    damping_ratio: float
    optimal_mode_gain: float

    def closed_loop(self) -> tuple[Array, Array]:
        """Natural frequency (n,) rad/s and damping ratio (n,) that the gains give."""
        return closed_loop(
            self.gains, self.sensitivity, self.inertia, self.gear_ratio, self.above_rated
        )


def tuned_gains(
    turbine: Turbine,
    *,
    natural_frequency: float | None = None,
    damping_ratio: float = DAMPING_RATIO,
    above_rated: AboveRated = "constant_power",
    floating: bool | None = None,
    wake: Wake = "frozen",
    wind_speeds: ArrayLike | None = None,
    rotor: Rotor | None = None,
    air_density: float = AIR_DENSITY,
    options: BemOptions | None = None,
) -> Tuning:
    """Pitch gains of a turbine from its blades, inertia and rating.

    ``natural_frequency`` rad/s is 0.6 on land and 0.2 for a turbine that floats, which is one
    with a platform if ``floating`` does not say. ``rotor`` is the rigid one by blade-element
    momentum theory if not given. Raises InputError where the turbine lacks the data.
    """
    control = turbine.control
    if not (control.rated_power > 0.0 and control.rated_rotor_speed > 0.0):
        raise InputError(turbine.name, "has no rated power and speed", "give them in its control")
    if natural_frequency is None:
        floats = turbine.platform is not None if floating is None else floating
        natural_frequency = FLOATING_FREQUENCY if floats else NATURAL_FREQUENCY
    rotor = rotor or SteadyRotor(turbine, options, air_density)
    sensitivity = power_sensitivity(turbine, rotor, wind_speeds, wake)
    inertia, ratio = drive_inertia(turbine), turbine.drivetrain.gear_ratio
    gains = pitch_gains(
        sensitivity,
        inertia,
        ratio,
        natural_frequency=natural_frequency,
        damping_ratio=damping_ratio,
        above_rated=above_rated,
    )
    return Tuning(
        turbine.name,
        gains,
        sensitivity,
        inertia,
        ratio,
        above_rated,
        natural_frequency,
        damping_ratio,
        optimal_mode_gain(turbine, air_density, options),
    )


def power_sensitivity(
    turbine: Turbine, rotor: Rotor, wind_speeds: ArrayLike | None = None, wake: Wake = "frozen"
) -> Sensitivity:
    """How the power of a rotor at rated speed answers to pitch, where its power is rated.

    ``wind_speeds`` (n,) m/s are by default from the rated one to cut-out. Raises InputError
    for winds that do not bring rated power.
    """
    speed = turbine.control.rated_rotor_speed
    if wind_speeds is None:
        first = rated_wind_speed(turbine, rotor)
        last = max(turbine.control.cut_out_wind_speed, first + 1.0)
        wind_speeds = np.linspace(first, last, POINTS)
    winds = np.atleast_1d(np.asarray(wind_speeds, dtype=float))
    pitches: list[float] = []
    for wind in winds:
        start = pitches[-1] if pitches else None
        pitches.append(rated_pitch(turbine, rotor, float(wind), start))
    rows = [
        _power_and_slope(rotor, wind, speed, p, wake)
        for wind, p in zip(winds, pitches, strict=True)
    ]
    power, slope = np.array(rows).T
    return Sensitivity(winds, np.array(pitches), power, slope, speed)


def rated_power_of_rotor(turbine: Turbine) -> float:
    """Aerodynamic power W that gives the rated electrical one."""
    return turbine.control.rated_power / efficiency(turbine)


def rated_wind_speed(turbine: Turbine, rotor: Rotor) -> float:
    """Wind speed m/s that first gives rated power at rated speed.

    Raises InputError where none up to cut-out does.
    """
    wanted, control = rated_power_of_rotor(turbine), turbine.control

    def excess(wind: float) -> float:
        pitch = minimum_pitch(turbine, wind)
        return float(rotor.at(wind, control.rated_rotor_speed, pitch)["rotor_power"]) / wanted - 1.0

    low, high = control.cut_in_wind_speed, control.cut_out_wind_speed
    for wind in np.arange(low, high + 1.0, 1.0):
        if excess(float(wind)) > 0.0:
            return float(brentq(excess, max(wind - 1.0, 0.5 * low), wind, xtol=1e-4))
    raise InputError(turbine.name, f"does not reach rated power up to {high:g} m/s")


def rated_pitch(
    turbine: Turbine, rotor: Rotor, wind_speed: float, start: float | None = None
) -> float:
    """The pitch rad at which a rotor at rated speed gives rated power, from ``start`` up.

    Raises InputError where the wind is too weak for it, ConvergenceError where no pitch does it.
    """
    wanted, control = rated_power_of_rotor(turbine), turbine.control

    def excess(pitch: float) -> float:
        power = rotor.at(wind_speed, control.rated_rotor_speed, pitch)["rotor_power"]
        return float(power) / wanted - 1.0

    low = minimum_pitch(turbine, wind_speed) if start is None else start
    value = excess(low)
    if value <= 0.0:
        if value > -1e-3:
            return low
        raise InputError(
            f"{turbine.name} at {wind_speed:.4g} m/s", "the wind does not bring rated power"
        )
    step = 0.25 * DEG
    while excess(low + step) > 0.0:
        low, step = low + step, min(2.0 * step, LARGEST_STEP)
        if low > control.maximum_pitch:
            where = f"{turbine.name} at {wind_speed:.4g} m/s"
            raise ConvergenceError(where, "no pitch angle brings the power down to rated")
    return float(brentq(excess, low, low + step, xtol=PITCH_TOLERANCE))


def _power_and_slope(
    rotor: Rotor, wind: float, speed: float, pitch: float, wake: Wake
) -> tuple[float, float]:
    """Power W and its derivative W/rad, by central differences."""
    held = pitch if wake == "frozen" else None
    less, more = (
        float(rotor.at(wind, speed, pitch + sign * PITCH_STEP, held)["rotor_power"])
        for sign in (-1.0, 1.0)
    )
    power = float(rotor.at(wind, speed, pitch)["rotor_power"])
    return power, (more - less) / (2.0 * PITCH_STEP)


def drive_inertia(turbine: Turbine) -> float:
    """Inertia kg m2 of rotor and generator about the low-speed shaft.

    Raises InputError where the turbine gives no masses of its blades.
    """
    rotor = rotor_inertia(turbine)
    if rotor is None:
        raise InputError(turbine.name, "has no blade masses", "gains need the rotor's inertia")
    return rotor + turbine.drivetrain.generator_inertia * turbine.drivetrain.gear_ratio**2


def optimal_mode_gain(
    turbine: Turbine, air_density: float = AIR_DENSITY, options: BemOptions | None = None
) -> float:
    """K N m s2 of torque = K speed^2 at the generator that holds the best tip-speed ratio.

    Half rho pi R^5 C_P,max / (lambda^3 G^3) (dissertation eq. 2.125, where C_P,max is missing),
    less what the gearbox takes.
    """
    fine = [turbine.control.fine_pitch]
    surface = performance_surface(turbine, TIP_SPEED_RATIOS, fine, options=options)
    coefficient = surface["power_coefficient"].values[:, 0]
    best = int(coefficient.argmax())
    drivetrain, radius = turbine.drivetrain, turbine.rotor_radius
    torque = 0.5 * air_density * np.pi * radius**5 * coefficient[best] / TIP_SPEED_RATIOS[best] ** 3
    return float(torque * drivetrain.gearbox_efficiency / drivetrain.gear_ratio**3)


def doubling_fit(sensitivity: Sensitivity) -> tuple[float, float]:
    """Sensitivity W/rad at zero pitch and the pitch rad at which it doubles.

    By a straight line through all points, as in NREL/TP-500-38060, figure 7-5.
    """
    slope, at_zero = np.polyfit(sensitivity.pitch, sensitivity.power_by_pitch, 1)
    return float(at_zero), float(at_zero / slope)
