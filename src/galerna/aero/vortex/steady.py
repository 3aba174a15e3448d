"""Steady flow about wings and rotors, with a prescribed or a free wake.

The circulation of a steady wake is that of the trailing edge all along each strip, so the wake
enters the boundary condition as n strips and not as K x n rings (eq. 4). A free wake lies where
its own velocity carries it (eq. 8): the solution repeats flow and place until they agree.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vortex.ages import rotor_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.helix import carried, displaced, drift, drifted_centre
from galerna.aero.vortex.influence import strip_influence
from galerna.aero.vortex.loads import SurfaceLoads, lattice_loads
from galerna.aero.vortex.mirror import MirrorPlane
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
from galerna.aero.vortex.symmetry import RotationalSymmetry, sector_of
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.wake import RotorAxis, Wake
from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError
from galerna.units import AIR_DENSITY

WING_WAKE = 100.0  #: spans that the straight wake of a wing reaches downstream
Wind = Callable[[Array], Array]


@dataclass(frozen=True)
class FreeWake:
    """How a free wake is found: each iteration moves it by ``relaxation`` times what it lacks.

    It is found when no row lacks more than ``tolerance`` of the rotor's radius or the span (root
    mean square over the row). ``error`` and ``precision`` are those of ``InducedField`` for the
    velocity of the wake on itself.
    """

    relaxation: float = 0.3
    tolerance: float = 1e-4
    iterations: int = 200
    error: float | None = 1e-3
    precision: str = "single"


@dataclass(eq=False)
class SteadySolution:
    """Steady flow: all surfaces with their circulation (m,n) m2/s, wakes and loads.

    ``wind`` (3,) m/s is the undisturbed flow that carries the wake; ``iterations`` and
    ``history`` (what the wake lacked, of the radius) tell how a free wake was found.
    """

    surfaces: list[Surface]
    circulation: list[Array]
    wake: Wake
    loads: list[SurfaceLoads]
    wind: Array
    sheets: list[Sheet]
    air: Wind
    history: list[float]
    mirror: MirrorPlane | None = None
    error: float | None = 1e-3

    @property
    def iterations(self) -> int:
        """Iterations of the free wake; 0 for a prescribed one."""
        return len(self.history)

    @property
    def force(self) -> Array:
        """Total force (3,) N."""
        return np.sum([load.force for load in self.loads], axis=0)

    def moment(self, about: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
        """Total moment (3,) N m about a point (3,) m."""
        return np.sum([load.moment(about) for load in self.loads], axis=0)

    @property
    def drag(self) -> float:
        """Force along the wind, N."""
        return float(self.force @ self.wind / np.linalg.norm(self.wind))

    @property
    def lift(self) -> float:
        """Force across the wind on the side to which the surfaces' suction sides look, N."""
        along = self.wind / np.linalg.norm(self.wind)
        up = np.sum([s.lattice.area_vectors.sum(axis=(0, 1)) for s in self.surfaces], axis=0)
        up = up - (up @ along) * along
        return float(self.force @ up / np.linalg.norm(up))

    def velocity(self, points: ArrayLike) -> Array:
        """Velocity (...,3) m/s of the air at points (...,3) m."""
        points = np.asarray(points, dtype=float)
        field = InducedField(self.sheets, error=self.error, mirror=self.mirror)
        return field.velocity(points) + self.air(points)


def solve_steady(
    surfaces: Sequence[Surface | ArrayLike],
    velocity: ArrayLike | Wind,
    *,
    axis: RotorAxis | None = None,
    ages: ArrayLike | None = None,
    free: FreeWake | None = None,
    core: VortexCore | None = None,
    density: float = AIR_DENSITY,
    wake_velocity: ArrayLike | None = None,
    mirror: MirrorPlane | None = None,
    symmetry: bool = True,
) -> SteadySolution:
    """Steady flow about surfaces, each a `Surface` or its corners (m+1,n+1,3) m.

    ``velocity`` is the wind (3,) m/s, or a function of points (k,3) m. Corners turn with the
    ``axis`` of a rotor and stand still without one. The wake's rows have ``ages`` (K+1,) s: by
    default one long panel behind a wing, and `rotor_ages` behind a rotor. It goes with
    ``wake_velocity`` (3,) m/s, by default the mean wind at the surfaces, and ``free`` lets it go
    with all induced velocities too. A rotor in axial flow is solved for one blade unless
    ``symmetry`` is off.

    Raises InputError for surfaces, winds or ages that cannot be used, and ConvergenceError where
    a free wake is not found.
    """
    bodies = [s if isinstance(s, Surface) else _placed(s, axis) for s in surfaces]
    air = _wind(velocity)
    wind = _wake_wind(air, bodies, wake_velocity)
    sector = _sector(bodies, velocity, wind, axis) if symmetry and mirror is None else None
    times = _ages(bodies, wind, axis, free) if ages is None else np.asarray(ages, dtype=float)
    flow = _Flow(bodies, air, wind, axis, times, core, sector, mirror)
    flow.solve()
    history = [] if free is None else flow.relax(free)
    return flow.solution(density, history)


class _Flow:
    """The surfaces that are solved for, one sector of a symmetric rotor, and their wakes."""

    def __init__(
        self,
        surfaces: list[Surface],
        air: Wind,
        wind: Array,
        axis: RotorAxis | None,
        ages: Array,
        core: VortexCore | None,
        sector: RotationalSymmetry | None,
        mirror: MirrorPlane | None,
    ) -> None:
        self.all_surfaces = surfaces
        self.surfaces = surfaces if sector is None else surfaces[:1]
        self.air, self.wind, self.axis, self.ages = air, wind, axis, ages
        self.core, self.sector, self.mirror = core, sector, mirror
        self.points = collocation_points(self.surfaces)
        self.normals = collocation_normals(self.surfaces)
        relative = air(self.points) - collocation_velocities(self.surfaces)
        self.onset = np.einsum("ka,ka->k", relative, self.normals)
        self.rows = [carried(ages, s.lattice.vertices[-1], wind, axis) for s in self.surfaces]
        self.drifts = [np.zeros_like(x) for x in self.rows]
        self.system = BoundSystem(sector, mirror)
        self.system.place(self.surfaces)
        self.circulation: list[Array] = []
        n = sum(s.shape[1] for s in self.surfaces)
        self.trailing = np.zeros(n)

    def solve(self) -> None:
        """The circulation with the wake as it lies now."""
        strips = np.einsum("kja,ka->kj", self.strips(self.points), self.normals)
        flat = self.system.solve_with_strips(-self.onset, strips)
        self.circulation = split_panels(flat, self.surfaces)

    def strips(self, points: Array) -> Array:
        """Velocity (k,n,3) 1/m of each wake strip, images and all, of circulation 1."""
        radii = self.wake().core_radius(self.core)
        parts = []
        for rows, radius in zip(self.placed_rows(), radii, strict=True):
            part = np.zeros((len(points), rows.shape[1] - 1, 3))
            for vertices in self._images(rows):
                part += strip_influence(vertices, points, radius)
                if self.mirror is not None:
                    image = strip_influence(vertices, self.mirror.reflect_points(points), radius)
                    part += self.mirror.reflect_vectors(image)
            parts.append(part)
        return np.concatenate(parts, axis=1)

    def relax(self, free: FreeWake) -> list[float]:
        """Let the wake go where its velocity carries it; what it lacked in each iteration."""
        size = self._size()
        history: list[float] = []
        while True:
            lacking = [
                drift(self.ages, u, self.axis) - e
                for u, e in zip(self._wake_velocities(free), self.drifts, strict=True)
            ]
            history.append(float(max(_row_rms(e).max() for e in lacking) / size))
            if history[-1] <= free.tolerance:
                return history
            _require_progress(history, free)
            for own, change in zip(self.drifts, lacking, strict=True):
                own += free.relaxation * change
            self.solve()

    def placed_rows(self) -> list[Array]:
        """Rows (K+1,n+1,3) m of each wake, where they lie now."""
        return [
            displaced(x, e, self.ages, self.axis)
            for x, e in zip(self.rows, self.drifts, strict=True)
        ]

    def wake(self) -> Wake:
        """The wakes of the surfaces solved for."""
        rows = self.placed_rows()
        strengths = tuple(
            np.tile(g[-1], (len(self.ages) - 1, 1)) for g in self.circulation
        ) or tuple(np.zeros((len(self.ages) - 1, x.shape[1] - 1)) for x in rows)
        centre = (
            None
            if self.axis is None
            else drifted_centre(self.ages, self.wind, self.drifts, self.axis)
        )
        return Wake(self.ages, tuple(rows), strengths, centre)

    def whole(self) -> tuple[Wake, list[Array]]:
        """The wakes and the circulations of all surfaces."""
        wake = self.wake()
        if self.sector is None:
            return wake, self.circulation
        images = tuple(self.sector.images(wake.vertices[0]))
        whole = replace(wake, vertices=images, circulation=wake.circulation * self.sector.order)
        return whole, self.circulation * self.sector.order

    def solution(self, density: float, history: list[float]) -> SteadySolution:
        """Everything that is known of the flow."""
        wake, circulation = self.whole()
        sheets = self._sheets(wake, circulation)
        return SteadySolution(
            self.all_surfaces, circulation, wake, self._loads(density), self.wind, sheets,
            self.air, history, self.mirror,
        )  # fmt: skip

    def _loads(self, density: float) -> list[SurfaceLoads]:
        points = segment_points(self.surfaces)
        trailing = np.concatenate([g[-1] for g in self.circulation])
        velocity = self.air(points) + np.einsum("kja,j->ka", self.strips(points), trailing)
        bound = [
            Sheet(vertices, g)
            for s, g in zip(self.surfaces, self.circulation, strict=True)
            for vertices in self._images(s.lattice.vertices)
        ]
        velocity += InducedField(bound, mirror=self.mirror).velocity(points)
        relative = velocity - segment_velocities(self.surfaces)
        loads = lattice_loads(self.surfaces, self.circulation, relative, density)
        if self.sector is None:
            return loads
        return [
            loads[0].turned(turn, s.lattice.corners)
            for turn, s in zip(self.sector.rotations, self.all_surfaces, strict=True)
        ]

    def _wake_velocities(self, free: FreeWake) -> list[Array]:
        """Induced velocity (K+1,n+1,3) m/s on the rows of the surfaces solved for."""
        sheets = self._sheets(*self.whole())
        first = len(self.all_surfaces)
        field = InducedField(sheets, error=free.error, precision=free.precision, mirror=self.mirror)
        return field.vertex_velocities(range(first, first + len(self.surfaces)))

    def _sheets(self, wake: Wake, circulation: list[Array]) -> list[Sheet]:
        bound = [
            Sheet(s.lattice.vertices, g)
            for s, g in zip(self.all_surfaces, circulation, strict=True)
        ]
        return bound + wake.sheets(self.core)

    def _images(self, vertices: Array) -> list[Array]:
        return [vertices] if self.sector is None else self.sector.images(vertices)

    def _size(self) -> float:
        corners = np.concatenate([s.lattice.corners.reshape(-1, 3) for s in self.all_surfaces])
        if self.axis is None:
            return float(np.linalg.norm(np.ptp(corners, axis=0)))
        return float(np.linalg.norm(np.cross(corners - self.axis.origin, self.axis.direction),
                                    axis=1).max())  # fmt: skip


def _row_rms(change: Array) -> Array:
    return np.sqrt(np.sum(change**2, axis=2).mean(axis=1))


def _require_progress(history: list[float], free: FreeWake) -> None:
    """Raise ConvergenceError where the wake runs away or takes too long."""
    last, best = history[-1], min(history)
    what = ""
    if not np.isfinite(last) or last > 100.0 * history[0]:
        what = f"the free wake runs away: after {len(history)} iterations it lacks {last:.2g} radii"
    elif len(history) >= free.iterations:
        what = f"the free wake is not found in {len(history)} iterations: it lacks {last:.2g} radii"
        what += f" (at best {best:.2g}, wanted {free.tolerance:.2g})"
    if what:
        hint = "use thicker vortex cores, a smaller relaxation, a shorter wake or a prescribed one"
        raise ConvergenceError("steady vortex lattice", what, hint)


def _placed(corners: ArrayLike, axis: RotorAxis | None) -> Surface:
    if axis is None:
        return Surface.at_rest(np.asarray(corners, dtype=float))
    return Surface.turning(np.asarray(corners), axis.speed * axis.direction, axis.origin)


def _wind(velocity: ArrayLike | Wind) -> Wind:
    if callable(velocity):
        return velocity
    uniform = np.asarray(velocity, dtype=float)
    if uniform.shape != (3,) or not np.isfinite(uniform).all():
        raise InputError("velocity", "expected three finite numbers, m/s, or a function of points")
    return lambda points: np.broadcast_to(uniform, points.shape)


def _wake_wind(air: Wind, surfaces: list[Surface], given: ArrayLike | None) -> Array:
    if given is not None:
        return np.asarray(given, dtype=float)
    return air(collocation_points(surfaces)).mean(axis=0)


def _sector(
    surfaces: list[Surface], velocity: ArrayLike | Wind, wind: Array, axis: RotorAxis | None
) -> RotationalSymmetry | None:
    """The symmetry of a rotor in axial flow, None where there is none."""
    if axis is None or callable(velocity) or len(surfaces) < 2:
        return None
    across = wind - (wind @ axis.direction) * axis.direction
    if np.linalg.norm(across) > 1e-9 * np.linalg.norm(wind):
        return None
    sector = sector_of([s.lattice.corners for s in surfaces], axis.direction, axis.origin)
    if sector is None:
        return None
    moving = np.array([s.velocity for s in surfaces])
    turned = np.array([sector.turn_vectors(surfaces[0].velocity, b) for b in range(sector.order)])
    return sector if np.abs(moving - turned).max() <= 1e-9 * np.abs(moving).max() else None


def _ages(
    surfaces: list[Surface], wind: Array, axis: RotorAxis | None, free: FreeWake | None
) -> Array:
    speed = float(np.linalg.norm(wind))
    corners = np.concatenate([s.lattice.corners.reshape(-1, 3) for s in surfaces])
    if axis is not None:
        arms = np.linalg.norm(np.cross(corners - axis.origin, axis.direction), axis=1)
        return rotor_ages(axis.speed, float(wind @ axis.direction), float(arms.max()))
    if not speed > 0.0:
        raise InputError("velocity", "there is no wind to carry a wake", "give the wake's ages")
    if free is not None:
        raise InputError("ages", "a free wake behind a wing needs the ages of its rows")
    return np.array([0.0, WING_WAKE * np.linalg.norm(np.ptp(corners, axis=0)) / speed])
