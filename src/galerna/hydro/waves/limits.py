"""Which waves can exist: breaking limits, with the figures."""

from __future__ import annotations

from math import isfinite, tanh

import numpy as np

from galerna.errors import InputError
from galerna.hydro.waves.dispersion import wavelength

MICHE = 0.142  #: largest height over length in deep water (Miche, 1944)
DEPTH_LIMIT = 0.78  #: largest height over depth (McCowan, 1894)
STEEPEST_SEA = 1.0 / 15.0  #: significant height over the peak's length (DNV-RP-C205, 3.5.4)
USUAL_SEA = ((8.0, 15.0), (1.0 / 15.0, 1.0 / 25.0))  #: the same over the peak period s


def require_regular(height: float, period: float, depth: float, gravity: float) -> None:
    """Raise InputError unless waves of a height m and a period s stand before they break."""
    length = wavelength(period, depth, gravity)
    steepest = MICHE * length * tanh(2.0 * np.pi * depth / length)
    if height > steepest:
        what = (
            f"waves of {height:g} m at a period of {period:g} s are {length:.4g} m long: they "
            f"break above {steepest:.3g} m (height over length 0.142 tanh(k h), Miche)"
        )
        raise InputError("sea.waves.height_m", what, "lower the height or lengthen the period")
    require_depth("sea.waves.height_m", height, depth)


def require_irregular(
    height: float, period: float, depth: float, gravity: float
) -> tuple[str, ...]:
    """Warnings for a significant height m with a peak period s.

    Raises InputError where no sea is so steep.
    """
    require_depth("sea.waves.significant_height_m", height, depth)
    length = wavelength(period, depth, gravity)
    found = height / length
    figures = (
        f"{height:g} m with a peak period of {period:g} s, {length:.4g} m long, is a "
        f"significant steepness of 1/{1.0 / found:.3g}"
    )
    if found > STEEPEST_SEA:
        what = f"{figures}; the steepest seas have 1/15 (DNV-RP-C205)"
        hint = f"at most {STEEPEST_SEA * length:.3g} m at this period"
        raise InputError("sea.waves.significant_height_m", what, hint)
    usual = float(np.interp(period, *USUAL_SEA))
    if found > usual:
        return (f"waves: {figures}; observed seas stay below 1/{1.0 / usual:.3g} (DNV-RP-C205)",)
    return ()


def require_depth(where: str, height: float, depth: float) -> None:
    """Raise InputError unless waves of a height m stand on a depth m."""
    if isfinite(depth) and height > DEPTH_LIMIT * depth:
        what = (
            f"{height:g} m on a depth of {depth:g} m: waves break above {DEPTH_LIMIT * depth:.3g} m"
        )
        raise InputError(where, what, "lower the height")


def require_resolved(highest: float, time_step: float, peak: float) -> tuple[str, ...]:
    """Warnings where a time step s is coarse for waves up to ``highest`` rad/s.

    Raises InputError where the waves are beyond the step's Nyquist frequency.
    """
    if highest * time_step > np.pi:
        what = (
            f"waves up to {highest:.4g} rad/s; a step of {time_step:g} s resolves "
            f"{np.pi / time_step:.4g} rad/s at most"
        )
        raise InputError("sea.waves", what, "shorten time_step_s or lower highest_frequency_hz")
    steps = 2.0 * np.pi / (peak * time_step)
    if steps < 20.0:
        return (f"waves: {steps:.3g} time steps per peak period; 20 resolve it",)
    return ()
