"""What a turbine does (produce power, start, stop, stand still), and when that changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import get_args

import numpy as np

from galerna.control.options import Mode
from galerna.errors import InputError, did_you_mean

MODES: tuple[Mode, ...] = get_args(Mode)
GENERATING: tuple[Mode, ...] = ("production", "start_up", "normal_stop")

Events = Sequence[tuple[float, Mode]]


class Supervisor:
    """The mode of a turbine over time.

    ``events`` (time s, mode) change it; a rotor faster than ``overspeed`` rad/s, where it is
    given, brings an emergency stop, which only an event ends. Raises InputError for a mode that
    does not exist.
    """

    def __init__(self, mode: Mode, events: Events = (), overspeed: float | None = None) -> None:
        for name in (mode, *(name for _, name in events)):
            if name not in MODES:
                raise InputError("mode", f"{name!r} is not known", did_you_mean(name, MODES))
        self.mode, self._events, self._overspeed = mode, events, overspeed
        self._time = -inf

    def update(self, time: float, rotor_speed: float) -> bool:
        """Go on to a time in s; True where the mode changes."""
        before, started = self.mode, self._time
        self._time = time
        if self._overspeed is not None and rotor_speed > self._overspeed:
            self.mode = "emergency_stop"
        for when, mode in self._events:
            if started < when <= time + 1e-9:
                self.mode = mode
                self._time = max(self._time, when)
        return self.mode != before

    def state(self) -> dict[str, np.ndarray]:
        """The mode, by its number, and the time of the last look at the events."""
        return {"mode": np.array([MODES.index(self.mode), self._time])}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        number, self._time = state["mode"].tolist()
        self.mode = MODES[int(number)]
