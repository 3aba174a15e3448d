"""Gains of the pitch controller from the sensitivity of the aerodynamic power to pitch.

The rotor's speed error x obeys a second-order equation in its integral (eq. 2.128; Hansen et
al., Riso-R-1500(EN), 2005): with the drivetrain's inertia I at the rotor, gear ratio G and
speed W,

    (I + s G K_D) x'' + (s G K_P - c) x' + s G K_I x = 0,   s = -(dP/dpitch) / W,

where c = P/W^2 for a generator at constant power, which drives the speed away, and zero at
constant torque. Wanted frequency and damping give the gains at each pitch angle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.contract import Array
from galerna.control.pitch import PitchGains
from galerna.control.torque import AboveRated
from galerna.errors import InputError

NATURAL_FREQUENCY, DAMPING_RATIO = 0.6, 0.7  #: rad/s and 1: the NREL 5 MW report's choice


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Aerodynamic power W and its derivative W/rad over pitch (n,) rad, at rated speed rad/s.

    ``wind_speed`` (n,) m/s is where each pitch balances the rated power.
    """

    wind_speed: Array
    pitch: Array
    power: Array
    power_by_pitch: Array
    rotor_speed: float


def pitch_gains(
    sensitivity: Sensitivity,
    inertia: float,
    gear_ratio: float,
    *,
    natural_frequency: float = NATURAL_FREQUENCY,
    damping_ratio: float = DAMPING_RATIO,
    above_rated: AboveRated = "constant_power",
    derivative: float = 0.0,
) -> PitchGains:
    """Gains that give the closed loop a natural frequency rad/s and a damping ratio.

    ``inertia`` kg m2 at the rotor; ``derivative`` s2 is the derivative gain. Raises InputError
    where power grows with pitch: no positive gain can hold the speed there.
    """
    if natural_frequency <= 0.0 or damping_ratio <= 0.0:
        raise InputError("natural_frequency, damping_ratio", "both must be positive")
    speed = sensitivity.rotor_speed
    torque_by_pitch = -sensitivity.power_by_pitch / speed
    if np.any(torque_by_pitch <= 0.0):
        bad = np.degrees(sensitivity.pitch[torque_by_pitch <= 0.0][0])
        what = f"power does not fall with pitch at {bad:.2f} deg"
        raise InputError("sensitivity", what, "begin the schedule at a larger angle")
    lever = torque_by_pitch * gear_ratio
    effective = inertia + lever * derivative
    driving = sensitivity.power / speed**2 if above_rated == "constant_power" else 0.0
    return PitchGains(
        sensitivity.pitch,
        (2.0 * damping_ratio * natural_frequency * effective + driving) / lever,
        natural_frequency**2 * effective / lever,
        np.full(len(lever), derivative),
    )


def closed_loop(
    gains: PitchGains,
    sensitivity: Sensitivity,
    inertia: float,
    gear_ratio: float,
    above_rated: AboveRated = "constant_power",
) -> tuple[Array, Array]:
    """Natural frequency (n,) rad/s and damping ratio (n,) that gains give."""
    lever = -sensitivity.power_by_pitch / sensitivity.rotor_speed * gear_ratio
    tuned = np.array([gains.at(pitch) for pitch in sensitivity.pitch])
    effective = inertia + lever * tuned[:, 2]
    driving = sensitivity.power / sensitivity.rotor_speed**2
    driving = driving if above_rated == "constant_power" else 0.0 * driving
    frequency = np.sqrt(lever * tuned[:, 1] / effective)
    return frequency, (lever * tuned[:, 0] - driving) / (2.0 * frequency * effective)
