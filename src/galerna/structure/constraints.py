"""Constraints of any form on any frames, by Lagrange multipliers.

The lower pairs (hinge, slider, ...) are components of a pair's relative motion and live in
``joints``; whatever else holds frames together is one small class here or in a user's file.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Protocol

import numpy as np
from scipy.sparse import coo_matrix

from galerna.contract import Array

from .frames import exp_se3
from .joints import Path
from .pairs import Integers
from .solvers import Rows

STEP = 1e-6  #: m and rad, of the differences that replace second derivatives


class Constraint(Protocol):
    """What keeps frames together: its violation and the directions in which it pushes.

    ``frames`` are the names of the k frames it sees; ``holonomic`` says whether the
    violation depends on positions alone or is linear in the velocities. ``violation`` (r,)
    is zero when the constraint holds; ``directions`` (r,6k) is its derivative over the
    body variations (holonomic) or over the body twists (not holonomic) of the frames.
    x (k,3), R (k,3,3) and v (k,6) belong to the frames in their order.
    """

    name: str
    frames: tuple[str, ...]
    holonomic: bool

    def violation(self, time: float, x: Array, R: Array, v: Array) -> Array: ...
    def directions(self, time: float, x: Array, R: Array) -> Array: ...


class RollingWithoutSlip:
    """A disc or sphere on a horizontal plane: the touching point does not slip.

    ``radius`` m; a disc's axis is ``axis`` (3,) in body axes, a sphere has none. The
    contact is kept on the plane by ``TouchesPlane``, which alone knows its height.
    """

    holonomic = False

    def __init__(self, name: str, frame: str, radius: float, axis: Array | None = None) -> None:
        self.name, self.frames = name, (frame,)
        self.radius, self.axis = radius, axis

    def violation(self, time: float, x: Array, R: Array, v: Array) -> Array:
        return self.directions(time, x, R) @ v[0]

    def directions(self, time: float, x: Array, R: Array) -> Array:
        arm = R[0].T @ lowest_point(R[0], self.radius, self.axis)
        to_contact = np.hstack([np.eye(3), -np.cross(np.eye(3), arm)])
        return (R[0] @ to_contact)[:2]


class TouchesPlane:
    """The lowest point of a disc or sphere stays on the plane z = ``height`` m."""

    holonomic = True

    def __init__(
        self, name: str, frame: str, radius: float, axis: Array | None = None, height: float = 0.0
    ) -> None:
        self.name, self.frames = name, (frame,)
        self.radius, self.axis, self.height = radius, axis, height

    def violation(self, time: float, x: Array, R: Array, v: Array) -> Array:
        return (x[0] + lowest_point(R[0], self.radius, self.axis))[2:] - self.height

    def directions(self, time: float, x: Array, R: Array) -> Array:
        arm = R[0].T @ lowest_point(R[0], self.radius, self.axis)
        return (R[0] @ np.hstack([np.eye(3), -np.cross(np.eye(3), arm)]))[2:]


def lowest_point(R: Array, radius: float, axis: Array | None) -> Array:
    """From the centre to the lowest point (3,) of a sphere, or of a disc with a body axis."""
    up = np.array([0.0, 0.0, 1.0])
    if axis is not None:
        normal = R @ axis
        up = up - normal * normal[2]
        up = up / np.linalg.norm(up)
    return -radius * up


class HeldAlong:
    """Global components of a frame's position stay where a path (m and turn of time) has them.

    A joint holds them in its own axes and those of the relative motion, which turn.
    """

    holonomic = True

    def __init__(self, name: str, frame: str, components: tuple[int, ...], path: Path) -> None:
        self.name = name
        self.frames: tuple[str, ...] = (frame,)
        self.components, self.path = list(components), path

    def violation(self, time: float, x: Array, R: Array, v: Array) -> Array:
        return np.asarray((x[0] - self.path(time)[0])[self.components])

    def directions(self, time: float, x: Array, R: Array) -> Array:
        return np.hstack([R[0], np.zeros((3, 3))])[self.components]


class PrescribedVelocity:
    """Global components of a frame's velocity or angular velocity follow a function of time.

    ``components`` are indices into (vx, vy, vz, wx, wy, wz) in global axes; ``velocity``
    gives their values (r,) m/s or rad/s at a time.
    """

    holonomic = False

    def __init__(
        self,
        name: str,
        frame: str,
        components: tuple[int, ...],
        velocity: Callable[[float], Array],
    ) -> None:
        self.name, self.frames = name, (frame,)
        self.components, self.velocity = list(components), velocity

    def violation(self, time: float, x: Array, R: Array, v: Array) -> Array:
        return self.directions(time, x, R) @ v[0] - np.atleast_1d(self.velocity(time))

    def directions(self, time: float, x: Array, R: Array) -> Array:
        return np.kron(np.eye(2), R[0])[self.components]


def constraint_rows(
    constraints: list[tuple[Constraint, Integers]],
    time: float,
    multiplier: Array,
    x: Array,
    R: Array,
    v: Array,
    velocity_tangent: Array,
) -> tuple[Rows, Array]:
    """Rows of all constraints for the solver, and their forces (6n,) on the n nodes.

    ``constraints`` come with the numbers of their nodes; ``multiplier`` (r,) in order.
    """
    n, total = len(x), len(multiplier)
    residual = np.zeros(total)
    force = np.zeros(6 * n)
    J, F, S = Triplets(), Triplets(), Triplets()
    start = 0
    for constraint, nodes in constraints:
        local = Local(constraint, time, x[nodes], R[nodes], v[nodes])
        directions = local.directions()
        rows = start + np.arange(len(directions))
        columns = (6 * nodes[:, None] + np.arange(6)).ravel()
        mu = multiplier[rows]
        residual[rows] = local.violation()
        force[columns] += directions.T @ mu
        jacobian = directions
        if not constraint.holonomic:
            moving = np.zeros((len(columns), len(columns)))
            for k, node in enumerate(nodes):
                moving[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = velocity_tangent[node]
            jacobian = directions @ moving + local.difference(lambda at: at.violation())
        F.add(rows, columns, directions)
        J.add(rows, columns, jacobian)
        S.add(columns, columns, local.difference(partial(_force, mu)))
        start += len(rows)
    wide, square = (total, 6 * n), (6 * n, 6 * n)
    return Rows(residual, J.matrix(wide), F.matrix(wide), S.matrix(square)), force


def _force(multiplier: Array, at: Local) -> Array:
    return at.directions().T @ multiplier


class Triplets:
    """Dense blocks gathered into one sparse matrix."""

    def __init__(self) -> None:
        self.row: list[Integers] = []
        self.col: list[Integers] = []
        self.data: list[Array] = []

    def add(self, rows: Integers, columns: Integers, block: Array) -> None:
        self.row.append(np.repeat(rows, len(columns)))
        self.col.append(np.tile(columns, len(rows)))
        self.data.append(block.ravel())

    def matrix(self, shape: tuple[int, int]) -> coo_matrix:
        data = np.concatenate(self.data)
        row, col = np.concatenate(self.row), np.concatenate(self.col)
        return coo_matrix((data, (row, col)), shape=shape)


class Local:
    """A constraint at one state of its frames, and how things change with that state."""

    def __init__(self, constraint: Constraint, time: float, x: Array, R: Array, v: Array) -> None:
        self.constraint, self.time, self.x, self.R, self.v = constraint, time, x, R, v

    def violation(self) -> Array:
        return self.constraint.violation(self.time, self.x, self.R, self.v)

    def directions(self) -> Array:
        return self.constraint.directions(self.time, self.x, self.R)

    def moved(self, component: int, step: float) -> Local:
        """The same after a small body variation of one component."""
        node, axis = divmod(component, 6)
        turn, shift = exp_se3(step * np.eye(6)[axis])
        x, R = self.x.copy(), self.R.copy()
        x[node] += R[node] @ shift
        R[node] = R[node] @ turn
        return Local(self.constraint, self.time, x, R, self.v)

    def difference(self, function: Callable[[Local], Array]) -> Array:
        """Central differences (r,6k) of ``function(Local)`` (r,) over the body variations."""
        change = [
            (function(self.moved(k, STEP)) - function(self.moved(k, -STEP))) / (2 * STEP)
            for k in range(6 * len(self.x))
        ]
        return np.array(change).T
