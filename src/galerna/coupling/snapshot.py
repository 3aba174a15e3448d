"""The machine at one time, as its sensors read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numba import njit

from galerna.contract import Array, Channel
from galerna.structure.blocks import apply, apply_transposed, multiply3, multiply3_transposed
from galerna.structure.frames import hat, log_so3
from galerna.structure.pairs import Integers
from galerna.structure.system import State

Values = Mapping[str, float | Array]


@dataclass(frozen=True, eq=False, slots=True)
class Snapshot:
    """A state with what its pairs put on their frames, (m,12) in the axes of first and second.

    ``tower_loads`` (6,) is what load models put on the tower's first frame, in its axes.
    """

    state: State
    node_wrench: Array
    tower_loads: Array


def named(channels: tuple[Channel, ...], rows: Array) -> dict[str, float | Array]:
    """The rows (k,...) under the names of k channels; a row without dimensions is a number."""
    if rows.ndim == 1:
        return dict(zip((c.name for c in channels), rows.tolist(), strict=True))
    return {channel.name: row for channel, row in zip(channels, rows, strict=True)}


def turned(axes: Array, wrench: Array) -> Array:
    """Forces and moments (...,6) taken into axes whose columns (...,3,3) stand in theirs."""
    parts = wrench.reshape(*wrench.shape[:-1], 2, 3)
    return (parts @ axes).reshape(wrench.shape)


def about(wrench: Array, arm: Array) -> Array:
    """A wrench (6,) about a point that is ``arm`` (3,) away from its own."""
    return np.concatenate([wrench[:3], wrench[3:] - cross(arm, wrench[:3])])


@njit(cache=True)
def cross(a: Array, b: Array) -> Array:
    """Product (3,) of two vectors."""
    return apply(hat(a), b)


def true_acceleration(state: State, node: int) -> Array:
    """Acceleration (3,) m/s2 of a frame's origin in the frame's axes."""
    v, rate = state.velocity[node], state.acceleration[node]
    return rate[:3] + cross(v[3:], v[:3])


def interpolation(span: Array, stations: Array) -> Array:
    """Weights (stations, nodes) that interpolate linearly between nodes at ``span``."""
    return np.stack([np.interp(stations, span, row) for row in np.eye(len(span))], axis=1)


@njit(cache=True, error_model="numpy")
def displacements(x: Array, R: Array, nodes: Integers, x0: Array, R0: Array, axes: Array) -> Array:
    """Displacement m along ``axes`` (3,3) and rotation rad about the section's, (n,6).

    Of frames ``nodes`` (n,) against where they stood, x0 (n,3) and R0 (n,3,3), in the axes of
    the first one, which carries them all. ``axes`` stand in those of the first one too.
    """
    root = nodes[0]
    out = np.zeros((len(nodes), 6))
    for i in range(1, len(nodes)):
        node = nodes[i]
        moved = apply_transposed(R[root], x[node] - x[root]) - x0[i]
        out[i, :3] = apply_transposed(axes, moved)
        out[i, 3:] = log_so3(multiply3_transposed(multiply3(R[root], R0[i]), R[node]))
    return out


@njit(cache=True, error_model="numpy")
def distance_to_tower(point: Array, axis: Array, radius: Array) -> float:
    """Distance m from a point (3,) to the surface of a tower on the points ``axis`` (n,3)."""
    nearest = np.inf
    for i in range(len(axis) - 1):
        along = axis[i + 1] - axis[i]
        share = np.dot(point - axis[i], along) / np.dot(along, along)
        share = min(max(share, 0.0), 1.0)
        gap = point - axis[i] - share * along
        thickness = radius[i] + share * (radius[i + 1] - radius[i])
        nearest = min(nearest, np.sqrt(np.dot(gap, gap)) - thickness)
    return nearest
