"""Camber lines: from an airfoil's outline, or the arc that has its polar's zero-lift angle."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.model import Airfoil, Turbine

CamberSource = Literal["coordinates", "polar", "none"]
SEARCHED = np.radians(30.0)  #: on both sides of 0: where a polar's zero-lift angle is looked for
NO_LIFT = 0.01  #: lift coefficient; some files have 1e-4 for a cylinder


def parabolic_arc(zero_lift_angle: float, along: Array) -> Array:
    """Mean line z/c at ``along`` x/c of the parabola with a thin airfoil's zero-lift angle rad.

    Source: Katz and Plotkin, Low-Speed Aerodynamics (2001), section 5.4: the angle is minus
    twice the height of the arc in chords.
    """
    return -2.0 * zero_lift_angle * along * (1.0 - along)


def mean_line(camber: Array, along: Array) -> Array:
    """Height z/c at ``along`` x/c of a camber line (k,2); its ends are met exactly."""
    x = (camber[:, 0] - camber[0, 0]) / (camber[-1, 0] - camber[0, 0])
    return np.interp(along, x, camber[:, 1])


def thin_airfoil_zero_lift(camber: Array) -> float:
    """Zero-lift angle rad of a camber line (k,2) in thin-airfoil theory.

    The integral of slope times (1 - cos theta)/pi over theta, x = (1 - cos theta)/2, is exact
    for a line that is straight between its points (Katz and Plotkin 2001, eq. 5.57).
    """
    x = (camber[:, 0] - camber[0, 0]) / (camber[-1, 0] - camber[0, 0])
    theta = np.arccos(1.0 - 2.0 * np.clip(x, 0.0, 1.0))
    slope = np.diff(camber[:, 1]) / np.diff(x)
    return float(np.sum(slope * np.diff(theta - np.sin(theta))) / np.pi)


def polar_zero_lift(airfoil: Airfoil) -> float:
    """Zero-lift angle rad of an airfoil's middle polar: where the lift rises through 0.

    0 where it never does, as with a cylinder. Raises InputError without polars.
    """
    if not airfoil.polars:
        raise InputError(f"airfoil {airfoil.name!r}", "has neither polars nor coordinates")
    polar = airfoil.polars[len(airfoil.polars) // 2]
    angle, lift = polar.angle_of_attack, polar.lift
    rises = (lift[:-1] < 0.0) & (lift[1:] >= 0.0) & (np.abs(angle[:-1]) < SEARCHED)
    left = np.flatnonzero(rises)
    zeros = angle[left] - lift[left] * np.diff(angle)[left] / np.diff(lift)[left]
    return float(zeros[np.argmin(np.abs(zeros))]) if len(zeros) else 0.0


class ZeroLiftAngles(NamedTuple):
    """Zero-lift angles rad of one airfoil: of its camber line in thin-airfoil theory, of its polar.

    ``by_camber`` is None where no coordinates are known.
    """

    airfoil: str
    by_camber: float | None
    by_polar: float


def zero_lift_angles(turbine: Turbine) -> list[ZeroLiftAngles]:
    """What the choice between camber line and polar means, for each lifting airfoil in use.

    They differ because a boundary layer that is thicker on the suction side, or an open
    trailing edge, takes camber away from real sections.
    """
    names = dict.fromkeys(turbine.blade.shape.airfoil_names)
    used = [turbine.airfoils[name] for name in names if has_lift(turbine.airfoils[name])]
    return [
        ZeroLiftAngles(
            airfoil.name,
            None if airfoil.camber is None else thin_airfoil_zero_lift(airfoil.camber),
            polar_zero_lift(airfoil),
        )
        for airfoil in used
    ]


def has_lift(airfoil: Airfoil) -> bool:
    """Whether an airfoil lifts at any angle; a cylinder's polar has no lift or next to none.

    Without polars the thickness decides.
    """
    if not airfoil.polars:
        return airfoil.relative_thickness < 1.0
    return any(bool(np.max(np.abs(polar.lift)) > NO_LIFT) for polar in airfoil.polars)


def airfoil_line(airfoil: Airfoil, source: CamberSource, along: Array) -> Array:
    """Mean line z/c of an airfoil at ``along`` x/c.

    ``source`` "coordinates" takes its camber line, or the polar where it has none; "polar" the
    parabola with the polar's zero-lift angle; "none" a flat plate. Without lift it is flat.
    """
    if source == "none" or not has_lift(airfoil):
        return np.zeros_like(along)
    if source == "coordinates" and airfoil.camber is not None:
        return mean_line(airfoil.camber, along)
    return parabolic_arc(polar_zero_lift(airfoil), along)
