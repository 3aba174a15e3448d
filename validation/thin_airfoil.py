"""Unsteady thin-airfoil theory: what a flat plate's lift must be in plane, linear flow.

Time is counted in semichords travelled, s = 2 U t / c. Both indicial functions come from
their Laplace transforms K1/(K0 + K1)/p (a step of the angle of attack everywhere) and
exp(-p)/(K0 + K1)/p^2 (a gust that meets the leading edge at s = 0), whose only singularities
are the pole at rest and the cut along p = -x (Garrick, NACA 629, 1938). Round the cut

    phi(s) = 1 - int_0^inf exp(-x s) / (x^2 D) dx
    psi(s) = 1 - int_0^inf exp(-x (s - 1)) (I0 + I1) / (x^2 D) dx
    D(x) = (K0 - K1)^2 + pi^2 (I0 + I1)^2

which the trapezoidal rule over log x gives to ten digits, as a sum of exponentials. So the
convolution of a gust is a set of first-order lags, exact for an angle that varies linearly
between samples.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import hankel2, i0e, i1e, k0e, k1e

from galerna.contract import Array

ComplexArray = NDArray[np.complex128]


@cache
def _relaxation() -> tuple[Array, Array, Array]:
    """Decay rates x per semichord and the weights of Wagner's and Kuessner's exponentials."""
    logarithm, step = np.linspace(-24.0, 32.0, 1121, retstep=True)
    x = np.exp(logarithm)
    lift = i0e(x) + i1e(x)  # times exp(x)
    denominator = ((k0e(x) - k1e(x)) * np.exp(-2 * x)) ** 2 + (np.pi * lift) ** 2
    wagner_weight = step * np.exp(-2 * x) / (x * denominator)
    kuessner_weight = step * lift / (x * denominator)
    return x, wagner_weight, kuessner_weight


def _respond(weight: Array, semichords: ArrayLike) -> Array:
    s = np.asarray(semichords, dtype=float)
    decay = np.exp(-np.multiply.outer(np.maximum(s, 0.0), _relaxation()[0]))
    return np.where(s < 0.0, 0.0, 1.0 - decay @ weight)


def wagner(semichords: ArrayLike) -> Array:
    """Circulatory lift after a step of the angle of attack, over its final value.

    Source: Wagner, ZAMM 5 (1925); the value 1/2 at s = 0 is the limit from above.
    """
    return _respond(_relaxation()[1], semichords)


def kuessner(semichords: ArrayLike) -> Array:
    """Lift of a plate that enters a sharp-edged gust, over its final value.

    Source: Kuessner, Luftfahrtforschung 13 (1936), as corrected by von Karman and Sears.
    """
    return _respond(_relaxation()[2], semichords)


def theodorsen(reduced_frequency: ArrayLike) -> ComplexArray:
    """C(k) of NACA 496 (1935), k = omega c / 2U > 0."""
    k = np.asarray(reduced_frequency, dtype=float)
    return hankel2(1, k) / (hankel2(1, k) + 1j * hankel2(0, k))


def plunge_lift(k: ArrayLike) -> ComplexArray:
    """Complex lift coefficient of plunging with downward velocity U exp(iks).

    Added mass and circulation, NACA 496 eq. 18 with h' = U exp(iks).
    """
    k = np.asarray(k, dtype=float)
    return 2 * np.pi * theodorsen(k) + 1j * np.pi * k


def pitch_lift(k: ArrayLike, axis: float) -> ComplexArray:
    """Complex lift coefficient of a pitch angle exp(iks), nose up.

    ``axis`` is the axis' distance behind the mid-chord in semichords, Theodorsen's a.
    """
    k = np.asarray(k, dtype=float)
    circulatory = 2 * np.pi * theodorsen(k) * (1.0 + 1j * k * (0.5 - axis))
    return circulatory + np.pi * (1j * k + axis * k**2)


def gust_lift(semichords: ArrayLike, angle: ArrayLike) -> Array:
    """Lift coefficients (n,) in a gust that is convected along the chord.

    ``angle`` (n,) rad is the angle of attack that the wind at the leading edge makes at
    ``semichords`` (n,), rising; before the first it was constant and the lift steady. Eq. 3.4
    of the dissertation, with the start of a steady flow in place of a sharp edge.
    """
    s, alpha = np.asarray(semichords, dtype=float), np.asarray(angle, dtype=float)
    rate, _, weight = _relaxation()
    lag = np.zeros_like(rate)  # of each exponential behind the angle
    lift = [2 * np.pi * alpha[0]]
    for step, change, now in zip(np.diff(s), np.diff(alpha), alpha[1:], strict=True):
        lag *= np.exp(-rate * step)
        lag += change * -np.expm1(-rate * step) / (rate * step)
        lift.append(2 * np.pi * (now - weight @ lag))
    return np.array(lift)


def sears(k: ArrayLike) -> ComplexArray:
    """Lift in a sinusoidal gust over its quasi-steady value, phase at the leading edge.

    Source: Sears, J. Aeronaut. Sci. 8 (1941), moved from the mid-chord by exp(-ik).
    """
    k = np.asarray(k, dtype=float)
    # C (J0 - i J1) + i J1, simplified with the Wronskian of the Bessel functions.
    return np.exp(-1j * k) * 2.0 / (np.pi * k * (hankel2(0, k) - 1j * hankel2(1, k)))
