"""The wake's own clock: laid out, moved, and shed anew when its first panel is full."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from galerna.aero.vortex.convection import (
    Convection,
    Integers,
    corrected,
    due_rows,
    earlier,
    renewed,
    require_calm,
)
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.memory import Memory
from galerna.aero.vortex.quasi_steady import steady_wake
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.thinning import Thinning
from galerna.aero.vortex.unsteady_options import UnsteadyOptions
from galerna.aero.vortex.wake import (
    STEP_TOLERANCE,
    RotorAxis,
    Wake,
    courant_numbers,
    helical_wake,
    straight_wake,
)
from galerna.contract import Array, Inflow


class WakeClock:
    """Wakes whose rows have ``ages`` (K+1,) s, moved by the ``wind`` and, if free, by all vortices.

    What it knows of a wake is in the `Memory` that it is given. ``names`` of the surfaces that
    shed are for errors; ``rows`` are those summed, see `Thinning`.
    """

    def __init__(
        self,
        wind: Inflow,
        ages: Array,
        options: UnsteadyOptions,
        names: Sequence[str] = (),
        rows: Integers | None = None,
    ) -> None:
        self.wind, self.options, self.names = wind, options, tuple(names)
        self.ages = np.asarray(ages, dtype=float)
        courant_numbers(self.ages, 0.0)
        self.thinning = Thinning(self.ages, rows)

    @property
    def step(self) -> float:
        """Time s in which a row is shed: the age of the first panel."""
        return float(self.ages[1])

    def name(self, surfaces: int) -> None:
        """Call so many surfaces by their numbers, where they have no names."""
        if not self.names:
            self.names = tuple(f"surface {i + 1}" for i in range(surfaces))

    def overflows(self, elapsed: float) -> bool:
        """Whether a wake shed so long ago has to shed its next row before."""
        return elapsed > self.step * (1.0 + STEP_TOLERANCE)

    def first_wake(self, time: float, surfaces: Sequence[Surface], axis: RotorAxis | None) -> Wake:
        """A wake without circulation, as surfaces that never changed their motion left it."""
        edges = [s.lattice.vertices[-1] for s in surfaces]
        if axis is not None:
            blown = self.wind.velocity(np.concatenate(edges), time)
            return helical_wake(self.ages, edges, axis, blown.mean(axis=0) - axis.velocity)
        moving = [Lattice(s.velocity, s.lattice.rings).vertices[-1] for s in surfaces]
        drift = [self.wind.velocity(e, time) - v for e, v in zip(edges, moving, strict=True)]
        return straight_wake(self.ages, edges, drift)

    def field(self, sheets: Sequence[Sheet], precision: str = "double") -> InducedField:
        """The velocity field of sheets, summed as the options say."""
        options = self.options
        return InducedField(
            sheets, error=options.tree_error, precision=precision, mirror=options.mirror
        )

    def sheets(self, memory: Memory, summed: Wake, edge: float) -> list[Sheet]:
        """Wakes of ``summed`` rows, and bound vortices, which have a core of radius ``edge`` m."""
        bound = [
            Sheet(Lattice(c, self.options.rings).vertices, g, edge)
            for c, g in zip(memory.corners, memory.circulation, strict=True)
        ]
        return [*summed.sheets(self.options.core, edge=edge), *bound]

    def _fluid_velocity(
        self, summed: Wake, induced: Sequence[Array], time: float, axis: RotorAxis | None
    ) -> tuple[Array, ...]:
        """Velocity (K+1,n+1,3) m/s that moves the vertices of a wake.

        ``induced`` (S,n+1,3) m/s is that of the vortices at its summed rows, empty for none.
        """
        vertices = summed.vertices
        everywhere = np.concatenate([x.reshape(-1, 3) for x in vertices])
        velocity = _like(np.asarray(self.wind.velocity(everywhere, time), dtype=float), vertices)
        if induced:
            velocity = [u + v for u, v in zip(velocity, induced, strict=True)]
        return self.thinning.everywhere(velocity, axis)

    def _induced_velocity(
        self, memory: Memory, summed: Wake, time: float, rows: Integers | None = None
    ) -> tuple[Array, ...]:
        """Velocity (S,n+1,3) m/s by all vortices at the summed rows, or at some ``rows`` of them.

        Empty where wakes are not free.
        """
        if not self.options.free:
            return ()
        edge = 0.0 if self.options.core is None else self.options.core.initial_radius
        field = self.field(self.sheets(memory, summed, edge), self.options.wake_precision)
        if rows is None:
            rows = np.arange(len(summed.ages))
            induced = field.vertex_velocities(range(len(summed.vertices)))
        else:
            chosen = [x[rows] for x in summed.vertices]
            induced = _like(
                field.velocity(np.concatenate([x.reshape(-1, 3) for x in chosen])), chosen
            )
        require_calm(summed, induced, rows, memory.speed, time, self.names)
        return tuple(induced)

    def convection(self, memory: Memory, time: float, axis: RotorAxis | None) -> Convection:
        """How the wake just shed is going to move."""
        past, summed = memory.earlier, self.thinning.wake(memory.wake)
        if past is not None and past.induced and self.options.multirate:
            rows = due_rows(self.thinning.ages, memory.sheds)
            new = self._induced_velocity(memory, summed, time, rows)
            induced = renewed(past.induced, new, rows)
        else:
            induced = self._induced_velocity(memory, summed, time)
        velocity = self._fluid_velocity(summed, induced, time, axis)
        acceleration = None if past is None else past.acceleration(velocity)
        return Convection(velocity, acceleration, axis, induced)

    def advanced(self, memory: Memory, elapsed: float, shed: Sequence[Array]) -> Wake:
        """The wake ``elapsed`` s after its shedding, with what the edges ``shed`` (n,) in all."""
        convection = memory.convection
        assert convection is not None
        mean = [i / elapsed for i in shed]
        return memory.wake.advanced(convection.mean(elapsed), elapsed, mean, convection.axis)

    def wake_at(self, memory: Memory) -> Wake:
        """The wake at the instant of a memory, ``elapsed`` after the last shedding."""
        if memory.elapsed == 0.0:
            return memory.wake
        wake = self.advanced(memory, memory.elapsed, memory.shed)
        wake.attach([Lattice(c, self.options.rings).vertices[-1] for c in memory.corners])
        return wake

    def shed(self, memory: Memory, wake: Wake, time: float) -> Memory:
        """The memory after it has shed ``wake``, the one at its instant."""
        convection, elapsed = memory.convection, memory.elapsed
        assert convection is not None
        fraction = courant_numbers(self.ages, elapsed)
        if self.options.scheme == "heun":
            summed = self.thinning.wake(wake)
            induced = self._induced_velocity(memory, summed, time)
            end = self._fluid_velocity(summed, induced, time, convection.axis)
            mean = corrected(convection.velocity, end, fraction)
            better = replace(memory, convection=Convection(mean, None, convection.axis))
            wake = self.wake_at(better)
        if self.options.quasi_steady:
            wake = steady_wake(wake, [g[-1] for g in memory.circulation])
        past = None
        if self.options.scheme == "adams_bashforth":
            past = earlier(convection, fraction, elapsed)
        nothing = [np.zeros_like(i) for i in memory.shed]
        return replace(
            memory, wake=wake, elapsed=0.0, shed=nothing, convection=None, earlier=past,
            sheds=memory.sheds + 1,
        )  # fmt: skip


def _like(velocity: Array, shapes: Sequence[Array]) -> list[Array]:
    """Velocities (k,3) of all points in the shapes of the surfaces' arrays."""
    ends = np.cumsum([x.size // 3 for x in shapes])[:-1]
    return [u.reshape(x.shape) for u, x in zip(np.split(velocity, ends), shapes, strict=True)]
