"""How long and how fast waves of a frequency are on water of constant depth."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array

_STEPS = 6  #: of Newton from Eckart's start, which is within 6 %: the fifth reaches rounding
_DEEP = 350.0  #: k h beyond which sinh(2 k h) would overflow


def wavenumber(frequency: ArrayLike, depth: float, gravity: float) -> Array:
    """Wave number (n,) 1/m of w^2 = g k tanh(k h) for frequencies (n,) rad/s; h may be infinite."""
    deep = np.asarray(frequency, dtype=float) ** 2 / gravity
    if not np.isfinite(depth):
        return deep
    x = np.maximum(deep * depth, np.finfo(float).tiny)
    y = x / np.sqrt(np.tanh(x))
    for _ in range(_STEPS):
        t = np.tanh(y)
        y = y - (y * t - x) / (t + y * (1.0 - t**2))
    return np.where(deep > 0.0, y / depth, 0.0)


def group_velocity(frequency: ArrayLike, depth: float, gravity: float) -> Array:
    """Speed (n,) m/s at which the energy of waves of frequencies (n,) rad/s travels."""
    w = np.asarray(frequency, dtype=float)
    k = wavenumber(w, depth, gravity)
    kh = np.minimum(k * depth, _DEEP)
    return np.asarray(0.5 * w / k * (1.0 + 2.0 * kh / np.sinh(2.0 * kh)))


def wavelength(period: float, depth: float, gravity: float) -> float:
    """Length m of a wave of a period s."""
    return float(2.0 * np.pi / wavenumber(2.0 * np.pi / period, depth, gravity))
