"""Joints and springs between two frames: each says which relative motions it holds.

A joint stands at a place with axes of its own, z the axis of its freedom, where both frames
have it in the structure's first shape. Relative motion is (translation, rotation) along
the joint's axes; the locked components are held at position level by multipliers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import floor

import numpy as np
from scipy.integrate import quad

from galerna.contract import Array
from galerna.errors import InputError

from .frames import rotation_about

Angle = Callable[[float], float]
Path = Callable[[float], tuple[Array, Array]]

ALL = (0, 1, 2, 3, 4, 5)


@dataclass(frozen=True, eq=False)
class Joint:
    """Any lower pair, spring or damper between the frames ``first`` and ``second``.

    It stands at ``position`` (3,) m with ``axes`` (3,3) as columns, global, in the first
    shape. ``locked`` components are held; the others carry ``stiffness`` and ``damping``
    (6,6) N/m, N m/rad, N s/m, N m s/rad. ``placement`` moves the joint in its own axes as a
    function of time: position (3,) m and rotation (3,3). ``inertance`` kg m2, of a hinge, gives
    a torque against the relative angular acceleration: a rotor that gears turn fast.
    """

    name: str
    first: str
    second: str
    position: Array
    axes: Array = field(default_factory=lambda: np.eye(3))
    locked: tuple[int, ...] = ()
    stiffness: Array = field(default_factory=lambda: np.zeros((6, 6)))
    damping: Array = field(default_factory=lambda: np.zeros((6, 6)))
    placement: Path | None = None
    inertance: float = 0.0


def rigid(name: str, first: str, second: str, position: Array) -> Joint:
    """Two frames that move as one."""
    return Joint(name, first, second, position, locked=ALL)


def spherical(name: str, first: str, second: str, position: Array) -> Joint:
    """A common point, all rotations free."""
    return Joint(name, first, second, position, locked=(0, 1, 2))


def hinge(
    name: str,
    first: str,
    second: str,
    position: Array,
    axis: Array,
    angle: Angle | None = None,
    speed: Angle | None = None,
    stiffness: float = 0.0,
    damping: float = 0.0,
    inertance: float = 0.0,
) -> Joint:
    """Rotation about ``axis`` (3,) alone: free, or with ``angle`` rad or ``speed`` rad/s of time.

    A free one may have a damper N m s/rad and a torsion spring N m/rad, which knows its angle
    within half a turn; a torque is set with ``System.set_torque``. ``inertance`` see ``Joint``.
    """
    K, D = np.zeros((6, 6)), np.zeros((6, 6))
    K[5, 5], D[5, 5] = stiffness, damping
    if speed is not None:
        if angle is not None:
            raise InputError(name, "angle and speed are both given", "give one of them")
        angle = integral(speed)
    locked = (0, 1, 2, 3, 4) if angle is None else ALL
    placement = None if angle is None else turning(angle)
    axes = axes_along(axis)
    return Joint(name, first, second, position, axes, locked, K, D, placement, inertance)


def prismatic(name: str, first: str, second: str, position: Array, axis: Array) -> Joint:
    """Translation along ``axis`` (3,) alone."""
    return Joint(name, first, second, position, axes_along(axis), (0, 1, 3, 4, 5))


def cylindrical(name: str, first: str, second: str, position: Array, axis: Array) -> Joint:
    """Rotation about and translation along ``axis`` (3,)."""
    return Joint(name, first, second, position, axes_along(axis), (0, 1, 3, 4))


def spring(
    name: str, first: str, second: str, position: Array, stiffness: Array,
    damping: Array | None = None, axes: Array | None = None,
) -> Joint:  # fmt: skip
    """An elastic bushing (6,6) between two frames, or to the ground; slack in the first shape."""
    D = np.zeros((6, 6)) if damping is None else np.asarray(damping)
    return Joint(
        name, first, second, position, np.eye(3) if axes is None else axes, (),
        np.asarray(stiffness), D,
    )  # fmt: skip


def on_path(
    name: str, frame: str, path: Path, locked: tuple[int, ...] = ALL, ground: str = "ground"
) -> Joint:
    """A frame that follows ``path``: time -> global position (3,) m and rotation (3,3).

    A frame that stands off the path at time 0 keeps its place in the path's axes. ``locked``
    leaves some components free, in these axes.
    """
    start, axes = path(0.0)

    def travelled(time: float) -> tuple[Array, Array]:
        x, R = path(time)
        return axes.T @ (x - start), axes.T @ R

    return Joint(name, ground, frame, start, axes, locked, placement=travelled)


def turning(angle: Angle) -> Path:
    """A placement that turns about z by ``angle`` rad of time."""
    return lambda time: (np.zeros(3), rotation_about(2, float(angle(time))))


def integral(speed: Angle) -> Angle:
    """The angle rad that a speed rad/s has turned since time 0.

    It is summed second by second to rounding: accelerations divide its error by the square
    of the time step.
    """

    turned = [0.0]  # after whole seconds

    def piece(start: float, end: float) -> float:
        return float(quad(speed, start, end, epsabs=1e-14, epsrel=0.0, limit=200, full_output=1)[0])

    def angle(time: float) -> float:
        whole = max(floor(time), 0)
        while len(turned) <= whole:
            k = len(turned) - 1
            turned.append(turned[k] + piece(k, k + 1))
        return turned[whole] + piece(whole, time)

    return angle


def axes_along(axis: Array) -> Array:
    """Joint axes (3,3) with z along ``axis`` (3,); raises InputError if that has no direction."""
    length = np.linalg.norm(axis)
    if not 0.0 < length < np.inf:
        raise InputError("axis", f"{np.asarray(axis).tolist()} has no direction")
    z = np.asarray(axis, dtype=float) / length
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)
