"""Steady flow about wings and rotors, with a prescribed or a free wake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vortex.ages import growing_ages, rotor_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.free_wake import FreeWake, find_free_wake
from galerna.aero.vortex.loads import SurfaceLoads
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.steady_flow import SteadyFlow, Wind, extent
from galerna.aero.vortex.surface import Surface, collocation_points
from galerna.aero.vortex.symmetry import RotationalSymmetry, sector_of
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array
from galerna.errors import InputError
from galerna.units import AIR_DENSITY

STRAIGHT_WAKE = 100.0  #: spans that the prescribed wake of a wing reaches downstream
FREE_WAKE = 10.0  #: spans that a free one reaches
FREE_CORE = 0.1  #: mean chords: radius of the cores of a free wake where none is given
TREE_ERROR = 1e-3  #: of velocities anywhere in the flow, where the treecode saves time


@dataclass(eq=False)
class SteadySolution:
    """Steady flow: all surfaces with their circulation (m,n) m2/s, wakes and loads.

    ``wind`` (3,) m/s is the undisturbed flow that carries the wake, ``sheets`` are all that
    induces velocity, and ``history`` holds the largest move of a row of a free wake in each
    sweep, over the radius or span (empty for a prescribed wake).
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
        field = InducedField(self.sheets, error=TREE_ERROR, mirror=self.mirror)
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
    ``axis`` of a rotor and stand still without one. The wake goes with ``wake_velocity`` (3,)
    m/s, by default the mean wind at the surfaces, and with the induced velocities too where
    ``free`` says how. Its rows have ``ages`` (K+1,) s: by default one long panel behind a wing,
    growing ones if it is free, and `rotor_ages` behind a rotor. A rotor in axial flow is solved
    for one blade, unless ``symmetry`` is off.

    In a wind across its axis a rotor's flow is not steady: the solution is that of the blades
    as they stand, with a wake that has always had their present circulation.

    Raises InputError for surfaces, winds or ages that cannot be used, and ConvergenceError where
    a free wake is not found.
    """
    bodies = [
        s if isinstance(s, Surface) else _placed(f"surface {number}", s, axis)
        for number, s in enumerate(surfaces, 1)
    ]
    if not bodies:
        raise InputError("surfaces", "there are none", "give at least one")
    air = _wind(velocity)
    wind = _wake_wind(air, bodies, wake_velocity)
    symmetric = symmetry and mirror is None and not callable(velocity)
    times = _default_ages(bodies, wind, axis, free) if ages is None else _checked(ages)
    if free is not None and core is None:
        core = VortexCore(FREE_CORE * _mean_chord(bodies))
    flow = SteadyFlow(
        bodies, air, wind, times, axis=axis, core=core, mirror=mirror,
        sector=_sector(bodies, wind, axis) if symmetric else None,
    )  # fmt: skip
    history = [] if free is None else find_free_wake(flow, free)
    wake, circulation = flow.whole()
    return SteadySolution(
        surfaces=bodies,
        circulation=circulation,
        wake=wake,
        loads=flow.loads(density),
        wind=wind,
        sheets=flow.sheets(),
        air=air,
        history=history,
        mirror=mirror,
    )


def _placed(name: str, corners: ArrayLike, axis: RotorAxis | None) -> Surface:
    corners = np.asarray(corners, dtype=float)
    if corners.ndim != 3 or corners.shape[2] != 3 or min(corners.shape[:2]) < 2:
        raise InputError(name, f"corners must be (m+1,n+1,3), found {corners.shape}")
    bad = np.argwhere(~np.isfinite(corners).all(axis=2))
    if len(bad):
        row, column = bad[0] + 1
        raise InputError(name, f"the corner in row {row}, column {column} is not a finite number")
    if axis is None:
        return Surface.at_rest(corners)
    return Surface.turning(corners, axis.speed * axis.direction, axis.origin)


def _wind(velocity: ArrayLike | Wind) -> Wind:
    if callable(velocity):
        return velocity
    uniform = _vector("velocity", velocity)
    return lambda points: np.broadcast_to(uniform, points.shape)


def _wake_wind(air: Wind, surfaces: list[Surface], given: ArrayLike | None) -> Array:
    if given is not None:
        return _vector("wake_velocity", given)
    return air(collocation_points(surfaces)).mean(axis=0)


def _vector(where: str, value: ArrayLike) -> Array:
    vector = np.asarray(value, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(where, f"expected three finite numbers, m/s, found {value!r}")
    return vector


def _checked(ages: ArrayLike) -> Array:
    times = np.asarray(ages, dtype=float)
    if times.ndim != 1 or len(times) < 2 or times[0] != 0.0 or not np.all(np.diff(times) > 0.0):
        raise InputError("ages", "at least two times are needed that rise from 0 s")
    return times


def _sector(
    surfaces: list[Surface], wind: Array, axis: RotorAxis | None
) -> RotationalSymmetry | None:
    """The symmetry of a rotor in axial flow, None where there is none."""
    if axis is None or len(surfaces) < 2:
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


def _mean_chord(surfaces: list[Surface]) -> float:
    chords = [np.linalg.norm(s.lattice.corners[-1] - s.lattice.corners[0], axis=1).mean()
              for s in surfaces]  # fmt: skip
    return float(np.mean(chords))


def _default_ages(
    surfaces: list[Surface], wind: Array, axis: RotorAxis | None, free: FreeWake | None
) -> Array:
    size, speed = extent(surfaces, axis), float(np.linalg.norm(wind))
    if axis is not None:
        return rotor_ages(axis.speed, speed, size)
    if not speed > 0.0:
        raise InputError("velocity", "there is no wind to carry a wake", "give the wake's ages")
    if free is None:
        return np.array([0.0, STRAIGHT_WAKE * size / speed])
    step = _mean_chord(surfaces) / speed
    return growing_ages(step, FREE_WAKE * size / speed, near=free.length * size / speed, growth=1.1)
