"""BeamDyn: the blade's reference axis and its 6x6 sections, already in galerna's axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.turbine.model import Array, SectionProperties
from galerna.turbine.openfast.deck import Deck
from galerna.units import DEG

STEEPEST = 5.0  #: metres sideways for one outwards
_DAMPING_NONE, _DAMPING_STIFFNESS, _DAMPING_MODAL = 0, 1, 2


@dataclass(frozen=True, eq=False)
class BeamBlade:
    """Reference axis (n,3) m at the fractions ``span`` (n,) of its length, and the sections."""

    span: Array
    axis: Array
    structure: SectionProperties


def read_beamdyn(deck: Deck, blade: Deck) -> BeamBlade:
    """Key points from BeamDyn's file, sections from its blade file."""
    table = deck.table("kp_total", "kp_xr", least=2)
    axis = np.stack([deck.column(table, f"kp_{c}r") for c in "xyz"], axis=1)
    twist = deck.column(table, "initial_twist") * DEG
    check_axis(deck, "kp_xr", axis)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(axis, axis=0), axis=1))])
    span = length / length[-1]
    stations, stiffness, inertia = _sections(blade)
    structure = SectionProperties(
        span=stations,
        stiffness=stiffness,
        inertia=inertia,
        twist=np.interp(stations, span, twist),
        **_damping(blade),
    )
    return BeamBlade(span, axis - axis[0], structure)


def check_axis(deck: Deck, header: str, points: Array) -> None:
    """Points (n,3) m of a blade go outwards, and sideways no more than steeply."""
    steps = np.diff(points, axis=0)
    wrong = np.abs(steps[:, :2]).max(axis=1) >= STEEPEST * steps[:, 2]
    if wrong.any():
        k = int(np.argmax(wrong))
        raise deck.error(
            f"the blade does not go outwards from point {k + 1} to {k + 2}",
            "",
            deck.header(header)[0],
        )


def _sections(deck: Deck) -> tuple[Array, Array, Array]:
    """Fractions (n,), stiffness and inertia (n,6,6): a number and two matrices a station."""
    count = deck.integer("station_total", low=2)
    line = _start_of_sections(deck)
    stations, matrices = [], []
    for k in range(count):
        what = f"station {k + 1} of {count}"
        at, line = deck.rows(line, 1, 1, what)
        stiffness, line = deck.rows(line, 6, 6, f"stiffness of {what}")
        inertia, line = deck.rows(line, 6, 6, f"mass matrix of {what}")
        _check(deck, stiffness, f"stiffness of {what}", line - 7)
        _check(deck, inertia, f"mass matrix of {what}", line)
        stations.append(at[0, 0])
        matrices.append((stiffness, inertia))
    span = np.array(stations)
    if abs(span[0]) > 1e-6 or abs(span[-1] - 1.0) > 1e-6 or (np.diff(span) <= 0.0).any():
        raise deck.error("the stations must ascend from 0 to 1")
    stacked = np.array(matrices)
    symmetric = (stacked + np.swapaxes(stacked, -1, -2)) / 2.0
    return np.clip(span, 0.0, 1.0), symmetric[:, 0], symmetric[:, 1]


def _check(deck: Deck, matrix: Array, what: str, line: int) -> None:
    """Symmetric to printing accuracy, with a positive diagonal."""
    size = np.abs(matrix).max()
    if np.abs(matrix - matrix.T).max() > 1e-3 * size:
        raise deck.error(f"{what} is not symmetric", "", line)
    if (np.diagonal(matrix)[:3] <= 0.0).any() or (np.diagonal(matrix) < 0.0).any():
        raise deck.error(f"{what} has a diagonal term that is not positive", "", line)


def _start_of_sections(deck: Deck) -> int:
    for line, text in enumerate(deck.lines, deck.first_line):
        if "distributed properties" in text.lower():
            return line
    raise deck.error("there is no line DISTRIBUTED PROPERTIES before the sections")


def _damping(deck: Deck) -> dict:
    """Stiffness-proportional factors s, or the ratio of the first mode."""
    kind = deck.integer("damp_type", _DAMPING_NONE)
    if kind == _DAMPING_STIFFNESS:
        rows, _ = deck.rows(deck.header("mu1")[0] + 1, 1, 6, "damping coefficients mu")
        return {"damping": rows[0]}
    if kind == _DAMPING_MODAL:
        return {"damping_ratio": deck.number("zeta", low=0.0)}
    return {}
