"""The vortex lattice as a load model: its loads, its channels, its clock, what it refuses."""

from dataclasses import replace

import numpy as np
import pytest

import galerna
from galerna.aero.vortex.model import VortexLattice
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.aero.vortex.section_lift import SectionLift, strip_chords
from galerna.aero.vortex.wake_size import wake_size
from galerna.case import load
from galerna.contract import LoadModel
from galerna.errors import ConvergenceError, InputError
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.machine import build_machine
from galerna.signals import Signal

SMALL = {
    "model": "vortex_lattice",
    "spanwise_panels": 8,
    "chordwise_panels": 2,
    "wake_length_diameters": 1.5,
    "wake_step_deg": 10,
    "wake": "prescribed",
    "tower_influence": False,
}
CASE = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 10.0,
    "time_step_s": 0.15,
    "inflow": {"wind_speed_m_s": 8.0},
    "operation": {"rotor_speed_rpm": 9.16, "pitch_deg": 0.0},
    "tower_and_nacelle_drag": False,
}


def machine(*, case=None, **aerodynamics):
    return build_machine(load({**CASE, **(case or {}), "aerodynamics": {**SMALL, **aerodynamics}}))


def advanced(steps, *, case=None, **aerodynamics):
    made = machine(case=case, **aerodynamics)
    for _ in range(steps):
        made.simulation.advance()
    return made


def operation(**changes):
    return {"operation": {**CASE["operation"], **changes}}


@pytest.fixture(scope="module")
def steady():
    """A prescribed wake in uniform wind, begun with the steady wake, after a few steps."""
    made = advanced(6)
    return made, made.simulation.record()


@pytest.fixture(scope="module")
def bem():
    simulation = build_machine(
        load({**CASE, "aerodynamics": {"tower_influence": False}})
    ).simulation
    simulation.run(3.0)
    return simulation


def test_it_answers_the_contract(steady):
    assert isinstance(steady[0].vortex_lattice, LoadModel)


def test_its_loads_are_near_those_of_blade_element_momentum(steady, bem):
    """The wake leaves too fast, so there is less induction; the lattice is coarse."""
    thrust = steady[1]["rotor_thrust"] / bem.record()["rotor_thrust"]
    assert 0.9 < thrust < 1.1
    assert 0.1 < steady[1]["rotor_axial_induction"] < bem.record()["rotor_axial_induction"]


def test_the_sections_feel_nearly_the_air_of_blade_element_momentum(steady, bem):
    """The DU 35 inboard has its zero lift 2.3 deg higher in its polar than by its camber."""
    radius, other = steady[0].simulation.coordinates["radius"], bem.coordinates["radius"]
    middle = (radius > 25.0) & (radius < 55.0)
    for name, most in (("angle_of_attack", np.radians(3.0)), ("relative_speed", 1.0)):
        values = np.interp(radius, other, bem.record()[name][0])
        assert np.abs(steady[1][name][0] - values)[middle].max() < most


def test_the_angle_of_attack_is_what_the_circulation_tells(steady):
    """Eq. (1) of the channels against the lift of plane sections: two ways, one angle."""
    model, record = steady[0].vortex_lattice, steady[1]
    surface = model._shown.surfaces[0]
    chord, aft = strip_chords(surface.lattice.corners)
    first = model.lattice.bare_strips
    air = model._strip_state(model._shown).air[0, first:]
    section = SectionLift.of_lattice(surface.lattice)
    across = section.across(record["circulation"][0, first:], chord)
    told = section.effective_flow(across, np.sum(air * aft, axis=1)).angle_of_attack
    inboard = slice(0, -2)
    np.testing.assert_allclose(
        record["angle_of_attack"][0, first:][inboard], told[inboard], atol=np.radians(0.3)
    )


def test_the_strips_add_up_to_the_rotor(steady):
    model, record = steady[0].vortex_lattice, steady[1]
    shown = model._shown
    strips = model._strip_state(shown)
    shaft = shown.frames.shaft[:, 0]
    assert (strips.force @ shaft).sum() == pytest.approx(record["rotor_thrust"], rel=1e-12)
    assert shown.force.sum(axis=(0, 1)) == pytest.approx(strips.force.sum(axis=(0, 1)))


def test_bare_strips_have_polars_and_no_vortices(steady):
    model, record = steady[0].vortex_lattice, steady[1]
    bare = slice(0, model.lattice.bare_strips)
    assert model.lattice.bare_strips > 0
    assert (record["circulation"][:, bare] == 0.0).all()
    assert (record["axial_induction"][:, bare] == 0.0).all()
    assert (record["drag_coefficient"][:, bare] > 0.3).all()  # cylinders


def test_without_drag_the_power_is_higher_and_no_section_is_told():
    made = advanced(3, drag=False)
    assert (made.simulation.record()["drag_coefficient"] == 0.0).all()
    with_drag = advanced(3).simulation.record()["rotor_power"]
    assert 1.02 < made.simulation.record()["rotor_power"] / with_drag < 1.15


def test_every_channel_has_its_place_and_is_a_number(steady):
    simulation = steady[0].simulation
    for channel in simulation.channels:
        shape = tuple(len(simulation.coordinates[dim]) for dim in channel.dims)
        assert np.shape(steady[1][channel.name]) == shape
        assert np.isfinite(steady[1][channel.name]).all()
    assert steady[1]["wake_panels"] == steady[0].vortex_lattice.wake_panels


def test_loads_may_be_asked_again_and_a_step_begun_again(steady):
    model = machine().vortex_lattice
    motion = machine().simulation.structure.motions[0]
    model.begin_step(0.0, 0.15, motion)
    first = model.loads(0.15, motion)
    again = model.loads(0.15, motion)
    np.testing.assert_array_equal(first.force, again.force)
    model.begin_step(0.0, 0.15, motion)
    np.testing.assert_array_equal(first.moment, model.loads(0.15, motion).moment)
    assert model.state() == {}


@pytest.mark.parametrize("wake", ["prescribed", "free"])
def test_a_restored_state_goes_on_with_the_same_bits(wake):
    simulation = advanced(5, wake=wake).simulation
    saved = simulation.state()
    simulation.advance()
    simulation.advance()
    first = simulation.record()
    simulation.restore(saved)
    simulation.advance()
    simulation.advance()
    for name, value in simulation.record().items():
        np.testing.assert_array_equal(value, first[name])


def test_a_resumed_run_knows_its_time_and_does_not_tell_again():
    turbulence = {"kind": "mann", "turbulence_class": "B", "points_across": 8, "time_step_s": 0.5}
    case = {
        "inflow": {"wind_speed_m_s": 8.0, "turbulence": turbulence},
        **operation(rotor_speed_rpm=0.0),
    }
    first, resumed = advanced(3, case=case), machine(case=case)
    resumed.simulation.restore(first.simulation.state())
    place = np.array([[-100.0, 0.0, 90.0]])
    np.testing.assert_array_equal(
        resumed.vortex_lattice.velocity(place), first.vortex_lattice.velocity(place)
    )
    resumed.simulation.advance()
    told = [{line.partition(": ")[2] for line in m.notices()} for m in (first, resumed)]
    assert told[0]
    assert not told[0] & told[1]


def test_a_notice_of_a_step_taken_back_is_taken_back_too():
    made = machine(case=operation(rotor_speed_rpm=0.0))
    before = made.simulation.state()
    made.simulation.advance()
    assert made.notices()
    made.simulation.restore(before)
    assert made.notices() == ()


def test_a_first_step_begun_anew_from_elsewhere_forgets_where_it_was_begun():
    turned = machine(wake="free", case=operation(azimuth_deg=40.0)).simulation.structure.motions[0]
    start = machine(wake="free").simulation.structure.motions[0]
    again, fresh = machine(wake="free").vortex_lattice, machine(wake="free").vortex_lattice
    again.begin_step(0.0, 0.15, start)
    for model in (again, fresh):
        model.begin_step(0.0, 0.15, turned)
    np.testing.assert_array_equal(again.loads(0.15, turned).force, fresh.loads(0.15, turned).force)


def test_without_drag_no_polars_are_needed():
    turbine = galerna.load_turbine("nrel5mw")
    lines = {"polars": (), "camber": np.array([[0.0, 0.0], [1.0, 0.0]])}
    airfoils = {name: replace(a, **lines) for name, a in turbine.airfoils.items()}
    bare = replace(turbine, airfoils=airfoils)
    options = {**SMALL, "drag": False, "root_span": 0.2}
    with_polars, without = (rotor_loads(t, camber="none", **options) for t in (turbine, bare))
    np.testing.assert_array_equal(with_polars["rotor_thrust"], without["rotor_thrust"])
    lift = slice(4, None)
    np.testing.assert_array_equal(
        with_polars["lift_coefficient"][:, lift], without["lift_coefficient"][:, lift]
    )
    with pytest.raises(InputError, match="no polars"):
        rotor_loads(bare, **{**options, "drag": True})


def rotor_loads(turbine, **options):
    """What a rotor in uniform wind records after a step."""

    class Uniform:
        def velocity(self, points, time):
            return np.tile([8.0, 0.0, 0.0], (len(points), 1))

    chosen = VortexLatticeOptions.model_validate(options)
    model = VortexLattice(turbine, Uniform(), rotor_speed=1.0, wind_speed=8.0, options=chosen)
    turning = PrescribedOperation(Signal.constant(1.0), (Signal.constant(0.0),) * 3)
    motion = PrescribedMotion(turbine, turning, [model.stations]).motions[0]
    model.begin_step(0.0, 0.1, motion)
    model.end_step(0.1, motion)
    return model.record()


def test_a_free_wake_begins_where_it_will_stay():
    """The thrust of the first second against three turns later; the helix is 10 % off."""
    made = advanced(4, wake="free")
    early = made.simulation.record()["rotor_thrust"]
    assert made.notices() == ()
    for _ in range(60):
        made.simulation.advance()
    assert early == pytest.approx(made.simulation.record()["rotor_thrust"], rel=0.01)


def test_a_free_wake_has_more_induction_than_a_prescribed_one(steady):
    free = advanced(6, wake="free").simulation.record()
    assert free["rotor_axial_induction"] > 1.05 * steady[1]["rotor_axial_induction"]
    assert 0.85 < free["rotor_thrust"] / steady[1]["rotor_thrust"] < 1.0


def test_small_time_steps_shed_the_same_wake():
    whole = advanced(8)
    parts = advanced(32, case={"time_step_s": 0.0375})
    size = [m.vortex_lattice.wake_size.step for m in (whole, parts)]
    assert size[0] == pytest.approx(0.15)
    assert size[1] == pytest.approx(round(size[0] / 0.0375) * 0.0375, rel=0.3)
    thrusts = [m.simulation.record()["rotor_thrust"] for m in (whole, parts)]
    assert thrusts[0] == pytest.approx(thrusts[1], rel=0.01)


def test_wind_and_vortices_are_known_anywhere():
    probes = [[-200.0, 0.0, 90.0], [40.0, 0.0, 120.0], [0.0, 300.0, 90.0]]
    made = advanced(3, probes_m=probes)
    far, behind, beside = np.stack(
        [made.simulation.record()[f"probe_velocity_{a}"] for a in "xyz"], 1
    )
    np.testing.assert_allclose(far, [8.0, 0.0, 0.0], atol=0.25)
    np.testing.assert_allclose(beside, [8.0, 0.0, 0.0], atol=0.25)
    assert 1.5 < behind[0] < 6.5
    np.testing.assert_array_equal(made.vortex_lattice.velocity(np.array(probes))[1], behind)


def test_probes_beyond_a_box_of_turbulence_have_wind():
    turbulence = {"kind": "mann", "turbulence_class": "B", "points_across": 8, "time_step_s": 0.5}
    case = {"inflow": {"wind_speed_m_s": 8.0, "turbulence": turbulence}}
    made = advanced(2, case=case, probes_m=[[0.0, 500.0, 90.0]], wake="free")
    assert 2.0 < made.simulation.record()["probe_velocity_x"][0] < 14.0


@pytest.mark.parametrize("wake_turbulence", [True, False])
def test_turbulence_moves_the_wake_by_choice(wake_turbulence):
    turbulence = {"kind": "mann", "turbulence_class": "A", "points_across": 8, "time_step_s": 0.5}
    case = {"inflow": {"wind_speed_m_s": 8.0, "turbulence": turbulence}}
    made = advanced(5, case=case, wake_turbulence=wake_turbulence)
    tips = [m.vortex_lattice.sheets()[0].vertices[:, -1] for m in (made, advanced(5))]
    apart = np.linalg.norm(tips[0] - tips[1], axis=1).max()
    assert (apart > 0.1) == wake_turbulence


@pytest.mark.parametrize(
    "changes",
    [
        {"wake_scheme": "heun", "wake": "free"},
        {"wake_scheme": "euler", "wake": "free"},
        {"quasi_steady": True},
        {"start": "impulsive"},
        {"ground": True},
        {"core_radius": 0.0, "core_growth": 0.0, "wake": "free"},
        {"tree_error": 0.0, "precision": "double", "wake": "free"},
        {"decambering": True},
        {"camber": "polar", "tower_influence": True},
        {"spanwise_panels": [0.2, 0.5, 0.8, 1.0], "chordwise_panels": [0.0, 0.3, 1.0]},
    ],
    ids=str,
)
def test_every_option_runs_and_gives_a_rotor(changes):
    record = advanced(3, **changes).simulation.record()
    assert 2.0e5 < record["rotor_thrust"] < 5.5e5
    assert all(np.isfinite(value).all() for value in record.values())


@pytest.mark.parametrize(
    "changes",
    [
        operation(rotor_speed_rpm=0.0, pitch_deg=90.0),
        operation(rotor_speed_rpm=0.0),
        operation(rotor_speed_rpm={"time_s": [0.0, 2.0], "values": [0.0, 9.16]}),
        operation(yaw_deg=90.0),
        operation(yaw_deg=180.0),
        operation(pitch_deg=[0.0, 5.0, 90.0]),
    ],
    ids=["parked", "parked across", "from rest", "yaw 90", "yaw 180", "one blade feathered"],
)
def test_odd_operation_gives_numbers_and_tells_which_sections_left_their_polar(changes):
    made = advanced(4, case={**changes, "duration_s": 5.0})
    record = made.simulation.record()
    assert all(np.isfinite(value).all() for value in record.values())
    assert record["sections_outside_polar"] > 0
    assert "of the attached polar of" in made.notices()[0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"time_step_s": 0.5},
            "case: time_step_s: 0.5 s is too large: rotor permits at most 0.182 s",
        ),
        (operation(rotor_speed_rpm=-9.0), "the rotor turns backwards"),
        ({"inflow": {"wind_speed_m_s": 0.0}}, "a wind of 0 m/s does not carry the wake away"),
        ({"inflow": {"wind_speed_m_s": 0.0}, **operation(rotor_speed_rpm=0.0)}, "give a wind, or"),
    ],
)
def test_what_cannot_be_simulated_is_refused_before_the_run(changes, message):
    with pytest.raises(InputError, match=message):
        machine(case=changes)


def test_a_rotor_turns_in_calm_air_where_its_wake_moves_itself():
    case = {"inflow": {"wind_speed_m_s": 0.0}}
    record = advanced(3, case=case, wake="free", start="impulsive").simulation.record()
    assert all(np.isfinite(value).all() for value in record.values())
    assert record["rotor_power"] < 0.0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"spanwise_panels": [0.2, 0.9]}, "the edges end at 0.9, not at the tip"),
        ({"chordwise_panels": [0.1, 1.0]}, "edges go from 0.1 to 1"),
        ({"spanwise_panels": [0.5, 0.2, 1.0]}, "two edges that rise"),
    ],
)
def test_edges_that_make_no_lattice_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        machine(**options)


def test_wind_that_is_no_number_names_the_blade():
    made = machine()

    class Broken:
        def velocity(self, points, time):
            wind = np.tile([8.0, 0.0, 0.0], (len(points), 1))
            wind[points[:, 2] > 140.0] = np.nan  # blade 1 points up
            return wind

    made.vortex_lattice._flow.inflow = Broken()
    with pytest.raises((InputError, ConvergenceError), match="blade1"):
        made.simulation.advance()


def test_a_blade_inside_the_tower_is_named():
    turbine = galerna.load_turbine("nrel5mw")
    near = replace(turbine, nacelle=replace(turbine.nacelle, overhang=0.0, tilt=0.0))

    class Uniform:
        def velocity(self, points, time):
            return np.tile([8.0, 0.0, 0.0], (len(points), 1))

    options = VortexLatticeOptions.model_validate({**SMALL, "tower_influence": True})
    model = VortexLattice(near, Uniform(), rotor_speed=1.0, wind_speed=8.0, options=options)
    still = PrescribedOperation(Signal.constant(1.0), (Signal.constant(0.0),) * 3, azimuth=np.pi)
    motion = PrescribedMotion(near, still, [model.stations]).motions[0]
    with pytest.raises(ConvergenceError, match=r"blade1.* is inside the tower at .* of its span"):
        model.begin_step(0.0, 0.1, motion)


class TestWakeSize:
    """Length and step of a wake, from the options."""

    def size(self, speed=1.0, wind=8.0, time_step=None, **options):
        made = VortexLatticeOptions.model_validate({"model": "vortex_lattice", **options})
        return wake_size(made, speed, wind, 63.0, time_step)

    def test_the_length_is_that_asked_for(self):
        assert self.size(wake_length_diameters=2.0).diameters == pytest.approx(2.0, rel=0.1)
        assert self.size(wake_revolutions=4.0).revolutions == pytest.approx(4.0, rel=0.1)

    def test_the_step_is_a_whole_number_of_time_steps(self):
        size = self.size(wake_step_deg=5.0, time_step=0.03)
        assert size.step == pytest.approx(0.09)
        assert abs(size.step - np.radians(5.0)) < 0.5 * 0.03

    def test_a_longer_time_step_is_left_to_be_refused(self):
        assert self.size(wake_step_deg=5.0, time_step=0.2).step == pytest.approx(np.radians(5.0))

    def test_behind_a_parked_rotor_rows_are_shed_as_the_wind_goes(self):
        size = self.size(speed=0.0)
        assert 8.0 * size.step == pytest.approx(0.1 * 63.0)
        assert size.revolutions == 0.0
        assert 20 < len(size.ages) < 200

    def test_a_time_may_be_given(self):
        assert self.size(wake_step_s=0.05).step == pytest.approx(0.05)

    def test_growth_of_one_keeps_panels_equal(self):
        ages = self.size(wake_growth=1.0).ages
        np.testing.assert_allclose(np.diff(ages), ages[1], rtol=1e-9)


def test_check_describes_a_lattice_and_times_no_step_of_a_huge_one():
    small, huge = (dict(machine(**size).describe()) for size in ({}, {"spanwise_panels": 500}))
    assert "ms to move the wake" in small["cost"]
    assert "not measured" in huge["cost"]
