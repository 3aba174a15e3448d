"""Mooring lines as a load on the platform: elastic catenaries in balance at every moment."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf

import numpy as np

from galerna.contract import Array, Channel, Loads, Motion, Stations
from galerna.hydro.strips import Carrier
from galerna.turbine.platform import Mooring
from galerna.units import SEA_WATER, STANDARD_GRAVITY

from .catenary import RESTING
from .lines import on_body, place, tensions, turn_back
from .network import Found, Network

_LINES = ("mooring_line",)
CHANNELS = (
    Channel("fairlead_tension", "N", "tension of a line's end at the platform", _LINES,
            "FAIRTEN{node}", "N"),
    Channel("anchor_tension", "N", "tension of a line's other end", _LINES,
            "ANCHTEN{node}", "N"),
    Channel("grounded_length", "m", "length of a line on the seabed", _LINES),
    *(
        Channel(f"mooring_{kind}_{axis}", unit, f"{text} {axis} of lines and yaw spring")
        for kind, unit, text in (("force", "N", "force along"), ("moment", "N m", "moment about"))
        for axis in "xyz"
    ),
)  # fmt: skip


class Fairleads:
    """Where a body carries the fairleads of a network, and the yaw spring between it and the earth.

    All of them ride on the one frame of ``carrier`` that is nearest to their mean height.
    """

    def __init__(self, network: Network, carrier: Carrier) -> None:
        self.network = network
        places = network.points[network.vessel]
        height = places[:, 2].mean() if len(places) else 0.0
        frame = int(np.abs(carrier.position[:, 2] - height).argmin())
        span = carrier.stations.span[frame : frame + 1]
        self.stations = (Stations(carrier.stations.part, span),)
        #: the frame as described, and the fairleads in its axes
        self.place, self.axes = carrier.position[frame], carrier.rotation[frame]
        self._arms = np.ascontiguousarray((places - self.place) @ self.axes)
        self._ahead = np.ascontiguousarray(self.axes[0])  # the platform's x axis
        self._yaw_stiffness = network.mooring.yaw_stiffness

    def points(self, motion: Motion, start: Array) -> Array:
        """All points (n,3) m: fairleads where the frame is, the others as at ``start``."""
        points = start.copy()
        place(points, self.network.vessel, self._arms, motion.position[0], motion.rotation[0])
        return points

    def velocity(self, motion: Motion) -> Array:
        """Velocities (k,3) m/s of the fairleads."""
        arms = self._arms @ motion.rotation[0].T
        return np.asarray(motion.velocity[0] + np.cross(motion.angular_velocity[0], arms))

    def loads(self, motion: Motion, found: Found) -> Loads:
        """Force, moment and stiffness about the frame's origin, with the yaw spring's."""
        force, moment, stiffness = np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 6, 6))
        on_body(
            found.points, self.network.vessel, found.force, found.stiffness, motion.position[0],
            force[0], moment[0], stiffness[0],
        )  # fmt: skip
        turn_back(self._yaw_stiffness, self._ahead, motion.rotation[0], moment[0], stiffness[0])
        return Loads(force, moment, stiffness)


def standing(fairleads: Fairleads) -> Motion:
    """The frame that carries the fairleads, at rest where it was described."""
    motion = Motion.at_rest(1)
    motion.position[0], motion.rotation[0] = fairleads.place, fairleads.axes
    return motion


class Moored:
    """What all lines share: a network in ``depth`` m of water of ``density`` kg/m3, at rest.

    ``carrier`` is what the fairleads ride on. Loads and the moment's channels are about the
    frame's origin. Raises InputError for a mooring that cannot be, with the figures.
    """

    channels: tuple[Channel, ...] = CHANNELS
    largest_step: float = inf

    def __init__(
        self,
        mooring: Mooring,
        carrier: Carrier,
        depth: float,
        density: float = SEA_WATER,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        self.network = Network.of(mooring, depth, density, gravity)
        self.fairleads = Fairleads(self.network, carrier)
        self.stations: tuple[Stations, ...] = self.fairleads.stations
        self.coordinates = coordinates(self.network)
        self.warnings = self.network.warnings
        #: where the search for the connections' rest starts
        self._start = self.network.at(self.network.points).points

    def _found(self, motion: Motion) -> Found:
        """The lines at rest where the frame is."""
        return self.network.at(self.fairleads.points(motion, self._start))


class MooringLines(Moored):
    """Elastic catenaries that are at rest wherever the platform is (Jonkman, 2007), and a spring.

    The lines have no inertia, drag or damping. See ``Moored``.
    """

    def __init__(
        self,
        mooring: Mooring,
        carrier: Carrier,
        depth: float,
        density: float = SEA_WATER,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        super().__init__(mooring, carrier, depth, density, gravity)
        self._moved, self._total = self._found(standing(self.fairleads)), np.zeros(6)
        self._shown = self._moved, self._total

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Nothing to prepare."""

    def loads(self, time: float, motion: Motion) -> Loads:
        """Force, moment and stiffness of all lines about the frame's origin."""
        self._moved = self._found(motion)
        loads = self.fairleads.loads(motion, self._moved)
        self._total = np.concatenate([loads.force[0], loads.moment[0]])
        return loads

    def end_step(self, time: float, motion: Motion) -> None:
        """Keep the lines of the last ``loads``; the connections' next search starts there."""
        self._shown = self._moved, self._total
        self._start = self._moved.points

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        found, total = self._shown
        anchor, fairlead = tensions(found.lines)
        return channel_values(fairlead, anchor, found.lines[:, RESTING].copy(), total)

    def state(self) -> dict[str, np.ndarray]:
        """Where the search for the connections' rest starts; the lines themselves need none."""
        return {"connections": self._start[self.network.free]}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take back what ``state`` gave."""
        self._start = self._start.copy()
        self._start[self.network.free] = state["connections"]

    def hanging_weight(self, motion: Motion) -> float:
        """Weight N of the lines in water that hangs on the platform where it is."""
        found = self._found(motion)
        return float(-found.force[self.network.vessel, 2].sum())

    def describe(self, motion: Motion) -> Iterator[str]:
        """Tensions of the lines, and what hangs on the platform, where it rests."""
        found = self._found(motion)
        both = zip(self.network.names, *tensions(found.lines), found.lines[:, RESTING], strict=True)
        for name, anchor, fairlead, rests in both:
            yield (
                f"{name}: {fairlead / 1e3:.4g} kN at the platform, {anchor / 1e3:.4g} kN at the "
                f"other end, {rests:.4g} m on the seabed"
            )
        yield f"{self.hanging_weight(motion) / 1e3:.5g} kN of lines hang on the platform"


def coordinates(network: Network) -> Mapping[str, Array]:
    """The lines' numbers, from 1."""
    return {"mooring_line": np.arange(1.0, len(network.ends) + 1.0)}


def channel_values(
    fairlead: Array, anchor: Array, resting: Array, total: Array
) -> Mapping[str, float | Array]:
    """Values by channel: tensions N and lengths m (m,), force and moment (6,)."""
    columns = (fairlead, anchor, resting, *total.tolist())
    return dict(zip((channel.name for channel in CHANNELS), columns, strict=True))
