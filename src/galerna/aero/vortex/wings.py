"""Plain wings as lattice corners: x downstream, y along the span, z up; no turbine needed."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vortex.camber import mean_line
from galerna.aero.vortex.checks import require_sound_lattice
from galerna.aero.vortex.spacing import panel_edges
from galerna.contract import Array
from galerna.errors import InputError


def wing_corners(
    quarter_chord: ArrayLike,
    chord: ArrayLike,
    chordwise: int | ArrayLike,
    *,
    twist: ArrayLike = 0.0,
    camber: Array | None = None,
    spacing: str = "uniform",
) -> Array:
    """Corners (m+1,n+1,3) m of a wing from its sections, which stand in planes of constant y.

    ``quarter_chord`` (n+1,3) m with rising y; ``chord`` (n+1,) m; ``twist`` (n+1,) rad, nose up,
    about the quarter chord; ``camber`` (k,2) the mean line x/c, z/c, a flat plate without it;
    ``chordwise`` is a number of panels, spaced by ``spacing``, or their edges from 0 to 1.
    Raises InputError for sections or edges that make no sound lattice.
    """
    place = np.asarray(quarter_chord, dtype=float)
    if place.ndim != 2 or place.shape[1] != 3 or len(place) < 2:
        raise InputError("quarter_chord", f"expected (n+1,3), found {place.shape}")
    along = panel_edges("chordwise", chordwise, spacing)
    lift = np.zeros_like(along) if camber is None else mean_line(camber, along)
    chord, turn = _per_section("chord", chord, len(place)), _per_section("twist", twist, len(place))
    if np.any(chord < 0.0):
        raise InputError("chord", f"found {chord.min():g} m, less than 0")
    x, z = np.outer(along - 0.25, chord), np.outer(lift, chord)
    c, s = np.cos(turn), np.sin(turn)
    corners = place + np.stack([c * x + s * z, np.zeros_like(x), c * z - s * x], axis=2)
    require_sound_lattice(corners, "wing")
    return corners


def trapezoidal_wing(
    span: float,
    root_chord: float,
    chordwise: int | ArrayLike,
    spanwise: int | ArrayLike,
    *,
    taper: float = 1.0,
    sweep: float = 0.0,
    dihedral: float = 0.0,
    angle_of_attack: float = 0.0,
    camber: Array | None = None,
    spanwise_spacing: str = "cosine",
    chordwise_spacing: str = "uniform",
) -> Array:
    """Corners (m+1,n+1,3) m of a symmetric wing of ``span`` m from tip to tip.

    ``taper`` is tip over root chord; ``sweep`` rad, of the quarter-chord line, backwards and
    ``dihedral`` rad upwards; ``angle_of_attack`` rad turns every section about its quarter chord.
    Rectangular as it comes. Raises InputError as ``wing_corners``.
    """
    y = span * (panel_edges("spanwise", spanwise, spanwise_spacing) - 0.5)
    outboard = np.abs(y)
    quarter_chord = np.stack([outboard * np.tan(sweep), y, outboard * np.tan(dihedral)], axis=1)
    chord = root_chord * (1.0 - (1.0 - taper) * 2.0 * outboard / span)
    return wing_corners(
        quarter_chord,
        chord,
        chordwise,
        twist=angle_of_attack,
        camber=camber,
        spacing=chordwise_spacing,
    )


def elliptic_wing(
    span: float,
    root_chord: float,
    chordwise: int | ArrayLike,
    spanwise: int | ArrayLike,
    *,
    straight_line: float = 0.25,
    angle_of_attack: float = 0.0,
    camber: Array | None = None,
    spanwise_spacing: str = "cosine",
    chordwise_spacing: str = "uniform",
) -> Array:
    """Corners (m+1,n+1,3) m of a wing whose chord is an ellipse along the span, tip to tip.

    ``straight_line`` is the fraction of the chord on a straight line across: 0.25 the quarter
    chord, 0.5 an ellipse in plan, 1 a straight trailing edge. The sections end in points at
    the tips. The area is pi/4 span root_chord. Raises InputError as ``wing_corners``.
    """
    y = span * (panel_edges("spanwise", spanwise, spanwise_spacing) - 0.5)
    chord = root_chord * np.sqrt(np.maximum(1.0 - (2.0 * y / span) ** 2, 0.0))
    back = (0.25 - straight_line) * chord * np.cos(angle_of_attack)
    down = -(0.25 - straight_line) * chord * np.sin(angle_of_attack)
    return wing_corners(
        np.stack([back, y, down], axis=1),
        chord,
        chordwise,
        twist=angle_of_attack,
        camber=camber,
        spacing=chordwise_spacing,
    )


def _per_section(name: str, values: ArrayLike, sections: int) -> Array:
    array = np.asarray(values, dtype=float)
    if array.shape not in ((), (1,), (sections,)):
        raise InputError(name, f"expected one value or {sections}, found {array.shape}")
    return np.broadcast_to(array, sections)
