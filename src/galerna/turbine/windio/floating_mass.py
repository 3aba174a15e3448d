"""What a floating platform weighs: walls, bulkheads, fixed ballast, rigid bodies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from galerna.turbine.model import Array
from galerna.turbine.platform import Member
from galerna.turbine.windio.block import Block
from galerna.turbine.windio.joints import Joints
from galerna.turbine.windio.materials import material

_SLICES = 400  #: per member; its walls' moments are then exact to 1e-5
_UNREAD = ("ring_stiffeners", "longitudinal_stiffeners")


@dataclass
class _Sum:
    """Mass kg, first moment kg m and moments of inertia (3,3) kg m2 about the origin."""

    mass: float = 0.0
    first: Array = field(default_factory=lambda: np.zeros(3))
    second: Array = field(default_factory=lambda: np.zeros((3, 3)))

    def add(self, masses: Array, points: Array, own: Array) -> None:
        """Masses (n,) at points (n,3) with inertia (n,3,3) about them."""
        squares = np.einsum("ni,ni->n", points, points)
        outer = np.einsum("n,ni,nj->ij", masses, points, points)
        self.mass += float(masses.sum())
        self.first += masses @ points
        self.second += (masses @ squares) * np.eye(3) - outer + own.sum(axis=0)

    def center(self) -> Array:
        """Mass centre (3,) m."""
        return self.first / self.mass

    def inertia(self) -> Array:
        """Inertia (3,3) about the mass centre."""
        c = self.center()
        return self.second - self.mass * ((c @ c) * np.eye(3) - np.outer(c, c))


def platform_mass(
    document: Block, block: Block, joints: Joints, members: tuple[Member, ...], notes: list[str]
) -> dict[str, Any]:
    """``mass``, ``center_of_mass`` and ``inertia`` of a platform from its structure.

    Variable ballast stays out: it follows from the balance afloat. Raises InputError where
    nothing has mass.
    """
    total = _Sum()
    blocks = list(block.blocks("members"))
    for member, member_block in zip(members, blocks, strict=True):
        _add_member(total, document, member_block.block("structure"), member)
    _add_bodies(total, block, joints)
    if total.mass <= 0.0:
        raise block.error("nothing of it has mass", "state 'platform' in the companion")
    inertia, center = total.inertia(), total.center()
    notes += _what_was_done(blocks, total.mass, inertia)
    x, y, z = (float(value) for value in center)
    roll, pitch, yaw = (float(value) for value in np.diag(inertia))
    return {"mass": total.mass, "center_of_mass": (x, y, z), "inertia": (roll, pitch, yaw)}


def _what_was_done(blocks: list[Block], mass: float, inertia: Array) -> Iterator[str]:
    yield (
        f"platform: mass of {mass:.6g} kg, centre and inertia from walls, bulkheads, fixed "
        "ballast and rigid bodies; those of the companion would win"
    )
    watered = [b.text("name") for b in blocks if any(map(_is_variable, _ballast(b)))]
    if watered:
        yield (
            f"platform: variable ballast of {', '.join(watered)} is left out: what balances it "
            "afloat is for the companion's mass, center_of_mass and inertia to state"
        )
    for key in _UNREAD:
        if stiffened := [b.text("name") for b in blocks if b.block("structure").has(key)]:
            yield f"platform: {key} of {', '.join(stiffened)} do not count"
    products = np.abs(inertia[np.triu_indices(3, 1)]).max()
    if products > 0.01 * np.diag(inertia).max():
        yield f"platform: products of inertia up to {products:.4g} kg m2 are left out"


def _ballast(member: Block) -> list[Block]:
    structure = member.block("structure")
    return list(structure.blocks("ballast")) if structure.has("ballast") else []


def _is_variable(ballast: Block) -> bool:
    return bool(ballast.value("variable_flag"))


def _add_member(total: _Sum, document: Block, structure: Block, member: Member) -> None:
    edges = np.unique(np.concatenate([np.linspace(0.0, 1.0, _SLICES + 1), member.span]))
    span, step = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges) * member.length
    factor = structure.number("outfitting_factor", 1.0, 1.0)
    outer = _sides_at(member, span)
    for layer in structure.blocks("layers"):
        grid, thickness = layer.curve("thickness", low=0.0)
        inner = outer - 2.0 * np.interp(span, grid, thickness)[:, None]
        if (inner < 0.0).any():
            raise layer.error("is thicker than half the member", "", "thickness")
        weight = factor * material(document, layer).density * step
        _add_slices(total, member, span, weight, outer)
        _add_slices(total, member, span, -weight, inner)
        outer = inner
    _add_bulkheads(total, document, structure, member, factor, (span, outer))
    _add_ballast(total, document, structure, member, (span, step, outer))


def _add_bulkheads(
    total: _Sum,
    document: Block,
    structure: Block,
    member: Member,
    factor: float,
    inside: tuple[Array, Array],
) -> None:
    if not structure.has("bulkhead"):
        return
    block = structure.block("bulkhead")
    thickness = block.block("thickness")
    grid = thickness.array("grid", low=0.0)
    depth = thickness.array("values", len(grid), 0.0)
    sides = _interpolated(grid, *inside)
    weight = factor * material(document, block).density * depth
    _add_slices(total, member, grid, weight, sides)


def _add_ballast(
    total: _Sum,
    document: Block,
    structure: Block,
    member: Member,
    inside: tuple[Array, Array, Array],
) -> None:
    """Fixed ballast fills its compartment from the lower end until its volume is in."""
    span, step, sides = inside
    for block in structure.blocks("ballast") if structure.has("ballast") else ():
        if _is_variable(block):
            continue
        low, high = block.array("grid", 2, 0.0).tolist()
        room = np.where((span > low) & (span < high), _area(member, sides) * step, 0.0)
        volume = block.number("volume", low=0.0)
        if volume > 1.01 * room.sum():
            what = f"{volume:g} m3 of ballast where {room.sum():g} m3 have room"
            raise block.error(what, "", "volume")
        upwards = slice(None) if member.end[2] >= member.start[2] else slice(None, None, -1)
        below = np.cumsum(room[upwards]) - room[upwards]
        filled = np.clip((volume - below) / np.maximum(room[upwards], 1e-300), 0.0, 1.0)[upwards]
        _add_slices(
            total,
            member,
            span,
            material(document, block).density * step * filled * (room > 0.0),
            sides,
        )


def _add_slices(total: _Sum, member: Member, span: Array, weight: Array, sides: Array) -> None:
    """Thin slices of ``weight`` (n,) kg/m2 and ``sides`` (n,2) across a member's axis."""
    masses = weight * _area(member, sides)
    points = member.start + span[:, None] * (member.end - member.start)
    across = (sides**2 / (16.0 if member.round else 12.0)) * masses[:, None]
    axes = member.axes()
    diagonal = np.stack([across[:, 1], across[:, 0], across.sum(axis=1)], axis=1)
    total.add(masses, points, np.einsum("ik,nk,jk->nij", axes, diagonal, axes))


def _add_bodies(total: _Sum, block: Block, joints: Joints) -> None:
    if joints.transition is not None:
        mass = block.number("transition_piece_mass", 0.0, 0.0)
        foot = joints.position[joints.transition]
        total.add(np.array([mass]), foot[None], np.zeros((1, 3, 3)))
    for body in block.blocks("rigid_bodies") if block.has("rigid_bodies") else ():
        point = joints.of(body, "joint1") + body.array("cm_offset", 3)
        own = np.diag(body.array("moments_of_inertia", 3, 0.0))
        total.add(np.array([body.number("mass", low=0.0)]), point[None], own[None])


def _area(member: Member, sides: Array) -> Array:
    return (np.pi / 4.0 if member.round else 1.0) * sides[:, 0] * sides[:, 1]


def _sides_at(member: Member, span: Array) -> Array:
    return _interpolated(span, member.span, member.sides)


def _interpolated(span: Array, grid: Array, sides: Array) -> Array:
    return np.stack([np.interp(span, grid, sides[:, i]) for i in range(2)], axis=1)
