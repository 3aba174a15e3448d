"""Where each strip is in the rotor and what air it meets: the columns of the strip table."""

from __future__ import annotations

from math import atan2, pi, sqrt

from numba import njit

from galerna.aero.bem.momentum import FASTMATH, Strip
from galerna.aero.vectors import (
    Vector,
    add,
    axis,
    combine,
    cross,
    dot,
    length,
    row,
    scale,
    subtract,
)
from galerna.contract import Array

# Constants of a strip: rows of ``shape``.
CENTER_X, CENTER_Y, OFFSET, WEIGHT, CHORD, TO_TIP, TO_ROOT = range(7)
SHAPE_COLUMNS = 7

# What is known of a strip at one time: rows of ``strips``. Vectors take three columns.
RADIUS = 0  #: distance of the aerodynamic centre from the shaft axis, m
CONE = 1  #: cosine of the angle between the shaft and the strip's normal
RADIAL = 2  #: cosine of the angle between the span and the radius
PITCH = 3  #: angle from the rotor plane to the chord, rad
NORMAL_WIND, TANGENTIAL_WIND = 4, 5  #: air velocity without the rotor's induction, m/s
TURNING = 6  #: angular velocity about the span, nose-up positive, rad/s
TORSION = 7  #: the part of it that is not the rotor's own, rad/s
NORMAL = 8  #: unit vector across the span, as near the shaft as it can be
TANGENT = 11  #: unit vector in the rotor plane, against the rotation
OUTWARDS = 14  #: unit vector from the shaft axis to the strip
LOSS = 17  #: Prandtl's factor
INDUCED_NORMAL, INDUCED_SWIRL = 18, 19  #: induced velocity against the wind and swirl, m/s
SPEED = 20  #: relative speed, m/s
ACROSS = 21  #: relative velocity along NORMAL, m/s
ANGLE_OF_ATTACK = 22  #: rad, at the point that the options name
LIFT, DRAG, MOMENT = 23, 24, 25  #: coefficients
NORMAL_FORCE, TANGENTIAL_FORCE = 26, 27  #: N/m along NORMAL and against TANGENT
PITCH_COSINE, PITCH_SINE = 28, 29
ALONG = 30  #: relative velocity along TANGENT, m/s
STRIP_COLUMNS = 31


@njit(cache=True)
def vector(strips: Array, i: int, first: int) -> Vector:
    """The vector of strip i that starts at column ``first``."""
    return strips[i, first], strips[i, first + 1], strips[i, first + 2]


@njit(cache=True)
def _keep(strips: Array, i: int, first: int, value: Vector) -> None:
    strips[i, first], strips[i, first + 1], strips[i, first + 2] = value


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def arm(rotation: Array, shape: Array, i: int) -> Vector:
    """From the frame of station i to its aerodynamic centre, m, in global axes."""
    return combine(
        shape[i, CENTER_X], axis(rotation, i, 0), shape[i, CENTER_Y], axis(rotation, i, 1)
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def aerodynamic_centers(position: Array, rotation: Array, shape: Array, points: Array) -> None:
    """Write the points (m,3) m where the m strips meet the wind, in global axes."""
    for i in range(shape.shape[0]):
        points[i, 0], points[i, 1], points[i, 2] = add(row(position, i), arm(rotation, shape, i))


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def place_strip(
    i: int,
    shape: Array,
    points: Array,
    rotation: Array,
    velocity: Array,
    angular_velocity: Array,
    wind: Array,
    hub: Vector,
    shaft: Vector,
    rotor_turning: Vector,
    strips: Array,
) -> None:
    """Fill the geometry and the undisturbed velocities of strip i.

    ``points`` are the aerodynamic centres and ``wind`` is the air's velocity there; ``hub``
    is a point of the shaft axis, ``shaft`` its downwind direction and ``rotor_turning`` the
    angular velocity of the hub; all in global axes.
    """
    span, suction = axis(rotation, i, 2), axis(rotation, i, 0)
    along = dot(span, shaft)
    cone = sqrt(max(1.0 - along * along, 1e-6))
    normal = combine(1.0 / cone, shaft, -along / cone, span)
    tangent = cross(span, normal)
    from_hub = subtract(row(points, i), hub)
    outwards = combine(1.0, from_hub, -dot(from_hub, shaft), shaft)
    radius = max(length(outwards), 1e-6)
    outwards = scale(1.0 / radius, outwards)
    turning = row(angular_velocity, i)
    motion = add(row(velocity, i), cross(turning, arm(rotation, shape, i)))
    air = subtract(row(wind, i), motion)
    strips[i, RADIUS], strips[i, CONE] = radius, cone
    strips[i, RADIAL] = max(dot(outwards, span), 0.1)
    strips[i, PITCH_COSINE], strips[i, PITCH_SINE] = dot(suction, normal), -dot(suction, tangent)
    strips[i, PITCH] = atan2(strips[i, PITCH_SINE], strips[i, PITCH_COSINE])
    strips[i, NORMAL_WIND], strips[i, TANGENTIAL_WIND] = dot(air, normal), dot(air, tangent)
    strips[i, TURNING] = dot(turning, span)
    strips[i, TORSION] = dot(subtract(turning, rotor_turning), span)
    _keep(strips, i, NORMAL, normal)
    _keep(strips, i, TANGENT, tangent)
    _keep(strips, i, OUTWARDS, outwards)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def strip_balance(i: int, strips: Array, shape: Array, blades: float, lift_shift: float) -> Strip:
    """What ``momentum.solve_strip`` wants of strip i.

    Momentum flows through the annulus that the strip sweeps, dr = ds RADIAL, along the
    shaft; the induced velocity is axial, and the strip meets its part CONE across the span.
    """
    radius, cone, radial = strips[i, RADIUS], strips[i, CONE], strips[i, RADIAL]
    solidity = blades * shape[i, CHORD] * cone / (2.0 * pi * radius * radial)
    to_root = shape[i, TO_ROOT] * radial
    return (
        solidity * cone * cone,
        solidity,
        0.5 * blades * shape[i, TO_TIP] * radial / radius,
        0.5 * blades * to_root / max(radius - to_root, 1e-6),
        1.0 if strips[i, NORMAL_WIND] >= 0.0 else -1.0,
        lift_shift,
    )
