"""What the lattice lacks of a blade's loads, from polars: drag, and all of the bare strips.

The drag coefficient of a strip belongs to the lift coefficient that its vortices have, along
the attached branch of its polar; the angle of attack would have to be told next to singular
vortices. The drag acts along the undisturbed relative wind (dissertation 4.1.1), in the plane
across the span, and adds to the induced drag of the lattice. A section that leaves the branch
is flagged and has the drag of the branch's end.

Strips inboard of the lattice have no vortices; their polars act at the angle of the
undisturbed relative wind. Pitching moments: those of bare strips are the polars', those of
the others are the lattice's own, which has camber; the polar's would count them twice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from galerna.aero.vectors import cross_products
from galerna.aero.vortex.blades import BladeLattice
from galerna.aero.vortex.section_polars import SectionPolars
from galerna.contract import Array
from galerna.units import AIR_DENSITY

CALM = 1e-3  #: m/s, relative wind below which a strip has no lift coefficient


class StripAir(NamedTuple):
    """Strips of blades and the undisturbed air (..., N, 3) that they meet, in global axes.

    ``arm`` (..., N+1, 3) m leads from the frames to the quarter chord, where forces act;
    ``span`` m from one station's quarter chord to the next; ``velocity`` m/s is that of the air
    relative to the strip in the plane across the span, ``speed`` (..., N) m/s its length;
    ``lift`` is the unit vector across it towards the suction side; ``angle`` (..., N) rad.
    """

    arm: Array
    span: Array
    velocity: Array
    speed: Array
    lift: Array
    angle: Array


class PolarLoads(NamedTuple):
    """Loads from polars on the stations' frames, and what the strips were found to be.

    ``force`` (..., N+1, 3) N and ``moment`` (..., N+1, 3) N m about the frames' origins, global
    axes. Of the N strips, bare ones first: lift and drag coefficient, the angle of attack rad
    that the polar has there, and ``outside``: 1 above, -1 below the attached branch, else 0.
    """

    force: Array
    moment: Array
    lift_coefficient: Array
    drag_coefficient: Array
    angle_of_attack: Array
    outside: NDArray[np.int8]


class PolarForces:
    """Forces on the blades of a lattice that come from polars.

    All arrays may have leading dimensions, such as one of the blades, which are alike.
    Raises InputError where the blade's airfoils have no polars, unless these are not needed:
    then there are no forces, and lift coefficients are told all the same.
    """

    def __init__(
        self,
        lattice: BladeLattice,
        air_density: float = AIR_DENSITY,
        *,
        needs_polars: bool = True,
    ) -> None:
        self.lattice, self.air_density = lattice, air_density
        without = lattice.sections is None and not needs_polars
        if without:
            self.polars = SectionPolars.none(len(lattice.chord) - 1)
        else:
            self.polars = SectionPolars.of_blade(lattice.sections, "blade")
        chord = lattice.chord
        self._chord = 0.5 * (chord[1:] + chord[:-1])
        self._bare = ~self.polars.lifting & (not without)
        self._bare[: lattice.bare_strips] = True

    def points(self, position: Array, rotation: Array) -> Array:
        """Where the strips (..., N, 3) m meet the wind, for frames (..., N+1, 3) m."""
        ends = position + np.einsum("...nab,nb->...na", rotation, self.lattice.quarter_chord)
        return 0.5 * (ends[..., 1:, :] + ends[..., :-1, :])

    def air(
        self,
        position: Array,
        rotation: Array,
        velocity: Array,
        angular_velocity: Array,
        wind: Array,
    ) -> StripAir:
        """The air at the strips in a motion of the frames, with ``wind`` (..., N, 3) m/s there."""
        arm = np.einsum("...nab,nb->...na", rotation, self.lattice.quarter_chord)
        span = np.diff(position + arm, axis=-2)
        along = span / np.linalg.norm(span, axis=-1, keepdims=True)
        aft = _middles(rotation[..., 1])
        aft = aft - np.sum(aft * along, axis=-1, keepdims=True) * along
        aft = aft / np.linalg.norm(aft, axis=-1, keepdims=True)
        suction = cross_products(aft, along)
        relative = wind - _middles(velocity + cross_products(angular_velocity, arm))
        across = np.sum(relative * suction, axis=-1)
        chordwise = np.sum(relative * aft, axis=-1)
        speed = np.hypot(across, chordwise)
        unit = np.maximum(speed, CALM)[..., None]
        return StripAir(
            arm=arm,
            span=span,
            velocity=across[..., None] * suction + chordwise[..., None] * aft,
            speed=speed,
            lift=(chordwise[..., None] * suction - across[..., None] * aft) / unit,
            angle=np.arctan2(across, chordwise),
        )

    def loads(
        self, air: StripAir, strip_force: Array, angle_of_attack: Array | None = None
    ) -> PolarLoads:
        """Loads beside those of the lattice, whose strips carry ``strip_force`` (..., n, 3) N.

        ``angle_of_attack`` (..., n) rad, where decambering knows it, replaces the branch: the
        drag is the polar's at that angle, and nothing is outside.
        """
        area = self._chord * np.linalg.norm(air.span, axis=-1)
        pressure = 0.5 * self.air_density * air.speed**2
        lift = self._lattice_lift(air, strip_force, pressure * area)
        state = self.polars.at_lift(lift)
        angle = np.where(self._bare, air.angle, state.angle_of_attack)
        outside = np.where(self._bare, 0, state.outside).astype(np.int8)
        if angle_of_attack is not None:
            known = slice(self.lattice.bare_strips, None)
            angle[..., known] = np.where(self._bare[known], angle[..., known], angle_of_attack)
            outside[:] = 0
        coefficients = self.polars.at_angle(angle)
        by_angle = self._bare if angle_of_attack is None else True
        drag = np.where(by_angle, coefficients[..., 1], state.drag)
        lift = np.where(self._bare, coefficients[..., 0], lift)
        bare = np.where(self._bare, area, 0.0)
        force = (0.5 * self.air_density * air.speed * area * drag)[..., None] * air.velocity
        force += (pressure * bare * lift)[..., None] * air.lift
        turn = (pressure * bare * self._chord * coefficients[..., 2])[..., None] * (
            air.span / np.linalg.norm(air.span, axis=-1, keepdims=True)
        )
        lumped = _to_stations(force)
        moment = cross_products(air.arm, lumped) + _to_stations(turn)
        return PolarLoads(lumped, moment, lift, drag, angle, outside)

    def describe_outside(self, blade: str, strip: int, lift: float) -> str:
        """Which section is outside its polar's attached branch and by what, in a sentence."""
        low, high = self.polars.lift_range[strip]
        limit, word = (high, "above the greatest") if lift > high else (low, "below the least")
        sections = self.lattice.sections
        assert sections is not None, "PolarForces has polars"
        place = f"{blade}, at {sections.span[strip]:.1%} of the span"
        polar = f"the attached polar of {sections.airfoil_at(strip)!r}"
        return f"{place}: the lift coefficient {lift:.2f} is {word} of {polar}, {limit:.2f}"

    def _lattice_lift(self, air: StripAir, strip_force: Array, scale: Array) -> Array:
        """Lift coefficients (..., N) of the lattice; 0 on bare strips and in calm air."""
        lift = np.zeros(air.speed.shape)
        k = self.lattice.bare_strips
        lift[..., k:] = np.sum(strip_force * air.lift[..., k:, :], axis=-1)
        return np.where(air.speed > CALM, lift / np.maximum(scale, np.finfo(float).tiny), 0.0)


def _middles(values: Array) -> Array:
    return 0.5 * (values[..., 1:, :] + values[..., :-1, :])


def _to_stations(strips: Array) -> Array:
    """Half of each strip's vector (..., N, 3) to the station at either end (..., N+1, 3)."""
    stations = np.zeros((*strips.shape[:-2], strips.shape[-2] + 1, 3))
    stations[..., :-1, :] += 0.5 * strips
    stations[..., 1:, :] += 0.5 * strips
    return stations
