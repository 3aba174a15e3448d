"""Waves on water of constant depth, as far as coefficients need them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array


def wavenumber(frequency: ArrayLike, depth: float, gravity: float) -> Array:
    """Wave number 1/m of w^2 = g k tanh(k h) for frequencies rad/s; the depth may be infinite."""
    deep = np.asarray(frequency, dtype=float) ** 2 / gravity
    if not np.isfinite(depth):
        return deep
    target = deep * depth
    kh = np.where(target > 1.0, target, np.sqrt(target))
    for _ in range(50):
        t = np.tanh(kh)
        slope = t + kh * (1.0 - t**2)
        kh = kh - (kh * t - target) / np.where(slope > 0.0, slope, 1.0)
    return np.asarray(kh / depth)


def group_velocity(frequency: ArrayLike, depth: float, gravity: float) -> Array:
    """Speed m/s at which the waves' energy travels."""
    w = np.asarray(frequency, dtype=float)
    k = wavenumber(w, depth, gravity)
    if not np.isfinite(depth):
        return 0.5 * w / k
    kh = np.minimum(k * depth, 300.0)
    return 0.5 * w / k * (1.0 + 2.0 * kh / np.sinh(2.0 * kh))
