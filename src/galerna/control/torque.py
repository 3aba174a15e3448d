"""Generator torque against generator speed: the regions of a variable-speed turbine.

Below rated speed the torque follows K w^2, which holds the best tip-speed ratio; straight
lines lead into it from the cut-in speed (region 1 1/2) and out of it to the rated torque
(region 2 1/2, a line with the slip of an induction machine); above, power or torque is
constant. Where a turbine does not say how wide region 1 1/2 is, it is steep: the torque holds
the minimum speed until the optimum asks for more. Source: Jonkman et al., NREL/TP-500-38060
(2009), section 7.2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt
from typing import Literal

from galerna.errors import InputError
from galerna.turbine.model import Control, Drivetrain
from galerna.units import RPM

AboveRated = Literal["constant_power", "constant_torque"]
RATED_SHARE = 0.99  #: of the rated speed, where region 3 begins
SLIP = 0.10  #: of region 2 1/2, against the synchronous speed
CUT_IN_RAMP = 1.05  #: end of region 1 1/2 over the minimum speed, where a turbine does not say
RELEASED, HELD = 0.8, 0.9  #: of where region 2 1/2 begins, between which a held region 3 fades


@dataclass(frozen=True)
class TorqueCurve:
    """Torque N m at generator speeds rad/s; ``power`` W is the generator's mechanical power.

    ``cut_in`` and ``ramp_end`` bound region 1 1/2, ``leave`` and ``rated`` region 2 1/2;
    ``maximum`` N m bounds the torque at constant power.
    """

    optimal_mode_gain: float
    cut_in: float
    ramp_end: float
    leave: float
    rated: float
    power: float
    above_rated: AboveRated = "constant_power"
    maximum: float = inf

    @property
    def rated_torque(self) -> float:
        """Torque at the start of region 3; where it is constant, that of the rated speed."""
        return rated_torque(self.power, self.rated, self.above_rated)

    def torque(self, speed: float, region_3: float = 0.0) -> float:
        """Torque at a speed.

        ``region_3``, from 0 to 1, is how far region 3 is held below its speed, because the blades
        are still pitched; far below region 2 1/2 it is not.
        """
        if speed >= self.rated:
            return self._above(speed)
        below = self._below(speed)
        share = (speed / self.leave - RELEASED) / (HELD - RELEASED)
        held = region_3 * min(max(share, 0.0), 1.0)
        return below + held * (self._above(speed) - below) if held > 0.0 else below

    def _above(self, speed: float) -> float:
        """Region 3."""
        if self.above_rated == "constant_torque":
            return self.rated_torque
        return min(self.power / speed, self.maximum)

    def _below(self, speed: float) -> float:
        """Regions 1 to 2 1/2."""
        gain = self.optimal_mode_gain
        if speed <= self.cut_in:
            return 0.0
        if speed < self.ramp_end:
            end = gain * self.ramp_end**2
            return end * (speed - self.cut_in) / (self.ramp_end - self.cut_in)
        if speed < self.leave:
            return gain * speed**2
        low = gain * self.leave**2
        share = (speed - self.leave) / (self.rated - self.leave)
        return low + share * (self.rated_torque - low)


def rated_torque(power: float, rated: float, above_rated: AboveRated) -> float:
    """Torque N m that a power W asks for where region 3 begins, at ``rated`` rad/s."""
    return power / rated if above_rated == "constant_power" else RATED_SHARE * power / rated


def torque_curve(
    control: Control, drivetrain: Drivetrain, above_rated: AboveRated = "constant_power"
) -> TorqueCurve:
    """The curve of a turbine from its published figures.

    Raises InputError where the turbine has no optimal-mode gain or its speeds leave no room.
    """
    if control.optimal_mode_gain is None:
        raise InputError(
            "control.optimal_mode_gain", "the turbine does not give it",
            "compute one with galerna tune, or give it in the turbine's companion file",
        )  # fmt: skip
    ratio, gain = drivetrain.gear_ratio, control.optimal_mode_gain
    power = control.rated_power / drivetrain.generator_efficiency
    rated = RATED_SHARE * control.rated_rotor_speed * ratio
    cut_in = control.minimum_rotor_speed * ratio
    ramp_end = (control.region_2_rotor_speed or 0.0) * ratio or CUT_IN_RAMP * cut_in
    torque = rated_torque(power, rated, above_rated)
    synchronous = rated / (1.0 + SLIP)
    slope = torque / (rated - synchronous)
    if gain * rated**2 >= torque:  # the optimum gives the rated torque before the rated speed
        leave = sqrt(torque / gain)
    else:
        leave = (slope - sqrt(slope * (slope - 4.0 * gain * synchronous))) / (2.0 * gain)
    if not (cut_in < ramp_end < leave or cut_in == 0.0):
        what = f"cut in at {cut_in / RPM:.4g} rpm, but the optimum is left at {leave / RPM:.4g} rpm"
        raise InputError("control", what, "check the minimum speed and the optimal-mode gain")
    maximum = control.maximum_torque or inf
    return TorqueCurve(gain, cut_in, ramp_end, leave, rated, power, above_rated, maximum)
