"""Where a line at rest lies, for pictures."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array

from .catenary import Catenary, catenary
from .network import Found, Network


def line_shape(
    distance: float,
    rise: float,
    length: float,
    weight: float,
    stiffness: float,
    *,
    friction: float = 0.0,
    height: float | None = 0.0,
    count: int = 50,
) -> tuple[Array, Array]:
    """Places (count,2) m along a line from A, and above it, and its tension (count,) N.

    Arguments as of ``catenary``; the points are equally far apart in unstretched length. What
    rests of a slack line is drawn straight: where it lies is not known.
    """
    line = catenary(distance, rise, length, weight, stiffness, friction=friction, height=height)
    s = np.linspace(0.0, length, count)
    if line.resting <= 0.0:
        x, z, tension = _lifted(line.horizontal_a, line.vertical_a, s, weight, stiffness)
        return np.stack([x, z], axis=1), tension
    return _resting(line, s, distance, weight, stiffness, friction)


def _lifted(
    H: float, V: float, s: Array, weight: float, stiffness: float
) -> tuple[Array, Array, Array]:
    """x, z m and tension N at s m along a part that begins with H and V."""
    up = V + weight * s
    tension, start = np.hypot(H, up), np.hypot(H, V)
    z = (tension - start) / weight + s * (V + 0.5 * weight * s) / stiffness
    if H <= 0.0:
        return np.zeros_like(s), z, tension
    x = H / weight * (np.arcsinh(up / H) - np.arcsinh(V / H)) + H * s / stiffness
    return x, z, tension


def _resting(
    line: Catenary, s: Array, distance: float, weight: float, stiffness: float, friction: float
) -> tuple[Array, Array]:
    """The two lifted sides, and between them straight over the seabed what rests."""
    down, up = -line.vertical_a / weight, s[-1] - line.vertical_b / weight
    H = line.horizontal_b
    left = _lifted(H, line.vertical_a, np.clip(s, 0.0, down), weight, stiffness)
    foot = _lifted(H, line.vertical_a, np.array([0.0, down]), weight, stiffness)
    right = _lifted(H, 0.0, np.clip(s - up, 0.0, None), weight, stiffness)
    tail = _lifted(H, 0.0, np.array([0.0, s[-1] - up]), weight, stiffness)
    ground = np.clip((s - down) / (up - down), 0.0, 1.0)
    x = left[0] + right[0] + ground * (distance - foot[0][1] - tail[0][1])
    drag = friction * weight if down == 0.0 else 0.0
    on_bed = np.maximum(H - drag * (up - np.clip(s, down, up)), 0.0)
    tension = np.where(s < down, left[2], np.where(s > up, right[2], on_bed))
    return np.stack([x, left[1] + right[1]], axis=1), tension


def shape_in_space(network: Network, found: Found, line: int, count: int = 50) -> Array:
    """Places (count,3) m along a line of a network at rest, from the anchor's side."""
    first, second = found.points[network.ends[line]]
    away = second - first
    x = float(np.hypot(away[0], away[1]))
    length, weight, stiffness, friction = network.figures[line]
    flat, _ = line_shape(
        x, float(away[2]), length, weight, stiffness,
        friction=friction, height=float(first[2]) + network.depth, count=count,
    )  # fmt: skip
    along = away[:2] / x if x > 0.0 else np.zeros(2)
    return np.column_stack([first[:2] + flat[:, :1] * along, first[2] + flat[:, 1]])
