from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.linalg import expm

from galerna.contract import LoadModel, Motion
from galerna.errors import InputError
from galerna.hydro.drift import SlowDrift
from galerna.hydro.excitation import WaveExcitation
from galerna.hydro.heading import Bins, MeanHeading, MeanLean, lean_of, mean_axes
from galerna.hydro.platform_options import PlatformOptions
from galerna.hydro.potential_flow import PotentialFlow
from galerna.hydro.radiation import RadiationStateSpace, fit_radiation
from galerna.hydro.waves.sea import Sea
from galerna.structure.frames import exp_so3, rotation_about
from galerna.turbine.platform import Platform

from .analytic_database import ROUND, heave_only, spar_like

SPAR = Platform(
    (0.0, 0.0, 0.0), 7.47e6, (0.0, 0.0, -89.9), (4.2e9, 4.2e9, 1.6e8), displaced_volume=8029.0,
    additional_damping=np.diag([1e5, 2e5, 1.3e5, 0.0, 0.0, 1.3e7]),
)  # fmt: skip
PERIOD = 600.0


@pytest.fixture(scope="module")
def database():
    w = np.arange(1, 81) * 0.05
    drift = np.zeros((len(w), len(ROUND), 6))
    drift[:, :, 0] = 5e3 * np.cos(ROUND) * (w**2)[:, None]
    drift[:, :, 1] = 5e3 * np.sin(ROUND) * (w**2)[:, None]
    return spar_like(w, mean_drift=drift)


@pytest.fixture(scope="module")
def fit(database):
    return fit_radiation(database)


def waves(orders, amplitudes, direction=0.0, **other):
    orders = np.asarray(orders)
    amplitudes = np.asarray(amplitudes, dtype=complex)
    towards = np.full(len(orders), direction)
    return Sea(2.0 * np.pi / PERIOD * orders, towards, amplitudes, PERIOD, 320.0, **other)


def irregular(direction=0.0, seed=0):
    orders = np.arange(30, 300)
    size = 0.1 * np.exp(-(((orders - 60) / 25.0) ** 2))
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, len(orders))
    return waves(orders, size * np.exp(1j * phase), direction)


def moving(rng, yaw=0.0):
    """A platform that is tilted, turned and moves all ways."""
    motion = Motion.at_rest(1)
    motion.position[0] = rng.normal(size=3)
    motion.rotation[0] = rotation_about(2, yaw) @ exp_so3(0.15 * rng.normal(size=3))
    motion.velocity[0], motion.angular_velocity[0] = rng.normal(size=3), 0.02 * rng.normal(size=3)
    motion.acceleration[0] = rng.normal(size=3)
    motion.angular_acceleration[0] = 0.02 * rng.normal(size=3)
    return motion


def total(loads):
    return np.concatenate([loads.force[0], loads.moment[0]])


def turned(motion, angle):
    """The same motion with everything turned about z."""
    R = rotation_about(2, angle)
    other = Motion.at_rest(1)
    other.rotation[0] = R @ motion.rotation[0]
    for name in ("position", "velocity", "angular_velocity", "acceleration",
                 "angular_acceleration"):  # fmt: skip
        getattr(other, name)[0] = R @ getattr(motion, name)[0]
    return other


def model_of(database, fit, sea=None, **options):
    return PotentialFlow(SPAR, database, sea, PlatformOptions(**options), radiation=fit)


# -- the load model ---------------------------------------------------------------------------


def test_is_a_load_model_whose_parts_make_the_whole(database, fit):
    model = model_of(database, fit, irregular(), drift="slow")
    assert isinstance(model, LoadModel)
    rng = np.random.default_rng(0)
    model.begin_step(10.0, 0.1, moving(rng))
    motion = moving(rng)
    wrench = total(model.loads(10.1, motion))
    model.end_step(10.1, motion)
    record = model.record()
    assert list(record) == [channel.name for channel in model.channels]
    values = np.array(list(record.values())).reshape(7, 6)
    np.testing.assert_allclose(values[0], wrench)
    np.testing.assert_allclose(values[1:].sum(axis=0), wrench)
    assert all(np.abs(part).max() > 0.0 for part in values)
    assert record["excitation_moment_y"] == values[3, 4]
    names = {channel.name: channel.openfast for channel in model.channels}
    assert names["hydrodynamic_force_x"] == "HydroFxi"
    assert names["excitation_moment_z"] == "B1WvsMzi"


def test_every_part_is_what_it_says(database, fit):
    model = model_of(database, fit, radiation="none", added_mass_axes="upright")
    motion = Motion.at_rest(1)
    motion.position[0] = [3.0, 1.0, -2.0]
    motion.rotation[0] = exp_so3(np.array([0.0, 0.05, 0.0]))
    motion.velocity[0, 1] = 0.5
    motion.acceleration[0, 0] = 0.2
    model.begin_step(0.0, 0.1, motion)
    model.loads(0.1, motion)
    model.end_step(0.1, motion)
    record = model.record()
    assert record["buoyancy_force_z"] == pytest.approx(database.buoyancy + 2.0 * 3.3e5)
    assert record["buoyancy_moment_y"] == pytest.approx(5e9 * 0.05)
    assert record["added_mass_force_x"] == pytest.approx(-8e6 * 0.2)
    assert record["added_mass_moment_y"] == pytest.approx(4.8e8 * 0.2)
    assert record["additional_damping_force_y"] == pytest.approx(-2e5 * 0.5)
    assert record["radiation_force_y"] == 0.0


def test_blocks_are_the_slopes_of_the_loads(database, fit):
    rng = np.random.default_rng(3)
    stiffness = 1e6 * rng.normal(size=(6, 6)) * np.outer(*2 * [np.repeat([1.0, 50.0], 3)])
    model = model_of(replace(database, hydrostatic_stiffness=stiffness), fit, irregular(0.4))
    model.begin_step(5.0, 0.4, moving(rng, 0.7))
    motion = moving(rng, 0.9)
    loads = model.loads(5.4, motion)
    slopes = np.zeros((3, 6, 6))
    for k in range(6):
        for block in range(3):  # velocities and accelerations act linearly
            step = (1.0 if k < 3 else 0.02) * (1.0 if block else 1e-5) * np.eye(6)[k]
            ends = [total(model.loads(5.4, moved(motion, block, s * step))) for s in (1, -1)]
            slopes[block, :, k] = (ends[1] - ends[0]) / (2.0 * step[k])
    for block, found in enumerate((loads.stiffness, loads.damping, loads.mass)):
        scale = np.abs(slopes[block]).max(axis=1, keepdims=True) + 1.0
        np.testing.assert_allclose(found[0] / scale, slopes[block] / scale, atol=1e-6)


def moved(motion, block, step):
    """A motion with its pose, velocities or accelerations changed by (6,)."""
    other = replace(motion)
    if block == 0:
        other.position = motion.position + step[:3]
        other.rotation = (exp_so3(step[3:]) @ motion.rotation[0])[None]
    elif block == 1:
        other.velocity = motion.velocity + step[:3]
        other.angular_velocity = motion.angular_velocity + step[3:]
    else:
        other.acceleration = motion.acceleration + step[:3]
        other.angular_acceleration = motion.angular_acceleration + step[3:]
    return other


@pytest.mark.parametrize("angle", [0.5236, 2.6, -1.3])
def test_platform_and_sea_turned_together_feel_the_same_loads(database, fit, angle):
    rng = np.random.default_rng(5)
    before, after = moving(rng), moving(rng)
    results = []
    for by, sea in ((0.0, irregular(0.3)), (angle, irregular(0.3 + angle))):
        model = model_of(database, fit, sea, drift="slow")
        model.begin_step(7.0, 0.2, turned(before, by))
        results.append(model.loads(7.2, turned(after, by)))
    R = rotation_about(2, angle)
    scale = np.abs(results[0].force).max(), np.abs(results[0].moment).max()
    np.testing.assert_allclose(results[1].force, results[0].force @ R.T, atol=2e-3 * scale[0])
    np.testing.assert_allclose(results[1].moment, results[0].moment @ R.T, atol=2e-3 * scale[1])
    T = np.kron(np.eye(2), R)
    for name in ("stiffness", "damping", "mass"):
        other = T @ getattr(results[0], name)[0] @ T.T
        scale = np.abs(other).max()
        np.testing.assert_allclose(getattr(results[1], name)[0], other, atol=1e-9 * scale)


def test_trials_change_nothing_and_a_resume_keeps_the_bits(database, fit):
    sea = irregular(0.2)
    for radiation in ("state_space", "convolution"):
        options = {"radiation": radiation, "drift": "slow", "radiation_memory_s": 3.0}
        rng = np.random.default_rng(6)
        motions = [moving(rng, 0.01 * k) for k in range(41)]
        first = model_of(database, fit, sea, **options)
        run(first, motions[:21], 0)
        saved = first.state()
        first.begin_step(20.0, 0.05, motions[3])
        first.loads(20.1, motions[4])
        for name, value in first.state().items():
            np.testing.assert_array_equal(value, saved[name])
        rest = run(first, motions[20:], 20)
        again = model_of(database, fit, sea, **options)
        again.restore(saved)
        np.testing.assert_array_equal(run(again, motions[20:], 20), rest)


def run(model, motions, first):
    """Loads (k,6) of steps of 0.1 s between motions, the first of which is accepted."""
    out = []
    for k, (before, after) in enumerate(pairwise(motions), first):
        model.begin_step(0.1 * k, 0.1, before)
        out.append(total(model.loads(0.1 * (k + 1), after)))
        model.end_step(0.1 * (k + 1), after)
    return np.array(out)


def test_free_decay_in_heave_is_that_of_the_exact_equation():
    """m x'' + int K v + C x = 0 with K of two states, by the trapezoidal rule."""
    w = np.arange(1, 101) * 0.05
    size, decay, own, mass, stiffness = 3e5, 0.25, 0.8, 8.23e6, 3.3e5
    base = heave_only(w, size, decay, own, 2.4e5, stiffness)
    A = np.array([[0.0, own], [-own, -2.0 * decay]])
    A[0, 1], A[1, 0] = np.hypot(own, decay), -np.hypot(own, decay)
    B = np.zeros((2, 6))
    B[1, 2] = np.sqrt(size)
    radiation = RadiationStateSpace(A, B, base.added_mass_infinite)
    np.testing.assert_allclose(radiation.transfer(w)[:, 2, 2].real, base.damping[:, 2, 2])
    whole = np.zeros((4, 4))  # height, its rate, states
    whole[0, 1] = 1.0
    whole[1, 0] = -stiffness / (mass + 2.4e5)
    whole[1, 2:] = -B[:, 2] / (mass + 2.4e5)
    whole[2:, 1], whole[2:, 2:] = B[:, 2], A
    exact = expm(whole * 60.0) @ np.array([3.0, 0.0, 0.0, 0.0])

    def error(dt):
        model = PotentialFlow(
            replace(SPAR, additional_damping=np.zeros((6, 6))), base, radiation=radiation
        )
        return np.abs(decayed(model, mass, 3.0, dt, 60.0) - exact[:2])

    assert abs(exact[0]) > 0.1
    coarse, fine = error(0.2), error(0.1)
    assert fine.max() < 5e-3
    np.testing.assert_allclose(coarse / fine, 4.0, rtol=0.05)


def decayed(model, mass, height, dt, duration):
    """Height m and its rate of a mass kg that the model alone moves up and down."""
    motion = Motion.at_rest(1)
    motion.position[0, 2] = height
    weight = model.database.buoyancy
    motion.acceleration[0, 2] = -model.database.hydrostatic_stiffness[2, 2] * height
    motion.acceleration[0, 2] /= mass + model.database.added_mass_infinite[2, 2]
    for step in range(round(duration / dt)):
        model.begin_step(step * dt, dt, motion)
        x, v, a = (getattr(motion, n)[0, 2] for n in ("position", "velocity", "acceleration"))
        after = replace(motion)
        for _ in range(2):  # it is linear: Newton's first step is the last but for rounding
            new = after.acceleration[0, 2]
            after.position = np.array([[0.0, 0.0, x + dt * v + dt**2 / 4 * (a + new)]])
            after.velocity = np.array([[0.0, 0.0, v + dt / 2 * (a + new)]])
            loads = model.loads((step + 1) * dt, after)
            tangent = mass + loads.mass[0, 2, 2] + dt / 2 * loads.damping[0, 2, 2]
            tangent += dt**2 / 4 * loads.stiffness[0, 2, 2]
            residual = mass * new - (loads.force[0, 2] - weight)
            after.acceleration = np.array([[0.0, 0.0, new - residual / tangent]])
        model.end_step((step + 1) * dt, after)
        motion = after
    return np.array([motion.position[0, 2], motion.velocity[0, 2]])


@pytest.mark.parametrize("lean", [0.0, 0.1])
def test_still_water_never_gives_energy_away(database, fit, lean):
    """Random motion around: what radiation and damping take is never given back in all."""
    model = model_of(database, fit, lean_cut_off_hz=0.0)
    leaning = Motion.at_rest(1)
    leaning.rotation[0] = exp_so3(np.array([0.0, lean, 0.0]))
    model.settle(leaning)
    times = np.arange(0.0, 120.0, 0.02)
    rng = np.random.default_rng(8)
    w, phase = rng.uniform(0.1, 2.0, (2, 12, 6))
    speed = np.cos(times[:, None, None] * w + 4.0 * phase).sum(axis=1) * [1, 1, 1, 0.02, 0.02, 0.02]
    motion, work, power, least = Motion.at_rest(1), 0.0, 0.0, np.inf
    for k in range(len(times) - 1):
        model.begin_step(times[k], 0.02, motion)
        motion.velocity[0], motion.angular_velocity[0] = np.split(speed[k + 1], 2)
        model.loads(times[k + 1], motion)
        model.end_step(times[k + 1], motion)
        record = model.record()
        names = [f"radiation_{kind}_{axis}" for kind in ("force", "moment") for axis in "xyz"]
        now = -np.array([record[name] for name in names]) @ speed[k + 1]
        work += 0.01 * (now + power)
        power = now
        least = min(least, work - model.memory.energy)
    assert least > -1e-4 * work
    assert work > 0.0


# -- still water --------------------------------------------------------------------------------


def test_rest_is_buoyancy_and_mean_drift(database, fit):
    sea = irregular(0.3)
    model = model_of(database, fit, sea, drift="slow")
    motion = Motion.at_rest(1)
    loads = model.static_loads(motion)
    mean = 5e3 * np.sum(np.abs(sea.amplitude) ** 2 * sea.frequency**2)
    np.testing.assert_allclose(loads.force[0], [mean * np.cos(0.3), mean * np.sin(0.3),
                                                database.buoyancy], rtol=2e-3)  # fmt: skip
    np.testing.assert_allclose(loads.stiffness[0, 2, 2], 3.3e5)
    assert np.isnan(model.state()["heading"])


def test_centre_of_buoyancy_beside_the_reference_point_heels():
    base = spar_like(center_of_buoyancy=np.array([0.5, -0.2, -62.0]))
    model = PotentialFlow(SPAR, base, options=PlatformOptions(radiation="none"))
    for yaw in (0.0, 1.1):
        motion = Motion.at_rest(1)
        motion.rotation[0] = rotation_about(2, yaw)
        arm = motion.rotation[0] @ base.center_of_buoyancy
        loads = model.static_loads(motion)
        lift = np.array([0.0, 0.0, base.buoyancy])
        np.testing.assert_allclose(loads.moment[0], np.cross(arm, lift), atol=1e-3)


def test_another_buoyancy_takes_the_place_of_the_linear(database, fit):
    def loads(position, rotation):
        return np.arange(6.0), np.diag(np.arange(1.0, 7.0))

    model = PotentialFlow(
        SPAR, database, options=PlatformOptions(radiation="none"),
        buoyancy=SimpleNamespace(loads=loads),
    )  # fmt: skip
    motion = moving(np.random.default_rng(1), 0.4)
    rest = model.static_loads(motion)
    np.testing.assert_allclose(total(rest), np.arange(6.0))
    np.testing.assert_allclose(rest.stiffness[0], np.diag(np.arange(1.0, 7.0)))
    model.begin_step(0.0, 0.1, motion)
    model.loads(0.1, motion)
    model.end_step(0.1, motion)
    assert model.record()["buoyancy_moment_z"] == 5.0


def test_database_about_another_point_is_moved(database):
    about = replace(SPAR, reference_point=(0.0, 0.0, 10.0))
    model = PotentialFlow(about, database, options=PlatformOptions(radiation="none"))
    motion = Motion.at_rest(1)
    motion.position[0, 2] = 10.0
    motion.acceleration[0, 0] = 1.0
    model.begin_step(0.0, 0.1, motion)
    loads = model.loads(0.1, motion)
    assert loads.force[0, 0] == pytest.approx(-8e6)
    assert loads.moment[0, 1] == pytest.approx(4.8e8 + 10.0 * 8e6)


# -- waves --------------------------------------------------------------------------------------


def test_regular_wave_gives_its_transfer_function(database, fit):
    amplitude, order = 2.0 * np.exp(0.7j), 60
    sea = waves([order], [amplitude], 0.3)
    model = model_of(database, fit, sea, radiation="none")
    w = 2.0 * np.pi / PERIOD * order
    X = database.excitation_at([w], [0.3])[0]
    for time in (0.0, 3.3, 100.7):
        model.begin_step(time - 0.1, 0.1, Motion.at_rest(1))
        model.loads(time, Motion.at_rest(1))
        model.end_step(time, Motion.at_rest(1))
        values = np.array(list(model.record().values())).reshape(7, 6)
        exact = (amplitude * X * np.exp(1j * w * time)).real
        np.testing.assert_allclose(values[3], exact, atol=1.5e-3 * np.abs(amplitude * X).max())


def test_excitation_between_headings(database):
    sea = irregular(0.3)
    excitation = WaveExcitation(database, sea)
    for heading in (0.0437, -0.91, 3.1):
        exact = sea.series(excitation.transfer(heading))
        times = np.linspace(0.0, 100.0, 50)
        found = np.array([excitation.at(t, heading) for t in times])
        scale = np.array([exact.at(t) for t in times]).std(axis=0).max()
        error = found - [exact.at(t) for t in times]
        assert error.std(axis=0).max() < 2e-3 * scale


def test_reference_point_beside_the_axis_feels_waves_later(database):
    beside = replace(database, reference_point=np.array([20.0, 5.0, 0.0]))
    sea = waves([90], [1.0], 0.5)
    ahead = 20.0 * np.cos(0.5) + 5.0 * np.sin(0.5)
    late = np.exp(-1j * sea.wavenumber * ahead)
    here, there = (WaveExcitation(base, sea).transfer(0.0) for base in (database, beside))
    np.testing.assert_allclose(there, late * here)


def test_sea_above_the_database_is_refused_where_it_matters(database):
    beyond = waves([60, 500], [1.0, 3.0])
    with pytest.raises(InputError, match=r"90\.00% of the waves' variance lies above 4 rad/s"):
        WaveExcitation(database, beyond)
    excitation = WaveExcitation(database, waves([60, 500], [1.0, 0.01]))
    assert excitation.notes == ("1 waves above the database's last frequency bring no excitation",)
    assert np.all(excitation.transfer(0.0)[1] == 0.0)


def test_slow_drift_needs_coefficients(fit):
    with pytest.raises(InputError, match="no mean drift coefficients"):
        model_of(spar_like(), fit, irregular(), drift="mean")


def test_slow_drift_of_two_waves_beats_with_the_geometric_mean(database):
    sea = waves([80, 90], [1.0, 0.5])
    drift = SlowDrift(database, sea)
    D = 5e3 * sea.frequency**2
    times = np.linspace(0.0, 120.0, 241)
    found = np.array([drift.at(t, 0.0)[0] for t in times])
    beat = np.cos((sea.frequency[1] - sea.frequency[0]) * times)
    exact = D[0] + 0.25 * D[1] + np.sqrt(D[0] * D[1]) * beat
    np.testing.assert_allclose(found, exact, rtol=2e-3)
    assert drift.mean(0.0)[0] == pytest.approx(D[0] + 0.25 * D[1], rel=1e-3)


def test_mean_of_the_slow_drift_is_the_mean_drift(database):
    sea = irregular(0.3, seed=2)
    drift = SlowDrift(database, sea)
    found = np.mean([drift.at(t, 0.0) for t in np.arange(0.0, PERIOD, 0.5)], axis=0)
    np.testing.assert_allclose(found[:2], drift.mean(0.0)[:2], rtol=2e-3)


def test_drift_begins_with_its_mean_while_waves_grow(database):
    drift = SlowDrift(database, replace(irregular(), ramp=50.0))
    np.testing.assert_allclose(drift.at(0.0, 0.0), drift.mean(0.0))


# -- heading and options --------------------------------------------------------------------------


def test_mean_heading_follows_a_step_of_yaw_as_a_lag():
    heading = MeanHeading(0.01)
    psi = heading.over_step(np.eye(3))
    assert psi == 0.0
    for _ in range(100):
        before = heading.over_step(np.eye(3))
        heading.commit(0.2, before, rotation_about(2, 0.3))
    exact = 0.3 * (1.0 - np.exp(-2.0 * np.pi * 0.01 * 20.0))
    assert heading.over_step(np.eye(3)) == pytest.approx(exact, rel=1e-12)


def test_mean_heading_goes_the_short_way_round():
    heading = MeanHeading(0.01)
    heading.commit(0.1, heading.over_step(rotation_about(2, 3.1)), rotation_about(2, -3.1))
    assert 3.1 < heading.over_step(np.eye(3)) < 3.11


def test_fixed_heading_stays(database, fit):
    model = PotentialFlow(
        SPAR, database, None, PlatformOptions(heading="fixed"), radiation=fit, heading=0.25
    )
    motion = Motion.at_rest(1)
    motion.rotation[0] = rotation_about(2, 1.0)
    model.begin_step(0.0, 0.1, motion)
    model.loads(0.1, motion)
    model.end_step(0.1, motion)
    assert model.state()["heading"] == 0.25


@pytest.mark.parametrize("yaw", [0.0, 2.3, -3.0])
def test_lean_is_the_shortest_turn_from_upright(yaw):
    lean = np.array([0.06, -0.11, 0.0])
    leaning = mean_axes(yaw, lean)
    np.testing.assert_allclose(lean_of(leaning), lean, rtol=1e-12)
    np.testing.assert_allclose(leaning.T @ leaning, np.eye(3), atol=1e-15)
    np.testing.assert_array_equal(lean_of(rotation_about(2, yaw)), np.zeros(3))


def test_mean_lean_begins_at_rest_and_follows_as_a_lag():
    mean, leaning = MeanLean(0.01), exp_so3(np.array([0.0, 0.2, 0.0]))
    np.testing.assert_allclose(mean.over_step(leaning), [0.0, 0.2, 0.0])
    mean.settle(exp_so3(np.array([0.0, 0.05, 0.0])))
    for _ in range(100):
        mean.commit(0.2, mean.over_step(leaning), leaning)
    left = np.exp(-2.0 * np.pi * 0.01 * 20.0)
    np.testing.assert_allclose(mean.over_step(leaning), [0.0, 0.2 - 0.15 * left, 0.0], rtol=1e-12)
    with pytest.raises(InputError, match="lean_cut_off_hz"):
        MeanLean(-0.1)


def test_a_leaning_body_of_revolution_spins_without_its_added_mass(database, fit):
    """About its own axis it moves no water; upright axes give a spar a share of A44."""
    leaning = exp_so3(np.array([0.03, 0.05, 0.0]))
    spin = Motion.at_rest(1)
    spin.rotation[0] = leaning
    spin.angular_acceleration[0] = leaning[:, 2]
    found = {}
    for axes in ("mean_lean", "upright"):
        model = model_of(database, fit, radiation="none", added_mass_axes=axes)
        model.settle(spin)
        model.begin_step(0.0, 0.1, spin)
        loads = model.loads(0.1, spin)
        model.end_step(0.1, spin)
        record = model.record()
        moment = np.array([record[f"added_mass_moment_{axis}"] for axis in "xyz"])
        found[axes] = -moment @ leaning[:, 2]
        np.testing.assert_allclose(loads.mass[0], model.static_loads(spin).mass[0], rtol=1e-12)
    tilt = 1.0 - leaning[2, 2] ** 2
    assert found["upright"] == pytest.approx(3.8e10 * tilt, rel=1e-12)
    assert abs(found["mean_lean"]) < 1e-12 * 3.8e10


def test_upright_on_average_is_upright_to_the_bit(database, fit):
    rng = np.random.default_rng(4)
    motions = [moving(rng, yaw=0.4) for _ in range(5)]
    found = []
    for options in ({"lean_cut_off_hz": 0.0}, {"added_mass_axes": "upright"}):
        model = model_of(database, fit, irregular(), drift="slow", **options)
        model.settle(Motion.at_rest(1))
        for k, motion in enumerate(motions[:-1]):
            model.begin_step(0.1 * k, 0.1, motion)
            wrench = total(model.loads(0.1 * (k + 1), motions[k + 1]))
            model.end_step(0.1 * (k + 1), motions[k + 1])
            found.append(wrench)
    np.testing.assert_array_equal(found[:4], found[4:])


def work_of_added_mass(model, swings=5, w=0.2, steps=200):
    """Work J on the added mass in pitch and heave at w, and in surge at 2 w, over whole swings."""
    model.settle(Motion.at_rest(1))
    motion, powers, dt = Motion.at_rest(1), [], 2.0 * np.pi / w / steps
    names = [f"added_mass_{kind}_{axis}" for kind in ("force", "moment") for axis in "xyz"]
    for k in range(steps * (1 + swings)):
        model.begin_step(k * dt, dt, motion)
        at = w * dt * (k + 1)
        surge, swing = 2.0 * at + 0.25 * np.pi, 0.08 * w
        motion.rotation[0] = exp_so3(np.array([0.0, 0.08 * np.sin(at), 0.0]))
        motion.velocity[0] = [np.cos(surge), 0.0, 0.2 * np.cos(at)]
        motion.angular_velocity[0, 1] = swing * np.cos(at)
        motion.acceleration[0] = [-2.0 * w * np.sin(surge), 0.0, -0.2 * w * np.sin(at)]
        motion.angular_acceleration[0, 1] = -swing * w * np.sin(at)
        model.loads((k + 1) * dt, motion)
        model.end_step((k + 1) * dt, motion)
        record = model.record()
        load = np.array([record[name] for name in names])
        powers.append(-load @ np.concatenate([motion.velocity[0], motion.angular_velocity[0]]))
    return dt * np.sum(powers[steps:])


def test_a_slow_mean_hardly_makes_power_of_the_added_mass(database, fit):
    """Axes that turn with the motion itself would: products of velocities are not in them."""
    slow, fast = (
        work_of_added_mass(model_of(database, fit, radiation="none", lean_cut_off_hz=cut_off))
        for cut_off in (0.001, 10.0)
    )
    held = work_of_added_mass(model_of(database, fit, radiation="none", lean_cut_off_hz=0.0))
    assert abs(slow) < 0.04 * abs(fast)
    assert abs(held) < 1e-3 * abs(fast)


def test_bins_go_round():
    made = []
    bins = Bins(lambda angle: made.append(angle) or angle, 0.1)
    below, above, share = bins.around(0.25 + 2.0 * np.pi)
    assert (below, above, share) == pytest.approx((0.2, 0.3, 0.5))
    bins.around(0.27)
    assert len(made) == 2


def test_headings_that_are_not_met_are_not_asked_for(database, fit):
    """A database of one heading will do where the heading is fixed; else it is refused at once."""
    towards_x = int(np.argmin(np.abs(ROUND)))
    kept = slice(towards_x, towards_x + 1)
    one = replace(
        database, heading=ROUND[kept], excitation=database.excitation[:, kept],
        mean_drift=database.mean_drift[:, kept],
    )  # fmt: skip
    half = replace(
        database, heading=ROUND[: towards_x + 1],
        excitation=database.excitation[:, : towards_x + 1], mean_drift=None,
    )  # fmt: skip
    sea = waves([100], [1.0])
    motion = Motion.at_rest(1)
    forces = []
    for base in (one, database):
        model = model_of(base, fit, sea, heading="fixed", drift="slow")
        model.begin_step(0.0, 0.1, motion)
        forces.append(total(model.loads(0.1, motion)))
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-12, atol=1e-6)
    with pytest.raises(InputError, match="waves go towards 5 deg"):
        model_of(one, fit, sea)
    with pytest.raises(InputError, match="waves go towards 5 deg"):
        model_of(half, fit, sea)


def test_options_say_what_they_take():
    assert PlatformOptions().radiation == "state_space"
    with pytest.raises(ValidationError, match="state_space"):
        PlatformOptions(radiation="spring")
    with pytest.raises(InputError, match="cut-off"):
        MeanHeading(-0.1)
