"""All channels of the moving machine, read in one pass when a record is due."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from galerna.contract import Array, Channel, Loads, Stations
from galerna.coupling.blade_sensors import BladeSensors
from galerna.coupling.shaft_sensors import ShaftSensors
from galerna.coupling.snapshot import Snapshot
from galerna.coupling.tower_sensors import TowerSensors
from galerna.structure.attachment import Attachment
from galerna.structure.pairs import Integers
from galerna.structure.system import Forces, State
from galerna.structure.turbine import TurbineSystem
from galerna.turbine.model import Turbine


@dataclass(frozen=True)
class Gauges:
    """Where section loads are read, in fractions of the axis of blades and tower."""

    blade: tuple[float, ...] = (0.25, 0.5, 0.75)
    tower: tuple[float, ...] = (0.5,)


class Sensors:
    """What is read of a machine's state; ``pitch`` rad is that of its described shape.

    ``tower_riders`` hold, for every load model, its stations on the tower and their rows.
    """

    def __init__(
        self,
        turbine: Turbine,
        parts: TurbineSystem,
        pitch: float,
        tower_riders: Sequence[tuple[Attachment, Integers] | None],
        gauges: Gauges,
    ) -> None:
        self._system, self._riders = parts.system, tower_riders
        self.blades = BladeSensors(turbine, parts, pitch, np.array(gauges.blade))
        self.tower = TowerSensors(turbine, parts, np.array(gauges.tower))
        self.shaft = ShaftSensors(turbine, parts)
        self.channels: tuple[Channel, ...] = (
            self.blades.channels + self.shaft.channels + self.tower.channels
        )
        stations = {"blade_station": gauges.blade, "tower_station": gauges.tower}
        needed = {dim for channel in self.channels for dim in channel.dims}
        self.coordinates: Mapping[str, Array] = {
            name: np.array(values) for name, values in stations.items() if name in needed
        }

    def record(
        self, state: State, loads: Sequence[Loads], rotor_speed: float
    ) -> dict[str, float | Array]:
        """All channels at a state under the loads of the load models."""
        wrenches = self._system.node_wrenches(state)
        at = Snapshot(state, wrenches, self._tower_loads(state, loads))
        return {
            **self.blades.record(at, *self.tower.surface(state)),
            **self.shaft.record(at, rotor_speed),
            **self.tower.record(at),
        }

    def _tower_loads(self, state: State, loads: Sequence[Loads]) -> Array:
        """What load models put on the tower's first frame (6,), in its axes."""
        forces = Forces.none(len(self._system))
        for riding, load in zip(self._riders, loads, strict=False):
            if riding is not None:
                riders, rows = riding
                riders.follow(state)
                riders.add_loads(Loads(load.force[rows], load.moment[rows]), forces)
        return forces.follower[self.tower.base]


def rows_of(group: Sequence[Stations], part: str) -> tuple[list[Stations], Integers]:
    """The stations of one part in a load model's, and their rows in its loads."""
    ends = np.cumsum([len(stations) for stations in group])
    chosen = [
        (stations, np.arange(end - len(stations), end))
        for stations, end in zip(group, ends, strict=True)
        if stations.part == part
    ]
    if not chosen:
        return [], np.zeros(0, dtype=np.int64)
    return [stations for stations, _ in chosen], np.concatenate([rows for _, rows in chosen])
