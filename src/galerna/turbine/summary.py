"""The figures of a turbine beside the published ones: what agrees, what does not, by how much."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from galerna.turbine.model import Array, SectionProperties, Turbine
from galerna.units import RPM


@dataclass(frozen=True)
class Row:
    """One figure. ``value`` is None where galerna has no figure, ``published`` where nobody has.

    ``difference`` is (value - published) / |published|.
    """

    quantity: str
    value: float | None
    unit: str
    published: float | None = None
    source: str = ""

    @property
    def difference(self) -> float | None:
        if self.value is None or self.published is None or self.published == 0.0:
            return None
        return (self.value - self.published) / abs(self.published)


def summary(turbine: Turbine, solved: Mapping[str, float] | None = None) -> list[Row]:
    """Every figure of a turbine that galerna computes or that its file says is published.

    ``solved`` holds figures that take a solver, by quantity, in the units of the table; one
    of them replaces what the turbine's own data say.
    """
    rows, solved = [], solved or {}
    published = {p.quantity: p for p in turbine.published}
    for quantity, (unit, compute) in QUANTITIES.items():
        value = solved.get(quantity, compute(turbine))
        known = published.pop(quantity, None)
        if known is not None and known.unit == unit:
            rows.append(Row(quantity, value, unit, known.value, known.source))
        elif value is not None:
            rows.append(Row(quantity, value, unit))
        if known is not None and known.unit != unit:
            published[quantity] = known
    others = {q: value for q, value in solved.items() if q not in QUANTITIES}
    return rows + [
        Row(p.quantity, others.get(p.quantity), p.unit, p.value, p.source)
        for p in published.values()
    ]


def fitted_airfoils(turbine: Turbine) -> tuple[str, ...]:
    """Names of the airfoils whose unsteady parameters are fitted, not published."""
    return tuple(a.name for a in turbine.airfoils.values() if a.unsteady.origin != "published")


def point_masses(axis_span: Array, axis: Array, sections: SectionProperties) -> tuple[Array, Array]:
    """A beam as points on its reference axis (k,3) m with masses (k,) kg.

    Three Gauss points between neighbouring stations: mass and moments of a mass per
    length that is linear between them come out exact.
    """
    knots = np.union1d(axis_span, sections.span)
    ends = np.stack([np.interp(knots, axis_span, c) for c in axis.T], axis=1)
    points, weights = np.polynomial.legendre.leggauss(3)
    part = (1.0 + points) / 2.0  # of the way between two knots
    steps = np.diff(ends, axis=0)
    position = ends[:-1, None] + part[:, None] * steps[:, None]
    span = knots[:-1, None] + part * np.diff(knots)[:, None]
    length = np.linalg.norm(steps, axis=1)[:, None] * weights / 2.0
    mass = np.interp(span, sections.span, sections.mass) * length
    return mass.ravel(), position.reshape(-1, 3)


def _blade(turbine: Turbine) -> tuple[Array, Array] | None:
    blade = turbine.blade
    if blade.structure is None:
        return None
    return point_masses(blade.axis_span, blade.axis, blade.structure)


def _tower(turbine: Turbine) -> tuple[Array, Array] | None:
    tower = turbine.tower
    if tower.structure is None:
        return None
    mass, position = point_masses(tower.axis_span, tower.axis, tower.structure)
    extra = np.array(tower.extra_masses).reshape(-1, 2)
    heights = np.stack([np.zeros(len(extra)), np.zeros(len(extra)), extra[:, 0]], axis=1)
    return np.append(mass, extra[:, 1]), np.append(position, heights, axis=0)


def _blade_moment(power: int, turbine: Turbine) -> float | None:
    """Moment of a blade's mass about its root along the pitch axis."""
    if (points := _blade(turbine)) is None:
        return None
    return float(points[0] @ points[1][:, 2] ** power)


def _blade_center(turbine: Turbine) -> float | None:
    mass, moment = _blade_moment(0, turbine), _blade_moment(1, turbine)
    return None if mass is None or moment is None else moment / mass


def _rotor_mass(turbine: Turbine) -> float | None:
    blade = _blade_moment(0, turbine)
    return None if blade is None else turbine.number_of_blades * blade + turbine.hub.mass


def _rotor_nacelle_mass(turbine: Turbine) -> float | None:
    rotor = _rotor_mass(turbine)
    nacelle = turbine.nacelle
    return None if rotor is None else rotor + nacelle.mass + nacelle.yaw_bearing_mass


def _coned(turbine: Turbine, position: Array) -> tuple[Array, Array]:
    """Distance from the shaft and along it downwind from the hub centre, of blade points."""
    x, y, z = position.T
    c, s = np.cos(turbine.hub.cone), np.sin(turbine.hub.cone)
    outwards = turbine.hub.radius + z
    return np.hypot(c * outwards + s * x, y), c * x - s * outwards


def rotor_inertia(turbine: Turbine) -> float | None:
    """Inertia kg m2 of blades and hub about the shaft; None where the blades have no mass."""
    if (points := _blade(turbine)) is None:
        return None
    mass, position = points
    distance, _ = _coned(turbine, position)
    return float(turbine.number_of_blades * (mass @ distance**2) + turbine.hub.inertia)


def _tower_mass(turbine: Turbine) -> float | None:
    return None if (points := _tower(turbine)) is None else float(points[0].sum())


def _tower_center(turbine: Turbine) -> float | None:
    if (points := _tower(turbine)) is None:
        return None
    return float(points[0] @ points[1][:, 2] / points[0].sum())


def _center_of_mass(axis: int, turbine: Turbine) -> float | None:
    """Mass centre of the machine, platform included, global axes; over all azimuths."""
    blade, tower = _blade(turbine), _tower(turbine)
    if blade is None or tower is None:
        return None
    nacelle, hub, count = turbine.nacelle, turbine.hub, turbine.number_of_blades
    top = turbine.tower.axis[-1]
    shaft = np.array([np.cos(nacelle.tilt), 0.0, -np.sin(nacelle.tilt)])
    apex = top + np.array([0.0, 0.0, nacelle.shaft_height]) - nacelle.overhang * shaft
    _, downwind = _coned(turbine, blade[1])
    parts = [
        (tower[0].sum(), tower[0] @ tower[1] / tower[0].sum()),
        (nacelle.mass, top + np.array(nacelle.center_of_mass)),
        (nacelle.yaw_bearing_mass, top),
        (hub.mass, apex + hub.center_of_mass * shaft),
        (count * blade[0].sum(), apex + (blade[0] @ downwind) / blade[0].sum() * shaft),
    ]
    if turbine.platform is not None:
        parts.append((turbine.platform.mass, np.array(turbine.platform.center_of_mass)))
    total = sum(mass for mass, _ in parts)
    return float(sum(mass * place[axis] for mass, place in parts) / total)


def _unsolved(turbine: Turbine) -> None:
    """What only a solver can tell."""


def _rated_torque(turbine: Turbine) -> float:
    """Generator torque that gives rated power at rated speed, N m."""
    drivetrain, control = turbine.drivetrain, turbine.control
    speed = control.rated_rotor_speed * drivetrain.gear_ratio
    return control.rated_power / (drivetrain.generator_efficiency * speed)


#: Unit and computation of every figure, in the order of the table.
QUANTITIES: dict[str, tuple[str, Callable[[Turbine], float | None]]] = {
    "rotor_diameter": ("m", lambda t: 2.0 * t.rotor_radius),
    "hub_height": ("m", lambda t: t.hub_height),
    "hub_diameter": ("m", lambda t: 2.0 * t.hub.radius),
    "blade_length": ("m", lambda t: t.blade.length),
    "blade_mass": ("kg", partial(_blade_moment, 0)),
    "blade_first_moment": ("kg m", partial(_blade_moment, 1)),
    "blade_second_moment": ("kg m2", partial(_blade_moment, 2)),
    "blade_center_of_mass": ("m", _blade_center),
    "hub_mass": ("kg", lambda t: t.hub.mass),
    "rotor_mass": ("kg", _rotor_mass),
    "rotor_inertia": ("kg m2", rotor_inertia),
    "nacelle_mass": ("kg", lambda t: t.nacelle.mass),
    "nacelle_yaw_inertia": ("kg m2", lambda t: t.nacelle.yaw_inertia),
    "rotor_nacelle_mass": ("kg", _rotor_nacelle_mass),
    "tower_mass": ("kg", _tower_mass),
    "tower_center_of_mass": ("m", _tower_center),
    "overall_center_of_mass_x": ("m", partial(_center_of_mass, 0)),
    "overall_center_of_mass_z": ("m", partial(_center_of_mass, 2)),
    "platform_mass": ("kg", lambda t: t.platform.mass if t.platform else None),
    "rated_power": ("W", lambda t: t.control.rated_power),
    "rated_wind_speed": ("m/s", _unsolved),
    "rated_rotor_speed": ("rpm", lambda t: t.control.rated_rotor_speed / RPM),
    "rated_tip_speed": ("m/s", lambda t: t.control.rated_rotor_speed * t.rotor_radius),
    "rated_generator_speed": (
        "rpm",
        lambda t: t.control.rated_rotor_speed * t.drivetrain.gear_ratio / RPM,
    ),
    "rated_generator_torque": ("N m", _rated_torque),
    "optimal_tip_speed_ratio": ("-", lambda t: t.control.optimal_tip_speed_ratio),
    "peak_power_coefficient": ("-", _unsolved),
}
