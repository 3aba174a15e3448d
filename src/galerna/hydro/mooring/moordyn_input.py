"""MoorDyn v2's input file of a network of lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from galerna.errors import InputError
from galerna.turbine.platform import LineType

from .network import Network

SEGMENTS = 20  #: of a line
BED_STIFFNESS, BED_DAMPING = 3.0e6, 3.0e5  #: Pa/m, Pa s/m, of the OpenFAST regression tests
SEGMENT_DAMPING = -0.8  #: of a segment, below 0: as a share of the critical one
STABLE = 0.35  #: of the shortest time of a segment or of a node on the seabed
KINDS = {"fixed": "Fixed", "vessel": "Coupled", "connection": "Free"}


def input_text(network: Network, density: float, gravity: float, segments: int = SEGMENTS) -> str:
    """The file's text. Lines run from the anchor's side to the platform's."""
    return "\n".join(_rows(network, density, gravity, segments)) + "\n"


def _rows(network: Network, density: float, gravity: float, segments: int) -> Iterator[str]:
    mooring = network.mooring
    yield "MoorDyn input of galerna"
    yield "--- LINE TYPES ---"
    yield "Name Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx"
    yield "(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)"
    for i, line in enumerate(mooring.lines):
        weight = float(network.figures[i, 1])
        yield f"type{i + 1} {_line_type(line.line_type, weight, density, gravity)}"
    yield "--- POINTS ---"
    yield "ID Attachment X Y Z M V CdA Ca"
    yield "(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)"
    start = network.at(network.points).points
    for i, node in enumerate(mooring.nodes):
        place = " ".join(f"{x:.17g}" for x in start[i])
        yield f"{i + 1} {KINDS[node.kind]} {place} {node.mass:.10g} {node.volume:.10g} 0 0"
    yield "--- LINES ---"
    yield "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs"
    yield "(#) (-) (-) (-) (m) (-) (-)"
    for i, (first, second) in enumerate(network.ends):
        length = mooring.lines[i].length
        yield f"{i + 1} type{i + 1} {first + 1} {second + 1} {length:.17g} {segments} -"
    yield "--- OPTIONS ---"
    for name, value in _options(network, density, gravity, segments).items():
        yield f"{value:.12g} {name}"
    yield "--- OUTPUTS ---"
    yield "--- need this line ---"


def _line_type(kind: LineType, weight: float, density: float, gravity: float) -> str:
    """Figures of a type. Its diameter is that which gives its weight in water, and coefficients
    of drag and added mass are scaled with it, so that their forces stay."""
    area = (kind.mass - weight / gravity) / density
    if area <= 0.0:
        raise InputError(
            f"mooring, line type {kind.name!r}",
            f"{weight:g} N/m in water is more than its mass of {kind.mass:g} kg/m weighs",
        )
    diameter = float(np.sqrt(4.0 * area / np.pi))
    wide = kind.diameter / diameter
    figures = (
        diameter, kind.mass, kind.stiffness, SEGMENT_DAMPING, 0.0,
        kind.transverse_drag * wide, kind.transverse_added_mass * wide**2,
        kind.tangential_drag * wide, kind.tangential_added_mass * wide**2,
    )  # fmt: skip
    return " ".join(f"{figure:.12g}" for figure in figures)


def _options(network: Network, density: float, gravity: float, segments: int) -> dict[str, float]:
    return {
        "writeLog": 0,
        "disableOutput": 1,
        "disableOutTime": 1,
        "WtrDpth": network.depth,
        "g": gravity,
        "rhoW": density,
        "dtM": _time_step(network, segments),
        "kBot": BED_STIFFNESS,
        "cBot": BED_DAMPING,
        "dtIC": 1.0,
        "TmaxIC": 300.0,
        "CdScaleIC": 4.0,
        "threshIC": 1e-5,
    }


def _time_step(network: Network, segments: int) -> float:
    """A step s at which every segment's stretch and every resting node is stable."""
    shortest = np.inf
    for line in network.mooring.lines:
        kind, size = line.line_type, line.length / segments
        wave = size * np.sqrt(kind.mass / kind.stiffness)
        bed = kind.mass / (BED_DAMPING * kind.diameter)
        shortest = min(shortest, wave, bed, np.sqrt(kind.mass / (BED_STIFFNESS * kind.diameter)))
    return float(STABLE * shortest)
