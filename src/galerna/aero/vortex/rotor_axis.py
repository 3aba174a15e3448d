"""The axis about which a rotor turns."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from galerna.contract import Array


@dataclass(frozen=True, eq=False)
class RotorAxis:
    """A rotor's axis: a point (3,) m, the unit direction (3,) and the ``speed`` rad/s about it.

    ``velocity`` (3,) m/s is that of the point.
    """

    origin: Array
    direction: Array
    speed: float = 0.0
    velocity: Array = field(default_factory=lambda: np.zeros(3))
