"""Where a steady wake lies: carried by the wind and by what all vortices induce on it.

In steady flow about a rotor's axis the row of age a is where the trailing edge was a ago, carried
by all velocities met since. Seen turned back by the angle that the rotor made in that time, every
fluid particle has taken the same path, so that with R(a) the rotation by the rotor's speed
times a, the row

    x(a) = c + R(-a) (x(0) - c) + a U + R(-a) E(a),   dE/da = R(a) u(x(a))                (8)

with U the wind and u the induced velocity. A wing is the case R = 1.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.contract import Array


def turns(ages: Array, axis: RotorAxis | None) -> Array:
    """R(a) (K+1,3,3) of ages (K+1,) s; the identity without an axis."""
    rate = np.zeros(3) if axis is None else axis.speed * np.asarray(axis.direction)
    return Rotation.from_rotvec(np.asarray(ages)[:, None] * rate).as_matrix()


def carried(ages: Array, edge: Array, wind: Array, axis: RotorAxis | None = None) -> Array:
    """Rows (K+1,n+1,3) m that a trailing edge (n+1,3) m leaves in a wind (3,) m/s, E = 0."""
    center = np.zeros(3) if axis is None else np.asarray(axis.origin)
    back = np.einsum("kba,nb->kna", turns(ages, axis), edge - center)
    return center + back + np.asarray(ages)[:, None, None] * wind


def drifted_centre(ages: Array, wind: Array, drifts: Sequence[Array], axis: RotorAxis) -> Array:
    """Centres (K+1,3) m of the rows: carried along the axis as the rows are in the mean."""
    mean = sum(e.mean(axis=1) for e in drifts) / len(drifts)
    along = (mean @ axis.direction)[:, None] * axis.direction
    return axis.origin + np.asarray(ages)[:, None] * wind + along
