"""Ctrl-C and SIGTERM, which a batch system sends before it kills: how commands end by them."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from galerna.errors import GalernaError
from galerna.simulation import Callback, Simulation

if TYPE_CHECKING:
    from types import FrameType


class InterruptedRunError(GalernaError):
    """The user pressed Ctrl-C, or something sent SIGTERM."""

    def __init__(self, interrupt: KeyboardInterrupt) -> None:
        super().__init__(str(interrupt) or "interrupted")
        terminated = isinstance(interrupt, Terminated)
        self.exit_code = 128 + (signal.SIGTERM if terminated else signal.SIGINT)
        for note in getattr(interrupt, "__notes__", ()):
            self.add_note(note)


class Terminated(KeyboardInterrupt):
    """SIGTERM ends a command as Ctrl-C does."""


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise _meaning(number)


def _meaning(number: int) -> KeyboardInterrupt:
    return Terminated("terminated") if number == signal.SIGTERM else KeyboardInterrupt()


@contextmanager
def interruptible() -> Iterator[None]:
    """Turn Ctrl-C and SIGTERM into an error that keeps the notes on what was saved."""
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        yield
    except KeyboardInterrupt as interrupt:
        raise InterruptedRunError(interrupt) from None
    finally:
        signal.signal(signal.SIGTERM, before)


class AfterTheStep(Callback):
    """Lets a run end by the first signal after the step under way, by a second one at once.

    So the run stops where its state is known, and can be resumed from there.
    """

    def start(self, simulation: Simulation, end: float) -> None:
        """Take the signals over."""
        self._received: KeyboardInterrupt | None = None
        numbers = (signal.SIGINT, signal.SIGTERM)
        self._before: dict[int, Any] = {n: signal.signal(n, self._receive) for n in numbers}

    def accepted(self, simulation: Simulation) -> None:
        """End the run where that was asked for."""
        if self._received is not None:
            raise self._received

    def finish(self, simulation: Simulation) -> None:
        """Give the signals back."""
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _receive(self, number: int, frame: FrameType | None) -> None:
        again = self._received is not None
        self._received = _meaning(number)
        if again:
            raise self._received
