"""The machine afloat: pace of the demonstration, what the water costs, long seas, memory."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import galerna
from galerna.case import load
from galerna.contract import Loads, Motion
from galerna.machine import Machine, build_machine

from .framework import Benchmark, Figure
from .machine import march, timed

DEMO = Path(__file__).parents[1] / "examples" / "demo.yaml"
DURATION, REPEATS = 20.0, 3  #: simulated s of one timing
BLOCK, BLOCKS = 0.5, 60  #: simulated s of one turn of two machines, and turns
WATER = ("hydrodynamics", "drag", "mooring")
OPENFAST = 1.0 / 0.74  #: times real time, v5.0.0, linear modes, 0.025 s, on a machine of this kind

LATTICE: dict[str, Any] = {
    "galerna": 1,
    "turbine": "nrel5mw_oc3",
    "duration_s": 10.0,
    "time_step_s": 0.055,
    "inflow": {"wind_speed_m_s": 11.4},
    "aerodynamics": {
        "model": "vortex_lattice",
        "spanwise_panels": 26,
        "chordwise_panels": 16,
        "wake": "prescribed",
        "wake_step_s": 0.055,
        "wake_revolutions": 49.0 / 90.0,
        "wake_growth": 1.0,
    },
    "structure": "flexible",
    "control": "baseline",
    "sea": {"waves": {"kind": "jonswap", "significant_height_m": 6.0, "peak_period_s": 10.0}},
}
SHARPY = 400.0  #: CPU s per simulated s: SHARPy 2.4, 1248 bound and 3822 wake panels, 0.055 s
SHARPY_WANTED = 200.0  #: times faster


class Watch:
    """Seconds of a clock in the calls of a machine's water loads, less those of reading it."""

    def __init__(self, machine: Machine, clock: Callable[[], float] = time.perf_counter) -> None:
        self.spent = 0.0
        self._clock = clock
        self._reading = median(-clock() + clock() for _ in range(1001))
        for name in WATER:
            model = machine.simulation.load_models.get(name)
            if model is None:
                continue
            for call in ("begin_step", "loads", "end_step"):
                setattr(model, call, self._watched(getattr(model, call)))

    def _watched(self, call: Any) -> Any:
        def timed_call(*arguments: float | Motion) -> Loads | None:
            start = self._clock()
            answer = call(*arguments)
            self.spent += self._clock() - start - self._reading
            return answer

        return timed_call


def pace() -> Sequence[Figure]:
    """Real-time factor of the demonstration on one core, and the water's share of it."""
    machine = build_machine(load(DEMO))
    simulation = machine.simulation
    march(simulation, 2.0)
    factors = [DURATION / timed(simulation, DURATION) for _ in range(REPEATS)]
    watch = Watch(machine)
    spent = timed(simulation, DURATION)
    name = "OC3 spar, flexible, controlled, wind and waves, 0.02 s step, one core"
    return (
        Figure(f"{name}: real-time factor", median(factors), "x", 3.0, True),
        Figure("the same: OpenFAST with linear modes, 0.025 s, measured elsewhere", OPENFAST, "x"),
        Figure("radiation, waves, drag and moorings: share of the time", watch.spent / spent, "-",
               0.10),
    )  # fmt: skip


def long_seas() -> Sequence[Figure]:
    """Time of the water's loads in a step for ten minutes and for an hour of waves.

    The two take turns in short blocks of processor time, so that what else the computer
    does meets both.
    """
    seas = [_in_a_sea_of(minutes) for minutes in (10, 60)]
    watches = [Watch(machine, time.process_time) for machine in seas]
    costs = np.array([[_block(*each) for each in zip(seas, watches, strict=True)]
                      for _ in range(BLOCKS)])  # fmt: skip
    figures = [
        Figure(f"water's loads in a step, sea of {minutes} min, {count} frequencies", cost, "us")
        for minutes, count, cost in zip(
            (10, 60), map(_frequencies, seas), np.median(costs, axis=0).tolist(), strict=True
        )
    ]
    ratio = float(np.median(costs[:, 1] / costs[:, 0]))
    return (*figures, Figure("an hour's over ten minutes', of blocks in turn", ratio, "-", 1.15))


def _in_a_sea_of(minutes: float) -> Machine:
    """The rigid machine in a sea of so many minutes, two seconds after its start."""
    case = {
        **{key: value for key, value in LATTICE.items() if key != "aerodynamics"},
        "structure": "rigid",
        "duration_s": 60.0 * minutes,
        "time_step_s": 0.02,
    }
    machine = build_machine(load(case))
    march(machine.simulation, 2.0)
    return machine


def _frequencies(machine: Machine) -> int:
    assert machine.afloat is not None
    return len(machine.afloat.sea.frequency)


def _block(machine: Machine, watch: Watch) -> float:
    """Microseconds of the water's loads in a step, over one block of steps."""
    before = watch.spent
    march(machine.simulation, BLOCK)
    return 1e6 * (watch.spent - before) * machine.simulation.time_step / BLOCK


MEMORY = """
import json, resource, sys
import galerna
galerna.run(json.loads(sys.argv[1]), sys.argv[2], overwrite=True)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0)
"""


def memory() -> Sequence[Figure]:
    """Peak memory of an hour in turbulence and waves, streamed to disk; blades rigid."""
    from tempfile import TemporaryDirectory

    case = {
        **{key: value for key, value in LATTICE.items() if key != "aerodynamics"},
        "duration_s": 3600.0,
        "time_step_s": 0.1,
        "inflow": {"wind_speed_m_s": 18.0, "turbulence": {"kind": "mann", "turbulence_class": "B"}},
        "structure": "rigid",
    }
    with TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, "-c", MEMORY, json.dumps(case), f"{folder}/hour.nc"],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
    peak = float(done.stdout.split()[-1])
    return (Figure("peak memory of an hour in turbulence and waves", peak / 1024.0, "GB", 1.0),)


def lattice() -> Sequence[Figure]:
    """CPU time of a simulated second with the vortex lattice and a prescribed wake."""
    machine = build_machine(galerna.load_case(LATTICE))
    simulation = machine.simulation
    march(simulation, 1.0)
    spent = timed(simulation, 5.0) / 5.0
    model = machine.vortex_lattice
    assert model is not None
    bound = 3 * 26 * 16
    return (
        Figure(f"OC3 spar, flexible, {bound} bound and {model.wake_panels} prescribed wake panels, "
               "0.055 s: CPU s a simulated second", spent, "s"),
        Figure("times faster than SHARPy, measured elsewhere", SHARPY / spent, "x",
               SHARPY_WANTED, True),
    )  # fmt: skip


BENCHMARKS = (
    Benchmark("afloat-pace", "afloat", "The demonstration: OC3 spar in wind and waves", pace),
    Benchmark("afloat-sea", "afloat", "Long seas", long_seas),
    Benchmark("afloat-memory", "afloat", "Memory of an hour", memory),
    Benchmark("afloat-lattice", "afloat", "Lattice afloat beside SHARPy", lattice),
)
