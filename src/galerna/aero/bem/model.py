"""Blade-element momentum theory as a load model of the machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf

import numpy as np

from galerna.aero.bem import channels
from galerna.aero.bem import rotor as r
from galerna.aero.bem import strips as s
from galerna.aero.bem.dynamic_stall import JONES, section_parameters, separation_table
from galerna.aero.bem.momentum import Momentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.rotational_augmentation import augment
from galerna.aero.bem.spanwise_filter import filter_matrix
from galerna.aero.sections import BladeSections, blade_sections
from galerna.aero.tower_influence import add_tower_influence, tower_sections
from galerna.contract import Array, Channel, Inflow, Loads, Motion, Stations
from galerna.errors import ConvergenceError
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY

FIRST_GUESS = 0.2  #: rad, of the inflow angle
RATED_WIND = 11.0  #: m/s, where a turbine does not say
FEEDBACK_PASSES = 50  #: of the filtered lift through the momentum balance, before a start


class BladeElementMomentum:
    """Aerodynamic loads of the rotor by blade-element momentum theory.

    It sees the frames of the blades' stations, of the hub and, for its influence on the wind,
    of the tower, whatever moves them, and the ``inflow`` at the strips. Velocities are taken
    in the plane across the span of each moving, deflected section; the momentum balance is
    that of the annulus the strip sweeps, with its radius from the shaft axis and the induced
    velocity along the shaft. Structural velocities count as wind for the balance of the
    moment and are delayed like it.
    Raises InputError where the turbine's blade or polars cannot be used.
    """

    channels: tuple[Channel, ...] = channels.CHANNELS
    largest_step: float = inf  #: every memory is integrated exactly or implicitly

    def __init__(
        self,
        turbine: Turbine,
        inflow: Inflow,
        *,
        air_density: float = AIR_DENSITY,
        options: BemOptions | None = None,
    ) -> None:
        self.options = options if options is not None else BemOptions()
        self.inflow = inflow
        self.sections = rotor_sections(turbine, self.options)
        blades, n = turbine.number_of_blades, len(self.sections)
        self.stations = (
            *(Stations(f"blade{b + 1}", self.sections.span) for b in range(blades)),
            Stations("hub"),
            *(
                (Stations("tower", turbine.tower.axis_span),)
                if self.options.tower_influence
                else ()
            ),
        )
        self.coordinates: Mapping[str, Array] = {
            "blade": np.arange(1.0, blades + 1.0),
            "radius": turbine.hub.radius + self.sections.position[:, 2],
        }
        self._rotor = rotor_settings(turbine, self.options, air_density, n)
        self._shape = np.tile(strip_shapes(self.sections, turbine.blade.length), (blades, 1))
        self._table, self._stall = stall_tables(self.sections, self.options)
        self._spanwise = spanwise_matrix(self.sections, turbine.blade.length, self._rotor)
        self._whole_circle = bool(
            np.all(np.ptp(self.sections.coverage, axis=1) >= 2 * np.pi - 0.02)
        )
        self._tower = tower_sections(turbine.tower, turbine.tower.axis_span)
        self._allocate(blades * n, blades)

    def _allocate(self, strips: int, blades: int) -> None:
        self._memory = np.zeros((strips, r.MEMORY_COLUMNS))
        self._memory[:, r.GUESS] = FIRST_GUESS
        self._before, self._after = self._memory.copy(), np.zeros_like(self._memory)
        self._started, self._dt = False, -1.0
        self._points = np.zeros((strips, 3))
        self._strips = np.zeros((strips, s.STRIP_COLUMNS))
        self._totals = np.zeros(r.ROOT_MOMENTS + 2 * blades)
        self._shown = self._strips.copy(), self._totals.copy()

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Prepare a trial of ``dt`` s; the first one starts from the long-lasting flow."""
        if not self._started:
            self._before = self._long_lasting(time, motion)
        self._dt = dt

    def loads(self, time: float, motion: Motion) -> Loads:
        """Forces and moments on all stations; the hub's and the tower's are zero."""
        loads = Loads.zero(len(motion.position))
        s.aerodynamic_centers(motion.position, motion.rotation, self._shape, self._points)
        r.rotor_loads(
            self._rotor,
            self._points,
            motion.position,
            motion.rotation,
            motion.velocity,
            motion.angular_velocity,
            self._wind(time, motion),
            self._shape,
            self._table,
            self._stall,
            self._spanwise,
            self._before,
            self._dt,
            self._after,
            self._strips,
            self._totals,
            loads.force,
            loads.moment,
        )
        return loads

    def end_step(self, time: float, motion: Motion) -> None:
        """Commit the memories of the last ``loads``."""
        if not self._whole_circle:
            angles = self._strips[:, s.ANGLE_OF_ATTACK].reshape(-1, len(self.sections))
            self.sections.check_angles(angles)
        self._memory[:] = self._after
        self._before = self._memory
        self._started, self._dt = True, 0.0
        self._shown[0][:], self._shown[1][:] = self._strips, self._totals

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        return channels.record(self._rotor, *self._shown)

    def state(self) -> dict[str, np.ndarray]:
        """Every memory of every strip, (m,16), and whether the flow has started."""
        return {"memory": self._memory.copy(), "started": np.array(self._started)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._memory[:] = state["memory"]
        self._before, self._started = self._memory, bool(state["started"])
        self._dt = 0.0 if self._started else -1.0

    def _long_lasting(self, time: float, motion: Motion) -> Array:
        """Memories (m,16) of a flow that has for ever been as it is now."""
        before, dt = self._before, self._dt
        self._before, self._dt = self._memory.copy(), -1.0
        feedback = self._rotor.spanwise_filter == r.FILTER_FEEDBACK
        for _ in range(FEEDBACK_PASSES if feedback else 1):
            self.loads(time, motion)
            self._before[:] = self._after
        started, self._before, self._dt = self._before, before, dt
        return started

    def _wind(self, time: float, motion: Motion) -> Array:
        """Wind (m,3) m/s at the strips, as the tower lets it through."""
        wind = self.inflow.velocity(self._points, time)
        if not self.options.tower_influence:
            return wind
        tower, velocity = slice(len(wind) + 1, None), np.array(wind)
        inside = add_tower_influence(
            self._points,
            motion.position[tower],
            motion.velocity[tower],
            self._tower,
            True,
            velocity,
        )
        if inside >= 0:
            blade, station = divmod(inside, len(self.sections))
            raise ConvergenceError(
                f"blade{blade + 1}",
                f"is inside the tower at {self.sections.span[station]:.1%} of its span",
                "check overhang, tilt, cone and prebend, or the deflection",
                time,
            )
        return velocity


def rotor_sections(turbine: Turbine, options: BemOptions) -> BladeSections:
    """The strips of one blade as the options want them, stall delayed by rotation included."""
    sections = blade_sections(turbine, options.stations)
    method = options.rotational_augmentation
    if method == "none":
        return sections
    control, table = turbine.control, sections.table.copy()
    speed = control.rated_rotor_speed * turbine.rotor_radius
    ratio = control.optimal_tip_speed_ratio or speed / (control.rated_wind_speed or RATED_WIND)
    radius = turbine.hub.radius + sections.position[:, 2]
    fraction = radius / (turbine.hub.radius + turbine.blade.axis[-1, 2])
    for i, chord in enumerate(sections.chord):
        table[i, :, 0], table[i, :, 1] = augment(
            sections.angles,
            table[i, :, 0],
            table[i, :, 1],
            method,
            chord / radius[i],
            fraction[i],
            ratio,
        )
    return replace(sections, table=table)


def rotor_settings(
    turbine: Turbine, options: BemOptions, air_density: float, strips_per_blade: int
) -> r.Rotor:
    """The turbine and the options as numbers, for the kernels."""
    return r.Rotor(
        air_density=float(air_density),
        radius=turbine.rotor_radius,
        hub_radius=float(turbine.hub.radius),
        cone=float(turbine.hub.cone),
        blades=turbine.number_of_blades,
        strips_per_blade=strips_per_blade,
        momentum=Momentum.of(options, turbine.number_of_blades),
        induction=options.induction,
        skewed_wake=("none", "pitt_peters", "vortex_cylinder").index(options.skewed_wake),
        dynamic_inflow=options.has_dynamic_inflow,
        unsteady_airfoil=options.has_unsteady_airfoil,
        three_quarter_chord=options.angle_of_attack_point == "three_quarter_chord",
        spanwise_filter=("off", "loads", "feedback").index(options.spanwise_filter),
        tip_unloaded=options.induction and options.tip_loss,
        root_unloaded=options.induction and options.root_loss,
    )


def strip_shapes(sections: BladeSections, length: float) -> Array:
    """Constants (n,7) of the strips of one blade of ``length`` m, for the kernels."""
    shape = np.zeros((len(sections), s.SHAPE_COLUMNS))
    shape[:, [s.CENTER_X, s.CENTER_Y]] = sections.aerodynamic_center
    shape[:, s.OFFSET], shape[:, s.WEIGHT] = sections.offset, sections.weight
    shape[:, s.CHORD] = sections.chord
    shape[:, s.TO_TIP] = (1.0 - sections.span) * length
    shape[:, s.TO_ROOT] = sections.span * length
    return shape


def stall_tables(sections: BladeSections, options: BemOptions) -> tuple[Array, Array]:
    """The polars with the separation columns (n,m,5) and the stall model's constants (n,9)."""
    zero_lift = np.array([u.zero_lift_angle for u in sections.unsteady])
    table, lift_line = separation_table(sections.table, zero_lift)
    indicial = np.array(JONES)
    if options.indicial_response == "airfoil":
        indicial = np.array(
            [(*u.indicial_amplitudes, *u.indicial_exponents) for u in sections.unsteady]
        )
    return table, section_parameters(lift_line, indicial)


def spanwise_matrix(sections: BladeSections, length: float, rotor: r.Rotor) -> Array:
    """The filter of the circulation along a blade (n,n); unloaded ends stay unloaded.

    Sections whose polar has no lift at all (the cylinders at the root) carry no circulation:
    the filter ends midway between them and the first one outboard that does.
    """
    matrix = np.zeros((len(sections), len(sections)))
    lifting = np.logical_and.accumulate(sections.table[::-1, :, 0].any(axis=1)).sum()
    if rotor.spanwise_filter == r.FILTER_OFF or lifting < 2:
        return matrix
    first = len(sections) - int(lifting)
    place, outer = sections.span * length, slice(first, None)
    start = 0.5 * (place[first - 1] + place[first]) if first else 0.0
    matrix[outer, outer] = filter_matrix(place[outer], sections.chord[outer], (start, length))
    matrix[(sections.span <= 0.0) & rotor.root_unloaded] = 0.0
    matrix[(sections.span >= 1.0) & rotor.tip_unloaded] = 0.0
    return matrix
