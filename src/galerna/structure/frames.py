"""Rotations and rigid motions: exponential, logarithm, tangent operators and their derivatives.

A rigid motion is a rotation ``R`` (3,3) and a position ``x`` (3,); a twist or relative
motion ``d`` (6,) is (translation, rotation). Variations are the body's own:
``R <- R exp(rotation)``, ``x <- x + R translation``. The operators on SE(3) are polynomials
in ``ad(d)``, whose eigenvalues are 0 and, twice each, plus and minus i times the angle, so a
polynomial that agrees with the function and its slope there is the function itself.
Sources: Sonneville, Cardona and Bruls, Comput. Methods Appl. Mech. Eng. 268 (2014) 451;
Selig, Geometric Fundamentals of Robotics (2005), ch. 7.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numba import njit

from galerna.contract import Array

from .blocks import FAST, apply, multiply3, multiply6


def _half_cotangent_series(terms: int) -> list[float]:
    """Coefficients of z^2k in (z/2) coth(z/2): cosh(z/2) divided by sinh(z/2) / (z/2)."""
    b: list[float] = []
    for k in range(terms):
        known = sum(b[j] / (4.0 ** (k - j) * factorial(2 * (k - j) + 1)) for j in range(k))
        b.append(1.0 / (4.0**k * factorial(2 * k)) - known)
    return b


_ALTERNATING = [(-1.0) ** k for k in range(18)]
_B = [sign * b for sign, b in zip(_ALTERNATING, _half_cotangent_series(18), strict=True)]
_INVERSE_2 = np.array([(k - 2) * _B[k] for k in range(1, 18)])
_INVERSE_4 = np.array([(k - 1) * _B[k] for k in range(2, 18)])
_BEND = np.array([-_B[k] for k in range(1, 18)])
_EVEN = [_ALTERNATING[k] / factorial(2 * k + 1) for k in range(18)]
_ODD = [-_ALTERNATING[k] / factorial(2 * k + 2) for k in range(18)]
_TANGENT_1 = np.array([(1 - k) * _ODD[k] for k in range(18)])
_TANGENT_2 = np.array([(k - 2) * _EVEN[k] for k in range(1, 18)])
_TANGENT_3 = np.array([-k * _ODD[k] for k in range(1, 18)])
_TANGENT_4 = np.array([(k - 1) * _EVEN[k] for k in range(2, 18)])
_SERIES_BELOW = 1.0  #: squared angle up to which the inverse tangent is summed as a series


@njit(cache=True, error_model="numpy")
def _sum(coefficients: Array, s: float) -> tuple[float, float]:
    """A power series at ``s`` and its derivative."""
    value = slope = 0.0
    for k in range(len(coefficients) - 1, -1, -1):
        slope = slope * s + value
        value = value * s + coefficients[k]
    return value, slope


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
    square = phi[0] ** 2 + phi[1] ** 2 + phi[2] ** 2
    if square < _SERIES_BELOW:
        bend, _ = _sum(_BEND, square)
    else:
        a, b, _ = _versine_ratios(square)
        bend = (1.0 - 0.5 * a / b) / square
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


@njit(cache=True, error_model="numpy")
def tangent(d: Array) -> Array:
    """T(d) (6,6): ``exp(d + e) = exp(d) exp(T(d) e)`` to first order in e."""
    s = d[3] ** 2 + d[4] ** 2 + d[5] ** 2
    A = ad(d)
    A2 = multiply6(A, A)
    odd = _sum(_TANGENT_1, s)[0] * A + _sum(_TANGENT_3, s)[0] * multiply6(A2, A)
    even = _sum(_TANGENT_2, s)[0] * A2 + _sum(_TANGENT_4, s)[0] * multiply6(A2, A2)
    return np.eye(6) + odd + even


@njit(cache=True, error_model="numpy")
def _inverse_coefficients(s: float) -> tuple[float, float, float, float]:
    """Coefficients of ad^2 and ad^4 in the inverse tangent, and their slopes over s = angle^2."""
    if s < _SERIES_BELOW:
        a2, a2_slope = _sum(_INVERSE_2, s)
        a4, a4_slope = _sum(_INVERSE_4, s)
        return a2, a2_slope, a4, a4_slope
    half = 0.5 * np.sqrt(s)
    g = half / np.tan(half)
    slope = (g - g * g - 0.25 * s) / (2.0 * s)
    curvature = (slope * (1.0 - 2.0 * g) - 0.25) / (2.0 * s) - slope / s
    a2 = (2.0 * (1.0 - g) + s * slope) / s
    a4 = (1.0 - g + s * slope) / (s * s)
    return a2, curvature - (slope + a2) / s, a4, (curvature - 2.0 * a4) / s


@njit(cache=True, error_model="numpy", fastmath=FAST)
def inverse_tangents(d: Array) -> tuple[Array, Array]:
    """T(d)^-1 and T(-d)^-1 (6,6), for angles below 2 pi."""
    a2, _, a4, _ = _inverse_coefficients(d[3] ** 2 + d[4] ** 2 + d[5] ** 2)
    A = ad(d)
    A2 = multiply6(A, A)
    A4 = multiply6(A2, A2)
    ahead = np.empty((6, 6))
    behind = np.empty((6, 6))
    for i in range(6):
        for j in range(6):
            even = a2 * A2[i, j] + a4 * A4[i, j]
            ahead[i, j] = even + 0.5 * A[i, j]
            behind[i, j] = even - 0.5 * A[i, j]
        ahead[i, i] += 1.0
        behind[i, i] += 1.0
    return ahead, behind


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _next_slope(A: Array, D: Array, y: Array, dual: bool) -> Array:
    """Slope of ``A z`` over d, for z with the value y and the slope D."""
    out = bracket_by_twist(y, dual)
    for i in range(6):
        for k in range(6):
            a = A[i, k]
            for j in range(6):
                out[i, j] += a * D[k, j]
    return out


@njit(cache=True, error_model="numpy", fastmath=FAST)
def inverse_tangent_slope(d: Array, y: Array, dual: bool) -> Array:
    """Derivative (6,6) over d of the even part of ``T(d)^-1 y`` for a twist y (6,).

    ``dual``: of the transposed operator and a wrench y instead. With the odd part, the
    derivative of ``T(+-d)^-1 y`` is this plus or minus half ``bracket_by_twist(y, dual)``.
    """
    a2, a2_slope, a4, a4_slope = _inverse_coefficients(d[3] ** 2 + d[4] ** 2 + d[5] ** 2)
    A = ad(d)
    if dual:
        A = A.T.copy()
    y1 = apply(A, y)
    y2 = apply(A, y1)
    y3 = apply(A, y2)
    y4 = apply(A, y3)
    D2 = _next_slope(A, bracket_by_twist(y, dual), y1, dual)
    D4 = _next_slope(A, _next_slope(A, D2, y2, dual), y3, dual)
    for i in range(6):
        change = 2.0 * (a2_slope * y2[i] + a4_slope * y4[i])
        for j in range(6):
            D2[i, j] = a2 * D2[i, j] + a4 * D4[i, j]
        for j in range(3, 6):
            D2[i, j] += change * d[j]
    return D2
