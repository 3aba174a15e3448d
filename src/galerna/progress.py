"""What a person sees while a simulation runs: a bar, or a line now and then."""

from __future__ import annotations

import sys
import time

import numpy as np

from galerna.simulation import Callback, Simulation
from galerna.units import DEG, RPM

REFRESH = 0.2  #: s of the wall clock between two looks at the machine
LINE_EVERY = 10.0  #: s of the wall clock between two lines where there is no terminal


class ProgressLine(Callback):
    """A line on stderr every ten seconds: simulated time, real-time factor, remaining time."""

    def start(self, simulation: Simulation, end: float) -> None:
        self._end, self._first = end, simulation.time
        self._began = self._last = time.perf_counter()

    def accepted(self, simulation: Simulation) -> None:
        now = time.perf_counter()
        if now - self._last >= LINE_EVERY:
            self._last = now
            print(self._line(simulation, now), file=sys.stderr, flush=True)

    def _line(self, simulation: Simulation, now: float) -> str:
        factor = (simulation.time - self._first) / (now - self._began)
        remaining = (self._end - simulation.time) / factor
        at = f"{simulation.time:.1f} of {self._end:.1f} s"
        return f"{at}, {factor:.1f} x real time, {remaining:.0f} s left, {machine(simulation)}"


class ProgressBar(Callback):
    """A bar with simulated time, real-time factor, remaining time, rotor speed, pitch, power."""

    def start(self, simulation: Simulation, end: float) -> None:
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        self._progress = Progress(
            TextColumn("{task.completed:7.1f} of {task.total:.1f} s"),
            BarColumn(bar_width=24),
            TextColumn("{task.fields[factor]:6.1f} x real time"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[machine]}"),
            transient=True,
        )
        self._first, self._began, self._last = simulation.time, time.perf_counter(), 0.0
        self._task = self._progress.add_task("", total=end, factor=0.0, machine="")
        self._progress.start()

    def accepted(self, simulation: Simulation) -> None:
        now = time.perf_counter()
        if now - self._last < REFRESH:
            return
        self._last = now
        factor = (simulation.time - self._first) / (now - self._began)
        state = machine(simulation)
        self._progress.update(self._task, completed=simulation.time, factor=factor, machine=state)

    def finish(self, simulation: Simulation) -> None:
        self._progress.stop()


def machine(simulation: Simulation) -> str:
    """Rotor speed, pitch and power of the accepted state, as far as they are known."""
    record = simulation.record()
    shown = []
    if "rotor_speed" in record:
        shown.append(f"{np.mean(record['rotor_speed']) / RPM:.2f} rpm")
    if "pitch" in record:
        shown.append(f"{np.mean(record['pitch']) / DEG:.2f} deg")
    if "rotor_power" in record:
        shown.append(f"{np.mean(record['rotor_power']) / 1e6:.3f} MW")
    return "  ".join(shown)


def best(stream_is_terminal: bool) -> Callback:
    """A bar on a terminal, lines elsewhere."""
    return ProgressBar() if stream_is_terminal else ProgressLine()
