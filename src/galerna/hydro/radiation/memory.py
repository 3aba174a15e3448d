"""How radiation is stepped: a trial of one step, committed when the step is accepted."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from galerna.contract import Array

from .state_space import RadiationStateSpace

KEPT_STEPS = 8  #: step sizes whose matrices are kept


class Memory(Protocol):
    """Radiation force ``free - block @ v1`` at the end of a step, the platform's mean axes.

    ``begin`` takes dt and the velocity (6,) at the step's start and gives ``free`` (6,) N, N m and
    ``block`` (6,6); ``commit`` takes the velocity at its end.
    """

    def begin(self, dt: float, velocity: Array) -> tuple[Array, Array]: ...
    def commit(self, velocity: Array) -> None: ...
    def state(self) -> dict[str, np.ndarray]: ...
    def restore(self, state: Mapping[str, np.ndarray]) -> None: ...


class NoMemory:
    """Water that forgets at once."""

    def begin(self, dt: float, velocity: Array) -> tuple[Array, Array]:
        """No force, and none that grows with the velocity."""
        return np.zeros(6), np.zeros((6, 6))

    def commit(self, velocity: Array) -> None:
        """Nothing to keep."""

    def state(self) -> dict[str, np.ndarray]:
        """Empty."""
        return {}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Nothing to take back."""


class StateSpaceMemory:
    """The states of a fitted radiation; exact where the velocity is linear over each step."""

    def __init__(self, radiation: RadiationStateSpace) -> None:
        self.radiation = radiation
        self._x = np.zeros(len(radiation))
        self._free = np.zeros(len(radiation))
        self._rise = np.zeros((len(radiation), 6))
        self._steps: dict[float, tuple[Array, Array, Array, Array]] = {}

    @property
    def energy(self) -> float:
        """What the water around the platform could give back, J."""
        return 0.5 * float(self._x @ self._x)

    def begin(self, dt: float, velocity: Array) -> tuple[Array, Array]:
        """x1 = E x0 + B0 v0 + B1 v1, of which all but the last is known."""
        E, B0, self._rise, block = self._step(dt)
        self._free = E @ self._x + B0 @ velocity
        return -self.radiation.B.T @ self._free, block

    def _step(self, dt: float) -> tuple[Array, Array, Array, Array]:
        """The matrices of a step size, and the damping (6,6) that they make."""
        if dt not in self._steps:
            if len(self._steps) == KEPT_STEPS:
                self._steps.pop(next(iter(self._steps)))
            E, B0, B1 = self.radiation.step(dt)
            self._steps[dt] = E, B0, B1, self.radiation.B.T @ B1
        return self._steps[dt]

    def commit(self, velocity: Array) -> None:
        """Take the states to the end of the step."""
        self._x = self._free + self._rise @ velocity

    def state(self) -> dict[str, np.ndarray]:
        """The states (n,)."""
        return {"radiation": self._x.copy()}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take the states back."""
        self._x = np.array(state["radiation"], dtype=float)
