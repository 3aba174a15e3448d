"""The tower of a windIO file: given as a beam, or as a steel tube by its layers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from galerna.turbine import cross_section
from galerna.turbine.model import Array, SectionProperties, Tower
from galerna.turbine.windio import elastic
from galerna.turbine.windio.blade import reference_axis
from galerna.turbine.windio.block import Block, merged_grid
from galerna.turbine.windio.materials import material


def read_tower(document: Block, damping_ratio: float | None, notes: list[str]) -> Tower:
    """The tower from its base to the yaw bearing."""
    block = document.block("components", "tower")
    axis_span, axis = reference_axis(block.block("reference_axis"))
    outer = block.block("outer_shape")
    diameter, drag = outer.curve("outer_diameter"), outer.curve("cd", low=0.0)
    if (diameter[1] <= 0.0).any():
        raise outer.error("must be positive", "", "outer_diameter", "values")
    span = merged_grid(axis_span, diameter[0], drag[0])
    return Tower(
        axis_span=span,
        axis=np.stack([np.interp(span, axis_span, axis[:, i]) for i in range(3)], axis=1),
        diameter=np.interp(span, *diameter),
        drag_coefficient=np.interp(span, *drag),
        structure=_structure(document, block, diameter, damping_ratio, notes),
        extra_masses=_point_masses(block, axis_span, axis),
    )


def _structure(
    document: Block,
    tower: Block,
    diameter: tuple[Array, Array],
    damping_ratio: float | None,
    notes: list[str],
) -> SectionProperties | None:
    structure = tower.optional("structure")
    beam = structure.optional("elastic_properties")
    if beam.data and elastic.is_complete(beam):
        span, stiffness, inertia, damping = elastic.read_sections(beam)
    elif structure.has("layers"):
        span, stiffness, inertia = _tube(document, structure, diameter)
        mu = beam.optional("structural_damping")
        damping = mu.array("mu", 6, low=0.0) if mu.has("mu") else np.zeros(6)
        notes.append("tower: section matrices from the diameter and wall of its layers")
    else:
        notes.append("tower: not all six section stiffnesses are given, so it counts as rigid")
        return None
    return SectionProperties(span, stiffness, inertia, np.zeros_like(span), damping, damping_ratio)


def _tube(
    document: Block, structure: Block, diameter: tuple[Array, Array]
) -> tuple[Array, Array, Array]:
    """Span and section matrices of a round tube of layers, each inside the one before.

    Shear coefficient 2(1+nu)/(4+3nu) of a thin-walled tube: Cowper, J. Appl. Mech. 33, 1966.
    """
    layers = list(structure.blocks("layers"))
    walls = [layer.curve("thickness", low=0.0) for layer in layers]
    span = merged_grid(diameter[0], *(grid for grid, _ in walls))
    outer = np.interp(span, *diameter) / 2.0
    stiffness, inertia = np.zeros((len(span), 6, 6)), np.zeros((len(span), 6, 6))
    factor = structure.number("outfitting_factor", 1.0, 1.0)
    for layer, wall in zip(layers, walls, strict=True):
        inner = outer - np.interp(span, *wall)
        if (inner < 0.0).any():
            raise layer.error("is thicker than the tower's radius", "", "thickness")
        young, shear, density = material(document, layer)
        nu = young / (2.0 * shear) - 1.0
        area, second = np.pi * (outer**2 - inner**2), np.pi / 4.0 * (outer**4 - inner**4)
        transverse = 2.0 * (1.0 + nu) / (4.0 + 3.0 * nu) * shear * area
        stiffness += cross_section.stiffness_matrix(
            young * area, (young * second,) * 2, (transverse,) * 2, 2.0 * shear * second
        )
        mass, moment = factor * density * area, factor * density * second
        inertia += cross_section.inertia_matrix(
            mass, (0.0, 0.0), np.stack([moment, moment], axis=1)
        )
        outer = inner
    if (inertia[:, 0, 0] <= 0.0).any():
        raise structure.error("the layers leave a place without a wall", "", "layers")
    return span, stiffness, inertia


def _point_masses(tower: Block, axis_span: Array, axis: Array) -> tuple[tuple[float, float], ...]:
    beam = tower.optional("structure", "elastic_properties")
    if not beam.has("point_mass"):
        return ()
    points = beam.block("point_mass")
    grid = points.array("grid", low=0.0)
    heights = np.interp(grid, axis_span, axis[:, 2])
    return tuple(_pairs(heights, points.array("mass", len(grid), 0.0)))


def _pairs(heights: Array, masses: Array) -> Iterator[tuple[float, float]]:
    return ((float(h), float(m)) for h, m in zip(heights, masses, strict=True))
