"""The wakes of several surfaces, whose rows are labelled by age.

Row k holds the fluid that left the trailing edge a_k ago; row 0 is the trailing edge itself.
While a time dt passes every vertex moves with the flow and ages by dt. The new row k, of age
a_k, then lies between the moved rows k (age a_k + dt) and k-1 (age a_{k-1} + dt), at the fraction

    C_k = dt / (a_k - a_{k-1})                                                             (1)

towards row k-1, and the circulation of the panel between rows k-1 and k becomes

    G_k <- (1 - C_k) G_k + C_k G_{k-1},    G_0 the trailing edge's over dt                 (2)

which is the dissertation's convection equation with its Courant number (eq. 4.4) and, in the same
fraction, its remeshing (4.1.2). It conserves the sum of G_k (a_k - a_{k-1}) but for what enters
and leaves. With equal panels of age dt, C = 1 and rows shift (eq. 2.71).

Straight interpolation would cut corners in every step, and a wake that slows down would lie too
near to the rotor. Rows are interpolated by a parabola through the next older one, with w the
panels' widths and r = w_k / w_{k+1}:

    x <- (1 - C_k) x_k + C_k x_{k-1} - b [(x_{k+1} - x_k) - (x_k - x_{k-1})/r],
    b = C_k (1 - C_k) r^2/(1 + r)                                                          (3)

For a rotor x is the way along the axis, the radius and the angle about the rows' centre (slerp,
eq. 4.6), so that a helix stays the same helix.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, sin, sqrt

import numpy as np
from numba import njit

from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.helix import carried
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.sheet import Sheet
from galerna.contract import Array
from galerna.errors import InputError

STEP_TOLERANCE = 1e-6  #: of the first panel's age, by which a step may exceed it
THINNEST = 0.25  #: of the way that fluid has gone from the edge: no core is thicker


@dataclass(frozen=True, eq=False)
class Wake:
    """Wakes of surfaces with n panels across: K+1 rows of common ``ages`` (K+1,) s, from 0.

    ``vertices`` (K+1,n+1,3) m and ``circulation`` (K,n) m2/s for each surface; ``centre``
    (K+1,3) m, what a rotor's rows turn about, moves with the fluid too.
    """

    ages: Array
    vertices: tuple[Array, ...]
    circulation: tuple[Array, ...]
    centre: Array | None = None

    @property
    def step(self) -> float:
        """The age of the first panel, s: the longest step."""
        return float(self.ages[1])

    @property
    def panels(self) -> int:
        """Number of panels of all surfaces."""
        return sum(g.size for g in self.circulation)

    def advanced(
        self,
        velocity: Sequence[Array],
        elapsed: float,
        shed: Sequence[Array],
        axis: RotorAxis | None = None,
    ) -> Wake:
        """The wake ``elapsed`` s later; row 0 of its vertices is where the fluid carried it.

        ``velocity`` (K+1,n+1,3) m/s moves the vertices; ``shed`` (n,) m2/s is the mean circulation
        of the trailing edge in this time. Raises InputError for a step beyond the first panel.
        """
        fraction = courant_numbers(self.ages, elapsed)
        origins, centre = self._centres(velocity, elapsed, fraction, axis)
        direction = np.zeros(3) if axis is None else axis.direction
        vertices = tuple(np.empty_like(x) for x in self.vertices)
        circulation = tuple(np.empty_like(g) for g in self.circulation)
        for s, (x, u, g) in enumerate(zip(self.vertices, velocity, self.circulation, strict=True)):
            _move(x, u, elapsed, self.ages, fraction, origins, direction, vertices[s])
            _convect(g, shed[s], fraction, circulation[s])
        return replace(self, vertices=vertices, circulation=circulation, centre=centre)

    def _centres(
        self, velocity: Sequence[Array], elapsed: float, fraction: Array, axis: RotorAxis | None
    ) -> tuple[Array, Array | None]:
        """Moved centres (K+1,3) that rows turn about, and those of the new rows."""
        if axis is None or self.centre is None:
            return np.zeros((len(self.ages), 3)), None
        moved = self.centre + elapsed * sum(u.mean(axis=1) for u in velocity) / len(velocity)
        moved[0] += axis.origin - self.centre[0]
        return moved, interpolated(moved, fraction)

    def attach(self, edges: Sequence[Array]) -> None:
        """Put row 0 on the trailing edges (n+1,3) m of the surfaces."""
        for x, edge in zip(self.vertices, edges, strict=True):
            x[0] = edge

    def core_radius(self, core: VortexCore | None, edge: float = 0.0) -> tuple[Array | float, ...]:
        """Core radii (K+1,1) m of each surface's rows, from their age and strongest circulation.

        Row 0 takes that of the bound ring's ``edge`` m with which it coincides. Behind a bound
        vortex without a core they grow as `THINNEST` says, or they would blunt what the sheet
        does to the surface that has just shed it.
        """
        if core is None:
            return tuple(0.0 for _ in self.vertices)
        return tuple(
            _row_cores(core, self.ages, x, g, edge)
            for x, g in zip(self.vertices, self.circulation, strict=True)
        )

    def sheets(
        self, core: VortexCore | None = None, *, rows: slice = slice(None), edge: float = 0.0
    ) -> list[Sheet]:
        """What induces velocity: a sheet of each surface, of the panels ``rows`` alone."""
        first, last, _ = rows.indices(len(self.ages) - 1)
        vertices = tuple(x[: last + 1] for x in self.vertices)
        circulation = tuple(g[:last] for g in self.circulation)
        newer = replace(
            self, ages=self.ages[: last + 1], vertices=vertices, circulation=circulation
        )
        return [
            Sheet(x[first:], g[first:], r if isinstance(r, float) else r[first:])
            for x, g, r in zip(vertices, circulation, newer.core_radius(core, edge), strict=True)
        ]


def straight_wake(ages: Array, edges: Sequence[Array], drift: Sequence[Array]) -> Wake:
    """A wake without circulation behind trailing edges (n+1,3) m, which drift away from it.

    ``drift`` (n+1,3) m/s is the wind less the velocity of the edge, for each surface.
    """
    vertices = (carried(ages, edge, away) for edge, away in zip(edges, drift, strict=True))
    return Wake(np.asarray(ages, float), tuple(vertices), _nothing(ages, edges))


def helical_wake(ages: Array, edges: Sequence[Array], axis: RotorAxis, wind: Array) -> Wake:
    """A wake without circulation that trailing edges (n+1,3) m leave in turning about an axis.

    The ``wind`` (3,) m/s, relative to the axis, carries it away.
    """
    vertices = (carried(ages, edge, wind, axis) for edge in edges)
    centre = axis.origin + ages[:, None] * wind
    return Wake(np.asarray(ages, float), tuple(vertices), _nothing(ages, edges), centre)


def _nothing(ages: Array, edges: Sequence[Array]) -> tuple[Array, ...]:
    return tuple(np.zeros((len(ages) - 1, len(edge) - 1)) for edge in edges)


def courant_numbers(ages: Array, elapsed: float) -> Array:
    """C_k (K,) of eq. (1); InputError where a step is longer than the first panel."""
    width = np.diff(ages)
    if np.any(width <= 0.0) or width.min() < width[0] * (1.0 - STEP_TOLERANCE):
        raise InputError("ages of the wake", "a panel is narrower than the first", "let them grow")
    if elapsed > width[0] * (1.0 + STEP_TOLERANCE):
        raise InputError(
            "time step",
            f"{elapsed:.6g} s moves the trailing edge by more than the first wake panel, which is "
            f"{width[0]:.6g} s wide",
            f"use a step of at most {width[0]:.6g} s, or wider wake panels",
        )
    fraction = elapsed / width
    fraction[fraction > 1.0 - STEP_TOLERANCE] = 1.0
    return fraction


def interpolated(moved: Array, fraction: Array) -> Array:
    """Rows (K+1,...) at their own ages from moved rows, linearly; row 0 stays."""
    out = moved.copy()
    weight = fraction.reshape(-1, *(1,) * (moved.ndim - 1))
    out[1:] += weight * (moved[:-1] - moved[1:])
    return out


def _row_cores(
    core: VortexCore, ages: Array, vertices: Array, circulation: Array, edge: float
) -> Array:
    strongest = np.abs(circulation).max(axis=1)
    radius = core.radius(ages, np.concatenate([strongest[:1], strongest]))
    radius[0] = edge
    way = 0.0
    for k in range(1, len(ages) if edge == 0.0 else 0):
        way += float(np.linalg.norm(vertices[k] - vertices[k - 1], axis=1).mean())
        if radius[k] <= THINNEST * way:
            break
        radius[k] = THINNEST * way
    return radius[:, None]


@njit(cache=True, error_model="numpy")
def _convect(circulation, shed, fraction, out):  # type: ignore[no-untyped-def]
    """Eq. (2)."""
    for k in range(circulation.shape[0]):
        for j in range(circulation.shape[1]):
            newer = shed[j] if k == 0 else circulation[k - 1, j]
            out[k, j] = circulation[k, j] + fraction[k] * (newer - circulation[k, j])
            if fraction[k] == 1.0:
                out[k, j] = newer


@njit(cache=True, error_model="numpy")
def _move(x, velocity, elapsed, ages, fraction, origins, axis, out):  # type: ignore[no-untyped-def]
    """Move vertices and put the new rows between them, eq. (3)."""
    older, old, new = np.empty(3), np.empty(3), np.empty(3)
    turns = axis[0] != 0.0 or axis[1] != 0.0 or axis[2] != 0.0
    last = x.shape[0] - 1
    for j in range(x.shape[1]):
        for i in range(3):
            new[i] = out[0, j, i] = x[0, j, i] + elapsed * velocity[0, j, i]
            old[i] = x[1, j, i] + elapsed * velocity[1, j, i]
        for k in range(1, last + 1):
            behind = min(k + 1, last)
            for i in range(3):
                older[i] = x[behind, j, i] + elapsed * velocity[behind, j, i]
            c = fraction[k - 1]
            if c == 1.0:
                out[k, j] = new
            else:
                width = ages[k] - ages[k - 1]
                weight, ratio = 0.0, 1.0
                if k < last:
                    ratio = width / (ages[k + 1] - ages[k])
                    weight = c * (1.0 - c) * ratio * ratio / (1.0 + ratio)
                if turns:
                    _between_turns(
                        older, old, new, origins[behind], origins[k], origins[k - 1], axis,
                        c, weight, ratio, out[k, j],
                    )  # fmt: skip
                else:
                    for i in range(3):
                        out[k, j, i] = _between(older[i], old[i], new[i], c, weight, ratio)
            new[:] = old
            old[:] = older


@njit(cache=True, error_model="numpy")
def _between(older, old, new, c, weight, ratio):  # type: ignore[no-untyped-def]
    """Eq. (3) for one coordinate; ``weight`` 0 is linear."""
    return old + c * (new - old) - weight * ((older - old) - (old - new) / ratio)


@njit(cache=True, error_model="numpy")
def _between_turns(z, a, b, centre_z, centre_a, centre_b, axis, c, weight, ratio, out):  # type: ignore[no-untyped-def]
    """The point between a and b, z behind them: eq. (3) for the way along the axis, for the
    radius and for the angle about the centres.
    """
    p, q, o, side = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    along_a = _across(a, centre_a, axis, p)
    along_b = _across(b, centre_b, axis, q)
    along_z = _across(z, centre_z, axis, o)
    for i in range(3):
        side[i] = axis[i - 2] * p[i - 1] - axis[i - 1] * p[i - 2]
    radius = _length(p)
    if radius == 0.0:
        for i in range(3):
            out[i] = _between(z[i], a[i], b[i], c, weight, ratio)
        return
    newer, older = _angle(p, side, q), _angle(p, side, o)
    angle = _between(older, 0.0, newer, c, weight, ratio)
    stretch = _between(_length(o), radius, _length(q), c, weight, ratio) / radius
    along = _between(along_z, along_a, along_b, c, weight, ratio)
    for i in range(3):
        centre = _between(centre_z[i], centre_a[i], centre_b[i], c, weight, ratio)
        out[i] = centre + along * axis[i] + stretch * (cos(angle) * p[i] + sin(angle) * side[i])


@njit(cache=True, error_model="numpy")
def _across(point, centre, axis, arm):  # type: ignore[no-untyped-def]
    """Write the arm (3,) across the axis from the centre to a point; how far along it stands."""
    along = 0.0
    for i in range(3):
        arm[i] = point[i] - centre[i]
        along += arm[i] * axis[i]
    for i in range(3):
        arm[i] -= along * axis[i]
    return along


@njit(cache=True, error_model="numpy")
def _length(a):  # type: ignore[no-untyped-def]
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@njit(cache=True, error_model="numpy")
def _angle(p, side, q):  # type: ignore[no-untyped-def]
    """The angle from p to q, ``side`` being p turned by 90 degrees."""
    ahead = side[0] * q[0] + side[1] * q[1] + side[2] * q[2]
    return atan2(ahead, p[0] * q[0] + p[1] * q[1] + p[2] * q[2])
