"""What polars say of strips: coefficients at an angle, and drag at a lift while flow is attached.

Between its least and its greatest lift an attached section has one drag for each lift
(dissertation 4.1.1). That branch is the part of the polar around its least drag on which lift
rises with the angle of attack.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from galerna.aero.sections import BladeSections, tabulate_polar
from galerna.aero.vortex.camber import NO_LIFT
from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.model import Polar

LEAST_DRAG_WITHIN = np.radians(20.0)  #: on both sides of 0, where the attached branch is looked for
FALL = 0.02  #: of the lift coefficient along the branch that is scatter and not its end
BRANCH_POINTS = 513
WHOLE_TABLE = 2880  #: intervals of a plain polar's table


class AttachedState(NamedTuple):
    """Angle of attack rad and drag of sections by their lift.

    ``outside`` is -1 below the least and 1 above the greatest lift of the branch, whose end is
    taken there; 0 within.
    """

    angle_of_attack: Array
    drag: Array
    outside: NDArray[np.int8]


@dataclass(frozen=True, eq=False)
class SectionPolars:
    """Polars of n strips: cl, cd and cm (n,k,3) at k angles evenly from -pi to pi.

    ``lift_range`` (n,2) are the least and the greatest lift coefficient of the attached branch
    and ``branch`` (n,q,2) its angle of attack rad and drag; see ``at_lift`` for the q places.
    ``lifting`` (n,) is false for cylinders, which have no such branch.
    """

    table: Array
    lift_range: Array
    branch: Array
    lifting: NDArray[np.bool_]

    @classmethod
    def of_table(cls, table: Array) -> SectionPolars:
        """From coefficients (n,k,3) on even angles."""
        lifting = np.max(np.abs(table[:, :, 0]), axis=1) > NO_LIFT
        ranges, branches = zip(*(_attached_branch(t) for t in table), strict=True)
        return cls(table, np.array(ranges), np.array(branches), lifting)

    @classmethod
    def of_blade(cls, sections: BladeSections | None, blade: str) -> SectionPolars:
        """Of a blade's strips; InputError where its airfoils have no polars."""
        if sections is None:
            raise InputError(
                blade,
                "an airfoil has no polars, and drag and separation are taken from them",
                "give polars, or switch drag and decambering off",
            )
        return cls.of_table(sections.table)

    @classmethod
    def none(cls, strips: int) -> SectionPolars:
        """For strips that have no polars: all coefficients are zero."""
        return cls.of_table(np.zeros((strips, 3, 3)))

    @classmethod
    def of_polar(cls, polar: Polar, strips: int) -> SectionPolars:
        """One polar for all strips of a wing; InputError where it cannot be used."""
        table = tabulate_polar("of the wing", polar, WHOLE_TABLE)
        return cls.of_table(np.broadcast_to(table, (strips, *table.shape)))

    @classmethod
    def joined(cls, parts: Sequence[SectionPolars]) -> SectionPolars:
        """The strips of several surfaces, one after the other, on the finest of their tables."""
        finest = max(part.table.shape[1] for part in parts)
        return cls.of_table(np.concatenate([_on_angles(part.table, finest) for part in parts]))

    def part(self, first: int) -> SectionPolars:
        """The strips from number ``first`` on."""
        return SectionPolars(*(getattr(self, f.name)[first:] for f in fields(self)))

    def __len__(self) -> int:
        return len(self.table)

    def at_angle(self, angle_of_attack: Array) -> Array:
        """cl, cd and cm (..., n, 3) at any angles (..., n) rad."""
        last = self.table.shape[1] - 1
        place = (np.asarray(angle_of_attack) + pi) * (last / (2.0 * pi)) % last
        left = np.minimum(place.astype(int), last - 1)
        t = (place - left)[..., None]
        strip = np.arange(len(self))
        return (1.0 - t) * self.table[strip, left] + t * self.table[strip, left + 1]

    def at_lift(self, lift: Array) -> AttachedState:
        """The attached branch at lift coefficients (..., n).

        The branch is tabled at lifts that crowd towards both ends like a cosine, because
        the angle goes with the square root of the distance to the greatest lift.
        """
        low, high = self.lift_range.T
        inside = np.clip((lift - low) / np.where(self.lifting, high - low, 1.0), 0.0, 1.0)
        last = self.branch.shape[1] - 1
        place = np.arccos(1.0 - 2.0 * inside) * (last / pi)
        left = np.minimum(place.astype(int), last - 1)
        t = (place - left)[..., None]
        strip = np.arange(len(self))
        found = (1.0 - t) * self.branch[strip, left] + t * self.branch[strip, left + 1]
        outside = (np.asarray(lift > high, np.int8) - (lift < low)) * self.lifting
        return AttachedState(found[..., 0], found[..., 1], outside.astype(np.int8))


def _on_angles(table: Array, angles: int) -> Array:
    """A table (n,k,3) on another number of even angles."""
    if table.shape[1] == angles:
        return table
    old, new = (np.linspace(-pi, pi, k) for k in (table.shape[1], angles))
    return np.stack([[np.interp(new, old, c) for c in strip.T] for strip in table]).swapaxes(1, 2)


def _attached_branch(table: Array) -> tuple[Array, Array]:
    """Lift range (2,) and branch (q,2) of one polar (k,3)."""
    angle = np.linspace(-pi, pi, len(table))
    lift, drag = table[:, 0], table[:, 1]
    near = np.abs(angle) <= LEAST_DRAG_WITHIN
    start = int(np.argmin(np.where(near, drag + 1e-6 * np.abs(angle), np.inf)))
    last = start + _rise(lift[start:])
    first = start - _rise(-lift[start::-1])
    part = slice(first, last + 1)
    rising = np.maximum.accumulate(lift[part])
    kept = np.flatnonzero(np.diff(rising, prepend=-np.inf) > 0.0)
    low, high = rising[kept[0]], rising[kept[-1]]
    crowded = 0.5 - 0.5 * np.cos(np.linspace(0.0, pi, BRANCH_POINTS))
    places = low + (high - low) * crowded
    branch = [np.interp(places, rising[kept], v[part][kept]) for v in (angle, drag)]
    return np.array([low, high]), np.stack(branch, axis=1)


def _rise(lift: Array) -> int:
    """Steps from the first of ``lift`` (k,) to its greatest before it falls by more than FALL."""
    greatest = np.maximum.accumulate(lift)
    fallen = np.flatnonzero(greatest - lift > FALL)
    return int(np.argmax(lift[: fallen[0]] if len(fallen) else lift))
