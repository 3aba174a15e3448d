"""The sum of a platform's linear loads, in one kernel, and the channels of its parts."""

from __future__ import annotations

from math import sqrt, tan

import numpy as np
from numba import njit

from galerna.contract import Array, Channel
from galerna.structure.frames import log_so3

FAST = {"reassoc", "contract", "arcp", "nsz", "afn"}

PARTS = (  # name, meaning, OpenFAST's name before Fxi
    ("hydrodynamic", "all of potential flow", "Hydro"),
    ("buoyancy", "buoyancy", "B1HdS"),
    ("radiation", "load of the waves that the platform made, without added mass", ""),
    ("excitation", "first-order load of the waves", "B1Wvs"),
    ("drift", "second-order load of the waves", ""),
    ("added_mass", "load of the added mass at infinite frequency", ""),
    ("additional_damping", "additional linear damping", ""),
)


def channels_of() -> tuple[Channel, ...]:
    """Force and moment about the reference point along global axes, of every part."""
    return tuple(
        Channel(
            f"{name}_{kind}_{axis}",
            unit,
            f"{kind} along {axis} on the platform: {meaning}"
            if kind == "force"
            else f"moment about {axis} on the platform: {meaning}",
            (),
            f"{openfast}{kind[0].upper()}{axis}i" if openfast else "",
            unit.replace(" ", "-") if openfast else "",
        )
        for name, meaning, openfast in PARTS
        for kind, unit in (("force", "N"), ("moment", "N m"))
        for axis in "xyz"
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _turned(c: float, s: float, a: Array, i: int, b: Array, j: int) -> Array:
    """Rows i of ``a`` and j of ``b`` (.,3), turned about z by the angle of cosine c and sine s."""
    out = np.empty(6)
    out[0], out[1], out[2] = c * a[i, 0] - s * a[i, 1], s * a[i, 0] + c * a[i, 1], a[i, 2]
    out[3], out[4], out[5] = c * b[j, 0] - s * b[j, 1], s * b[j, 0] + c * b[j, 1], b[j, 2]
    return out


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _tilt(c: float, s: float, rotation: Array) -> Array:
    """Rotation vector (3,) of ``rotation`` seen from the heading's axes."""
    seen = np.empty((3, 3))
    for j in range(3):
        seen[0, j] = c * rotation[0, 0, j] + s * rotation[0, 1, j]
        seen[1, j] = c * rotation[0, 1, j] - s * rotation[0, 0, j]
        seen[2, j] = rotation[0, 2, j]
    return log_so3(seen)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _stiffness(C: Array, phi: Array, K: Array) -> None:
    """``K = C J``: J takes a small turn of the axes outside to a change of the rotation vector.

    J = 1 - hat(phi) / 2 + bend (phi phi^T - phi^2 1) on the rotations.
    """
    square = phi[0] ** 2 + phi[1] ** 2 + phi[2] ** 2
    bend = 1.0 / 12.0 + square / 720.0
    if square > 1e-3:
        half = 0.5 * sqrt(square)
        bend = (1.0 - half / tan(half)) / square
    for i in range(6):
        x, y, z = C[i, 3], C[i, 4], C[i, 5]
        along = bend * (x * phi[0] + y * phi[1] + z * phi[2])
        left = 1.0 - bend * square
        for j in range(3):
            K[i, j] = C[i, j]
        K[i, 3] = left * x + along * phi[0] - 0.5 * (y * phi[2] - z * phi[1])
        K[i, 4] = left * y + along * phi[1] - 0.5 * (z * phi[0] - x * phi[2])
        K[i, 5] = left * z + along * phi[2] - 0.5 * (x * phi[1] - y * phi[0])


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _turn_block(c: float, s: float, K: Array) -> None:
    """``K <- T K T^T`` (6,6) with the turn T about z, of cosine c and sine s."""
    for first in (0, 3):
        for j in range(6):
            x, y = K[first, j], K[first + 1, j]
            K[first, j], K[first + 1, j] = c * x - s * y, s * x + c * y
    for first in (0, 3):
        for i in range(6):
            x, y = K[i, first], K[i, first + 1]
            K[i, first], K[i, first + 1] = c * x - s * y, s * x + c * y


@njit(cache=True, error_model="numpy", fastmath=FAST)
def add_up(
    position: Array, rotation: Array, velocity: Array, angular_velocity: Array,
    acceleration: Array, angular_acceleration: Array, c: float, s: float, reference: Array,
    matrices: Array, given: Array, wrench: Array,
    parts: Array, force: Array, moment: Array, blocks: Array,
) -> None:  # fmt: skip
    """Fill ``parts`` (7,6), the sum on top, ``force`` and ``moment`` (1,3), ``blocks`` (3,1,6,6).

    ``c`` and ``s`` are the heading's cosine and sine. ``matrices`` (4,6,6) are stiffness,
    additional damping, added mass and radiation's damping, ``given`` (4,6) buoyancy at rest,
    radiation, excitation and drift, all in the heading's axes; ``wrench`` (6,) is another
    buoyancy in global axes.
    """
    offset = np.empty((1, 3))
    for k in range(3):
        offset[0, k] = position[0, k] - reference[k]
    p = _turned(c, -s, offset, 0, offset, 0)
    p[3:] = _tilt(c, s, rotation)
    v = _turned(c, -s, velocity, 0, angular_velocity, 0)
    a = _turned(c, -s, acceleration, 0, angular_acceleration, 0)
    own = np.zeros((6, 6))
    for i in range(6):
        for k in range(4):
            own[k, i] = given[k, i]
        for j in range(6):
            own[0, i] -= matrices[0, i, j] * p[j]
            own[1, i] -= matrices[3, i, j] * v[j]
            own[4, i] -= matrices[2, i, j] * a[j]
            own[5, i] -= matrices[1, i, j] * v[j]
            blocks[1, 0, i, j] = matrices[1, i, j] + matrices[3, i, j]
            blocks[2, 0, i, j] = matrices[2, i, j]
    _stiffness(matrices[0], p[3:], blocks[0, 0])
    for k in range(3):
        _turn_block(c, s, blocks[k, 0])
    halves = own.reshape(12, 3)
    for k in range(6):
        parts[k + 1] = _turned(c, s, halves, 2 * k, halves, 2 * k + 1)
    parts[1] += wrench
    parts[0] = parts[1]
    for k in range(2, 7):
        parts[0] += parts[k]
    for k in range(3):
        force[0, k], moment[0, k] = parts[0, k], parts[0, 3 + k]
