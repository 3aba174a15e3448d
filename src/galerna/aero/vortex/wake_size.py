"""How long the wake of a rotor is and in what steps it is shed, from a user's options."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy as np

from galerna.aero.vortex.ages import SLOWEST_TURN, rotor_ages
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.aero.vortex.thinning import Integers, summed_rows
from galerna.contract import Array
from galerna.errors import InputError
from galerna.units import DEG

FARTHEST_STEP = 0.1  #: radii that the wind travels while a slow rotor sheds one row
SLOWEST_WIND = 0.01  #: over the tip speed; a slower one leaves a wake in the rotor plane


@dataclass(frozen=True, eq=False)
class WakeSize:
    """Ages (S,) s of the summed rows of a wake, and what they are to the rotor.

    ``rows`` (S,) are their numbers among all rows, which are a step apart.
    """

    ages: Array
    rows: Integers
    diameters: float
    revolutions: float

    @property
    def step(self) -> float:
        """Time s in which a row is shed."""
        return float(self.ages[1])

    @property
    def all_ages(self) -> Array:
        """Ages (K+1,) s of all rows."""
        return self.step * np.arange(self.rows[-1] + 1.0)


def wake_size(
    options: VortexLatticeOptions,
    rotor_speed: float,
    wind_speed: float,
    radius: float,
    time_step: float | None = None,
) -> WakeSize:
    """The wake of a rotor of ``radius`` m at a mean speed rad/s, in a mean wind m/s.

    Its step is rounded to whole numbers of ``time_step`` s; one that is longer is left to the
    check of the step. Raises InputError where nothing carries the wake away, or where the rotor
    turns backwards.
    """
    _require_a_wake(options, rotor_speed, wind_speed, radius)
    turn = max(rotor_speed, SLOWEST_TURN * abs(wind_speed) / radius)
    longest = FARTHEST_STEP * radius / abs(wind_speed) if wind_speed else inf
    step = options.wake_step_s or min(options.wake_step_deg * DEG / turn, longest)
    if time_step is not None and time_step <= step * (1.0 + 1e-9):
        step = max(round(step / time_step), 1) * time_step
    diameters = options.wake_length_diameters
    if options.wake_revolutions is not None:
        speed = max(abs(wind_speed), 0.05 * rotor_speed * radius)
        diameters = options.wake_revolutions * 2.0 * pi / turn * speed / (2.0 * radius)
    wanted = rotor_ages(
        rotor_speed,
        wind_speed,
        radius,
        step * turn / DEG,
        diameters=diameters,
        near_deg=options.wake_near_deg,
        growth=options.wake_growth,
        widest_deg=options.wake_widest_deg,
    )
    rows = summed_rows(wanted)
    ages = step * rows.astype(float)
    length = float(ages[-1])
    return WakeSize(
        ages, rows, length * abs(wind_speed) / (2.0 * radius), length * rotor_speed / (2.0 * pi)
    )


def _require_a_wake(
    options: VortexLatticeOptions, rotor_speed: float, wind_speed: float, radius: float
) -> None:
    if rotor_speed < 0.0:
        raise InputError(
            "rotor speed",
            "the rotor turns backwards, where no vortices leave its blades' trailing edges",
            "model: bem knows such sections from their polars",
        )
    if abs(wind_speed) > SLOWEST_WIND * rotor_speed * radius:
        return
    if rotor_speed and options.wake == "free" and options.start == "impulsive":
        return
    raise InputError(
        "wind speed",
        f"a wind of {wind_speed:g} m/s does not carry the wake away from the rotor",
        "a rotor that turns in calm air needs wake: free and start: impulsive"
        if rotor_speed
        else "give a wind, or turn the rotor",
    )
