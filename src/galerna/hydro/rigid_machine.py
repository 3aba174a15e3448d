"""A turbine with its platform as one rigid body: what moves with a hull in waves."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.far_field import Moving
from galerna.hydro.rigid import constant_force_stiffness, point_mass
from galerna.turbine.model import Turbine
from galerna.turbine.platform import Platform
from galerna.turbine.summary import point_masses
from galerna.units import STANDARD_GRAVITY


def afloat(turbine: Turbine) -> Platform:
    """The turbine's platform. Raises InputError where it stands on land."""
    if turbine.platform is None:
        raise InputError(f"turbine {turbine.name!r}", "has no platform", "name a floating turbine")
    return turbine.platform


def rigid_machine(turbine: Turbine, gravity: float = STANDARD_GRAVITY) -> Moving:
    """Mass and the weight's restoring (6,6) about the platform's reference point.

    Tower, nacelle, hub and blades are points, the blades at the hub; the moorings' stiffness,
    small beside inertia in waves, is left out. Raises InputError without a platform.
    """
    platform = afloat(turbine)
    center = np.subtract(platform.center_of_mass, platform.reference_point)
    inertia = point_mass(platform.mass, center)
    inertia[3:, 3:] += np.diag(platform.inertia)
    restoring = constant_force_stiffness(_weight(platform.mass, gravity), center)
    for mass, place in _points(turbine):
        arm = place - np.asarray(platform.reference_point)
        inertia += point_mass(mass, arm)
        restoring += constant_force_stiffness(_weight(mass, gravity), arm)
    if platform.mooring is not None:
        restoring[5, 5] += platform.mooring.yaw_stiffness
    return Moving(inertia, restoring)


def _weight(mass: float, gravity: float) -> Array:
    return np.array([0.0, 0.0, -mass * gravity])


def _points(turbine: Turbine) -> list[tuple[float, Array]]:
    """Masses kg and places (3,) m, global axes, of all but the platform."""
    tower, blade, nacelle, hub = turbine.tower, turbine.blade, turbine.nacelle, turbine.hub
    top = tower.axis[-1]
    shaft = np.array([np.cos(nacelle.tilt), 0.0, -np.sin(nacelle.tilt)])
    apex = top + np.array([0.0, 0.0, nacelle.shaft_height]) - nacelle.overhang * shaft
    points = [
        (nacelle.mass, top + nacelle.center_of_mass),
        (nacelle.yaw_bearing_mass, top),
        (hub.mass, apex),
        *((mass, np.array([top[0], top[1], height])) for height, mass in tower.extra_masses),
    ]
    if tower.structure is not None:
        masses, places = point_masses(tower.axis_span, tower.axis, tower.structure)
        points += list(zip(masses.tolist(), places, strict=True))
    if blade.structure is not None:
        masses, _ = point_masses(blade.axis_span, blade.axis, blade.structure)
        points.append((turbine.number_of_blades * float(masses.sum()), apex))
    return points
