"""The built-in DTU 10 MW against figures published with it (Report-I-0092 and its HAWC2 model)."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from galerna.turbine import load
from galerna.turbine.geometry import blade_frames
from galerna.turbine.library import file
from galerna.turbine.model import Turbine
from galerna.turbine.summary import summary

DEG = np.pi / 180.0

# Rows of the HAWC2 structural file of the blade, in the half-chord axes of HAWC2.
STATION_R = 10.6503
STATION = {
    "m": 974.6284809, "x_cg": 0.0981146652, "y_cg": 0.0039630065, "pitch": -35.9093973106,
    "x_e": 0.136506314592, "y_e": 0.0080682858054, "x_sh": 0.290874188664, "y_sh": 0.067433683939,
    "E": 10162502747.9, "G": 1902067135.51, "A": 1.45915057456,
    "I_x": 3.522080876, "I_y": 4.32350116482, "I_p": 7.34445086056,
}  # fmt: skip
LENGTH_R = 86.366


@pytest.fixture(scope="module")
def turbine() -> Turbine:
    return load("dtu10mw")


@pytest.fixture(scope="module")
def station(turbine: Turbine) -> tuple[int, float]:
    """Index of the section, and how far the half chord lies behind the reference axis there."""
    s, shape = turbine.blade.structure, turbine.blade.shape
    assert s is not None
    k = int(np.argmin(np.abs(s.span - STATION_R / LENGTH_R)))
    chord, nose = (
        np.interp(s.span[k], shape.span, v) for v in (shape.chord, shape.leading_edge_offset)
    )
    return k, float(chord / 2 - nose)


def test_file_is_valid_windio() -> None:
    from windIO import validate

    validate(file("dtu10mw"), "turbine/turbine_schema")


def test_masses(turbine: Turbine) -> None:
    rows = {row.quantity: row for row in summary(turbine)}
    for quantity, tolerance in (
        ("blade_mass", 2e-3),  # the table is by length of the pitch axis, the axis is prebent
        ("hub_mass", 1e-6),
        ("nacelle_mass", 1e-4),
        ("tower_mass", 1e-4),
        ("rotor_inertia", 5e-3),  # HAWCStab2's beam is 0.15 % longer than its table
        ("hub_height", 1e-4),
    ):
        difference = rows[quantity].difference
        assert difference is not None
        assert abs(difference) < tolerance, quantity


def test_geometry(turbine: Turbine) -> None:
    """Root radius 2.8 m, tip at 88.934 m from the shaft (HAWCStab2), prebend 3.33 m upwind."""
    blade = turbine.blade
    assert turbine.hub.radius == 2.8
    assert_allclose(turbine.rotor_radius, 88.93427442, atol=2e-3)
    assert_allclose(blade.axis[-1], [-3.3315, 0.0, 86.3655], atol=1e-3)
    assert_allclose(blade.axis[:, 1], 0.0)
    assert_allclose(blade.shape.twist[[0, -1]] / DEG, [14.5, -3.42796], atol=1e-6)
    assert_allclose(turbine.nacelle.overhang, 7.1, atol=1e-5)
    assert_allclose(turbine.nacelle.tilt, 5 * DEG)
    assert_allclose(turbine.hub.cone, 2.5 * DEG)


def test_half_chord_line(turbine: Turbine) -> None:
    """The half-chord points of the HAWC2 file, turned into its axes: x = -y, y = x."""
    published = np.array([[-0.576634, -0.0180296, 18.2151], [-0.403180, -2.10743, 72.2261]])
    shape = turbine.blade.shape
    for x, y, z in published:
        span = np.interp(z, turbine.blade.axis[:, 2], turbine.blade.axis_span)
        origin, axes = blade_frames(turbine.blade, np.array([span]))
        chord, nose = (
            np.interp(span, shape.span, v) for v in (shape.chord, shape.leading_edge_offset)
        )
        half_chord = origin[0] + (chord / 2 - nose) * axes[0, :, 1]
        assert_allclose([-half_chord[1], half_chord[0], half_chord[2]], [x, y, z], atol=0.02)


def test_axial_force_at_the_elastic_centre_only_stretches(
    turbine: Turbine, station: tuple[int, float]
) -> None:
    k, behind = station
    stiffness = turbine.blade.structure.stiffness[k]
    x, y = STATION["y_e"], behind - STATION["x_e"]
    strain = np.linalg.solve(stiffness, np.array([0.0, 0.0, 1.0, y, -x, 0.0]) * 1e6)
    assert_allclose(strain[2], 1e6 / (STATION["E"] * STATION["A"]), rtol=1e-4)
    assert_allclose(strain[3:], 0.0, atol=1e-4 * strain[2])


def test_force_at_the_shear_centre_does_not_twist(
    turbine: Turbine, station: tuple[int, float]
) -> None:
    k, behind = station
    stiffness = turbine.blade.structure.stiffness[k]
    x, y = STATION["y_sh"], behind - STATION["x_sh"]
    torsion = STATION["G"] * STATION["I_p"]
    for fx, fy in ((1e6, 0.0), (0.0, 1e6)):
        strain = np.linalg.solve(stiffness, [fx, fy, 0.0, 0.0, 0.0, x * fy - y * fx])
        assert abs(strain[5]) < 1e-4 * 1e6 / torsion
    turned = np.linalg.solve(stiffness, [0.0, 0.0, 0.0, 0.0, 0.0, 1e6])
    assert_allclose(turned[5], 1e6 / torsion, rtol=1e-4)


def test_moment_about_a_principal_axis_bends_about_it(
    turbine: Turbine, station: tuple[int, float]
) -> None:
    """HAWC2's x axis is our -y; the principal axis stands at ``pitch`` from it about z."""
    stiffness = turbine.blade.structure.stiffness[station[0]]
    angle = STATION["pitch"] * DEG
    axis = np.array([np.sin(angle), -np.cos(angle), 0.0])
    strain = np.linalg.solve(stiffness, np.concatenate([np.zeros(3), 1e6 * axis]))
    expected = 1e6 * axis / (STATION["E"] * STATION["I_x"])
    assert_allclose(strain[3:], expected, atol=1e-4 * np.abs(expected).max())


def test_mass_centre(turbine: Turbine, station: tuple[int, float]) -> None:
    k, behind = station
    inertia = turbine.blade.structure.inertia[k]
    assert_allclose(inertia[0, 0], STATION["m"], rtol=1e-6)
    centre = inertia[1, 5] / inertia[0, 0], -inertia[0, 5] / inertia[0, 0]
    assert_allclose(centre, [STATION["y_cg"], behind - STATION["x_cg"]], atol=1e-4)


def test_sections_are_physical(turbine: Turbine) -> None:
    s = turbine.blade.structure
    assert s is not None
    assert np.linalg.eigvalsh(s.stiffness).min() > 0.0
    assert np.linalg.eigvalsh(s.inertia).min() > 0.0
    outboard = s.span > 0.2
    assert (s.stiffness[outboard, 3, 3] > s.stiffness[outboard, 4, 4]).all()  # edge above flap


def test_damping_is_three_per_cent_flapwise_and_edgewise(turbine: Turbine) -> None:
    """HAWCStab2's first collective flap and mean edge frequencies at 6 rpm, Hz.

    The htc file says that both are tuned to a logarithmic decrement of 3 %, 2 pi^2 f mu; its
    factors, first and second, only do so as those of the edgewise and the flapwise moment.
    """
    damping = turbine.blade.structure.damping
    flap, edge = 2 * np.pi**2 * np.array([0.645481, (0.829324 + 1.02974) / 2])
    assert_allclose(flap * damping[4], 0.03, rtol=0.1)
    assert_allclose(edge * damping[3], 0.03, rtol=0.1)


def test_airfoils(turbine: Turbine) -> None:
    """Each outline is as thick as its name says, and stands where the blade is."""
    shape = turbine.blade.shape
    for airfoil in turbine.airfoils.values():
        assert airfoil.coordinates is not None
        sides = airfoil.coordinates[:60], airfoil.coordinates[:58:-1]
        thickness = (sides[0][:, 1] - sides[1][:, 1]).max()
        assert_allclose(thickness, airfoil.relative_thickness, atol=5e-4)
        assert airfoil.polars[0].angle_of_attack[0] == -np.pi
    for span, name in zip(shape.airfoil_span, shape.airfoil_names, strict=True):
        along = np.interp(span, shape.span, shape.relative_thickness)
        assert_allclose(along, turbine.airfoils[name].relative_thickness, atol=2e-3)


def test_operation(turbine: Turbine) -> None:
    control = turbine.control
    assert_allclose(control.rated_rotor_speed * 30 / np.pi, 9.6)
    assert control.pitch_schedule is not None
    assert_allclose(control.pitch_schedule[0, 1:] * 50.0, [0.524485, 0.141233], rtol=1e-6)
    halved = np.interp(0.5, control.pitch_schedule[::-1, 1] / control.pitch_schedule[0, 1],
                       control.pitch_schedule[::-1, 0] / DEG)  # fmt: skip
    root = -693.22213 / 198.32888 / 2
    assert_allclose(halved, root + np.sqrt(root**2 + 693.22213), atol=0.1)


def test_publication_behind_every_block(turbine: Turbine) -> None:
    for block in ("blade.outer_shape", "blade.structure", "airfoils", "hub", "tower", "control"):
        assert "I-0092" in turbine.sources[block]
