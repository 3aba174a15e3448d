"""A simulation in the hands of a Python program: step by step, with or without a controller."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from galerna.case import Case, LoadedCase, load
from galerna.control.interface import Controller, Measurements
from galerna.coupling.control_loop import ControlLoop
from galerna.machine import Machine, build_machine
from galerna.simulation import Record

if TYPE_CHECKING:
    from galerna.simulation import Simulation

SHARED = ("sample_time_s", "pitch_actuator", "torque_time_constant_s")  #: by all controllers


def start(
    case: str | Path | Mapping[str, Any] | Case | LoadedCase, controller: Controller | None = None
) -> Session:
    """A case at its start, ready for ``step``.

    The ``controller`` is an object with a method ``demands``; without one it is the case's, and
    where the case has none, what ``step`` is told holds. Raises InputError.
    """
    loaded = case if isinstance(case, LoadedCase) else load(case)
    if controller is not None or loaded.case.control is None:
        loaded = _from_outside(loaded)
    return Session(build_machine(loaded, controller))


def _from_outside(loaded: LoadedCase) -> LoadedCase:
    """The same case, its pitch and torque from a Python program."""
    values = loaded.document.values
    block = values.get("control")
    kept = {key: block[key] for key in SHARED if key in block} if isinstance(block, dict) else {}
    changed = {**values, "name": loaded.name, "control": {"model": "external", **kept}}
    return replace(load(changed), folder=loaded.folder)


class Session:
    """A machine that is stepped from Python; all in SI and radians.

    A ``with`` block, or ``close``, lets go of what a controller holds.
    """

    def __init__(self, machine: Machine) -> None:
        assert isinstance(machine.simulation.commander, ControlLoop)
        self.machine = machine
        self.simulation: Simulation = machine.simulation
        self._loop = machine.simulation.commander

    @property
    def time(self) -> float:
        """Time of the accepted state, s."""
        return self.simulation.time

    def step(
        self,
        pitch: ArrayLike | None = None,
        torque: float | None = None,
        yaw_rate: float | None = None,
        brake: float | None = None,
    ) -> Measurements:
        """One time step; returns what the sensors show after it.

        ``pitch`` rad (one, or one per blade), generator ``torque`` N m, ``yaw_rate`` rad/s and
        ``brake`` N m at the low-speed shaft are demands to the actuators. What is left out comes
        from the controller; without one it stays as it was. Raises ControllerError for demands
        that cannot be met, ConvergenceError where the step fails.
        """
        given = (pitch, torque, yaw_rate, brake)
        if any(value is not None for value in given):
            self._loop.override(*given)
        self.simulation.advance()
        return self.measure()

    def measure(self) -> Measurements:
        """What the sensors show now."""
        return self._loop.measure(self.time)

    def record(self) -> Record:
        """Every channel now, by its name."""
        return self.simulation.record()

    def state(self) -> dict[str, np.ndarray]:
        """Everything that the next step depends on, to go back to with ``restore``."""
        return self.simulation.state()

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Go back to a ``state``; from there the steps are the same to the bit."""
        self.simulation.restore(state)

    def close(self) -> None:
        """Let go of what the controller holds."""
        self.machine.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()
