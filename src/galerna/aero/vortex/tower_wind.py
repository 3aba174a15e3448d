"""The wind that blades meet behind and before a tower."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from galerna.aero.tower_influence import add_tower_influence, tower_sections
from galerna.contract import Array, Inflow, Motion, Stations
from galerna.errors import ConvergenceError
from galerna.turbine.model import Tower


class TowerWind:
    """An ``inflow`` as the tower lets it through; the tower's stations stand last of ``stations``.

    ``see`` tells where the tower and the blades are.
    """

    def __init__(self, inflow: Inflow, tower: Tower, stations: Sequence[Stations]) -> None:
        self.inflow = inflow
        self._sections = tower_sections(tower, tower.axis_span)
        self._stations = stations
        self._motion = Motion.at_rest(sum(len(s) for s in stations))
        self._time = 0.0

    def see(self, motion: Motion, time: float) -> None:
        """Take the motion at ``time`` s; its arrays are read at the next ``velocity``."""
        self._motion, self._time = motion, time

    def velocity(self, points: Array, time: float) -> Array:
        """Wind (n,3) m/s at points (n,3) m; ConvergenceError for a point inside the tower."""
        velocity = np.array(self.inflow.velocity(points, time))
        tower = slice(-len(self._sections), None)
        inside = add_tower_influence(
            np.ascontiguousarray(points),
            self._motion.position[tower],
            self._motion.velocity[tower],
            self._sections,
            True,
            velocity,
        )
        if inside >= 0:
            part, span = self._nearest(points[inside])
            raise ConvergenceError(
                part,
                f"is inside the tower at {span:.1%} of its span",
                "check overhang, tilt, cone and prebend, or the deflection",
                time,
            )
        return velocity

    def _nearest(self, point: Array) -> tuple[str, float]:
        """The blade's station next to a point."""
        places = [(s.part, span) for s in self._stations[:-1] for span in s.span]
        distance = np.linalg.norm(self._motion.position[: len(places)] - point, axis=1)
        return places[int(np.argmin(distance))]
