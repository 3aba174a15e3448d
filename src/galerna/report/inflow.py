"""Slices through the wind that a rotor meets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array, Inflow
from galerna.report.style import WIND_COLOURS, galerna_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

POINTS, TIMES = 61, 400  #: of a slice, each way


@dataclass(frozen=True)
class RotorCircle:
    """Where the rotor stands in the wind, m."""

    hub_height: float
    radius: float

    @property
    def lateral(self) -> Array:
        """Lateral positions (n,) m across the rotor."""
        return np.linspace(-self.radius, self.radius, POINTS)


def inflow_figure(
    wind: Inflow, rotor: RotorCircle, duration: float, at: float | None = None, name: str = ""
) -> Figure:
    """Wind speed downwind across the rotor at one time, and at hub height over time.

    ``at`` s is the time of the cross-section, half the ``duration`` s by default.
    """
    at = 0.5 * duration if at is None else at
    times = np.linspace(0.0, duration, TIMES)
    section, line = _cross_section(wind, rotor, at), _over_time(wind, rotor, times)
    with galerna_style():
        figure, axes = new_figure(1, 2, (10.0, 4.2), width_ratios=[1.0, 1.6])
        limits = {
            **_colour_limits(section, line),
            "cmap": WIND_COLOURS,
            "shading": "gouraud",
        }
        plane, strip = axes[0]
        heights = rotor.lateral + rotor.hub_height
        mesh = plane.pcolormesh(rotor.lateral, heights, section, **limits)
        _cut_to_rotor(plane, mesh, rotor)
        plane.set(title=f"Looking downwind at t = {at:g} s", xlabel="y [m]", ylabel="z [m]")
        strip.pcolormesh(times, rotor.lateral, line.T, **limits)
        title = f"At hub height, {rotor.hub_height:g} m"
        strip.set(title=title, xlabel="Time [s]", ylabel="y [m]")
        for ax in axes[0]:
            ax.grid(False)
        figure.colorbar(mesh, ax=axes[0], label="Wind speed along x [m/s]", fraction=0.03)
        figure.suptitle(f"Inflow: {name}" if name else "Inflow")
    return figure


def _colour_limits(*slices: Array) -> dict[str, float]:
    """The same colours for the same speed in all slices; half a m/s around a uniform wind."""
    low, high = min(s.min() for s in slices), max(s.max() for s in slices)
    room = max(0.5 - 0.5 * (high - low), 0.0)
    return {"vmin": float(low - room), "vmax": float(high + room)}


def _cross_section(wind: Inflow, rotor: RotorCircle, time: float) -> Array:
    """Downwind speed (z, y) m/s over the square around the rotor."""
    y, z = np.meshgrid(rotor.lateral, rotor.lateral + rotor.hub_height)
    points = np.column_stack([np.zeros(y.size), y.ravel(), z.ravel()])
    return wind.velocity(points, time)[:, 0].reshape(y.shape)


def _over_time(wind: Inflow, rotor: RotorCircle, times: Array) -> Array:
    """Downwind speed (time, y) m/s on the horizontal line through the hub."""
    y = rotor.lateral
    points = np.column_stack([np.zeros_like(y), y, np.full_like(y, rotor.hub_height)])
    return np.array([wind.velocity(points, float(t))[:, 0] for t in times])


def _cut_to_rotor(ax: Axes, mesh: QuadMesh, rotor: RotorCircle) -> None:
    """Show a cross-section within the rotor's circle only, left to the left looking downwind."""
    from matplotlib.patches import Circle

    circle = Circle((0.0, rotor.hub_height), rotor.radius, fill=False, lw=1.2, clip_on=False)
    ax.add_patch(circle)
    mesh.set_clip_path(circle)
    ax.set_aspect("equal")
    ax.invert_xaxis()
