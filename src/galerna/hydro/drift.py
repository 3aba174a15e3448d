"""Second-order drift of the waves: its mean, or slow with it by Newman's approximation.

The mean force in a regular wave is D(w) |a|^2. Newman (Int. Symp. Dynamics of Marine Vehicles,
1974) takes the force at a difference frequency from D alone; with the geometric mean of the two
waves' D the double sum is a product, |sum a sqrt(D) exp(i w t)|^2 (Standing, Brendling and
Wilson, OTC 5395, 1987). Its complex signal holds no sum frequencies. Where D changes its sign
the positive and the negative part have a product each.
"""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import HydroDatabase

from .excitation import covered
from .heading import Bins
from .waves.sea import Sea
from .waves.series import Series, growth


class _Drift:
    """Drift coefficients of the waves of a sea, by heading. InputError without any."""

    def __init__(self, database: HydroDatabase, sea: Sea) -> None:
        if database.mean_drift is None:
            what = "the hydrodynamic database holds no mean drift coefficients"
            hint = "compute them (galerna hydro), or say `drift: none`"
            raise InputError("platform.drift", what, hint)
        self.database, self.sea = database, sea
        self._inside = covered(database, sea)
        self._power = np.abs(sea.amplitude) ** 2
        self._means = Bins(self._mean)

    def coefficients(self, heading: float) -> Array:
        """D (n,6) N/m2, N/m of each wave on a platform with a heading rad, in its axes."""
        found = np.zeros((len(self._inside), 6))
        w, towards = self.sea.frequency[self._inside], self.sea.direction[self._inside]
        drift = self.database.drift_at(w, towards - heading)
        assert drift is not None
        found[self._inside] = drift
        return found

    def _mean(self, heading: float) -> Array:
        return self._power @ self.coefficients(heading)

    def mean(self, heading: float) -> Array:
        """Mean force (6,) N, N m at a heading rad, in its axes."""
        below, above, share = self._means.around(heading)
        return (1.0 - share) * below + share * above


class MeanDrift(_Drift):
    """The mean alone, from the start on: a platform begins where it holds the balance."""

    def at(self, time: float, heading: float) -> Array:
        """Force (6,) N, N m at a heading rad, in its axes."""
        return self.mean(heading)


class SlowDrift(_Drift):
    """Mean and slow drift. As long as waves grow at the start, the mean stands in for them."""

    def __init__(self, database: HydroDatabase, sea: Sea) -> None:
        super().__init__(database, sea)
        self._bins = Bins(self._series)
        self._bins.around(0.0)

    def _series(self, heading: float) -> Series:
        """Real, then imaginary parts of the signals of D > 0 and of D < 0."""
        D = self.coefficients(heading)
        roots = np.sqrt(np.hstack([np.maximum(D, 0.0), np.maximum(-D, 0.0)]))
        here = self.sea.spread(self.database.reference_point[:2])
        return self.sea.series(np.hstack([roots, -1j * roots]) * here)

    def at(self, time: float, heading: float) -> Array:
        """Force (6,) N, N m at a time s and a heading rad, in its axes."""
        below, above, share = self._bins.around(heading)
        slow = (1.0 - share) * _product(below, time) + share * _product(above, time)
        return slow + (1.0 - growth(time, self.sea.ramp) ** 2) * self.mean(heading)


def _product(series: Series, time: float) -> Array:
    """Squares of the signals (6,): those of D > 0 less those of D < 0."""
    square = series.at(time) ** 2
    positive, negative = (square[:12] + square[12:]).reshape(2, 6)
    return np.asarray(positive - negative)
