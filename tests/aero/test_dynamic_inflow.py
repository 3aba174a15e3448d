"""Oye's dynamic inflow against its differential equations, limits and rates."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from galerna.aero.bem.dynamic_inflow import (
    COUPLING,
    advance_inflow,
    slow_time_constant,
    start_inflow,
    time_constant_ratio,
)
from galerna.aero.bem.lag import first_order_lag

TAU, RADIUS_FRACTION = 9.0, 0.6


def filtered(quasi_steady, times):
    """Induced velocities at ``times`` for a function of time, from its steady state."""
    state, advanced = np.empty(3), np.empty(3)
    start_inflow(quasi_steady(times[0]), state)
    answers = [quasi_steady(times[0])]
    for before, after in pairwise(times):
        answers.append(
            advance_inflow(
                state, quasi_steady(after), after - before, TAU, RADIUS_FRACTION, advanced
            )
        )
        state, advanced = advanced, state
    return np.array(answers)


def oye_reference(quasi_steady, rate, times):
    """The published pair of equations, integrated by a general solver."""
    tau_2 = time_constant_ratio(RADIUS_FRACTION) * TAU

    def derivative(t, w):
        intermediate = (quasi_steady(t) + COUPLING * TAU * rate(t) - w[0]) / TAU
        return [intermediate, (w[0] - w[1]) / tau_2]

    start = [quasi_steady(times[0])] * 2
    return solve_ivp(derivative, (0, times[-1]), start, t_eval=times, rtol=1e-10, atol=1e-12).y[1]


def test_solves_the_published_equations_exactly_for_a_ramp():
    times = np.linspace(0.0, 30.0, 11)
    expected = oye_reference(lambda t: 3.0 + 0.2 * t, lambda t: 0.2, times)
    np.testing.assert_allclose(filtered(lambda t: 3.0 + 0.2 * t, times), expected, rtol=1e-8)


def test_second_order_in_the_step_for_a_curved_input():
    def error(n):
        times = np.linspace(0.0, 20.0, n + 1)
        reference = oye_reference(lambda t: np.sin(t) ** 2, lambda t: np.sin(2 * t), times)
        return np.abs(filtered(lambda t: np.sin(t) ** 2, times) - reference).max()

    assert error(100) / error(200) == pytest.approx(4.0, rel=0.1)


def test_a_step_rises_fast_then_slowly_and_never_overshoots():
    times = np.linspace(0.0, 60.0, 601)
    response = filtered(lambda t: 0.0 if t == 0.0 else 1.0, times)
    assert np.all(np.diff(response) > 0.0)
    assert response[-1] < 1.0
    # tau_2 alone would reach 0.999 after 7 tau_2 = 18.6 s; the slow part is still missing.
    assert 0.9 < response[186] < 0.99


def test_steady_input_stays_exactly_and_any_step_is_stable():
    state, advanced = np.empty(3), np.empty(3)
    start_inflow(2.5, state)
    for dt in (0.0, 1e-12, 1e-3, 1.0, 1e6):
        assert advance_inflow(state, 2.5, dt, TAU, 0.3, advanced) == pytest.approx(2.5, abs=4e-15)
    assert 2.5 < advance_inflow(state, 9.0, 1e6, TAU, 0.3, advanced) <= 9.0


def test_a_vanishing_step_changes_nothing():
    state, advanced = np.array([1.0, 2.0, 3.0]), np.empty(3)
    steps = np.array([1e-9, 1e-7, 1e-5, 1e-4])
    change = []
    for dt in steps:
        advance_inflow(state, 3.0, dt, TAU, 0.3, advanced)
        change.append(advanced[0] - 1.0)
    np.testing.assert_allclose(np.array(change) / steps, 2.0 / TAU, rtol=1e-5)


@pytest.mark.parametrize("ratio", [1e-8, 9.99e-4, 1.001e-3, 0.3, 5.0])
def test_lag_is_exact_for_linear_input(ratio):
    before, after, start = 0.4, 1.1, -0.3
    exact = solve_ivp(
        lambda x, y: before + (after - before) * x / ratio - y,
        (0.0, ratio),
        [start],
        rtol=1e-12,
        atol=1e-14,
    ).y[0, -1]
    assert first_order_lag(start, before, after, ratio) == pytest.approx(exact, abs=1e-12)


def test_time_constants_follow_the_loading():
    light, heavy = slow_time_constant(10.0, 0.0, 63.0), slow_time_constant(10.0, 0.5, 63.0)
    assert light == pytest.approx(1.1 * 6.3)
    assert heavy == pytest.approx(1.1 / 0.35 * 6.3)
    assert slow_time_constant(10.0, 0.9, 63.0) == heavy
    assert np.isfinite(slow_time_constant(0.0, 0.3, 63.0))
    assert time_constant_ratio(1.0) == pytest.approx(0.13)
