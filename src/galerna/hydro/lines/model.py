"""Mooring lines at rest as a load on the platform."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import atan2, inf

import numpy as np

from galerna.contract import Array, Channel, Loads, Motion, Stations
from galerna.hydro.strips import Carrier
from galerna.turbine.platform import Mooring

from .kernels import on_body
from .network import Network

ALONG_LINES = ("mooring_line",)
CHANNELS = (
    Channel("fairlead_tension", "N", "tension of the line's end at the platform", ALONG_LINES,
            "FairTen{mooring_line}", "N"),
    Channel("anchor_tension", "N", "tension of the line's other end", ALONG_LINES,
            "AnchTen{mooring_line}", "N"),
    Channel("grounded_length", "m", "length of the line on the seabed", ALONG_LINES),
    *(
        Channel(f"mooring_{kind}_{axis}", unit, f"{text} {axis} of all lines on the platform")
        for kind, unit, text in (("force", "N", "force along"), ("moment", "N m", "moment about"))
        for axis in "xyz"
    ),
)  # fmt: skip


class QuasiStaticLines:
    """Elastic catenaries in balance with the fairleads' places, and a torsion spring about z.

    ``depth`` m of water of ``density`` kg/m3. The lines act on the frame of ``carrier`` that is
    nearest to their fairleads' mean height. Neither inertia nor drag: Jonkman (2007).
    """

    channels: tuple[Channel, ...] = CHANNELS
    largest_step: float = inf

    def __init__(
        self,
        mooring: Mooring,
        carrier: Carrier,
        depth: float,
        density: float = 1025.0,
        gravity: float = 9.80665,
    ) -> None:
        self.network = Network.of(mooring, depth, density, gravity)
        network = self.network
        self._yaw_stiffness = mooring.yaw_stiffness
        height = network.points[network.vessel, 2].mean() if network.vessel.any() else 0.0
        frame = int(np.abs(carrier.position[:, 2] - height).argmin())
        part, span = carrier.stations.part, carrier.stations.span
        self.stations: tuple[Stations, ...] = (Stations(part, span[frame : frame + 1]),)
        self._turned = carrier.rotation[frame]  # the frame's axes in the platform as described
        self._arms = (network.points - carrier.position[frame]) @ self._turned
        self._arms[~network.vessel] = 0.0
        self._points = network.points.copy()
        self._fairlead = np.where(network.vessel[network.ends[:, 1]], 1, 0)
        numbers = np.arange(1.0, len(network.names) + 1.0)
        self.coordinates: Mapping[str, Array] = {"mooring_line": numbers}
        self._trial = self._shown = np.zeros((len(numbers), 6, 3)), np.zeros(6)

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        """Nothing to prepare."""

    def loads(self, time: float, motion: Motion) -> Loads:
        """Force, moment and stiffness of all lines about the frame's origin."""
        network, R = self.network, motion.rotation[0]
        arms = self._arms @ R.T
        vessel = network.vessel
        points = self._points.copy() if network.free.any() else self._points
        points[vessel] = motion.position[0] + arms[vessel]
        answer = network.solve(points)
        force, moment, K = np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 6, 6))
        on_body(arms, vessel, network.ends, answer, force[0], moment[0], K[0])
        if network.free.any():
            self._condense(K[0], arms, answer)
        if self._yaw_stiffness:
            ahead = R @ self._turned[0]  # the x axis of the platform as described
            moment[0, 2] -= self._yaw_stiffness * atan2(ahead[1], ahead[0])
            K[0, 5, 5] += self._yaw_stiffness
        self._trial = answer, np.concatenate([force[0], moment[0]])
        return Loads(force, moment, K)

    def _condense(self, K: Array, arms: Array, answer: Array) -> None:
        """Let the connections follow: take what they give from the stiffness (6,6)."""
        stiff, own = self.network.condensed(answer)
        held = self.network.assembled(answer, own)[1]
        carry = np.zeros((3 * len(own), 6))
        for i, node in enumerate(own):
            x, y, z = arms[node]
            carry[3 * i : 3 * i + 3, :3] = np.eye(3)
            carry[3 * i : 3 * i + 3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        K -= carry.T @ (held - stiff) @ carry

    def end_step(self, time: float, motion: Motion) -> None:
        """Keep the tensions of the last ``loads`` for the record."""
        self._shown = self._trial

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted step."""
        answer, total = self._shown
        lines, tension = np.arange(len(answer)), answer[:, 5, :2]
        columns = (
            tension[lines, self._fairlead],
            tension[lines, 1 - self._fairlead],
            answer[:, 5, 2].copy(),
            *total.tolist(),
        )
        return dict(zip((channel.name for channel in CHANNELS), columns, strict=True))

    def state(self) -> dict[str, np.ndarray]:
        """Empty: the next step depends on nothing of the last."""
        return {}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Nothing to take back."""

    def describe(self, motion: Motion) -> Iterator[str]:
        """Tension and length on the seabed of each line while the platform rests."""
        self.loads(0.0, motion)
        answer, _ = self._trial
        tension = answer[np.arange(len(answer)), 5, self._fairlead]
        for name, pull, length in zip(self.network.names, tension, answer[:, 5, 2], strict=True):
            yield f"{name}: {pull / 1e3:.4g} kN at the platform, {length:.4g} m on the seabed"
