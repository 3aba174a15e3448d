"""Blade-element momentum as a load model: physics of the loads, and the contract."""

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.bem import strips
from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import UniformWind
from galerna.aero.rigid_rotor import rigid_rotor_motion, rotation_about
from galerna.contract import LoadModel, Motion
from galerna.errors import ConvergenceError, InputError
from galerna.units import DEG, RPM
from tests.machines import small_turbine

QUASI_STEADY = BemOptions(quasi_steady=True, tower_influence=False)
UNSTEADY = BemOptions(tower_influence=False)
SPEED = 9.16 * RPM


@pytest.fixture(scope="module")
def nrel():
    return turbine.load("nrel5mw")


def model_in(machine, wind, options=QUASI_STEADY):
    return BladeElementMomentum(machine, UniformWind(np.asarray(wind, float)), options=options)


def step(model, motion, dt=0.05):
    model.begin_step(0.0, dt, motion)
    loads = model.loads(dt, motion)
    model.end_step(dt, motion)
    return loads


def run(model, machine, turns, steps, pitch=0.0, speed=SPEED):
    """Records over the last turn, by azimuth."""
    dt = 2.0 * np.pi / speed / steps
    records = []
    for k in range(turns * steps):
        azimuth = 2.0 * np.pi * k / steps
        now = rigid_rotor_motion(machine, model.sections, azimuth, speed, pitch)
        then = rigid_rotor_motion(
            machine, model.sections, azimuth + 2.0 * np.pi / steps, speed, pitch
        )
        model.begin_step(k * dt, dt, now)
        model.loads((k + 1) * dt, then)
        model.end_step((k + 1) * dt, then)
        records.append(model.record())
    return records[-steps:]


def copied(motion):
    return Motion(*(getattr(motion, name).copy() for name in Motion.__slots__))


def test_it_is_a_load_model(nrel):
    model = model_in(nrel, [8, 0, 0], BemOptions())
    assert isinstance(model, LoadModel)
    assert [s.part for s in model.stations] == ["blade1", "blade2", "blade3", "hub", "tower"]
    names = [c.name for c in model.channels]
    assert len(set(names)) == len(names)


def test_records_hold_every_channel_in_its_shape(nrel):
    model = model_in(nrel, [8, 0, 0])
    step(model, rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, 0.0))
    record = model.record()
    assert set(record) == {c.name for c in model.channels}
    for channel in model.channels:
        shape = tuple(len(model.coordinates[d]) for d in channel.dims)
        assert np.shape(record[channel.name]) == shape
        assert np.all(np.isfinite(record[channel.name]))


@pytest.mark.parametrize("options", [QUASI_STEADY, UNSTEADY])
def test_steady_axial_flow_starts_without_a_transient(nrel, options):
    model = model_in(nrel, [8, 0, 0], options)
    records = run(model, nrel, 1, 30)
    thrust = [r["rotor_thrust"] for r in records]
    assert np.ptp(thrust) < 1e-6 * thrust[0]


def test_unsteady_and_quasi_steady_agree_in_steady_flow(nrel):
    loads = [
        step(
            (model := model_in(nrel, [8, 0, 0], options)),
            rigid_rotor_motion(nrel, model.sections, 0.3, SPEED, 0.02),
        )
        for options in (QUASI_STEADY, UNSTEADY)
    ]
    assert loads[0].force == pytest.approx(loads[1].force, rel=1e-9, abs=1e-6)


def test_lumped_loads_are_the_integral_of_the_distributed_ones(nrel):
    straight = replace(nrel, hub=replace(nrel.hub, cone=0.0))
    model = model_in(straight, [10, 0, 0])
    loads = step(model, rigid_rotor_motion(straight, model.sections, 0.0, SPEED, 0.0))
    record, radius = model.record(), model.coordinates["radius"]
    thrust = 3 * np.trapezoid(record["normal_force"][0], radius)
    assert loads.force[:, 0].sum() == pytest.approx(thrust, rel=1e-9)
    # torque of a piecewise linear load: r F is quadratic, Simpson's rule is exact
    middle = 0.5 * (radius[1:] + radius[:-1])
    force = record["tangential_force"][0]
    between = 0.5 * (force[1:] + force[:-1])
    step_ = np.diff(radius)
    torque = 3 * np.sum(
        step_ / 6 * (force[1:] * radius[1:] + force[:-1] * radius[:-1] + 4 * between * middle)
    )
    assert record["rotor_torque"] == pytest.approx(torque, rel=2e-3)  # section moments are small
    assert record["rotor_power"] == pytest.approx(record["rotor_torque"] * SPEED, rel=1e-12)


def test_root_moments_follow_from_the_loads(nrel):
    model = model_in(nrel, [8, 0, 0])
    motion = rigid_rotor_motion(nrel, model.sections, 0.7, SPEED, 0.0)
    loads = step(model, motion)
    n = len(model.sections)
    axes = rotation_about(0, 0.7) @ rotation_about(1, -nrel.hub.cone)
    root = nrel.hub.radius * axes[:, 2]
    arms = motion.position[:n] - root
    moment = (np.cross(arms, loads.force[:n]) + loads.moment[:n]).sum(axis=0) @ axes
    record = model.record()
    assert record["aerodynamic_root_in_plane_moment"][0] == pytest.approx(moment[0], rel=1e-9)
    assert record["aerodynamic_root_out_of_plane_moment"][0] == pytest.approx(moment[1], rel=1e-9)
    assert moment[1] > 0.0  # thrust bends the blade downwind


def test_loads_do_not_depend_on_where_the_machine_stands_or_looks(nrel):
    wind = np.array([8.0, 1.0, 0.5])
    base = model_in(nrel, wind)
    motion = rigid_rotor_motion(nrel, base.sections, 0.4, SPEED, 0.05)
    here = step(base, motion)
    turn = rotation_about(2, 0.8) @ rotation_about(1, -0.3)
    drift = np.array([3.0, -2.0, 0.7])
    moved = copied(motion)
    moved.position[:] = motion.position @ turn.T + np.array([100.0, 50.0, -20.0])
    moved.rotation[:] = turn @ motion.rotation
    moved.velocity[:] = motion.velocity @ turn.T + drift
    moved.angular_velocity[:] = motion.angular_velocity @ turn.T
    there = step(model_in(nrel, turn @ wind + drift), moved)
    assert there.force == pytest.approx(here.force @ turn.T, rel=1e-6, abs=1e-3)
    assert there.moment == pytest.approx(here.moment @ turn.T, rel=1e-6, abs=1e-3)


def test_loads_are_pure_and_repeat_to_the_bit(nrel):
    model = model_in(nrel, [8, 2, 0], UNSTEADY)
    run(model, nrel, 1, 12)
    motion = rigid_rotor_motion(nrel, model.sections, 0.2, SPEED, 0.0)
    other = rigid_rotor_motion(nrel, model.sections, 1.2, 1.3 * SPEED, 0.2)
    before = model.state()
    model.begin_step(1.0, 0.1, motion)
    first = model.loads(1.1, motion)
    model.loads(1.1, other)
    again = model.loads(1.1, motion)
    assert np.array_equal(first.force, again.force)
    assert np.array_equal(first.moment, again.moment)
    assert all(np.array_equal(before[k], v) for k, v in model.state().items())
    model.loads(1.1, other)
    model.loads(1.1, motion)
    model.end_step(1.1, motion)  # commits the last loads, whatever was asked before
    committed = model.state()
    model.restore(before)
    model.begin_step(1.0, 0.1, motion)
    model.loads(1.1, motion)
    model.end_step(1.1, motion)
    assert all(np.array_equal(committed[k], v) for k, v in model.state().items())


def test_a_repeated_trial_replaces_the_first(nrel):
    model = model_in(nrel, [8, 0, 0], UNSTEADY)
    run(model, nrel, 1, 12)
    motion = rigid_rotor_motion(nrel, model.sections, 0.2, 1.1 * SPEED, 0.0)
    model.begin_step(1.0, 0.2, motion)
    model.loads(1.2, motion)
    model.begin_step(1.0, 0.1, motion)
    halved = model.loads(1.1, motion)
    model.begin_step(1.0, 0.1, motion)
    assert np.array_equal(model.loads(1.1, motion).force, halved.force)


def test_resume_gives_the_same_bits(nrel):
    wind = [9.0, 3.0, 0.0]
    model = model_in(nrel, wind, UNSTEADY)
    run(model, nrel, 1, 12)
    state = model.state()
    onward = run(model, nrel, 1, 12)
    resumed = model_in(nrel, wind, UNSTEADY)
    resumed.restore(state)
    again = run(resumed, nrel, 1, 12)
    for one, other in zip(onward, again, strict=True):
        assert all(np.array_equal(one[name], other[name]) for name in one)


def test_yaw_to_either_side_mirrors_the_azimuth(nrel):
    """Wind from the left at azimuth psi loads a blade as wind from the right at 180 - psi.

    The mirror plane contains the shaft and is turned by the rotation's sense: reversing the
    lateral wind turns the whole picture by half a turn.
    """
    plain = replace(nrel, hub=replace(nrel.hub, cone=0.0))
    loads = []
    for side in (3.0, -3.0):
        model = model_in(plain, [8.0, side, 0.0])
        half_turn = 0.0 if side > 0 else np.pi
        motion = rigid_rotor_motion(plain, model.sections, 0.6 + half_turn, SPEED, 0.0)
        step(model, motion)
        loads.append(model.record()["normal_force"])
    assert loads[0] == pytest.approx(loads[1], rel=1e-8)


def test_skewed_wake_loads_the_upwind_side(nrel):
    """Yaw error +30 deg: the load at 0.75R peaks near 270 deg with a skewed wake, not without."""
    wind = 10.0 * np.array([np.cos(30 * DEG), np.sin(-30 * DEG), 0.0])  # in shaft axes
    peaks, troughs = {}, {}
    for skewed in ("none", "pitt_peters", "vortex_cylinder"):
        options = UNSTEADY.model_copy(update={"skewed_wake": skewed})
        model = model_in(nrel, wind, options)
        records = run(model, nrel, 4, 36, speed=1.2)
        station = int(np.argmin(np.abs(model.coordinates["radius"] - 0.75 * 63.0)))
        load = np.array([r["normal_force"][0, station] for r in records])
        azimuth = (np.arange(36) + 1) * 10.0 % 360.0
        peaks[skewed], troughs[skewed] = azimuth[load.argmax()], azimuth[load.argmin()]
    assert peaks["none"] == pytest.approx(180.0, abs=20.0)
    for skewed in ("pitt_peters", "vortex_cylinder"):
        assert peaks[skewed] == pytest.approx(270.0, abs=40.0)
        assert troughs[skewed] == pytest.approx(90.0, abs=40.0)


def test_vibration_out_of_plane_is_damped(nrel):
    """A blade that moves downwind loses thrust: the work done on a flap cycle is negative."""
    for options in (QUASI_STEADY, UNSTEADY):
        model = model_in(nrel, [8, 0, 0], options)
        n, work, dt = len(model.sections), 0.0, 0.05
        rest = rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, 0.0)
        step(model, rest, dt)
        for k in range(80):
            motion = copied(rest)
            velocity = 0.5 * np.cos(2 * np.pi * k / 40)
            motion.velocity[:n, 0] += velocity * model.sections.span
            loads = step(model, motion, dt)
            if k >= 40:
                work += dt * velocity * (loads.force[:n, 0] * model.sections.span).sum()
        assert work < 0.0


def test_pitch_to_feather_lowers_the_thrust(nrel):
    thrusts = []
    for pitch in (0.0, 0.05, 0.1):
        model = model_in(nrel, [10, 0, 0])
        step(model, rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, pitch))
        thrusts.append(model.record()["rotor_thrust"])
    assert thrusts[0] > thrusts[1] > thrusts[2]


def test_individual_pitch_acts_on_its_blade_alone(nrel):
    model = model_in(nrel, [10, 0, 0])
    even = rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, 0.0)
    uneven = copied(even)
    n = len(model.sections)
    uneven.rotation[:n] = rigid_rotor_motion(
        nrel, model.sections, 0.0, SPEED, 0.1, blades=1
    ).rotation[:n]
    normal = []
    for motion in (even, uneven):
        step(model, motion)
        normal.append(model.record()["normal_force"].copy())
    assert normal[1][0, 10] < 0.8 * normal[0][0, 10]
    assert np.allclose(normal[0][1:], normal[1][1:], rtol=1e-6)


@pytest.mark.parametrize(
    ("wind", "speed", "pitch"),
    [
        ([12.0, 0, 0], 0.0, 0.0),  # stopped rotor
        ([30.0, 5, 2], 0.0, 1.55),  # parked, feathered
        ([0.0, 0, 0], 1.2, 0.0),  # no wind
        ([0.0, 0, 0], 0.0, 0.0),  # nothing at all
        ([-10.0, 0, 0], 1.0, 0.0),  # wind from behind
        ([8.0, 0, 0], -1.0, 0.0),  # turning backwards
        ([0.0, 15.0, 0], 0.3, 0.5),  # wind across the shaft
    ],
)
@pytest.mark.parametrize("options", [QUASI_STEADY, UNSTEADY])
def test_every_state_of_the_machine_has_finite_loads(nrel, wind, speed, pitch, options):
    model = model_in(nrel, wind, options)
    for azimuth in (0.0, 0.1, 0.2):
        motion = rigid_rotor_motion(nrel, model.sections, azimuth, speed, pitch)
        loads = step(model, motion)
        assert np.all(np.isfinite(loads.force))
        assert np.all(np.isfinite(loads.moment))
        assert np.abs(loads.force).sum(axis=0).max() < 5e6
    if not np.any(wind) and speed == 0.0:
        assert np.abs(loads.force).max() < 1e-6


def test_a_spinning_rotor_in_a_calm_is_braked(nrel):
    model = model_in(nrel, [0, 0, 0])
    step(model, rigid_rotor_motion(nrel, model.sections, 0.0, 1.2, 0.0))
    assert model.record()["rotor_torque"] < 0.0


def test_dynamic_inflow_overshoots_after_a_pitch_step(nrel):
    """Thrust falls below its new level at first, because the induction is still the old one."""
    model = model_in(nrel, [8, 0, 0], UNSTEADY)
    thrust = []
    for k in range(1200):
        pitch = 0.0 if k == 0 else 3.7 * DEG
        motion = rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, pitch)
        step(model, motion, 0.05)
        thrust.append(model.record()["rotor_thrust"])
    settled = thrust[-1]
    assert thrust[20] < 0.95 * settled
    quasi = model_in(nrel, [8, 0, 0])
    step(quasi, rigid_rotor_motion(nrel, quasi.sections, 0.0, SPEED, 3.7 * DEG))
    assert settled == pytest.approx(quasi.record()["rotor_thrust"], rel=1e-3)


def test_filter_lowers_the_response_to_a_spanwise_wave(nrel):
    class Wave:
        def velocity(self, points, time):
            radius = np.linalg.norm(points, axis=1)
            wind = np.zeros_like(points)
            wind[:, 0] = 8.0 + np.sin(2 * np.pi * radius / 15.0)
            return wind

    waviness = {}
    for choice in ("off", "loads", "feedback"):
        options = BemOptions(
            quasi_steady=True, tower_influence=False, spanwise_filter=choice, stations=60
        )
        model = BladeElementMomentum(nrel, Wave(), options=options)
        step(model, rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, 0.0))
        force = model.record()["normal_force"][0, 25:50]
        waviness[choice] = np.abs(np.diff(force, 2)).sum()
    assert waviness["loads"] < 0.7 * waviness["off"]
    assert waviness["feedback"] < waviness["off"]


def test_switched_off_induction_is_pure_blade_element(nrel):
    model = model_in(nrel, [8, 0, 0], QUASI_STEADY.model_copy(update={"induction": False}))
    step(model, rigid_rotor_motion(nrel, model.sections, 0.0, SPEED, 0.0))
    assert np.all(model.record()["axial_induction"] == 0.0)


def test_polar_that_ends_too_early_is_reported():
    machine = small_turbine()
    plate = machine.airfoils["plate"]
    polar = plate.polars[0]
    part = np.abs(polar.angle_of_attack) < 0.2
    short = replace(
        polar,
        angle_of_attack=polar.angle_of_attack[part],
        lift=polar.lift[part],
        drag=polar.drag[part],
        moment=polar.moment[part],
    )
    machine = replace(machine, airfoils={"plate": replace(plate, polars=(short,))})
    model = model_in(machine, [10, 0, 0])
    with pytest.raises(InputError, match="plate"):
        step(model, rigid_rotor_motion(machine, model.sections, 0.0, 0.0, 0.0))


def test_blade_inside_the_tower_is_an_error(nrel):
    model = model_in(nrel, [8, 0, 0], BemOptions(quasi_steady=True))
    rotor = rigid_rotor_motion(nrel, model.sections, np.pi, SPEED, 0.0)
    motion = Motion.at_rest(sum(map(len, model.stations)))
    for name in Motion.__slots__:
        getattr(motion, name)[: len(rotor.position)] = getattr(rotor, name)
    tower = nrel.tower.axis - np.array([0.0, 0.0, 90.0])
    motion.position[len(rotor.position) :] = tower  # the hub stands over the tower's axis
    with pytest.raises(ConvergenceError, match=r"blade1.*inside the tower"):
        model.loads(0.1, motion)


def test_strip_columns_do_not_overlap():
    columns = [v for k, v in vars(strips).items() if k.isupper() and isinstance(v, int)]
    assert max(columns) == strips.STRIP_COLUMNS
