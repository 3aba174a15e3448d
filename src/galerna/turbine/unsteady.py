"""Attached-flow and dynamic-stall parameters fitted from a static polar.

Leishman and Beddoes, "A semi-empirical model for dynamic stall", J. American
Helicopter Society 34(3), 1989: the static curve is read as Kirchhoff flow,
Cn = Cn_alpha ((1 + sqrt f)/2)^2 (alpha - alpha_0), with the separation point f.
"""

from __future__ import annotations

import numpy as np

from galerna.turbine.model import Array, Polar, UnsteadyParameters
from galerna.units import DEG

SEPARATION_POINT = 0.7  #: chords, where the boundary layer is taken to give way
_WINDOW = 6.0 * DEG  # the linear range is the steepest stretch of this width ...
_MIDDLES = (-1.0 * DEG, 8.0 * DEG)  # ... with its middle this far from zero lift
_NEAREST = 2.5 * DEG  # separation is looked for beyond this angle from zero lift
_WIDEST = 45.0 * DEG
_LEAST_LIFT = 0.05  # below it a section has no lift to speak of: a cylinder
_STEP = 0.1 * DEG


def fit(polar: Polar) -> UnsteadyParameters:
    """Zero-lift angle, normal-force slope, separation angles and critical loads of a polar.

    A section without lift gets zeros, as the OpenFAST files give a cylinder.
    The critical normal force is the attached one at the separation angle.
    """
    alpha = np.arange(-_WIDEST, _WIDEST + _STEP / 2, _STEP)
    lift, drag, moment = (
        np.interp(alpha, polar.angle_of_attack, c) for c in (polar.lift, polar.drag, polar.moment)
    )
    normal = lift * np.cos(alpha) + drag * np.sin(alpha)
    zero, slope = _linear_range(alpha, lift, normal)
    if slope <= 0.0:
        return UnsteadyParameters(
            zero_lift_angle=0.0,
            normal_force_slope=0.0,
            separation_angles=(0.0, 0.0),
            critical_normal_force=(0.0, 0.0),
            zero_lift_drag=float(np.interp(0.0, alpha, drag)),
            zero_lift_moment=float(np.interp(0.0, alpha, moment)),
        )
    above = _separation_angle(alpha - zero, normal, slope)
    below = -_separation_angle(-(alpha - zero)[::-1], -normal[::-1], slope)
    return UnsteadyParameters(
        zero_lift_angle=zero,
        normal_force_slope=slope,
        separation_angles=(zero + above, zero + below),
        critical_normal_force=(slope * above, slope * below),
        zero_lift_drag=float(np.interp(zero, alpha, drag)),
        zero_lift_moment=float(np.interp(zero, alpha, moment)),
    )


def _linear_range(alpha: Array, lift: Array, normal: Array) -> tuple[float, float]:
    """Zero-lift angle rad and slope 1/rad of the steepest line along the normal force.

    The line's own zero is taken, so that the two describe the same attached flow.
    Both are 0 for a section without lift.
    """
    rising = np.flatnonzero((lift[:-1] <= 0.0) & (lift[1:] > 0.0))
    if np.abs(lift).max() < _LEAST_LIFT or len(rising) == 0:
        return 0.0, 0.0
    crossing = alpha[rising[np.argmin(np.abs(alpha[rising]))]]
    half = round(_WINDOW / _STEP / 2.0)
    first, last = np.searchsorted(alpha, crossing + np.array(_MIDDLES))
    lines = [
        np.polyfit(alpha[i - half : i + half + 1], normal[i - half : i + half + 1], 1)
        for i in range(max(first, half), min(last, len(alpha) - half - 1))
    ]
    slope, constant = max(lines, key=lambda line: float(line[0]), default=(0.0, 0.0))
    return (float(-constant / slope), float(slope)) if slope > 0.0 else (0.0, 0.0)


def _separation_angle(angle: Array, normal: Array, slope: float) -> float:
    """First angle above zero lift at which f falls to 0.7, rad; the widest if it never does."""
    ratio_there = ((1.0 + np.sqrt(SEPARATION_POINT)) / 2.0) ** 2
    outside = angle > _NEAREST
    angle, normal = angle[outside], normal[outside]
    separated = np.flatnonzero(normal < ratio_there * slope * angle)
    return float(angle[separated[0]] if len(separated) else angle[-1])
