"""A platform that floats: loads with tangents on frames, equilibrium, decay, spar models."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.linalg import eig

from galerna.case import load as load_case
from galerna.contract import Loads, Motion, Stations
from galerna.coupling.afloat import build_water
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.floating import Burden, Pose, WaterAtRest
from galerna.coupling.floating_report import modes_of
from galerna.errors import InputError
from galerna.hydro.heading import lean_of
from galerna.structure import TurbineOptions, with_initial_accelerations
from galerna.structure.attachment import Attachment
from galerna.structure.foundation import Spar
from galerna.structure.frames import exp_so3, log_so3
from galerna.structure.joints import ALL
from galerna.structure.modes import natural_modes
from galerna.structure.system import Forces
from galerna.turbine import load

OC3 = load("nrel5mw_oc3")
RIGID = TurbineOptions(
    blade_elements=0, tower_elements=0, flexible_shaft=False, flexible_yaw=False, rotor="locked"
)
BUOYANCY = 80.708e6  #: N
RESTORING = np.diag([41180.0, 41180.0, 344881.0, -4.688e9, -4.688e9, 1.0e8])
ADDED_MASS = np.diag([7.98e6, 7.98e6, 2.4e5, 3.79e10, 3.79e10, 0.0])
ADDED_MASS[0, 4] = ADDED_MASS[4, 0] = -4.94e8
ADDED_MASS[1, 3] = ADDED_MASS[3, 1] = 4.94e8


@dataclass
class Water:
    """Buoyancy, a restoring matrix and an added mass, on the platform's frame."""

    buoyancy: float = BUOYANCY
    restoring: np.ndarray = None
    added_mass: np.ndarray = None
    stations = (Stations("platform"),)

    def loads(self, time: float, motion: Motion) -> Loads:
        K = RESTORING if self.restoring is None else self.restoring
        A = ADDED_MASS if self.added_mass is None else self.added_mass
        moved = np.concatenate([motion.position[0], log_so3(motion.rotation[0])])
        rate = np.concatenate([motion.acceleration[0], motion.angular_acceleration[0]])
        wrench = -K @ moved - A @ rate
        wrench[2] += self.buoyancy
        return Loads(wrench[None, :3], wrench[None, 3:], K[None], np.zeros((1, 6, 6)), A[None])


def floating(options: TurbineOptions = RIGID) -> FlexibleMachine:
    return FlexibleMachine(OC3, [Water.stations], options)


def rigid_mass(machine: FlexibleMachine) -> tuple[np.ndarray, float, np.ndarray]:
    """Mass matrix (6,6) about the origin, mass and centre of a machine as it was described."""
    system, total = machine.system, np.zeros((6, 6))
    for i in range(1, len(system)):
        x, R = system.position[i], system.rotation[i]
        carry = np.zeros((6, 6))
        carry[:3, :3] = carry[3:, 3:] = R.T
        carry[:3, 3:] = R.T @ np.array([[0, x[2], -x[1]], [-x[2], 0, x[0]], [x[1], -x[0], 0]])
        total += carry.T @ system.mass[i] @ carry
    mass = total[0, 0]
    return total, mass, np.array([total[1, 5], total[2, 3], total[0, 4]]) / mass


def march(machine: FlexibleMachine, water: Water, displaced: np.ndarray, dt: float, steps: int):
    """Platform motions (steps,6) after a release at rest."""
    state = machine.system.initial_state()
    turned = exp_so3(displaced[3:])
    state.position[1:] = displaced[:3] + state.position[1:] @ turned.T
    state.rotation[1:] = turned @ state.rotation[1:]
    machine.start(state)
    forces = machine.forces([water.loads(0.0, machine.motions[0])])
    machine.start(with_initial_accelerations(machine.system, state, forces))
    found = []
    for step in range(steps):
        machine.predict(step * dt, dt)
        for _ in range(8):
            if machine.balance([water.loads(0.0, machine.motions[0])]):
                break
        else:
            pytest.fail("no balance in 8 evaluations")
        machine.accept()
        found.append(machine.platform_motion())
    return np.array(found)


def heave_only() -> Water:
    return Water(rigid_mass(floating())[1] * 9.80665)


def test_heave_swings_with_the_added_mass() -> None:
    machine, water = floating(), heave_only()
    _, mass, _ = rigid_mass(machine)
    rate = np.sqrt(RESTORING[2, 2] / (mass + ADDED_MASS[2, 2]))
    dt, steps = 0.25, 200
    options = TurbineOptions(**{**RIGID.__dict__, "base_motion": Pose(np.zeros(3), np.eye(3)),
                                "base_locked": (0, 1, 3, 4, 5)})  # fmt: skip
    motion = march(floating(options), water, np.array([0, 0, 2.0, 0, 0, 0]), dt, steps)
    exact = 2.0 * np.cos(rate * dt * np.arange(1, steps + 1))
    assert motion[:, 2] == pytest.approx(exact, abs=0.03)
    assert np.abs(motion[:, [0, 1, 3, 4, 5]]).max() < 1e-9


def test_natural_frequencies_are_those_of_the_rigid_body() -> None:
    machine, water = floating(), heave_only()
    M, mass, center = rigid_mass(machine)
    K = RESTORING.copy()
    K[3, 3] -= mass * 9.80665 * center[2]
    K[4, 4] -= mass * 9.80665 * center[2]
    K[5, 3] += mass * 9.80665 * center[0]
    squares = np.linalg.eigvals(np.linalg.solve(M + ADDED_MASS, K))
    wanted = np.sort(np.sqrt(squares.real)) / (2.0 * np.pi)
    state = machine.system.initial_state()
    machine.start(state)
    forces = machine.forces([water.loads(0.0, machine.motions[0])])
    found = natural_modes(machine.system, state, 6, forces).frequency
    assert found == pytest.approx(wanted, rel=2e-3)


def test_equilibrium_under_a_thrust_balances_every_load() -> None:
    machine = floating()
    _, mass, center = rigid_mass(machine)
    gravity = np.array([0.0, 0.0, -9.80665])
    thrust = np.array([4e5, 0, 0, 0, 4e5 * 90.0, 0])
    water, burden = WaterAtRest({"water": Water()}), Burden(mass, center, thrust)
    pose = water.equilibrium(burden, Pose(np.zeros(3), np.eye(3)), gravity)
    residual, _ = water.balance(burden, pose, gravity)
    assert np.abs(residual).max() < 1e-4 * mass
    assert pose.position[0] == pytest.approx(4e5 / 41180.0, rel=1e-6)
    assert log_so3(pose.rotation)[1] == pytest.approx(
        4e5 * 90 / (-4.688e9 - mass * 9.80665 * center[2]), rel=0.05
    )


def test_locked_directions_stay() -> None:
    _, mass, center = rigid_mass(floating())
    water = WaterAtRest({"water": Water()}, locked=(0, 4))
    burden = Burden(mass, center, np.array([4e5, 1e5, 0, 0, 4e7, 0]))
    pose = water.equilibrium(burden, Pose(np.zeros(3), np.eye(3)), np.array([0, 0, -9.80665]))
    assert pose.position[0] == 0.0
    assert pose.position[1] == pytest.approx(1e5 / 41180.0, rel=1e-6)
    assert abs(log_so3(pose.rotation)[1]) < 1e-12


def test_an_unstable_platform_is_refused() -> None:
    _, mass, center = rigid_mass(floating())
    unstable = RESTORING.copy()
    unstable[2, 2] = -1e5
    water = WaterAtRest({"water": Water(restoring=unstable)})
    burden = Burden(1.01 * mass, center, np.zeros(6))
    with pytest.raises(InputError, match="unstable in heave"):
        water.equilibrium(burden, Pose(np.zeros(3), np.eye(3)), np.array([0, 0, -9.80665]))


def test_a_platform_that_drifts_away_is_refused() -> None:
    _, mass, center = rigid_mass(floating())
    adrift = RESTORING.copy()
    adrift[0, 0] = 0.0
    water = WaterAtRest({"water": Water(mass * 9.80665, adrift)})
    still, gravity = Pose(np.zeros(3), np.eye(3)), np.array([0, 0, -9.80665])
    with pytest.raises(InputError, match="nothing holds it in surge"):
        water.equilibrium(Burden(mass, center, np.array([4e5, 0, 0, 0, 0, 0])), still, gravity)
    pose = water.equilibrium(Burden(mass, center, np.zeros(6)), still, gravity)
    assert abs(pose.position[2]) < 1e-9


@pytest.mark.parametrize("model", ["concentrated_spar", "flexible_spar"])
def test_spar_models_keep_mass_centre_and_inertia(model) -> None:
    options = TurbineOptions(**{**RIGID.__dict__, "platform": model})
    whole, rigid = rigid_mass(floating(options)), rigid_mass(floating())
    assert whole[1] == pytest.approx(rigid[1], rel=1e-6)
    assert whole[2][2] == pytest.approx(rigid[2][2], rel=1e-6)
    assert np.diag(whole[0]) == pytest.approx(np.diag(rigid[0]), rel=2e-5)


def test_the_flexible_spar_of_eq_3_15_has_a_ballast_below_the_centre() -> None:
    spar = Spar.of(OC3.platform, OC3.tower, "flexible_spar")
    assert 89.9155 < spar.ballast_depth < 120.0
    assert spar.ballast + spar.linear_mass * 130.0 == pytest.approx(7466330.0)


def test_a_base_follows_its_path_in_locked_directions_alone() -> None:
    pose = Pose(np.array([3.0, 0.0, 0.0]), np.eye(3))
    options = TurbineOptions(**{**RIGID.__dict__, "base_motion": pose, "base_locked": ALL})
    assert floating(options).platform_motion()[0] == pytest.approx(3.0)


def test_a_locked_direction_is_global_however_the_platform_turns() -> None:
    held = Pose(np.zeros(3), np.eye(3))
    options = TurbineOptions(**{**RIGID.__dict__, "base_motion": held, "base_locked": (0, 3)})
    released = np.array([0.0, 1.0, 3.0, 0.0, 0.2, 0.0])
    motion = march(floating(options), heave_only(), released, 0.1, 120)
    assert np.abs(motion[:, 0]).max() < 1e-6
    assert np.ptp(motion[:, 2]) > 3.0
    assert np.ptp(motion[:, 4]) > 0.1  # 12 s of a swing of some 30 s, from 0.2 rad


def test_forces_with_room_for_tangents_are_cleared() -> None:
    machine, water = floating(), Water()
    first = machine.forces([water.loads(0.0, machine.motions[0])])
    kept = first.mass.copy(), first.dead.copy()
    again: Forces = machine.forces([water.loads(0.0, machine.motions[0])])
    assert np.array_equal(again.mass, kept[0])
    assert np.array_equal(again.dead, kept[1])


def test_the_account_of_energy_closes_afloat() -> None:
    options = TurbineOptions(blade_elements=0, tower_elements=4, rotor="locked")
    machine = FlexibleMachine(OC3, [Water.stations], options, energy=True)
    march(machine, heave_only(), np.array([3.0, 0, 1.0, 0, 0.03, 0]), 0.05, 200)
    energy = machine.ledger.values()
    moved = sum(abs(energy[f"energy_{kind}"]) for kind in ("kinetic", "potential", "water"))
    assert abs(energy["energy_defect"]) < 2e-3 * moved
    assert abs(energy["energy_water"]) > 1e5


def test_tangents_of_a_load_that_stands_off_its_frame() -> None:
    """A spring on an arm: the frame's stiffness is minus the derivative of what arrives there."""
    state, pull = floating().system.initial_state(), np.array([3.0, -2.0, 5.0])
    place, K = np.array([1.0, 2.0, -4.0]), np.diag([7.0, 3.0, 2.0])
    node = np.array([[1, 1]])
    stations = Attachment(state, node, np.zeros(1), place[None], np.eye(3)[None])

    def arrived(shift: np.ndarray, turn: np.ndarray) -> Forces:
        moved = state.copy()
        moved.position[1] = state.position[1] + shift
        moved.rotation[1] = exp_so3(turn) @ state.rotation[1]
        stations.follow(moved)
        block = np.zeros((1, 6, 6))
        block[0, :3, :3] = K
        force = pull - K @ (stations.motion.position[0] - place)
        forces = Forces.stiff_on(len(state.position), np.array([1]))
        stations.add_loads(Loads(force[None], np.zeros((1, 3)), block), forces)
        return forces

    h = 1e-6
    for k in range(6):
        step = h * np.eye(6)[k]
        ahead, behind = (arrived(s * step[:3], s * step[3:]).dead[1] for s in (1.0, -1.0))
        expected = arrived(np.zeros(3), np.zeros(3)).stiffness[1][:, k]
        assert -(ahead - behind) / (2 * h) == pytest.approx(expected, abs=1e-6)


AFLOAT = {
    "galerna": 1,
    "turbine": "nrel5mw_oc3",
    "duration_s": 1.0,
    "time_step_s": 0.05,
    "inflow": {"wind_speed_m_s": 12.0},
    "sea": {"current": {"profile": "uniform", "speed_m_s": 1.0}},
    "operation": {"rotor_speed_rpm": 0.0, "pitch_deg": 90.0},
}


def test_a_flexible_spar_floats_where_the_rigid_one_does() -> None:
    """Drag and lines ride on frames down the spar; at rest they act as on the rigid body."""
    pose = Pose(np.array([8.0, -1.0, -0.3]), exp_so3(np.array([0.01, 0.06, 0.02])))
    rigid, bent = (
        build_water(load_case(AFLOAT | {"platform": {"model": model}}), OC3).floating.water
        for model in ("rigid", "flexible_spar")
    )
    for found, expected in zip(bent.total(pose), rigid.total(pose), strict=True):
        assert found == pytest.approx(expected, rel=1e-12)


def test_a_leaning_spar_yaws_as_an_upright_one() -> None:
    """About its own axis it moves no water; with upright coefficients it would be slower."""
    total, mass, center = rigid_mass(floating())
    gravity = np.array([0.0, 0.0, -9.80665])
    yaw = {}
    for axes in ("mean_lean", "upright"):
        case = AFLOAT | {"sea": "still", "platform": {"added_mass_axes": axes}}
        afloat = build_water(load_case(case), OC3)
        water, burden = afloat.floating.water, Burden(mass, center, np.eye(6)[4] * 7.5e7)
        pose = water.equilibrium(burden, afloat.floating.pose, gravity)
        water.settle(pose)
        turned = np.kron(np.eye(2), pose.rotation)
        inertia = turned @ total @ turned.T + water.loads(pose)["hydrodynamics"].mass[0]
        squares, shapes = eig(water.balance(burden, pose, gravity)[1], inertia)
        moved = np.abs(shapes[5]) / np.linalg.norm(shapes, axis=0)
        yaw[axes] = np.sqrt(squares[int(moved.argmax())].real) / (2.0 * np.pi)
    assert lean_of(pose.rotation)[1] == pytest.approx(np.deg2rad(3.3), rel=0.01)
    assert yaw["mean_lean"] == pytest.approx(0.1205, rel=0.005)
    assert yaw["upright"] < 0.9 * yaw["mean_lean"]
    modes = modes_of(OC3, RIGID, water, burden, pose, afloat.database)
    assert modes[-1].frequency == pytest.approx(yaw["upright"], rel=0.01)
