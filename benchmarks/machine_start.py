"""How long a user waits before a run moves: a fresh process, with the kernels compiled."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from statistics import median

from .framework import Benchmark, Figure

REPEATS = 5
PROGRAM = """
import galerna
case = dict(
    galerna=1, turbine="nrel5mw", duration_s=60, inflow={"wind_speed_m_s": 12.0},
    structure="flexible", control="baseline",
)
machine = galerna.build_machine(galerna.load_case(case))
machine.simulation.advance()
"""
STAGES = """
import os, resource, time
began = time.monotonic()
exec(PROGRAM)
used = resource.getrusage(resource.RUSAGE_SELF)
print(time.monotonic() - began, used.ru_utime + used.ru_stime)
"""


def start() -> Sequence[Figure]:
    """Seconds from nothing to the first step: imports, turbine, trim, structure, kernels."""
    code = STAGES.replace("PROGRAM", repr(PROGRAM))
    runs = []
    for _ in range(REPEATS + 1):  # the first one may compile
        command = [sys.executable, "-c", code]
        found = subprocess.run(command, capture_output=True, text=True, check=True)
        runs.append([float(word) for word in found.stdout.split()])
    wall, cpu = (median(column) for column in zip(*runs[1:], strict=True))
    return (
        Figure("flexible controlled NREL 5 MW to the first step", wall, "s", 3.0),
        Figure("processor time of it", cpu, "s"),
    )


BENCHMARKS = (Benchmark("machine_start", "machine", "start-up to the first step", start),)
