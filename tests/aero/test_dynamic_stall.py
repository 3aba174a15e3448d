"""Beddoes-Leishman sections against thin-airfoil theory, static polars and their own equations."""

from itertools import pairwise

import numpy as np
import pytest
from numpy import pi
from scipy.integrate import solve_ivp
from scipy.special import hankel2

from galerna import turbine as turbines
from galerna.aero.bem.dynamic_stall import (
    BLEND_END,
    BLEND_START,
    JONES,
    UNDECIDED,
    advance_stall,
    section_parameters,
    separation_table,
    start_stall,
)
from galerna.aero.sections import blade_sections

CHORD, SPEED = 2.0, 50.0
ANGLES = np.linspace(-pi, pi, 1441)
ZERO = np.radians(-2.0)


def stalling_polar():
    """Kirchhoff flow about -2 deg with f falling around 12 deg, a flat plate beyond."""
    distance = ANGLES - ZERO
    point = 1.0 / (1.0 + np.exp((np.abs(distance) - np.radians(14.0)) / np.radians(2.0)))
    kirchhoff = 2 * pi * distance * ((1.0 + np.sqrt(point)) / 2.0) ** 2
    share = np.clip((np.abs(distance) - 0.4) / 0.3, 0.0, 1.0)
    lift = (1 - share) * kirchhoff + share * 2.0 * np.sin(ANGLES) * np.cos(ANGLES)
    drag = 0.008 + 1.9 * np.sin(ANGLES) ** 2 * share
    moment = -0.05 - 0.3 * np.sin(ANGLES) * share
    return np.stack([lift, drag, moment], axis=1)


def plate_polar():
    return np.stack([2 * pi * ANGLES, 0 * ANGLES, 0 * ANGLES], axis=1)


def cylinder_polar():
    return np.stack([0 * ANGLES, 0 * ANGLES + 0.5, 0 * ANGLES], axis=1)


def section(polar, zero=ZERO):
    table, lift_line = separation_table(polar[None], np.array([zero]))
    return table, section_parameters(lift_line, np.array(JONES))


STALLING, PLATE = section(stalling_polar()), section(plate_polar(), 0.0)


def run(model, motion, times):
    """cl, cd, cm at ``times`` for motion(t) -> (normal, chordwise velocity, torsion rate)."""
    table, parameters = model
    state, advanced = np.empty(8), np.empty(8)
    normal, chordwise, rate = motion(times[0])
    start_stall(state, table, 0, parameters, CHORD, normal, chordwise, rate)
    answers = [
        advance_stall(state, table, 0, parameters, CHORD, normal, chordwise, rate, 0.0, advanced)
    ]
    for before, after in pairwise(times):
        normal, chordwise, rate = motion(after)
        answers.append(
            advance_stall(
                state,
                table,
                0,
                parameters,
                CHORD,
                normal,
                chordwise,
                rate,
                after - before,
                advanced,
            )
        )
        state, advanced = advanced, state
    return np.array(answers)


def harmonic(values, times, omega):
    """Complex amplitude a of Re(a e^{i omega t}) over the last period of ``times``."""
    last = times > times[-1] - 2 * pi / omega * (1 - 1e-9)
    return 2.0 * np.mean(values[last] * np.exp(-1j * omega * times[last]))


def periods(omega, cycles, per_period):
    return np.arange(cycles * per_period + 1) * (2 * pi / omega / per_period)


def jones(k):
    a_1, a_2, b_1, b_2 = JONES
    return 1.0 - a_1 * 1j * k / (1j * k + b_1) - a_2 * 1j * k / (1j * k + b_2)


@pytest.mark.parametrize("dt", [0.0, 1e-3, 0.1, 0.5, 100.0])
def test_steady_flow_gives_back_the_static_polar(dt):
    table, parameters = STALLING
    state, advanced = np.empty(8), np.empty(8)
    for row in range(0, len(ANGLES), 7):
        flow = SPEED * np.sin(ANGLES[row]), SPEED * np.cos(ANGLES[row]), 0.0
        start_stall(state, table, 0, parameters, CHORD, *flow)
        got = advance_stall(state, table, 0, parameters, CHORD, *flow, dt, advanced)
        np.testing.assert_allclose(got, stalling_polar()[row], rtol=0, atol=1e-12)
        np.testing.assert_allclose(advanced, state, atol=1e-13)


def test_any_start_converges_to_the_static_polar():
    table, parameters = STALLING
    for degrees in (-30.0, 5.0, 13.0, 50.0, 100.0, 175.0):
        angle = np.radians(degrees)
        state = np.array([30.0, -40.0, 1.5, 0.9, 20.0, 10.0, -1.0, 0.2])
        for _ in range(400):
            flow = SPEED * np.sin(angle), SPEED * np.cos(angle), 0.0
            advanced = np.empty(8)
            got = advance_stall(state, table, 0, parameters, CHORD, *flow, 0.05, advanced)
            state = advanced
        expected = [np.interp(angle, ANGLES, column) for column in stalling_polar().T]
        np.testing.assert_allclose(got, expected, atol=1e-9)


def test_separation_rebuilds_the_static_lift_and_stays_within_bounds():
    table, lift_line = separation_table(stalling_polar()[None], np.array([ZERO]))
    slope, zero, _ = lift_line[0]
    assert zero == pytest.approx(ZERO, abs=2e-3)
    assert slope == pytest.approx(2 * pi, rel=0.02)
    lift, point, gain = table[0, :, 0], table[0, :, 3], table[0, :, 4]
    assert point.min() >= 0.0
    assert point.max() <= 1.0
    rebuilt = slope * (ANGLES - zero) - (1.0 - point) * gain
    near = (np.abs(ANGLES) < BLEND_END) & (point < 1.0) & (np.abs(ANGLES - zero) > UNDECIDED)
    np.testing.assert_allclose(rebuilt[near], lift[near], atol=1e-9)


def test_step_of_downwash_follows_wagner():
    s = np.linspace(0.0, 40.0, 401)  # half-chords
    times = s * CHORD / 2 / SPEED
    alpha = 1e-3
    lift = run(PLATE, lambda t: (0.0 if t == 0.0 else SPEED * alpha, SPEED, 0.0), times)[:, 0]
    a_1, a_2, b_1, b_2 = JONES
    # The input rises linearly over the first step, so the response is half a step late.
    late = s[1:] - 0.5 * (s[1] - s[0])
    wagner = 1.0 - a_1 * np.exp(-b_1 * late) - a_2 * np.exp(-b_2 * late)
    np.testing.assert_allclose(lift[1:] / (2 * pi * alpha), wagner, atol=2e-4)


@pytest.mark.parametrize("k", [0.02, 0.1, 0.3, 1.0])
def test_plunging_plate_follows_theodorsen(k):
    omega = k * SPEED / (CHORD / 2)
    times = periods(omega, 4 + int(30 * k), 400)
    lift = run(PLATE, lambda t: (1e-3 * SPEED * np.cos(omega * t), SPEED, 0.0), times)[:, 0]
    ratio = harmonic(lift, times, omega) / (2 * pi * 1e-3)
    assert abs(ratio - jones(k)) < 1e-3
    theodorsen = hankel2(1, k) / (hankel2(1, k) + 1j * hankel2(0, k))
    assert abs(ratio - theodorsen) < 0.02  # the accuracy of Jones' approximation


def test_pitching_plate_has_the_lift_and_moment_of_its_rate():
    k = 0.1
    omega, amplitude = k * SPEED / (CHORD / 2), 1e-3
    times = periods(omega, 5, 400)

    def motion(t):
        alpha, rate = amplitude * np.cos(omega * t), -amplitude * omega * np.sin(omega * t)
        return SPEED * alpha + rate * CHORD / 2, SPEED, rate  # pitch about the quarter chord

    answer = run(PLATE, motion, times)
    lift, moment = (harmonic(answer[:, i], times, omega) / amplitude for i in (0, 2))
    assert abs(lift - (2 * pi * jones(k) * (1 + 1j * k) + pi * 1j * k)) < 5e-3
    assert abs(moment + 0.5 * pi * 1j * k) < 2e-4


def test_plunging_plate_has_garricks_drag():
    k, alpha = 0.2, 0.02
    omega = k * SPEED / (CHORD / 2)
    times = periods(omega, 8, 400)
    drag = run(PLATE, lambda t: (alpha * SPEED * np.cos(omega * t), SPEED, 0.0), times)[:, 1]
    expected = pi * alpha**2 * (jones(k).real - abs(jones(k)) ** 2)
    assert drag[-400:].mean() == pytest.approx(expected, rel=5e-3)


def test_changing_speed_follows_the_papers_equations():
    a_1, a_2, b_1, b_2 = JONES
    alpha = 0.02

    def speed(t):
        return SPEED * (1.0 + 0.3 * np.sin(8.0 * t))

    def derivative(t, x):
        u, u_dot = speed(t), SPEED * 0.3 * 8.0 * np.cos(8.0 * t)
        passage = CHORD / 2 / u
        return [
            -(b + CHORD * u_dot / (2 * u**2)) / passage * x_i + b * a / passage * alpha
            for a, b, x_i in ((a_1, b_1, x[0]), (a_2, b_2, x[1]))
        ]

    times = np.linspace(0.0, 2.0, 2001)
    x = solve_ivp(
        derivative, (0, 2), [a_1 * alpha, a_2 * alpha], t_eval=times, rtol=1e-9, atol=1e-12
    ).y
    expected = 2 * pi * (alpha * (1 - a_1 - a_2) + x[0] + x[1])
    lift = run(PLATE, lambda t: (speed(t) * np.sin(alpha), speed(t) * np.cos(alpha), 0.0), times)[
        :, 0
    ]
    np.testing.assert_allclose(lift, expected, rtol=5e-4)


def test_stalling_section_overshoots_and_turns_clockwise():
    k = 0.08
    omega = k * SPEED / (CHORD / 2)
    times = periods(omega, 3, 200)

    def motion(t):
        alpha = np.radians(12.0 + 6.0 * np.sin(omega * t))
        return SPEED * np.sin(alpha), SPEED * np.cos(alpha), 0.0

    lift = run(STALLING, motion, times)[-200:, 0]
    rising = np.cos(omega * times[-200:]) > 0
    alpha = 12.0 + 6.0 * np.sin(omega * times[-200:])
    at_up = lift[rising][np.argmin(np.abs(alpha[rising] - 13.0))]
    at_down = lift[~rising][np.argmin(np.abs(alpha[~rising] - 13.0))]
    assert at_up > at_down + 0.1
    assert lift.max() > stalling_polar()[np.abs(ANGLES) < 0.35, 0].max() * 1.02


def test_second_order_in_the_step():
    omega = 5.0

    def motion(t):
        alpha = np.radians(8.0 + 4.0 * np.sin(omega * t))
        return SPEED * np.sin(alpha), SPEED * np.cos(alpha), np.radians(20) * np.cos(omega * t)

    def final(n):
        return run(STALLING, motion, np.linspace(0.0, 1.0, n + 1))[-1, 0]

    reference = final(12800)
    assert (final(100) - reference) / (final(200) - reference) == pytest.approx(4.0, rel=0.25)


@pytest.mark.parametrize("dt", [0.001, 0.02, 0.5])
def test_a_full_turn_of_the_flow_stays_bounded_and_static_behind(dt):
    times = np.arange(0.0, 40.0, dt)

    def motion(t):
        return SPEED * np.sin(0.5 * t), SPEED * np.cos(0.5 * t), 0.0

    answer = run(STALLING, motion, times)
    angle = (0.5 * times + pi) % (2 * pi) - pi
    static = np.stack([np.interp(angle, ANGLES, column) for column in stalling_polar().T], axis=1)
    behind = np.abs(angle) > BLEND_END + 0.01
    np.testing.assert_allclose(answer[behind], static[behind], atol=1e-12)
    assert np.abs(answer).max() < 4.0


def test_blending_into_the_static_polar_is_smooth():
    table, parameters = STALLING
    state = np.array([20.0, 20.0, 0.3, 0.6, 20.0, SPEED, 0.3, 0.6])
    angles = np.linspace(BLEND_START - 0.1, BLEND_END + 0.1, 2001)
    lift = np.array(
        [
            advance_stall(
                state,
                table,
                0,
                parameters,
                CHORD,
                SPEED * np.sin(a),
                SPEED * np.cos(a),
                0.0,
                0.01,
                np.empty(8),
            )[0]
            for a in angles
        ]
    )
    assert np.abs(np.diff(lift)).max() < 0.01


def test_no_wind_and_no_lift_are_safe():
    table, parameters = STALLING
    state, advanced = np.empty(8), np.empty(8)
    start_stall(state, table, 0, parameters, CHORD, 0.0, 0.0, 0.0)
    assert np.all(np.isfinite(state))
    for dt in (0.0, 0.02, 10.0):
        answer = advance_stall(state, table, 0, parameters, CHORD, 0.0, 0.0, 0.1, dt, advanced)
        assert np.all(np.isfinite(answer))
        assert np.all(np.isfinite(advanced))
    cylinder = section(cylinder_polar(), 0.0)
    answer = run(cylinder, lambda t: (9.0 * np.cos(t), 30.0, 0.5), np.linspace(0, 5, 51))
    np.testing.assert_allclose(answer, np.tile([0.0, 0.5, 0.0], (51, 1)), atol=1e-14)


def test_the_committed_state_is_left_alone():
    table, parameters = STALLING
    state, advanced = np.empty(8), np.empty(8)
    start_stall(state, table, 0, parameters, CHORD, 5.0, SPEED, 0.0)
    kept = state.copy()
    advance_stall(state, table, 0, parameters, CHORD, 9.0, SPEED, 0.2, 0.02, advanced)
    assert np.array_equal(state, kept)
    assert not np.array_equal(advanced, kept)


@pytest.mark.parametrize("name", ["nrel5mw", "dtu10mw"])
def test_real_blades_are_attached_where_they_work_and_separated_in_deep_stall(name):
    sections = blade_sections(turbines.load(name))
    zero = np.array([u.zero_lift_angle for u in sections.unsteady])
    table, lift_line = separation_table(sections.table, zero)
    outer = (sections.span > 0.35) & (lift_line[:, 0] > 5.0)
    assert outer.sum() > 5
    degrees = np.degrees(sections.angles)
    point = table[outer][:, :, 3]
    assert point[:, (degrees > 0) & (degrees < 5)].min() > 0.85
    assert point[:, np.abs(degrees) > 45].max() == 0.0
    assert np.all(np.isfinite(table))
