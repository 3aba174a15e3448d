"""Says that kernels are being compiled, which takes minutes in the first run and no time later."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from numba.core import event

from galerna.simulation import Callback, Simulation

SHORT = 0.5  #: s of compiling that nobody needs to know of
USUAL = "a minute or two"  #: what all kernels of a run take

log = logging.getLogger("galerna")


class Watch(event.Listener):  # type: ignore[misc]
    """Sees every kernel that Numba compiles, not those that it has in its cache.

    Says so once ``SHORT`` s have gone by, and in ``report`` how long it was.
    """

    def __init__(self) -> None:
        self._depth, self._began = 0, 0.0
        self._said, self._count, self._spent = False, 0, 0.0

    def on_start(self, event: event.Event) -> None:
        """A kernel, perhaps one that another one calls."""
        if self._depth == 0:
            self._began = time.perf_counter()
            self._say()
        self._depth += 1

    def on_end(self, event: event.Event) -> None:
        """It is compiled, or it failed."""
        self._depth -= 1
        self._count += 1
        if self._depth == 0:
            self._spent += time.perf_counter() - self._began

    def report(self) -> None:
        """Say how long it took, if it was said that it goes on."""
        if self._said:
            log.warning("compiled %d kernels in %.0f s", self._count, self._spent)
        self._forget()

    def _say(self) -> None:
        if not self._said and self._spent > SHORT:
            log.warning("compiling the kernels, once for this version: %s ...", USUAL)
            self._said = True

    def _forget(self) -> None:
        self._said, self._count, self._spent = False, 0, 0.0


@cache
def watch() -> Watch:
    """The one that watches from the first call on."""
    found = Watch()
    event.register("numba:compile", found)
    return found


@contextmanager
def announced() -> Iterator[None]:
    """Say of what goes on inside that it compiles, and at the end for how long it did."""
    watching = watch()
    try:
        yield
    finally:
        watching.report()


class Report(Callback):
    """Says after the second step for how long a run has compiled: then all kernels are there."""

    def start(self, simulation: Simulation, end: float) -> None:
        """Count the steps of this run."""
        watch()
        self._steps = 0

    def accepted(self, simulation: Simulation) -> None:
        """Report once."""
        self._steps += 1
        if self._steps == 2:
            watch().report()
