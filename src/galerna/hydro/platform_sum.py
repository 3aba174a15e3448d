"""The sum of a platform's linear loads, in one kernel, and the channels of its parts."""

from __future__ import annotations

from math import atan2, cos, sin, sqrt, tan

import numpy as np
from numba import njit

from galerna.contract import Array, Channel

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
def seen_from(R: Array, a: Array, b: Array) -> Array:
    """Row 0 of ``a`` and of ``b`` (1,3) in the axes R (3,3)."""
    out = np.empty(6)
    for k in range(3):
        out[k] = R[0, k] * a[0, 0] + R[1, k] * a[0, 1] + R[2, k] * a[0, 2]
        out[3 + k] = R[0, k] * b[0, 0] + R[1, k] * b[0, 1] + R[2, k] * b[0, 2]
    return out


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _out_of(R: Array, own: Array, out: Array) -> None:
    """``out`` (6,): ``own`` (6,) in the axes R (3,3), seen in global ones."""
    for i in range(3):
        out[i] = R[i, 0] * own[0] + R[i, 1] * own[1] + R[i, 2] * own[2]
        out[3 + i] = R[i, 0] * own[3] + R[i, 1] * own[4] + R[i, 2] * own[5]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _block_out_of(R: Array, own: Array, out: Array) -> None:
    """``out`` (6,6): a matrix ``own`` (6,6) in the axes R (3,3), seen in global ones."""
    half = np.empty((6, 6))
    for j in range(6):
        _out_of(R, own[:, j], half[:, j])
    for i in range(6):
        _out_of(R, half[i], out[i])


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
def _lean(rotation: Array) -> tuple[float, float, float, float]:
    """Lean about x and y rad, in axes that turn with the platform, and its yaw's cosine and sine.

    The rotation is a turn about z and then the shortest one that takes z to the body's axis.
    """
    up, level = rotation[0, 2, 2], sqrt(rotation[0, 0, 2] ** 2 + rotation[0, 1, 2] ** 2)
    share = atan2(level, up) / level if level > 0.0 else 1.0
    x, y = -share * rotation[0, 1, 2], share * rotation[0, 0, 2]
    yaw = atan2(rotation[0, 1, 0] - rotation[0, 0, 1], rotation[0, 0, 0] + rotation[0, 1, 1])
    c, s = cos(yaw), sin(yaw)
    return c * x + s * y, c * y - s * x, c, s


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _float_slope(C: Array, p: Array, own: Array, K: Array) -> None:
    """Stiffness (6,6) of linear buoyancy in axes that turn with the platform's yaw.

    ``p`` (6,) is the displacement and the lean, ``own`` (2,3) the load. A small turn u of the
    platform changes its lean by u + (1 - t / sin t) (lean x (lean x u)) / t^2 for a lean of t,
    and its yaw by u_z + tan(t / 2) / t (lean_y u_x - lean_x u_y).
    """
    x, y = p[3], p[4]
    lean = sqrt(x * x + y * y)
    across, yawing = -1.0 / 6.0, 0.5
    if lean > 1e-4:
        across, yawing = (1.0 - lean / sin(lean)) / lean**2, tan(0.5 * lean) / lean
    for i in range(6):
        half, k = i // 3, i % 3
        # by yaw, the place turns in these axes and the load with them
        by_yaw = C[i, 0] * p[1] - C[i, 1] * p[0]
        if k < 2:
            by_yaw += own[half, 1] if k == 0 else -own[half, 0]
        over = across * (C[i, 4] * x - C[i, 3] * y)
        for j in range(3):
            K[i, j] = C[i, j]
        K[i, 3] = C[i, 3] + over * y + yawing * y * by_yaw
        K[i, 4] = C[i, 4] - over * x - yawing * x * by_yaw
        K[i, 5] = by_yaw


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _float(C: Array, at_rest: Array, offset: Array, rotation: Array, load: Array, K: Array) -> None:
    """Linear buoyancy (6,) with its stiffness, global axes; it turns with the platform's own yaw.

    It has no memory, so a platform that leans and yaws leans to where it has turned.
    """
    p = np.zeros(6)
    p[3], p[4], c, s = _lean(rotation)
    shift = _turned(c, -s, offset, 0, offset, 0)
    own = np.zeros((2, 3))
    for i in range(3):
        p[i] = shift[i]
    for i in range(6):
        own[i // 3, i % 3] = at_rest[i]
        for j in range(6):
            own[i // 3, i % 3] -= C[i, j] * p[j]
    _float_slope(C, p, own, K)
    load[:] = _turned(c, s, own, 0, own, 1)
    _turn_block(c, s, K)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def add_up(
    position: Array, rotation: Array, velocity: Array, angular_velocity: Array,
    acceleration: Array, angular_acceleration: Array, c: float, s: float, axes: Array,
    reference: Array, matrices: Array, given: Array, wrench: Array,
    parts: Array, force: Array, moment: Array, blocks: Array,
) -> None:  # fmt: skip
    """Fill ``parts`` (7,6), the sum on top, ``force`` and ``moment`` (1,3), ``blocks`` (3,1,6,6).

    ``c`` and ``s`` are the heading's cosine and sine, ``axes`` (3,3) those of the mean lean.
    ``matrices`` (4,6,6) are stiffness, additional damping, added mass and radiation's damping,
    ``given`` (4,6) buoyancy at rest, radiation, excitation and drift. The buoyancy turns with
    the platform, excitation and drift are in the heading's axes, all others in ``axes``.
    ``wrench`` (6,) is another buoyancy in global axes.
    """
    offset = np.empty((1, 3))
    for k in range(3):
        offset[0, k] = position[0, k] - reference[k]
    v = seen_from(axes, velocity, angular_velocity)
    a = seen_from(axes, acceleration, angular_acceleration)
    own = np.zeros((3, 6))  # radiation, added mass, additional damping
    for i in range(6):
        own[0, i] = given[1, i]
        for j in range(6):
            own[0, i] -= matrices[3, i, j] * v[j]
            own[1, i] -= matrices[2, i, j] * a[j]
            own[2, i] -= matrices[1, i, j] * v[j]
    for k in range(3):
        _out_of(axes, own[k], parts[2 if k == 0 else 4 + k])
    _block_out_of(axes, matrices[1] + matrices[3], blocks[1, 0])
    _block_out_of(axes, matrices[2], blocks[2, 0])
    waves = given.reshape(8, 3)
    for k in range(2, 4):
        parts[k + 1] = _turned(c, s, waves, 2 * k, waves, 2 * k + 1)
    _float(matrices[0], given[0], offset, rotation, parts[1], blocks[0, 0])
    parts[1] += wrench
    parts[0] = parts[1]
    for k in range(2, 7):
        parts[0] += parts[k]
    for k in range(3):
        force[0, k], moment[0, k] = parts[0, k], parts[0, 3 + k]
