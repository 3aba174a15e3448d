"""Faults of lattices: each kind is found, named and placed; sound surfaces pass."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.checks import Fault, find_fault, require_sound_lattice
from galerna.aero.vortex.wings import elliptic_wing, trapezoidal_wing
from galerna.errors import InputError


def plate() -> np.ndarray:
    return trapezoidal_wing(6.0, 1.0, 4, 6, spanwise_spacing="uniform")


def test_sound_surfaces_have_no_fault() -> None:
    assert find_fault(plate()) is None
    assert find_fault(elliptic_wing(10.0, 1.0, 3, 20)) is None
    assert find_fault(trapezoidal_wing(6.0, 1.0, 4, 6, sweep=0.9, dihedral=0.7)) is None


def test_a_missing_number_is_found_at_its_corner() -> None:
    corners = plate()
    corners[2, 5, 1] = np.nan
    assert find_fault(corners) == Fault(2, 5, "has a coordinate that is not a number")


def test_a_panel_without_area_is_found() -> None:
    corners = plate()
    corners[:, 3] = corners[:, 4]
    fault = find_fault(corners)
    assert fault == Fault(0, 3, "has no area")


def test_sides_that_cross_are_found() -> None:
    corners = plate()
    corners[0, 2, 1] += 1.3  # beyond the next column, 1 m away
    assert find_fault(corners) == Fault(0, 2, "has sides that cross")


def test_a_surface_folded_onto_itself_is_found() -> None:
    corners = plate()
    corners[3:, :, 0] = 2.0 * corners[2, :, 0] - corners[3:, :, 0]
    corners[3:, :, 2] += 0.01
    assert find_fault(corners) == Fault(2, 0, "is folded onto its neighbour")


def test_a_surface_that_winds_through_itself_is_found() -> None:
    turn = np.linspace(0.0, 1.9 * np.pi, 30)
    radius = 1.0 + 0.3 * np.cos(turn)  # comes back through its first strip
    ring = np.stack([np.zeros(30), radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    corners = np.stack([ring, ring + np.array([1.0, 0.0, 0.0])])
    assert find_fault(corners) is None
    corners[:, -1, 2] = 0.5
    fault = find_fault(corners)
    assert fault is not None
    assert fault.what == "meets another part of the surface"


def test_the_error_names_surface_and_span() -> None:
    corners = plate()
    corners[:, 3] = corners[:, 4]
    with pytest.raises(InputError, match=r"blade2: the panel in row 1 at 50.0% to 66.7% of the sp"):
        require_sound_lattice(corners, "blade2", np.linspace(0.0, 1.0, 7))
    with pytest.raises(InputError, match="in row 1, column 4 has no area"):
        require_sound_lattice(corners, "wing")
    with pytest.raises(InputError, match=r"\(m\+1,n\+1,3\)"):
        require_sound_lattice(corners[0], "wing")


def test_only_a_thorough_check_looks_for_strips_that_pierce_others() -> None:
    corners = trapezoidal_wing(6.0, 1.0, 1, 12, spanwise_spacing="uniform")
    turn = np.linspace(0.0, 1.9 * np.pi, 13)
    corners[..., 1], corners[..., 2] = np.cos(turn), np.sin(turn)
    corners[:, -1, 1:] = 1.2, 0.6  # out through the first strip
    assert find_fault(corners, thorough=False) is None
    fault = find_fault(corners)
    assert fault is not None
    assert fault.what == "meets another part of the surface"
