"""Rotational augmentation: polars of a turning blade, which stalls later than a wing.

Both models move the lift towards that of attached flow, cl_p = slope (alpha - alpha_0):

    cl = cl_2D + f_L (cl_p - cl_2D),      cd = cd_2D - f_D (cd_2D - cd_0)

    snel      f_L = 3 (c/r)^2,  f_D = 0           Snel, Houwink & Bosschers, ECN-C--93-052, 1994
    du_selig  f = (1.6 s / 0.1267 (1 - s^e) / (1 + s^e) - 1) / (2 pi),  s = c/r,
              e = R / (Lambda r) for f_L and half of it for f_D,
              Lambda = lambda / sqrt(1 + lambda^2)     Du & Selig, AIAA-98-0021, 1998

Du and Selig's factors are negative towards the tip: there their theory separates earlier
than the wing, and it is left to. The slope is the polar's own attached one, not 2 pi, so
that attached flow is not changed. Measured augmentation ends where the flow is like that
behind a plate: the correction is whole up to FADE_START and falls to zero at FADE_END, and
it leaves angles below zero lift alone.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from galerna.aero.bem.attached_flow import attached_line
from galerna.errors import InputError, did_you_mean
from galerna.turbine.model import Polar

Array = NDArray[np.float64]
Method = Literal["none", "snel", "du_selig"]

FADE_START, FADE_END = np.radians(30.0), np.radians(50.0)
LEAST_SLOPE = 1.0  #: 1/rad; a section that lifts less (a cylinder) is left as it is


def augmentation_factors(
    method: Method, chord_to_radius: float, radius_fraction: float, tip_speed_ratio: float
) -> tuple[float, float]:
    """(f_L, f_D) of the module's equations, at most 1.

    ``chord_to_radius`` is c/r (taken as 1 where larger), ``radius_fraction`` r/R. Raises
    InputError for an unknown method or a ratio that is not positive.
    """
    if not np.all(np.array([chord_to_radius, radius_fraction, tip_speed_ratio]) > 0.0):
        raise InputError("rotational augmentation", "c/r, r/R and tip-speed ratio must be positive")
    s = min(chord_to_radius, 1.0)
    if method == "none":
        return 0.0, 0.0
    if method == "snel":
        return min(3.0 * s**2, 1.0), 0.0
    if method != "du_selig":
        hint = did_you_mean(method, ("none", "snel", "du_selig"))
        raise InputError("rotational augmentation", f"unknown method {method!r}", hint)
    modified = tip_speed_ratio / np.sqrt(1.0 + tip_speed_ratio**2)
    power = s ** (np.array([1.0, 0.5]) / (modified * radius_fraction))
    factors = (1.6 * s / 0.1267 * (1.0 - power) / (1.0 + power) - 1.0) / (2.0 * np.pi)
    lift, drag = np.minimum(factors, 1.0).tolist()
    return lift, drag


def augment(
    angle: Array,
    lift: Array,
    drag: Array,
    method: Method,
    chord_to_radius: float,
    radius_fraction: float,
    tip_speed_ratio: float,
) -> tuple[Array, Array]:
    """Lift and drag coefficients (m,) of the turning section on the angles (m,) rad, rising.

    Raises as ``augmentation_factors``. Source: see the module.
    """
    f_lift, f_drag = augmentation_factors(method, chord_to_radius, radius_fraction, tip_speed_ratio)
    zero, slope = attached_line(angle, lift)
    if slope < LEAST_SLOPE:
        return lift.copy(), drag.copy()
    share = np.clip((FADE_END - angle) / (FADE_END - FADE_START), 0.0, 1.0) * (angle > zero)
    attached = slope * (angle - zero)
    drag_at_zero = np.interp(zero, angle, drag)
    return (
        lift + share * f_lift * (attached - lift),
        drag - share * f_drag * (drag - drag_at_zero),
    )


def augment_polar(
    polar: Polar,
    method: Method,
    chord_to_radius: float,
    radius_fraction: float,
    tip_speed_ratio: float,
) -> Polar:
    """The polar of the turning section; its moment stays. Raises as ``augment``."""
    lift, drag = augment(
        polar.angle_of_attack,
        polar.lift,
        polar.drag,
        method,
        chord_to_radius,
        radius_fraction,
        tip_speed_ratio,
    )
    return replace(polar, lift=lift, drag=drag)
