"""The flow about surfaces at one instant: wind, wake and bound vortices together.

A ``separation`` brings the lift of the sections to their polars.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from galerna.aero.vortex.chordwise import AlongChords, ChordPoints
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.quasi_steady import strip_velocities
from galerna.aero.vortex.separation import Separation
from galerna.aero.vortex.shedding import EdgePanels
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import (
    Surface,
    collocation_normals,
    collocation_points,
    collocation_velocities,
    segment_points,
    segment_velocities,
    split_panels,
)
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array, Inflow
from galerna.errors import InputError


@dataclass(frozen=True, eq=False)
class Flow:
    """The flow about surfaces at one instant.

    ``circulation`` (m,n) m2/s of each surface; ``wind`` and ``wake_velocity`` (P,3) m/s at
    ``control_points``: the N collocation points, then the middles of the loaded segments. The
    velocity is by the wake without the panels ``near`` the trailing edges, which hang on them.
    """

    circulation: list[Array]
    wind: Array
    wake_velocity: Array
    near: Sequence[Sheet] = ()


def control_points(surfaces: Sequence[Surface]) -> Array:
    """Points (P,3) m where the velocity of the air is needed: collocation and loaded segments."""
    return np.concatenate([collocation_points(surfaces), segment_points(surfaces)])


def wind_at(
    inflow: Inflow, points: Array, time: float, surfaces: Sequence[Surface], names: Sequence[str]
) -> Array:
    """Wind (P,3) m/s at control points; InputError that says where it is not finite."""
    wind = np.asarray(inflow.velocity(points, time), dtype=float)
    faults = np.flatnonzero(~np.isfinite(wind).all(axis=1))
    if len(faults):
        place = np.array2string(points[faults[0]], precision=4)
        raise InputError(
            f"inflow at {_whose(int(faults[0]), surfaces, names)}",
            f"the wind at {place} m and t = {time:.6g} s is not a number",
        )
    return wind


def bound_flow(
    system: BoundSystem,
    surfaces: Sequence[Surface],
    wind: Array,
    wake_velocity: Array,
    separation: Separation | None = None,
) -> Flow:
    """The flow with a wake that is known."""
    circulation = system.solve(_needed_velocity(surfaces, wind + wake_velocity))
    if separation is not None:
        response = separation.response(system.solve, surfaces)
        circulation = separation.correct(surfaces, wind, circulation, response)
    return Flow(split_panels(circulation, surfaces), wind, wake_velocity)


class EdgeInfluence(NamedTuple):
    """Normal velocities by the first panels of wakes, as `EdgePanels.normal_velocity` has them.

    ``shares`` are None where nothing of the circulation sought is in the panels; ``response`` is
    that of the `Separation`, if there is one, with the shares in it.
    """

    known: Array
    shares: Array | None
    response: Array | None


def edge_influence(
    system: BoundSystem,
    surfaces: Sequence[Surface],
    edges: Sequence[EdgePanels],
    mirror: MirrorPlane | None,
    separation: Separation | None = None,
) -> EdgeInfluence:
    """What the first panels of all wakes do at the collocation points: (N,) m/s and (N,n) 1/m."""
    points, normals = collocation_points(surfaces), collocation_normals(surfaces)
    pairs = [e.normal_velocity(points, normals, mirror) for e in edges]
    known = np.sum([known for known, _ in pairs], axis=0)
    strips = np.hstack([share for _, share in pairs])
    shares, response = strips if strips.any() else None, None
    if separation is not None:
        response = separation.response(partial(system.solve, strips=shares), surfaces)
    return EdgeInfluence(known, shares, response)


def edge_flow(
    system: BoundSystem,
    surfaces: Sequence[Surface],
    wind: Array,
    far_velocity: Array,
    edges: Sequence[EdgePanels],
    influence: EdgeInfluence,
    separation: Separation | None = None,
) -> Flow:
    """The flow with a wake whose first panels depend on the circulation sought."""
    needed = _needed_velocity(surfaces, wind + far_velocity) - influence.known
    solved = system.solve(needed, influence.shares)
    if separation is not None:
        assert influence.response is not None, "edge_influence takes the separation too"
        solved = separation.correct(surfaces, wind, solved, influence.response)
    circulation = split_panels(solved, surfaces)
    near = [e.sheet(g[-1]) for e, g in zip(edges, circulation, strict=True)]
    return Flow(circulation, wind, far_velocity, near)


def strip_flow(
    system: BoundSystem,
    surfaces: Sequence[Surface],
    wind: Array,
    wake: Wake,
    core: VortexCore | None,
    mirror: MirrorPlane | None,
    separation: Separation | None = None,
) -> Flow:
    """The flow with a wake whose strips carry the circulation of the trailing edges."""
    strips = strip_velocities(wake, control_points(surfaces), core, mirror)
    normals = collocation_normals(surfaces)
    normal_strips = np.einsum("pni,pi->pn", strips[: len(normals)], normals)
    solve = partial(system.solve, strips=normal_strips)
    circulation = solve(_needed_velocity(surfaces, wind))
    if separation is not None:
        response = separation.response(solve, surfaces)
        circulation = separation.correct(surfaces, wind, circulation, response)
    wake_velocity = np.einsum("pni,n->pi", strips, circulation[system.trailing_rings])
    return Flow(split_panels(circulation, surfaces), wind, wake_velocity)


class NearField:
    """Velocity at the loaded segments by what is bound and by the first panels of the wakes.

    With ``smooth`` the vortices of one blade are interpolated along the chords of another.
    """

    def __init__(self, mirror: MirrorPlane | None, smooth: bool) -> None:
        self._mirror, self._smooth = mirror, smooth
        self._sums: AlongChords | None = None

    def velocity(self, surfaces: Sequence[Surface], flow: Flow) -> Array:
        """Velocity (S,3) m/s; what was near to what at the first call is held to be so again."""
        bound = zip(surfaces, flow.circulation, strict=True)
        sheets = [Sheet(s.lattice.vertices, g) for s, g in bound] + list(flow.near)
        targets = [ChordPoints(s, collocated=False) for s in surfaces]
        if self._sums is None:
            self._sums = AlongChords(targets, sheets, self._field, self._smooth)
        near = "mixed" if self._smooth else "double"
        return np.concatenate(self._sums.velocity(targets, sheets, near))

    def _field(self, sheets: Sequence[Sheet], precision: str) -> InducedField:
        return InducedField(sheets, precision=precision, mirror=self._mirror)


def segment_air(surfaces: Sequence[Surface], flow: Flow, near: Array) -> Array:
    """Velocity (S,3) m/s of the air relative to the loaded segments, that of `NearField` added."""
    air = (flow.wind + flow.wake_velocity)[-len(near) :]
    return air + near - segment_velocities(surfaces)


def _needed_velocity(surfaces: Sequence[Surface], air: Array) -> Array:
    """Normal velocity (N,) m/s that the bound vortices must induce against the air's (P,3)."""
    velocity = collocation_velocities(surfaces)
    return np.einsum("ni,ni->n", velocity - air[: len(velocity)], collocation_normals(surfaces))


def _whose(point: int, surfaces: Sequence[Surface], names: Sequence[str]) -> str:
    """The surface, and the column where it is known, of a control point."""
    number = point
    for surface, name in zip(surfaces, names, strict=True):
        m, n = surface.shape
        if number < m * n:
            return f"{name}, panel column {number % n + 1} of {n}"
        number -= m * n
    for surface, name in zip(surfaces, names, strict=True):
        m, n = surface.shape
        if number < m * n + m * (n + 1):
            column = number % n if number < m * n else (number - m * n) % (n + 1)
            return f"{name}, panel column {min(column, n - 1) + 1} of {n}"
        number -= m * n + m * (n + 1)
    return names[-1]
