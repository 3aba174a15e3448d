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
_ATTACHED = (-2.0 * DEG, 5.0 * DEG)  # about zero lift: within every section's linear range
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
    zero = _zero_lift_angle(alpha, lift)
    slope = 0.0 if zero is None else _slope(alpha - zero, lift, drag)
    if zero is None or slope <= 0.0:
        at_zero = np.interp(0.0, alpha, drag), np.interp(0.0, alpha, moment)
        return UnsteadyParameters(
            0.0, 0.0, (0.0, 0.0), (0.0, 0.0), float(at_zero[0]), float(at_zero[1])
        )
    normal = lift * np.cos(alpha) + drag * np.sin(alpha)
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


def _zero_lift_angle(alpha: Array, lift: Array) -> float | None:
    """The rising zero of the lift nearest to alpha = 0; None for a section without lift."""
    if np.abs(lift).max() < _LEAST_LIFT:
        return None
    i = np.flatnonzero((lift[:-1] <= 0.0) & (lift[1:] > 0.0))
    if len(i) == 0:
        return None
    zeros = alpha[i] - lift[i] * (alpha[i + 1] - alpha[i]) / (lift[i + 1] - lift[i])
    return float(zeros[np.argmin(np.abs(zeros))])


def _slope(angle: Array, lift: Array, drag: Array) -> float:
    """Least-squares slope 1/rad of the normal force over the attached range, through zero lift."""
    attached = (angle >= _ATTACHED[0]) & (angle <= _ATTACHED[1])
    normal = (lift + drag * angle)[attached]  # cos 1, sin the angle: 0.5 % at the range's ends
    angle = angle[attached]
    return float(angle @ normal / (angle @ angle))


def _separation_angle(angle: Array, normal: Array, slope: float) -> float:
    """First angle above zero lift at which f falls to 0.7, rad; the widest if it never does."""
    ratio_there = ((1.0 + np.sqrt(SEPARATION_POINT)) / 2.0) ** 2
    outside = angle > _ATTACHED[1] / 2
    angle, normal = angle[outside], normal[outside]
    separated = np.flatnonzero(normal < ratio_there * slope * angle)
    return float(angle[separated[0]] if len(separated) else angle[-1])
