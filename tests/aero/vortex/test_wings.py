"""Plain wings: areas, angles, where the straight line is, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.wings import elliptic_wing, trapezoidal_wing, wing_corners
from galerna.errors import InputError


def test_a_rectangular_wing_lies_flat_with_its_suction_side_up() -> None:
    lattice = Lattice(trapezoidal_wing(10.0, 1.5, 4, 6))
    assert lattice.shape == (4, 6)
    assert lattice.area_vectors.sum((0, 1)) == pytest.approx([0.0, 0.0, 15.0])


def test_an_angle_of_attack_turns_every_section_about_its_quarter_chord() -> None:
    corners = trapezoidal_wing(10.0, 2.0, [0.0, 0.25, 1.0], 4, taper=0.5, sweep=0.3,
                               dihedral=0.1, angle_of_attack=0.2)  # fmt: skip
    flat = trapezoidal_wing(10.0, 2.0, [0.0, 0.25, 1.0], 4, taper=0.5, sweep=0.3, dihedral=0.1)
    assert corners[1] == pytest.approx(flat[1])
    chord = corners[2] - corners[0]
    assert -chord[:, 2] / chord[:, 0] == pytest.approx(np.tan(0.2) * np.ones(5))
    assert np.linalg.norm(chord, axis=1) == pytest.approx([1.0, 1.29289322, 2.0, 1.29289322, 1.0])
    y = np.abs(flat[1, :, 1])
    assert flat[1, :, 0] == pytest.approx(y * np.tan(0.3))
    assert flat[1, :, 2] == pytest.approx(y * np.tan(0.1))


def test_the_area_of_an_elliptic_wing_converges_at_second_order() -> None:
    def error(panels: int) -> float:
        area = Lattice(elliptic_wing(10.0, 1.0, 2, panels)).area_vectors[..., 2].sum()
        return abs(area - np.pi / 4 * 10.0)

    assert np.log2(error(20) / error(40)) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("line", [0.0, 0.25, 0.5, 1.0])
def test_the_straight_line_of_an_elliptic_wing_is_straight_at_an_angle(line: float) -> None:
    edges = [0.0, line, 1.0] if 0.0 < line < 1.0 else [0.0, 1.0]
    corners = elliptic_wing(10.0, 1.0, edges, 12, straight_line=line, angle_of_attack=0.1)
    row = corners[edges.index(line)]
    assert np.ptp(row[:, [0, 2]], axis=0) == pytest.approx([0.0, 0.0], abs=1e-14)


def test_camber_stands_on_the_chord() -> None:
    camber = np.array([[0.0, 0.0], [0.5, 0.1], [1.0, 0.0]])
    corners = trapezoidal_wing(4.0, 2.0, 2, 2, camber=camber)
    assert corners[:, 0, 2] == pytest.approx([0.0, 0.2, 0.0])


def test_wings_that_are_no_surface_are_refused() -> None:
    line = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    with pytest.raises(InputError, match="no area"):
        wing_corners(line, 0.0, 2)
    with pytest.raises(InputError, match=r"\(n\+1,3\)"):
        wing_corners(np.zeros((2, 2)), 1.0, 2)
    with pytest.raises(InputError, match="not a number"):
        wing_corners(line, [1.0, np.nan], 2)
    with pytest.raises(InputError, match="expected one value or 2"):
        wing_corners(line, [1.0, 1.0, 1.0], 2)
    with pytest.raises(InputError, match="less than 0"):
        wing_corners(line, -1.0, 2)
