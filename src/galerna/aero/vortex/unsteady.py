"""Lifting surfaces that move as they like, and the wakes they shed.

The order of the calls is that of ``contract.LoadModel``: ``begin_step`` carries the wake on,
``solve`` finds the circulation that lets no flow through the surfaces as they stand at the end of
the step and may be called many times, ``end_step`` accepts. The circulation that the trailing
edge had at the beginning of a step is shed in it (the Kutta condition, eq. 2.72).

The wake has its own clock: it sheds a row when the age of its first panel has elapsed. In between
the wake at every instant is made from the one last shed, so steps that are smaller than a
panel do not spread it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from galerna.aero.vortex.convection import (
    SCHEMES,
    Convection,
    Earlier,
    corrected,
    earlier,
    require_calm,
)
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.flow import (
    Flow,
    bound_flow,
    control_points,
    edge_flow,
    flow_loads,
    strip_flow,
    wind_at,
)
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.loads import SurfaceLoads
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.quasi_steady import steady_wake
from galerna.aero.vortex.separation import Separation
from galerna.aero.vortex.shedding import History, Shedding, edge_panels, shedding
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface, collocation_velocities
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.wake import (
    STEP_TOLERANCE,
    RotorAxis,
    Wake,
    courant_numbers,
    helical_wake,
    straight_wake,
)
from galerna.contract import Array, Inflow
from galerna.errors import InputError, did_you_mean
from galerna.units import AIR_DENSITY

STARTS = ("steady", "impulsive")


@dataclass(frozen=True, eq=False)
class UnsteadyOptions:
    """How the wakes of `UnsteadyLattice` move and are summed.

    ``free`` wakes move with the whole velocity, others with the wind. ``scheme`` is one of
    ``convection.SCHEMES``. ``core`` is that of the wake's vortices, None the singular vortex.
    ``tree_error`` is the relative error of the fast summation, None sums directly;
    ``wake_precision`` is of the velocities that wakes induce on wakes. ``start`` "steady" begins
    with the wake of the steady flow, "impulsive" without vortices in it. ``quasi_steady`` gives
    the whole wake the present circulation. ``freeze_wake`` computes the velocity that the wake
    induces on the surfaces, but for its first panels, once in a step, where the first ``solve`` of
    the step has them. ``classical_shedding`` leaves the circulation at the beginning of a step in
    one ring, as most programs do.
    """

    free: bool = True
    scheme: str = "adams_bashforth"
    core: VortexCore | None = None
    tree_error: float | None = 1e-3
    wake_precision: str = "single"
    start: str = "steady"
    quasi_steady: bool = False
    freeze_wake: bool = False
    classical_shedding: bool = False
    mirror: MirrorPlane | None = None
    air_density: float = AIR_DENSITY
    rings: str = "quarter_chord"

    def __post_init__(self) -> None:
        for name, valid in (("scheme", SCHEMES), ("start", STARTS)):
            value = getattr(self, name)
            if value not in valid:
                raise InputError(f"{name} of the wake", f"{value!r}", did_you_mean(value, valid))


@dataclass(frozen=True, eq=False)
class Solution:
    """Circulations, their rates (m,n) m2/s2, None at first, and loads of the surfaces."""

    flow: Flow
    circulation_rate: list[Array] | None
    loads: list[SurfaceLoads]

    @property
    def circulation(self) -> list[Array]:
        """Circulations (m,n) m2/s of the rings of each surface."""
        return self.flow.circulation


@dataclass(frozen=True, eq=False)
class _Memory:
    """Everything the next step depends on, but for the factorisation.

    ``wake`` as it was last shed, ``elapsed`` s ago, ``convection`` its motion since and
    ``shed`` (n,) the time integrals of what the trailing edges have shed since; the surfaces'
    corners and circulations now, and the ``past`` circulations ``past_step`` s before (0: none);
    the ``trailing`` circulations (h,n) for as long as they still have to be shed, newest first,
    and the ``times`` (h,) s before now when they were.
    ``speed`` m/s is the highest of the air along the surfaces, to judge the wake by.
    """

    wake: Wake
    corners: list[Array]
    circulation: list[Array]
    speed: float
    shed: list[Array]
    trailing: list[Array]
    times: list[Array]
    elapsed: float = 0.0
    convection: Convection | None = None
    earlier: Earlier | None = None
    past: list[Array] = field(default_factory=list)
    past_step: float = 0.0


@dataclass(eq=False)
class _Trial:
    """A step under way: whence, how long, the circulation shed, the wake and its field."""

    memory: _Memory
    dt: float
    shed: list[Shedding]
    wake: Wake
    far: InducedField | None
    frozen: Array | None = None
    solution: Solution | None = None


class UnsteadyLattice:
    """Bound vortices of moving surfaces and the wakes they shed, in an ``inflow``.

    ``ages`` (K+1,) s are those of the rows of the wakes (see ``ages``); no step may be longer than
    ``ages[1]``. ``wake_inflow`` is the wind that moves the wakes, if another one; ``names`` are
    what errors call the surfaces; ``separation`` brings their sections' lift to polars.
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
    ) -> None:
        self.inflow, self.ages = inflow, np.asarray(ages, dtype=float)
        self.wake_inflow = inflow if wake_inflow is None else wake_inflow
        self.options = UnsteadyOptions() if options is None else options
        self.system = BoundSystem(mirror=self.options.mirror)
        self.separation = separation
        courant_numbers(self.ages, 0.0)
        self._names = tuple(names)
        self._memory: _Memory | None = None
        self._trial: _Trial | None = None

    @property
    def largest_step(self) -> float:
        """The longest step, s: the age of the first panel."""
        return float(self.ages[1])

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
        if self._overflows(memory.elapsed + dt):
            memory = self._sheds(memory, self._wake_at(memory), time)
        if memory.convection is None:
            memory = replace(memory, convection=self._convection(memory, time, axis))
        shed = self._shedding(memory, surfaces, dt)
        total = [i + dt * new.known for i, new in zip(memory.shed, shed, strict=True)]
        wake = self._advanced(memory, memory.elapsed + dt, total)
        self._trial = _Trial(memory, dt, shed, wake, self._far_field(wake))

    def solve(self, time: float, surfaces: Sequence[Surface]) -> Solution:
        """The flow about ``surfaces`` where they are at ``time``, the end of the step begun.

        Raises InputError for a wind that is not finite, naming the surface and the place.
        """
        trial = self._begun()
        trial.wake.attach([s.lattice.vertices[-1] for s in surfaces])
        self.system.place(surfaces)
        flow = self._flow(trial, time, surfaces)
        rate = None if self.options.quasi_steady else _rates(flow.circulation, trial)
        options = self.options
        loads = flow_loads(surfaces, flow, options.air_density, rate, options.mirror)
        trial.solution = Solution(flow, rate, loads)
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
        if self._overflows(memory.elapsed + trial.dt):
            memory = self._sheds(memory, trial.wake, time)
        self.system.accept()
        if self.separation is not None:
            self.separation.accept()
        self._memory, self._trial = memory, None

    def wake(self) -> Wake:
        """The wake as it is at the end of the last accepted step."""
        return self._wake_at(self._accepted())

    def sheets(self) -> list[Sheet]:
        """The wakes, then the bound vortices, at the end of the last accepted step."""
        memory = self._accepted()
        return self._sheets(memory, self._wake_at(memory), 0.0)

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity (...,3) m/s of wind and vortices at points (...,3) m, after an accepted step."""
        points = np.asarray(points, dtype=float)
        wind = self.inflow.velocity(points.reshape(-1, 3), time).reshape(points.shape)
        return wind + self._field(self.sheets()).velocity(points)

    def state(self) -> dict[str, np.ndarray]:
        """Everything the next step depends on, as arrays; empty before the first step."""
        if self._memory is None:
            return {}
        bound = {f"system_{k}": v for k, v in self.system.state().items()}
        if self.separation is not None:
            bound |= self.separation.state()
        return _to_arrays(self._memory) | bound

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._trial = None
        self._memory = _from_arrays(state, self.ages) if state else None
        corners = [] if self._memory is None else self._memory.corners
        surfaces = [Surface.at_rest(c, self.options.rings) for c in corners]
        self._name(len(surfaces))
        bound = {k.removeprefix("system_"): v for k, v in state.items() if k[:7] == "system_"}
        self.system.restore(bound, surfaces)
        if self.separation is not None:
            self.separation.restore(state)

    def _name(self, surfaces: int) -> None:
        if not self._names:
            self._names = tuple(f"surface {i + 1}" for i in range(surfaces))

    def _overflows(self, elapsed: float) -> bool:
        return elapsed > self.largest_step * (1.0 + STEP_TOLERANCE)

    def _begun(self) -> _Trial:
        if self._trial is None:
            raise InputError("unsteady lattice", "no step was begun", "call begin_step first")
        return self._trial

    def _accepted(self) -> _Memory:
        if self._memory is None:
            raise InputError("unsteady lattice", "no step was accepted yet", "call end_step first")
        return self._memory

    def _start(
        self,
        time: float,
        surfaces: Sequence[Surface],
        axis: RotorAxis | None,
        wake: Wake | None,
    ) -> _Memory:
        """The flow before the first step: about a wake that is given or laid out along the wind."""
        options = self.options
        self._name(len(surfaces))
        wake = self._first_wake(time, surfaces, axis) if wake is None else wake
        wake.attach([s.lattice.vertices[-1] for s in surfaces])
        self.system.place(surfaces)
        points = control_points(surfaces)
        wind = wind_at(self.inflow, points, time, surfaces, self._names)
        if options.start == "steady" or options.quasi_steady:
            flow = strip_flow(
                self.system, surfaces, wind, wake, options.core, options.mirror, self.separation
            )
            wake = steady_wake(wake, [g[-1] for g in flow.circulation])
        else:
            still = np.zeros_like(points)
            flow = bound_flow(self.system, surfaces, wind, still, self.separation)
        return _Memory(
            wake,
            [s.lattice.corners.copy() for s in surfaces],
            flow.circulation,
            _speed(surfaces, wind),
            [np.zeros_like(g[-1]) for g in flow.circulation],
            [g[-1:].copy() for g in flow.circulation],
            [np.zeros(1) for _ in flow.circulation],
        )

    def _first_wake(self, time: float, surfaces: Sequence[Surface], axis: RotorAxis | None) -> Wake:
        edges = [s.lattice.vertices[-1] for s in surfaces]
        if axis is not None:
            blown = self.wake_inflow.velocity(np.concatenate(edges), time)
            return helical_wake(self.ages, edges, axis, blown.mean(axis=0))
        drift = [
            self.wake_inflow.velocity(e, time) - Lattice(s.velocity, s.lattice.rings).vertices[-1]
            for e, s in zip(edges, surfaces, strict=True)
        ]
        return straight_wake(self.ages, edges, drift)

    def _flow(self, trial: _Trial, time: float, surfaces: Sequence[Surface]) -> Flow:
        options = self.options
        points = control_points(surfaces)
        wind = wind_at(self.inflow, points, time, surfaces, self._names)
        if options.quasi_steady:
            return strip_flow(
                self.system, surfaces, wind, trial.wake, options.core, options.mirror,
                self.separation,
            )  # fmt: skip
        sheets = trial.wake.sheets(options.core, rows=slice(1))
        edges = [
            edge_panels(new, sheet, self.largest_step)
            for new, sheet in zip(trial.shed, sheets, strict=True)
        ]
        far = self._far_velocity(trial, points)
        return edge_flow(self.system, surfaces, wind, far, edges, options.mirror, self.separation)

    def _far_velocity(self, trial: _Trial, points: Array) -> Array:
        """Velocity (P,3) m/s by the wake but for its first panels, which move with the edges."""
        if trial.frozen is not None:
            return trial.frozen
        assert trial.far is not None
        velocity = trial.far.velocity(points)
        if self.options.freeze_wake:
            trial.frozen = velocity
        return velocity

    def _shedding(self, memory: _Memory, surfaces: Sequence[Surface], dt: float) -> list[Shedding]:
        assert memory.convection is not None
        pairs = zip(memory.times, memory.trailing, strict=True)
        histories = [History(dt, times, values) for times, values in pairs]
        classical = self.options.classical_shedding
        edge_velocities = (u[0] for u in memory.convection.velocity)
        return [
            shedding(s, u, h, self.largest_step, classical)
            for s, u, h in zip(surfaces, edge_velocities, histories, strict=True)
        ]

    def _far_field(self, wake: Wake) -> InducedField | None:
        """The field of all panels but the first, summed fast for all solutions of a step."""
        if self.options.quasi_steady:
            return None
        return self._field(wake.sheets(self.options.core, rows=slice(1, None)))

    def _field(self, sheets: Sequence[Sheet], precision: str = "double") -> InducedField:
        options = self.options
        return InducedField(
            sheets, error=options.tree_error, precision=precision, mirror=options.mirror
        )

    def _sheets(self, memory: _Memory, wake: Wake, edge: float) -> list[Sheet]:
        """Wakes and bound vortices, which have a core of radius ``edge`` m."""
        bound = [
            Sheet(Lattice(c, self.options.rings).vertices, g, edge)
            for c, g in zip(memory.corners, memory.circulation, strict=True)
        ]
        return [*wake.sheets(self.options.core, edge=edge), *bound]

    def _fluid_velocity(self, memory: _Memory, wake: Wake, time: float) -> tuple[Array, ...]:
        """Velocity (K+1,n+1,3) m/s that moves the vertices of a wake."""
        everywhere = np.concatenate([x.reshape(-1, 3) for x in wake.vertices])
        wind = np.asarray(self.wake_inflow.velocity(everywhere, time), dtype=float)
        ends = np.cumsum([x.size // 3 for x in wake.vertices])[:-1]
        velocity = [
            w.reshape(x.shape) for w, x in zip(np.split(wind, ends), wake.vertices, strict=True)
        ]
        if self.options.free:
            edge = 0.0 if self.options.core is None else self.options.core.initial_radius
            field = self._field(self._sheets(memory, wake, edge), self.options.wake_precision)
            induced = field.vertex_velocities(range(len(wake.vertices)))
            require_calm(wake, induced, memory.speed, time, self._names)
            velocity = [u + v for u, v in zip(velocity, induced, strict=True)]
        return tuple(velocity)

    def _convection(self, memory: _Memory, time: float, axis: RotorAxis | None) -> Convection:
        velocity = self._fluid_velocity(memory, memory.wake, time)
        if self.options.scheme != "adams_bashforth" or memory.earlier is None:
            return Convection(velocity, None, axis)
        return Convection(velocity, memory.earlier.acceleration(velocity), axis)

    def _advanced(self, memory: _Memory, elapsed: float, shed: Sequence[Array]) -> Wake:
        convection = memory.convection
        assert convection is not None
        mean = [i / elapsed for i in shed]
        return memory.wake.advanced(convection.mean(elapsed), elapsed, mean, convection.axis)

    def _wake_at(self, memory: _Memory) -> Wake:
        """The wake at the instant of a memory, ``elapsed`` after the last shedding."""
        if memory.elapsed == 0.0:
            return memory.wake
        wake = self._advanced(memory, memory.elapsed, memory.shed)
        wake.attach([Lattice(c, self.options.rings).vertices[-1] for c in memory.corners])
        return wake

    def _sheds(self, memory: _Memory, wake: Wake, time: float) -> _Memory:
        """The memory after it has shed ``wake``, the one at its instant."""
        convection, elapsed = memory.convection, memory.elapsed
        assert convection is not None
        fraction = courant_numbers(self.ages, elapsed)
        if self.options.scheme == "heun":
            end = self._fluid_velocity(memory, wake, time)
            mean = corrected(convection.velocity, end, fraction)
            better = replace(memory, convection=Convection(mean, None, convection.axis))
            wake = self._wake_at(better)
        if self.options.quasi_steady:
            wake = steady_wake(wake, [g[-1] for g in memory.circulation])
        past = None
        if self.options.scheme == "adams_bashforth":
            past = earlier(convection.velocity, fraction, elapsed)
        nothing = [np.zeros_like(i) for i in memory.shed]
        return replace(memory, wake=wake, elapsed=0.0, shed=nothing, convection=None, earlier=past)


def _speed(surfaces: Sequence[Surface], wind: Array) -> float:
    """Highest speed m/s of the air along the surfaces, without induction."""
    velocity = collocation_velocities(surfaces)
    return float(np.linalg.norm(wind[: len(velocity)] - velocity, axis=1).max())


def _rates(circulation: Sequence[Array], trial: _Trial) -> list[Array]:
    """Backward differences, of second order from the second step on (eq. 2.85), any steps."""
    memory = trial.memory
    if memory.past_step == 0.0:
        return [(g - b) / trial.dt for g, b in zip(circulation, memory.circulation, strict=True)]
    ratio = trial.dt / memory.past_step
    now, past = (1.0 + 2.0 * ratio) / (1.0 + ratio), ratio**2 / (1.0 + ratio)
    return [
        (now * g - (1.0 + ratio) * b + past * a) / trial.dt
        for g, b, a in zip(circulation, memory.circulation, memory.past, strict=True)
    ]


def _to_arrays(memory: _Memory) -> dict[str, np.ndarray]:
    """A memory as plain arrays, one of each kind for each surface."""
    kinds: dict[str, Sequence[Array]] = {
        "vertices": memory.wake.vertices,
        "wake_circulation": memory.wake.circulation,
        "corners": memory.corners,
        "circulation": memory.circulation,
        "shed": memory.shed,
        "trailing": memory.trailing,
        "time": memory.times,
        "past": memory.past,
    }
    arrays = {"times": np.array([memory.elapsed, memory.past_step, memory.speed])}
    if memory.wake.centre is not None:
        arrays["centre"] = memory.wake.centre
    if memory.earlier is not None:
        kinds["earlier"] = memory.earlier.velocity
        arrays["earlier_step"] = np.array(memory.earlier.step)
    if memory.convection is not None:
        kinds["velocity"] = memory.convection.velocity
        kinds["acceleration"] = memory.convection.acceleration or ()
        axis = memory.convection.axis
        if axis is not None:
            arrays["axis"] = np.concatenate([axis.origin, axis.direction, [axis.speed]])
    arrays["surfaces"] = np.array(len(memory.corners))
    for kind, values in kinds.items():
        arrays |= {f"{kind}_{i}": a.copy() for i, a in enumerate(values)}
    return arrays


def _from_arrays(arrays: Mapping[str, np.ndarray], ages: Array) -> _Memory:
    """The inverse of ``_to_arrays``."""

    def kind(name: str) -> list[Array]:
        keys = (f"{name}_{i}" for i in range(int(arrays["surfaces"])))
        return [arrays[k].copy() for k in keys if k in arrays]

    elapsed, past_step, speed = (float(t) for t in arrays["times"])
    axis = arrays.get("axis")
    rotor = None if axis is None else RotorAxis(axis[:3], axis[3:6], float(axis[6]))
    convection = None
    if velocity := tuple(kind("velocity")):
        convection = Convection(velocity, tuple(kind("acceleration")) or None, rotor)
    past = None
    if "earlier_step" in arrays:
        past = Earlier(tuple(kind("earlier")), float(arrays["earlier_step"]))
    centre = arrays["centre"].copy() if "centre" in arrays else None
    return _Memory(
        Wake(ages, tuple(kind("vertices")), tuple(kind("wake_circulation")), centre),
        kind("corners"),
        kind("circulation"),
        speed,
        kind("shed"),
        kind("trailing"),
        kind("time"),
        elapsed,
        convection,
        past,
        kind("past"),
        past_step,
    )
