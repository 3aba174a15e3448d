"""A Bladed-style library in a process of its own: what its start, its calls and its replay cost.

The library is ROSCO's (``pip install --no-deps rosco``); without it there is nothing to measure.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from importlib.util import find_spec
from statistics import median

import numpy as np

from galerna import examples
from galerna import turbine as turbines
from galerna.control.discon import ROSCO, DisconController
from galerna.control.interface import Measurements
from galerna.control.options import DisconOptions
from galerna.turbine.model import Turbine

from .framework import Benchmark, Figure, seconds

CALLS, STEP = 3000, 0.02
RATED = Measurements(0.0, 1.267, 122.9, 43.1e3, 5e6, np.full(3, 0.26), 0.0, wind_speed=18.0)


def controller(turbine: Turbine) -> DisconController:
    """ROSCO for the NREL 5 MW."""
    options = DisconOptions(input_file="rosco_nrel5mw/DISCON.IN")
    return DisconController(options, turbine, examples.folder(), STEP)


def discon() -> Sequence[Figure]:
    """Start, one call from measurements to demands, and a restore."""
    if find_spec(ROSCO) is None:
        return []
    turbine = turbines.load("nrel5mw")
    start = seconds(lambda: controller(turbine).close())
    library, times = controller(turbine), []
    for i in range(CALLS):
        measured = replace(RATED, time=STEP * i)
        began = time.perf_counter()
        library.demands(measured)
        times.append(time.perf_counter() - began)
    state, fresh = library.state(), controller(turbine)
    began = time.perf_counter()
    fresh.restore(state)
    replay = time.perf_counter() - began
    for each in (library, fresh):
        each.close()
    return [
        Figure("start and end of the process", 1e3 * start, "ms", 300.0),
        Figure("one call of ROSCO, median", 1e6 * median(times), "us", 100.0),
        Figure("replay of 1000 calls", 1e3 * replay / CALLS * 1000, "ms"),
    ]


BENCHMARKS = (Benchmark("discon", "machine", "a library in a process of its own", discon),)
