"""The strip view of a blade that every aerodynamic model shares: shape, polars, weights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import pi

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from galerna.errors import InputError
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Airfoil, BladeShape, Polar, Turbine, UnsteadyParameters
from galerna.units import AIR_VISCOSITY

Array = NDArray[np.float64]

TABLE_INTERVALS = (720, 1440, 2880, 5760)  #: the coarsest that meets TABLE_ERROR is taken
TABLE_ERROR = 1e-3  #: largest error of a tabulated coefficient, against cubic interpolation


@dataclass(frozen=True, eq=False)
class BladeSections:
    """Strips of one blade at (n,) stations.

    ``span`` is the fraction of the reference axis; ``position`` (n,3) m and ``rotation``
    (n,3,3) are the undeflected section frames in the blade's root axes. ``chord`` m and
    ``twist`` rad (n,). ``aerodynamic_center`` (n,2) m is where the polars act, along x and y
    of the section. ``weight`` (n,) m makes a distributed load a lumped one, and ``offset``
    (n,) m along z is where it acts; together they are exact for force and moment of loads
    that vary linearly. ``table`` (n,m,3) holds cl, cd, cm at m angles evenly from -pi to pi
    and ``coverage`` (n,2) rad the angles for which the polars have data. ``blend`` (n,k) is
    the share of each of the ``airfoils`` in a station.
    """

    span: Array
    position: Array
    rotation: Array
    chord: Array
    twist: Array
    relative_thickness: Array
    aerodynamic_center: Array
    weight: Array
    offset: Array
    table: Array
    coverage: Array
    airfoils: tuple[str, ...]
    blend: Array
    unsteady: tuple[UnsteadyParameters, ...]

    def __len__(self) -> int:
        return len(self.span)

    @property
    def angles(self) -> Array:
        """Angles of attack (m,) rad of the table."""
        return np.linspace(-pi, pi, self.table.shape[1])

    def airfoil_at(self, station: int) -> str:
        """Name of the airfoil with the largest share in a station."""
        return self.airfoils[int(np.argmax(self.blend[station]))]

    def check_angles(self, angle_of_attack: ArrayLike) -> None:
        """Raise InputError where an angle (..., n) rad has no data in the station's polar."""
        angle = (np.atleast_2d(np.asarray(angle_of_attack, dtype=float)) + pi) % (2 * pi) - pi
        low, high = self.coverage.T
        bad = ~((angle >= low - 1e-9) & (angle <= high + 1e-9))
        if bad.any():
            row, station = np.argwhere(bad)[0]
            raise InputError(
                f"airfoil {self.airfoil_at(station)!r}",
                f"angle of attack {np.degrees(angle[row, station]):.1f} deg met at span "
                f"{self.span[station]:.3f}; its polar covers {np.degrees(low[station]):.1f} to "
                f"{np.degrees(high[station]):.1f} deg",
                "extend the polar, for example with Viterna's method, to -180 to 180 deg",
            )


@njit(cache=True, error_model="numpy", inline="always")
def section_coefficients(table, station, angle):  # type: ignore[no-untyped-def]
    """cl, cd and cm of a station at any angle rad, linear on the table's even grid."""
    last = table.shape[1] - 1
    place = (angle + pi) * (last / (2.0 * pi))
    place -= last * np.floor(place / last)
    left = min(int(place), last - 1)
    t = place - left
    lower, upper = table[station, left], table[station, left + 1]
    return (
        lower[0] + t * (upper[0] - lower[0]),
        lower[1] + t * (upper[1] - lower[1]),
        lower[2] + t * (upper[2] - lower[2]),
    )


def blade_sections(turbine: Turbine, stations: int | ArrayLike | None = None) -> BladeSections:
    """Strips at the turbine's own stations, at a number of equal ones, or at span fractions.

    Raises InputError for stations that do not rise within 0 and 1 or leave an end of the blade
    out, zero chord, and polars that cannot be used.
    """
    blade, shape = turbine.blade, turbine.blade.shape
    span = _stations(shape, stations)
    chord = np.interp(span, shape.span, shape.chord)
    if not np.all(chord > 0.0):
        bad = span[~(chord > 0.0)][0]
        raise InputError(f"blade of {turbine.name!r}", f"chord at span {bad:.3f} is not positive")
    thickness = np.interp(span, shape.span, shape.relative_thickness)
    names, blend = airfoil_blend(shape, turbine.airfoils, span, thickness)
    airfoils = [turbine.airfoils[name] for name in names]
    position, rotation = blade_frames(blade, span)
    weight, offset = strip_weights(span * blade.length, blade.length)
    radius = turbine.hub.radius + position[:, 2]
    reynolds = turbine.control.rated_rotor_speed * radius * chord / AIR_VISCOSITY
    return BladeSections(
        span=span,
        position=position,
        rotation=rotation,
        chord=chord,
        twist=np.interp(span, shape.span, shape.twist),
        relative_thickness=thickness,
        aerodynamic_center=_aerodynamic_centers(shape, airfoils, blend, span, chord),
        weight=weight,
        offset=offset,
        table=_tables(airfoils, blend, reynolds),
        coverage=_coverage(airfoils, blend),
        airfoils=names,
        blend=blend,
        unsteady=tuple(blend_unsteady([a.unsteady for a in airfoils], b) for b in blend),
    )


def strip_weights(position: Array, length: float) -> tuple[Array, Array]:
    """Weights (n,) m and offsets (n,) m of strips at ``position`` (n,) m along an axis.

    A load that is linear between the stations, and beyond the outermost ones to the axis'
    ends, has the same force and moment as its station values times the weights, each acting
    at its offset from the station: the consistent nodal loads of linear shape functions.
    """
    n = len(position)
    edges = np.concatenate(([0.0], position, [length]))
    half, middle = np.diff(edges) / 2.0, (edges[1:] + edges[:-1]) / 2.0
    points = np.concatenate((middle - half / np.sqrt(3.0), middle + half / np.sqrt(3.0)))
    share = np.concatenate((half, half))
    left = np.clip(np.searchsorted(position, points) - 1, 0, n - 2)
    t = (points - position[left]) / (position[left + 1] - position[left])

    def assemble(density: Array) -> Array:
        shares = np.concatenate((density * (1.0 - t), density * t))
        return np.bincount(np.concatenate((left, left + 1)), shares, n).astype(float)

    weight = assemble(share)
    return weight, assemble(share * points) / weight - position


def airfoil_blend(
    shape: BladeShape, airfoils: dict[str, Airfoil], span: Array, thickness: Array
) -> tuple[tuple[str, ...], Array]:
    """Names (k) of the airfoils in use and their shares (n,k) at ``span`` (n,).

    Between two airfoils the share follows the relative thickness ``thickness`` (n,) where
    theirs differ, and the position where they do not.
    """
    names = tuple(dict.fromkeys(shape.airfoil_names))
    place = shape.airfoil_span
    of_place = np.array([airfoils[name].relative_thickness for name in shape.airfoil_names])
    column = np.array([names.index(name) for name in shape.airfoil_names])
    blend = np.zeros((len(span), len(names)))
    if len(place) == 1:
        blend[:] = 1.0
        return names, blend
    left = np.clip(np.searchsorted(place, span, side="right") - 1, 0, len(place) - 2)
    step = of_place[left + 1] - of_place[left]
    by_position = (span - place[left]) / np.maximum(place[left + 1] - place[left], 1e-12)
    differs = np.abs(step) > 1e-6
    by_thickness = (thickness - of_place[left]) / np.where(differs, step, 1.0)
    t = np.clip(np.where(differs, by_thickness, by_position), 0.0, 1.0)
    row = np.arange(len(span))
    np.add.at(blend, (row, column[left]), 1.0 - t)
    np.add.at(blend, (row, column[left + 1]), t)
    return names, blend


def blend_unsteady(parameters: Sequence[UnsteadyParameters], share: Array) -> UnsteadyParameters:
    """The mean of unsteady parameters with the weights ``share`` (k,)."""
    used = [(p, s) for p, s in zip(parameters, share, strict=True) if s > 0.0]
    if len(used) == 1:
        return used[0][0]
    values: dict[str, object] = {"origin": "; ".join(sorted({p.origin for p, _ in used}))}
    for entry in fields(UnsteadyParameters):
        if entry.name != "origin":
            mean = sum(s * np.asarray(getattr(p, entry.name)) for p, s in used)
            values[entry.name] = tuple(mean.tolist()) if np.ndim(mean) else float(mean)
    return UnsteadyParameters(**values)  # type: ignore[arg-type]


def tabulate_polar(airfoil: str, polar: Polar, intervals: int) -> Array:
    """Coefficients (intervals + 1, 3) of a polar on even angles, by monotone cubics.

    Beyond the polar's own angles the outermost values stay. Raises InputError for angles
    that do not rise, a missing value, or fewer than two points.
    """
    angle = np.asarray(polar.angle_of_attack, dtype=float)
    values = np.stack([polar.lift, polar.drag, polar.moment], axis=1)
    if len(angle) < 2 or not np.all(np.diff(angle) > 0.0):
        raise InputError(f"airfoil {airfoil!r}", "the polar's angles of attack must rise")
    if not np.all(np.isfinite(values)):
        at = np.degrees(angle[~np.isfinite(values).all(axis=1)][0])
        raise InputError(f"airfoil {airfoil!r}", f"the polar has a missing value at {at:.1f} deg")
    grid = np.clip(np.linspace(-pi, pi, intervals + 1), angle[0], angle[-1])
    return PchipInterpolator(angle, values, axis=0)(grid)


def _stations(shape: BladeShape, stations: int | ArrayLike | None) -> Array:
    if stations is None:
        return np.asarray(shape.span, dtype=float)
    span = np.linspace(0.0, 1.0, stations) if isinstance(stations, int) else np.array(stations)
    if span.ndim != 1 or len(span) < 2 or np.any(np.diff(span) <= 0) or span[0] < 0 or span[-1] > 1:
        raise InputError("stations", "at least two span fractions that rise within 0 and 1 needed")
    for end, gap, spacing in (
        ("root", span[0], span[1] - span[0]),
        ("tip", 1.0 - span[-1], span[-1] - span[-2]),
    ):
        if gap > spacing + 1e-9:
            what = f"they stop {gap:.3g} of the span short of the {end}, {spacing:.3g} apart"
            raise InputError("stations", what, "loads go on straight there: no further than that")
    return span.astype(float)


def _aerodynamic_centers(
    shape: BladeShape, airfoils: list[Airfoil], blend: Array, span: Array, chord: Array
) -> Array:
    center = blend @ np.array([airfoil.aerodynamic_center for airfoil in airfoils])
    along_chord = center * chord - np.interp(span, shape.span, shape.leading_edge_offset)
    return np.stack([np.interp(span, shape.span, shape.normal_offset), along_chord], axis=1)


def _tables(airfoils: list[Airfoil], blend: Array, reynolds: Array) -> Array:
    """Blended coefficients (n,m,3) at each station's nominal Reynolds number."""
    intervals = max(_intervals(airfoil, polar) for airfoil in airfoils for polar in airfoil.polars)
    table = np.zeros((len(blend), intervals + 1, 3))
    for column, airfoil in enumerate(airfoils):
        polars = np.stack([tabulate_polar(airfoil.name, p, intervals) for p in airfoil.polars])
        log_reynolds = np.log([max(p.reynolds, 1.0) for p in airfoil.polars])
        for station in np.flatnonzero(blend[:, column] > 0.0):
            share = _nearest_share(log_reynolds, np.log(max(reynolds[station], 1.0)))
            table[station] += blend[station, column] * np.tensordot(share, polars, axes=1)
    return table


def _nearest_share(nodes: Array, at: float) -> Array:
    """Linear interpolation weights (k,) of a value among rising nodes (k,), held at the ends."""
    return np.array([np.interp(at, nodes, row) for row in np.eye(len(nodes))])


def _intervals(airfoil: Airfoil, polar: Polar) -> int:
    """The coarsest even grid that reproduces a polar to TABLE_ERROR, else the finest."""
    fine = tabulate_polar(airfoil.name, polar, 4 * TABLE_INTERVALS[-1])
    angle = np.linspace(-pi, pi, len(fine))
    for intervals in TABLE_INTERVALS:
        step = (len(fine) - 1) // intervals
        coarse = np.stack(
            [np.interp(angle, angle[::step], fine[::step, i]) for i in range(3)], axis=1
        )
        if np.abs(coarse - fine).max() < TABLE_ERROR:
            return intervals
    return TABLE_INTERVALS[-1]


def _coverage(airfoils: list[Airfoil], blend: Array) -> Array:
    """Angles (n,2) rad that every polar in a station's blend has."""
    ends = np.array(
        [
            (
                max(p.angle_of_attack[0] for p in airfoil.polars),
                min(p.angle_of_attack[-1] for p in airfoil.polars),
            )
            for airfoil in airfoils
        ]
    )
    whole = np.array([[-pi, pi]])
    used = blend[:, :, None] > 0.0
    low = np.where(used[..., 0], ends[None, :, 0], whole[:, :1]).max(axis=1)
    high = np.where(used[..., 0], ends[None, :, 1], whole[:, 1:]).min(axis=1)
    return np.stack([low, high], axis=1)
