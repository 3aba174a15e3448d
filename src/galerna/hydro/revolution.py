"""Bodies of revolution: from waves along x and motions in their plane to all others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.contract import Array
from galerna.hydro.database import HydroDatabase
from galerna.hydro.rigid import turn


def whole_of_revolution(base: HydroDatabase, headings: Array) -> HydroDatabase:
    """The whole of a body of revolution from its motions in the plane of waves along x."""

    def both(a: Array) -> Array:
        """Sway and roll are surge and pitch turned by a quarter; heave stands alone."""
        plane = np.zeros_like(a)
        for i, j in ((0, 0), (0, 4), (4, 0), (4, 4)):
            plane[..., i, j] = a[..., i, j]
        quarter = turn(0.5 * np.pi)
        whole = plane + quarter @ plane @ quarter.T
        whole[..., 2, 2] = a[..., 2, 2]
        return np.where(np.abs(whole) < 1e-12 * np.nanmax(np.abs(whole)), 0.0, whole)

    turns = np.stack([turn(b) for b in headings])
    drift = base.mean_drift
    return replace(
        base,
        added_mass=both(base.added_mass),
        damping=both(base.damping),
        added_mass_infinite=both(base.added_mass_infinite),
        added_mass_zero=None if base.added_mass_zero is None else both(base.added_mass_zero),
        heading=headings,
        excitation=np.einsum("mij,nj->nmi", turns, base.excitation[:, 0]),
        mean_drift=None if drift is None else np.einsum("mij,nj->nmi", turns, drift[:, 0]),
    )
