"""Which circulation the trailing edges leave in the wake, and how it stands close behind them.

On a lattice with vortices at the quarter of its panels all vorticity stands a quarter of a panel
upstream of where it belongs. The wake begins a quarter panel behind the trailing edge, where
fluid belongs that has left the edge half a panel before: what enters the wake at a time t is

    G(t - tau),    tau = c_p / (2 u)                                                       (1)

with G the circulation of the trailing ring, c_p the chord of the last panel and u the speed of the
air off the edge. For steps of one panel this is the classical rule (eq. 2.72); G is linear
between the ends of steps, so the circulation shed depends on the one sought.

A wake step on a rotor is many panels long, and vorticity at the edge counts most. The first panel
of the wake is therefore cut into rings that grow from c_p by doubling, each with the mean of
eq. (1) over the time in which it was shed; their sum is the panel's own circulation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.aero.vortex.influence import normal_influence
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface
from galerna.contract import Array

LONGEST_DELAY = 100.0  #: steps; more where the air hardly leaves the edge
MOST_RINGS = 8  #: in the first panel of a wake


@dataclass(frozen=True, eq=False)
class History:
    """Trailing circulation over time: unknown at the end of a step of ``dt`` s, known before.

    ``values`` (h,n) m2/s stood ``times`` (h,) s before the step's beginning, the newest first, at
    0. It is linear in between, and was the oldest for ever before.
    """

    dt: float
    times: Array
    values: Array

    def mean(self, start: Array, end: Array) -> tuple[Array, Array]:
        """The mean from ``start`` to ``end`` s ago, (...,n): a known part, and the share of now."""
        (known, new), (known_0, new_0) = self._integral(end), self._integral(start)
        return (known - known_0) / (end - start), (new - new_0) / (end - start)

    def _integral(self, ago: Array) -> tuple[Array, Array]:
        """The integral over the last ``ago`` s: a known part, and the weight of now."""
        step = np.minimum(ago, self.dt)
        fall = 0.5 * step**2 / self.dt
        known, rest = fall * self.values[0], np.maximum(ago - self.dt, 0.0)
        for i, length in enumerate(np.diff(self.times)):
            part = np.minimum(rest, length)
            slope = (self.values[i + 1] - self.values[i]) / length
            known += part * (self.values[i] + 0.5 * part * slope)
            rest = rest - part
        return known + rest * self.values[-1], step - fall

    def extended(self, value: Array, span: float) -> tuple[Array, Array]:
        """Times and values once the new one is known, as far as ``span`` s back."""
        times = np.concatenate([[0.0], self.times + self.dt])
        kept = int(np.searchsorted(times, span)) + 1
        return times[:kept], np.vstack([value, self.values])[:kept]


@dataclass(frozen=True, eq=False)
class Shedding:
    """What one surface sheds in a step: a ``known`` (n,) circulation plus a ``share`` of the new.

    ``delay`` (n,) s is tau of eq. (1), ``rows`` (q+1,) the places between which the first panel of
    the wake is cut into rings, from 0 to 1.
    """

    history: History
    delay: Array
    rows: Array
    known: Array
    share: Array

    def total(self, trailing: Array) -> Array:
        """Mean circulation (n,) shed, once the trailing one (n,) at the end is known."""
        return self.known + self.share * trailing


def shedding(
    surface: Surface, edge_velocity: Array, history: History, panel: float, classical: bool = False
) -> Shedding:
    """What a surface sheds into a first panel of the age ``panel`` s.

    ``edge_velocity`` (n+1,3) m/s is that of the fluid at the trailing edge. ``classical`` sheds
    the circulation at the beginning of the step, in one ring (eq. 2.72).
    """
    lattice = surface.lattice
    if classical or lattice.rings == "edges":
        before = history.values[0]
        nothing = np.zeros_like(before)
        return Shedding(history, nothing, np.array([0.0, 1.0]), before, nothing)
    off = edge_velocity - Lattice(surface.velocity, lattice.rings).vertices[-1]
    speed = np.linalg.norm(0.5 * (off[1:] + off[:-1]), axis=1)
    last = lattice.corners[-1] - lattice.corners[-2]
    chord = np.linalg.norm(0.5 * (last[1:] + last[:-1]), axis=1)
    longest = LONGEST_DELAY * history.dt
    delay = 0.5 * chord / np.maximum(speed, 0.5 * chord / longest)
    known, share = history.mean(delay, delay + history.dt)
    rings = np.clip(np.ceil(np.log2(0.5 * panel / delay.mean() + 1.0) - 0.05), 1, MOST_RINGS)
    rows = (2.0 ** np.arange(rings + 1) - 1.0) / (2.0**rings - 1.0)
    return Shedding(history, delay, rows, known, share)


@dataclass(frozen=True, eq=False)
class EdgePanels:
    """The first panels of a wake: rings between rows of ``vertices`` (q+1,n+1,3) m.

    Their circulations are ``known`` (q,n) m2/s plus ``share`` (q,n) times the trailing one.
    """

    vertices: Array
    core_radius: Array | float
    known: Array
    share: Array

    def normal_velocity(
        self, points: Array, normals: Array, mirror: MirrorPlane | None
    ) -> tuple[Array, Array]:
        """Normal velocities (N,) of the known part, (N,n) 1/m of the shares of circulation 1."""
        rings = normal_influence(self.vertices, points, normals, self.core_radius)
        if mirror is not None:
            image = mirror.reflect_points(points), mirror.reflect_vectors(normals)
            rings += normal_influence(self.vertices, *image, self.core_radius)
        shares = np.einsum("pqn,qn->pn", rings.reshape(len(points), *self.share.shape), self.share)
        return rings @ self.known.ravel(), shares

    def sheet(self, trailing: Array) -> Sheet:
        """The rings with their circulation, once the trailing one (n,) is known."""
        return Sheet(self.vertices, self.known + self.share * trailing, self.core_radius)


def edge_panels(shed: Shedding, wake: Sheet, panel: float) -> EdgePanels:
    """The first panel of a ``wake``, ``panel`` s old, cut into rings.

    The circulation of the sheet's first row lacks the share that depends on the new one.
    """
    rows, first = shed.rows, wake.vertices[:2]
    vertices = first[0] + rows[:, None, None] * (first[1] - first[0])
    core: Array | float = 0.0
    if np.ndim(wake.core_radius):
        square = np.asarray(wake.core_radius)[:2] ** 2
        core = np.sqrt(square[0] + rows[:, None] * (square[1] - square[0]))
    ages = panel * rows[:, None] + shed.delay
    known, share = np.empty((2, len(rows) - 1, len(shed.known)))
    known[:-1], share[:-1] = shed.history.mean(ages[:-2], ages[1:-1])
    width = np.diff(rows)
    new = shed.history.dt / panel * shed.share
    known[-1] = (wake.circulation[0] - width[:-1] @ known[:-1]) / width[-1]
    share[-1] = (new - width[:-1] @ share[:-1]) / width[-1]
    return EdgePanels(vertices, core, known, share)
