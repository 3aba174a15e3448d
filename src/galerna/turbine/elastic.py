"""Section stiffness and inertia: windIO's 21 + 7 columns to 6x6 matrices and back.

Axes are BeamDyn's, as in the files that WISDEM writes: x towards the suction
side, y towards the trailing edge. windIO's own text has the two the other way
round, so a file is judged by which bending stiffness is the flapwise one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from galerna.turbine.airfoils import merged_grid
from galerna.turbine.block import Block
from galerna.turbine.model import Array, SectionProperties

_COLUMNS = [(f"K{i + 1}{j + 1}", i, j) for i in range(6) for j in range(i, 6)]
_INERTIA = ("mass", "cm_x", "cm_y", "i_edge", "i_flap", "i_plr", "i_cp")
_SWAP = [1, 0, 2, 4, 3, 5]  # x and y exchanged


def read_sections(elastic: Block) -> tuple[Array, Array, Array, Array]:
    """Span (n,), stiffness (n,6,6), inertia (n,6,6) and damping (6,) s of one beam, as in the file.

    Raises InputError where a matrix is not positive definite.
    """
    stiffness_block, inertia_block = (
        elastic.block(k) for k in ("stiffness_matrix", "inertia_matrix")
    )
    grids = stiffness_block.grid(), inertia_block.grid()
    stiffness = _stiffness(stiffness_block, grids[0])
    inertia = _inertia(inertia_block, grids[1])
    span = merged_grid(*grids)
    damping = np.zeros(6)
    if elastic.optional("structural_damping").has("mu"):
        damping = elastic.block("structural_damping").array("mu", 6, low=0.0)
    return span, _resample(span, grids[0], stiffness), _resample(span, grids[1], inertia), damping


def inertia_matrix(
    mass: Array, cm_x: Array, cm_y: Array, edge: Array, flap: Array, polar: Array, cross: Array
) -> Array:
    """Section inertia (n,6,6) about the reference axis from (n,) columns, as in BeamDyn.

    mass kg/m; centre of mass m; ``edge`` and ``flap`` kg m about x and y; ``polar`` about
    z; ``cross`` the product of inertia. Source: BeamDyn user's guide, section matrices.
    """
    matrix = np.zeros((len(mass), 6, 6))
    for i in range(3):
        matrix[:, i, i] = mass
    matrix[:, 0, 5] = -mass * cm_y
    matrix[:, 1, 5] = mass * cm_x
    matrix[:, 2, 3] = mass * cm_y
    matrix[:, 2, 4] = -mass * cm_x
    matrix[:, 3, 3], matrix[:, 4, 4], matrix[:, 5, 5] = edge, flap, polar
    matrix[:, 3, 4] = -cross
    lower = np.tril_indices(6, -1)
    matrix[:, lower[0], lower[1]] = matrix[:, lower[1], lower[0]]
    return matrix


def turned(matrix: Array, angle: Array) -> Array:
    """Section matrices (n,6,6) in axes turned by ``angle`` (n,) rad about +z."""
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    rotation = np.zeros((len(angle), 6, 6))
    block = np.array([[c, s, zero], [-s, c, zero], [zero, zero, zero + 1.0]]).transpose(2, 0, 1)
    rotation[:, :3, :3] = rotation[:, 3:, 3:] = block
    return rotation @ matrix @ rotation.transpose(0, 2, 1)


def edge_is_about_x(span: Array, stiffness: Array) -> bool:
    """Whether bending about x is the stiffer, edgewise one: then x points to the suction side."""
    body = (span > 0.2) & (span < 0.9)
    if not body.any():
        body[:] = True
    return bool(np.median(stiffness[body, 3, 3] / stiffness[body, 4, 4]) >= 1.0)


def mass_center_is_along_y(span: Array, inertia: Array) -> bool:
    """Whether the mass centre lies further from the axis along y, than along x."""
    body = (span > 0.2) & (span < 0.9)
    if not body.any():
        body[:] = True
    along_y, along_x = np.abs(inertia[body, 0, 5]), np.abs(inertia[body, 1, 5])
    return bool(along_y.sum() >= along_x.sum())


def exchanged(matrix: Array) -> Array:
    """Section matrices (n,6,6) with the names of x and y exchanged."""
    return matrix[:, _SWAP][:, :, _SWAP]


def section_columns(sections: SectionProperties) -> dict[str, Any]:
    """windIO's ``elastic_properties`` of a beam, in BeamDyn's axes."""
    grid = sections.span.tolist()
    stiffness = {name: sections.stiffness[:, i, j].tolist() for name, i, j in _COLUMNS}
    matrix = sections.inertia
    mass = matrix[:, 0, 0]
    columns = (
        mass,
        matrix[:, 1, 5] / mass,
        matrix[:, 2, 3] / mass,
        matrix[:, 3, 3],
        matrix[:, 4, 4],
        matrix[:, 5, 5],
        -matrix[:, 3, 4],
    )
    inertia = {name: column.tolist() for name, column in zip(_INERTIA, columns, strict=True)}
    return {
        "stiffness_matrix": {"grid": grid, **stiffness},
        "inertia_matrix": {"grid": grid, **inertia},
        "structural_damping": {"mu": sections.damping.tolist()},
    }


def _stiffness(block: Block, grid: Array) -> Array:
    matrix = np.zeros((len(grid), 6, 6))
    for name, i, j in _COLUMNS:
        if i == j or block.has(name):
            matrix[:, i, j] = matrix[:, j, i] = block.array(name, len(grid))
    _check_positive_definite(block, matrix, grid, "K")
    return matrix


def _inertia(block: Block, grid: Array) -> Array:
    n = len(grid)
    columns = [block.array(k, n) if block.has(k) else np.zeros(n) for k in _INERTIA]
    if not block.has("i_plr"):
        columns[5] = columns[3] + columns[4]
    matrix = inertia_matrix(*columns)
    _check_positive_definite(block, matrix, grid, "M")
    return matrix


def _check_positive_definite(block: Block, matrix: Array, grid: Array, letter: str) -> None:
    diagonal = np.diagonal(matrix, axis1=1, axis2=2)
    if (diagonal <= 0.0).any():
        station, i = np.argwhere(diagonal <= 0.0)[0]
        raise block.error(
            f"diagonal term {letter}{i + 1}{i + 1} is {diagonal[station, i]:g} at span "
            f"{grid[station]:.4g}; it must be positive"
        )
    scale = 1.0 / np.sqrt(diagonal)
    least = np.linalg.eigvalsh(matrix * scale[:, :, None] * scale[:, None, :])[:, 0]
    if (least <= 0.0).any():
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
