"""Loads on the frames, and what they add to the tangents."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from galerna.contract import Array, Loads
from galerna.errors import InputError

from .blocks import FAST, multiply3, multiply3_transposed, multiply6
from .frames import hat
from .pairs import Integers

BLOCKS = ("stiffness", "damping", "mass")
NO_BLOCKS = np.zeros((0, 6, 6))


@dataclass(eq=False, slots=True)
class Forces:
    """Loads on all n frames: ``dead`` (n,6) in global and ``follower`` (n,6) in body axes.

    ``stiffness``, ``damping`` and ``mass`` (n,6,6), where given, are minus the
    derivatives of the dead loads over motion, velocity and acceleration in global axes;
    they vanish but on the frames ``stiff`` (k,), where that is given.
    """

    dead: Array
    follower: Array
    stiffness: Array | None = None
    damping: Array | None = None
    mass: Array | None = None
    stiff: Integers | None = None

    @classmethod
    def none(cls, n: int) -> Forces:
        return cls(np.zeros((n, 6)), np.zeros((n, 6)))

    @classmethod
    def of(cls, n: int, nodes: Integers, loads: Loads) -> Forces:
        """A load model's answer on the frames ``nodes`` (k,), each of which may repeat."""
        forces = cls.none(n)
        np.add.at(forces.dead, nodes, np.hstack([loads.force, loads.moment]))
        for name in BLOCKS:
            blocks = getattr(loads, name)
            if blocks is not None:
                total = np.zeros((n, 6, 6))
                np.add.at(total, nodes, blocks)
                setattr(forces, name, total)
        return forces

    @classmethod
    def stiff_on(cls, n: int, nodes: Integers) -> Forces:
        """No loads on n frames, with room for blocks on the frames ``nodes`` (k,)."""
        if not len(nodes):
            return cls.none(n)
        blocks = {name: np.zeros((n, 6, 6)) for name in BLOCKS}
        return cls(np.zeros((n, 6)), np.zeros((n, 6)), **blocks, stiff=np.unique(nodes))

    @property
    def blocks(self) -> tuple[Array | None, Array | None, Array | None]:
        """Stiffness, damping and mass."""
        return self.stiffness, self.damping, self.mass

    def clear(self) -> None:
        """Take all loads away, and the blocks."""
        self.dead[:] = 0.0
        self.follower[:] = 0.0
        if self.stiff is not None:
            for name in BLOCKS:
                getattr(self, name)[self.stiff] = 0.0

    def scaled(self, factor: float) -> Forces:
        """The loads times a factor."""
        given = {name: getattr(self, name) for name in BLOCKS}
        blocks = {name: None if b is None else factor * b for name, b in given.items()}
        return Forces(factor * self.dead, factor * self.follower, **blocks, stiff=self.stiff)

    def check(self, n: int) -> None:
        """Raise InputError where an array does not belong to n frames."""
        for name in ("dead", "follower", *BLOCKS):
            values = getattr(self, name)
            shape = (n, 6) if name in ("dead", "follower") else (n, 6, 6)
            if values is not None and np.shape(values) != shape:
                raise InputError(
                    f"forces, {name}", f"shape {np.shape(values)}, the system needs {shape}",
                    "one row for each frame, the ground's first",
                )  # fmt: skip


def add_load_tangents(
    forces: Forces, R: Array, v: Array, velocity_tangent: Array, acceleration_tangent: Array,
    nodes: Array,
) -> None:  # fmt: skip
    """Add stiff loads' blocks, turned from global into body axes."""
    if forces.stiffness is None and forces.damping is None and forces.mass is None:
        return
    at = np.arange(len(R)) if forces.stiff is None else forces.stiff
    stiffness, damping, mass = (NO_BLOCKS if b is None else b for b in forces.blocks)
    _add_blocks(
        at, stiffness, damping, mass, R, v, velocity_tangent, acceleration_tangent, nodes
    )  # fmt: skip


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _in_axes(block: Array, R: Array) -> Array:
    """A block (6,6) given in global axes, in the axes R (3,3)."""
    out = np.empty((6, 6))
    for i in (0, 3):
        for j in (0, 3):
            turned = multiply3(np.ascontiguousarray(block[i : i + 3, j : j + 3]), R)
            out[i : i + 3, j : j + 3] = multiply3_transposed(R, turned)
    return out


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_blocks(
    at: Integers, stiffness: Array, damping: Array, mass: Array, R: Array, v: Array,
    velocity_tangent: Array, acceleration_tangent: Array, nodes: Array,
) -> None:  # fmt: skip
    for i in at:
        if len(stiffness):
            nodes[i] += _in_axes(stiffness[i], R[i])
        if len(damping):
            # a variation turns the body's axes, in which v is given, and so the global velocity
            rate = velocity_tangent[i].copy()
            rate[:3, 3:] -= hat(v[i, :3])
            rate[3:, 3:] -= hat(v[i, 3:])
            nodes[i] += multiply6(_in_axes(damping[i], R[i]), rate)
        if len(mass):
            nodes[i] += multiply6(_in_axes(mass[i], R[i]), acceleration_tangent[i])


def in_body_axes(blocks: Array, R: Array) -> Array:
    """Blocks (n,6,6) given in global axes, in the axes of the frames."""
    turn = np.zeros((len(R), 6, 6))
    turn[:, :3, :3] = turn[:, 3:, 3:] = R
    return turn.transpose(0, 2, 1) @ blocks @ turn


def hats(a: Array) -> Array:
    """Cross-product matrices (n,3,3) of vectors (n,3)."""
    return np.cross(np.eye(3)[None], a[:, None, :])
