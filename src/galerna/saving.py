"""When a run writes checkpoints, and which of them stays."""

from __future__ import annotations

import logging
import time
from dataclasses import dataclass
from functools import cached_property
from math import inf
from pathlib import Path
from typing import Protocol

import numpy as np

from galerna.checkpoints import Origin, remove, wind_samples, write
from galerna.contract import Array
from galerna.errors import InputError
from galerna.machine import Machine
from galerna.results.dataset import checkpoint_of
from galerna.simulation import Callback, Simulation

LARGEST_SHARE = 0.02  #: of a run's time that goes into checkpoints

log = logging.getLogger("galerna")


@dataclass(frozen=True)
class Saving:
    """``every`` s of the wall clock a checkpoint, and whether the last one of a whole run stays."""

    every: float = 60.0
    keep: bool = False


class Records(Protocol):
    """The result of the run, as far as it is written: ``steps`` of the simulation are in it."""

    @property
    def path(self) -> Path: ...
    @property
    def steps(self) -> int: ...
    @property
    def records(self) -> int: ...
    def sync(self) -> None: ...


class Checkpointer(Callback):
    """Writes checkpoints of a run beside its result, seldom enough to cost next to nothing.

    A disk that does not take one is told of, and does not stop the run. ``resumed`` holds the
    times s at which the run has gone on before.
    """

    def __init__(
        self,
        machine: Machine,
        written: Records,
        run: str,
        saving: Saving,
        resumed: tuple[float, ...] = (),
    ) -> None:
        self.path = checkpoint_of(written.path)
        self._machine, self._written, self._run = machine, written, run
        self._saving, self._resumed = saving, resumed
        self._due = inf

    def start(self, simulation: Simulation, end: float) -> None:
        """Start the clock."""
        self._due = time.perf_counter() + self._saving.every

    def accepted(self, simulation: Simulation) -> None:
        """Write a checkpoint where one is due."""
        if time.perf_counter() >= self._due:
            self._write(simulation.state())

    def save(self) -> None:
        """Write the last accepted state of a run that ends here, as far as it is known."""
        simulation = self._machine.simulation
        state = simulation.accepted_state() if self._written.steps == simulation.steps else None
        if state is not None:
            self._write(state)

    def remove(self) -> None:
        """Leave no checkpoint."""
        remove(self.path)

    @cached_property
    def _wind(self) -> Array:
        return wind_samples(self._machine, self._machine.case.case.duration_s)

    def _write(self, state: dict[str, np.ndarray]) -> None:
        began = time.perf_counter()
        origin = Origin.of(self._machine, self._run, self._written.records, self._resumed)
        try:
            self._written.sync()
            write(self.path, origin, self._wind, {} if origin.obstacle else state)
        except (InputError, OSError) as error:
            log.warning("no checkpoint at %g s: %s", origin.time, error)
        ended = time.perf_counter()
        wait = max(self._saving.every, (ended - began) / LARGEST_SHARE)
        self._due = inf if origin.obstacle else ended + wait
