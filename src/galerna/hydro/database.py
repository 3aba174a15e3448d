"""Potential-flow coefficients of a platform: what panel codes compute and files hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class HydroDatabase:
    """First-order coefficients about ``reference_point`` (3,) m, in SI, axes of the platform.

    ``frequency`` (n,) rad/s rises and is finite and positive; ``added_mass`` and ``damping``
    (n,6,6), ``added_mass_infinite`` and ``added_mass_zero`` (6,6) in kg, kg m, kg m2 and per
    second. ``heading`` (m,) rad rises: where the waves go, 0 along +x. ``excitation`` (n,m,6)
    N/m, N: an elevation Re[a exp(i w t)] above the reference point gives Re[a X exp(i w t)],
    which is WAMIT's convention. ``hydrostatic_stiffness`` (6,6) is of buoyancy alone: minus the
    rate of its force and moment over the motion, without any weight. ``mean_drift`` (n,m,6)
    N/m2 is the mean second-order force in regular waves over the amplitude's square.
    """

    frequency: Array
    added_mass: Array
    damping: Array
    added_mass_infinite: Array
    heading: Array
    excitation: Complex
    hydrostatic_stiffness: Array
    displaced_volume: float
    center_of_buoyancy: Array
    reference_point: Array
    water_depth: float
    water_density: float = 1025.0
    gravity: float = 9.80665
    added_mass_zero: Array | None = None
    mean_drift: Array | None = None
    settings: Mapping[str, str | float] = field(default_factory=dict)
