"""Section stiffness and inertia: windIO's 21 + 7 columns to 6x6 matrices and back.

Axes are BeamDyn's, as in the files that WISDEM writes: x towards the suction
side, y towards the trailing edge. windIO's own text has the two the other way
round, so a file is judged by which bending stiffness is the flapwise one.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from galerna.turbine import cross_section
from galerna.turbine.model import Array, SectionProperties
from galerna.turbine.windio.block import Block, merged_grid

_COLUMNS = [(f"K{i + 1}{j + 1}", i, j) for i in range(6) for j in range(i, 6)]
_INERTIA = ("mass", "cm_x", "cm_y", "i_edge", "i_flap", "i_plr", "i_cp")
_SWAP = [1, 0, 2, 4, 3, 5]  # x and y exchanged


def is_complete(elastic: Block) -> bool:
    """Whether all six stiffnesses are given; 0, windIO's default, means that one is not."""
    stiffness, inertia = elastic.block("stiffness_matrix"), elastic.block("inertia_matrix")
    columns = [(stiffness, f"K{i}{i}") for i in range(1, 7)]
    columns.append((inertia, "mass"))
    return all(block.has(name) and block.array(name).any() for block, name in columns)


def read_sections(elastic: Block) -> tuple[Array, Array, Array, Array]:
    """Span (n,), stiffness (n,6,6), inertia (n,6,6) and damping (6,) s, in the file's axes.

    Raises InputError where a matrix is not positive definite.
    """
    blocks = elastic.block("stiffness_matrix"), elastic.block("inertia_matrix")
    grids = [block.grid() for block in blocks]
    stiffness, inertia = _stiffness(blocks[0], grids[0]), _inertia(blocks[1], grids[1])
    span = merged_grid(*grids)
    damping = np.zeros(6)
    if elastic.optional("structural_damping").has("mu"):
        damping = elastic.block("structural_damping").array("mu", 6, low=0.0)
    return span, _resample(span, grids[0], stiffness), _resample(span, grids[1], inertia), damping


def edge_is_about_x(span: Array, stiffness: Array) -> bool:
    """Whether bending about x is the stiffer, edgewise one: then x points to the suction side."""
    body = _body(span)
    return bool(np.median(stiffness[body, 3, 3] / stiffness[body, 4, 4]) >= 1.0)


def mass_center_is_along_y(span: Array, inertia: Array) -> bool:
    """Whether the mass centre lies further from the axis along y, as along a chord, than x."""
    distance = np.abs(cross_section.center_of_mass(inertia[_body(span)])).sum(axis=0)
    return bool(distance[1] >= distance[0])


def exchanged(matrix: Array) -> Array:
    """Section matrices (n,6,6) with the names of x and y exchanged."""
    return matrix[:, _SWAP][:, :, _SWAP]


def elastic_properties(sections: SectionProperties, twist: Array) -> dict[str, Any]:
    """windIO's ``elastic_properties`` of a beam, in BeamDyn's axes at the twist (n,) given."""
    turn = twist - sections.twist  # both positive about -z
    origin = np.zeros((len(turn), 2))
    stiffness = cross_section.at_reference(sections.stiffness, origin, turn)
    matrix = cross_section.at_reference(sections.inertia, origin, turn)
    center = cross_section.center_of_mass(matrix)
    columns = (matrix[:, 0, 0], *center.T, *(matrix[:, i, i] for i in (3, 4, 5)), -matrix[:, 3, 4])
    grid = sections.span.tolist()
    return {
        "stiffness_matrix": {"grid": grid}
        | {name: stiffness[:, i, j].tolist() for name, i, j in _COLUMNS},
        "inertia_matrix": {"grid": list(grid)}
        | {name: column.tolist() for name, column in zip(_INERTIA, columns, strict=True)},
        "structural_damping": {"mu": sections.damping.tolist()},
    }


def _body(span: Array) -> NDArray[np.intp]:
    """The stations that look like a blade: neither root nor tip, if there are such."""
    body = np.flatnonzero((span > 0.2) & (span < 0.9))
    return body if len(body) else np.arange(len(span))


def _stiffness(block: Block, grid: Array) -> Array:
    matrix = np.zeros((len(grid), 6, 6))
    for name, i, j in _COLUMNS:
        if i == j or block.has(name):
            matrix[:, i, j] = matrix[:, j, i] = block.array(name, len(grid))
    _check_diagonal(block, matrix, grid, "K", directions=6)
    _check_definite(block, matrix, grid, least_allowed=1e-12)
    return matrix


def _inertia(block: Block, grid: Array) -> Array:
    columns = {
        name: block.array(name, len(grid)) if block.has(name) else np.zeros(len(grid))
        for name in _INERTIA
    }
    center = np.stack([columns["cm_x"], columns["cm_y"]], axis=1)
    moments = np.stack([columns["i_edge"], columns["i_flap"]], axis=1)
    matrix = cross_section.inertia_matrix(columns["mass"], center, moments, columns["i_cp"])
    if block.has("i_plr"):
        matrix[:, 5, 5] = columns["i_plr"]
    _check_diagonal(block, matrix, grid, "M", directions=3)
    _check_definite(block, matrix, grid, least_allowed=-1e-9)  # a thin beam has no own inertia
    return matrix


def _check_diagonal(block: Block, matrix: Array, grid: Array, letter: str, directions: int) -> None:
    """The first ``directions`` diagonal terms must be positive, the others not negative."""
    diagonal = np.diagonal(matrix, axis1=1, axis2=2)
    wrong = np.where(np.arange(6) < directions, diagonal <= 0.0, diagonal < 0.0)
    if wrong.any():
        station, i = np.argwhere(wrong)[0]
        name = f"{letter}{i + 1}{i + 1}"
        what = f"diagonal term {name} is {diagonal[station, i]:g} at span {grid[station]:.4g}"
        raise block.error(what, "it must be positive")


def _check_definite(block: Block, matrix: Array, grid: Array, least_allowed: float) -> None:
    """No deformation may have negative energy: eigenvalues, each direction on its own scale."""
    diagonal = np.diagonal(matrix, axis1=1, axis2=2)
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    least = np.linalg.eigvalsh(matrix * scale[:, :, None] * scale[:, None, :])[:, 0]
    if (least < least_allowed).any():
        station = int(np.argmin(least))
        raise block.error(
            f"the 6x6 matrix at span {grid[station]:.4g} is not positive definite",
            "check the coupling terms and their signs",
        )


def _resample(span: Array, grid: Array, matrix: Array) -> Array:
    if np.array_equal(span, grid):
        return matrix
    flat = matrix.reshape(len(grid), 36)
    return np.stack([np.interp(span, grid, c) for c in flat.T], axis=1).reshape(-1, 6, 6)
