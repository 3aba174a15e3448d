"""The straight part of a polar: what attached flow would lift at any angle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BELOW, ABOVE = np.radians(2.0), np.radians(8.0)  #: of the zero of the lift, where flow is attached


def attached_line(angle: Array, lift: Array, near: float = 0.0) -> tuple[float, float]:
    """Zero-lift angle rad and slope 1/rad of the attached lift: a line of least squares.

    ``angle`` (m,) rad rises, ``lift`` (m,) is cl. The line runs from BELOW under to ABOVE
    over the rising zero of the lift nearest to ``near`` rad. (near, 0) where there is none,
    as for a cylinder.
    """
    left = np.flatnonzero((lift[:-1] <= 0.0) & (lift[1:] > 0.0))
    if len(left) == 0:
        return float(near), 0.0
    share = -lift[left] / (lift[left + 1] - lift[left])
    zeros = angle[left] + share * (angle[left + 1] - angle[left])
    zero = float(zeros[np.argmin(np.abs(zeros - near))])
    around = np.linspace(zero - BELOW, zero + ABOVE, 61)
    slope, offset = np.polyfit(around, np.interp(around, angle, lift), 1)
    return (float(-offset / slope), float(slope)) if slope > 0.0 else (zero, 0.0)
