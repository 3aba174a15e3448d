"""The rotor's brake: friction on the low-speed shaft that holds as well as it slows down.

While it slips it gives its full torque against the motion; below that it is a stiff spring with a
damper, whose rest moves along when it slips: friction with presliding (Dahl, 1968). A torque that
changes once per time step can hold no stiffer than STIFFNESS and DAMPING of the inertia it holds:
with these the discrete motion decays for any larger inertia.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

STIFFNESS, DAMPING = 0.25, 0.7  #: times inertia / dt^2, and inertia / dt


class Brake:
    """Friction on a shaft whose smallest free inertia is ``inertia`` kg m2."""

    def __init__(self, inertia: float) -> None:
        self._inertia = inertia
        self._twist = 0.0  # rad, of the spring

    def torque(self, grip: float, speed: float, dt: float) -> float:
        """Torque N m against the rotation at a speed rad/s, at most ``grip`` N m, for ``dt`` s."""
        if grip <= 0.0:
            self._twist = 0.0
            return 0.0
        stiffness, damping = STIFFNESS * self._inertia / dt**2, DAMPING * self._inertia / dt
        most = grip / stiffness
        torque = stiffness * self._twist + damping * speed
        self._twist = min(max(self._twist + speed * dt, -most), most)
        return min(max(torque, -grip), grip)

    def state(self) -> dict[str, np.ndarray]:
        """The twist of its spring."""
        return {"brake_twist": np.array(self._twist)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._twist = float(state["brake_twist"])
