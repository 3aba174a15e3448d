"""What galerna says when it cannot go on: where, what was expected, what to do."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


class GalernaError(Exception):
    """Base of every error that galerna raises on purpose."""

    exit_code = 1


class InputError(GalernaError):
    """Something that the user gave cannot be used.

    ``where`` is a file, a line, a key path or an argument; ``what`` is the
    problem with what was found and what was expected; ``hint`` is what to do.
    """

    exit_code = 2

    def __init__(self, where: str, what: str, hint: str = "") -> None:
        self.where, self.what, self.hint = where, what, hint
        super().__init__(f"{where}: {what}" + (f"\n  {hint}" if hint else ""))


class SimulationError(GalernaError):
    """A simulation cannot go on: where, at which time in s, what, and what to do."""

    def __init__(self, where: str, what: str, hint: str = "", time: float | None = None) -> None:
        self.where, self.what, self.hint, self.time = where, what, hint, time
        at = "" if time is None else f" at t = {time:.6g} s"
        super().__init__(f"{where}{at}: {what}" + (f"\n  {hint}" if hint else ""))


class ConvergenceError(SimulationError):
    """A solution was not found; says at which time and in which part."""

    exit_code = 3


class ControllerError(SimulationError):
    """A controller that the user brought failed: it crashed, hung or asked for the impossible."""

    exit_code = 4


def did_you_mean(name: str, valid: Iterable[str]) -> str:
    """A sentence with the nearest valid names, or with all of them."""
    names = sorted(valid)
    close = get_close_matches(name, names, n=3, cutoff=0.6)
    if close:
        return "did you mean " + " or ".join(repr(c) for c in close) + "?"
    return "valid names: " + ", ".join(names)
