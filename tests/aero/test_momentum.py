"""The momentum balance of one strip: closure, limits, and an answer to every wind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from galerna import turbine
from galerna.aero.bem.momentum import (
    HIGH_THRUST,
    SLOWEST,
    Momentum,
    balance,
    prandtl_loss,
    slowness,
    solve_strip,
)
from galerna.aero.bem.options import BemOptions
from galerna.aero.sections import blade_sections, section_coefficients


@pytest.fixture(scope="module")
def table():
    return blade_sections(turbine.load("nrel5mw")).table


def constant_section(lift, drag):
    """A polar that has the same coefficients at every angle."""
    return np.tile(np.array([lift, drag, 0.0]), (1, 721, 1))


def strip(solidity=0.05, tip=5.0, root=5.0, mirror=1.0):
    return solidity, solidity, tip, root, mirror, 0.0


SWITCHES = Momentum.of(BemOptions(), 3)
NO_LOSS = Momentum.of(BemOptions(tip_loss=False, root_loss=False), 3)


def buhl(a, loss):
    if a <= 0.4:
        return 4.0 * a * loss * (1.0 - a)
    return 8 / 9 + (4 * loss - 40 / 9) * a + (50 / 9 - 4 * loss) * a**2


def glauert(a, loss):
    return loss * (4.0 * a * (1.0 - a) if a <= 0.4 else buhl(a, 1.0))


def wilson_walker(a, loss):
    return 4.0 * loss * (a * (1.0 - a) if a <= 0.2 else 0.04 + 0.6 * a)


def madsen(a, loss):
    """C_T of an induction, by inverting the polynomial."""
    real = [x.real for x in np.roots([0.0883, 0.0586, 0.2460, -a]) if abs(x.imag) < 1e-9]
    return loss * max(real)


CURVES = {"madsen": madsen, "buhl": buhl, "glauert": glauert, "wilson_walker": wilson_walker}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("loss", [1.0, 0.8, 0.4])
def test_thrust_and_induction_close_on_the_published_curve(name, loss):
    for sine in (0.02, 0.1, 0.5):
        for load in np.geomspace(1e-4, 1.0, 25):
            ratio = 1.0 / slowness(load, loss, sine, HIGH_THRUST[name])
            induction = 1.0 - ratio * sine
            thrust = 4.0 * loss * load * ratio**2  # sigma Cn (W/U)^2
            assert thrust == pytest.approx(CURVES[name](induction, loss), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", CURVES)
def test_thrust_curve_passes_smoothly_where_the_flow_reverses(name):
    load = 0.02
    angles = np.linspace(-0.03, 0.03, 601)
    ratio = np.array([1.0 / slowness(load, 1.0, np.sin(x), HIGH_THRUST[name]) for x in angles])
    assert np.all(np.isfinite(ratio))
    assert np.abs(np.diff(ratio, 2)).max() < 2e-3 * ratio.max()
    induction = 1.0 - ratio * np.sin(angles)
    assert induction[0] > 1.0 > induction[-1]


def test_no_load_means_no_induction():
    angle, induced, swirl, _, _ = solve_strip(
        0.3, constant_section(0.0, 0.0), 0, 0.0, 8.0, 40.0, strip(), SWITCHES
    )
    assert angle == pytest.approx(np.arctan2(8.0, 40.0), abs=1e-8)
    assert (induced, swirl) == pytest.approx((0.0, 0.0), abs=1e-7)


def test_betz_is_the_most_that_a_lightly_swirling_strip_gives():
    """Local power coefficient a strip can reach at a high speed ratio without drag: 16/27."""
    best = 0.0
    for solidity in np.geomspace(1e-4, 2e-2, 60):
        for lift in np.linspace(0.2, 1.5, 14):
            x = 30.0  # local speed ratio
            section = constant_section(lift, 0.0)
            angle, induced, swirl, _, _ = solve_strip(
                0.05, section, 0, 0.0, 1.0, x, strip(solidity), NO_LOSS
            )
            square = (1.0 - induced) ** 2 + (x + swirl) ** 2
            best = max(best, solidity * lift * np.sin(angle) * square * x)
    assert 0.99 * 16 / 27 < best < 16 / 27


def test_momentum_and_blade_element_agree_in_thrust_and_torque(table):
    for normal, tangential, pitch in ((8.0, 40.0, 0.06), (12.0, 30.0, 0.1), (6.0, 60.0, 0.0)):
        angle, induced, swirl, loss, _ = solve_strip(
            0.2, table, 12, pitch, normal, tangential, strip(0.03), SWITCHES
        )
        across, along = normal - induced, tangential + swirl
        assert np.arctan2(across, along) == pytest.approx(angle, abs=1e-6)
        lift, drag, _ = section_coefficients(table, 12, angle - pitch)
        square = across**2 + along**2
        thrust = 0.03 * (lift * np.cos(angle) + drag * np.sin(angle)) * square / normal**2
        assert thrust == pytest.approx(buhl(induced / normal, loss), rel=1e-6)
        torque = 0.03 * (lift * np.sin(angle) - drag * np.cos(angle)) * square
        if induced / normal < 0.4:
            assert torque == pytest.approx(4.0 * loss * swirl * across, rel=1e-6)


def test_prandtl_factor():
    assert prandtl_loss(10.0, 0.1) == pytest.approx(1.0)
    assert prandtl_loss(0.0, 0.1) == 0.0
    assert prandtl_loss(0.5, 0.2) == pytest.approx(2 / np.pi * np.arccos(np.exp(-2.5)), rel=1e-9)


def test_wind_from_behind_mirrors(table):
    """A symmetric section in reversed wind has the reversed induction."""
    angle = np.linspace(-np.pi, np.pi, 721)
    plate = np.stack([np.sin(2 * angle), 0.01 + np.sin(angle) ** 2, 0 * angle], axis=1)[None]
    front = solve_strip(0.2, plate, 0, 0.0, 8.0, 30.0, strip(), SWITCHES)
    behind = solve_strip(0.2, plate, 0, 0.0, -8.0, 30.0, strip(mirror=-1.0), SWITCHES)
    assert behind[1] == pytest.approx(-front[1], rel=1e-7)
    assert behind[2] == pytest.approx(front[2], rel=1e-7)


SPEED = st.floats(-60.0, 60.0)


@settings(max_examples=600, deadline=None)
@given(
    normal=SPEED,
    tangential=st.floats(-120.0, 120.0),
    pitch=st.floats(-np.pi, np.pi),
    station=st.integers(0, 18),
    solidity=st.floats(1e-3, 0.6),
    tip=st.floats(0.0, 20.0),
    root=st.floats(0.0, 20.0),
    curve=st.sampled_from(sorted(HIGH_THRUST)),
    drag=st.booleans(),
    guess=st.floats(-10.0, 10.0),
)
def test_every_wind_speed_and_pitch_has_an_answer(
    table, normal, tangential, pitch, station, solidity, tip, root, curve, drag, guess
):
    options = BemOptions(
        high_thrust=curve, drag_in_axial_induction=drag, drag_in_tangential_induction=drag
    )
    switches = Momentum.of(options, 3)
    mirror = 1.0 if normal >= 0.0 else -1.0
    entry = strip(solidity, tip, root, mirror)
    angle, induced, swirl, loss, evaluations = solve_strip(
        guess, table, station, pitch, normal, tangential, entry, switches
    )
    assert np.all(np.isfinite([angle, induced, swirl]))
    assert 0.0 < loss <= 1.0
    assert evaluations < 100
    at, before, after = (
        balance(
            angle + step,
            table,
            station,
            pitch,
            max(abs(normal), SLOWEST),
            tangential,
            entry,
            switches,
        )[0]
        for step in (0.0, -1e-13, 1e-13)
    )
    assert abs(at) < 1e-9 or before * after <= 0.0


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("pitch", [0.0, 0.35])
def test_thrust_has_no_jump_where_the_wind_turns(table, name, pitch):
    """Without wind a turning strip is a propeller, whichever side the last breeze came from."""
    switches = Momentum.of(BemOptions(high_thrust=name), 3)
    induced = []
    for mirror in (1.0, -1.0):
        entry = strip(0.04, mirror=mirror)
        answer = solve_strip(0.0, table, 12, pitch, mirror * 1e-4, 40.0, entry, switches)
        induced.append(answer[1])
    assert abs(induced[0]) > 1.0
    assert induced[1] == pytest.approx(induced[0], abs=0.01)


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("guess", [5e-324, -5e-324, 2.2e-309, -1e-200, 0.0])
def test_an_inflow_angle_next_to_zero_overflows_nothing(table, name, guess):
    """Where a cylinder stands in a calm, its thrust vanishes with the angle."""
    for drag in (True, False):
        options = BemOptions(high_thrust=name, drag_in_axial_induction=drag)
        answer = solve_strip(
            guess, table, 0, 0.0, 0.0, 0.0, strip(0.0156, 0.0, 0.0), Momentum.of(options, 3)
        )
        assert np.all(np.isfinite(answer))


def test_answer_is_continuous_in_the_wind(table):
    """Induced velocity has no jump while the wind rises from nothing to a storm."""
    entry, guess, last = strip(0.04), 0.1, None
    for normal in np.linspace(0.01, 30.0, 3000):
        guess, induced, _, _, _ = solve_strip(guess, table, 12, 0.03, normal, 40.0, entry, SWITCHES)
        if last is not None:
            assert abs(induced - last) < 0.05
        last = induced
