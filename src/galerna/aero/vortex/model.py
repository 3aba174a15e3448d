"""The unsteady vortex lattice as a load model of the machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from galerna.aero.vortex import channels
from galerna.aero.vortex.blades import BladeLattice, blade_lattice
from galerna.aero.vortex.channels import Frames, StripState
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.aero.vortex.separation import blade_separation
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.start import drifted_wake
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.tower_wind import TowerWind
from galerna.aero.vortex.unsteady import Solution, UnsteadyLattice, UnsteadyOptions
from galerna.aero.vortex.viscous import PolarForces, PolarLoads, StripAir
from galerna.aero.vortex.wake import RotorAxis, Wake
from galerna.aero.vortex.wake_size import wake_size
from galerna.contract import Array, Channel, Inflow, Loads, Motion, Stations
from galerna.errors import ConvergenceError
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY

SLOWEST_WINDMILL = 0.05  #: wind along the shaft over tip speed, for a start with a free wake
GROUND = MirrorPlane(np.zeros(3), np.array([0.0, 0.0, 1.0]))


@dataclass(frozen=True, eq=False)
class _Evaluation:
    """One answer of the model: where the blades were, the flow about them, and the loads."""

    frames: Frames
    surfaces: list[Surface]
    solution: Solution
    wind: Array
    air: StripAir
    polar: PolarLoads
    force: Array
    moment: Array


class VortexLattice:
    """Aerodynamic loads of the rotor by the unsteady vortex lattice.

    It sees the frames of the blades' stations, of the hub and, for its influence on the wind, of
    the tower. ``inflow`` is the wind everywhere and ``wake_inflow`` the one that moves the wake,
    if another. The mean ``rotor_speed`` rad/s and ``wind_speed`` m/s size the wake, whose own
    step becomes a whole number of the ``time_step`` s where one is given.
    Raises InputError where the turbine's blade or polars, or the options, cannot be used.
    """

    def __init__(
        self,
        turbine: Turbine,
        inflow: Inflow,
        *,
        rotor_speed: float,
        wind_speed: float,
        time_step: float | None = None,
        air_density: float = AIR_DENSITY,
        options: VortexLatticeOptions | None = None,
        wake_inflow: Inflow | None = None,
    ) -> None:
        self.options = VortexLatticeOptions() if options is None else options
        self.inflow, self.turbine = inflow, turbine
        self.lattice = _blade_lattice(turbine, self.options)
        self.wake_size = wake_size(
            self.options, rotor_speed, wind_speed, turbine.rotor_radius, time_step
        )
        self.blades = [f"blade{b + 1}" for b in range(turbine.number_of_blades)]
        tower = self.options.tower_influence
        self.stations = (
            *(Stations(name, self.lattice.stations) for name in self.blades),
            Stations("hub"),
            *((Stations("tower", turbine.tower.axis_span),) if tower else ()),
        )
        self._polar = PolarForces(self.lattice, air_density, needs_polars=self.options.drag)
        self._density = air_density
        self._tower_wind = TowerWind(inflow, turbine.tower, self.stations) if tower else None
        self._flow = UnsteadyLattice(
            inflow if self._tower_wind is None else self._tower_wind,
            self.wake_size.all_ages,
            _unsteady_options(self.options, self.lattice, air_density),
            wake_inflow=inflow if wake_inflow is None else wake_inflow,
            names=self.blades,
            summed_rows=self.wake_size.rows,
            separation=(
                blade_separation(self.lattice, turbine.blade, self.blades)
                if self.options.decambering
                else None
            ),
        )
        self._probes = np.array(self.options.probes_m, dtype=float).reshape(-1, 3)
        self._trial: _Evaluation | None = None
        self._shown: _Evaluation | None = None
        self._time = 0.0
        self._started = False
        self._first: tuple[Array, Wake | None] | None = None
        self._start_notice = ""
        self._told: dict[tuple[int, int], str] = {}  # notices by blade and strip

    @property
    def channels(self) -> tuple[Channel, ...]:
        """What ``record`` gives."""
        return channels.CHANNELS + (channels.PROBE_CHANNELS if len(self._probes) else ())

    @property
    def coordinates(self) -> Mapping[str, Array]:
        """Numbers of the blades and probes, and the radii m of the strips' middles."""
        position, _ = blade_frames(self.turbine.blade, self.lattice.stations)
        height = self.turbine.hub.radius + position[:, 2]
        return {
            "blade": np.arange(1.0, len(self.blades) + 1.0),
            "radius": 0.5 * (height[1:] + height[:-1]),
            **({"probe": np.arange(1.0, len(self._probes) + 1.0)} if len(self._probes) else {}),
        }

    @property
    def largest_step(self) -> float:
        """The wake's own step, s."""
        return self.wake_size.step

    @property
    def notices(self) -> list[str]:
        """What a user should know of the run so far, a line each."""
        return [line for line in (self._start_notice, *self._told.values()) if line]

    @property
    def wake_panels(self) -> int:
        """Panels of all wakes."""
        strips = len(self.lattice.span) - 1
        return len(self.blades) * strips * (len(self.wake_size.ages) - 1)

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Carry the wake on for ``dt`` s."""
        self._see_tower(motion, time)
        frames = self._frames(motion)
        axis = RotorAxis(frames.hub, frames.shaft[:, 0], frames.rotor_speed, frames.hub_velocity)
        surfaces = self._surfaces(frames)
        wake = None if self._started else self._first_wake(time, surfaces, axis)
        self._flow.begin_step(time, dt, surfaces, axis, wake)
        self._trial = None

    def loads(self, time: float, motion: Motion) -> Loads:
        """Forces and moments on all stations; the hub's and the tower's are zero."""
        self._see_tower(motion, time)
        self._trial = made = self._evaluate(time, self._frames(motion))
        loads = Loads.zero(len(motion.position))
        count = made.force.shape[0] * made.force.shape[1]
        loads.force[:count] = made.force.reshape(-1, 3)
        loads.moment[:count] = made.moment.reshape(-1, 3)
        return loads

    def end_step(self, time: float, motion: Motion) -> None:
        """Accept the step of the last ``loads``."""
        if self._trial is None:
            self.loads(time, motion)
        assert self._trial is not None
        self._flow.end_step(time, self._trial.surfaces)
        self._shown, self._trial, self._time = self._trial, None, time
        self._started = True
        if self.options.drag:
            self._notice_outside(self._shown.polar, time)

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        if self._shown is None:
            raise ConvergenceError("vortex lattice", "there is no accepted step to show yet")
        shown = self._shown
        strips = self._strip_state(shown)
        hub = self.turbine.hub
        rotor = (self._density, self.turbine.rotor_radius, hub.radius, hub.cone)
        return {
            **channels.strip_values(shown.frames, strips),
            **channels.whole_rotor(shown.frames, strips, shown.force, shown.moment, rotor),
            "wake_panels": float(self.wake_panels),
            "sections_outside_polar": float(np.count_nonzero(shown.polar.outside)),
            **(channels.probe_values(self.velocity(self._probes)) if len(self._probes) else {}),
        }

    def velocity(self, points: Array) -> Array:
        """Velocity (...,3) m/s of the air at points (...,3) m, after the accepted step.

        Wind and all vortices, without the tower's influence. Raises InputError before the
        first step.
        """
        points = np.asarray(points, dtype=float)
        wind = self.inflow.velocity(points.reshape(-1, 3), self._time).reshape(points.shape)
        return wind + self._flow.induced_velocity(points)

    def sheets(self) -> list[Sheet]:
        """The wake of each blade, then its bound vortices, after the accepted step."""
        return self._flow.sheets()

    def state(self) -> dict[str, np.ndarray]:
        """The wakes and the last circulations, their time, and of which strips was told."""
        if not self._started:
            return {}
        told = np.array(list(self._told), dtype=np.int64).reshape(-1, 2)
        return {**self._flow.state(), "told": told, "time": np.array(self._time)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._flow.restore(state)
        self._trial, self._started = None, bool(state)
        self._time = float(state.get("time", 0.0))
        told = [(int(b), int(strip)) for b, strip in state.get("told", ())]
        self._told = {place: self._told.get(place, "") for place in told}

    def _frames(self, motion: Motion) -> Frames:
        blades, stations = len(self.blades), len(self.lattice.stations)
        hub = blades * stations
        own = slice(0, hub)

        def of(values: Array) -> Array:
            return values[own].reshape(blades, stations, *values.shape[1:]).copy()

        shaft = motion.rotation[hub].copy()
        return Frames(
            of(motion.position),
            of(motion.rotation),
            of(motion.velocity),
            of(motion.angular_velocity),
            motion.position[hub].copy(),
            shaft,
            motion.velocity[hub].copy(),
            float(motion.angular_velocity[hub] @ shaft[:, 0]),
        )

    def _surfaces(self, frames: Frames) -> list[Surface]:
        columns = slice(self.lattice.bare_strips, None)
        return [
            Surface(
                Lattice(self.lattice.place(position[columns], rotation[columns])),
                self.lattice.velocity(rotation[columns], velocity[columns], turning[columns]),
            )
            for position, rotation, velocity, turning in zip(
                frames.position,
                frames.rotation,
                frames.velocity,
                frames.angular_velocity,
                strict=True,
            )
        ]

    def _evaluate(self, time: float, frames: Frames) -> _Evaluation:
        surfaces = self._surfaces(frames)
        solution = self._flow.solve(time, surfaces)
        points = self._polar.points(frames.position, frames.rotation)
        wind = self._flow.inflow.velocity(points.reshape(-1, 3), time).reshape(points.shape)
        air = self._polar.air(
            frames.position, frames.rotation, frames.velocity, frames.angular_velocity, wind
        )
        strip_force = np.stack([load.strip_force for load in solution.loads])
        polar = self._polar.loads(air, strip_force, self._separated_angles())
        force, moment = np.zeros_like(frames.position), np.zeros_like(frames.position)
        if self.options.drag:
            force += polar.force
            moment += polar.moment
        first = self.lattice.bare_strips
        for b, load in enumerate(solution.loads):
            column_force, column_moment = load.column_loads(frames.position[b, first:])
            force[b, first:] += column_force
            moment[b, first:] += column_moment
        return _Evaluation(frames, surfaces, solution, wind, air, polar, force, moment)

    def _strip_state(self, shown: _Evaluation) -> StripState:
        """The strips of an evaluation, with the air that they feel."""
        flow, first = shown.solution.flow, self.lattice.bare_strips
        moving = np.cross(shown.frames.angular_velocity, shown.air.arm) + shown.frames.velocity
        undisturbed = shown.wind - 0.5 * (moving[:, 1:] + moving[:, :-1])
        effective = undisturbed.copy()
        circulation = np.zeros(undisturbed.shape[:2])
        along_span = channels.air_along_spans(shown.surfaces, shown.solution.air)
        for b, surface in enumerate(shown.surfaces):
            effective[b, first:] = channels.effective_air(
                surface, flow.circulation[b], along_span[b]
            )
            circulation[b, first:] = flow.circulation[b][-1]
        force = self._polar_strip_force(shown)
        force[:, first:] += np.stack([load.strip_force for load in shown.solution.loads])
        drag = shown.polar.drag_coefficient if self.options.drag else np.zeros_like(circulation)
        width = np.linalg.norm(shown.air.span, axis=-1)
        lift = shown.polar.lift_coefficient
        return StripState(width, shown.wind, undisturbed, effective, force, circulation, lift, drag)

    def _polar_strip_force(self, shown: _Evaluation) -> Array:
        """Forces (B,N,3) N on the strips from polars."""
        if not self.options.drag:
            return np.zeros_like(shown.wind)
        air, polar = shown.air, shown.polar
        chord = 0.5 * (self.lattice.chord[1:] + self.lattice.chord[:-1])
        area = 0.5 * self._density * chord * np.linalg.norm(air.span, axis=-1) * air.speed
        force = (area * polar.drag_coefficient)[..., None] * air.velocity
        bare = slice(0, self.lattice.bare_strips)
        lift = (area * air.speed * polar.lift_coefficient)[..., None] * air.lift
        force[:, bare] += lift[:, bare]
        return force

    def _first_wake(self, time: float, surfaces: list[Surface], axis: RotorAxis) -> Wake | None:
        """What ``_drifted_wake`` finds, sought once for a motion."""
        moving = [a for s in surfaces for a in (s.lattice.corners, s.velocity)]
        seen = np.concatenate([np.array([time]), *(a.ravel() for a in moving)])
        if self._first is None or not np.array_equal(self._first[0], seen):
            self._start_notice = ""
            self._first = seen, self._drifted_wake(time, surfaces, axis)
        return self._first[1]

    def _drifted_wake(self, time: float, surfaces: list[Surface], axis: RotorAxis) -> Wake | None:
        """Where the first free wake lies, None where it begins as a helix along the wind."""
        free, settings = self.options.wake == "free", self._flow.options
        edges = np.concatenate([s.lattice.vertices[-1] for s in surfaces])
        wind = self._flow.wake_inflow.velocity(edges, time).mean(axis=0) - axis.velocity
        through = wind @ axis.direction
        windmill = through > SLOWEST_WINDMILL * abs(axis.speed) * self.turbine.rotor_radius > 0.0
        if not (free and self.options.start == "steady" and windmill):
            return None
        try:
            return drifted_wake(surfaces, self._flow.ages, axis, wind, settings.core)
        except ConvergenceError as error:
            self._start_notice = f"the run begins with the wake along the wind: {error.what}"
            return None

    def _separated_angles(self) -> Array | None:
        """Angles of attack (B,n) rad that decambering found; None without it."""
        separation = self._flow.separation
        if separation is None or separation.found is None:
            return None
        return separation.found.flow.angle_of_attack.reshape(len(self.blades), -1)

    def _see_tower(self, motion: Motion, time: float) -> None:
        if self._tower_wind is not None:
            self._tower_wind.see(motion, time)

    def _notice_outside(self, polar: PolarLoads, time: float) -> None:
        """Keep a notice of every section that leaves its polar's attached branch, once."""
        for blade, strip in np.argwhere(polar.outside):
            place = int(blade), int(strip)
            if place in self._told:
                continue
            lift = float(polar.lift_coefficient[place])
            said = self._polar.describe_outside(self.blades[place[0]], place[1], lift)
            self._told[place] = f"t = {time:.6g} s: {said}"


def _blade_lattice(turbine: Turbine, options: VortexLatticeOptions) -> BladeLattice:
    return blade_lattice(
        turbine,
        chordwise=options.chordwise_panels,
        spanwise=options.spanwise_panels,
        chordwise_spacing=options.chordwise_spacing,
        spanwise_spacing=options.spanwise_spacing,
        camber=options.camber,
        root_span=options.root_span,
    )


def _unsteady_options(
    options: VortexLatticeOptions, lattice: BladeLattice, air_density: float
) -> UnsteadyOptions:
    chord = lattice.chord[lattice.bare_strips :]
    mean_chord = np.trapezoid(chord, lattice.span) / np.ptp(lattice.span)
    return UnsteadyOptions(
        free=options.wake == "free",
        scheme=options.wake_scheme,
        core=VortexCore(options.core_radius * float(mean_chord), options.core_growth),
        tree_error=options.tree_error or None,
        wake_precision=options.precision,
        start=options.start,
        multirate=options.wake_multirate,
        hold_influences=True,
        quasi_steady=options.quasi_steady,
        mirror=GROUND if options.ground else None,
        air_density=air_density,
    )
