"""The built-in turbine as frames and beams: masses, places, motion, modes."""

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.errors import InputError
from galerna.structure.forces import Forces
from galerna.structure.frames import rotation_about
from galerna.structure.initial import with_fitting_velocities, with_initial_accelerations
from galerna.structure.integrators import Integrator
from galerna.structure.mode_names import name_modes
from galerna.structure.modes import natural_modes
from galerna.structure.statics import static_equilibrium
from galerna.structure.system import spin_twists, with_spin
from galerna.structure.turbine import TurbineOptions, generator_inertias, turbine_system
from galerna.structure.whirl import rotor_nodes, whirl_modes
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Drivetrain
from galerna.units import DEG

FEW = {"blade_elements": 6, "tower_elements": 4}


@pytest.fixture(scope="module")
def nrel():
    return turbines.load("nrel5mw")


def test_parts_weigh_what_they_should(nrel):
    model = turbine_system(nrel, TurbineOptions(**FEW))
    weight = model.system.weight
    blade = np.trapezoid(nrel.blade.structure.mass, nrel.blade.structure.span) * nrel.blade.length
    assert weight[model.parts["blade1"], 0].sum() == pytest.approx(blade, rel=1e-9)
    assert weight[model.parts["hub"], 0].sum() == pytest.approx(nrel.hub.mass)
    tower = np.trapezoid(nrel.tower.structure.mass, nrel.tower.structure.span) * 87.6
    assert weight[model.parts["tower"], 0].sum() == pytest.approx(tower, rel=1e-9)


def test_frames_stand_where_the_kinematics_put_them(nrel):
    """Tilt lifts the upwind end, cone moves the tips upwind, pitch turns about -z."""
    options = TurbineOptions(**FEW, pitch=10 * DEG, azimuth=0.0)
    model = turbine_system(nrel, options)
    x, R = model.system.position, model.system.rotation
    hub, tip = x[model.parts["hub"][0]], x[model.parts["blade1"][-1]]
    assert hub == pytest.approx([-5.0, 0.0, 90.0], abs=0.02)
    angle = nrel.nacelle.tilt + 0.0
    along = np.array([-np.sin(nrel.hub.cone - angle), 0.0, np.cos(nrel.hub.cone - angle)])
    assert tip == pytest.approx(hub + 63.0 * along, abs=1e-6)
    blade_axes = blade_frames(nrel.blade, np.zeros(1))[1][0]
    root = R[model.parts["blade1"][0]]
    unpitched = root @ blade_axes.T
    assert unpitched[1, 0] == pytest.approx(-np.sin(10 * DEG), abs=1e-9)


@pytest.mark.parametrize("rigid", ["blade_elements", "tower_elements"])
def test_parts_can_be_rigid_and_keep_their_mass(nrel, rigid):
    flexible = turbine_system(nrel, TurbineOptions(**FEW))
    stiff = turbine_system(nrel, TurbineOptions(**{**FEW, rigid: 0}))
    part = rigid.partition("_")[0]
    assert len(stiff.system) < len(flexible.system)
    if part == "blade":
        blades = [m.system.weight[m.parts["blade2"], 0].sum() for m in (flexible, stiff)]
        assert blades[0] == pytest.approx(blades[1], rel=1e-6)


def test_weight_reaches_the_ground(nrel):
    model = turbine_system(nrel, TurbineOptions(**FEW, rotor="locked"))
    system = model.system
    state = static_equilibrium(system)
    root = -system.pair_answer(state).node_wrench[system.pair_names.index("tower:0"), :6]
    above = system.weight[1:, 0].sum()
    assert root[2] == pytest.approx(-9.80665 * above, rel=1e-6)


def test_the_rotor_turns_at_the_speed_it_is_given(nrel):
    speed = 1.2
    model = turbine_system(nrel, TurbineOptions(**FEW, rotor=lambda time: speed))
    system = model.system
    state = system.initial_state()
    twists = spin_twists(state, model.hub_center, speed * model.shaft_axis)
    rotor = ["hub", "blade1", "blade2", "blade3"]
    turning = np.concatenate(
        [[system.names.index("generator")], *(model.parts[name] for name in rotor)]
    )
    state.velocity[turning] = twists[turning]
    start = with_initial_accelerations(system, state)
    *_, end = Integrator(system).march(start, 0.05, 20)
    generator = system.names.index("generator")
    nacelle = model.parts["nacelle"][0]
    untilted = rotation_about(1, -nrel.nacelle.tilt)
    relative = untilted @ end.rotation[nacelle].T @ end.rotation[generator]
    azimuth = np.arctan2(relative[2, 1], relative[1, 1])
    assert azimuth == pytest.approx(speed * 1.0, abs=1e-6)
    assert system.violation(end) < 1e-10


def test_modes_have_their_names_in_the_order_of_the_report(nrel):
    model = turbine_system(nrel, TurbineOptions(rotor="locked"))
    state = static_equilibrium(model.system)
    modes = natural_modes(model.system, state, 8)
    assert name_modes(model, state, modes) == [
        "tower side-side 1",
        "tower fore-aft 1",
        "drivetrain 1",
        "blade flap yaw 1",
        "blade flap pitch 1",
        "blade flap collective 1",
        "blade edge pitch 1",
        "blade edge yaw 1",
    ]
    # the deck's ratio is of the isolated blade's first modes: near it here
    assert modes.damping_ratio[3:6] == pytest.approx(0.00477, rel=0.2)


def test_a_floating_turbine_stands_on_its_platform():
    model = turbine_system(turbines.load("nrel5mw_oc3"), TurbineOptions(**FEW))
    assert "platform" in model.parts
    platform = turbines.load("nrel5mw_oc3").platform
    index = model.parts["platform"][0]
    assert model.system.weight[index, 0] > platform.mass


def test_a_flexible_part_without_data_is_refused(nrel):
    bare = replace(nrel, tower=replace(nrel.tower, structure=None))
    with pytest.raises(InputError, match="tower_elements"):
        turbine_system(bare)
    turbine_system(bare, TurbineOptions(**{**FEW, "tower_elements": 0}))


def test_an_unknown_rotor_is_refused(nrel):
    with pytest.raises(InputError, match="rotor"):
        turbine_system(nrel, TurbineOptions(**FEW, rotor="spinning"))


@pytest.mark.parametrize("n", [-1, 2.5])
def test_elements_are_whole_numbers(n):
    for part in ("blade_elements", "tower_elements"):
        with pytest.raises(InputError, match=part):
            TurbineOptions(**{part: n})


def test_two_blades_have_no_multiblade_coordinates(nrel):
    with pytest.raises(InputError, match="2 blades"):
        whirl_modes(replace(nrel, number_of_blades=2), 1.0)


def test_multiblade_coordinates_change_nothing_at_standstill(nrel):
    options = TurbineOptions(**FEW, gravity=(0.0, 0.0, 0.0))
    whirling = whirl_modes(nrel, 0.0, 8, options)
    plain = natural_modes(whirling.model.system, whirling.state, 8)
    assert whirling.modes.frequency[2:] == pytest.approx(plain.frequency[2:], rel=1e-6)


def test_turning_splits_the_asymmetric_modes_by_twice_the_speed(nrel):
    """On a rigid tower the flapwise whirls are the blade's own frequency minus and plus 1P."""
    speed = 1.0
    options = TurbineOptions(blade_elements=6, tower_elements=0, flexible_yaw=False)
    found = 2 * np.pi * whirl_modes(nrel, speed, 9, options).modes.frequency
    backward, _, forward = found[found > 0.1][:3]
    assert forward - backward == pytest.approx(2 * speed, rel=1e-3)


@pytest.mark.parametrize("ratio", [1.0, 97.0])
def test_a_geared_generator_has_the_energy_of_its_own_speed(ratio):
    """Spin ``ratio`` times that of the shaft in the nacelle, and the nacelle's."""
    own, between = generator_inertias(Drivetrain(gear_ratio=ratio, generator_inertia=534.0))
    for shaft, nacelle in ((1.3, 0.0), (0.0, 0.1), (1.3, 0.1)):
        speed = ratio * (shaft - nacelle) + nacelle
        parts = own * shaft**2 + between * (shaft - nacelle) ** 2
        parts += (1.0 - ratio) * 534.0 * nacelle**2
        assert parts == pytest.approx(534.0 * speed**2, rel=1e-9)


@pytest.mark.parametrize("flexible_shaft", [True, False])
def test_the_nacelle_feels_the_generator_speed_up(nrel, flexible_shaft):
    """The gearbox's housing takes the shaft's torque, which the lost torque no longer holds."""
    options = TurbineOptions(
        blade_elements=0, tower_elements=0, flexible_shaft=flexible_shaft, flexible_yaw=False,
        gravity=(0.0, 0.0, 0.0),
    )  # fmt: skip
    system = turbine_system(nrel, options).system
    hub, forces = system.names.index("hub"), Forces.none(len(system))
    forces.follower[hub, 3] = 4e6
    state = with_initial_accelerations(system, system.initial_state(), forces)
    generator = system.names.index("generator" if flexible_shaft else "hub")
    speeding = nrel.drivetrain.generator_inertia * 97.0 * 96.0 * state.acceleration[generator, 3]
    felt = system.node_wrenches(state)[system.pair("yaw bearing"), 9]
    assert felt == pytest.approx(speeding * np.cos(nrel.nacelle.tilt), rel=1e-6, abs=1.0)
    assert (speeding > 1e5) is not flexible_shaft  # whose torsion passes nothing on at once


def test_the_gyroscopic_moment_of_a_generator_goes_with_its_gear_ratio_once(nrel):
    """On a nodding nacelle its angular momentum is inertia times its own speed, no more."""
    nod, speed, moments = 0.05, 1.2, []
    foot = nrel.tower.axis[0]
    options = TurbineOptions(
        blade_elements=0, tower_elements=0, flexible_yaw=False, gravity=(0.0, 0.0, 0.0),
        base_motion=lambda t: (foot, rotation_about(1, nod * t)),
    )  # fmt: skip
    for inertia in (0.0, 534.116):
        drivetrain = replace(nrel.drivetrain, generator_inertia=inertia)
        model = turbine_system(replace(nrel, drivetrain=drivetrain), options)
        system = model.system
        state = with_spin(
            system.initial_state(), model.hub_center, speed * model.shaft_axis, rotor_nodes(model)
        )
        state = with_initial_accelerations(system, with_fitting_velocities(system, state))
        moments.append(system.node_wrenches(state)[system.pair("yaw bearing"), 11])
    expected = 534.116 * 97.0 * speed * nod * np.cos(nrel.nacelle.tilt)
    assert moments[1] - moments[0] == pytest.approx(expected, rel=0.02)
