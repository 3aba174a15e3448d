"""The floating platform of a windIO file: members, mooring, mass."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine.model import Array
from galerna.turbine.platform import Member, Mooring, Platform
from galerna.turbine.windio.block import Block, merged_grid
from galerna.turbine.windio.companion import Companion
from galerna.turbine.windio.floating_mass import platform_mass
from galerna.turbine.windio.joints import Joints
from galerna.turbine.windio.mooring import read_mooring

_AT_THE_TOWER = 0.05  #: m between transition joint and tower base that is rounding


def read_platform(
    document: Block, companion: Companion, tower_base: Array, notes: list[str]
) -> Platform | None:
    """The platform of ``floating_platform`` and ``mooring``; what the companion states wins.

    Without mass in the companion it is that of walls, bulkheads, fixed ballast and rigid
    bodies. None where neither file has a platform.
    """
    components, stated = document.block("components"), companion.properties["platform"]
    if not components.has("floating_platform"):
        companion.refuse_parts_of_a_platform()
        if components.has("mooring"):
            notes.append("mooring: not read, as there is no floating_platform")
        return Platform(**stated) if stated else None
    block = components.block("floating_platform")
    joints = Joints(block)
    _compare_with_the_tower(block, joints, tower_base, notes)
    members = _overridden([_member(b, joints) for b in block.blocks("members")], companion)
    notes += _without_drag(members)
    mooring = read_mooring(components, joints, companion, notes)
    given: dict[str, Any] = {"reference_point": (0.0, 0.0, 0.0)} | _depths(members, mooring)
    if "mass" not in stated:
        given |= platform_mass(document, block, joints, members, notes)
    return Platform(**(given | stated), members=members, mooring=mooring)


def _compare_with_the_tower(
    block: Block, joints: Joints, tower_base: Array, notes: list[str]
) -> None:
    if joints.transition is None:
        raise block.error("no joint has 'transition: true'", "the tower stands on that one")
    foot = joints.position[joints.transition]
    if np.linalg.norm(foot - tower_base) > _AT_THE_TOWER:
        notes.append(
            f"platform: the transition joint {joints.transition} is at {_triple(foot)} m, the "
            f"tower's base at {_triple(tower_base)} m; a rigid piece joins them"
        )


def _member(block: Block, joints: Joints) -> Member:
    name, outer = block.text("name"), block.block("outer_shape")
    start, end = joints.of(block, "joint1"), joints.of(block, "joint2")
    if not np.linalg.norm(end - start) > 0.0:
        raise block.error("both joints stand at the same place", "", "joint2")
    span, sides = _sides(outer)
    ends = (block.text("joint1"), block.text("joint2"))
    return Member(
        name=name,
        start=start,
        end=end,
        span=span,
        sides=sides,
        round=outer.text("shape") == "circular",
        drag_coefficient=_drag(block, outer, span),
        axial_drag_coefficient=max(joints.axial_drag.get(end, 0.0) for end in ends),
    )


def _sides(outer: Block) -> tuple[Array, Array]:
    """Fractions (n,) and both sides (n,2) m of a cross section along a member."""
    match outer.text("shape"):
        case "circular":
            keys = ("outer_diameter", "outer_diameter")
        case "rectangular":
            keys = ("side_length_a", "side_length_b")
            keys = keys[::-1] if _quarter_turns(outer) % 2 else keys
        case shape:
            what = f"a {shape} cross section; galerna reads circular and rectangular ones"
            hint = "give the sides of a rectangle of the same area under 'members' of the companion"
            raise outer.error(what, hint, "shape")
    curves = [outer.curve(key, low=1e-6) for key in keys]
    span = merged_grid(*(grid for grid, _ in curves))
    return span, np.stack([np.interp(span, *curve) for curve in curves], axis=1)


def _quarter_turns(outer: Block) -> int:
    turns = outer.number("rotation", 0.0) / 90.0
    if abs(turns - round(turns)) > 1e-9:
        what = "a rectangle turned about its member by other than quarter turns"
        raise outer.error(what, "galerna has one side level", "rotation")
    return round(turns)


def _drag(block: Block, outer: Block, span: Array) -> Array:
    """Drag coefficients (n,2) along both sides; windIO's -1, for none given, is 0."""
    along_a = _coefficients(block, "Cd", outer, span)
    along_b = _coefficients(block, "Cdy", outer, span) if block.has("Cdy") else along_a
    drag = np.stack(np.broadcast_arrays(along_a, along_b), axis=1)
    return np.maximum(drag, 0.0)


def _coefficients(block: Block, key: str, outer: Block, span: Array) -> Array:
    """A coefficient (n,) on ``span``, or (1,) where it is one number."""
    if not isinstance(block.data.get(key), list):
        return np.array([block.number(key, -1.0)])
    values = block.array(key)
    if len(values) == 1:
        return values
    keys = ("outer_diameter", "side_length_a")
    grid = outer.block(next(k for k in keys if outer.has(k))).grid()
    return np.interp(span, grid, block.array(key, len(grid)))


def _without_drag(members: tuple[Member, ...]) -> list[str]:
    names = [member.name for member in members if not member.drag_coefficient.any()]
    if not names:
        return []
    return [f"platform: no drag across {', '.join(names)}, without a coefficient Cd"]


def _overridden(members: list[Member], companion: Companion) -> tuple[Member, ...]:
    """The members with the sides and coefficients that the companion states instead."""
    names = [member.name for member in members]
    for name, block in companion.members.items():
        if name not in names:
            raise block.error(f"unknown member {name!r}", did_you_mean(name, names))
    return tuple(
        replace(member, **_changes(companion.members[member.name], member))
        if member.name in companion.members
        else member
        for member in members
    )


def _changes(block: Block, member: Member) -> dict[str, Any]:
    changes: dict[str, Any] = {}
    if block.has("sides"):
        sides = block.array("sides", 2, low=1e-6)
        changes |= {"sides": np.tile(sides, (len(member.span), 1)), "round": False}
    if block.has("drag_coefficient"):
        changes["drag_coefficient"] = block.array("drag_coefficient", 2, low=0.0)[None]
    if block.has("axial_drag_coefficient"):
        changes["axial_drag_coefficient"] = block.number("axial_drag_coefficient", low=0.0)
    return changes


def _depths(members: tuple[Member, ...], mooring: Mooring | None) -> dict[str, float]:
    """Draft, and the depth of the water by the lowest anchor; 0 where there is none."""
    draft = max(-min(float(m.start[2]), float(m.end[2])) for m in members)
    anchors = [n.position[2] for n in mooring.nodes if n.kind == "fixed"] if mooring else []
    return {"draft": max(0.0, draft), "water_depth": max(0.0, -float(min(anchors, default=0.0)))}


def _triple(point: Array) -> str:
    return "(" + ", ".join(f"{x:g}" for x in point) + ")"
