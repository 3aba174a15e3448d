"""Skewed wake: how induction varies over a turn when the wind does not blow along the shaft.

Angles and signs. n is the shaft axis downwind, about which the rotor turns positively; the
part of the wind in the rotor plane points along the unit vector s. delta is the angle of a
blade from s, positive about n: the blade at delta = 0 is the downwind one, into whose side
the wake leans. (In the convention of yaw error +30 deg, s points to azimuth 90 deg and
delta = azimuth - 90 deg; with the wind from the other side or from below, s turns with it,
so yaw, tilt and upflow need no formula of their own.) Induced velocities are positive where
they oppose: ``axial`` reduces the wind along n, ``tangential`` adds to the speed of the
rotor, in which the wake's swirl runs the other way.

Wake skew angle chi: the wake leaves along the mean of the velocities inside and outside it
(Coleman, Feingold & Stempin, NACA WR L-126, 1945; Burton et al., Wind Energy Handbook):

    tan(chi) = (V_s - w tan(chi/2)) / (V_n - w)

Vortex cylinder. For a rotor of constant circulation the wake is a skewed cylinder of rings,
a root vortex and axial vorticity on the cylinder (Branlard & Gaunaa, Wind Energy 19, 2016).
With t = tan(chi/2), x = r/R and w, w_t the means of the annulus, at the rotor plane:

    rings:        axial       w (1 + K(x) t cos(delta)),   K = 4 u_r / gamma, straight wake
                  tangential  - w t sin(delta)             (the cross-wind slows down too)
    root vortex:  axial       w_t 2 t sin(delta) / q,      q = 1 + t^2 - 2 t cos(delta)
                  tangential  w_t (1 - t^2) / q

K is Oye's polynomial x + 0.4 x^3 + 0.4 x^5, 1 % from the elliptic integrals at 0.75 R and
finite at the tip, where theirs grow without bound because a real blade's circulation does
not end at once. The root vortex acts against the rings at the bottom and with them at the
top of the rotor, mostly inboard: it turns the phase there. These are the first harmonics of
the rings (exact for every chi) and all of the root vortex. Left out: the rings' higher
harmonics, 3 % of w at chi = 30 deg and 10 % at 50 deg inside 0.75 R, and the axial
vorticity on the cylinder, which hardly moves the axial velocity there.
"""

from __future__ import annotations

from math import atan, cos, pi, sqrt, tan

from numba import njit

from galerna.aero.bem.lag import FASTMATH

PITT_PETERS = 15.0 * pi / 32.0  #: ratio of the matrix entries 15 pi/64 and 1/2
LARGEST_SKEW = pi / 3.0  #: beyond, the wake lies against the rotor and the theory fades out


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def half_skew_tangent(axial_wind: float, in_plane_wind: float, axial_induced: float) -> float:
    """tan(chi/2) >= 0 of the wake behind the whole rotor; 0 with flow from behind.

    Means over the rotor in m/s: the wind along n, the size of its part in the rotor plane,
    and the axial induced velocity. Beyond LARGEST_SKEW the answer falls to 0 with the flow
    through the rotor.
    """
    through = axial_wind - axial_induced
    if through <= 0.0 or in_plane_wind <= 0.0:
        return 0.0
    # w t (1 + t^2) - V_s t^2 - 2 V_n t + V_s has one root between 0 and 1: shrink to it.
    low, high = 0.0, 1.0
    t = in_plane_wind / (axial_wind + sqrt(axial_wind**2 + in_plane_wind**2))
    for _ in range(60):
        value = (
            axial_induced * t * (1.0 + t * t)
            - in_plane_wind * t * t
            - 2.0 * axial_wind * t
            + in_plane_wind
        )
        low, high = (t, high) if value > 0.0 else (low, t)
        slope = axial_induced * (1.0 + 3.0 * t * t) - 2.0 * (in_plane_wind * t + axial_wind)
        step = t - value / slope if slope < 0.0 else -1.0
        following = step if low < step < high else 0.5 * (low + high)
        if abs(following - t) < 1e-13:
            break
        t = following
    largest = tan(0.5 * LARGEST_SKEW)
    return t if t <= largest else largest * cos(2.0 * atan(t)) / cos(LARGEST_SKEW)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def skew_position(
    wind_y: float, wind_z: float, radial_y: float, radial_z: float
) -> tuple[float, float]:
    """cos(delta), sin(delta) of a strip from in-plane components in axes whose x is n.

    ``wind`` m/s is the rotor's mean wind, ``radial`` m points from the shaft to the strip.
    (1, 0) where either vanishes.
    """
    size = sqrt((wind_y**2 + wind_z**2) * (radial_y**2 + radial_z**2))
    if size == 0.0:
        return 1.0, 0.0
    return (
        (wind_y * radial_y + wind_z * radial_z) / size,
        (wind_y * radial_z - wind_z * radial_y) / size,
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def pitt_peters(
    axial: float, tangential: float, radius_fraction: float, t: float, cos_delta: float
) -> tuple[float, float]:
    """Induced velocities m/s with the linear variation of Pitt and Peters (Vertica 5, 1981).

    The one-harmonic model of AeroDyn and of the dissertation's "BEM skew":
    axial (1 + 15 pi/32 (r/R) tan(chi/2) cos(delta)), the swirl as it is.
    """
    return axial * (1.0 + PITT_PETERS * radius_fraction * t * cos_delta), tangential


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def vortex_cylinder(
    axial: float,
    tangential: float,
    radius_fraction: float,
    t: float,
    cos_delta: float,
    sin_delta: float,
) -> tuple[float, float]:
    """Induced velocities m/s of a strip behind which the wake is skewed; see the module.

    ``axial`` and ``tangential`` m/s are those of the axisymmetric wake, ``t`` is
    ``half_skew_tangent``, the position comes from ``skew_position``.
    """
    x = min(radius_fraction, 1.0)
    growth = x * (1.0 + 0.4 * x * x * (1.0 + x * x))
    q = 1.0 + t * t - 2.0 * t * cos_delta
    return (
        axial * (1.0 + growth * t * cos_delta) + tangential * 2.0 * t * sin_delta / q,
        tangential * (1.0 - t * t) / q - axial * t * sin_delta,
    )
