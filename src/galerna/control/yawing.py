"""Yaw control: the nacelle turns slowly into the mean wind when that is far enough to the side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import copysign, pi

import numpy as np

from galerna.control.actuators import lagged
from galerna.errors import InputError
from galerna.units import DEG


@dataclass(frozen=True)
class YawSettings:
    """``rate`` rad/s, ``dead_band`` rad, and the time constant ``averaging`` s of the error."""

    rate: float = 0.3 * DEG
    dead_band: float = 8.0 * DEG
    averaging: float = 60.0

    def __post_init__(self) -> None:
        if self.rate <= 0.0 or self.dead_band < 0.0 or self.averaging < 0.0:
            raise InputError("yaw", "needs a positive rate, a dead band and an averaging from 0 on")


class YawControl:
    """The yaw rate that a nacelle is turned with.

    When the averaged yaw error (nacelle yaw minus wind direction) leaves the dead band, the
    nacelle turns back by as much, and the average starts anew.
    """

    def __init__(self, settings: YawSettings) -> None:
        self.settings = settings
        self.error = np.nan  #: rad, averaged
        self._turn = 0.0  # rad that are still to go

    def __call__(self, yaw_error: float, dt: float) -> float:
        """Yaw rate rad/s, ``dt`` s after the last one."""
        now = wrapped(yaw_error)
        if self._turn:
            step = copysign(self.settings.rate * dt, self._turn)
            self._turn = 0.0 if abs(step) >= abs(self._turn) else self._turn - step
            if not self._turn:
                self.error = now
        elif np.isnan(self.error):
            self.error = now
        else:
            self.error = lagged(now, self.error, self.settings.averaging, dt)
        if not self._turn and abs(self.error) > self.settings.dead_band:
            self._turn = -self.error
        return copysign(self.settings.rate, self._turn) if self._turn else 0.0

    def state(self) -> dict[str, np.ndarray]:
        """The averaged error and what is still to be turned."""
        return {"yaw_control": np.array([self.error, self._turn])}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.error, self._turn = state["yaw_control"].tolist()


def wrapped(angle: float) -> float:
    """The same angle from -pi to pi, rad."""
    return (angle + pi) % (2.0 * pi) - pi
