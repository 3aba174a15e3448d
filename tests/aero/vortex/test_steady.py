"""Steady wings and rotors: theory, symmetry, other programs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from galerna.aero.vortex.ages import revolution_ages
from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.steady import SteadySolution, solve_steady
from galerna.aero.vortex.surface import Surface, collocation_normals, collocation_points
from galerna.aero.vortex.symmetry import RotationalSymmetry
from galerna.aero.vortex.wings import elliptic_wing, trapezoidal_wing
from galerna.errors import InputError
from galerna.units import RPM

WIND = np.array([10.0, 0.0, 0.0])
DENSITY = 1.225
SHARPY = Path(__file__).parents[3] / "validation" / "data" / "sharpy_nrel5mw_lattice.csv"


def elliptic(aspect_ratio: float, chordwise: int, spanwise: int, angle: float) -> SteadySolution:
    span = 0.25 * np.pi * aspect_ratio
    wing = elliptic_wing(
        span, 1.0, chordwise, spanwise, angle_of_attack=angle, spanwise_spacing="uniform"
    )
    return solve_steady([wing], WIND, density=DENSITY)


def coefficient(force: float, aspect_ratio: float) -> float:
    return force / (0.5 * DENSITY * 100.0 * (0.25 * np.pi) ** 2 * aspect_ratio)


def test_the_lift_of_slender_elliptic_wings_tends_to_the_lifting_line() -> None:
    angle = 0.02
    lacking = []
    for aspect_ratio in (6.366, 12.73, 25.46):
        line = 2.0 * np.pi * angle / (1.0 + 2.0 / aspect_ratio)
        lift = coefficient(elliptic(aspect_ratio, 2, 60, angle).lift, aspect_ratio)
        lacking.append(1.0 - lift / line)
    assert 0.0 < lacking[2] < 0.015
    assert lacking[0] > 2.0 * lacking[1] > 4.0 * lacking[2], "of an order above 1/aspect ratio"


def test_the_induced_drag_of_elliptic_wings_is_the_least_there_is() -> None:
    aspect_ratio = 6.366
    excess = []
    for spanwise in (20, 40, 80):
        flow = elliptic(aspect_ratio, 1, spanwise, 0.02)
        lift, drag = coefficient(flow.lift, aspect_ratio), coefficient(flow.drag, aspect_ratio)
        excess.append(drag * np.pi * aspect_ratio / lift**2 - 1.0)
    assert abs(excess[-1]) < 0.01
    assert 1.8 < excess[0] / excess[1] < 2.2, "first order in the width of the panels"
    assert 1.8 < excess[1] / excess[2] < 2.2


def test_the_drag_on_the_segments_is_that_of_the_far_wake() -> None:
    flow = elliptic(6.366, 1, 30, 0.01)
    first, last = flow.wake.vertices[0][0], flow.wake.vertices[0][-1]
    middle = 0.25 * (first[1:] + first[:-1] + last[1:] + last[:-1])
    wash = direct_velocity(flow.wake.sheets(), middle)
    across = np.cross(wash, np.diff(first, axis=0))[:, 0]
    trefftz = 0.5 * DENSITY * np.sum(flow.wake.circulation[0][0] * across)
    assert flow.drag == pytest.approx(trefftz, rel=1e-3)


def test_a_circular_wing_tends_to_kinners_lift() -> None:
    errors = []
    for panels in (6, 12, 24):
        wing = elliptic_wing(1.0, 1.0, panels, 2 * panels, straight_line=0.5, angle_of_attack=0.01)
        lift = solve_steady([wing], WIND, density=DENSITY).lift
        slope = lift / (0.5 * DENSITY * 100.0 * 0.25 * np.pi) / 0.01
        errors.append(slope / 1.790 - 1.0)  # Kinner 1937; Jordan 1971: 1.7900
    assert errors[2] < 0.025
    assert 1.7 < errors[0] / errors[1] < 2.3
    assert 1.7 < errors[1] / errors[2] < 2.3


def test_half_a_wing_at_a_mirror_is_the_half_of_a_wing() -> None:
    edges = np.array([-1.0, -0.8, -0.4, 0.0, 0.4, 0.8, 1.0])
    sections = np.stack([0.3 * np.abs(edges), 2.0 * edges, 0.1 * np.abs(edges)], axis=1)
    chordwise = np.array([0.0, 0.3, 1.0])[:, None, None] * [1.0, 0.0, -0.1]
    wing = sections + chordwise
    whole = solve_steady([wing], WIND)
    plane = MirrorPlane(np.zeros(3), np.array([0.0, 1.0, 0.0]))
    half = solve_steady([wing[:, 3:]], WIND, mirror=plane, ages=whole.wake.ages)
    assert half.circulation[0] == pytest.approx(whole.circulation[0][:, 3:], rel=1e-10)
    assert 2.0 * half.force[[0, 2]] == pytest.approx(whole.force[[0, 2]], rel=1e-10)
    probe = np.array([[3.0, 0.7, 0.2], [1.0, -0.4, 0.5]])
    assert half.velocity(probe) == pytest.approx(whole.velocity(probe), rel=1e-10)


def test_wind_on_a_wing_is_a_wing_that_flies() -> None:
    wing = trapezoidal_wing(5.0, 1.0, 3, 6, angle_of_attack=0.1, sweep=0.2)
    standing = solve_steady([wing], WIND)
    flying = Surface.at_rest(wing)
    flying.velocity[:] = -WIND
    moved = solve_steady([flying], np.zeros(3), wake_velocity=WIND, ages=standing.wake.ages)
    assert moved.force == pytest.approx(standing.force, rel=1e-12)


def test_no_flow_passes_through_the_surface_and_the_wind_comes_from_afar() -> None:
    wing = trapezoidal_wing(5.0, 1.0, 3, 6, angle_of_attack=0.1)
    flow = solve_steady([wing, wing + np.array([2.0, 0.0, 0.3])], WIND)
    points, normals = collocation_points(flow.surfaces), collocation_normals(flow.surfaces)
    assert np.abs(np.sum(flow.velocity(points) * normals, axis=1)).max() < 1e-10
    assert flow.velocity([-500.0, 0.0, 0.0]) == pytest.approx(WIND, abs=1e-4)


def test_wind_that_varies_along_the_span_acts_where_it_blows() -> None:
    wing = trapezoidal_wing(40.0, 1.0, 2, 40)

    def gust(points: np.ndarray) -> np.ndarray:
        up = np.where(points[:, 1] > 0.0, 0.5, 0.0)
        return np.stack([np.full(len(points), 10.0), np.zeros(len(points)), up], axis=1)

    flow = solve_steady([wing], gust, wake_velocity=WIND)
    strips = flow.loads[0].strip_force[:, 2]
    assert strips[30] > 10.0 * strips[10] > 0.0


@pytest.fixture(scope="module")
def rotor() -> tuple[list[np.ndarray], RotorAxis]:
    """Three plain blades about the x axis, which the wind turns as it does a turbine."""
    root = trapezoidal_wing(4.0, 0.6, 2, 5, angle_of_attack=0.12, taper=0.5)
    chord, span, normal = (root + np.array([0.0, 3.0, 0.0])).transpose(2, 0, 1)
    blade = np.stack([normal, chord, span], axis=2)
    axis = RotorAxis(np.array([1.0, 2.0, 3.0]), np.array([1.0, 0.0, 0.0]), 12.0)
    sectors = RotationalSymmetry(3, axis.direction, axis.origin)
    return sectors.images(axis.origin + blade), axis


def test_one_blade_stands_for_all_in_axial_flow(rotor) -> None:
    blades, axis = rotor
    ages = revolution_ages(axis.speed, 1.0, 20.0)
    one = solve_steady(blades, WIND, axis=axis, ages=ages)
    three = solve_steady(blades, WIND, axis=axis, ages=ages, symmetry=False)
    for a, b in zip(one.loads, three.loads, strict=True):
        assert a.corner_force == pytest.approx(b.corner_force, rel=1e-9, abs=1e-9)
    assert one.moment(axis.origin) == pytest.approx(three.moment(axis.origin), rel=1e-9, abs=1e-9)
    for a, b in zip(one.wake.vertices, three.wake.vertices, strict=True):
        assert a == pytest.approx(b, abs=1e-12)
    assert one.force[0] > 0.0
    assert one.moment(axis.origin)[0] > 0.0, "the wind drives it"


def test_a_row_of_the_wake_is_where_the_edge_was_and_the_wind_went(rotor) -> None:
    blades, axis = rotor
    ages = revolution_ages(axis.speed, 2.0, 30.0)
    flow = solve_steady(blades, WIND, axis=axis, ages=ages)
    turn = flow.wake.vertices[0]
    assert turn[12] == pytest.approx(turn[0] + ages[12] * WIND, abs=1e-10), "a revolution ago"
    before = flow.wake.vertices[2]  # a third of a turn behind in the order of rotation
    assert turn[4] == pytest.approx(before[0] + ages[4] * WIND, abs=1e-10)


def test_a_yawed_rotor_has_a_skewed_wake(rotor) -> None:
    blades, axis = rotor
    wind = 10.0 * np.array([np.cos(0.5), np.sin(0.5), 0.0])
    flow = solve_steady(blades, wind, axis=axis, ages=revolution_ages(axis.speed, 1.0, 15.0))
    assert flow.wake.vertices[1][24] == pytest.approx(
        flow.wake.vertices[1][0] + flow.wake.ages[24] * wind
    )
    forces = [load.force[0] for load in flow.loads]
    assert np.ptp(forces) > 0.01 * np.mean(forces)


@pytest.mark.parametrize("revolutions", [2, 7])
def test_rings_of_sharpy_have_its_circulation_and_forces(revolutions: int) -> None:
    table = np.genfromtxt(SHARPY, delimiter=",", names=True, skip_header=1)
    grid = (int(table["row"].max()) + 1, int(table["column"].max()) + 1)

    def field(*names: str) -> np.ndarray:
        return np.stack([table[name] for name in names], axis=1).reshape(*grid, len(names))

    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), 12.1 * RPM)
    corners = field("x_m", "y_m", "z_m")
    blades = [
        Surface.turning(c, axis.speed * axis.direction, rings="edges")
        for c in RotationalSymmetry(3, axis.direction, axis.origin).images(corners)
    ]
    ages = revolution_ages(axis.speed, revolutions, 5.0)
    flow = solve_steady(blades, [11.4, 0.0, 0.0], axis=axis, ages=ages, density=1.225)
    circulation = field(f"circulation_{revolutions}")[:-1, :-1, 0]
    force = field(*(f"force_{a}_{revolutions}" for a in "xyz"))
    assert np.abs(flow.circulation[0] - circulation).max() < 1e-5 * np.abs(circulation).max()
    apart = np.linalg.norm(flow.loads[0].corner_force - force, axis=2).max()
    assert apart < 1e-5 * np.linalg.norm(force, axis=2).max()


def not_a_number_at_a_corner():
    corners = trapezoidal_wing(5.0, 1.0, 1, 2)
    corners[0, 1, 2] = np.nan
    return corners


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"velocity": [1.0, 0.0]}, "velocity: expected three"),
        ({"velocity": [np.nan, 0.0, 0.0]}, "velocity: expected three"),
        ({"velocity": [0.0, 0.0, 0.0]}, "no wind"),
        ({"ages": [0.0, 2.0, 1.0]}, "rise from 0"),
        ({"ages": [0.5, 2.0]}, "rise from 0"),
        ({"surfaces": []}, "none"),
        ({"surfaces": [np.zeros((3, 3))]}, "corners must be"),
        ({"surfaces": [not_a_number_at_a_corner()]}, "surface 1: the corner in row 1, column 2"),
    ],
)
def test_what_cannot_be_used_is_named(changes, match) -> None:
    arguments = {"surfaces": [trapezoidal_wing(5.0, 1.0, 1, 2)], "velocity": WIND} | changes
    with pytest.raises(InputError, match=match):
        solve_steady(arguments.pop("surfaces"), arguments.pop("velocity"), **arguments)
