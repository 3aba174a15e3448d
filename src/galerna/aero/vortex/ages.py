"""How old the rows of a wake are: close together behind the trailing edge, wider further on.

What is far away may be coarse. A panel's width in age is also how far its vorticity spreads
while it passes (eq. 4.4 is an upwind scheme), so widths grow gently, and on a rotor no panel
spans an arc so long that its chord misrepresents the circle.
"""

from __future__ import annotations

from math import ceil, inf

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.units import DEG

MOST_ROWS = 100_000  #: of one wake; a default one has about a hundred
SLOWEST_TURN = 0.05  #: tip speed over wind speed below which a rotor sheds like a wing


def uniform_ages(step: float, duration: float) -> Array:
    """Ages (K+1,) s from 0 to at least ``duration`` s, ``step`` s apart."""
    return growing_ages(step, duration)


def growing_ages(
    step: float, duration: float, *, near: float = 0.0, growth: float = 1.0, widest: float = inf
) -> Array:
    """Ages (K+1,) s from 0 to ``duration`` s, whose differences grow.

    Panels are ``step`` s wide up to the age ``near`` s; behind it each is ``growth`` times as
    wide as the one before, up to ``widest`` s. The last row lies at least at ``duration``.
    Raises InputError for a step, duration or growth that makes no wake, or one of more than
    ``MOST_ROWS`` rows.
    """
    sound = 0.0 < step < inf and step <= duration < inf and growth >= 1.0 and widest >= step
    if not sound:
        raise InputError(
            "ages of the wake",
            f"step {step:g} s, duration {duration:g} s, growth {growth:g}, widest {widest:g} s",
            "they need 0 < step <= duration, growth from 1 and widest from step up",
        )
    ages, width = [0.0], step
    while ages[-1] < duration * (1.0 - 1e-9):
        if len(ages) > MOST_ROWS:
            raise InputError(
                "ages of the wake",
                f"more than {MOST_ROWS} rows to the age of {duration:g} s",
                "ask for a shorter wake or longer steps",
            )
        if ages[-1] >= near * (1.0 - 1e-9) and len(ages) > 1:
            width = min(growth * width, widest)
        ages.append(ages[-1] + width)
    return np.array(ages)


def rotor_ages(
    rotor_speed: float,
    wind_speed: float,
    radius: float,
    step_deg: float = 5.0,
    *,
    diameters: float = 3.0,
    near_deg: float = 120.0,
    growth: float = 1.1,
    widest_deg: float = 20.0,
) -> Array:
    """Ages (K+1,) s of a rotor's wake, from its speed rad/s, the wind m/s and the radius m.

    The wake is as long as the wind travels over ``diameters`` rotor diameters. Panels span
    ``step_deg`` of azimuth up to ``near_deg`` and grow to ``widest_deg`` behind it. A rotor that
    hardly turns gets the panels of one whose tips move at a twentieth of the wind speed.
    Raises InputError where neither wind nor rotor moves.
    """
    speed = max(abs(wind_speed), 0.05 * abs(rotor_speed) * radius)
    turn = max(abs(rotor_speed), SLOWEST_TURN * abs(wind_speed) / radius)
    if not (0.0 < speed < inf and 0.0 < turn < inf and radius > 0.0):
        raise InputError(
            "ages of the wake",
            f"rotor speed {rotor_speed:g} rad/s and wind {wind_speed:g} m/s carry no wake away",
            "give the ages of the wake's rows",
        )
    per_degree = DEG / turn
    duration = max(2.0 * radius * diameters / speed, step_deg * per_degree)
    return growing_ages(
        step_deg * per_degree,
        duration,
        near=near_deg * per_degree,
        growth=growth,
        widest=max(widest_deg, step_deg) * per_degree,
    )


def revolution_ages(
    rotor_speed: float, revolutions: float, step_deg: float = 5.0, **growth: float
) -> Array:
    """Ages (K+1,) s of a wake of so many ``revolutions`` at ``rotor_speed`` rad/s.

    Further keywords as in ``rotor_ages``: ``near_deg``, ``growth``, ``widest_deg``; without them
    all panels span ``step_deg``.
    """
    per_degree = DEG / abs(rotor_speed)
    steps = ceil(revolutions * 360.0 / step_deg - 1e-9)
    return growing_ages(
        step_deg * per_degree,
        steps * step_deg * per_degree,
        near=growth.get("near_deg", 0.0) * per_degree,
        growth=growth.get("growth", 1.0),
        widest=max(growth.get("widest_deg", 360.0), step_deg) * per_degree,
    )
