"""Steady lattices of a turbine's rotor in axial wind, with and without drag, kept once solved."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from galerna.aero.vortex.ages import revolution_ages
from galerna.aero.vortex.blades import blade_lattice
from galerna.aero.vortex.camber import CamberSource
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.steady import FreeWake, SteadySolution, solve_steady
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.viscous import PolarForces
from galerna.aero.vortex.wake import RotorAxis
from galerna.contract import Array, Motion, Stations
from galerna.kinematics import PrescribedMotion
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY, RPM

from .rotors import constant_operation, dynamic_pressure_force

SHAFT = np.array([1.0, 0.0, 0.0])  #: of a rotor without tilt
CORE = 0.1  #: of the mean chord, radius of a free wake's vortices when shed


@dataclass(frozen=True)
class Mesh:
    """The size of a rotor's lattice; the wake's panels are all alike."""

    chordwise: int = 8
    spanwise: int = 20
    revolutions: float = 7.0
    step_deg: float = 5.0
    rings: str = "quarter_chord"
    camber: CamberSource = "coordinates"
    free: bool = False


@dataclass(frozen=True, eq=False)
class SteadyRotor:
    """Coefficients of the rotor, without and with drag, and along blade 1 (n,) of its lattice.

    ``c_out``, ``c_in`` 1/m as in the dissertation's eq. 3.9; the polar's ``drag_coefficient`` and
    ``angle_of_attack`` rad are those of ``lift_coefficient``.
    """

    thrust_coefficient: float
    power_coefficient: float
    thrust_with_drag: float
    power_with_drag: float
    radius: Array
    c_out: Array
    c_in: Array
    c_out_with_drag: Array
    c_in_with_drag: Array
    lift_coefficient: Array
    drag_coefficient: Array
    angle_of_attack: Array
    solution: SteadySolution


@cache
def steady_lattice(
    turbine: Turbine,
    wind_speed: float,
    rotor_speed_rpm: float,
    pitch_deg: float,
    mesh: Mesh,
    air_density: float = AIR_DENSITY,
) -> SteadyRotor:
    """The rigid rotor, without tilt, in uniform wind along its shaft."""
    blade = blade_lattice(
        turbine, chordwise=mesh.chordwise, spanwise=mesh.spanwise, camber=mesh.camber
    )
    operation = constant_operation(turbine, rotor_speed_rpm, pitch_deg)
    parts = [Stations(f"blade{b + 1}", blade.stations) for b in range(turbine.number_of_blades)]
    motions = PrescribedMotion(turbine, operation, [[p] for p in (*parts, Stations("hub"))]).motions
    *frames, hub = motions
    speed, wind = rotor_speed_rpm * RPM, np.array([wind_speed, 0.0, 0.0])
    axis = RotorAxis(hub.position[0], SHAFT, speed)
    bare = blade.bare_strips
    surfaces = []
    for motion in frames:
        columns = [v[bare:] for v in (motion.position, motion.rotation)]
        corners = blade.place(*columns)
        surfaces.append(Surface.turning(corners, speed * SHAFT, axis.origin, mesh.rings))
    ages = revolution_ages(speed, mesh.revolutions, mesh.step_deg)
    core = VortexCore(CORE * float(blade.chord[bare:].mean())) if mesh.free else None
    solution = solve_steady(
        surfaces, wind, axis=axis, ages=ages, density=air_density, core=core,
        free=FreeWake() if mesh.free else None,
    )  # fmt: skip
    return _coefficients(turbine, PolarForces(blade, air_density), frames[0], axis, wind, solution)


def _coefficients(
    turbine: Turbine,
    polars: PolarForces,
    frames: Motion,
    axis: RotorAxis,
    wind: Array,
    solution: SteadySolution,
) -> SteadyRotor:
    bare, blades = polars.lattice.bare_strips, len(solution.surfaces)
    strips = solution.loads[0].strip_force
    winds = np.broadcast_to(wind, (len(polars.lattice.stations) - 1, 3))
    air = polars.air(
        frames.position, frames.rotation, frames.velocity, frames.angular_velocity, winds
    )
    viscous = polars.loads(air, strips)
    scale = dynamic_pressure_force(turbine, wind[0]) * polars.air_density / AIR_DENSITY
    radius = polars.points(frames.position, frames.rotation) - axis.origin
    height = np.linalg.norm(air.span, axis=1)
    chord = polars.lattice.chord
    area = 0.5 * (chord[1:] + chord[:-1]) * height
    drag = 0.5 * polars.air_density * air.speed * viscous.drag_coefficient * area
    drag = drag[:, None] * air.velocity
    around = np.cross(axis.direction, radius)
    around /= np.linalg.norm(around, axis=1, keepdims=True)

    def along(force: Array) -> tuple[Array, Array]:
        """c_out and c_in of strip forces (n,3) N."""
        per_length = force / (scale * height[bare:, None])
        return per_length @ axis.direction, np.sum(per_length * around[bare:], axis=1)

    thrust, torque = solution.force @ axis.direction, solution.moment(axis.origin) @ axis.direction
    arms = frames.position - axis.origin
    added = blades * viscous.force.sum(axis=0) @ axis.direction
    turned = np.cross(arms, viscous.force) + viscous.moment
    twisted = blades * turned.sum(axis=0) @ axis.direction
    to_power = axis.speed / (scale * wind[0])
    return SteadyRotor(
        float(thrust / scale), float(torque * to_power),
        float((thrust + added) / scale), float((torque + twisted) * to_power),
        np.linalg.norm(np.cross(radius[bare:], axis.direction), axis=1),
        *along(strips), *along(strips + drag[bare:]),
        viscous.lift_coefficient[bare:], viscous.drag_coefficient[bare:],
        viscous.angle_of_attack[bare:], solution,
    )  # fmt: skip
