from dataclasses import replace

import numpy as np
import pytest

from galerna.errors import ConvergenceError, InputError
from galerna.hydro.netcdf import read_netcdf, write_netcdf
from galerna.hydro.radiation import (
    Convolution,
    RadiationStateSpace,
    StateSpaceMemory,
    fit_radiation,
    impulse_response,
    radiation_of,
)
from galerna.hydro.radiation.convolution import RESOLUTION
from galerna.hydro.radiation.fit import coupled_modes
from galerna.hydro.radiation.stored import store_radiation, stored_radiation
from galerna.hydro.radiation.wave_rows import Rows, realized, transfer

from .analytic_database import (
    SIZES,
    WIDTHS,
    gaussian_response,
    heave_only,
    spar_like,
)

FINE = np.geomspace(1e-3, 1e3, 3000)


@pytest.fixture(scope="module")
def database():
    return spar_like()


@pytest.fixture(scope="module")
def fit(database):
    return fit_radiation(database)


def random_motion(rng, times):
    """Velocities (k,6) of many waves, moments' arms of 50 m."""
    w = np.linspace(0.1, 2.5, 60)
    size = rng.normal(size=(60, 6)) / np.array([1, 1, 1, 50, 50, 50])
    phase = rng.uniform(0.0, 2.0 * np.pi, (60, 6))
    return np.sum(size * np.cos(times[:, None, None] * w[:, None] + phase), axis=1)


def forces(memory, times, velocity):
    """Forces (k,6) at the ends of all steps."""
    out = []
    for k, dt in enumerate(np.diff(times)):
        free, block = memory.begin(dt, velocity[k])
        out.append(free - block @ velocity[k + 1])
        memory.commit(velocity[k + 1])
    return np.array(out)


# -- the fit ---------------------------------------------------------------------------------


def test_coefficients_are_fitted_within_the_tolerance(database, fit):
    """0.3 % where the damping is, and above that as an error of the added mass."""
    w = database.frequency
    K = radiation_of(database)
    K += 1j * w[:, None, None] * (database.added_mass_infinite - fit.added_mass_infinite)
    apart = np.abs(fit.transfer(w) - K)
    largest = np.abs(K).max(axis=0)
    assert np.all(apart[w < 1.0] <= 0.003 * largest + 1e-6)
    assert np.all((apart / w[:, None, None])[w > 1.0] <= 0.0035 * largest + 1e-6)
    np.testing.assert_allclose(fit.error * largest, apart.max(axis=0), rtol=1e-3, atol=1e-3)
    assert fit.notes == ()


def test_added_mass_at_infinity_hardly_moves(database, fit):
    given = database.added_mass_infinite
    felt = given != 0.0
    assert np.abs(fit.added_mass_infinite - given)[felt] / np.abs(given)[felt] == pytest.approx(
        0.0, abs=2e-3
    )


def test_a_body_of_revolution_has_the_same_radiation_in_sway_and_roll(fit):
    turned = np.array([1.0, -1.0])
    surge_pitch = fit.transfer(FINE)[:, [0, 4]][:, :, [0, 4]]
    sway_roll = fit.transfer(FINE)[:, [1, 3]][:, :, [1, 3]]
    apart = np.abs(turned[:, None] * surge_pitch * turned - sway_roll)
    assert apart.max() < 1e-12 * np.abs(surge_pitch).max()


def test_surge_pitch_is_pitch_surge_and_nothing_couples_that_does_not(fit):
    K = fit.transfer(FINE)
    np.testing.assert_allclose(K, K.transpose(0, 2, 1), rtol=1e-9, atol=1e-6)
    assert np.abs(K[:, 0, 4]).max() > 1e5
    assert np.abs(K[:, 0, 1]).max() == 0.0
    assert np.abs(K[:, 2, 4]).max() == 0.0


def test_fit_is_stable_passive_strictly_proper_and_zero_at_rest(fit):
    assert np.linalg.eigvals(fit.A).real.max() < 0.0
    assert fit.largest_growth < 1e-13
    assert fit.smallest_damping(FINE) > -1e-12
    assert np.abs(fit.transfer(0.0)).max() < 1e-8 * np.abs(fit.transfer(1.0)).max()
    far = np.abs(fit.transfer([1e4, 1e5])).max(axis=(1, 2))
    assert far[0] / far[1] == pytest.approx(10.0, rel=1e-3)


def test_rational_radiation_is_recovered():
    rng = np.random.default_rng(4)
    rows = Rows(np.array([[0.4, 1.7]]), np.array([[0.5, 1.1]]), rng.normal(size=(1, 4, 2)))
    G = rows.G.reshape(2, 2, 2)
    G[1, 1] = -1.7 * (0.5 * G[0, 0] + G[0, 1]) / 0.4 - 1.1 * G[1, 0]  # no wave at w = 0
    w = np.arange(1, 101) * 0.05
    K = transfer(*rows, w) * np.outer([1e3, 2e4], [1e3, 2e4])
    assert np.abs(transfer(*rows, np.array([0.0]))).max() < 1e-14
    base = spar_like(w)
    A, B = np.zeros((100, 6, 6)), np.zeros((100, 6, 6))
    pair = np.ix_(range(100), [0, 4], [0, 4])
    A[pair], B[pair] = K.imag / w[:, None, None], K.real
    known = replace(base, added_mass=base.added_mass_infinite + A, damping=B)
    found = fit_radiation(known)
    assert found.error.max() < 1e-4


def test_rows_in_balanced_states_are_the_rational_function():
    rng = np.random.default_rng(1)
    rows = Rows(*rng.uniform(0.2, 2.0, (2, 2, 3)), rng.normal(size=(2, 6, 3)))
    A, B = realized(rows)
    w = np.array([0.1, 0.7, 3.0])
    inside = 1j * w[:, None, None] * np.eye(len(A)) - A
    K = B.T @ np.linalg.solve(inside, np.broadcast_to(B, (3, *B.shape)))
    np.testing.assert_allclose(K, transfer(*rows, w), rtol=1e-6)


def test_two_waves_of_coupled_modes_take_two_rows():
    base = spar_like()
    w = base.frequency
    other = heave_only(w, own=1.3)
    second = 0.2 * radiation_of(other)[:, 2, 2]
    shape = np.outer([2.0, 15.0], [2.0, 15.0])
    A, B = base.added_mass.copy(), base.damping.copy()
    pair = np.ix_(range(len(w)), [0, 4], [0, 4])
    A[pair] += shape * (second.imag / w)[:, None, None]
    B[pair] += shape * second.real[:, None, None]
    found = fit_radiation(replace(base, added_mass=A, damping=B))
    assert found.error.max() < 0.012
    assert found.largest_growth < 1e-13
    values = np.linalg.eigvalsh(found.transfer(1.3).real[0][np.ix_([0, 4], [0, 4])])
    assert values.min() > 0.0


@pytest.mark.parametrize("seed", range(3))
def test_noisy_coefficients_still_give_a_passive_system(seed):
    base = spar_like()
    rng = np.random.default_rng(seed)
    noise = 0.03 * np.abs(base.damping).max(axis=0) * rng.normal(size=base.damping.shape)
    noisy = replace(base, damping=base.damping + noise)
    assert np.linalg.eigvalsh(noisy.damping).min() < 0.0
    found = fit_radiation(noisy, most_sections=3)
    assert found.largest_growth < 1e-13
    assert found.smallest_damping(FINE) > -1e-12
    assert "surge-surge" in " ".join(found.notes)


def test_modes_that_do_not_radiate_or_couple_stay_apart(database):
    K = radiation_of(database)
    K[:, 5, 5] = 1e-9
    assert sorted(coupled_modes(K)) == [[0, 4], [1, 3], [2]]


def test_coefficients_that_cannot_be_are_refused(database):
    broken = database.damping.copy()
    broken[3, 2, 2] = np.nan
    with pytest.raises(InputError, match="not finite"):
        fit_radiation(replace(database, damping=broken))
    with pytest.raises(ConvergenceError, match="no passive fit"):
        fit_radiation(replace(database, damping=-database.damping), most_sections=2)


def test_a_stored_fit_is_the_fit(fit):
    again = RadiationStateSpace.of_arrays(fit.arrays())
    np.testing.assert_array_equal(again.transfer(0.7), fit.transfer(0.7))
    np.testing.assert_array_equal(again.added_mass_infinite, fit.added_mass_infinite)


# -- impulse response and convolution ---------------------------------------------------------


def test_impulse_response_from_damping_and_from_added_mass(database):
    times = np.linspace(0.0, 15.0, 76)
    exact = np.zeros((76, 6, 6))
    for (i, j), width in WIDTHS.items():
        exact[:, i, j] = exact[:, j, i] = SIZES[i, j] * gaussian_response(width, times)
    largest = np.where(exact[0] == 0.0, 1.0, np.abs(exact[0]))
    assert np.abs((impulse_response(database, times) - exact) / largest).max() < 1e-5
    by_mass = impulse_response(database, times[1:], "added_mass")
    apart = np.abs((by_mass - exact[1:]) / largest).max(axis=(1, 2))
    assert apart[times[1:] > 1.0].max() < 6e-3  # its tail is longer, and felt at once
    assert apart.max() < 0.04


def test_tail_of_the_damping_counts():
    w = np.arange(1, 101) * 0.05
    times = np.linspace(0.1, 20.0, 50)
    exact = 1e5 * np.exp(-0.25 * times) * (np.cos(0.8 * times) - 0.25 / 0.8 * np.sin(0.8 * times))
    found = impulse_response(heave_only(w), times)[:, 2, 2]
    assert np.abs(found - exact).max() < 2e-3 * 1e5


def test_impulse_response_of_the_fit(database, fit):
    """At t = 0 it feels what lies above the frequencies fitted."""
    times = np.linspace(0.0, 30.0, 61)
    apart = np.abs(fit.impulse_response(times) - impulse_response(database, times))
    own = np.abs(impulse_response(database, 0.0)[0])
    assert np.all(apart[times >= 1.0] <= 0.01 * own + 1e-6)
    assert np.all(apart[times < 1.0] <= 0.1 * own + 1e-6)


def test_state_space_and_convolution_agree_in_random_motion(database, fit):
    times = np.arange(0.0, 150.0, 0.1)
    velocity = random_motion(np.random.default_rng(3), times)
    by_states = forces(StateSpaceMemory(fit), times, velocity)[600:]
    by_past = forces(Convolution.of(database), times, velocity)[600:]
    apart = (by_states - by_past)[:, :5].std(axis=0) / by_past[:, :5].std(axis=0)
    assert apart.max() < 0.01


def test_convolution_takes_steps_of_any_size():
    response = np.zeros((2001, 6, 6))
    lag = np.arange(2001) * RESOLUTION
    response[:, 2, 2] = np.exp(-lag)
    times = np.cumsum(np.tile([0.0, 0.02, 0.01, 0.005], 300))
    velocity = np.zeros((len(times), 6))
    velocity[:, 2] = np.sin(times)
    exact = 0.5 * (np.sin(times) - np.cos(times) + np.exp(-times))
    found = forces(Convolution(response), times, velocity)
    np.testing.assert_allclose(-found[:, 2], exact[1:], atol=5e-5)


# -- stepping -----------------------------------------------------------------------------------


def test_a_step_is_exact_for_a_linear_velocity(fit):
    rng = np.random.default_rng(2)
    start, end = rng.normal(size=(2, 6))
    whole = forces(StateSpaceMemory(fit), np.array([0.0, 0.4]), np.stack([start, end]))
    share = np.linspace(0.0, 1.0, 9)[:, None]
    small = forces(StateSpaceMemory(fit), 0.4 * share[:, 0], start + share * (end - start))
    np.testing.assert_allclose(small[-1], whole[-1], rtol=1e-10)


def test_steps_are_of_second_order(fit):
    def error(dt):
        times = np.linspace(0.0, 8.0, round(8.0 / dt) + 1)
        velocity = np.sin(1.3 * times)[:, None] * np.array([1, 0, 1, 0, 0.02, 0.0])
        return forces(StateSpaceMemory(fit), times, velocity)[-1]

    fine = error(0.005)
    ratio = np.abs(error(0.2) - fine)[[0, 2, 4]] / np.abs(error(0.1) - fine)[[0, 2, 4]]
    np.testing.assert_allclose(ratio, 4.0, rtol=0.03)


def test_water_stores_no_more_than_the_work_done_on_it(fit):
    """With the work by Gauss' rule within each step, exact for what a step can hold."""
    nodes, weights = np.polynomial.legendre.leggauss(6)
    memory, rng = StateSpaceMemory(fit), np.random.default_rng(5)
    dt, work, least = 0.3, 0.0, np.inf
    before = np.zeros(6)
    for _ in range(400):
        after = rng.normal(size=6) / np.array([1, 1, 1, 50, 50, 50])
        for node, weight in zip(0.5 + 0.5 * nodes, 0.5 * weights, strict=True):
            velocity = before + node * (after - before)
            free, block = memory.begin(node * dt, before)
            work -= weight * dt * (free - block @ velocity) @ velocity
        memory.begin(dt, before)
        memory.commit(after)
        before = after
        least = min(least, work - memory.energy)
    assert least > 0.0
    assert memory.energy > 0.0


@pytest.mark.parametrize("kind", ["states", "past"])
def test_memory_resumes_to_the_bit(database, fit, kind):
    def make():
        return StateSpaceMemory(fit) if kind == "states" else Convolution.of(database, 5.0)

    times = np.arange(0.0, 10.0, 0.1)
    velocity = random_motion(np.random.default_rng(7), times)
    through = make()
    forces(through, times[:51], velocity[:51])
    saved = through.state()
    rest = forces(through, times[50:], velocity[50:])
    resumed = make()
    resumed.restore(saved)
    np.testing.assert_array_equal(forces(resumed, times[50:], velocity[50:]), rest)


@pytest.mark.parametrize("kind", ["states", "past"])
def test_a_trial_changes_nothing_committed(database, fit, kind):
    memory = StateSpaceMemory(fit) if kind == "states" else Convolution.of(database, 5.0)
    times = np.arange(0.0, 2.0, 0.1)
    velocity = random_motion(np.random.default_rng(8), times)
    memory.begin(0.1, velocity[0])
    assert all(not np.any(value) for value in memory.state().values())
    forces(memory, times, velocity)
    before = memory.state()
    first = memory.begin(0.1, velocity[-1])[0]
    memory.begin(0.05, velocity[3])
    assert all(np.array_equal(before[name], value) for name, value in memory.state().items())
    np.testing.assert_array_equal(memory.begin(0.1, velocity[-1])[0], first)


def test_a_stored_fit_comes_back_for_another_density(tmp_path, database):
    path = tmp_path / "base.nc"
    write_netcdf(database, path)
    fit = store_radiation(database, path)
    point = database.reference_point
    again = stored_radiation(path, point, database.water_density)
    assert np.array_equal(again.A, fit.A)
    assert np.array_equal(again.B, fit.B)
    lighter = stored_radiation(path, point, 0.5 * database.water_density)
    assert lighter.transfer([0.7]) == pytest.approx(0.5 * fit.transfer([0.7]))
    assert stored_radiation(path, point + 1.0, database.water_density) is None
    assert np.array_equal(read_netcdf(path).added_mass, database.added_mass)
