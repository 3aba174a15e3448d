"""What a vortex lattice is, in words for a user before the run: size, wake, cost."""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter
from typing import TYPE_CHECKING

from galerna.contract import Motion

if TYPE_CHECKING:
    from galerna.aero.vortex.model import VortexLattice

TIMED_PANELS = 100_000  #: of all surfaces and wakes: no step of a larger lattice is timed


def describe_lattice(
    model: VortexLattice, motion: Motion, time_step: float
) -> Iterator[tuple[str, str]]:
    """Pairs of heading and text about a model that has made no step; one step is timed if small.

    ``motion`` is that at time 0, ``time_step`` s.
    """
    lattice, size = model.lattice, model.wake_size
    rows, strips = lattice.offsets.shape[0] - 1, lattice.offsets.shape[1] - 1
    blades, long = len(model.blades), len(size.ages) - 1
    panels = f"{blades} x {rows} x {strips} panels (blades, chord, span)"
    yield "lattice", f"{panels}, from {lattice.span[0]:.1%} of the span"
    for note in lattice.notes:
        yield "lattice", note
    yield "wake", f"{model.options.wake}, {blades} x {long} x {strips} = {model.wake_panels} panels"
    length = f"{size.diameters:.3g} diameters, {size.revolutions:.3g} revolutions"
    yield "wake", f"{length}; panels of {size.step:.4g} s to {_widest(model):.4g} s"
    steps = round(size.step / time_step)
    step = f"aerodynamic step {size.step:.4g} s, {steps} time step{'s' if steps > 1 else ''}"
    turning = 360.0 * size.revolutions / size.ages[-1]
    yield "wake", f"{step}, {turning * size.step:.3g} deg of a turn"
    if model.wake_panels + blades * rows * strips > TIMED_PANELS:
        yield "cost", f"not measured: more than {TIMED_PANELS} panels take long for every step"
        return
    shedding, loading = time_of_a_step(model, motion, time_step)
    cost = shedding / size.step + loading / time_step
    each = f"{1e3 * shedding:.3g} ms to move the wake, {1e3 * loading:.3g} ms for the loads"
    yield "cost", f"about {cost:.3g} s for a second, on this machine as it is now: {each}"


def time_of_a_step(model: VortexLattice, motion: Motion, time_step: float) -> tuple[float, float]:
    """Wall time s of moving the wake and of one evaluation of the loads, compiled and warm.

    A step is begun and not accepted, so the model stays as it was.
    """
    for _ in range(2):  # the first also compiles
        start = perf_counter()
        model.begin_step(0.0, time_step, motion)
        begun = perf_counter()
        model.loads(time_step, motion)
        done = perf_counter()
    return begun - start, done - begun


def _widest(model: VortexLattice) -> float:
    ages = model.wake_size.ages
    return float(ages[-1] - ages[-2])
