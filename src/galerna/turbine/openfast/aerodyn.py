"""AeroDyn 15 and later: airfoils, blade nodes, what the tower shows the wind."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from galerna.turbine.model import Airfoil, Array
from galerna.turbine.openfast.airfoil import read_airfoil
from galerna.turbine.openfast.deck import Deck
from galerna.units import DEG

_POLAR_COLUMNS = {"Alfa": 1, "Cl": 2, "Cd": 3, "Cm": 4}
_MOST_COLUMNS = 20
_LARGEST_TWIST = 80.0  # deg


@dataclass(frozen=True, eq=False)
class BladeNodes:
    """Aerodynamic centres (n,3) m in root axes, chord (n,) m, twist (n,) rad, airfoil names (n,).

    AeroDyn's axes of the curve are galerna's: x downwind, y towards the trailing edge.
    """

    centers: Array
    chord: Array
    twist: Array
    airfoils: tuple[str, ...]


def read_airfoils(deck: Deck, notes: list[str]) -> tuple[dict[str, Airfoil], list[str]]:
    """Airfoils by name, and the name of each number that a blade node may give (from 1)."""
    columns = {
        key: deck.integer(f"InCol_{key}", default, 0, _MOST_COLUMNS)
        for key, default in _POLAR_COLUMNS.items()
    }
    for key in ("Alfa", "Cl", "Cd"):
        if not columns[key]:
            line = deck.entry(f"InCol_{key}").line
            raise deck.error(f"InCol_{key} is 0; galerna needs this column", "", line)
    airfoils: dict[str, Airfoil] = {}
    names: list[str] = []
    paths: dict[Path, str] = {}
    for text, line in deck.listed_files("NumAFfiles", "AFNames"):
        path = deck.beside(text)
        if path not in paths:
            name = paths[path] = _unused_name(path.stem, airfoils)
            file = deck.file_at(text, "AFNames", line)
            airfoils[name] = read_airfoil(file, name, columns, notes)
        names.append(paths[path])
    return airfoils, names


def read_blade_nodes(blade: Deck, airfoil_names: list[str]) -> BladeNodes:
    """The nodes of AeroDyn's blade file."""
    table = blade.table("NumBlNds", "BlSpn", least=2)
    span, curve, sweep, twist, chord, number = (
        blade.column(table, name)
        for name in ("BlSpn", "BlCrvAC", "BlSwpAC", "BlTwist", "BlChord", "BlAFID")
    )
    first_row = blade.header("BlSpn")[0] + 2
    for bad, what in (
        (chord <= 0.0, "BlChord must be positive"),
        ((number < 1) | (number > len(airfoil_names)), f"BlAFID must be 1 to {len(airfoil_names)}"),
        (number != np.floor(number), "BlAFID must be a whole number"),
        (np.abs(twist) > _LARGEST_TWIST, f"BlTwist must be within {_LARGEST_TWIST:g} deg"),
    ):
        if bad.any():
            row = int(np.argmax(bad))
            raise blade.error(what, f"at node {row + 1}", first_row + row)
    return BladeNodes(
        centers=np.stack([curve, sweep, span - span[0]], axis=1),
        chord=chord,
        twist=twist * DEG,
        airfoils=tuple(airfoil_names[int(k) - 1] for k in number),
    )


def read_tower_shape(deck: Deck, base: float, top: float) -> tuple[Array, Array, Array]:
    """Fractions (n,) of the tower, diameter (n,) m and drag coefficient (n,); zero where absent."""
    ends = np.array([0.0, 1.0])
    if deck.integer("NumTwrNds", 0) == 0:
        return ends, np.zeros(2), np.zeros(2)
    table = deck.table("NumTwrNds", "TwrElev")
    height, diameter, drag = (deck.column(table, key) for key in ("TwrElev", "TwrDiam", "TwrCd"))
    line = deck.header("TwrElev")[0]
    if (np.diff(height) <= 0.0).any():
        raise deck.error("TwrElev must ascend", "", line)
    if diameter.min() < 0.0 or drag.min() < 0.0:
        raise deck.error("TwrDiam and TwrCd must not be negative", "", line)
    places = (height - base) / (top - base)
    span = np.unique(np.concatenate([ends, places[(places > 0.0) & (places < 1.0)]]))
    return span, np.interp(span, places, diameter), np.interp(span, places, drag)


def read_nacelle_drag(deck: Deck) -> tuple[float, float, float]:
    """Drag coefficient times area m2 along x, y and z, where the deck counts it."""
    if not deck.flag("NacelleDrag", False):
        return (0.0, 0.0, 0.0)
    areas, drag = deck.numbers("NacArea", 3, low=0.0), deck.numbers("NacCd", 3, low=0.0)
    x, y, z = (a * c for a, c in zip(areas, drag, strict=True))
    return (x, y, z)


def _unused_name(stem: str, taken: dict[str, Airfoil]) -> str:
    """The file's stem, numbered where files in different folders share it."""
    count = sum(1 for name in taken if name == stem or name.startswith(f"{stem} ("))
    return f"{stem} ({count + 1})" if count else stem
