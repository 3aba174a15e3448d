"""What a person sees while a simulation runs: a bar, or a line now and then."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from galerna.simulation import Callback, Simulation
from galerna.units import DEG, RPM


class Pace(Callback):
    """Knows how fast a run goes, and looks at it every ``interval`` s of the wall clock.

    The clock starts after the first step, which also loads or compiles the kernels.
    """

    interval: float

    def start(self, simulation: Simulation, end: float) -> None:
        self._end, self._began = end, 0.0

    def accepted(self, simulation: Simulation) -> None:
        now = time.perf_counter()
        if not self._began:
            self._first, self._began, self._last = simulation.time, now, now
        elif now - self._last >= self.interval:
            self._last = now
            factor = (simulation.time - self._first) / (now - self._began)
            self.show(simulation, factor, (self._end - simulation.time) / factor)

    def show(self, simulation: Simulation, factor: float, remaining: float) -> None:
        """Show a run that goes ``factor`` times real time and ends in ``remaining`` s."""
        raise NotImplementedError


class ProgressLine(Pace):
    """A line on stderr every ten seconds."""

    interval = 10.0

    def show(self, simulation: Simulation, factor: float, remaining: float) -> None:
        at = f"{simulation.time:.1f} of {self._end:.1f} s, {factor:.1f} x real time"
        print(f"{at}, {remaining:.0f} s left, {machine(simulation)}", file=sys.stderr, flush=True)


class ProgressBar(Pace):
    """A bar with simulated time, real-time factor, remaining time, rotor speed, pitch, power."""

    interval = 0.2

    def start(self, simulation: Simulation, end: float) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        super().start(simulation, end)
        self._progress = Progress(
            TextColumn("{task.completed:7.1f} of {task.total:.1f} s"),
            BarColumn(bar_width=24),
            TextColumn("{task.description}"),
            console=Console(stderr=True),
            transient=True,
        )
        self._task = self._progress.add_task("first step", total=end)
        self._progress.start()

    def show(self, simulation: Simulation, factor: float, remaining: float) -> None:
        minutes, seconds = divmod(round(remaining), 60)
        pace = f"{factor:.1f} x real time, {minutes}:{seconds:02d} left"
        text = f"{pace}  {machine(simulation)}"
        self._progress.update(self._task, completed=simulation.time, description=text)

    def finish(self, simulation: Simulation) -> None:
        self._progress.stop()


def machine(simulation: Simulation) -> str:
    """Rotor speed, pitch and power of the accepted state, as far as they are known.

    The power is the generator's where there is one.
    """
    record = simulation.record()
    shown = []
    if "rotor_speed" in record:
        shown.append(f"{np.mean(record['rotor_speed']) / RPM:.2f} rpm")
    if "pitch" in record:
        shown.append(f"{np.mean(record['pitch']) / DEG:.2f} deg")
    for name, kind in (("electrical_power", "electrical"), ("rotor_power", "aerodynamic")):
        if name in record:
            shown.append(f"{np.mean(record[name]) / 1e6:z.3f} MW {kind}")
            break
    return "  ".join(shown)


@contextmanager
def working(what: str) -> Iterator[None]:
    """Say on stderr what goes on inside: a spinner on a terminal, a line elsewhere."""
    if not sys.stderr.isatty():
        print(f"{what} ...", file=sys.stderr, flush=True)
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(what):
        yield


def best(stream_is_terminal: bool) -> Callback:
    """A bar on a terminal, lines elsewhere."""
    return ProgressBar() if stream_is_terminal else ProgressLine()
