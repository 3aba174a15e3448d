"""Lifting surfaces that move as they like, and the wakes they shed.

The order of the calls is that of ``contract.LoadModel``: ``begin_step`` carries the wake on,
``solve`` finds the circulation that lets no flow through the surfaces as they stand at the end of
the step and may be called many times, ``end_step`` accepts.

The wake has its own clock: it sheds a row when the age of its first panel has elapsed. In between
the wake at every instant is made from the one last shed, so steps that are smaller than a
panel do not spread it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from galerna.aero.vortex.far_wake import FarWake
from galerna.aero.vortex.flow import (
    EdgeInfluence,
    Flow,
    NearField,
    bound_flow,
    control_points,
    edge_flow,
    edge_influence,
    segment_air,
    strip_flow,
    wind_at,
)
from galerna.aero.vortex.loads import SurfaceLoads, lattice_loads
from galerna.aero.vortex.memory import Memory, from_arrays, to_arrays
from galerna.aero.vortex.quasi_steady import steady_wake
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.separation import Separation
from galerna.aero.vortex.shedding import History, Shedding, edge_panels, shedding
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface, collocation_velocities
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.thinning import Integers
from galerna.aero.vortex.unsteady_options import UnsteadyOptions
from galerna.aero.vortex.wake import Wake, courant_numbers
from galerna.aero.vortex.wake_clock import WakeClock
from galerna.contract import Array, Inflow
from galerna.errors import InputError


@dataclass(frozen=True, eq=False)
class Solution:
    """Circulations, their rates (m,n) m2/s2, None at first, and loads of the surfaces.

    ``air`` (S,3) m/s is the velocity of the air relative to the loaded segments.
    """

    flow: Flow
    circulation_rate: list[Array] | None
    air: Array
    loads: list[SurfaceLoads]

    @property
    def circulation(self) -> list[Array]:
        """Circulations (m,n) m2/s of the rings of each surface."""
        return self.flow.circulation


@dataclass(eq=False)
class _Trial:
    """A step under way: whence, how long, the circulation shed, the wake and its field.

    ``held`` is what the first solution found of influences and leaves to the others.
    """

    memory: Memory
    dt: float
    shed: list[Shedding]
    wake: Wake
    near: NearField
    held: _Influences | None = None
    solution: Solution | None = None


@dataclass(frozen=True, eq=False)
class _Influences:
    """Of the wake on surfaces: velocity (P,3) m/s by the far part, and what the first panels do."""

    far: Array
    edge: EdgeInfluence


class UnsteadyLattice:
    """Bound vortices of moving surfaces and the wakes they shed, in an ``inflow``.

    ``ages`` (K+1,) s are those of the rows of the wakes (see ``ages``); no step may be longer than
    ``ages[1]``. ``wake_inflow`` is the wind that moves the wakes, if another one; ``names`` are
    what errors call the surfaces; ``separation`` brings their sections' lift to polars.
    ``summed_rows`` are those of wakes that induce velocity, all by default: see `thinning`.
    """

    def __init__(
        self,
        inflow: Inflow,
        ages: Array,
        options: UnsteadyOptions | None = None,
        *,
        wake_inflow: Inflow | None = None,
        names: Sequence[str] = (),
        separation: Separation | None = None,
        summed_rows: Integers | None = None,
    ) -> None:
        self.inflow, self.separation = inflow, separation
        self.options = UnsteadyOptions() if options is None else options
        self.system = BoundSystem(mirror=self.options.mirror)
        self.wake_inflow = inflow if wake_inflow is None else wake_inflow
        self.clock = WakeClock(self.wake_inflow, ages, self.options, names, summed_rows)
        self._memory: Memory | None = None
        self._trial: _Trial | None = None

    @property
    def ages(self) -> Array:
        """Ages (K+1,) s of the rows of the wakes."""
        return self.clock.ages

    @property
    def _smooth(self) -> bool:
        """Whether velocities may be interpolated: where sums may err."""
        return self.options.tree_error is not None

    @property
    def largest_step(self) -> float:
        """The longest step, s: the age of the first panel."""
        return self.clock.step

    def begin_step(
        self,
        time: float,
        dt: float,
        surfaces: Sequence[Surface],
        axis: RotorAxis | None = None,
        wake: Wake | None = None,
    ) -> None:
        """Carry the wake from ``time`` over ``dt`` s; ``surfaces`` and ``axis`` are as at ``time``.

        About the ``axis`` of a rotor its wake keeps its radius. The first step starts from the
        ``wake`` given, or as ``options.start`` says. Raises InputError for too long a step and
        ConvergenceError for a wake that diverges.
        """
        self.system.reject()
        courant_numbers(self.ages, dt)
        memory = self._memory or self._start(time, surfaces, axis, wake)
        if self.clock.overflows(memory.elapsed + dt):
            memory = self.clock.shed(memory, self.clock.wake_at(memory), time)
        if memory.convection is None:
            memory = replace(memory, convection=self.clock.convection(memory, time, axis))
        shed = self._shedding(memory, surfaces, dt)
        total = [i + dt * new.known for i, new in zip(memory.shed, shed, strict=True)]
        wake = self.clock.advanced(memory, memory.elapsed + dt, total)
        self.system.guess(np.concatenate([g.ravel() for g in memory.circulation]))
        near = NearField(self.options.mirror, self._smooth)
        self._trial = _Trial(memory, dt, shed, wake, near)

    def solve(self, time: float, surfaces: Sequence[Surface]) -> Solution:
        """The flow about ``surfaces`` where they are at ``time``, the end of the step begun.

        Raises InputError for a wind that is not finite, naming the surface and the place.
        """
        trial = self._begun()
        trial.wake.attach([s.lattice.vertices[-1] for s in surfaces])
        if trial.held is None:
            self.system.reject()
            self.system.place(surfaces)
        flow = self._flow(trial, time, surfaces)
        if trial.solution is None and self.options.hold_influences:
            self.system.guess(np.concatenate([g.ravel() for g in flow.circulation]))
        rate = None if self.options.quasi_steady else trial.memory.rates(flow.circulation, trial.dt)
        options = self.options
        near = trial.near.velocity(surfaces, flow)
        air = segment_air(surfaces, flow, near)
        loads = lattice_loads(surfaces, flow.circulation, air, options.air_density, rate)
        trial.solution = Solution(flow, rate, air, loads)
        return trial.solution

    def end_step(self, time: float, surfaces: Sequence[Surface]) -> None:
        """Accept the step, with the ``surfaces`` of the last ``solve``."""
        trial = self._begun()
        solution = trial.solution or self.solve(time, surfaces)
        before = trial.memory
        trailing = [g[-1] for g in solution.circulation]
        for panel, new, edge in zip(trial.wake.circulation, trial.shed, trailing, strict=True):
            panel[0] += trial.dt / self.largest_step * new.share * edge
        trails = [
            new.history.extended(edge, self.largest_step + new.delay.max())
            for new, edge in zip(trial.shed, trailing, strict=True)
        ]
        shed = [
            i + trial.dt * new.total(edge)
            for i, new, edge in zip(before.shed, trial.shed, trailing, strict=True)
        ]
        memory = replace(
            before,
            corners=[s.lattice.corners.copy() for s in surfaces],
            circulation=solution.circulation,
            speed=_speed(surfaces, solution.flow.wind),
            elapsed=before.elapsed + trial.dt,
            shed=shed,
            trailing=[values for _, values in trails],
            times=[times for times, _ in trails],
            past=before.circulation,
            past_step=trial.dt,
        )
        if self.clock.overflows(memory.elapsed + trial.dt):
            memory = self.clock.shed(memory, trial.wake, time)
        self.system.accept()
        if self.separation is not None:
            self.separation.accept()
        self._memory, self._trial = memory, None

    def wake(self) -> Wake:
        """The wake as it is at the end of the last accepted step."""
        return self.clock.wake_at(self._accepted())

    def sheets(self) -> list[Sheet]:
        """The wakes, then the bound vortices, at the end of the last accepted step."""
        memory = self._accepted()
        summed = self.clock.thinning.wake(self.clock.wake_at(memory))
        return self.clock.sheets(memory, summed, 0.0)

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity (...,3) m/s of wind and vortices at points (...,3) m, after an accepted step."""
        points = np.asarray(points, dtype=float)
        wind = self.inflow.velocity(points.reshape(-1, 3), time).reshape(points.shape)
        return wind + self.induced_velocity(points)

    def induced_velocity(self, points: Array) -> Array:
        """Velocity (...,3) m/s of all vortices at points (...,3) m, after an accepted step."""
        return self.clock.field(self.sheets()).velocity(points)

    def state(self) -> dict[str, np.ndarray]:
        """Everything the next step depends on, as arrays; empty before the first step."""
        if self._memory is None:
            return {}
        bound = {f"system_{k}": v for k, v in self.system.state().items()}
        if self.separation is not None:
            bound |= self.separation.state()
        return to_arrays(self._memory) | bound

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._trial = None
        self._memory = from_arrays(state, self.ages) if state else None
        corners = [] if self._memory is None else self._memory.corners
        surfaces = [Surface.at_rest(c, self.options.rings) for c in corners]
        self.clock.name(len(surfaces))
        bound = {k.removeprefix("system_"): v for k, v in state.items() if k[:7] == "system_"}
        self.system.restore(bound, surfaces)
        if self.separation is not None:
            self.separation.restore(state)

    def _begun(self) -> _Trial:
        if self._trial is None:
            raise InputError("unsteady lattice", "no step was begun", "call begin_step first")
        return self._trial

    def _accepted(self) -> Memory:
        if self._memory is None:
            raise InputError("unsteady lattice", "no step was accepted yet", "call end_step first")
        return self._memory

    def _start(
        self,
        time: float,
        surfaces: Sequence[Surface],
        axis: RotorAxis | None,
        wake: Wake | None,
    ) -> Memory:
        """The flow before the first step: about a wake that is given or laid out along the wind."""
        options = self.options
        self.clock.name(len(surfaces))
        wake = self.clock.first_wake(time, surfaces, axis) if wake is None else wake
        wake.attach([s.lattice.vertices[-1] for s in surfaces])
        self.system.place(surfaces)
        points = control_points(surfaces)
        wind = wind_at(self.inflow, points, time, surfaces, self.clock.names)
        if options.start == "steady" or options.quasi_steady:
            flow = strip_flow(
                self.system, surfaces, wind, self.clock.thinning.wake(wake), options.core,
                options.mirror, self.separation,
            )  # fmt: skip
            wake = steady_wake(wake, [g[-1] for g in flow.circulation])
        else:
            still = np.zeros_like(points)
            flow = bound_flow(self.system, surfaces, wind, still, self.separation)
        return Memory(
            wake,
            [s.lattice.corners.copy() for s in surfaces],
            flow.circulation,
            _speed(surfaces, wind),
            [np.zeros_like(g[-1]) for g in flow.circulation],
            [g[-1:].copy() for g in flow.circulation],
            [np.zeros(1) for _ in flow.circulation],
        )

    def _flow(self, trial: _Trial, time: float, surfaces: Sequence[Surface]) -> Flow:
        options = self.options
        points = control_points(surfaces)
        wind = wind_at(self.inflow, points, time, surfaces, self.clock.names)
        if options.quasi_steady:
            return strip_flow(
                self.system, surfaces, wind, self.clock.thinning.wake(trial.wake), options.core,
                options.mirror, self.separation,
            )  # fmt: skip
        sheets = trial.wake.sheets(options.core, rows=slice(1))
        edges = [
            edge_panels(new, sheet, self.largest_step)
            for new, sheet in zip(trial.shed, sheets, strict=True)
        ]
        influences = trial.held
        if influences is None:
            influences = _Influences(
                self._far_wake(trial.wake).velocity(surfaces),
                edge_influence(self.system, surfaces, edges, options.mirror, self.separation),
            )
        if options.hold_influences:
            trial.held = influences
        return edge_flow(
            self.system, surfaces, wind, influences.far, edges, influences.edge, self.separation
        )

    def _far_wake(self, wake: Wake) -> FarWake:
        summed = self.clock.thinning.wake(wake)
        return FarWake(summed, self.options.core, self.clock.field, self._smooth)

    def _shedding(self, memory: Memory, surfaces: Sequence[Surface], dt: float) -> list[Shedding]:
        assert memory.convection is not None
        pairs = zip(memory.times, memory.trailing, strict=True)
        histories = [History(dt, times, values) for times, values in pairs]
        classical = self.options.classical_shedding
        edge_velocities = (u[0] for u in memory.convection.velocity)
        return [
            shedding(s, u, h, self.largest_step, classical)
            for s, u, h in zip(surfaces, edge_velocities, histories, strict=True)
        ]


def _speed(surfaces: Sequence[Surface], wind: Array) -> float:
    """Highest speed m/s of the air along the surfaces, without induction."""
    velocity = collocation_velocities(surfaces)
    return float(np.linalg.norm(wind[: len(velocity)] - velocity, axis=1).max())
