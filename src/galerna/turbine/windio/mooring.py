"""The mooring of a windIO file: nodes, lines, and what a line weighs and stretches."""

from __future__ import annotations

from typing import Literal

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine.model import Array
from galerna.turbine.platform import LineType, Mooring, MooringLine, MooringNode
from galerna.turbine.windio.block import Block
from galerna.turbine.windio.companion import Companion
from galerna.turbine.windio.joints import Joints
from galerna.units import SEA_WATER, STANDARD_GRAVITY

_KINDS: dict[str, Literal["fixed", "vessel", "connection"]] = {
    "fixed": "fixed",
    "fix": "fixed",
    "vessel": "vessel",
    "connection": "connection",
    "connect": "connection",
    "free": "connection",
}

#: Of chains by their nominal diameter d: volume-equivalent diameter over d, mass over d^2
#: kg/m3, stiffness over d^2 N/m2 (DNV-OS-E301, ch. 2 sec. 2; masses as of makers' tables).
_CHAINS = {"chain": (1.8, 19.9e3, 0.854e11), "chain_stud": (1.89, 21.9e3, 1.01e11)}


def read_mooring(
    components: Block, joints: Joints, companion: Companion, notes: list[str]
) -> Mooring | None:
    """Nodes, lines and their types; None where the file has no mooring."""
    if not components.has("mooring"):
        companion.refuse_mooring()
        return None
    block = components.block("mooring")
    types = _line_types(block, companion, notes)
    nodes = tuple(_node(b, joints) for b in block.blocks("nodes"))
    names = [node.name for node in nodes]
    lines = tuple(_line(b, names, types) for b in block.blocks("lines"))
    return Mooring(nodes, lines, **companion.properties["mooring"])


def _node(block: Block, joints: Joints) -> MooringNode:
    kind = block.text("node_type")
    if kind not in _KINDS:
        raise block.error(f"unknown kind {kind!r}", did_you_mean(kind, _KINDS), "node_type")
    return MooringNode(
        name=block.text("name"),
        kind=_KINDS[kind],
        position=_position(block, joints),
        mass=block.number("node_mass", 0.0, 0.0),
        volume=block.number("node_volume", 0.0, 0.0),
    )


def _position(block: Block, joints: Joints) -> Array:
    if block.text("joint", "none") != "none":
        return joints.of(block, "joint")
    return np.array(block.array("location", 3))


def _line(block: Block, nodes: list[str], types: dict[str, LineType]) -> MooringLine:
    first, second = (_known(block, key, nodes) for key in ("node1", "node2"))
    if first == second:
        raise block.error("begins and ends at the same node", "", "node2")
    return MooringLine(
        name=block.text("name"),
        first=first,
        second=second,
        line_type=types[_known(block, "line_type", list(types))],
        length=block.number("unstretched_length", low=1e-6),
    )


def _known(block: Block, key: str, names: list[str]) -> str:
    name = block.text(key)
    if name not in names:
        raise block.error(f"{name!r} is not there", did_you_mean(name, names), key)
    return name


def _line_types(block: Block, companion: Companion, notes: list[str]) -> dict[str, LineType]:
    blocks = {b.text("name"): b for b in block.blocks("line_types")}
    for name, stated in companion.line_types.items():
        if name not in blocks:
            raise stated.error(f"unknown line type {name!r}", did_you_mean(name, blocks))
    return {
        name: _line_type(b, companion.line_types.get(name), notes) for name, b in blocks.items()
    }


def _line_type(block: Block, stated: Block | None, notes: list[str]) -> LineType:
    """A line's properties: the companion's, the file's, or those of a chain of its size."""
    diameter = block.number("diameter", low=1e-6)
    found = {"diameter": diameter}
    if block.has("mass_density"):
        found["mass"] = block.number("mass_density", low=1e-6)
    if block.has("stiffness"):
        found["stiffness"] = block.number("stiffness", low=1e-6)
    if stated is not None:
        keys = ("diameter", "mass", "weight", "stiffness")
        found |= {key: stated.number(key) for key in keys if stated.has(key)}
    if not {"mass", "stiffness"} <= found.keys():
        found = _chain(block, diameter, notes) | found
    displaced = SEA_WATER * np.pi / 4.0 * found["diameter"] ** 2
    found.setdefault("weight", (found["mass"] - displaced) * STANDARD_GRAVITY)
    return LineType(name=block.text("name"), **found, **_coefficients(block))


def _chain(block: Block, diameter: float, notes: list[str]) -> dict[str, float]:
    """Mass and stiffness of a chain by its volume-equivalent diameter, as windIO states it."""
    kind = block.text("type").lower()
    if kind not in _CHAINS:
        what = f"a line of {kind} without mass_density and stiffness"
        hint = "give both here, or mass and stiffness under mooring.line_types of the companion"
        raise block.error(what, hint)
    ratio, mass, stiffness = _CHAINS[kind]
    nominal = diameter / ratio
    found = {"mass": mass * nominal**2, "stiffness": stiffness * nominal**2}
    notes.append(
        f"mooring: line type {block.text('name')} counts as {kind} of {1e3 * nominal:.4g} mm "
        f"(diameter of {diameter:g} m over {ratio:g}): {found['mass']:.4g} kg/m, "
        f"EA {found['stiffness']:.4g} N (DNV-OS-E301)"
    )
    return found


def _coefficients(block: Block) -> dict[str, float]:
    keys = ("transverse_drag", "tangential_drag", "transverse_added_mass", "tangential_added_mass")
    return {key: block.number(key, low=0.0) for key in keys if block.has(key)}
