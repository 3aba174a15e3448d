"""Anchors, fairleads, and the free connections that lines hold between them, at rest.

The energy of lines, weights and buoys is a convex function of where the connections are (but
for friction), so Newton's method with steps that do not run up the other side finds their rest.
Lines may lie on the seabed in their middle, without friction there; friction acts where a line
rests as far as an anchor on the seabed. Lines pass through each other and through the surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.contract import Array
from galerna.errors import ConvergenceError
from galerna.turbine.platform import LineType, Mooring, MooringNode
from galerna.units import SEA_WATER, STANDARD_GRAVITY

from .checks import ON_THE_SEABED, check_mooring, check_spans
from .lines import BED, Integers, add_own, assemble

STEPS, HALVES, BALANCED = 200, 40, 1e-11  #: the last is a share of the largest force
LONGEST_STEP = 0.2  #: of the longest line
SINKS = 0.01  #: m, how deep a connection sinks into the seabed under all that it may carry
TRACE = 1e-12  #: of the seabed's stiffness
_RANK = {"fixed": 0, "connection": 1, "vessel": 2}


@dataclass(frozen=True, eq=False)
class Found:
    """A network at rest: ``points`` (n,3) m, ``force`` (n,3) N of lines, and of each line what
    ``catenary.solve`` fills, (m,5). ``stiffness`` (3n,3n) N/m is with the connections following."""

    points: Array
    lines: Array
    force: Array
    stiffness: Array


@dataclass(frozen=True, eq=False)
class Network:
    """n points and m lines. ``points`` (n,3) m as described; ``ends`` (m,2) of each line, the
    anchor's side first; ``figures`` (m,4) of lines and ``own`` (n,4) of points as in ``lines``.
    ``vessel`` (k,) and ``free`` (c,) number fairleads and connections."""

    mooring: Mooring
    depth: float
    points: Array
    ends: Integers
    figures: Array
    own: Array
    vessel: Integers
    free: Integers

    @classmethod
    def of(
        cls,
        mooring: Mooring,
        depth: float,
        density: float = SEA_WATER,
        gravity: float = STANDARD_GRAVITY,
    ) -> Network:
        """The network in water of a depth m, its connections at rest. Raises InputError."""
        check_mooring(mooring, depth)
        kinds = [node.kind for node in mooring.nodes]
        number = {node.name: i for i, node in enumerate(mooring.nodes)}
        ends = np.array(
            [
                sorted((number[line.first], number[line.second]), key=lambda i: _RANK[kinds[i]])
                for line in mooring.lines
            ],
            dtype=np.int64,
        ).reshape(-1, 2)
        points = np.array([node.position for node in mooring.nodes], dtype=float).reshape(-1, 3)
        anchored = np.array([_rests(mooring.nodes[first], depth) for first, _ in ends], dtype=bool)
        for first, _ in ends[anchored]:
            points[first, 2] = -depth
        figures = [
            (line.length, weight_in_water(line.line_type, density, gravity),
             line.line_type.stiffness, mooring.seabed_friction * rests)
            for line, rests in zip(mooring.lines, anchored, strict=True)
        ]  # fmt: skip
        lines = np.array(figures).reshape(-1, 4)
        carried = np.abs(lines[:, 0] * lines[:, 1]).sum()
        own = np.array([_own(node, carried, density, gravity) for node in mooring.nodes])
        vessel, free = (np.flatnonzero([k == kind for k in kinds]).astype(np.int64)
                        for kind in ("vessel", "connection"))  # fmt: skip
        network = cls(mooring, depth, points, ends, lines, own.reshape(-1, 4), vessel, free)
        check_spans(mooring, network.at(points).points, ends)
        return network

    @property
    def names(self) -> tuple[str, ...]:
        """The lines' names."""
        return tuple(line.name for line in self.mooring.lines)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Anchors that do not stand on the seabed: perhaps the water's depth is another."""
        above = self.points[[n.kind == "fixed" for n in self.mooring.nodes], 2] + self.depth
        high = above > ON_THE_SEABED
        if not high.any():
            return ()
        return (
            f"mooring: {high.sum()} of {len(high)} anchors stand up to {above.max():.4g} m above "
            f"the seabed at {self.depth:.6g} m",
        )

    def at(self, points: Array) -> Found:
        """The network with anchors and fairleads at ``points`` (n,3) m; connections start there.

        Raises ConvergenceError where these find no rest.
        """
        points, n = points.copy(), len(points)
        found, force, K = np.zeros((len(self.ends), 5)), np.zeros((n, 3)), np.zeros((3 * n, 3 * n))
        assemble(points, self.ends, self.figures, self.depth, found, force, K)
        if len(self.free):
            self._settle(points, found, force, K)
            K = self._condensed(K)
        return Found(points, found, force, K)

    def _settle(self, points: Array, found: Array, force: Array, K: Array) -> None:
        """Move the connections to where they rest, and fill the others for that."""
        free, reach = self.free, LONGEST_STEP * self.figures[:, 0].max()
        residual, stiffness = self._on_connections(points, force, K)
        for _ in range(STEPS):
            size = float(np.abs(residual).max())
            if size <= BALANCED * max(np.abs(found).max(), 1.0):
                return
            step = np.linalg.solve(stiffness, residual)
            step *= min(1.0, reach / np.abs(step).max())
            start, work = points[free], float(residual @ step)
            for half in range(HALVES):
                points[free] = start + 0.5**half * step.reshape(-1, 3)
                assemble(points, self.ends, self.figures, self.depth, found, force, K)
                residual, stiffness = self._on_connections(points, force, K)
                if float(residual @ step) >= -0.5 * work:
                    break
        if size > 1e-7 * max(np.abs(found).max(), 1.0):
            raise ConvergenceError(
                "mooring",
                f"the free connections find no rest: {size:.3g} N are left over",
                "look for a buoy or weight that nothing holds, and for lines too short to reach",
            )

    def _on_connections(self, points: Array, force: Array, K: Array) -> tuple[Array, Array]:
        """Force (3c,) and stiffness (3c,3c) of the connections, with what is their own in ``K``."""
        own = force[self.free].copy()
        for i, node in enumerate(self.free):
            up, stiff = add_own(points[node, 2], self.own[node], self.depth)
            own[i, 2] += up
            K[3 * node + 2, 3 * node + 2] += stiff
        return own.ravel(), self._between_connections(K)

    def _between_connections(self, K: Array) -> Array:
        """Their stiffness (3c,3c), with a trace where neither lines nor water hold them."""
        at = self._rows(self.free)
        trace = TRACE * self.own[self.free[0], BED]
        return np.asarray(K[np.ix_(at, at)] + trace * np.eye(len(at)))

    def _condensed(self, K: Array) -> Array:
        """The stiffness of the other points where the connections follow them; eq. (14)."""
        at = self._rows(self.free)
        return np.asarray(K - K[:, at] @ np.linalg.solve(self._between_connections(K), K[at]))

    @staticmethod
    def _rows(nodes: Integers) -> Integers:
        return (3 * nodes[:, None] + np.arange(3)).ravel()


def weight_in_water(kind: LineType, density: float, gravity: float) -> float:
    """Weight N/m of a line; its own where density and gravity are the usual ones."""
    area = 0.25 * np.pi * kind.diameter**2
    other = kind.mass * (gravity - STANDARD_GRAVITY)
    return float(kind.weight + other - area * (density * gravity - SEA_WATER * STANDARD_GRAVITY))


def _rests(node: MooringNode, depth: float) -> bool:
    return bool(node.kind == "fixed" and node.position[2] <= -depth + ON_THE_SEABED)


def _own(node: MooringNode, carried: float, density: float, gravity: float) -> Array:
    """Weight, buoyancy, radius and seabed of a connection."""
    weight, buoyancy = node.mass * gravity, node.volume * density * gravity
    radius = np.cbrt(0.75 * node.volume / np.pi)
    return np.array([weight, buoyancy, radius, (carried + weight) / SINKS])
