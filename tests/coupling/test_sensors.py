"""What the machine's sensors show, held against statics, steady rotation and OpenFAST's signs."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.contract import Array, Loads, Stations
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.sensors import Gauges
from galerna.structure import TurbineOptions, with_initial_accelerations
from galerna.structure.frames import exp_so3, rotation_about
from galerna.structure.statics import static_equilibrium
from galerna.structure.system import with_spin
from galerna.units import DEG, RPM

NREL = turbines.load("nrel5mw")
GRAVITY = 9.80665
SPAN = np.linspace(0.0, 1.0, 9)
BLADES = tuple(Stations(f"blade{k}", SPAN) for k in (1, 2, 3))
RIGID = TurbineOptions(
    blade_elements=0, tower_elements=0, flexible_shaft=False, flexible_yaw=False, rotor="locked"
)


def options(**changes: object) -> TurbineOptions:
    """The rigid machine with its rotor locked, but for the changes."""
    return TurbineOptions(**{**vars(RIGID), **changes})


def at_rest(chosen: TurbineOptions, push: tuple[float, float, float] = (0, 0, 0), speed: float = 0):
    """Channels of a machine in its first shape, all forces in balance with its accelerations.

    ``push`` N stands on every station of the blades; the rotor turns at ``speed`` rad/s.
    """
    machine = FlexibleMachine(NREL, [BLADES], chosen, gauges=Gauges((0.5,), (0.5,)))
    loads = Loads.zero(3 * len(SPAN))
    loads.force[:] = push
    parts, state = machine.parts, machine.system.initial_state()
    if speed:
        turning = np.concatenate(
            [n for name, n in parts.parts.items() if name.startswith(("blade", "hub"))]
        )
        state = with_spin(state, parts.hub_center, speed * parts.shaft_axis, turning)
    machine.start(state)
    machine.start(with_initial_accelerations(machine.system, state, machine.forces([loads])))
    return machine, machine.record()


def blade_mass_center(machine: FlexibleMachine) -> tuple[float, Array]:
    """Mass kg of blade 1 and its centre (3,) m, global, of a rigid blade."""
    node = machine.parts.parts["blade1"][0]
    mass, *moment = machine.system.weight[node]
    state = machine.accepted
    return mass, state.position[node] + state.rotation[node] @ np.array(moment) / mass


def test_a_horizontal_blade_weighs_on_its_root_as_its_mass_says() -> None:
    machine, shown = at_rest(options(azimuth=90.0 * DEG))
    mass, center = blade_mass_center(machine)
    arm = center - machine.accepted.position[machine.parts.parts["blade1"][0]]
    assert mass == pytest.approx(17740.0, rel=1e-2)
    turn = np.linalg.norm(arm) * mass * GRAVITY
    assert shown["blade_root_in_plane_moment"][0] == pytest.approx(turn, rel=0.01)
    assert shown["blade_root_in_plane_moment"][0] > 0.0, "down-going: with the rotation"
    assert shown["blade_root_in_plane_shear"][0] == pytest.approx(-mass * GRAVITY, rel=0.01)
    upright = at_rest(options())[1]
    cosine = np.cos(NREL.hub.cone - NREL.nacelle.tilt)
    assert upright["blade_root_axial_force"][0] == pytest.approx(-mass * GRAVITY * cosine, rel=1e-3)


@pytest.mark.parametrize("elements", [0, 6])
def test_the_tower_s_foot_carries_all_weight_and_its_moment(elements: int) -> None:
    machine = FlexibleMachine(NREL, [BLADES], options(tower_elements=elements))
    machine.start(static_equilibrium(machine.system))
    shown, system, state = machine.record(), machine.system, machine.accepted
    weights = GRAVITY * system.weight[1:]
    carried = {0: 347460.0, 6: system.roots["tower"].weight[0] if elements else 0.0}[elements]
    total = weights[:, 0].sum() + GRAVITY * carried
    assert shown["tower_base_axial_force"] == pytest.approx(-total, rel=1e-5)
    first = (state.rotation[1:] @ weights[:, 1:, None])[:, 0, 0]
    moment = (weights[:, 0] * state.position[1:, 0] + first).sum()
    assert shown["tower_base_fore_aft_moment"] == pytest.approx(moment, rel=1e-6)
    assert moment < 0.0, "the rotor hangs upwind of the tower"


def test_steady_rotation_pulls_with_the_centrifugal_force() -> None:
    speed = 12.1 * RPM
    machine, shown = at_rest(options(gravity=(0, 0, 0), rotor=lambda time: speed), speed=speed)
    mass, center = blade_mass_center(machine)
    axis, arm = machine.parts.shaft_axis, center - machine.parts.hub_center
    radial = arm - axis * (axis @ arm)
    pull = mass * speed**2 * np.linalg.norm(radial)
    total = np.sqrt(
        sum(
            shown[f"blade_root_{name}"][0] ** 2
            for name in ("axial_force", "out_of_plane_shear", "in_plane_shear")
        )
    )
    assert total == pytest.approx(pull, rel=1e-9)
    assert shown["blade_root_axial_force"] == pytest.approx(pull * np.cos(NREL.hub.cone), rel=1e-3)
    # the cone holds the blade upwind, the pull straightens it: downwind, a positive moment
    assert (shown["blade_root_out_of_plane_moment"] > 0.0).all()
    assert abs(shown["shaft_thrust"]) < 1e-6 * pull
    assert abs(shown["shaft_torque"]) < 1e-6 * pull


def test_thrust_reaches_shaft_yaw_bearing_and_foot() -> None:
    chosen = options(gravity=(0, 0, 0))
    machine, shown = at_rest(chosen, push=(1000.0, 0.0, 0.0))
    thrust = 3 * len(SPAN) * 1000.0
    assert shown["shaft_thrust"] == pytest.approx(thrust * np.cos(NREL.nacelle.tilt), rel=1e-9)
    assert shown["yaw_bearing_fore_aft_shear"] == pytest.approx(thrust, rel=1e-9)
    assert shown["tower_base_fore_aft_shear"] == pytest.approx(thrust, rel=1e-9)
    points = machine.motions[0].position
    moment = 1000.0 * points[:, 2].sum()
    assert shown["tower_base_fore_aft_moment"] == pytest.approx(moment, rel=1e-9)
    assert (shown["blade_root_out_of_plane_moment"] > 0.0).all()
    assert machine.root_moments()[:, 0] == pytest.approx(
        shown["blade_root_out_of_plane_moment"], rel=1e-9
    )
    assert machine.root_moments()[:, 1] == pytest.approx(
        shown["blade_root_in_plane_moment"], rel=1e-6, abs=1.0
    )


def test_pitched_axes_turn_with_the_blade_and_coned_ones_do_not() -> None:
    straight = at_rest(options(gravity=(0, 0, 0)), push=(1000.0, 200.0, 0.0))[1]
    pitched = at_rest(options(gravity=(0, 0, 0), pitch=90.0 * DEG), push=(1000.0, 200.0, 0.0))[1]
    assert straight["blade_root_flapwise_shear"] == pytest.approx(
        straight["blade_root_out_of_plane_shear"]
    )
    assert pitched["blade_root_out_of_plane_shear"] == pytest.approx(
        straight["blade_root_out_of_plane_shear"]
    )
    # at 90 deg to feather the blade's leading edge points upwind, its y axis downwind
    assert pitched["blade_root_edgewise_shear"] == pytest.approx(
        straight["blade_root_out_of_plane_shear"]
    )


@pytest.mark.parametrize("flexible_shaft", [True, False])
def test_the_shaft_s_torque_is_what_turns_the_generator(flexible_shaft: bool) -> None:
    chosen = options(gravity=(0, 0, 0), rotor="free", flexible_shaft=flexible_shaft)
    machine = FlexibleMachine(NREL, [BLADES], chosen)
    machine.set_shaft_torque(-1.0e6)
    state = machine.system.initial_state()
    if flexible_shaft:  # wound up until the generator stands in balance
        hub = np.concatenate([n for name, n in machine.parts.parts.items() if name != "tower"])
        angle = 1.0e6 / NREL.drivetrain.shaft_stiffness
        axis, center = machine.parts.shaft_axis, machine.parts.hub_center
        for node in set(hub.tolist()) - {machine.system.names.index("nacelle")}:
            R = exp_so3(angle * axis)
            state.position[node] = center + R @ (state.position[node] - center)
            state.rotation[node] = R @ state.rotation[node]
    loads = Loads.zero(3 * len(SPAN))
    machine.start(state)
    machine.start(with_initial_accelerations(machine.system, state, machine.forces([loads])))
    torque = machine.record()["shaft_torque"]
    if flexible_shaft:
        assert torque == pytest.approx(1.0e6, rel=1e-6)
        return
    generator = NREL.drivetrain.generator_inertia * NREL.drivetrain.gear_ratio**2
    acceleration = machine.accepted.acceleration[machine.system.names.index("hub"), 3]
    assert torque == pytest.approx(1.0e6 + generator * acceleration, rel=1e-3)
    assert 0.0 < torque < 1.0e6


def test_nothing_is_displaced_in_the_described_shape() -> None:
    chosen = TurbineOptions(blade_elements=4, tower_elements=3, pitch=20 * DEG, azimuth=1.0)
    machine, shown = at_rest(chosen)
    for channel in machine.channels:
        if channel.name.endswith("_displacement") or channel.name == "tip_twist":
            assert np.abs(shown[channel.name]).max() < 1e-9, channel.name
    assert shown["tip_yaw_axis_distance"][0] > 0.0


def test_displacements_are_seen_along_their_axes() -> None:
    machine = FlexibleMachine(NREL, [BLADES], TurbineOptions(blade_elements=4, pitch=90 * DEG))
    state = machine.system.initial_state()
    tip = machine.parts.parts["blade1"][-1]
    state.position[tip] += [0.5, 0.0, 0.0]  # downwind
    state.rotation[tip] = state.rotation[tip] @ exp_so3(np.array([0.0, 0.0, -0.1]))  # to feather
    shown = machine.sensors.record(state, (), 0.0)
    cosine = np.cos(NREL.hub.cone - NREL.nacelle.tilt)
    assert shown["tip_out_of_plane_displacement"][0] == pytest.approx(0.5 * cosine, rel=1e-2)
    assert shown["tip_edgewise_displacement"][0] == pytest.approx(0.5 * cosine, rel=1e-2)
    assert shown["tip_twist"][0] == pytest.approx(0.1)
    assert shown["tip_out_of_plane_displacement"][1] == 0.0


def test_a_tilted_base_shows_as_platform_motion_and_bends_nothing() -> None:
    roll, pitch, yaw = 0.03, -0.05, 0.2
    R = rotation_about(2, yaw) @ rotation_about(1, pitch) @ rotation_about(0, roll)
    shift = np.array([1.0, -2.0, 0.5])
    chosen = options(tower_elements=3, base_motion=lambda time: (np.zeros(3), np.eye(3)))
    machine = FlexibleMachine(NREL, [BLADES], chosen)
    state = machine.system.initial_state()
    state.position[1:] = shift + state.position[1:] @ R.T
    state.rotation[1:] = R @ state.rotation[1:]
    machine.start(state)
    assert machine.platform_motion() == pytest.approx([*shift, roll, pitch, yaw], abs=1e-12)
    shown = machine.sensors.record(state, (), 0.0)
    assert shown["platform_pitch"] == pytest.approx(pitch)
    assert abs(shown["tower_top_fore_aft_displacement"]) < 1e-9
    assert abs(shown["tower_top_pitch"]) < 1e-9
    assert shown["tip_tower_clearance"] == pytest.approx(
        FlexibleMachine(NREL, [BLADES], chosen).sensors.record(
            machine.system.initial_state(), (), 0.0
        )["tip_tower_clearance"]
    )


def test_a_bent_blade_carries_a_tip_load_with_its_lever() -> None:
    """In dynamics the sections feel inertia; loads over mass that is at rest are statics."""
    machine = FlexibleMachine(
        NREL, [BLADES], options(blade_elements=20, gravity=(0, 0, 0)), gauges=Gauges((0.5,), (0.5,))
    )
    force = np.array([20e3, 0.0, 0.0])
    loads = Loads.zero(3 * len(SPAN))
    loads.force[len(SPAN) - 1] = force

    def of_state(state):
        machine._follow(state)
        return machine.forces([loads])

    machine.start(static_equilibrium(machine.system, loads=of_state))
    shown, state = machine.record(), machine.accepted
    nodes = machine.parts.parts["blade1"]
    lever = state.position[nodes[-1]] - state.position[nodes[10]]
    expected = state.rotation[nodes[10]].T @ np.cross(lever, force)
    sections = [shown[f"blade_{name}_moment"][0, 0] for name in ("edgewise", "flapwise", "torsion")]
    assert sections == pytest.approx(expected, rel=1e-6, abs=10.0)
    assert shown["tip_out_of_plane_displacement"][0] > 1.0
    assert shown["blade_flapwise_shear"][0, 0] > 0.0
