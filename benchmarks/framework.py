"""Speed and scale, measured: each benchmark returns figures beside what was wanted.

A module lists its benchmarks in ``BENCHMARKS``; ``benchmarks/__init__.py`` lists
the modules. A peer runs in the same process or right after, so that a ratio holds on a
noisy machine; where it is not installed its columns stay empty.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from statistics import median


@dataclass(frozen=True)
class Figure:
    """One measured figure. ``wanted`` is an upper bound, or a lower one where ``at_least``."""

    quantity: str
    value: float
    unit: str
    wanted: float | None = None
    at_least: bool = False
    peer: str = ""
    peer_value: float | None = None

    @property
    def passed(self) -> bool | None:
        if self.wanted is None:
            return None
        return bool(self.value >= self.wanted if self.at_least else self.value <= self.wanted)

    @property
    def ratio(self) -> float | None:
        """How many times better than the peer galerna is."""
        if self.peer_value is None:
            return None
        return self.value / self.peer_value if self.at_least else self.peer_value / self.value


@dataclass(frozen=True)
class Benchmark:
    """A named measurement; ``run`` may take up to a few minutes."""

    name: str
    group: str
    title: str
    run: Callable[[], Sequence[Figure]]


def seconds(function: Callable[[], object], repeat: int = 5) -> float:
    """Median wall seconds of ``function()`` over ``repeat`` runs, after one warm-up."""
    function()
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return median(times)


def records(benchmark: Benchmark, figures: Sequence[Figure]) -> list[dict[str, object]]:
    """Flat records as ``python -m benchmarks --json`` writes them."""
    return [
        {"name": benchmark.name, "group": benchmark.group}
        | asdict(figure)
        | {"passed": figure.passed, "ratio": figure.ratio}
        for figure in figures
    ]


def machine() -> str:
    """The machine in one line, for the page."""
    import platform

    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as lines:
            model = next(line.split(":")[1].strip() for line in lines if "model name" in line)
    except (OSError, StopIteration):
        pass
    return f"{os.cpu_count()} cores of {model}, Python {platform.python_version()}"
