"""Damaged decks: the error names file, line and keyword, and nothing else ever comes out."""

from __future__ import annotations

import tempfile
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_deck import FILES, beamdyn_blade, edit, write_deck

from galerna.errors import InputError
from galerna.turbine import load
from galerna.turbine.model import Turbine

DAMAGES = {
    "missing file": ("small.fst", "parts/ed.dat", "parts/gone.dat", "EDFile", "there is no file"),
    "folder for a file": ("small.fst", "parts/ed.dat", "parts", "EDFile", "there is no file"),
    "itself": ("small.fst", "parts/ed.dat", "small.fst", "TipRad", "missing"),
    "misspelt keyword": ("parts/ed.dat", "HubRad ", "HubRda ", "HubRad", "did you mean 'HubRda'"),
    "no number": ("parts/ed.dat", "1.5   HubRad", "big   HubRad", "line 9", "finite number"),
    "not a number": ("parts/ed.dat", "1.5   HubRad", "NaN   HubRad", "HubRad", "finite number"),
    "infinite": ("parts/ed.dat", "1.5   HubRad", "1e999 HubRad", "HubRad", "finite number"),
    "negative": ("parts/ed.dat", "1.5   HubRad", "-1.5  HubRad", "HubRad", "at least 0"),
    "not whole": ("parts/ed.dat", "  3   NumBl", "2.5   NumBl", "NumBl", "whole number"),
    "no flag": ("parts/ed.dat", "False         PtfmSgDOF", "maybe PtfmSgDOF", "PtfmSg", "True or"),
    "blade inside the hub": ("parts/ed.dat", "  63   TipRad", "  1.2  TipRad", "TipRad", "larger"),
    "downwind": ("parts/ed.dat", "-5.0191   OverHang", "5.0191   OverHang", "line", "downwind"),
    "short table": ("parts/blade.dat", "5   NBlInpSt", "9   NBlInpSt", "BlFract", "found 5"),
    "endless table": ("parts/blade.dat", "5   NBlInpSt", "1D12 NBlInpSt", "BlFract", "found 5"),
    "missing column": ("parts/blade.dat", "FlpStff", "FlapStff", "FlpStff", "no column"),
    "word in a table": ("parts/blade.dat", "2.0000000E+09", "stiff", "line 12", "'stiff'"),
    "stations": ("parts/blade.dat", "7.5000000E-01  3", "4.5000000E-01  3", "BlFract", "ascend"),
    "no mass": ("parts/blade.dat", "1.0319000E+01", "0.0", "BMassDen", "positive"),
    "chord": ("parts/ad_blade.dat", "3.010E+00", "0.000E+00", "line 9", "BlChord"),
    "airfoil number": ("parts/ad_blade.dat", "3.010E+00          2", "3.010 3", "BlAFID", "1 to 2"),
    "airfoil list": ("parts/ad.dat", "2   NumAFfiles", "3   NumAFfiles", "NumAFfiles", "2 are"),
    "airfoil file": ("parts/ad.dat", "foils/wing.dat", "foils/wnig.dat", "AFNames", "no file"),
    "airfoil is AeroDyn": ("parts/ad.dat", "foils/wing.dat", "ad.dat", "NumTabs", "keyword Re"),
    "polar column": ("parts/ad.dat", "3   InCol_Cd", "0   InCol_Cd", "InCol_Cd", "needs"),
    "polar columns": ("parts/ad.dat", "4   InCol_Cm", "6   InCol_Cm", "polar", "6 numbers"),
    "polar range": ("parts/foils/wing.dat", " 180.00 ", " 170.00 ", "polar", "-180 to 170"),
    "polar order": ("parts/foils/wing.dat", "-20.00 ", "20.00 ", "polar", "ascend"),
    "polar length": ("parts/foils/wing.dat", "9   NumAlf", "99 NumAlf", "polar", "found 9"),
    "coordinates": ("parts/foils/wing_coords.txt", "12   Num", "40   Num", "coord", "found 12"),
    "tower": ("parts/tower.dat", "3   NTwInpSt", "-3   NTwInpSt", "NTwInpSt", "at least 2"),
    "tower height": ("parts/ed.dat", "87.6   TowerHt", "0   TowerHt", "TowerHt", "larger"),
    "AeroDyn 14": ("parts/ad.dat", "ADBlFile(1)", "BladeFile", "ad.dat", "AeroDyn 15"),
}


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    return write_deck(tmp_path)


@pytest.mark.parametrize("damage", DAMAGES)
def test_error_says_where_and_what(deck: Path, damage: str) -> None:
    file, old, new, where, what = DAMAGES[damage]
    edit(deck, file, old, new)
    with pytest.raises(InputError) as raised:
        load(deck)
    assert where in str(raised.value)
    assert what in str(raised.value)


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("3   station_total", "1e12   station_total", "found 0"),
        ("2.00000000E+10   0.00000000E+00", "-2.0E+10   0.0", "not positive"),
        ("1.00000000E+09   0.00000000E+00", "1.0E+09   5.0E+09", "not symmetric"),
        ("  0.500000", "  0.000000", "ascend"),
        ("DISTRIBUTED", "SCATTERED", "DISTRIBUTED PROPERTIES"),
        ("mu1 ", "nu1 ", "'mu1'"),
    ],
)
def test_damaged_beamdyn_blade(deck: Path, old: str, new: str, what: str) -> None:
    edit(deck, "small.fst", '"NA"              BDBldFile(1)', '"parts/bd.dat" BDBldFile(1)')
    edit(deck, "parts/bd_blade.dat", old, new)
    with pytest.raises(InputError, match=what):
        load(deck)


def test_damaged_controller_input(deck: Path) -> None:
    edit(deck, "parts/svd.dat", "0   PCMode", "5   PCMode")
    edit(deck, "parts/DISCON.IN", "2                   ! PC_GS_n", "3  ! PC_GS_n")
    with pytest.raises(InputError, match="PC_GS_angles has 2 values; PC_GS_n says 3"):
        load(deck)


def test_absurd_counts_take_no_memory(deck: Path) -> None:
    edit(deck, "small.fst", '"NA"              BDBldFile(1)', '"parts/bd.dat" BDBldFile(1)')
    (deck.parent / "parts/bd_blade.dat").write_text(beamdyn_blade("9" * 15))
    tracemalloc.start()
    with pytest.raises(InputError):
        load(deck)
    assert tracemalloc.get_traced_memory()[1] < 20e6
    tracemalloc.stop()


def test_binary_file(deck: Path) -> None:
    (deck.parent / "parts/ed.dat").write_bytes(bytes(range(256)) * 50)
    with pytest.raises(InputError, match="missing"):
        load(deck)


def test_endless_line(deck: Path) -> None:
    (deck.parent / "parts/ed.dat").write_text("1 " * 200_000)
    with pytest.raises(InputError, match="endless"):
        load(deck)


# any damage at all -----------------------------------------------------------------

WORDS = st.sampled_from(
    [
        *("", "NaN", "inf", "-1", "0", "1e12", "1e308", "-1D+300", "1.0+3", "99999999999999999999"),
        *("DEFAULT", "True", '"', "'", "@", "!", "-", "\x00", "é"),
        *("small.fst", "../..", "parts/ed.dat"),
    ]
)


@st.composite
def damaged(draw: st.DrawFn) -> tuple[str, bytes]:
    """One file of the deck with a line gone, doubled or swapped, a word replaced, or cut short."""
    name = draw(st.sampled_from(sorted(FILES)))
    lines = FILES[name].splitlines()
    for _ in range(draw(st.integers(1, 3))):
        if not lines:
            break
        i = draw(st.integers(0, len(lines) - 1))
        match draw(st.sampled_from(["drop", "double", "swap", "word", "word", "word", "cut"])):
            case "drop":
                del lines[i]
            case "double":
                lines.insert(i, lines[i])
            case "swap":
                j = draw(st.integers(0, len(lines) - 1))
                lines[i], lines[j] = lines[j], lines[i]
            case "word":
                words = lines[i].split()
                if words:
                    words[draw(st.integers(0, len(words) - 1))] = draw(WORDS)
                lines[i] = "  ".join(words)
            case "cut":
                lines = lines[:i]
    return name, "\n".join(lines).encode()


def numbers(turbine: Turbine) -> Iterator[np.ndarray]:
    shape, structure = turbine.blade.shape, turbine.blade.structure
    assert structure is not None
    assert turbine.tower.structure is not None
    yield from (shape.span, shape.chord, shape.twist, shape.leading_edge_offset)
    yield from (structure.stiffness, structure.inertia, turbine.blade.axis, turbine.tower.axis)
    yield from (turbine.tower.structure.stiffness, turbine.tower.diameter)
    for airfoil in turbine.airfoils.values():
        yield from (airfoil.polars[0].lift, airfoil.polars[0].drag, airfoil.polars[0].moment)
    yield np.array([turbine.hub_height, turbine.rotor_radius])


def read_or_refuse(changes: list[tuple[str, bytes]]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        fst = write_deck(Path(folder))
        edit(fst, "small.fst", '"NA"              BDBldFile(1)', '"parts/bd.dat" BDBldFile(1)')
        for name, content in changes:
            (fst.parent / name).write_bytes(content)
        try:
            turbine = load(fst)
        except InputError:
            return
        assert all(np.isfinite(values).all() for values in numbers(turbine))


@settings(max_examples=150, deadline=2000)
@given(damaged())
def test_damaged_decks_are_read_or_refused(change: tuple[str, bytes]) -> None:
    read_or_refuse([change])


@settings(max_examples=40, deadline=2000)
@given(st.sampled_from(sorted(FILES)), st.binary(max_size=400))
def test_files_of_anything_are_refused(name: str, content: bytes) -> None:
    read_or_refuse([(name, content)])
