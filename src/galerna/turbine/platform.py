"""A floating platform with its moorings as plain data: SI and radians, global axes.

Positions are those of the platform as it is described, upright, with the origin at still
water on the tower's axis.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_UPRIGHT = 1e-6  #: sine of the lean below which an axis counts as upright


@dataclass(frozen=True, eq=False)
class Member:
    """A straight member from ``start`` to ``end`` (3,) m, its hull at fractions ``span`` (n,).

    ``sides`` (n,2) m are the diameter, twice, of a round member; of a rectangular one the
    horizontal width and the other side (of an upright member: along x and y).
    ``drag_coefficient`` (n,2) belongs to flow along the two sides' directions, over the width
    that stands across it; ``axial_drag_coefficient`` to flow against an end's area.
    """

    name: str
    start: Array
    end: Array
    span: Array
    sides: Array
    round: bool = True
    drag_coefficient: Array = field(default_factory=lambda: np.zeros((1, 2)))
    axial_drag_coefficient: float = 0.0

    @property
    def length(self) -> float:
        """Distance m from end to end."""
        return float(np.linalg.norm(self.end - self.start))

    def axes(self) -> Array:
        """Unit vectors (3,3) as columns: along the first side, the second side, the axis."""
        axis = (self.end - self.start) / self.length
        level = np.cross((0.0, 0.0, 1.0), axis)
        upright = np.linalg.norm(level) < _UPRIGHT
        first = np.array([1.0, 0.0, 0.0]) if upright else level / np.linalg.norm(level)
        return np.stack([first, np.cross(axis, first), axis], axis=1)


@dataclass(frozen=True)
class LineType:
    """A mooring line per metre: ``mass`` kg/m, ``weight`` N/m in water, ``stiffness`` EA N.

    ``diameter`` m is that of the displaced volume. Drag coefficients belong to it, across
    and along the line; they and the added-mass coefficients are for dynamic lines alone.
    """

    name: str
    diameter: float
    mass: float
    weight: float
    stiffness: float
    transverse_drag: float = 1.6
    tangential_drag: float = 0.1
    transverse_added_mass: float = 1.0
    tangential_added_mass: float = 0.0


@dataclass(frozen=True, eq=False)
class MooringNode:
    """An end of lines at ``position`` (3,) m: fixed, on the vessel, or a free connection.

    A connection's ``position`` is where its search begins; ``mass`` kg and ``volume`` m3 are a
    clump weight's or a buoy's.
    """

    name: str
    kind: Literal["fixed", "vessel", "connection"]
    position: Array
    mass: float = 0.0
    volume: float = 0.0


@dataclass(frozen=True)
class MooringLine:
    """A line of one type between two nodes, by their names; ``length`` m unstretched."""

    name: str
    first: str
    second: str
    line_type: LineType
    length: float


@dataclass(frozen=True, eq=False)
class Mooring:
    """Lines between anchors, the platform and free connections.

    ``seabed_friction`` is the coefficient of lines that rest; ``yaw_stiffness`` N m/rad is a
    torsion spring beside the lines, such as that of a delta connection.
    """

    nodes: tuple[MooringNode, ...]
    lines: tuple[MooringLine, ...]
    seabed_friction: float = 0.0
    yaw_stiffness: float = 0.0

    def node(self, name: str) -> MooringNode:
        """The node of a name."""
        return next(node for node in self.nodes if node.name == name)


@dataclass(frozen=True, eq=False)
class Platform:
    """Floating platform as a rigid body about its reference point, global axes.

    ``center_of_mass`` (3,) m from the origin; ``inertia`` (3,) kg m2 in roll, pitch and
    yaw about the centre of mass. ``additional_damping`` (6,6) N s/m ... N m s is linear damping
    about the reference point; ``hydrodynamics`` a file of potential-flow coefficients.
    """

    reference_point: tuple[float, float, float]
    mass: float
    center_of_mass: tuple[float, float, float]
    inertia: tuple[float, float, float]
    displaced_volume: float = 0.0
    water_depth: float = 0.0
    draft: float = 0.0
    members: tuple[Member, ...] = ()
    mooring: Mooring | None = None
    additional_damping: Array = field(default_factory=lambda: np.zeros((6, 6)))
    hydrodynamics: Path | None = None
