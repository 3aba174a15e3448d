"""Anchors, lines, fairleads and the free connections between them, at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError, did_you_mean
from galerna.turbine.platform import Mooring, MooringLine, MooringNode

from .kernels import pull_all

Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

LARGEST_STRAIN = 0.05  #: of a line where the platform was described
ON_THE_SEABED = 1e-3  #: of the water depth, within which an end lies on it
NEWTON_STEPS, BALANCED = 200, 1e-9  #: of the connections; of the largest force


@dataclass(frozen=True, eq=False)
class Network:
    """n points and m lines: ``points`` (n,3) m as described, ``ends`` (m,2), ``lines`` (m,3).

    ``lines`` hold length m, EA N and weight N/m, ``friction`` (m,) that of the seabed or -1 for
    lines that hang free. ``vessel`` and ``free`` (n,) mark fairleads and connections, ``load``
    (n,3) N is their own weight less their buoyancy.
    """

    names: tuple[str, ...]
    points: Array
    ends: Integers
    lines: Array
    friction: Array
    vessel: Flags
    free: Flags
    load: Array

    @classmethod
    def of(cls, mooring: Mooring, depth: float, density: float, gravity: float) -> Network:
        """The network of a mooring in water; InputError for lines that cannot be."""
        names = [node.name for node in mooring.nodes]
        _check(mooring, depth)
        points = np.array([node.position for node in mooring.nodes], dtype=float)
        ends = np.array([[names.index(e) for e in (line.first, line.second)]
                         for line in mooring.lines], dtype=np.int64)  # fmt: skip
        kinds = np.array([node.kind for node in mooring.nodes])
        rests = np.array([_rests(node, depth) for node in mooring.nodes])
        load = np.zeros_like(points)
        load[:, 2] = [
            gravity * (density * node.volume - node.mass) if node.kind == "connection" else 0.0
            for node in mooring.nodes
        ]
        lines = np.array(
            [[line.length, line.line_type.stiffness, line.line_type.weight]
             for line in mooring.lines]
        )  # fmt: skip
        friction = np.where(rests[ends].any(axis=1), mooring.seabed_friction, -1.0)
        network = cls(
            tuple(line.name for line in mooring.lines), points, ends, lines, friction,
            kinds == "vessel", kinds == "connection", load,
        )  # fmt: skip
        return network

    def solve(self, points: Array) -> Array:
        """Forces, stiffness, tensions (m,6,3) of all lines (``kernels.pull``).

        ``points`` (n,3) m; those of the connections are moved to where they rest.
        """
        answer = np.zeros((len(self.ends), 6, 3))
        pull_all(points, self.ends, self.lines, self.friction, answer)
        if self.free.any():
            self._settle(points, answer)
        return answer

    def _settle(self, points: Array, answer: Array) -> None:
        """Newton's method for the connections, each step halved until the forces fall."""
        free = np.flatnonzero(self.free)
        residual, stiffness = self.assembled(answer, free)
        for _ in range(NEWTON_STEPS):
            size = np.abs(residual).max()
            if size <= BALANCED * max(np.abs(answer[:, :2]).max(), 1.0):
                return
            step = np.linalg.lstsq(stiffness, residual, rcond=1e-12)[0].reshape(-1, 3)
            start = points[free].copy()
            for share in 0.5 ** np.arange(12):
                points[free] = start + share * step
                pull_all(points, self.ends, self.lines, self.friction, answer)
                residual, stiffness = self.assembled(answer, free)
                if np.abs(residual).max() < size:
                    break
        raise ConvergenceError(
            "mooring", f"the connections find no rest: {size:.3g} N are left over",
            "start them nearer to where they hang, in the turbine's file",
        )  # fmt: skip

    def assembled(self, answer: Array, nodes: Integers) -> tuple[Array, Array]:
        """Forces (3k,) on k points and their stiffness (3k,3k), the others held."""
        place = {int(node): 3 * i for i, node in enumerate(nodes)}
        force, K = self.load[nodes].ravel().copy(), np.zeros((3 * len(nodes), 3 * len(nodes)))
        for i, (a, b) in enumerate(self.ends.tolist()):
            block = answer[i, 2:5]
            for side, node in enumerate((a, b)):
                if node in place:
                    at = slice(place[node], place[node] + 3)
                    force[at] += answer[i, side]
                    K[at, at] += block
            if a in place and b in place:
                first, second = place[a], place[b]
                K[first : first + 3, second : second + 3] -= block
                K[second : second + 3, first : first + 3] -= block
        return force, K

    def condensed(self, answer: Array) -> tuple[Array, Integers]:
        """Stiffness (3k,3k) of the vessel's k points with the connections free, and their order."""
        own, free = np.flatnonzero(self.vessel), np.flatnonzero(self.free)
        _, K = self.assembled(answer, np.concatenate([own, free]))
        n = 3 * len(own)
        if len(free):
            inner = np.linalg.lstsq(K[n:, n:], K[n:, :n], rcond=1e-12)[0]
            K = K[:n, :n] - K[:n, n:] @ inner
        return np.asarray(K[:n, :n]), own


def _rests(node: MooringNode, depth: float) -> bool:
    return bool(abs(node.position[2] + depth) <= ON_THE_SEABED * depth)


def _check(mooring: Mooring, depth: float) -> None:
    names = [node.name for node in mooring.nodes]
    if not depth > 0.0:
        raise InputError("mooring", "the water depth is not known", "give sea.water_depth_m")
    for node in mooring.nodes:
        if node.position[2] < -depth * (1.0 + ON_THE_SEABED):
            raise InputError(
                f"mooring, node {node.name!r}",
                f"it stands {-node.position[2]:g} m below still water, the seabed {depth:g} m",
                "check its height and the water depth",
            )
    for line in mooring.lines:
        for end in (line.first, line.second):
            if end not in names:
                raise InputError(
                    f"mooring, line {line.name!r}", f"there is no node {end!r}",
                    did_you_mean(end, names),
                )  # fmt: skip
        _check_line(line, mooring)


def _check_line(line: MooringLine, mooring: Mooring) -> None:
    where = f"mooring, line {line.name!r}"
    if not (line.length > 0.0 and line.line_type.stiffness > 0.0):
        raise InputError(
            where,
            f"its length {line.length:g} m and EA {line.line_type.stiffness:g} N must be positive",
        )
    first, second = (mooring.node(name) for name in (line.first, line.second))
    if "connection" in (first.kind, second.kind):
        return
    span = float(np.linalg.norm(np.subtract(second.position, first.position)))
    strain = span / line.length - 1.0
    if strain > LARGEST_STRAIN:
        raise InputError(
            where,
            f"it is {line.length:g} m long and must span {span:.4g} m: it would stretch by "
            f"{strain:.1%}",
            f"a line of about {span:.4g} m would reach",
        )
