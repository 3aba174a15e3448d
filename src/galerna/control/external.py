"""No controller: a Python program says from step to step what the machine does."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from galerna.control.interface import Demands, Measurements


class ExternalController:
    """Holds what it was told last; at the start the pitch and the torque that it finds."""

    def __init__(self) -> None:
        self._held: Demands | None = None

    def demands(self, measured: Measurements) -> Demands:
        """What holds."""
        if self._held is None:
            self._held = Demands(measured.pitch.copy(), measured.generator_torque)
        return self._held

    def hold(self, demands: Demands) -> None:
        """Ask for this from now on."""
        self._held = demands

    def state(self) -> dict[str, np.ndarray]:
        """What holds."""
        if self._held is None:
            return {}
        held = self._held
        return {
            "held_pitch": np.array(held.pitch),
            "held": np.array([held.generator_torque, held.yaw_rate, held.brake]),
        }

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._held = None
        if "held" in state:
            self._held = Demands(state["held_pitch"].copy(), *state["held"].tolist())
