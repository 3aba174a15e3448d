"""What shows the waves at a place."""

from __future__ import annotations

from collections.abc import Mapping

from numpy.typing import ArrayLike

from galerna.contract import Array, Channel
from galerna.hydro.waves.sea import Sea


class WaveProbe:
    """The undisturbed elevation above ``point`` (2,) m, as a channel."""

    channels = (
        Channel("wave_elevation", "m", "wave elevation at the platform", (), "Wave1Elev", "m"),
    )

    def __init__(self, sea: Sea, point: ArrayLike = (0.0, 0.0)) -> None:
        self.coordinates: Mapping[str, Array] = {}
        self._elevation = sea.elevation_at(point)

    def record(self, time: float) -> Mapping[str, float | Array]:
        """The elevation at ``time`` s."""
        return {"wave_elevation": float(self._elevation.at(time)[0])}
