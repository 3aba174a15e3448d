"""The sea as a sum of first-order waves."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.waves.current import Current
from galerna.hydro.waves.dispersion import wavenumber
from galerna.hydro.waves.series import Complex, Series, samples_needed, tabulate
from galerna.units import SEA_WATER, STANDARD_GRAVITY

_WHOLE = 1e-9  #: of a frequency, by which it may miss its multiple


@dataclass(frozen=True, eq=False)
class Sea:
    """n waves whose frequencies are whole multiples of 2 pi / ``period``, and a current.

    ``frequency`` (n,) rad/s rises; ``direction`` (n,) rad is where each wave goes, 0 along +x;
    ``amplitude`` (n,) m is complex: above a point (x, y) the elevation is
    Re sum a exp(i (w t - k (x cos + y sin))). It repeats after ``period`` s and grows over the
    first ``ramp`` s. ``depth`` m may be infinite. ``notes`` say what the sea is,
    ``warnings`` what to doubt. Raises InputError for frequencies off the grid.
    """

    frequency: Array
    direction: Array
    amplitude: Complex
    period: float
    depth: float
    gravity: float = STANDARD_GRAVITY
    density: float = SEA_WATER
    ramp: float = 0.0
    current: Current = field(default_factory=Current.none)
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        multiple = self.frequency * self.period / (2.0 * pi)
        off = np.abs(multiple - self.order) > _WHOLE * np.maximum(multiple, 1.0)
        if off.any() or np.any(np.diff(self.order, prepend=0) < 1):
            raise InputError(
                "sea",
                f"wave frequencies must rise on multiples of {2.0 * pi / self.period:.6g} rad/s",
                "give a period in which every wave has a whole number of cycles",
            )

    @classmethod
    def still(cls, depth: float, **other: Any) -> Sea:
        """Water without waves; ``other`` fields as those of the class."""
        none = np.zeros(0)
        return cls(none, none, none.astype(complex), 1.0, depth, **other)

    @classmethod
    def regular(
        cls,
        height: float,
        period: float,
        depth: float,
        direction: float = 0.0,
        phase: float = 0.0,
        **other: Any,
    ) -> Sea:
        """Waves of a height m and a period s; at a ``phase`` rad of 0 a crest is at x = t = 0."""
        amplitude = np.array([0.5 * height * np.exp(1j * phase)])
        return cls(
            np.array([2.0 * pi / period]), np.array([direction]), amplitude, period, depth, **other
        )

    @cached_property
    def order(self) -> NDArray[np.int64]:
        """Cycles (n,) of each wave in ``period``."""
        return np.rint(self.frequency * self.period / (2.0 * pi)).astype(np.int64)

    @cached_property
    def wavenumber(self) -> Array:
        """Wave numbers (n,) 1/m."""
        return wavenumber(self.frequency, self.depth, self.gravity)

    @property
    def is_still(self) -> bool:
        """Whether there are no waves."""
        return not np.any(self.amplitude)

    @property
    def variance(self) -> float:
        """Variance m2 of the elevation over a period."""
        return float(0.5 * np.sum(np.abs(self.amplitude) ** 2))

    def spread(self, points: ArrayLike) -> Complex:
        """exp(-i k (x cos + y sin)) (n,m): the phase at points (m,2) m against the origin's."""
        x, y = np.atleast_2d(np.asarray(points, dtype=float)).T
        ahead = np.outer(np.cos(self.direction), x) + np.outer(np.sin(self.direction), y)
        return np.asarray(np.exp(-1j * self.wavenumber[:, None] * ahead))

    def series(self, transfer: Complex) -> Series:
        """Re sum_j a_j H_j exp(i w_j t) over time for k transfers (n,k), with the ramp.

        Tabulated once by an inverse Fourier transform, in single precision, so densely that
        interpolation errs by less than 3e-4 of the standard deviation (series.TOLERANCE).
        """
        return self.tabulated(transfer, self.samples(transfer))

    def samples(self, transfer: Complex) -> int:
        """Samples over a period that these transfers (n,k) need."""
        weight = np.abs(self.amplitude[:, None] * transfer) ** 2
        return samples_needed(weight, self.frequency, self.order, self.period)

    def tabulated(self, transfer: Complex, samples: int) -> Series:
        """``series`` with a given number of samples over a period."""
        table = tabulate(self.amplitude[:, None] * transfer, self.order, samples)
        return Series(table, self.period / samples, self.ramp)

    def elevation_at(self, points: ArrayLike = (0.0, 0.0)) -> Series:
        """Elevation m above points (m,2) m over time."""
        return self.series(self.spread(points))
