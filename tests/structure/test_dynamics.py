"""Time integration: order in the step, conservation, joints, restart."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from galerna.contract import Loads
from galerna.errors import ConvergenceError, InputError
from galerna.structure.assembly import Structure
from galerna.structure.beam import discretise, straight
from galerna.structure.bodies import point_mass, rigid_body
from galerna.structure.checkpoint import load, save
from galerna.structure.constraints import PrescribedVelocity, TouchesPlane
from galerna.structure.frames import rotation_about
from galerna.structure.initial import under_way, velocity_violation, with_initial_accelerations
from galerna.structure.integrators import Integrator
from galerna.structure.joints import hinge, integral, on_path, prismatic, spherical, turning
from galerna.structure.scheme import Scheme, Tolerance
from galerna.structure.system import Forces, spin_twists

from .models import coupled_sections, double_pendulum, flexible_sections

Y = np.array([0.0, 1.0, 0.0])
TIGHT = Tolerance(relative=1e-12, displacement=1e-13, rotation=1e-13, velocity=1e-12,
                  angular_velocity=1e-12)  # fmt: skip


def pendulum(**options):
    """A point mass of 2 kg, 1.5 m from a hinge about y, held out along x."""
    s = Structure((0.0, 0.0, -9.81))
    s.frame("bob", [0.0, 0.0, 0.0], mass=rigid_body(2.0, [1.5, 0, 0], np.full(3, 1e-6)))
    s.join(hinge("pin", "ground", "bob", np.zeros(3), Y, **options))
    return s.build()


def run(system, dt, duration, scheme=None, state=None, tolerance=TIGHT):
    scheme = scheme or Scheme.generalized_alpha(0.8)
    integrator = Integrator(system, scheme, tolerance)
    state = with_initial_accelerations(system, system.initial_state() if state is None else state)
    *_, end = integrator.march(state, dt, round(duration / dt))
    return end


def test_pendulum_converges_at_second_order():
    exact = solve_ivp(lambda t, y: [y[1], 9.81 / 1.5 * np.cos(y[0])], (0, 1), [0, 0],
                      rtol=1e-12, atol=1e-12).y[0, -1]  # fmt: skip
    system = pendulum()
    errors = []
    for dt in (0.02, 0.01, 0.005):
        R = run(system, dt, 1.0).rotation[1]
        errors.append(abs(np.arctan2(-R[2, 0], R[0, 0]) - exact))
    rates = [np.log2(a / b) for a, b in pairwise(errors)]
    assert min(rates) > 1.9
    assert errors[-1] < 1e-4


def test_a_start_off_its_joints_is_refused():
    system = pendulum()
    state = system.initial_state()
    state.position[1, 1] += 1e-3
    with pytest.raises(InputError, match=r"pin: the initial positions violate .* 0.001"):
        with_initial_accelerations(system, state)
    with pytest.raises(InputError, match="pin"):
        next(Integrator(system).march(state, 1e-3, 1))
    s = Structure()
    s.frame("ball", [0.0, 0.0, 1.2], mass=rigid_body(1.0, None, np.ones(3)))
    s.constrain(TouchesPlane("floor", "ball", 1.0))
    system = s.build()
    with pytest.raises(InputError, match=r"floor: the initial positions violate .* 0.2"):
        with_initial_accelerations(system, system.initial_state())


def test_newmark_without_dissipation_is_of_second_order_and_warns():
    system = pendulum()
    with pytest.warns(UserWarning, match="ring"):
        scheme = Scheme.newmark(0.0)
    states = [run(system, dt, 0.5, scheme).rotation[1] for dt in (0.02, 0.01, 0.0005)]
    errors = [np.abs(R - states[-1]).max() for R in states[:2]]
    assert errors[0] / errors[1] > 3.6


def test_flexible_pendulum_converges_at_second_order_in_the_step():
    system, _, tip = double_pendulum(6, flexible_sections())
    tips = [run(system, dt, 0.4).position[tip] for dt in (4e-3, 2e-3, 1e-3, 1.25e-4)]
    errors = [np.linalg.norm(x - tips[-1]) for x in tips[:3]]
    assert min(np.log2(a / b) for a, b in pairwise(errors)) > 1.8
    end = run(system, 4e-3, 0.4)
    assert system.violation(end) < 1e-12
    assert velocity_violation(system, end) < 1e-2


def test_the_start_fits_the_joints():
    system = pendulum()
    state = with_initial_accelerations(system, system.initial_state())
    assert state.acceleration[1, 4] == pytest.approx(9.81 / 1.5, rel=1e-5)
    state.velocity[1, 0] = 1.0
    with pytest.raises(InputError, match="pin"):
        with_initial_accelerations(system, state)


def test_a_fast_start_of_two_bars_is_measured_exactly():
    """Accelerations of two hinged bars that turn at 40 and 10 rad/s: centripetal alone."""
    s = Structure((0.0, 0.0, 0.0))
    elbow = np.array([1.0, 0.0, 0.0])
    s.frame("one", np.zeros(3), mass=rigid_body(2.0, [0.5, 0, 0], np.ones(3)))
    s.frame("two", elbow, mass=rigid_body(1.0, None, np.ones(3)))
    s.join(hinge("shoulder", "ground", "one", np.zeros(3), Y))
    s.join(hinge("elbow", "one", "two", elbow, Y))
    system = s.build()
    state = system.initial_state()
    state.velocity[1, 4], state.velocity[2, 4], state.velocity[2, 2] = 40.0, 10.0, -40.0
    state = with_initial_accelerations(system, state)
    assert np.allclose(state.motion(np.array([2])).acceleration, [-1600.0, 0, 0], atol=1e-2)


def test_the_start_feels_the_mass_of_a_load():
    """Water that answers an acceleration: the load's mass block takes part."""
    s = Structure((0.0, 0.0, -10.0))
    turn = rotation_about(0, 0.7)
    s.frame("float", np.zeros(3), turn, mass=rigid_body(1.0, None, np.ones(3)))
    system = s.build()
    forces = Forces.none(2)
    forces.mass = np.zeros((2, 6, 6))
    forces.mass[1] = np.diag([0.0, 0.0, 3.0, 1.0, 1.0, 1.0])
    start = with_initial_accelerations(system, system.initial_state(), forces)
    assert np.allclose(start.motion(np.array([1])).acceleration, [0, 0, -2.5], atol=1e-12)


def test_free_flight_keeps_momentum_and_energy():
    """A soft coupled beam thrown and turning: momentum drift falls at second order."""
    s = Structure((0.0, 0.0, 0.0))
    s.beam("beam", discretise(straight(np.zeros(3), np.eye(3), 2.0), 2.0, coupled_sections(),
                              np.linspace(0, 1, 5)))  # fmt: skip
    system = s.build()
    start = system.initial_state()
    start.velocity = spin_twists(start, np.array([0.3, -0.2, 0.5]), np.array([3.0, 1.0, -2.0]))
    start.velocity[1:, :3] += np.einsum("nji,j->ni", start.rotation[1:], [1.0, 2.0, 3.0])
    start.velocity[-1, 3:] += [1.0, 2.0, 0.5]
    before, energy = system.momentum(start), sum(system.energies(start))
    drift = []
    for dt in (2e-3, 1e-3):
        end = run(system, dt, 0.2, Scheme.generalized_alpha(0.9), start)
        drift.append(np.abs(system.momentum(end) - before).max() / np.abs(before).max())
        assert sum(system.energies(end)) < energy * (1 + 1e-4)
    assert drift[0] / drift[1] > 3.5
    assert drift[1] < 1e-5


def test_driven_hinge_and_moving_path_follow_time():
    angle = lambda t: 0.4 * np.sin(2 * t)  # noqa: E731
    system = pendulum(angle=angle)
    start = system.initial_state()
    start.velocity[1] = [0, 0, 0, 0, 0.8, 0]
    R = run(system, 0.01, 7.0, state=start).rotation[1]
    assert np.arctan2(-R[2, 0], R[0, 0]) == pytest.approx(angle(7.0), abs=1e-9)
    s = Structure()
    s.frame("cart", np.zeros(3), mass=rigid_body(1.0, None, np.ones(3)))
    s.join(on_path("rail", "cart", lambda t: (np.array([t**2, 0.0, 0.0]), np.eye(3))))
    end = run(s.build(), 0.01, 1.0)
    assert end.position[1, 0] == pytest.approx(1.0, abs=1e-9)
    assert end.acceleration[1, 0] == pytest.approx(2.0, abs=0.02)


def test_driven_speed_turns_many_times():
    system = pendulum(speed=lambda t: 10.0)
    start = system.initial_state()
    start.velocity[1, 4] = 10.0
    R = run(system, 0.01, 2.0, state=start).rotation[1]
    assert np.exp(1j * np.arctan2(-R[2, 0], R[0, 0])) == pytest.approx(np.exp(20j), abs=1e-9)


def test_a_path_away_from_the_origin_is_followed():
    turn = lambda t: rotation_about(2, 0.5 + t)  # noqa: E731
    path = lambda t: (np.array([5.0 + t**2, -2.0, 1.0]), turn(t))  # noqa: E731
    s = Structure()
    s.frame("cart", *path(0.0), mass=rigid_body(1.0, None, np.ones(3)))
    s.join(on_path("rail", "cart", path))
    system = s.build()
    start = system.initial_state()
    start.velocity[1, 5] = 1.0
    assert system.violation(start) < 1e-14
    end = run(system, 0.01, 1.0, state=start)
    assert np.allclose(end.position[1], path(1.0)[0], atol=1e-9)
    assert np.allclose(end.rotation[1], path(1.0)[1], atol=1e-9)


def test_the_angle_of_a_driven_speed_is_smooth_to_rounding():
    """Noise of 1e-8 rad would be 1e-2 rad/s2 and more at a step of 1 ms."""
    angle = integral(lambda t: min(t, 0.3))
    for t in (-0.5, 0.2, 0.7, 9.3, 30.002):
        exact = 0.5 * t * t if t < 0.3 else 0.3 * t - 0.045
        assert angle(t) == pytest.approx(exact, abs=1e-13)


def test_a_torque_turns_a_hinge_and_pushes_back():
    s = Structure((0.0, 0.0, 0.0))
    s.frame("stator", np.zeros(3), mass=rigid_body(1.0, None, np.full(3, 4.0)))
    s.frame("rotor", np.zeros(3), mass=rigid_body(1.0, None, np.full(3, 2.0)))
    s.join(spherical("ball", "ground", "stator", np.zeros(3)))
    s.join(hinge("shaft", "stator", "rotor", np.zeros(3), Y))
    system = s.build()
    system.set_torque("shaft", 6.0)
    end = run(system, 0.01, 0.5)
    assert end.velocity[2, 4] == pytest.approx(1.5, rel=1e-9)
    assert end.velocity[1, 4] == pytest.approx(-0.75, rel=1e-9)


def test_a_slider_falls_along_its_axis():
    s = Structure((0.0, 0.0, -10.0))
    s.frame("block", np.zeros(3), mass=rigid_body(1.0, None, np.ones(3)))
    s.join(prismatic("rail", "ground", "block", np.zeros(3), np.array([1.0, 0.0, -1.0])))
    end = run(s.build(), 0.01, 1.0)
    assert np.allclose(end.position[1], [2.5, 0, -2.5], atol=1e-9)


def test_a_prescribed_velocity_is_kept():
    s = Structure()
    s.frame("puck", np.zeros(3), mass=rigid_body(1.0, None, np.ones(3)))
    s.constrain(PrescribedVelocity("drive", "puck", (0, 1, 2), lambda t: np.array([1.0, t, 0.0])))
    start = s.build().initial_state()
    start.velocity[1, 0] = 1.0
    end = run(s.build(), 0.01, 1.0, state=start)
    assert np.allclose(end.position[1], [1.0, 0.5, 0.0], atol=1e-4)


def test_added_mass_slows_but_does_not_weigh():
    s = Structure((0.0, 0.0, -10.0))
    s.frame("float", np.zeros(3), mass=rigid_body(1.0, None, np.ones(3)))
    s.add_mass("float", 3.0 * np.eye(6), weighs=False)
    start = with_initial_accelerations(s.build(), s.build().initial_state())
    assert start.acceleration[1, 2] == pytest.approx(-2.5)


def test_loads_are_asked_in_the_trial_state():
    """A drag that depends on the velocity: terminal speed."""
    s = Structure((0.0, 0.0, -10.0))
    s.frame("ball", np.zeros(3), mass=point_mass(1.0) + rigid_body(0.0, None, np.ones(3)))
    system = s.build()

    def drag(state):
        forces = Forces.none(2)
        forces.dead[1, :3] = -5.0 * state.motion(np.array([1])).velocity[0]
        return forces

    integrator = Integrator(system, tolerance=TIGHT)
    *_, end = integrator.march(system.initial_state(), 0.02, 200, drag)
    assert end.velocity[1, 2] == pytest.approx(-2.0, rel=1e-6)


def test_a_restart_gives_the_same_bits(tmp_path):
    system, *_ = double_pendulum(3, flexible_sections())
    integrator = Integrator(system)
    state = with_initial_accelerations(system, system.initial_state())
    *_, half = integrator.march(state, 1e-3, 10)
    save(half, tmp_path / "half.npz")
    *_, straight_on = integrator.march(half, 1e-3, 10)
    again, *_ = double_pendulum(3, flexible_sections())
    *_, resumed = Integrator(again).march(load(again, tmp_path / "half.npz"), 1e-3, 10)
    assert resumed.position.tobytes() == straight_on.position.tobytes()
    assert resumed.velocity.tobytes() == straight_on.velocity.tobytes()
    with pytest.raises(InputError, match="frames"):
        load(pendulum(), tmp_path / "half.npz")


@pytest.mark.parametrize("keep", [0, 400])
def test_a_damaged_checkpoint_is_refused(tmp_path, keep):
    system, path = pendulum(), tmp_path / "state"
    save(system.initial_state(), path)
    assert load(system, path).time == 0.0
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(InputError, match="not a checkpoint"):
        load(system, path)


@pytest.mark.parametrize("dt", [0.0, -0.01, np.nan, np.inf])
def test_a_step_must_go_forward(dt):
    system = pendulum()
    with pytest.raises(InputError, match="time step"):
        Integrator(system).step(system.initial_state(), dt)


def test_an_impossible_step_says_when_and_where():
    system = pendulum()

    def absurd(state):
        forces = Forces.none(2)
        forces.dead[1] = np.nan
        return forces

    with pytest.raises(ConvergenceError, match=r"bob at t ="):
        Integrator(system).step(system.initial_state(), 0.01, absurd)


def test_settings_out_of_range_are_refused():
    with pytest.raises(InputError, match="rho_inf"):
        Scheme.generalized_alpha(1.2)
    with pytest.warns(UserWarning, match="weakly unstable"):
        Scheme.generalized_alpha(1.0)


def test_a_load_model_meets_its_frames():
    system = pendulum()
    loads = Loads(np.ones((2, 3)), np.full((2, 3), 2.0), np.tile(np.eye(6), (2, 1, 1)))
    forces = Forces.of(len(system), np.array([1, 1]), loads)
    assert np.allclose(forces.dead, [[0] * 6, [2, 2, 2, 4, 4, 4]])
    assert np.allclose(forces.stiffness[1], 2 * np.eye(6))
    assert forces.mass is None


def test_a_damper_sees_its_joint_without_the_drive():
    """A body on a driven spring and damper turns with the drive and lags by nothing."""
    rate, k, c = 0.3, 2e3, 1e3
    s = Structure((0.0, 0.0, 0.0))
    s.frame("head", np.zeros(3), mass=rigid_body(10.0, None, np.full(3, 5.0)))
    bearing = hinge("bearing", "ground", "head", np.zeros(3), np.array([0.0, 0, 1]),
                    stiffness=k, damping=c)  # fmt: skip
    s.join(replace(bearing, placement=turning(lambda t: rate * t)))
    system = s.build()
    start = system.initial_state()
    start.velocity[1, 5] = rate
    end = run(system, 0.01, 1.0, state=start)
    assert np.arctan2(end.rotation[1, 1, 0], end.rotation[1, 0, 0]) == pytest.approx(rate, abs=1e-9)
    assert system.dissipation(end) < 1e-9


def test_an_inertance_resists_the_relative_spin():
    """Two free bodies on a hinge: Newton's equations of both, in the start and after a while."""
    first, second, between, torque = 7.0, 2.0, 30.0, 5.0
    s = Structure((0.0, 0.0, 0.0))
    for name, inertia in (("first", first), ("second", second)):
        s.frame(name, np.zeros(3), mass=rigid_body(1.0, None, np.full(3, inertia)))
    axis = np.array([0.0, 0.0, 1.0])
    s.join(hinge("shaft", "first", "second", np.zeros(3), axis, inertance=between))
    system = s.build()
    system.set_torque("shaft", torque)
    matrix = np.array([[first + between, -between], [-between, second + between]])
    rates = np.linalg.solve(matrix, [-torque, torque])
    start = with_initial_accelerations(system, system.initial_state())
    assert start.acceleration[1:, 5] == pytest.approx(rates, rel=1e-9)
    end = run(system, 0.01, 1.0, state=start)
    assert end.velocity[1:, 5] == pytest.approx(rates, rel=1e-7)
    work = torque * 0.5 * (rates[1] - rates[0])
    assert system.energies(end)[0] == pytest.approx(work, rel=1e-7)


def test_a_driven_joint_starts_without_ringing():
    """A start under way has the accelerations of the path within what the step leaves later."""
    dt, rate = 0.02, 2.0
    path = lambda t: (np.array([np.sin(rate * t), 0.0, 0.0]), rotation_about(1, 0.3 * t + t**3))  # noqa: E731
    s = Structure((0.0, 0.0, 0.0))
    s.frame("cart", np.zeros(3), mass=rigid_body(1.0, None, np.ones(3)))
    s.join(on_path("rail", "cart", path))
    system, integrator = s.build(), Integrator(s.build(), tolerance=TIGHT)
    exact = system.initial_state()
    exact.velocity[1] = [rate, 0.0, 0.0, 0.0, 0.3, 0.0]
    exact = with_initial_accelerations(system, exact)
    ringing = []
    for start in (exact, under_way(system, exact, integrator.scheme, dt)):
        errors = []
        for state in integrator.march(start, dt, 30):
            body = state.acceleration[1, :3] + np.cross(
                state.velocity[1, 3:], state.velocity[1, :3]
            )
            linear = (state.rotation[1] @ body)[0] + rate**2 * np.sin(rate * state.time)
            errors.append(max(abs(linear), abs(state.acceleration[1, 4] - 6.0 * state.time)))
        ringing.append(max(errors))
    jerk = rate**3
    assert ringing[0] > dt * jerk
    assert ringing[1] < dt**2 * jerk
