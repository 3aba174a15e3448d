"""The vortex lattice's speed: steps of a rotor, steady solutions and the treecode's scaling."""

from __future__ import annotations

import os
import resource
import time
from collections.abc import Sequence
from functools import partial

import numpy as np

from galerna.aero.vortex.ages import revolution_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.steady import solve_steady
from galerna.aero.vortex.unsteady import UnsteadyLattice, UnsteadyOptions
from galerna.contract import Array
from galerna.units import DEG

from .framework import Benchmark, Figure
from .vortex_cases import AXIS, SPEED, WIND, Rotor, helical_sheets, sharpy_seconds
from .vortex_kernels import cpu_seconds

ERROR = 1e-3  # of the treecode
STEP_DEG, REVOLUTIONS = 5.0, 7.0
NREL = "NREL 5 MW, 3 x 20 x 8 panels, 30,240 in the wake"
#: (what, free wake, treecode, how many times faster than two evaluations of SHARPy)
STEPS = (
    ("prescribed wake, direct sum", False, False, 30.0),
    ("prescribed wake, treecode", False, True, 100.0),
    ("free wake, direct sum", True, False, 25.0),
    ("free wake, treecode", True, True, 100.0),
)
SIZES = (10_000, 30_000, 100_000, 300_000)


class Gusts:
    """A wind along the shaft with gusts of a tenth that drift with it."""

    def velocity(self, points: Array, time: float) -> Array:
        phase = (points[:, 0] - WIND * time) / 40.0
        wind = np.zeros_like(points)
        wind[:, 0] = WIND * (1.0 + 0.1 * np.sin(phase + points[:, 1] / 30.0))
        wind[:, 1] = 0.1 * WIND * np.sin(1.7 * phase + points[:, 2] / 50.0)
        return wind


class Uniform:
    """The mean of these gusts."""

    def velocity(self, points: Array, time: float) -> Array:
        return np.broadcast_to([WIND, 0.0, 0.0], points.shape)


def step_cost(rotor: Rotor, ages: Array, options: UnsteadyOptions, steps: int = 3) -> Array:
    """Least CPU and wall seconds (2,) of a step in gusts, after a first one."""
    lattice = UnsteadyLattice(Gusts(), ages, options, wake_inflow=Uniform())
    dt, costs = float(ages[1]), []
    for step in range(steps + 1):
        now = rotor.surfaces(SPEED * dt * step)
        then = rotor.surfaces(SPEED * dt * (step + 1))
        start = np.array([time.process_time(), time.perf_counter()])
        lattice.begin_step(dt * step, dt, now, AXIS)
        lattice.solve(dt * (step + 1), then)
        lattice.end_step(dt * (step + 1), then)
        costs.append(np.array([time.process_time(), time.perf_counter()]) - start)
    return np.min(costs[1:], axis=0)


def rotor_steps() -> Sequence[Figure]:
    """A step with its loads against two evaluations of SHARPy; none of the wake is kept."""
    rotor, ages = Rotor(8, 20), revolution_ages(SPEED, REVOLUTIONS, STEP_DEG)
    peer, figures = sharpy_seconds(8, 20, REVOLUTIONS, STEP_DEG), []
    for what, free, tree, times in STEPS:
        options = UnsteadyOptions(
            free=free, core=VortexCore(0.3), tree_error=ERROR if tree else None
        )
        cpu, wall = step_cost(rotor, ages, options)
        theirs = 2.0 * peer["free" if free else "prescribed"] if peer else None
        figures += [
            Figure(f"{NREL}: step, {what}, CPU time", float(cpu), "s",
                   theirs / times if theirs else None, False,
                   "SHARPy 2.4, two evaluations" if theirs else "", theirs),
            Figure(f"{NREL}: step, {what}, wall time", float(wall), "s"),
        ]  # fmt: skip
    return figures


def steady_rotor() -> Sequence[Figure]:
    """The same rotor solved steadily: all blades' unknowns, or one blade's by symmetry."""
    surfaces = Rotor(8, 20).surfaces(0.0)
    ages = revolution_ages(SPEED, REVOLUTIONS, STEP_DEG)
    wind = np.array([WIND, 0.0, 0.0])
    peer = sharpy_seconds(8, 20, REVOLUTIONS, STEP_DEG).get("steady")
    figures = []
    for name, symmetry in (("one blade by symmetry", True), ("all blades", False)):
        ours = cpu_seconds(
            partial(solve_steady, surfaces, wind, axis=AXIS, ages=ages, symmetry=symmetry)
        )
        figures.append(
            Figure(f"{NREL}: steady solution, {name}, CPU time", ours, "s",
                   peer / 20.0 if peer else None, False,
                   "SHARPy 2.4" if peer else "", peer)
        )  # fmt: skip
    return figures


def large_steady_rotor() -> Sequence[Figure]:
    """The dissertation's baseline: 3 x 28 x 64 panels and 3 x 28 x 5930 in the wake."""
    rows = 5930
    surfaces = Rotor(64, 28).surfaces(0.0)
    ages = revolution_ages(SPEED, REVOLUTIONS, 360.0 * REVOLUTIONS / rows)
    solve_steady(surfaces, np.array([WIND, 0.0, 0.0]), axis=AXIS, ages=ages[:100])
    start = time.perf_counter()
    solve_steady(surfaces, np.array([WIND, 0.0, 0.0]), axis=AXIS, ages=ages)
    wall = time.perf_counter() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    name = f"3 x 28 x 64 panels, 3 x 28 x {len(ages) - 1} in the wake"
    return [
        Figure(f"{name}: steady solution, wall time", wall, "s", 10.0),
        Figure(f"{name}: most memory of the process so far", memory, "GB", 3.0),
    ]


def large_free_step() -> Sequence[Figure]:
    """A free-wake step of 3 x 28 x 16 panels with 100,000 in the wake."""
    rotor, rows = Rotor(16, 28), 1191
    ages = np.arange(rows + 1, dtype=float) * STEP_DEG * DEG / SPEED
    options = UnsteadyOptions(free=True, core=VortexCore(0.3), tree_error=ERROR)
    cpu, wall = step_cost(rotor, ages, options, steps=2)
    name = f"3 x 28 x 16 panels, {3 * 28 * rows:,} in a free wake: step, treecode"
    return [
        Figure(f"{name}, wall time on {os.cpu_count()} cores", float(wall), "s", 3.0),
        Figure(f"{name}, CPU time", float(cpu), "s"),
    ]


def tree_seconds(panels: int, error: float | None = ERROR) -> tuple[int, float]:
    """Panels of a helical wake, and least CPU seconds of its velocity at its own vertices.

    By the treecode with the ``error``, or summed directly with None.
    """
    sheets = helical_sheets(panels)
    size = sum(sheet.circulation.size for sheet in sheets)
    repeat = 3 if panels < 100_000 else 1
    return size, cpu_seconds(
        lambda: InducedField(sheets, error=error, precision="single").vertex_velocities(), repeat
    )


def tree_scaling() -> Sequence[Figure]:
    """How the treecode's cost grows with the wake."""
    costs = [tree_seconds(size) for size in SIZES]
    figures = [
        Figure(f"treecode at {ERROR:g}, {size:,} panels at their vertices, CPU time", cost, "s")
        for size, cost in costs
    ]
    size, cost = np.log(np.array(costs).T)
    slope = float(np.polyfit(size, cost, 1)[0])
    return [*figures, Figure("exponent of the treecode's cost, 1e4 to 3e5 panels", slope, "-", 1.2)]


BENCHMARKS = [
    Benchmark("vortex-rotor-step", "vortex", "One step of the NREL 5 MW's lattice", rotor_steps),
    Benchmark("vortex-rotor-steady", "vortex", "Steady flow of the same rotor", steady_rotor),
    Benchmark("vortex-large-steady", "vortex", "Half a million wake panels", large_steady_rotor),
    Benchmark("vortex-large-step", "vortex", "A step with 100,000 wake panels", large_free_step),
    Benchmark("vortex-tree-scaling", "vortex", "The treecode from 1e4 to 3e5 panels", tree_scaling),
]
