"""The blade of a windIO file: axis, outer shape, airfoils along it, sections."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine.model import Airfoil, Array, Blade, BladeShape, SectionProperties
from galerna.turbine.windio import elastic
from galerna.turbine.windio.airfoils import blend_name, blend_weights, build_airfoil, read_airfoils
from galerna.turbine.windio.block import Block, merged_grid
from galerna.units import DEG

_THICKNESS_TOLERANCE = 0.02  # relative thickness: what resampling a blade may round off

_Curves = Mapping[str, tuple[Array, Array]]


def read_blade(
    document: Block, damping_ratio: float | None, notes: list[str]
) -> tuple[Blade, dict[str, Airfoil]]:
    """The blade, and the airfoils that stand along it by name."""
    block = document.block("components", "blade")
    axis_span, axis = reference_axis(block.block("reference_axis"))
    outer = block.block("outer_shape")
    placed, airfoils = _placed_airfoils(document, outer)
    shape = _shape(outer, placed)
    notes += _thickness_notes(shape, airfoils)
    structure = _structure(block, shape, damping_ratio, notes)
    return Blade(axis_span, axis, shape, structure), airfoils


def reference_axis(block: Block) -> tuple[Array, Array]:
    """Fractions (n,) and points (n,3) m of a reference axis."""
    curves = [block.curve(key) for key in ("x", "y", "z")]
    span = merged_grid(*(grid for grid, _ in curves))
    axis = np.stack([np.interp(span, *curve) for curve in curves], axis=1)
    if (np.diff(axis[:, 2]) <= 0.0).any():
        raise block.error("must rise all along: it goes from root to tip, or base to top", "", "z")
    return span, axis


def _shape(block: Block, placed: list[tuple[float, str]]) -> BladeShape:
    curves = {key: block.curve(key) for key in ("chord", "twist", "rthick", "section_offset_y")}
    if block.has("section_offset_x"):
        curves["section_offset_x"] = block.curve("section_offset_x")
    _check_shape(block, curves)
    span = merged_grid(*(grid for grid, _ in curves.values()))
    at_span = {key: np.interp(span, *curve) for key, curve in curves.items()}
    return BladeShape(
        span=span,
        chord=at_span["chord"],
        twist=at_span["twist"] * DEG,
        relative_thickness=at_span["rthick"],
        leading_edge_offset=at_span["section_offset_y"],
        normal_offset=at_span.get("section_offset_x", np.zeros_like(span)),
        airfoil_span=np.array([position for position, _ in placed]),
        airfoil_names=tuple(name for _, name in placed),
    )


def _check_shape(block: Block, curves: _Curves) -> None:
    grid, chord = curves["chord"]
    if (chord <= 0.0).any():
        i = int(np.argmin(chord))
        what = f"chord of {chord[i]:g} m at span {grid[i]:.4g}; it must be positive"
        raise block.error(what, "", "chord", "values")
    if np.abs(curves["twist"][1]).max() > 90.0:
        raise block.error("twist beyond 90 deg", "windIO v2 wants degrees", "twist", "values")
    thickness = curves["rthick"][1]
    if (thickness <= 0.0).any() or (thickness > 1.0).any():
        raise block.error("must lie above 0 and not above 1", "", "rthick", "values")


def _placed_airfoils(
    document: Block, outer: Block
) -> tuple[list[tuple[float, str]], dict[str, Airfoil]]:
    """Span and name of each airfoil along the blade, and the airfoils by name."""
    database = read_airfoils(document)
    thickness = outer.curve("rthick")
    placed: list[tuple[float, str]] = []
    airfoils: dict[str, Airfoil] = {}
    for entry in outer.blocks("airfoils"):
        name = entry.text("name")
        if name not in database:
            raise entry.error(f"unknown airfoil {name!r}", did_you_mean(name, database), "name")
        weights = blend_weights(entry)
        full_name = blend_name(name, weights)
        if full_name not in airfoils:
            airfoils[full_name] = build_airfoil(*database[name], weights, full_name)
        position = _position(entry, airfoils[full_name].relative_thickness, *thickness)
        if placed and position <= placed[-1][0]:
            raise entry.error(f"at {position:g}, inboard of the one before it ({placed[-1][0]:g})")
        placed.append((position, full_name))
    if not placed:
        raise outer.error("no airfoil stands along the blade", "", "airfoils")
    return placed, airfoils


def _thickness_notes(shape: BladeShape, airfoils: dict[str, Airfoil]) -> list[str]:
    """Notes on airfoils that stand where the blade is not as thick as they are."""
    along = np.interp(shape.airfoil_span, shape.span, shape.relative_thickness)
    own = np.array([airfoils[name].relative_thickness for name in shape.airfoil_names])
    return [
        f"airfoil {shape.airfoil_names[i]} is {own[i]:g} thick and stands at span "
        f"{shape.airfoil_span[i]:.3g}, where the blade is {along[i]:.3g} thick; the blade's "
        "thickness is followed"
        for i in np.flatnonzero(np.abs(along - own) > _THICKNESS_TOLERANCE)
    ]


def _position(entry: Block, thickness: float, grid: Array, along: Array) -> float:
    """Span of an airfoil: as given, or where the blade first becomes as thin as it."""
    if entry.has("spanwise_position"):
        return float(entry.number("spanwise_position", low=0.0, high=1.0))
    thin = np.flatnonzero(along <= thickness)
    if len(thin) == 0:
        what = f"the blade is nowhere as thin as this airfoil ({thickness:g})"
        raise entry.error(what, "give its spanwise_position")
    i = int(thin[0])
    if i == 0:
        return 0.0
    part = (along[i - 1] - thickness) / (along[i - 1] - along[i])
    return float(grid[i - 1] + part * (grid[i] - grid[i - 1]))


def _structure(
    blade: Block, shape: BladeShape, damping_ratio: float | None, notes: list[str]
) -> SectionProperties | None:
    """Section matrices in BeamDyn's axes; None, with a note, where the file lacks some."""
    if not blade.optional("structure").has("elastic_properties"):
        notes.append("blade: no elastic properties in the file, so it counts as rigid")
        return None
    block = blade.block("structure", "elastic_properties")
    if not elastic.is_complete(block):
        notes.append("blade: not all six section stiffnesses are given, so it counts as rigid")
        return None
    span, stiffness, inertia, damping = elastic.read_sections(block)
    edge_about_x = elastic.edge_is_about_x(span, stiffness)
    if edge_about_x != elastic.mass_center_is_along_y(span, inertia):
        notes.append(
            "blade sections: bending stiffness and mass centre disagree on which axis lies along "
            "the chord; the stiffness was followed"
        )
    if not edge_about_x:
        stiffness, inertia = elastic.exchanged(stiffness), elastic.exchanged(inertia)
        notes.append(
            "blade sections: K44 is the flapwise stiffness, so x lies along the chord as in "
            "windIO's text; x and y were exchanged to BeamDyn's axes"
        )
    twist = np.interp(span, shape.span, shape.twist)
    return SectionProperties(span, stiffness, inertia, twist, damping, damping_ratio)
