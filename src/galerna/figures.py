"""Figures of a turbine that take a solver: its rated point and its first frequencies.

Keys are quantities of ``turbine.summary``, values are in the units of its table.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np
from scipy.optimize import brentq

from galerna.turbine.model import Blade, Tower, Turbine
from galerna.units import RPM

TIP_SPEED_RATIOS = np.linspace(3.0, 15.0, 241)
HIGHEST_WIND_SPEED = 30.0  #: m/s, for a turbine that states no cut-out
MODES = 14  #: as far as Table 9-1 of NREL/TP-500-38060 reaches, and one to spare
_FREQUENCY = "frequency_"
_Beam = TypeVar("_Beam", Blade, Tower)


def rated_point(turbine: Turbine) -> dict[str, float]:
    """Where the steady power curve first gives rated power, and the best power coefficient.

    The coefficient is the largest at fine pitch over the tip-speed ratio, with the wind along
    the shaft. Empty where rated power or speed is unknown; the coefficient alone where the
    rotor does not reach rated power before cut-out. Raises InputError.
    """
    control = turbine.control
    if not (control.rated_power > 0.0 and control.rated_rotor_speed > 0.0):
        return {}
    best = _best_coefficient(turbine)
    ratio = control.optimal_tip_speed_ratio or best["optimal_tip_speed_ratio"]
    return best | _first_at_rated_power(turbine, ratio)


def frequencies(turbine: Turbine) -> dict[str, float]:
    """Natural frequencies Hz of the parked machine, for a turbine of which some are published.

    Blade 1 points up, the rotor is locked behind its flexible shaft, and the machine stands
    in its weight and still air. Raises InputError and ConvergenceError.
    """
    published = any(figure.quantity.startswith(_FREQUENCY) for figure in turbine.published)
    if not published or turbine.blade.structure is None or turbine.tower.structure is None:
        return {}
    from galerna.structure.mode_names import name_modes
    from galerna.structure.modes import natural_modes
    from galerna.structure.statics import static_equilibrium
    from galerna.structure.turbine import TurbineOptions, turbine_system

    undamped = replace(turbine, blade=_undamped(turbine.blade), tower=_undamped(turbine.tower))
    model = turbine_system(undamped, TurbineOptions(rotor="locked"))
    state = static_equilibrium(model.system)
    modes = natural_modes(model.system, state, MODES)
    names = (
        _FREQUENCY + name.replace(" ", "_").replace("-", "_")
        for name in name_modes(model, state, modes)
    )
    return dict(zip(names, modes.frequency.tolist(), strict=True))


def _best_coefficient(turbine: Turbine) -> dict[str, float]:
    from galerna.aero.bem.steady import performance_surface

    surface = performance_surface(turbine, TIP_SPEED_RATIOS, [turbine.control.fine_pitch])
    coefficient = surface["power_coefficient"].values[:, 0]
    best = int(coefficient.argmax())
    return {
        "optimal_tip_speed_ratio": float(TIP_SPEED_RATIOS[best]),
        "peak_power_coefficient": float(coefficient[best]),
    }


def _first_at_rated_power(turbine: Turbine, tip_speed_ratio: float) -> dict[str, float]:
    """Wind, speeds and torque there, by the strategy of ``power_curve``; empty if nowhere."""
    from galerna.aero.bem.steady import SteadyRotor, efficiency, minimum_pitch, strategy_speed

    control, drivetrain = turbine.control, turbine.drivetrain
    rotor, rated = SteadyRotor(turbine), control.rated_power / efficiency(turbine)

    def excess(wind_speed: float) -> float:
        speed = strategy_speed(turbine, tip_speed_ratio, wind_speed)
        point = rotor.at(wind_speed, speed, minimum_pitch(turbine, wind_speed))
        return float(point["rotor_power"]) / rated - 1.0

    winds = np.arange(1.0, min(control.cut_out_wind_speed, HIGHEST_WIND_SPEED) + 1.0)
    above = next((wind for wind in winds if excess(wind) >= 0.0), winds[0])
    if above == winds[0]:  # nowhere, or in the least breath of air
        return {}
    wind_speed = float(brentq(excess, above - 1.0, above))
    speed = strategy_speed(turbine, tip_speed_ratio, wind_speed)
    return {
        "rated_wind_speed": wind_speed,
        "rated_rotor_speed": speed / RPM,
        "rated_tip_speed": speed * turbine.rotor_radius,
        "rated_generator_speed": speed * drivetrain.gear_ratio / RPM,
        "rated_generator_torque": control.rated_power
        / (drivetrain.generator_efficiency * speed * drivetrain.gear_ratio),
    }


def _undamped(part: _Beam) -> _Beam:
    """A part without damping, which the structure would have to tune by modes of its own."""
    assert part.structure is not None
    structure = replace(part.structure, damping=np.zeros(6), damping_ratio=None)
    return replace(part, structure=structure)
