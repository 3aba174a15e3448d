"""One line at rest: textbook equations, published cases, tangents and limits in every regime."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from galerna.hydro.mooring import Catenary, catenary, line_shape

OC3 = (902.2, 698.094, 384.243e6)  # m, N/m, N
REGIMES = {  # distance, rise, friction, height of A above the seabed
    "rests": (848.67, 250.0, 0.0, 0.0),
    "rests with friction": (848.67, 250.0, 0.5, 0.0),
    "friction holds the anchor": (800.0, 250.0, 3.0, 0.0),
    "rests in its middle": (700.0, 60.0, 0.0, 130.0),
    "slack": (500.0, 250.0, 0.3, 0.0),
    "slack in its middle": (500.0, -40.0, 0.0, 160.0),
    "hangs above the seabed": (880.0, 250.0, 0.0, 0.0),
    "hangs without a seabed": (400.0, 100.0, 0.0, None),
    "taut": (600.0, 700.0, 0.0, 0.0),
    "downwards": (600.0, -100.0, 0.0, None),
    "on the seabed": (903.0, 0.0, 0.2, 0.0),
}


def textbook(line: Catenary, length: float, weight: float, stiffness: float, friction: float):
    """Distance and rise from the tensions: Jonkman (2007), eqs. 2-35 to 2-38; where a line rests in
    its middle, the sum of its two sides. Only for H > 0."""
    H, VA, VB = line.horizontal_b, line.vertical_a, line.vertical_b

    def lifted(V: float) -> float:
        return (np.hypot(H, V) - H) / weight + V * V / (2 * stiffness * weight)

    if line.resting <= 0.0:
        x = H / weight * (np.arcsinh(VB / H) - np.arcsinh(VA / H)) + H * length / stiffness
        z = (np.hypot(H, VB) - np.hypot(H, VA)) / weight
        return x, z + (VB**2 - VA**2) / (2 * stiffness * weight)
    x = line.resting + H / weight * (np.arcsinh(VB / H) + np.arcsinh(-VA / H))
    x += H * length / stiffness
    if friction > 0.0:
        loose = max(line.resting - H / (friction * weight), 0.0)
        x -= friction * weight / (2 * stiffness) * (line.resting**2 - loose**2)
    return x, lifted(VB) - lifted(VA)


@settings(max_examples=500, deadline=None)
@given(
    st.floats(0.0, 1.0), st.floats(-1.0, 1.0), st.floats(-0.5, 6.0), st.floats(0.0, 1.05),
    st.sampled_from([None, 0.0, 0.01, 0.3]), st.sampled_from([0.0, 0.3, 1.0]), st.booleans(),
)  # fmt: skip
def test_any_line_meets_the_textbook_equations(east, up, decades, chord, height, friction, floats):
    length, weight = 100.0, -50.0 if floats else 50.0
    stiffness = abs(weight) * length * 10.0**decades
    size = np.hypot(east, up)
    x, z = (length * chord * np.array([east, up]) / size) if size > 0 else (0.0, 0.0)
    if height is not None:
        height = length * height + (max(-z, 0.0) if height else 0.0)
        friction = friction if height == 0.0 else 0.0
        z = abs(z) if height == 0.0 else z
    line = catenary(x, z, length, weight, stiffness, friction=friction, height=height)
    found = [line.horizontal_a, line.vertical_a, line.horizontal_b, line.vertical_b]
    assert np.isfinite(found).all()
    assert np.isfinite(line.stiffness).all()
    lifted = weight * (length - line.resting)
    assert line.vertical_b - line.vertical_a == pytest.approx(lifted, rel=1e-9, abs=1e-9)
    if line.horizontal_b == 0.0:
        V = np.array([-line.vertical_a, line.vertical_b])
        heights = V / weight + V**2 / (2 * stiffness * weight)
        assert heights == pytest.approx([height, height + z], abs=1e-7)
        assert line.resting >= x - 1e-9
        return
    assert textbook(line, length, weight, stiffness, friction) == pytest.approx(
        (x, z), abs=2e-9 * length
    )


@settings(max_examples=300, deadline=None)
@given(st.floats(0.05, 1.02), st.floats(-1.4, 1.4), st.floats(0.0, 0.4))
def test_no_line_sinks_into_the_seabed(chord, angle, height):
    x, z = 100 * chord * np.cos(angle), 100 * chord * np.sin(angle)
    a = max(-z, 0.0) + 100 * height
    line = catenary(x, z, 100.0, 50.0, 1e6, height=a)
    if line.resting > 0.0 or line.vertical_a >= 0.0 or line.vertical_b <= 0.0:
        return
    H, V = line.horizontal_a, line.vertical_a
    assert (np.hypot(H, V) - H) / 50.0 + V * V / (2 * 1e6 * 50.0) <= a + 1e-9


@pytest.mark.parametrize("regime", REGIMES)
def test_tangent_is_the_slope_of_the_forces(regime):
    x, z, friction, height = REGIMES[regime]
    exact = catenary(x, z, *OC3, friction=friction, height=height).stiffness

    def forces(step: np.ndarray) -> np.ndarray:
        low = None if height is None else height + step[1]
        line = catenary(x + step[0], z + step[2] - step[1], *OC3, friction=friction, height=low)
        return np.array([line.horizontal_a, line.vertical_a, line.horizontal_b, line.vertical_b])

    anchored = height == 0.0  # A lies on the seabed: the forces have no slope over its height
    columns = [0, 2] if anchored else [0, 1, 2]
    if regime == "on the seabed":
        columns = [0]
    for column in columns:
        step = np.zeros(3)
        step[column] = 1e-4
        slope = (
            8 * (forces(step) - forces(-step)) - (forces(2 * step) - forces(-2 * step))
        ) / 12e-4
        assert exact[:, column] == pytest.approx(slope, rel=2e-7, abs=2e-7 * np.abs(exact).max())


def test_regimes_are_what_their_names_say():
    lines = {
        name: catenary(x, z, *OC3, friction=friction, height=height)
        for name, (x, z, friction, height) in REGIMES.items()
    }
    assert lines["friction holds the anchor"].horizontal_a == 0.0
    assert lines["rests with friction"].horizontal_a > 0.0
    resting = lines["rests with friction"]
    friction = 0.5 * OC3[1] * resting.resting
    assert resting.horizontal_b - resting.horizontal_a == pytest.approx(friction)
    assert lines["rests in its middle"].resting > 0.0 > lines["rests in its middle"].vertical_a
    assert lines["slack"].horizontal_b == 0.0 < lines["slack"].resting
    assert lines["hangs above the seabed"].vertical_a > 0.0 == lines["taut"].resting
    assert lines["on the seabed"].resting == OC3[0]


def test_slack_line_hangs_straight_down():
    line = catenary(0.0, 250.0, *OC3)
    length, weight, stiffness = OC3
    V = stiffness * (np.sqrt(1.0 + 2.0 * weight * 250.0 / stiffness) - 1.0)
    assert (line.horizontal_b, line.vertical_b) == (0.0, pytest.approx(V))
    assert line.resting == pytest.approx(length - V / weight)
    assert line.stiffness[3, 2] == pytest.approx(weight, rel=1e-3)


def test_vertical_tendon_is_a_spring():
    length, weight, stiffness = 200.0, 100.0, 1e8
    line = catenary(0.0, 200.5, length, weight, stiffness)
    middle = stiffness * 0.5 / length
    assert line.vertical_b == pytest.approx(middle + 0.5 * weight * length, rel=1e-9)
    assert line.vertical_a == pytest.approx(middle - 0.5 * weight * length, rel=1e-9)
    assert line.horizontal_b == pytest.approx(0.0, abs=1e-2)
    assert line.stiffness[3, 2] == pytest.approx(stiffness / length, rel=1e-9)
    # across: sum of ds / T along it, and stretch, for a line of tension V0 + w s
    ends = line.vertical_b, line.vertical_a
    across = np.log(ends[0] / ends[1]) / weight + length / stiffness
    assert line.stiffness[2, 0] == pytest.approx(1.0 / across, rel=1e-6)


def test_taut_light_line_is_a_spring():
    line = catenary(60.3, 80.4, 100.0, 1e-6, 1e6)
    assert line.tension_a == pytest.approx(1e6 * 0.005, rel=1e-8)
    assert line.horizontal_b / line.tension_b == pytest.approx(0.6, rel=1e-6)


def test_rest_on_the_seabed_with_friction():
    """Both ends down: the line stretches as far as friction lets the pull come."""
    length, weight, stiffness = 100.0, 50.0, 1e6
    pull = 2000.0  # spent on 40 m at a friction of 1
    x = length + pull**2 / (2.0 * weight * stiffness)
    line = catenary(x, 0.0, length, weight, stiffness, friction=1.0)
    assert (line.horizontal_b, line.horizontal_a) == (pytest.approx(pull), 0.0)
    assert catenary(99.0, 0.0, length, weight, stiffness).horizontal_b == 0.0


def test_buoyant_line_is_a_heavy_one_upside_down():
    heavy = catenary(80.0, 30.0, 100.0, 50.0, 1e6, height=None)
    light = catenary(80.0, -30.0, 100.0, -50.0, 1e6)
    assert light.horizontal_b == heavy.horizontal_b
    assert (light.vertical_a, light.vertical_b) == (-heavy.vertical_a, -heavy.vertical_b)


def test_forces_go_over_from_one_regime_to_the_next():
    """Through slack, resting and hanging in steps of 5 cm: none jumps, none falls."""
    pulls = np.array([catenary(x, 250.0, *OC3).horizontal_b for x in np.arange(640.0, 900.0, 0.05)])
    assert (np.diff(pulls) >= 0.0).all()
    stretched = OC3[2] / OC3[0]  # N/m: no line is stiffer
    assert np.diff(pulls).max() <= 0.05 * stretched


@pytest.mark.parametrize(("radius", "regime"), [(30.0, "rests"), (2.0, "hangs above the seabed")])
def test_work_around_a_loop_is_nothing_without_friction(radius, regime):
    x, z, _, height = REGIMES[regime]
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    work = 0.0
    scale = 0.0
    for t in angle:
        line = catenary(x - radius * (1 - np.cos(t)), z + radius * np.sin(t), *OC3, height=height)
        power = radius * (line.horizontal_b * np.sin(t) - line.vertical_b * np.cos(t))
        work += power * 2.0 * np.pi / len(angle)
        scale += abs(power) * 2.0 * np.pi / len(angle)
    assert abs(work) < 1e-9 * scale


MOORPY = (  # MoorPy, tests/test_catenary.py at 30b7fc4 (BSD-3): x, z, L, EA, w, CB -> its figures
    ((400, 200, 500.0, 7.51e12, 800.0, 5.0), (0.0, 0.0, 96643.43501616362, 237751.75997440016)),
    ((400, 200, 500.0, 7.51e12, 800.0, 0.1), (80418.60434855078, 0.0, 96643.42877136687,
                                              237751.75577183915)),
    ((400, 200, 500.0, 7.51e12, 200.0, None), (43694.580989249596, -22365.599350216216,
                                               43694.580989249596, 77634.40064978378)),
    ((37.96888656874307, 20.49078283711694, 100.0, 7.51e8, -881.0549577007893, None),
     (6428.437434537766, 53178.729367882406, 6428.437434537766, -34926.76640219652)),
)  # fmt: skip


@pytest.mark.parametrize(("given", "published"), MOORPY)
def test_moorpy_cases(given, published):
    x, z, length, stiffness, weight, friction = given
    height = None if friction is None else 0.0
    line = catenary(x, z, length, weight, stiffness, friction=friction or 0.0, height=height)
    found = line.horizontal_a, line.vertical_a, line.horizontal_b, line.vertical_b
    assert found == pytest.approx(published, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("regime", REGIMES)
def test_shape_runs_from_end_to_end_with_the_tensions_of_the_ends(regime):
    x, z, friction, height = REGIMES[regime]
    line = catenary(x, z, *OC3, friction=friction, height=height)
    points, tension = line_shape(x, z, *OC3, friction=friction, height=height, count=2001)
    assert points[0] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert points[-1] == pytest.approx([x, z], abs=1e-5)
    assert tension[[0, -1]] == pytest.approx([line.tension_a, line.tension_b], abs=1e-6)
    assert height is None or points[:, 1].min() >= -height - 1e-9
    if line.horizontal_b > 0.0:  # pieces are as long as their tension stretches them
        middle = 0.5 * (tension[1:] + tension[:-1])
        pieces = np.linalg.norm(np.diff(points, axis=0), axis=1)
        stretched = OC3[0] / 2000 * (1.0 + middle / OC3[2])
        close = pieces == pytest.approx(stretched, rel=1e-4)
        assert close or friction > 0.0
