"""How the fluid of a wake moves: with the wind, or with the whole velocity; schemes in time.

Over a wake step h from the shed wake, whose velocity is u_0, the fluid moves by e times a mean
velocity while a time e elapses:

    Euler            u_0                                      error O(h)                   (1)
    Adams-Bashforth  u_0 + e/2 (u_0 - u_-1) / h_-1            error O(h^2)                 (2)
    Heun             (u_0 + u_1) / 2                          error O(h^2)                 (3)

u_-1 is the velocity that the same fluid had a step h_-1 before, u_1 the velocity it has where
eq. (1) takes it; u_1 costs another evaluation and serves the accepted step alone.

Behind the near wake panels are wider than a step, and fluid takes several steps to cross one.
Rows there can take a new induced velocity once in that period, in turn, and keep theirs, as seen
from the rotor, in between (`due_rows`): most of a wake then moves at a fraction of the cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.thinning import turned
from galerna.aero.vortex.wake import Wake, interpolated
from galerna.contract import Array
from galerna.errors import ConvergenceError

Integers = NDArray[np.int64]
SCHEMES = ("adams_bashforth", "heun", "euler")
DIVERGED = 10.0  #: times the highest speed of wind and surfaces that no vortex induces


@dataclass(frozen=True, eq=False)
class Convection:
    """Velocities (K+1,n+1,3) m/s of the vertices of a shed wake, one array a surface.

    ``acceleration`` m/s2 of the fluid along its way, None for a first-order scheme; ``axis`` that
    of the rotor at the shedding; ``induced`` (S,n+1,3) m/s at the summed rows, to keep in turn.
    """

    velocity: tuple[Array, ...]
    acceleration: tuple[Array, ...] | None = None
    axis: RotorAxis | None = None
    induced: tuple[Array, ...] = ()

    def mean(self, elapsed: float) -> tuple[Array, ...]:
        """Mean velocity over the first ``elapsed`` s, eqs. (1) and (2)."""
        if self.acceleration is None:
            return self.velocity
        pairs = zip(self.velocity, self.acceleration, strict=True)
        return tuple(u + 0.5 * elapsed * a for u, a in pairs)


@dataclass(frozen=True, eq=False)
class Earlier:
    """Velocities (K+1,n+1,3) that the fluid now in a wake's rows had ``step`` s before.

    Row 0 is new fluid, which has no past. ``induced`` is the velocity at summed rows then, turned
    on with the rotor.
    """

    velocity: tuple[Array, ...]
    step: float
    induced: tuple[Array, ...] = ()

    def acceleration(self, velocity: Sequence[Array]) -> tuple[Array, ...]:
        """Backward difference of the fluid's velocity, zero in row 0."""
        change = tuple(
            (u - past) / self.step for u, past in zip(velocity, self.velocity, strict=True)
        )
        for a in change:
            a[0] = 0.0
        return change


def earlier(convection: Convection, fraction: Array, step: float) -> Earlier:
    """What velocities become for the rows of the wake that Courant numbers (K,) have remade."""
    velocity = tuple(interpolated(u, fraction) for u in convection.velocity)
    return Earlier(velocity, step, turned(convection.induced, convection.axis, step))


def corrected(start: Sequence[Array], end: Sequence[Array], fraction: Array) -> tuple[Array, ...]:
    """Eq. (3) for the fluid of the rows at the start, ``end`` being velocities of remade rows.

    The fluid of row k has come to between the new rows k and k+1; that of the last row has left.
    """
    velocities = []
    for u, v in zip(start, end, strict=True):
        arrived = v.copy()
        arrived[:-1] += fraction[:, None, None] * (v[1:] - v[:-1])
        velocities.append(0.5 * (u + arrived))
    return tuple(velocities)


def periods(ages: Array) -> Integers:
    """Wake steps (K+1,) in which the fluid crosses the panel upstream of each row, rounded down.

    Row 0 is crossed in every step.
    """
    width = np.diff(ages)
    steps = np.floor(width / width[0] * (1.0 + 1e-9)).astype(np.int64)
    return np.concatenate([[1], np.maximum(steps, 1)])


def due_rows(ages: Array, sheds: int) -> Integers:
    """Rows whose velocity is renewed after so many ``sheds``: all once in their period, in turn."""
    period = periods(ages)
    return np.flatnonzero((sheds + np.arange(len(period))) % period == 0)


def renewed(past: Sequence[Array], velocity: Sequence[Array], rows: Integers) -> tuple[Array, ...]:
    """Velocities (S,n+1,3) of the ``past``, with new ones in some ``rows``."""
    both = []
    for before, new in zip(past, velocity, strict=True):
        both.append(before.copy())
        both[-1][rows] = new
    return tuple(both)


def require_calm(
    wake: Wake,
    velocity: Sequence[Array],
    rows: Integers,
    speed: float,
    time: float,
    names: Sequence[str],
) -> None:
    """Raise ConvergenceError where the induced velocity of a wake shows that it diverges.

    ``velocity`` (len(rows),n+1,3) m/s is induced at the vertices of some ``rows``, ``speed`` m/s
    the highest of the wind and of the surfaces in it.
    """
    for name, x, u in zip(names, wake.vertices, velocity, strict=True):
        size = np.einsum("kji,kji->kj", u, u)
        if np.all(size <= (DIVERGED * speed) ** 2):
            continue
        number, column = np.unravel_index(
            np.argmax(np.where(np.isnan(size), np.inf, size)), size.shape
        )
        row, fast = rows[number], np.sqrt(size[number, column])
        place = np.array2string(x[row, column], precision=4)
        raise ConvergenceError(
            f"wake of {name}, row {row} (age {wake.ages[row]:.4g} s), column {column}",
            f"the vortices move the fluid at {place} m with {fast:.4g} m/s, beyond {DIVERGED:g} "
            f"times the {speed:.4g} m/s of wind and surfaces: the wake diverges",
            "give its vortices a thicker core, take a smaller time step, or prescribe the wake",
            time,
        )
