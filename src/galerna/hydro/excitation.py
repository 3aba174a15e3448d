"""First-order wave loads: the database's transfer functions times the waves of a sea."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import Complex, HydroDatabase

from .heading import BIN, Bins
from .waves.sea import Sea
from .waves.series import Series

LEFT_OUT = 0.01  #: of the variance of a force, at most, may come from above the frequencies
COUNTS = 1e-3  #: of the largest force along its kind of direction: smaller ones do not


def covered(database: HydroDatabase, sea: Sea) -> NDArray[np.bool_]:
    """Which waves (n,) the database's frequencies reach.

    Raises InputError with the figures where the waves above them may bring more of a force than
    may be left out: they are thought to act as strongly as those of the last frequency.
    """
    last = float(database.frequency[-1])
    inside = np.asarray(sea.frequency <= last)
    if inside.all():
        return inside
    share = _share_beyond(database, sea, inside)
    if share > LEFT_OUT:
        energy = np.abs(sea.amplitude) ** 2
        beyond = float(energy[~inside].sum() / energy.sum())
        raise InputError(
            "sea",
            f"{beyond:.2%} of the waves' variance lies above {last:.4g} rad/s, where the "
            f"hydrodynamic database ends (waves go up to {sea.frequency.max():.4g} rad/s), with up "
            f"to {share:.1%} of a force's variance",
            "compute the database up to higher frequencies (galerna hydro), or choose longer waves",
        )
    return inside


def _share_beyond(database: HydroDatabase, sea: Sea, inside: NDArray[np.bool_]) -> float:
    """Largest share of the variance of a force that the waves above the frequencies may bring."""
    w, last = sea.frequency, float(database.frequency[-1])
    acting = np.abs(database.excitation_at(np.minimum(w, last), sea.direction)) ** 2
    variance = acting * np.abs(sea.amplitude[:, None]) ** 2
    whole = variance.sum(axis=0)
    largest = np.repeat(whole.reshape(2, 3).max(axis=1), 3)
    counts = whole > COUNTS**2 * largest
    return float((variance[~inside].sum(axis=0)[counts] / whole[counts]).max(initial=0.0))


class WaveExcitation:
    """Force (6,) of the waves in axes of the platform's heading, between ready-made headings."""

    def __init__(self, database: HydroDatabase, sea: Sea) -> None:
        self.database, self.sea = database, sea
        self._inside = covered(database, sea)
        self._bins = Bins(self._series)
        self._bins.around(0.0)

    def prepare(self) -> None:
        """Make the headings beside 0 too: what the database lacks there is told at once."""
        for side in (-BIN, BIN):
            self._bins.around(side)

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
