"""Rotations and rigid motions: exponential, logarithm, tangent operators and their derivatives.

A rigid motion is a rotation ``R`` (3,3) and a position ``x`` (3,); a twist or relative
motion ``d`` (6,) is (translation, rotation). Variations are the body's own:
``R <- R exp(rotation)``, ``x <- x + R translation``. A function of ``ad(d)`` on SE(3) is the
function of the rotation alone, on SO(3), and its derivative along the translation.
Sources: Sonneville, Cardona and Bruls, Comput. Methods Appl. Mech. Eng. 268 (2014) 451;
Selig, Geometric Fundamentals of Robotics (2005), ch. 7.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numba import njit

from galerna.contract import Array

from .blocks import FAST, multiply3


def _half_cotangent_series(terms: int) -> list[float]:
    """Coefficients of z^2k in (z/2) coth(z/2): cosh(z/2) divided by sinh(z/2) / (z/2)."""
    b: list[float] = []
    for k in range(terms):
        known = sum(b[j] / (4.0 ** (k - j) * factorial(2 * (k - j) + 1)) for j in range(k))
        b.append(1.0 / (4.0**k * factorial(2 * k)) - known)
    return b


_ALTERNATING = [(-1.0) ** k for k in range(18)]
_HALF_COTANGENT = _half_cotangent_series(18)
_BEND = np.array([-_ALTERNATING[k] * _HALF_COTANGENT[k] for k in range(1, 18)])
_BEND_NEAR = _BEND[:6].copy()
_VERSINE = np.array([_ALTERNATING[k] / factorial(2 * k + 2) for k in range(9)])
_SINE_REST = np.array([_ALTERNATING[k] / factorial(2 * k + 3) for k in range(9)])
_SERIES_BELOW = 1.0  #: squared angle up to which the inverse tangent is summed as a series
_FEW_TERMS_BELOW = 0.02  #: squared angle of neighbours in a beam, where a few do


@njit(cache=True, error_model="numpy")
def _sum(coefficients: Array, s: float) -> tuple[float, float, float]:
    """A power series at ``s``, its derivative and its second derivative."""
    value = slope = curvature = 0.0
    for k in range(len(coefficients) - 1, -1, -1):
        curvature = curvature * s + 2.0 * slope
        slope = slope * s + value
        value = value * s + coefficients[k]
    return value, slope, curvature


@njit(cache=True, error_model="numpy")
def _bend(s: float) -> tuple[float, float, float]:
    """(1 - (t/2) cot(t/2)) / t^2 for t^2 = ``s``, and its two derivatives over s."""
    if s < _FEW_TERMS_BELOW:
        return _sum(_BEND_NEAR, s)
    if s < _SERIES_BELOW:
        return _sum(_BEND, s)
    half = 0.5 * np.sqrt(s)
    g = half / np.tan(half)
    slope = (g - g * g - 0.25 * s) / (2.0 * s)
    curvature = (slope * (1.0 - 2.0 * g) - 0.25) / (2.0 * s) - slope / s
    value = (1.0 - g) / s
    first = (-slope - value) / s
    return value, first, (-curvature - 2.0 * first) / s


@njit(cache=True)
def rotation_about(axis: int, angle: float) -> Array:
    """Rotation matrix (3,3) by ``angle`` rad about coordinate axis 0, 1 or 2."""
    c, s = np.cos(angle), np.sin(angle)
    R = np.zeros((3, 3))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[axis, axis] = 1.0
    R[i, i] = c
    R[j, j] = c
    R[i, j] = -s
    R[j, i] = s
    return R


@njit(cache=True)
def _set_hat(a: Array, start: int, A: Array, i: int, j: int) -> None:
    """Write the cross-product matrix of ``a[start : start + 3]`` at A[i, j]."""
    A[i, j + 1], A[i, j + 2], A[i + 1, j + 2] = -a[start + 2], a[start + 1], -a[start]
    A[i + 1, j], A[i + 2, j], A[i + 2, j + 1] = a[start + 2], -a[start + 1], a[start]


@njit(cache=True)
def hat(a: Array) -> Array:
    """The matrix (3,3) of the cross product: ``hat(a) @ b = a x b``."""
    A = np.zeros((3, 3))
    _set_hat(a, 0, A, 0, 0)
    return A


@njit(cache=True, error_model="numpy")
def _versine_ratios(square: float) -> tuple[float, float, float]:
    """sin t / t, (1 - cos t) / t^2 and (t - sin t) / t^3 for t^2 = ``square``."""
    if square < 1e-2:
        a = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))
        b = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0))
        c = 1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))
        return a, b, c
    angle = np.sqrt(square)
    half = np.sin(0.5 * angle)
    sine = np.sin(angle)
    return sine / angle, 2.0 * half * half / square, (angle - sine) / (square * angle)


@njit(cache=True, error_model="numpy")
def _second_order(scale_one: float, scale_two: float, phi: Array, a: Array) -> Array:
    """``a + scale_one phi x a + scale_two phi x (phi x a)``."""
    b = np.empty(3)
    b[0] = phi[1] * a[2] - phi[2] * a[1]
    b[1] = phi[2] * a[0] - phi[0] * a[2]
    b[2] = phi[0] * a[1] - phi[1] * a[0]
    c = np.empty(3)
    c[0] = a[0] + scale_one * b[0] + scale_two * (phi[1] * b[2] - phi[2] * b[1])
    c[1] = a[1] + scale_one * b[1] + scale_two * (phi[2] * b[0] - phi[0] * b[2])
    c[2] = a[2] + scale_one * b[2] + scale_two * (phi[0] * b[1] - phi[1] * b[0])
    return c


@njit(cache=True, error_model="numpy")
def exp_so3(phi: Array) -> Array:
    """Rotation matrix (3,3) of the rotation vector ``phi`` (3,) rad."""
    square = phi[0] ** 2 + phi[1] ** 2 + phi[2] ** 2
    a, b, _ = _versine_ratios(square)
    R = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            R[i, j] = b * phi[i] * phi[j]
        R[i, i] += 1.0 - b * square
    R[0, 1] -= a * phi[2]
    R[1, 0] += a * phi[2]
    R[0, 2] += a * phi[1]
    R[2, 0] -= a * phi[1]
    R[1, 2] -= a * phi[0]
    R[2, 1] += a * phi[0]
    return R


@njit(cache=True, error_model="numpy")
def quaternion_from_rotation(R: Array) -> Array:
    """Unit quaternion (4,), scalar first and not negative (Shepperd's choice of pivot)."""
    q = np.empty(4)
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    pivot = 0
    largest = trace
    for i in range(3):
        if R[i, i] > largest:
            pivot, largest = i + 1, R[i, i]
    if pivot == 0:
        q[0] = 1.0 + trace
        q[1] = R[2, 1] - R[1, 2]
        q[2] = R[0, 2] - R[2, 0]
        q[3] = R[1, 0] - R[0, 1]
    else:
        i = pivot - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q[0] = R[k, j] - R[j, k]
        q[1 + i] = 1.0 + R[i, i] - R[j, j] - R[k, k]
        q[1 + j] = R[j, i] + R[i, j]
        q[1 + k] = R[k, i] + R[i, k]
    norm = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    return q / (norm if q[0] >= 0.0 else -norm)


@njit(cache=True, error_model="numpy")
def rotation_from_quaternion(q: Array) -> Array:
    """Rotation matrix (3,3) of a quaternion (4,), scalar first; the length does not matter."""
    w, x, y, z = q / np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@njit(cache=True, error_model="numpy")
def log_so3(R: Array) -> Array:
    """Rotation vector (3,) rad of a rotation matrix, of length at most pi."""
    q = quaternion_from_rotation(R)
    sine = np.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    if sine < 1e-4:
        ratio = (sine / q[0]) ** 2
        factor = 2.0 / q[0] * (1.0 - ratio / 3.0)
    else:
        factor = 2.0 * np.arctan2(sine, q[0]) / sine
    return factor * q[1:]


@njit(cache=True, error_model="numpy")
def exp_se3(d: Array) -> tuple[Array, Array]:
    """Rotation (3,3) and position (3,) of the rigid motion along the constant twist ``d`` (6,)."""
    phi = d[3:]
    _, b, c = _versine_ratios(phi[0] ** 2 + phi[1] ** 2 + phi[2] ** 2)
    return exp_so3(phi), _second_order(b, c, phi, d[:3])


@njit(cache=True, error_model="numpy")
def log_se3(R: Array, x: Array) -> Array:
    """The constant twist (6,) that makes the rigid motion ``R``, ``x``; the inverse of exp_se3."""
    phi = log_so3(R)
    bend, _, _ = _bend(phi[0] ** 2 + phi[1] ** 2 + phi[2] ** 2)
    d = np.empty(6)
    d[:3] = _second_order(-0.5, bend, phi, x)
    d[3:] = phi
    return d


@njit(cache=True)
def adjoint(R: Array, x: Array) -> Array:
    """The matrix (6,6) that carries a twist from the moved frame to the base: Ad(R, x)."""
    A = np.zeros((6, 6))
    A[:3, :3] = R
    A[3:, 3:] = R
    A[:3, 3:] = multiply3(hat(x), R)
    return A


@njit(cache=True)
def ad(d: Array) -> Array:
    """The matrix (6,6) of the Lie bracket: ``ad(d) @ e = [d, e]``."""
    A = np.zeros((6, 6))
    _set_hat(d, 3, A, 0, 0)
    _set_hat(d, 3, A, 3, 3)
    _set_hat(d, 0, A, 0, 3)
    return A


@njit(cache=True)
def bracket_by_twist(y: Array, dual: bool) -> Array:
    """The matrix (6,6) of ``ad(d) @ y``, ``dual``: of ``ad(d).T @ y``, over d."""
    if not dual:
        return -ad(y)
    B = np.zeros((6, 6))
    _set_hat(y, 0, B, 0, 3)
    _set_hat(y, 0, B, 3, 0)
    _set_hat(y, 3, B, 3, 3)
    return B


@njit(cache=True, error_model="numpy", fastmath=FAST)
def tangent(d: Array) -> Array:
    """T(d) (6,6): ``exp(d + e) = exp(d) exp(T(d) e)`` to first order in e.

    On SO(3) it is ``1 - b hat(phi) + c (phi phi^T - phi^2 1)`` with the ratios b and c of
    ``_versine_ratios``; on SE(3) its derivative along the translation couples.
    """
    s = d[3] ** 2 + d[4] ** 2 + d[5] ** 2
    along = 2.0 * (d[0] * d[3] + d[1] * d[4] + d[2] * d[5])
    b, b_slope, c, c_slope = _tangent_ratios(s)
    odd = ad(d)
    T = np.zeros((6, 6))
    for i in range(3):
        for j in range(3):
            square = d[3 + i] * d[3 + j]
            turn = c * square - b * odd[i, j]
            shift = c * (d[3 + i] * d[j] + d[i] * d[3 + j]) + c_slope * along * square
            shift -= b * odd[i, 3 + j] + b_slope * along * odd[i, j]
            if i == j:
                turn += 1.0 - c * s
                shift -= along * (c + c_slope * s)
            T[i, j] = T[3 + i, 3 + j] = turn
            T[i, 3 + j] = shift
    return T


@njit(cache=True, error_model="numpy")
def _tangent_ratios(s: float) -> tuple[float, float, float, float]:
    """(1 - cos t) / t^2, (t - sin t) / t^3 for t^2 = ``s``, each with its derivative over s."""
    if s < _SERIES_BELOW:
        b, b_slope, _ = _sum(_VERSINE, s)
        c, c_slope, _ = _sum(_SINE_REST, s)
        return b, b_slope, c, c_slope
    a, b, c = _versine_ratios(s)
    return b, (0.5 * a - b) / s, c, (0.5 * b - 1.5 * c) / s


@njit(cache=True, error_model="numpy", fastmath=FAST)
def inverse_tangents(d: Array) -> tuple[Array, Array]:
    """T(d)^-1 and T(-d)^-1 (6,6), for angles below 2 pi.

    On SO(3) the inverse is ``1 + hat(phi)/2 + e(phi)`` with the even part ``e = bend(phi^2)
    (phi phi^T - phi^2 1)``; on SE(3) the derivative of that along the translation couples.
    """
    s = d[3] ** 2 + d[4] ** 2 + d[5] ** 2
    c = d[0] * d[3] + d[1] * d[4] + d[2] * d[5]
    bend, slope, _ = _bend(s)
    odd = ad(d)
    ahead = np.zeros((6, 6))
    behind = np.zeros((6, 6))
    for i in range(3):
        for j in range(3):
            square = d[3 + i] * d[3 + j]
            turn = bend * square
            shift = bend * (d[3 + i] * d[j] + d[i] * d[3 + j]) + 2.0 * slope * c * square
            if i == j:
                turn += 1.0 - bend * s
                shift -= 2.0 * c * (bend + slope * s)
            half_turn, half_shift = 0.5 * odd[i, j], 0.5 * odd[i, 3 + j]
            ahead[i, j] = ahead[3 + i, 3 + j] = turn + half_turn
            behind[i, j] = behind[3 + i, 3 + j] = turn - half_turn
            ahead[i, 3 + j], behind[i, 3 + j] = shift + half_shift, shift - half_shift
    return ahead, behind


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_even_slope(
    d: Array, y: Array, k: int, bend: float, slope: float, E: Array, row: int, column: int
) -> None:
    """Add the derivative (3,3) of ``e(phi) a`` over phi, for ``a = y[k : k + 3]``."""
    s = d[3] ** 2 + d[4] ** 2 + d[5] ** 2
    p = d[3] * y[k] + d[4] * y[k + 1] + d[5] * y[k + 2]
    for i in range(3):
        even = 2.0 * slope * (d[3 + i] * p - s * y[k + i]) - 2.0 * bend * y[k + i]
        for j in range(3):
            E[row + i, column + j] += bend * d[3 + i] * y[k + j] + even * d[3 + j]
        E[row + i, column + i] += bend * p


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_even_curvature(
    d: Array, y: Array, k: int, bend: float, slope: float, curvature: float,
    E: Array, row: int, column: int,
) -> None:  # fmt: skip
    """Add the derivative (3,3) along u of that derivative, for ``d = (u, phi)``."""
    s = d[3] ** 2 + d[4] ** 2 + d[5] ** 2
    c = d[0] * d[3] + d[1] * d[4] + d[2] * d[5]
    p = d[3] * y[k] + d[4] * y[k + 1] + d[5] * y[k + 2]
    q = d[0] * y[k] + d[1] * y[k + 1] + d[2] * y[k + 2]
    for i in range(3):
        phi, u, a = d[3 + i], d[i], y[k + i]
        even = phi * p - s * a
        by_phi = 4.0 * c * (curvature * even - slope * a) + 2.0 * slope * (
            u * p + phi * q - 2.0 * c * a
        )
        by_u = 2.0 * (slope * even - bend * a)
        by_a = 2.0 * c * slope * phi + bend * u
        for j in range(3):
            E[row + i, column + j] += by_a * y[k + j] + by_phi * d[3 + j] + by_u * d[j]
        E[row + i, column + i] += 2.0 * c * slope * p + bend * q


@njit(cache=True, error_model="numpy", fastmath=FAST)
def inverse_tangent_slope(d: Array, y: Array, dual: bool) -> Array:
    """Derivative (6,6) over d of the even part of ``T(d)^-1 y`` for a twist y (6,).

    ``dual``: of the transposed operator and a wrench y instead. With the odd part, the
    derivative of ``T(+-d)^-1 y`` is this plus or minus half ``bracket_by_twist(y, dual)``.
    """
    bend, slope, curvature = _bend(d[3] ** 2 + d[4] ** 2 + d[5] ** 2)
    E = np.zeros((6, 6))
    coupled, row = (0, 3) if dual else (3, 0)  # what meets both parts of the operator, and where
    _add_even_slope(d, y, coupled, bend, slope, E, row, 0)
    _add_even_slope(d, y, coupled, bend, slope, E, 3 - row, 3)
    _add_even_slope(d, y, 3 - coupled, bend, slope, E, row, 3)
    _add_even_curvature(d, y, coupled, bend, slope, curvature, E, row, 3)
    return E


def roll_pitch_yaw(R: Array) -> Array:
    """Roll, pitch and yaw (3,) rad of a rotation: about z first, then about y, about x last."""
    pitch = np.arcsin(min(max(-R[2, 0], -1.0), 1.0))
    return np.array([np.arctan2(R[2, 1], R[2, 2]), pitch, np.arctan2(R[1, 0], R[0, 0])])


def turned_by(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation (3,3) by yaw about z first, then pitch about y, roll about x last, rad."""
    return np.asarray(rotation_about(2, yaw) @ rotation_about(1, pitch) @ rotation_about(0, roll))
