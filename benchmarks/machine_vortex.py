"""The flexible controlled NREL 5 MW by a free vortex wake in turbulence: how near to real time."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from galerna.case import load
from galerna.contract import Loads, Motion
from galerna.machine import Machine, build_machine

from .framework import Benchmark, Figure

CASE = Path(__file__).parents[1] / "examples" / "flexible_free_wake.yaml"
WARM_UP, STEPS = 6, 60
UNIFORM_ROWS = 504  #: of 5 degrees in 7 revolutions


class Watch:
    """Wall seconds in the calls of a machine's lattice: moving the wake, first and later loads."""

    def __init__(self, machine: Machine) -> None:
        lattice = machine.vortex_lattice
        assert lattice is not None
        self.begin, self.evaluate = lattice.begin_step, lattice.loads
        lattice.begin_step = self.begin_step  # type: ignore[method-assign, assignment]
        lattice.loads = self.loads  # type: ignore[method-assign, assignment]
        self.reset()

    def reset(self) -> None:
        """Start to count again."""
        self.wake = self.first = self.again = 0.0
        self.evaluations, self._fresh = 0, True

    def begin_step(self, time_s: float, dt: float, motion: Motion) -> None:
        start = time.perf_counter()
        self.begin(time_s, dt, motion)
        self.wake += time.perf_counter() - start
        self._fresh = True

    def loads(self, time_s: float, motion: Motion) -> Loads:
        start = time.perf_counter()
        loads = self.evaluate(time_s, motion)
        spent = time.perf_counter() - start
        self.first += spent * self._fresh
        self.again += spent * (not self._fresh)
        self._fresh = False
        self.evaluations += 1
        return loads


def real_time() -> Sequence[Figure]:
    """Real-time factor of the example, and where its time goes."""
    machine = build_machine(load(CASE))
    simulation, watch = machine.simulation, Watch(machine)
    for _ in range(WARM_UP):
        simulation.advance()
    watch.reset()
    wall, cpu = time.perf_counter(), time.process_time()
    for _ in range(STEPS):
        simulation.advance()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    lattice = machine.vortex_lattice
    assert lattice is not None
    rows = len(lattice.wake_size.ages) - 1
    name = f"NREL 5 MW, flexible, controlled, 3 x 20 x 8 and 3 x 20 x {rows} free panels"
    rest = wall - watch.wake - watch.first - watch.again
    shares = (
        ("moving the wake", watch.wake),
        ("first loads of a step", watch.first),
        ("later loads", watch.again),
        ("structure, control and time loop", rest),
    )
    return [
        Figure(
            f"{name}: simulated over wall time on {os.cpu_count()} cores",
            STEPS * simulation.time_step / wall, "-", 1.0, at_least=True,
        ),
        Figure(f"{name}: CPU time of a step", cpu / STEPS, "s"),
        Figure(f"{name}: evaluations of the loads in a step", watch.evaluations / STEPS, "-"),
        *(Figure(f"{name}: {what}, wall time of a step", t / STEPS, "s") for what, t in shares),
        Figure("panels of its wake", float(lattice.wake_panels), "-"),
        Figure("panels of the uniform wake", float(np.prod((3, 20, UNIFORM_ROWS))), "-"),
    ]  # fmt: skip


BENCHMARKS = [
    Benchmark("machine-vortex", "machine", "Flexible machine with a free wake", real_time),
]
