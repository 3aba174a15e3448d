"""What cannot be moored: said with the figures, before time is spent."""

from __future__ import annotations

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.errors import InputError, did_you_mean
from galerna.turbine.platform import Mooring, MooringLine, MooringNode

LARGEST_STRAIN = 0.05  #: of a line where the platform was described
ON_THE_SEABED = 1e-3  #: m, within which an anchor lies on the seabed


def check_mooring(mooring: Mooring, depth: float) -> None:
    """Names, figures and places. Raises InputError; anchors may stand above the seabed."""
    if not (isfinite(depth) and depth > 0.0):
        what = f"lines need the depth of the water, not {depth:g} m"
        raise InputError("mooring", what, "give sea.water_depth_m")
    if not mooring.seabed_friction >= 0.0:
        what = f"the seabed's friction is {mooring.seabed_friction:g}, and must not be negative"
        raise InputError("mooring", what)
    names = [node.name for node in mooring.nodes]
    for node in mooring.nodes:
        if names.count(node.name) > 1:
            raise InputError(_node(node), "there are two nodes of this name", "rename one")
        _check_node(node, depth, mooring)
    for line in mooring.lines:
        _check_line(line, names)


def _node(node: MooringNode) -> str:
    return f"mooring, node {node.name!r}"


def _line(line: MooringLine) -> str:
    return f"mooring, line {line.name!r}"


def _check_node(node: MooringNode, depth: float, mooring: Mooring) -> None:
    if node.kind not in ("fixed", "vessel", "connection"):
        kinds = ("fixed", "vessel", "connection")
        raise InputError(_node(node), f"unknown kind {node.kind!r}", did_you_mean(node.kind, kinds))
    if not np.isfinite(node.position).all():
        raise InputError(_node(node), f"its position is {node.position}", "give three numbers in m")
    what = {"fixed": "anchor", "vessel": "fairlead", "connection": "connection"}[node.kind]
    if node.position[2] < -depth - ON_THE_SEABED:
        raise InputError(
            _node(node),
            f"the {what} is at z = {node.position[2]:.6g} m, the seabed at {-depth:.6g} m",
            "check its height and the water depth",
        )
    if min(node.mass, node.volume) < 0.0:
        given = f"mass {node.mass:g} kg, volume {node.volume:g} m3"
        raise InputError(_node(node), f"{given}: neither can be negative")
    if node.kind == "connection" and not any(
        node.name in (line.first, line.second) for line in mooring.lines
    ):
        raise InputError(_node(node), "no line holds this connection", "give it lines, or drop it")


def _check_line(line: MooringLine, names: list[str]) -> None:
    for end in (line.first, line.second):
        if end not in names:
            raise InputError(_line(line), f"there is no node {end!r}", did_you_mean(end, names))
    if line.first == line.second:
        raise InputError(_line(line), f"begins and ends at {line.first!r}")
    kind = line.line_type
    if not (line.length > 0.0 and kind.stiffness > 0.0 and kind.mass > 0.0):
        raise InputError(
            _line(line),
            f"length {line.length:g} m, EA {kind.stiffness:g} N and mass {kind.mass:g} kg/m must "
            "be positive",
        )
    if not (isfinite(kind.weight) and kind.weight != 0.0):
        what = f"its weight in water is {kind.weight:g} N/m: a line without weight has no shape"
        raise InputError(_line(line), what, "give it a small weight, or buoyancy (negative)")


def check_spans(mooring: Mooring, points: Array, ends: NDArray[np.int64]) -> None:
    """Lines that are too short for where ``points`` (n,3) m are, which ``ends`` (m,2) count."""
    spans = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    for line, span in zip(mooring.lines, spans, strict=True):
        strain = span / line.length - 1.0
        if strain > LARGEST_STRAIN:
            pull = strain * line.line_type.stiffness
            raise InputError(
                _line(line),
                f"{line.length:g} m long, it must span {span:.5g} m from {line.first!r} to "
                f"{line.second!r}: a strain of {strain:.1%}, a tension of {pull / 1e3:.4g} kN",
                f"check its length and the nodes' places; {LARGEST_STRAIN:.0%} is the most",
            )
