"""Rotations: the conversions that the whole machine shares."""

from __future__ import annotations

import numpy as np
from numba import njit

from galerna.contract import Array


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
