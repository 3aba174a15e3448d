"""A platform's members cut into strips on which the water drags."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from galerna.contract import Array, Stations
from galerna.turbine.platform import Member, Platform

_GROWTH = 20.0  #: m below or above the still water where strips are twice as long as at it
_LEVEL_STRIPS = 3.0  #: times as long as upright ones are strips of members that lie
_LYING = 0.5  #: sine of the slope below which a member lies
_PARTS = 20  #: of a strip, which are found inside of other members or not
_OUTSIDE = 1e-3  #: m beyond an end, where other members may cover it


@dataclass(frozen=True, eq=False)
class Carrier:
    """What the strips ride on: ``stations`` whose frames stand at ``position`` (k,3) m.

    ``rotation`` (k,3,3) are the frames' axes, as columns, in the platform as described. Each
    strip rides on the nearest frame.
    """

    stations: Stations
    position: Array
    rotation: Array

    @classmethod
    def rigid(cls, platform: Platform) -> Carrier:
        """The platform as one body."""
        position = np.array([platform.reference_point], dtype=float)
        return cls(Stations("platform"), position, np.eye(3)[None])


@dataclass(frozen=True, eq=False)
class Strips:
    """m strips of the platform as described, in global axes.

    ``center`` (m,3) m; ``axes`` (m,3,3) are along the first side, the second side and the axis,
    as columns. ``length`` (m,) m of the exposed part, ``height`` (m,) m from its lowest to its
    highest point. ``drag_width`` (m,2) m: coefficient times the width across the flow for flow
    along the two sides; ``drag_area`` (m,) m2 the same along the axis, of members' ends.
    """

    center: Array = field(default_factory=lambda: np.zeros((0, 3)))
    axes: Array = field(default_factory=lambda: np.zeros((0, 3, 3)))
    length: Array = field(default_factory=lambda: np.zeros(0))
    height: Array = field(default_factory=lambda: np.zeros(0))
    drag_width: Array = field(default_factory=lambda: np.zeros((0, 2)))
    drag_area: Array = field(default_factory=lambda: np.zeros(0))

    def __len__(self) -> int:
        return len(self.length)

    @classmethod
    def joined(cls, parts: Sequence[Strips]) -> Strips:
        """All of them, without those on which nothing drags."""
        names = ("center", "axes", "length", "height", "drag_width", "drag_area")
        whole = [np.concatenate([getattr(part, name) for part in parts]) for name in names]
        dragged = (whole[4].any(axis=1) & (whole[2] > 0.0)) | (whole[5] > 0.0)
        return cls(*(values[dragged] for values in whole))


def platform_strips(members: Sequence[Member], spacing: float = 1.0) -> Strips:
    """Strips of all members, without what stands inside of another one.

    ``spacing`` m is their length at the still water, 1/20 more per metre from it, and three
    times as much where members lie. Ends that no other member covers drag along the axis.
    """
    parts = [Strips()]
    for member in members:
        others = [other for other in members if other is not member]
        parts += [_along(member, others, spacing), _ends(member, others)]
    return Strips.joined(parts)


def _along(member: Member, others: Sequence[Member], spacing: float) -> Strips:
    """The strips between a member's ends."""
    edges = _edges(member, spacing)
    middle, share = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    inner = edges[:-1, None] + share[:, None] * (np.arange(_PARTS) + 0.5) / _PARTS
    exposed = 1.0 - _inside(_points(member, inner.ravel()), others).reshape(-1, _PARTS).mean(axis=1)
    length = member.length * share
    sides, drag = _at(member, member.sides, middle), _at(member, member.drag_coefficient, middle)
    return Strips(
        center=_points(member, middle),
        axes=np.tile(member.axes(), (len(middle), 1, 1)),
        length=exposed * length,
        height=_height(member, length, sides),
        drag_width=drag * sides[:, ::-1],
        drag_area=np.zeros(len(middle)),
    )


def _ends(member: Member, others: Sequence[Member]) -> Strips:
    """A member's two ends, where they are exposed, as strips of no length."""
    ends = np.array([0.0, 1.0])
    beyond = _points(member, np.array([-_OUTSIDE, member.length + _OUTSIDE]) / member.length)
    sides = _at(member, member.sides, ends)
    area = sides[:, 0] * sides[:, 1] * (0.25 * np.pi if member.round else 1.0)
    exposed = ~_inside(beyond, others)
    return Strips(
        center=_points(member, ends),
        axes=np.tile(member.axes(), (2, 1, 1)),
        length=np.zeros(2),
        height=np.maximum(_height(member, np.zeros(2), sides), 0.1 * sides.min(axis=1)),
        drag_width=np.zeros((2, 2)),
        drag_area=member.axial_drag_coefficient * area * exposed,
    )


def _edges(member: Member, spacing: float) -> Array:
    """Fractions (p,) of a member between its strips; they fall on the corners of its outside."""
    axis = member.axes()[:, 2]
    factor = spacing * (1.0 if abs(axis[2]) > _LYING else _LEVEL_STRIPS)
    corners = np.unique(np.concatenate([[0.0, 1.0], _corners(member)]))
    pieces = [np.zeros(1)]
    for a, b in pairwise(corners):
        fine = np.linspace(a, b, 200)
        z = _points(member, fine)[:, 2]
        density = member.length / (factor * (1.0 + np.abs(z) / _GROWTH))
        grown = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
        grown *= fine[1] - fine[0]
        count = max(int(np.ceil(grown[-1])), 1)
        pieces.append(np.interp(np.linspace(0.0, grown[-1], count + 1)[1:], grown, fine))
    return np.concatenate(pieces)


def _corners(member: Member) -> Array:
    """Fractions where a member's outside bends, and where it goes through the still water."""
    z = member.start[2], member.end[2]
    through = [z[0] / (z[0] - z[1])] if z[0] * z[1] < 0.0 else []
    return np.concatenate([member.span, through])


def _points(member: Member, fraction: Array) -> Array:
    return member.start + np.multiply.outer(fraction, member.end - member.start)


def _at(member: Member, values: Array, fraction: Array) -> Array:
    """Values (p,2) over ``member.span``, or one pair (1,2), at fractions (m,)."""
    rows = np.broadcast_to(values, (len(member.span), 2))
    return np.stack([np.interp(fraction, member.span, column) for column in rows.T], axis=1)


def _height(member: Member, length: Array, sides: Array) -> Array:
    """From the lowest to the highest point (m,) m of strips of a length and sides."""
    slope = np.abs(member.axes()[2])
    return np.asarray(slope[2] * length + slope[0] * sides[:, 0] + slope[1] * sides[:, 1])


def _inside(points: Array, members: Sequence[Member]) -> NDArray[np.bool_]:
    """Whether points (m,3) stand inside of one of the members."""
    found = np.zeros(len(points), dtype=bool)
    for member in members:
        across = (points - member.start) @ member.axes()
        fraction = across[:, 2] / member.length
        half = 0.5 * _at(member, member.sides, fraction)
        scaled = np.abs(across[:, :2]) / half
        reach = np.hypot(*scaled.T) if member.round else scaled.max(axis=1)
        found |= (fraction >= 0.0) & (fraction <= 1.0) & (reach < 1.0)
    return found


def columns_of(center: Array, tolerance: float = 1e-3) -> tuple[Array, NDArray[np.int64]]:
    """Horizontal places (c,2) m of points (m,3), and which of them is each point's (m,)."""
    rounded = np.rint(center[:, :2] / tolerance) * tolerance
    places, index = np.unique(rounded, axis=0, return_inverse=True)
    return places, index.ravel().astype(np.int64)
