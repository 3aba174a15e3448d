"""The lattice of a turbine's blade in its section frames, ready to be placed by any motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.sections import BladeSections, airfoil_blend, blade_sections
from galerna.aero.vectors import cross_products
from galerna.aero.vortex.camber import CamberSource, airfoil_line, has_lift
from galerna.aero.vortex.checks import require_sound_lattice
from galerna.aero.vortex.spacing import given_edges, panel_edges
from galerna.contract import Array
from galerna.errors import InputError, did_you_mean
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Turbine

CAMBER_SOURCES = ("coordinates", "polar", "none")
LIFTING_SHARE = 0.5  #: of lifting airfoils in a section, from which on the lattice stands


@dataclass(frozen=True, eq=False)
class BladeLattice:
    """Panels (m,n) of one blade between columns that stand in its section frames.

    ``span`` (n+1,) are the fractions of the reference axis where the columns stand and
    ``bare_span`` (k+1,) the edges of the strips inboard of it, which carry polar forces but no
    vortices; its last is ``span[0]``, and (0,) stands for none. ``offsets`` (m+1,n+1,3) m are the
    corners in the frames of ``contract.Stations``: x to the suction side, y to the trailing
    edge, z to the tip. ``chord`` (k+n+1,) m and ``quarter_chord`` (k+n+1,3) m, in the frames,
    stand on all ``stations``. ``sections`` are the strips, bare ones first, at the middle
    between the stations, None where an airfoil has no polars. ``notes`` say where the camber
    line comes from the polar.
    """

    span: Array
    bare_span: Array
    offsets: Array
    chord: Array
    quarter_chord: Array
    sections: BladeSections | None
    notes: tuple[str, ...] = ()

    @property
    def stations(self) -> Array:
        """Fractions (k+n+1,) of the reference axis whose frames are needed, root to tip."""
        return np.concatenate([self.bare_span[:-1], self.span])

    @property
    def bare_strips(self) -> int:
        """Number k of strips without vortices; the lattice's frames come after so many others."""
        return max(len(self.bare_span) - 1, 0)

    def place(self, position: Array, rotation: Array) -> Array:
        """Corners (m+1,n+1,3) m from the columns' frames (n+1,3) m and (n+1,3,3)."""
        return position + np.einsum("nab,mnb->mna", rotation, self.offsets)

    def velocity(self, rotation: Array, velocity: Array, angular_velocity: Array) -> Array:
        """Velocity (m+1,n+1,3) m/s of the corners as the columns' frames move and turn."""
        arm = np.einsum("nab,mnb->mna", rotation, self.offsets)
        return velocity + cross_products(angular_velocity, arm)


def blade_lattice(
    turbine: Turbine,
    *,
    chordwise: int | ArrayLike = 8,
    spanwise: int | ArrayLike = 20,
    chordwise_spacing: str = "uniform",
    spanwise_spacing: str = "half_sine",
    camber: CamberSource = "coordinates",
    root_span: float | None = None,
) -> BladeLattice:
    """The lattice of a turbine's blade; twist, prebend and sweep come with the frames.

    ``chordwise`` and ``spanwise`` are numbers of panels or their edges: x/c from 0 to 1, and
    fractions of the reference axis from where the lattice begins to 1. It begins at
    ``root_span``, or where the blade begins to lift (``lifting_start``). ``camber`` as in
    ``camber.airfoil_line``. Raises InputError for edges, options or shapes that cannot be used.
    """
    if camber not in CAMBER_SOURCES:
        raise InputError("camber", f"{camber!r} is unknown", did_you_mean(camber, CAMBER_SOURCES))
    along = panel_edges("chordwise panels", chordwise, chordwise_spacing)
    span = _columns(turbine, spanwise, spanwise_spacing, root_span)
    bare = _bare_edges(span)
    stations = np.concatenate([bare[:-1], span])
    shape = turbine.blade.shape
    chord = np.interp(stations, shape.span, shape.chord)
    back = np.interp(stations, shape.span, shape.leading_edge_offset)
    normal = np.interp(stations, shape.span, shape.normal_offset)
    lattice = slice(len(bare) - 1, None)
    lines, notes = _camber_lines(turbine, span, camber, along)
    offsets = np.zeros((len(along), len(span), 3))
    offsets[..., 0] = normal[lattice] + lines * chord[lattice]
    offsets[..., 1] = np.outer(along, chord[lattice]) - back[lattice]
    quarter_chord = np.stack([normal, 0.25 * chord - back, np.zeros_like(chord)], axis=1)
    has_polars = all(turbine.airfoils[name].polars for name in shape.airfoil_names)
    middles = 0.5 * (stations[1:] + stations[:-1])
    sections = blade_sections(turbine, middles) if has_polars else None
    made = BladeLattice(span, bare, offsets, chord, quarter_chord, sections, notes)
    position, rotation = blade_frames(turbine.blade, span)
    require_sound_lattice(made.place(position, rotation), f"blade of {turbine.name!r}", span)
    return made


def lifting_start(turbine: Turbine) -> float:
    """Fraction of the reference axis outboard of which airfoils with lift hold half a section.

    Between a cylinder and the first airfoil that is midway in their blend. Raises InputError
    where no airfoil of the blade has lift.
    """
    shape = turbine.blade.shape
    grid = np.linspace(0.0, 1.0, 4001)
    thickness = np.interp(grid, shape.span, shape.relative_thickness)
    names, blend = airfoil_blend(shape, turbine.airfoils, grid, thickness)
    share = blend @ np.array([has_lift(turbine.airfoils[name]) for name in names], dtype=float)
    bare = np.flatnonzero(share < LIFTING_SHARE)
    if not len(bare):
        return 0.0
    inner = bare[-1]
    if inner == len(grid) - 1:
        raise InputError(f"blade of {turbine.name!r}", "the airfoil at the tip has no lift")
    step = (LIFTING_SHARE - share[inner]) / (share[inner + 1] - share[inner])
    return float(grid[inner] + step * (grid[inner + 1] - grid[inner]))


def _columns(
    turbine: Turbine, spanwise: int | ArrayLike, spacing: str, root_span: float | None
) -> Array:
    """Fractions (n+1,) of the reference axis at which the lattice's columns stand."""
    if np.ndim(spanwise):
        span = given_edges("spanwise panels", spanwise)
        if span[-1] != 1.0:
            raise InputError("spanwise panels", f"the edges end at {span[-1]:g}, not at the tip, 1")
        return span
    start = lifting_start(turbine) if root_span is None else float(root_span)
    if not 0.0 <= start < 1.0:
        raise InputError("root_span", f"expected a fraction from 0 to below 1, found {start:g}")
    span = start + (1.0 - start) * panel_edges("spanwise panels", spanwise, spacing)
    span[-1] = 1.0
    return span


def _bare_edges(span: Array) -> Array:
    """Edges (k+1,) of the strips from the root to the lattice, about as wide as its first panel."""
    start, width = span[0], span[1] - span[0]
    strips = int(np.ceil(start / width - 1e-9)) if start > 0.0 else 0
    return np.linspace(0.0, start, strips + 1) if strips else span[:1]


def _camber_lines(
    turbine: Turbine, span: Array, source: CamberSource, along: Array
) -> tuple[Array, tuple[str, ...]]:
    """Camber lines (m+1,n+1) in chords, blended along the span as the polars are."""
    shape = turbine.blade.shape
    thickness = np.interp(span, shape.span, shape.relative_thickness)
    names, blend = airfoil_blend(shape, turbine.airfoils, span, thickness)
    airfoils = [turbine.airfoils[name] for name in names]
    lines = np.stack([airfoil_line(airfoil, source, along) for airfoil in airfoils], axis=1)
    notes = tuple(
        f"airfoil {a.name!r} has no coordinates: its camber line is the parabola with the "
        "zero-lift angle of its polar"
        for a, share in zip(airfoils, blend.T, strict=True)
        if source == "coordinates" and a.camber is None and has_lift(a) and share.any()
    )
    return lines @ blend.T, notes
