"""A floating platform and its mooring as blocks of a windIO file and its companion."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from galerna.errors import InputError
from galerna.turbine.model import Array
from galerna.turbine.platform import LineType, Member, Mooring, MooringNode, Platform

_TOWER_FOOT = "tower_foot"
_COEFFICIENTS = (
    "transverse_drag",
    "tangential_drag",
    "transverse_added_mass",
    "tangential_added_mass",
)


def components(platform: Platform, tower_base: Array) -> dict[str, Any]:
    """``floating_platform`` and ``mooring``, as far as there are members and lines.

    windIO wants a kind of anchor; as none is known, it is a drag anchor.
    Raises InputError for a mooring without members: windIO has no place for it.
    """
    if not platform.members:
        if platform.mooring is not None:
            what = "has a mooring and no members, which windIO cannot hold"
            raise InputError("platform", what, "describe the hull by members")
        return {}
    joints = [_joint(_TOWER_FOOT, tower_base) | {"transition": True}]
    for member in platform.members:
        joints += _ends(member)
    found: dict[str, Any] = {}
    if platform.mooring is not None:
        joints += [_joint(f"{node.name}_joint", node.position) for node in platform.mooring.nodes]
        found["mooring"] = _mooring(platform.mooring)
    members = [_member(member) for member in platform.members]
    return {"floating_platform": {"joints": joints, "members": members}} | found


def companion(platform: Platform, folder: Path) -> dict[str, Any]:
    """Blocks ``platform`` (beside its plain figures) and ``mooring`` of the companion."""
    found: dict[str, Any] = {"platform": {}}
    if platform.additional_damping.any():
        diagonal = np.diag(platform.additional_damping)
        if not np.array_equal(np.diag(diagonal), platform.additional_damping):
            what = "couples directions; a companion holds six figures, one per direction"
            raise InputError("platform.additional_damping", what)
        found["platform"]["additional_damping"] = diagonal.tolist()
    if platform.hydrodynamics is not None:
        found["platform"]["hydrodynamics"] = _relative(platform.hydrodynamics, folder)
    if platform.mooring is not None:
        found["mooring"] = _mooring_properties(platform.mooring)
    return found


def _relative(path: Path, folder: Path) -> str:
    return str(path.relative_to(folder) if path.is_relative_to(folder) else path)


def _joint(name: str, position: Array) -> dict[str, Any]:
    return {"name": name, "location": position.tolist()}


def _ends(member: Member) -> list[dict[str, Any]]:
    drag = {"axial_coeffs": {"Cd": member.axial_drag_coefficient}}
    ends = (("start", member.start), ("end", member.end))
    return [_joint(f"{member.name}_{end}", position) | drag for end, position in ends]


def _member(member: Member) -> dict[str, Any]:
    """A member without its structure, whose mass the companion states."""
    return {
        "name": member.name,
        "joint1": f"{member.name}_start",
        "joint2": f"{member.name}_end",
        "outer_shape": _outer_shape(member),
        "Cd": member.drag_coefficient[:, 0].tolist(),
        "Cdy": member.drag_coefficient[:, 1].tolist(),
        "structure": {"layers": []},
    }


def _outer_shape(member: Member) -> dict[str, Any]:
    curves = [{"grid": member.span.tolist(), "values": side.tolist()} for side in member.sides.T]
    if member.round:
        return {"shape": "circular", "outer_diameter": curves[0]}
    sides = {"side_length_a": curves[0], "side_length_b": curves[1]}
    return {"shape": "rectangular"} | sides


def _mooring(mooring: Mooring) -> dict[str, Any]:
    lines = [
        {
            "name": line.name,
            "line_type": line.line_type.name,
            "unstretched_length": line.length,
            "node1": line.first,
            "node2": line.second,
        }
        for line in mooring.lines
    ]
    anchor = {"name": "anchor", "type": "drag_embedment"}
    return {
        "nodes": [_node(node) for node in mooring.nodes],
        "lines": lines,
        "line_types": [_line_type(line_type) for line_type in _types(mooring)],
        "anchor_types": [anchor],
    }


def _node(node: MooringNode) -> dict[str, Any]:
    found: dict[str, Any] = {"name": node.name, "node_type": node.kind}
    match node.kind:
        case "fixed":
            found |= {"joint": f"{node.name}_joint", "anchor_type": "anchor"}
        case "vessel":
            found |= {"joint": f"{node.name}_joint", "fairlead_type": "rigid"}
        case "connection":
            found["location"] = node.position.tolist()
    return found | {"node_mass": node.mass, "node_volume": node.volume}


def _types(mooring: Mooring) -> list[LineType]:
    """Every line type once. Raises InputError where two of one name differ."""
    found: dict[str, LineType] = {}
    for line in mooring.lines:
        known = found.setdefault(line.line_type.name, line.line_type)
        if known != line.line_type:
            raise InputError("mooring", f"two different line types are named {known.name!r}")
    return list(found.values())


def _line_type(line_type: LineType) -> dict[str, Any]:
    coefficients = {key: getattr(line_type, key) for key in _COEFFICIENTS}
    return {
        "name": line_type.name,
        "diameter": line_type.diameter,
        "type": "chain",
    } | coefficients


def _mooring_properties(mooring: Mooring) -> dict[str, Any]:
    keys = ("mass", "weight", "stiffness")
    return {
        "yaw_stiffness": mooring.yaw_stiffness,
        "seabed_friction": mooring.seabed_friction,
        "line_types": {t.name: {key: getattr(t, key) for key in keys} for t in _types(mooring)},
    }
