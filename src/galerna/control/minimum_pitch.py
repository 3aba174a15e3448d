"""The lowest pitch in production: the fine pitch, or a table over the wind.

Turbines whose rotor cannot turn slowly enough pitch the blades a little in low wind, where the
tip-speed ratio is above its best; others keep the thrust's peak down near rated wind. The wind
is the hub's, low-pass filtered over a turn of the rotor at rated speed, as in the Basic DTU Wind
Energy controller (Hansen, Henriksen, DTU Wind Energy E-0018, 2013).
"""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.control.pitch import LowPass
from galerna.turbine.model import Control


class MinimumPitch:
    """Lowest pitch rad over the filtered wind; ``table`` (n,2) holds wind m/s and pitch rad."""

    def __init__(self, fine: float, table: Array | None, corner: float) -> None:
        self._fine, self._table, self.wind = fine, table, LowPass(corner)

    @classmethod
    def of(cls, control: Control, fine: float | None = None) -> MinimumPitch:
        """That of a turbine; a fine pitch rad that is given stands for its table too."""
        if fine is not None:
            return cls(fine, None, control.rated_rotor_speed)
        return cls(control.fine_pitch, control.minimum_pitch_table, control.rated_rotor_speed)

    def __call__(self, wind_speed: float, dt: float) -> float:
        """The lowest pitch after ``dt`` s of a wind speed m/s."""
        if self._table is None:
            return self._fine
        wind = self.wind(wind_speed, dt)
        return max(self._fine, float(np.interp(wind, self._table[:, 0], self._table[:, 1])))
