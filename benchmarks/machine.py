"""The whole machine by blade-element momentum: pace, and iterations a step."""

from __future__ import annotations

import time
from collections.abc import Sequence
from statistics import median
from typing import Any

import galerna
from galerna.contract import Loads
from galerna.simulation import Simulation

from .framework import Benchmark, Figure

DURATION, REPEATS = 20.0, 3  #: simulated s of one timing
WANTED = 5.0  #: times faster than real time, on one core
#: OpenFAST v5.0.0 on a machine of this kind, CPU time of one thread, step 0.01 s
LINEAR_MODES, BEAMDYN = 3.2, 0.6

CASE: dict[str, Any] = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 100.0,
    "time_step_s": 0.02,
    "inflow": {
        "wind_speed_m_s": 12.0,
        "shear": {"kind": "power_law", "exponent": 0.14},
        "turbulence": {"kind": "mann", "turbulence_class": "B"},
    },
    "aerodynamics": {"spanwise_filter": "loads", "rotational_augmentation": "snel"},
    "structure": "flexible",
    "control": "baseline",
}


def pace() -> Sequence[Figure]:
    """Real-time factor of processor time, every record taken, and iterations of a step."""
    simulation = galerna.build_machine(galerna.load_case(CASE)).simulation
    counted = Counted(simulation)
    march(simulation, 2.0)
    counted.balances = 0
    factors = [DURATION / timed(simulation, DURATION) for _ in range(REPEATS)]
    steps = round(REPEATS * DURATION / CASE["time_step_s"])
    name = "real-time factor, 3 x 20 + 10 beams, 0.02 s step, one core"
    return (
        Figure(name, median(factors), "x", WANTED, True),
        Figure("the same: OpenFAST with linear modes, measured elsewhere", LINEAR_MODES, "x"),
        Figure("the same: OpenFAST with BeamDyn, measured elsewhere", BEAMDYN, "x"),
        Figure("evaluations of loads and balance a step", counted.balances / steps, "-"),
    )


class Counted:
    """Counts how often a simulation's structure is brought into balance."""

    def __init__(self, simulation: Simulation) -> None:
        self.balances = 0
        balance = simulation.structure.balance

        def counting(loads: Sequence[Loads]) -> bool:
            self.balances += 1
            return balance(loads)

        simulation.structure.balance = counting  # type: ignore[method-assign]


def timed(simulation: Simulation, duration: float) -> float:
    """Processor seconds of ``duration`` s: those of a machine that does nothing else."""
    start = time.process_time()
    march(simulation, duration)
    return time.process_time() - start


def march(simulation: Simulation, duration: float) -> None:
    """Step on by ``duration`` s and take a record every 0.1 s, as a run does."""
    end = simulation.steps + round(duration / simulation.time_step)
    while simulation.steps < end:
        simulation.advance()
        if simulation.steps % 5 == 0:
            simulation.record()


BENCHMARKS = (
    Benchmark("machine-pace", "machine", "Flexible, controlled NREL 5 MW in turbulence", pace),
)
