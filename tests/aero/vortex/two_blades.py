"""A rotor of two plain blades for tests of wakes."""

from __future__ import annotations

import numpy as np

from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.surface import Surface

AXIS = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), 1.0)


def rotor(azimuth: float, rows: int = 8, columns: int = 12) -> list[Surface]:
    """Two blades of chord 2 m from 5 to 30 m, pitched by 6 degrees, that turn about x."""
    along, radius = np.linspace(-0.5, 1.5, rows + 1), np.linspace(5.0, 30.0, columns + 1)
    blade = np.zeros((rows + 1, columns + 1, 3))
    blade[..., 0] = 0.1 * along[:, None]
    blade[..., 1], blade[..., 2] = along[:, None], radius
    surfaces = []
    for turn in (azimuth, azimuth + np.pi):
        c, s = np.cos(turn), np.sin(turn)
        corners = blade @ np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]]).T
        surfaces.append(Surface.turning(corners, AXIS.speed * AXIS.direction))
    return surfaces
