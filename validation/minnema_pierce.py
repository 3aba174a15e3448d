"""What AeroDyn's Beddoes-Leishman model of Minnema and Pierce makes of a polar in steady flow.

With tabulated separation (FLookup) the normal and chordwise force follow from Kirchhoff's
separation points of the static polar, but not above those of attached flow,

    Cn = C_nalpha (alpha - alpha_0) ((1 + sqrt(f)) / 2)^2,             f <= 1
    Cc = C_nalpha (alpha - alpha_0) tan(alpha) (sqrt(f_c) - 0.2),  sqrt(f_c) <= 1.2

with C_nalpha / sqrt(1 - M^2), so where a polar lies above its published C_nalpha line, steady
loads are not the polar's: on the NREL 5 MW at 18 m/s the DU25 at 2.6 deg keeps 85 % of its
lift. Source: the unsteady aerodynamics module of AeroDyn (OpenFAST, UnsteadyAero; theory by
Damiani & Hayman), equations 1.32, 1.38 and 1.40 as numbered there.
"""

from __future__ import annotations

import numpy as np

from galerna.aero.sections import BladeSections
from galerna.contract import Array

SPEED_OF_SOUND = 335.0  #: m/s, of the deck
OFFSET = 0.2  #: keeps sqrt(f_c) real where the chordwise force points backwards


def corrected_loads(
    sections: BladeSections, turn: dict[str, Array], radius: Array
) -> tuple[float, float]:
    """Factors on thrust and torque when the section forces are those of the model.

    ``turn`` holds the channels of static loads (t,b,n); the induction stays, as in AeroDyn.
    """
    angle, inflow, speed = (
        turn[name] for name in ("angle_of_attack", "inflow_angle", "relative_speed")
    )
    loaded = turn["lift_coefficient"] ** 2 + turn["drag_coefficient"] ** 2 > 0.0
    pressure = speed**2 * sections.chord * loaded

    def integrals(lift: Array, drag: Array) -> tuple[float, float]:
        normal = pressure * (lift * np.cos(inflow) + drag * np.sin(inflow))
        tangential = pressure * (lift * np.sin(inflow) - drag * np.cos(inflow))
        thrust = np.trapezoid(normal, radius, axis=-1).mean()
        return float(thrust), float(np.trapezoid(tangential * radius, radius, axis=-1).mean())

    static = _static(sections, angle)
    before = integrals(*static)
    after = integrals(*_model(sections, angle, speed, *static))
    return after[0] / before[0], after[1] / before[1]


def section_forces(
    sections: BladeSections, angle: Array, speed: Array, *, unsteady_model: bool
) -> tuple[Array, Array]:
    """Lift and drag coefficient (...,n): the polar's, or those that the model makes of them."""
    static = _static(sections, angle)
    return _model(sections, angle, speed, *static) if unsteady_model else static


def _static(sections: BladeSections, angle: Array) -> tuple[Array, Array]:
    lift, drag = np.empty_like(angle), np.empty_like(angle)
    for i in range(len(sections)):
        lift[..., i] = np.interp(angle[..., i], sections.angles, sections.table[i, :, 0])
        drag[..., i] = np.interp(angle[..., i], sections.angles, sections.table[i, :, 1])
    return lift, drag


def _model(
    sections: BladeSections, angle: Array, speed: Array, lift: Array, drag: Array
) -> tuple[Array, Array]:
    slope, zero, at_zero = (
        np.array([getattr(u, name) for u in sections.unsteady])
        for name in ("normal_force_slope", "zero_lift_angle", "zero_lift_drag")
    )
    attached = slope / np.sqrt(1.0 - (speed / SPEED_OF_SOUND) ** 2) * (angle - zero)
    lifting = slope > 1.0
    attached = np.where(lifting, attached, 1.0)
    normal = lift * np.cos(angle) + (drag - at_zero) * np.sin(angle)
    chordwise = lift * np.sin(angle) - (drag - at_zero) * np.cos(angle)
    root = np.minimum(np.abs(2.0 * np.sqrt(np.maximum(normal / attached, 0.0)) - 1.0), 1.0)
    potential = attached * np.tan(angle)
    chord_root = np.minimum(np.abs(chordwise / potential + OFFSET), 1.0 + OFFSET)
    normal = attached * ((1.0 + root) / 2.0) ** 2
    chordwise = potential * (chord_root - OFFSET)
    return (
        np.where(lifting, normal * np.cos(angle) + chordwise * np.sin(angle), lift),
        np.where(lifting, normal * np.sin(angle) - chordwise * np.cos(angle) + at_zero, drag),
    )
