"""A wake of many rows, few of which induce velocity and are given one: what is far may be coarse.

All rows of the wake are fluid, as far apart in age as steps are, so moving on is a shift and
spreads neither vorticity nor the shape of a wake that rolls up. Of these only some, ever
further apart, are summed, with the mean circulation of the panels between them. Chords would
cut short the arcs that they stand for. So a summed row does not lie at its fluid x_k but where
its chords have the mean place of all rows between, with m the mean of these along a panel:

    x_k + [(m - c)_before + (m - c)_behind] / 2,    c the middle of a chord                (1)

which on a circle, and on a helix, keeps the area about the axis but for an error of fourth order
in the panel's width. All rows follow the summed ones in the velocity that cubics in age give, as
seen from the rotor, where a wake hardly changes from row to row:

    u(a) = R(-a) sum_i w_i(a) R(a_i) u_i                                                   (2)

with R(a) the rotation by the rotor's speed times a.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from galerna.aero.vortex.helix import turns
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array
from galerna.errors import InputError

Integers = NDArray[np.int64]
STENCIL = 4  #: summed rows from which a velocity is interpolated


class Thinning:
    """Which ``rows`` (S,) of a wake with ``ages`` (K+1,) s are summed; all without any.

    Raises InputError for rows that do not rise from 0 and 1 to the last one.
    """

    def __init__(self, ages: Array, rows: Integers | None = None) -> None:
        self._whole = rows is None
        last = len(ages) - 1
        self.rows = np.arange(last + 1) if rows is None else np.asarray(rows, dtype=np.int64)
        sound = self.rows[0] == 0 and self.rows[-1] == last and np.all(np.diff(self.rows) > 0)
        if not (sound and self.rows[1] == 1):
            raise InputError(
                "summed rows of the wake", f"{self.rows}", f"let them rise from 0 and 1 to {last}"
            )
        self._all_ages, self.ages = ages, ages[self.rows]
        self._weights = np.zeros((0, 0)) if self._whole else _weights(ages, self.rows)

    def wake(self, wake: Wake) -> Wake:
        """The summed rows of a wake, eq. (1), with mean circulations of the panels between them."""
        if self._whole:
            return wake
        width, share = np.diff(self.ages), np.diff(self._all_ages)
        circulation = tuple(
            np.add.reduceat(share[:, None] * g, self.rows[:-1]) / width[:, None]
            for g in wake.circulation
        )
        centre = None if wake.centre is None else wake.centre[self.rows]
        vertices = tuple(x[self.rows] + self._bulge(x) for x in wake.vertices)
        return replace(
            wake, ages=self.ages, vertices=vertices, circulation=circulation, centre=centre
        )

    def _bulge(self, x: Array) -> Array:
        """How far (S,n+1,3) m summed rows have to lie beside their fluid (K+1,n+1,3) m, eq. (1)."""
        middles, number = 0.5 * (x[1:] + x[:-1]), np.diff(self.rows)[:, None, None]
        known = x[self.rows]
        missed = np.add.reduceat(middles, self.rows[:-1]) / number - 0.5 * (known[1:] + known[:-1])
        bulge = np.zeros_like(known)
        bulge[1:] += 0.5 * missed
        bulge[1:-1] += 0.5 * missed[1:]
        return bulge

    def everywhere(self, velocity: Sequence[Array], axis: RotorAxis | None) -> tuple[Array, ...]:
        """Velocities (K+1,n+1,3) m/s of all rows from those (S,n+1,3) of the summed, eq. (2)."""
        if self._whole:
            return tuple(velocity)
        turn = turns(self._all_ages, axis)
        return tuple(
            _turned(np.tensordot(self._weights, _turned(u, turn[self.rows]), 1), turn, back=True)
            for u in velocity
        )


def summed_rows(ages: Array) -> Integers:
    """The rows (S,) of a wake in equal steps ``ages[1]`` next to growing ``ages`` (S',) s."""
    return np.unique(np.round(ages / ages[1]).astype(np.int64))


def turned(velocity: Sequence[Array], axis: RotorAxis | None, elapsed: float) -> tuple[Array, ...]:
    """Velocities (S,n+1,3) m/s after the rotor has turned them on for ``elapsed`` s."""
    turn = turns(np.array([elapsed]), axis)[0]
    return tuple(u @ turn.T for u in velocity)


def _turned(velocity: Array, turn: Array, *, back: bool = False) -> Array:
    return np.einsum("kba,knb->kna" if back else "kab,knb->kna", turn, velocity)


def _weights(ages: Array, rows: Integers) -> Array:
    """Lagrange's weights (K+1,S) of summed rows for all rows, through the STENCIL nearest."""
    weights = np.zeros((len(ages), len(rows)))
    count = min(STENCIL, len(rows))
    first = np.searchsorted(rows, np.arange(len(ages)), side="right") - count // 2
    first = np.clip(first, 0, len(rows) - count)
    for k, start in enumerate(first):
        known = ages[rows[start : start + count]]
        for i in range(count):
            others = np.delete(known, i)
            weights[k, start + i] = np.prod((ages[k] - others) / (known[i] - others))
    return weights
