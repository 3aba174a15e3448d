"""The operating point that a controller holds in a steady wind.

Below rated, the rotor turns where the aerodynamic torque is the generator's at the lowest
pitch; above, the blades pitch until it is that at rated speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import copysign

from scipy.optimize import brentq

from galerna.aero.bem.steady import SteadyRotor, efficiency, minimum_pitch, strategy_speed
from galerna.aero.bem.steady import optimal_tip_speed_ratio as best_ratio
from galerna.control.drivetrain import PowerTrain
from galerna.control.torque import AboveRated, torque_curve
from galerna.coupling.strategy import completed
from galerna.errors import ConvergenceError
from galerna.turbine.model import Turbine
from galerna.units import DEG

PITCH_TOLERANCE = 5e-5  #: rad
SPEED_TOLERANCE = 5e-5  #: of the rated speed
SECANTS = 20  #: at most, before bisection
SLOWEST = 0.02  #: of the rated speed, as low as a rotor in production is looked for
FIRST_STEP = 0.5 * DEG  #: of pitch, from the guess
FIRST_SHARE = 0.01  #: of the rated speed, from the guess

TorqueOf = Callable[[float, float], float]  #: rotor speed rad/s, pitch rad -> N m


@dataclass(frozen=True)
class OperatingPoint:
    """Rotor speed rad/s, pitch rad and the torque N m that holds the low-speed shaft."""

    rotor_speed: float
    pitch: float
    torque: float


@dataclass(frozen=True)
class Strategy:
    """What a controller wants: ``brake`` N m on the low-speed shaft over the rotor speed.

    ``lowest_pitch`` rad and ``rated_speed`` rad/s; with ``speed`` rad/s, below rated, the
    controller holds that instead and the generator gives what torque it takes.
    """

    lowest_pitch: float
    rated_speed: float
    brake: Callable[[float], float]
    speed: float | None = None


def baseline_strategy(
    turbine: Turbine, wind_speed: float, above_rated: AboveRated, fine_pitch: float | None = None
) -> Strategy:
    """That of the reference controller: torque by its curve."""
    turbine = completed(turbine, above_rated)
    control, train = turbine.control, PowerTrain.of(turbine.drivetrain)
    curve = torque_curve(control, turbine.drivetrain, above_rated)

    def brake(speed: float) -> float:
        return train.shaft_torque(curve.torque(train.generator_speed(speed)), speed)

    lowest = minimum_pitch(turbine, wind_speed) if fine_pitch is None else fine_pitch
    return Strategy(lowest, control.rated_rotor_speed, brake)


def general_strategy(turbine: Turbine, wind_speed: float) -> Strategy:
    """That of the turbine's power curve: its tip-speed ratio within its speeds, rated power."""
    control = turbine.control
    ratio = control.optimal_tip_speed_ratio or best_ratio(turbine)
    torque = control.rated_power / efficiency(turbine) / control.rated_rotor_speed
    return Strategy(
        minimum_pitch(turbine, wind_speed),
        control.rated_rotor_speed,
        lambda speed: torque,
        strategy_speed(turbine, ratio, wind_speed),
    )


def rigid_torque(rotor: SteadyRotor, wind_speed: float) -> TorqueOf:
    """The aerodynamic torque of a rigid rotor."""
    return lambda speed, pitch: float(rotor.at(wind_speed, speed, pitch)["rotor_torque"])


def operating_point(
    torque: TorqueOf, strategy: Strategy, guess: OperatingPoint | None = None
) -> OperatingPoint:
    """Where a rotor of an aerodynamic torque is held, looked for from a guess on.

    Raises ConvergenceError where there is no such point.
    """
    lowest, rated = strategy.lowest_pitch, strategy.rated_speed
    fast = rated if strategy.speed is None else strategy.speed
    guess = guess or OperatingPoint(fast, lowest, 0.0)

    def above(pitch: float) -> float:
        return torque(fast, pitch) / strategy.brake(rated) - 1.0

    if guess.pitch > lowest or above(lowest) > 0.0:
        step, highest = FIRST_STEP, lowest + 90.0 * DEG
        pitch = _falling_root(above, guess.pitch, step, lowest, highest, PITCH_TOLERANCE)
        if pitch > lowest:
            return OperatingPoint(fast, pitch, strategy.brake(rated))
    if strategy.speed is not None:
        return OperatingPoint(fast, lowest, torque(fast, lowest))

    def below(speed: float) -> float:
        return (torque(speed, lowest) - strategy.brake(speed)) / strategy.brake(rated)

    start, step = min(guess.rotor_speed, rated), FIRST_SHARE * rated
    speed = _falling_root(below, start, step, SLOWEST * rated, rated, SPEED_TOLERANCE * rated)
    return OperatingPoint(speed, lowest, strategy.brake(speed))


def _falling_root(
    function: Callable[[float], float],
    start: float,
    step: float,
    low: float,
    high: float,
    tolerance: float,
) -> float:
    """The zero of a falling function between two bounds by secants from ``start`` on.

    The lower bound where the function is negative down to it. Raises ConvergenceError where
    there is no zero up to the upper bound.
    """
    x, value = min(max(start, low), high), 0.0
    known: list[tuple[float, float]] = []
    for _ in range(SECANTS):
        value = function(x)
        known.append((x, value))
        if value < 0.0 and x == low:
            return low
        if value > 0.0 and x == high:
            break
        ahead = _secant(known, step if value > 0.0 else -step, 8.0 * step)
        before, x = x, min(max(x + ahead, low), high)
        if abs(x - before) < tolerance:
            return x
    above = max((x for x, value in known if value >= 0.0), default=None)
    below = min((x for x, value in known if value <= 0.0), default=None)
    if above is None or below is None:
        raise ConvergenceError("operating point", "no pitch or speed balances the torque")
    return float(brentq(function, above, below, xtol=tolerance))


def _secant(known: list[tuple[float, float]], first: float, largest: float) -> float:
    """How far to go from the last known point; on in longer steps where a secant does not fall."""
    if len(known) == 1:
        return first
    (x0, y0), (x1, y1) = known[-2:]
    if (y1 - y0) * (x1 - x0) < 0.0:
        ahead = -y1 * (x1 - x0) / (y1 - y0)
    else:
        ahead = copysign(2.0 * (x1 - x0), first)
    return min(max(ahead, -largest), largest)
