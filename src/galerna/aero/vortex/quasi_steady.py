"""A wake that has always had the present circulation (dissertation 4.2.3).

Its strips, from the trailing edge to the end, carry the circulation of the trailing edge; it
starts an unsteady simulation without a transient, and in every step of a quasi-steady one it
takes the place of the wake's own history.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.influence import strip_influence
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array


def strip_velocities(
    wake: Wake, points: Array, core: VortexCore | None = None, mirror: MirrorPlane | None = None
) -> Array:
    """Velocity (k,N,3) 1/m at points (k,3) m of each strip of circulation 1, of all surfaces."""
    velocities = []
    for x, radius in zip(wake.vertices, wake.core_radius(core), strict=True):
        velocity = strip_influence(x, points, radius)
        if mirror is not None:
            image = strip_influence(x, mirror.reflect_points(points), radius)
            velocity += mirror.reflect_vectors(image)
        velocities.append(velocity)
    return np.concatenate(velocities, axis=1)


def steady_wake(wake: Wake, trailing: list[Array]) -> Wake:
    """The wake with the circulations (n,) m2/s of the trailing edges all along its strips."""
    circulation = tuple(
        np.tile(edge, (len(g), 1)) for edge, g in zip(trailing, wake.circulation, strict=True)
    )
    return replace(wake, circulation=circulation)
