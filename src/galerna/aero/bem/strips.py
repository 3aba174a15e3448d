"""Where each strip is in the rotor and what air it meets: the columns of the strip table."""

from __future__ import annotations

from math import atan2, sqrt

import numpy as np
from numba import njit

from galerna.aero.bem.momentum import FASTMATH
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
NORMAL = slice(7, 10)  #: unit vector across the span, as near the shaft as it can be
TANGENT = slice(10, 13)  #: unit vector in the rotor plane, against the rotation
RADIUS_VECTOR = slice(13, 16)  #: unit vector from the shaft axis to the strip
LOSS = 16  #: Prandtl's factor
QUASI_NORMAL, QUASI_SWIRL = 17, 18  #: induced velocity in balance with the loads, m/s
INDUCED_NORMAL, INDUCED_SWIRL = 19, 20  #: induced velocity that the strip meets, m/s
SPEED = 21  #: relative speed, m/s
INFLOW_ANGLE = 22  #: rad
ANGLE_OF_ATTACK = 23  #: rad, at the point that the options name
LIFT, DRAG, MOMENT = 24, 25, 26  #: coefficients
NORMAL_FORCE, TANGENTIAL_FORCE = 27, 28  #: N/m along NORMAL and against TANGENT
STRIP_COLUMNS = 29


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def aerodynamic_centers(position: Array, rotation: Array, shape: Array, points: Array) -> None:
    """Write the points (m,3) m where the m strips meet the wind, in global axes."""
    for i in range(shape.shape[0]):
        for k in range(3):
            points[i, k] = (
                position[i, k]
                + rotation[i, k, 0] * shape[i, CENTER_X]
                + rotation[i, k, 1] * shape[i, CENTER_Y]
            )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH, inline="always")
def dot(a, b):  # type: ignore[no-untyped-def]
    """Scalar product of two vectors of three."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def place_strip(  # type: ignore[no-untyped-def]
    strip, shape, point, origin, axes, velocity, turning, air, hub, shaft
) -> None:
    """Fill the geometry and the velocities of one strip.

    ``point`` is the aerodynamic centre, ``origin`` and ``axes`` the station's frame with its
    ``velocity`` and angular velocity ``turning``, ``air`` the wind at the point, ``hub`` a
    point of the shaft axis and ``shaft`` its downwind direction; all in global axes.
    """
    normal, tangent, radius = strip[NORMAL], strip[TANGENT], strip[RADIUS_VECTOR]
    along = axes[0, 2] * shaft[0] + axes[1, 2] * shaft[1] + axes[2, 2] * shaft[2]
    cone = sqrt(max(1.0 - along * along, 1e-6))
    depth, square = 0.0, 0.0
    for k in range(3):
        normal[k] = (shaft[k] - along * axes[k, 2]) / cone
        depth += (point[k] - hub[k]) * shaft[k]
    for k in range(3):
        radius[k] = point[k] - hub[k] - depth * shaft[k]
        square += radius[k] * radius[k]
    distance = max(sqrt(square), 1e-6)
    arm = point - origin
    pitch_cosine, pitch_sine, radial, turn = 0.0, 0.0, 0.0, 0.0
    normal_wind, tangential_wind = 0.0, 0.0
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        tangent[k] = axes[i, 2] * normal[j] - axes[j, 2] * normal[i]
        radius[k] /= distance
        relative = air[k] - velocity[k] - (turning[i] * arm[j] - turning[j] * arm[i])
        radial += radius[k] * axes[k, 2]
        turn += turning[k] * axes[k, 2]
        pitch_cosine += axes[k, 0] * normal[k]
        pitch_sine -= axes[k, 0] * tangent[k]
        normal_wind += relative * normal[k]
        tangential_wind += relative * tangent[k]
    strip[RADIUS], strip[CONE], strip[RADIAL] = distance, cone, max(radial, 0.1)
    strip[PITCH] = atan2(pitch_sine, pitch_cosine)
    strip[NORMAL_WIND], strip[TANGENTIAL_WIND], strip[TURNING] = normal_wind, tangential_wind, turn


@njit(cache=True, error_model="numpy", fastmath=FASTMATH, inline="always")
def strip_balance(strip, shape, blades, lift_shift):  # type: ignore[no-untyped-def]
    """What ``momentum.solve_strip`` wants of a strip.

    Momentum flows through the annulus that the strip sweeps, dr = ds RADIAL, along the
    shaft; the induced velocity is axial, and the strip meets its part CONE across the span.
    """
    radius, cone, radial = strip[RADIUS], strip[CONE], strip[RADIAL]
    solidity = blades * shape[CHORD] * cone / (2.0 * np.pi * radius * radial)
    to_root = shape[TO_ROOT] * radial
    return (
        solidity * cone * cone,
        solidity,
        0.5 * blades * shape[TO_TIP] * radial / radius,
        0.5 * blades * to_root / max(radius - to_root, 1e-6),
        1.0 if strip[NORMAL_WIND] >= 0.0 else -1.0,
        lift_shift,
    )
