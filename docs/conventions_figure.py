"""Draw the axes and signs that galerna uses: ``python -m docs.conventions_figure``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Polygon

INK, WIND, TURN, BODY = "#1b2a41", "#2a7fb8", "#c8553d", "#8a97a6"
HERE = Path(__file__).parent

Place = Sequence[float] | np.ndarray  #: (2,) on the page


def point(place: Place) -> tuple[float, float]:
    x, y = place
    return float(x), float(y)


def arrow(
    ax: Axes,
    start: Place,
    end: Place,
    label: str = "",
    color: str = INK,
    offset: Place = (0.0, 0.0),
) -> None:
    """A labelled arrow; the label stands beside its head."""
    ax.annotate(
        "", point(end), point(start), arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.6}
    )
    if label:
        ax.text(end[0] + offset[0], end[1] + offset[1], label, color=color, ha="center",
                va="center", fontsize=10)  # fmt: skip


def turn(
    ax: Axes, center: Place, radius: float, start: float, end: float, label: str, at: Place
) -> None:
    """An arc from ``start`` to ``end`` deg with a head at its end: a positive angle."""
    low, high = min(start, end), max(start, end)
    ax.add_patch(
        Arc(point(center), 2 * radius, 2 * radius, theta1=low, theta2=high, color=TURN, lw=1.6)
    )
    angle, sense = np.radians(end), np.sign(end - start)
    tip = np.add(center, radius * np.array([np.cos(angle), np.sin(angle)]))
    back = tip - 0.02 * sense * np.array([-np.sin(angle), np.cos(angle)])
    ax.annotate(
        "", point(tip), point(back), arrowprops={"arrowstyle": "-|>", "color": TURN, "lw": 1.6}
    )
    ax.text(*point(at), label, color=TURN, fontsize=10, ha="center", va="center")


def wind(ax: Axes, x: float, heights: Sequence[float]) -> None:
    """Arrows of the wind, from the left."""
    for y in heights:
        arrow(ax, (x, y), (x + 0.45, y), color=WIND)
    ax.text(x + 0.2, max(heights) + 0.14, "wind", color=WIND, ha="center")


def side_view(ax: Axes) -> None:
    ax.set_title("From the side: tilt, cone, overhang", fontsize=11)
    ax.plot([0, 0], [-2.0, 0.0], color=BODY, lw=6, solid_capstyle="butt")
    tilt, cone, overhang = np.radians(8), np.radians(7), 0.75
    shaft = np.array([np.cos(tilt), -np.sin(tilt)])
    hub = np.array([0, 0.12]) - overhang * shaft
    ax.plot(*np.transpose([hub, hub + 1.15 * shaft]), color=BODY, lw=9, solid_capstyle="butt")
    ax.plot(*hub, "o", color=INK, ms=7)
    up = np.array([np.sin(tilt), np.cos(tilt)])
    for sign in (1, -1):
        blade = np.cos(cone) * sign * up - np.sin(cone) * shaft
        ax.plot(*np.transpose([hub, hub + 1.7 * blade]), color=INK, lw=3)
        ax.plot(*np.transpose([hub, hub + 1.7 * sign * up]), color=BODY, lw=1, ls=":")
    arrow(ax, hub + 0.55 * shaft, hub + 1.75 * shaft, "shaft axis", offset=(0.05, -0.12))
    turn(ax, (0, 0.12), 0.95, 0, -8, "tilt > 0", (1.28, 0.2))
    ax.plot([0, 1.25], [0.12, 0.12], color=BODY, lw=1, ls=":")
    turn(ax, hub, 1.35, 82, 89, "cone > 0", (hub[0] - 0.55, hub[1] + 1.45))
    arrow(ax, (0, -2.0), (0.7, -2.0), "x", offset=(0.1, 0))
    arrow(ax, (0, -2.0), (0, -1.3), "z", offset=(0.13, 0))
    wind(ax, -1.9, (-0.6, 0.0, 0.6))


def front_view(ax: Axes) -> None:
    ax.set_title("From upwind, looking downwind", fontsize=11)
    ax.plot([0, 0], [-2.0, 0.0], color=BODY, lw=6, solid_capstyle="butt")
    for number, azimuth in enumerate((0, 120, 240), 1):
        tip = 1.5 * np.array([np.sin(np.radians(azimuth)), np.cos(np.radians(azimuth))])
        ax.plot([0, tip[0]], [0, tip[1]], color=INK, lw=3)
        ax.text(*point(1.13 * tip), f"blade {number}", ha="center", va="center", fontsize=9)
    turn(ax, (0, 0), 0.8, 88, 35, "azimuth, rotor speed > 0", (1.15, 0.98))
    arrow(ax, (0, -2.0), (-0.7, -2.0), "y", offset=(-0.1, 0))
    arrow(ax, (0, -2.0), (0, -1.3), "z", offset=(0.13, 0))
    ax.text(0.12, -2.0, "x away from you", fontsize=9, va="center")


def top_view(ax: Axes) -> None:
    ax.set_title("From above: yaw and wind direction", fontsize=11)
    yaw = np.radians(30)
    shaft, right = np.array([np.cos(yaw), np.sin(yaw)]), np.array([np.sin(yaw), -np.cos(yaw)])
    hub = -0.5 * shaft
    ax.plot(*np.transpose([hub, hub + 1.1 * shaft]), color=BODY, lw=9, solid_capstyle="butt")
    ax.plot(*np.transpose([hub - 1.4 * right, hub + 1.4 * right]), color=INK, lw=3)
    low, high = hub + 1.42 * right + [0.1, -0.16], hub - 1.42 * right + [-0.1, 0.14]
    ax.text(*point(low), "azimuth 90°\n(downwind)", ha="center", va="top", fontsize=9)
    ax.text(*point(high), "azimuth 270°\n(upwind)", ha="center", fontsize=9)
    ax.plot([0, 1.6], [0, 0], color=BODY, lw=1, ls=":")
    turn(ax, (0, 0), 1.25, 0, 30, "nacelle yaw > 0", (1.6, 0.95))
    arrow(ax, (-1.5, -1.75), (-0.8, -1.75), "x", offset=(0.1, 0))
    arrow(ax, (-1.5, -1.75), (-1.5, -1.05), "y", offset=(0.13, 0))
    wind(ax, -1.9, (-0.35, 0.0, 0.35))
    ax.text(1.35, -0.75, "yaw error = nacelle yaw\n− wind direction, both\npositive about z (up)",
            fontsize=9, ha="center", va="center")  # fmt: skip


def section_view(ax: Axes) -> None:
    ax.set_title("A blade section, from the tip to the root", fontsize=11)
    # NACA 0018 with 4 % camber, leading edge towards -y
    s = 0.5 * (1 - np.cos(np.linspace(0, np.pi, 80)))
    half = 0.9 * (0.2969 * np.sqrt(s) - 0.126 * s - 0.3516 * s**2 + 0.2843 * s**3 - 0.1036 * s**4)
    camber = 0.16 * s * (1 - s)
    outline = np.concatenate(
        [np.stack([s - 0.3, camber + half], 1), np.stack([s - 0.3, camber - half], 1)[::-1]]
    )
    angle = np.radians(12)
    rotate = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    # On the page: right is -y of the root (direction of motion), up is downwind (+x of the root).
    page = 1.9 * (outline * [-1, 1]) @ rotate.T
    ax.add_patch(Polygon(page, facecolor="#dfe5ec", edgecolor=INK, lw=1.4))
    x_axis, y_axis = rotate @ [0, 1], rotate @ [-1, 0]
    arrow(ax, (0, 0), 0.95 * x_axis, "x suction side", offset=(0.25, 0.13))
    arrow(ax, (0, 0), 1.75 * y_axis, "y trailing edge", offset=(-0.1, 0.2))
    ax.plot(0, 0, "o", color=INK, ms=6)
    ax.text(0.12, -0.2, "z to the tip\n(towards you)", fontsize=9, va="top", ha="left")
    ax.plot([-2.0, 1.7], [0, 0], color=BODY, lw=1, ls=":")
    turn(ax, (0, 0), 1.45, 0, -12, "twist, pitch > 0\n(nose upwind)", (1.5, -0.75))
    arrow(ax, (0.35, -1.45), (1.3, -1.45), "blade moves", offset=(-0.3, -0.17))
    arrow(ax, (-1.6, -1.75), (-1.6, -1.05), color=WIND)
    ax.text(-1.45, -1.45, "wind", color=WIND)
    ax.set_xlim(-2.2, 2.2)


def draw() -> Path:
    """Draw the four views; the picture's path is returned."""
    figure, axes = plt.subplots(2, 2, figsize=(10, 9.6))
    for ax, view in zip(axes.flat, (side_view, front_view, top_view, section_view), strict=True):
        ax.set_aspect("equal")
        ax.set_xlim(-2.1, 2.1)
        ax.set_ylim(-2.25, 2.15)
        ax.axis("off")
        view(ax)
    figure.tight_layout()
    path = HERE / "figures" / "conventions.png"
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)
    return path


if __name__ == "__main__":
    print(draw())
