"""The wake that an unsteady rotor begins with: that of the steady rotor, so that little settles.

A free wake is found on a coarse lattice, in the part of the wind along the shaft, where the
rotor's flow is steady and one blade tells of all. How it drifts from the helix (eq. 8 of
``docs/theory/vortex.md``) varies slowly with age and span, and is carried over to the helix of
the whole lattice in the whole wind.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.free_wake import FreeWake
from galerna.aero.vortex.helix import carried, drifted_centre, turns
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.steady import solve_steady
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array
from galerna.units import DEG

Numbers = NDArray[np.int64]
COARSE_COLUMNS = 10  #: panels along the span
COARSE_TURN = 15.0 * DEG  #: of the rotor, between rows
TOLERANCE = 5e-3  #: of the radius, to which the coarse wake is found
SWEEPS = 20  #: after which the helix must do
FREE_SHARE = 0.5  #: of a short wake, that is free: its end is no place to be exact about


def drifted_wake(
    surfaces: Sequence[Surface],
    ages: Array,
    axis: RotorAxis,
    wind: Array,
    core: VortexCore | None,
) -> Wake:
    """A wake without circulation that lies like the free wake of the steady rotor.

    ``wind`` (3,) m/s, relative to the axis, carries it. Raises ConvergenceError where the steady
    wake is not found.
    """
    columns = _columns(surfaces[0].shape[1])
    rows = _rows(ages, axis)
    length = ages[-1] * np.linalg.norm(wind) / (2.0 * _radius(surfaces, axis))
    free = FreeWake(length=min(1.0, FREE_SHARE * length), tolerance=TOLERANCE, sweeps=SWEEPS)
    solved = solve_steady(
        [_coarser(s, columns, axis) for s in surfaces],
        (wind @ axis.direction) * axis.direction,
        axis=axis,
        ages=ages[rows],
        free=free,
        core=core,
    )
    vertices, drifts = [], []
    for surface, found in zip(surfaces, solved.wake.vertices, strict=True):
        helix = carried(ages[rows], found[0], solved.wind, axis)
        coarse = np.einsum("kab,knb->kna", turns(ages[rows], axis), found - helix)
        places = np.arange(surface.shape[1] + 1.0)
        across = _interpolated(coarse, columns.astype(float), places, 1)
        drift = _interpolated(across, ages[rows], ages, 0)
        moved = np.einsum("kba,knb->kna", turns(ages, axis), drift)
        vertices.append(carried(ages, surface.lattice.vertices[-1], wind, axis) + moved)
        drifts.append(drift)
    nothing = tuple(np.zeros((len(ages) - 1, s.shape[1])) for s in surfaces)
    centre = drifted_centre(ages, wind, drifts, axis)
    return Wake(ages, tuple(vertices), nothing, centre)


def _radius(surfaces: Sequence[Surface], axis: RotorAxis) -> float:
    arm = np.concatenate([s.lattice.corners.reshape(-1, 3) for s in surfaces]) - axis.origin
    across = arm - (arm @ axis.direction)[:, None] * axis.direction
    return float(np.linalg.norm(across, axis=1).max())


def _coarser(surface: Surface, columns: Numbers, axis: RotorAxis) -> Surface:
    """The surface with two panels along the chord and the columns given, about a still axis."""
    m = surface.shape[0]
    rows = np.unique([0, m // 2, m])
    part = np.ix_(rows, columns)
    return Surface(Lattice(surface.lattice.corners[part]), surface.velocity[part] - axis.velocity)


def _columns(panels: int) -> Numbers:
    """Numbers of the columns that a coarse lattice keeps, root and tip among them."""
    return np.unique(np.linspace(0, panels, min(panels, COARSE_COLUMNS) + 1).round().astype(int))


def _rows(ages: Array, axis: RotorAxis) -> Numbers:
    """Numbers of the rows that stand COARSE_TURN apart or more, the ends among them."""
    kept = [0]
    for row in range(1, len(ages) - 1):
        if (ages[row] - ages[kept[-1]]) * abs(axis.speed) >= COARSE_TURN * (1.0 - 1e-9):
            kept.append(row)
    return np.array([*kept, len(ages) - 1])


def _interpolated(values: Array, known: Array, wanted: Array, along: int) -> Array:
    """Values at ``wanted`` from those at ``known`` places, linearly along an axis."""
    right = np.clip(np.searchsorted(known, wanted), 1, len(known) - 1)
    t = (wanted - known[right - 1]) / (known[right] - known[right - 1])
    t = t.reshape([-1 if i == along else 1 for i in range(values.ndim)])
    before, after = np.take(values, right - 1, along), np.take(values, right, along)
    return (1.0 - t) * before + t * after
