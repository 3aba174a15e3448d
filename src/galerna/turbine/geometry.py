"""Where the sections of a blade are: reference frames along the undeflected axis."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from galerna.turbine.model import Array, Blade, Turbine


def axis_positions(axis_span: Array, axis: Array, span: Array) -> Array:
    """Points (n,3) m of a reference axis at the fractions ``span`` (n,)."""
    return np.stack([np.interp(span, axis_span, axis[:, i]) for i in range(3)], axis=1)


def axis_tangents(axis_span: Array, axis: Array, span: Array) -> Array:
    """Unit tangents (n,3) of a reference axis at the fractions ``span`` (n,)."""
    slope = PchipInterpolator(axis_span, axis).derivative()(span)
    return slope / np.linalg.norm(slope, axis=1, keepdims=True)


def section_rotations(tangent: Array, twist: Array) -> Array:
    """Section axes (n,3,3) as columns in root axes: tangent (n,3) along z, twisted about -z.

    At zero twist y keeps no component along the root's x, so a prebent blade's
    chord stays in the plane of the root's y and the tangent.
    """
    x = np.cross(np.array([0.0, 1.0, 0.0]), tangent)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(tangent, x)
    c, s = np.cos(twist)[:, None], np.sin(twist)[:, None]
    return np.stack([c * x - s * y, s * x + c * y, tangent], axis=2)


def blade_frames(blade: Blade, span: Array) -> tuple[Array, Array]:
    """Origins (n,3) m and section axes (n,3,3) of a blade at ``span`` (n,), in its root axes."""
    twist = np.interp(span, blade.shape.span, blade.shape.twist)
    tangent = axis_tangents(blade.axis_span, blade.axis, span)
    return axis_positions(blade.axis_span, blade.axis, span), section_rotations(tangent, twist)


def part_frames(turbine: Turbine, part: str, span: Array) -> tuple[Array, Array]:
    """Origins (n,3) m and axes (n,3,3) of a part's stations at ``span`` (n,), in its own axes.

    A tower's own axes are the global ones; a flexible spar's z points from still water to its
    keel; rigid bodies have all stations in their origin.
    """
    if part.startswith("blade"):
        return blade_frames(turbine.blade, span)
    aligned = np.tile(np.eye(3), (len(span), 1, 1))
    if part == "tower":
        return axis_positions(turbine.tower.axis_span, turbine.tower.axis, span), aligned
    if part == "spar" and turbine.platform is not None:
        return turbine.platform.draft * np.outer(span, [0.0, 0.0, 1.0]), aligned
    return np.zeros((len(span), 3)), aligned
