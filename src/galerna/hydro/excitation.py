"""First-order wave loads: the database's transfer functions times the waves of a sea."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import Complex, HydroDatabase

from .heading import Bins
from .waves.sea import Sea
from .waves.series import Series

LEFT_OUT = 1e-3  #: of the elevation's variance, at most, may lie above a database's frequencies


def covered(database: HydroDatabase, sea: Sea) -> NDArray[np.bool_]:
    """Which waves (n,) the database's frequencies reach.

    Raises InputError with the figures where more of the variance lies above them than may.
    """
    last = float(database.frequency[-1])
    inside = np.asarray(sea.frequency <= last)
    energy = np.abs(sea.amplitude) ** 2
    beyond = float(energy[~inside].sum() / max(energy.sum(), 1e-300))
    if beyond > LEFT_OUT:
        raise InputError(
            "sea",
            f"{beyond:.2%} of the waves' variance lies above {last:.4g} rad/s, where the "
            f"hydrodynamic database ends (waves go up to {sea.frequency.max():.4g} rad/s)",
            "compute the database up to higher frequencies (galerna hydro), or choose longer waves",
        )
    return inside


class WaveExcitation:
    """Force (6,) of the waves in axes of the platform's heading, between ready-made headings."""

    def __init__(self, database: HydroDatabase, sea: Sea) -> None:
        self.database, self.sea = database, sea
        self._inside = covered(database, sea)
        self._bins = Bins(self._series)
        self._bins.around(0.0)

    def transfer(self, heading: float) -> Complex:
        """N/m and N (n,6) of each wave on a platform with a heading rad, in its axes."""
        found = np.zeros((len(self.sea.frequency), 6), dtype=complex)
        w, towards = self.sea.frequency[self._inside], self.sea.direction[self._inside]
        found[self._inside] = self.database.excitation_at(w, towards - heading)
        return found * self.sea.spread(self.database.reference_point[:2])

    def _series(self, heading: float) -> Series:
        return self.sea.series(self.transfer(heading))

    def at(self, time: float, heading: float) -> Array:
        """N, N m (6,) at a time s and a heading rad."""
        below, above, share = self._bins.around(heading)
        return (1.0 - share) * below.at(time) + share * above.at(time)

    @property
    def notes(self) -> tuple[str, ...]:
        """How many waves act without a load, above the database's frequencies."""
        left = int((~self._inside).sum())
        what = f"{left} waves above the database's last frequency bring no excitation"
        return (what,) if left else ()
