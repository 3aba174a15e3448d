"""Strips of members, and the drag of still, moving and wavy water on them."""

from dataclasses import replace

import numpy as np
import pytest

from galerna.contract import LoadModel, Motion, Stations
from galerna.hydro.drag import ViscousDrag
from galerna.hydro.sea_options import SeaOptions
from galerna.hydro.strips import Carrier, platform_strips
from galerna.hydro.waves import Current, Sea, build_sea
from galerna.structure.frames import exp_so3
from galerna.turbine.platform import Member, Platform

RHO, CD = 1025.0, 0.6


def cylinder(bottom=-120.0, top=10.0, diameter=9.0, axial=0.0, at=(0.0, 0.0), name="spar"):
    return Member(
        name, np.array([*at, bottom]), np.array([*at, top]), np.array([0.0, 1.0]),
        np.full((2, 2), diameter), True, np.full((1, 2), CD), axial,
    )  # fmt: skip


def box(start, end, sides, drag, axial=0.0, name="pontoon"):
    return Member(
        name, np.array(start), np.array(end), np.array([0.0, 1.0]),
        np.tile(sides, (2, 1)).astype(float), False, np.tile(drag, (2, 1)).astype(float), axial,
    )  # fmt: skip


def platform(*members, reference=(0.0, 0.0, 0.0)):
    return Platform(reference, 1.0, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0), members=members)


def moving(velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0), at=(0.0,) * 3):
    motion = Motion.at_rest(1)
    motion.position[:], motion.velocity[:], motion.angular_velocity[:] = at, velocity, spin
    motion.rotation[0] = exp_so3(np.array(turn))
    return motion


STILL = Sea.still(320.0)


def irregular(**options):
    waves = {
        "kind": "jonswap", "significant_height_m": 6.0, "peak_period_s": 10.0,
        "spreading_exponent": 5.0,
    }  # fmt: skip
    return build_sea(SeaOptions(waves=waves, **options), 300.0, 3, 320.0)


def test_strips_are_the_member():
    strips = platform_strips([cylinder()])
    assert strips.length.sum() == pytest.approx(130.0, rel=1e-12)
    assert strips.length.min() > 0.5
    near = np.abs(strips.center[:, 2]) < 5.0
    assert strips.length[near].max() < 1.3
    assert strips.length @ strips.center[:, 2] == pytest.approx(130.0 * -55.0, rel=1e-12)
    assert strips.drag_width == pytest.approx(np.full((len(strips), 2), CD * 9.0))


def test_strips_follow_a_taper_and_its_corners():
    taper = replace(
        cylinder(), span=np.array([0.0, 108.0 / 130.0, 116.0 / 130.0, 1.0]),
        sides=np.array([[9.4] * 2, [9.4] * 2, [6.5] * 2, [6.5] * 2]),
    )  # fmt: skip
    strips = platform_strips([taper])
    area = 108.0 * 9.4 + 8.0 * 0.5 * (9.4 + 6.5) + 14.0 * 6.5
    assert strips.length @ strips.drag_width[:, 0] == pytest.approx(CD * area, rel=1e-12)


def test_nothing_drags_inside_of_another_member():
    column = cylinder(-20.0, 15.0, 12.0, axial=1.0, name="column")
    pontoon = box((0, 0, -16.5), (50, 0, -16.5), (12.0, 7.0), (1.0, 2.0), 0.5)
    far = cylinder(-20.0, 15.0, 12.0, axial=1.0, at=(50.0, 0.0), name="far")
    strips = platform_strips([column, pontoon, far])
    lying = np.abs(strips.axes[:, 2, 2]) < 0.1
    assert strips.length[lying].sum() == pytest.approx(50.0 - 12.0, abs=0.3)
    # flow across the pontoon meets its upright side of 7 m, flow from above that of 12 m
    assert strips.drag_width[lying][0] == pytest.approx([7.0, 24.0])
    ends = strips.drag_area > 0.0
    assert strips.drag_area[ends] == pytest.approx(np.full(4, np.pi * 36.0))


def test_stacked_members_have_no_ends_between_them():
    lower, upper = cylinder(-50.0, -20.0, axial=1.0), cylinder(-20.0, 10.0, axial=1.0, name="up")
    strips = platform_strips([lower, upper])
    assert np.sort(strips.center[strips.drag_area > 0.0, 2]) == pytest.approx([-50.0, 10.0])


def test_is_a_load_model_without_memory():
    model = ViscousDrag(platform(cylinder()), STILL)
    assert isinstance(model, LoadModel)
    assert model.state() == {}


def test_cylinder_dragged_through_still_water():
    model = ViscousDrag(platform(cylinder()), STILL)
    loads = model.loads(0.0, moving((0.8, -0.6, 2.0)))
    force = 0.5 * RHO * CD * 9.0 * 120.0
    assert loads.force[0] == pytest.approx([-0.8 * force, 0.6 * force, 0.0], rel=1e-12)
    assert loads.moment[0] == pytest.approx([0.6 * force * 60, 0.8 * force * 60, 0.0], rel=1e-12)
    model.end_step(0.0, moving())
    shown = list(model.record().values())
    assert shown == pytest.approx([*loads.force[0], *loads.moment[0]])


@pytest.mark.parametrize(("spacing", "error"), [(1.0, 1e-3), (0.5, 2.5e-4)])
def test_cylinder_turning_in_still_water(spacing, error):
    """Moment 1/2 rho C_d D L^4 / 4 w^2; the midpoint rule errs with the square of the strips."""
    model = ViscousDrag(platform(cylinder()), STILL, spacing=spacing)
    found = model.loads(0.0, moving(spin=(0.0, 0.03, 0.0))).moment[0, 1]
    exact = -0.5 * RHO * CD * 9.0 * 120.0**4 / 4.0 * 0.03**2
    assert abs(found / exact - 1.0) < error


def test_harmonic_motion_loses_the_energy_of_its_equivalent_damping():
    """Work of a cycle is pi V^2 / w times 8/(3 pi) c V; the force has that first harmonic."""
    model = ViscousDrag(platform(cylinder()), STILL)
    amplitude, w, n = 1.7, 0.2, 720
    angle = 2.0 * np.pi * np.arange(n) / n
    velocity = amplitude * np.cos(angle)
    force = np.array([model.loads(0.0, moving((v, 0.0, 0.0))).force[0, 0] for v in velocity])
    c = 0.5 * RHO * CD * 9.0 * 120.0
    damping = 8.0 / (3.0 * np.pi) * c * amplitude
    assert -2.0 * np.mean(force * np.cos(angle)) == pytest.approx(damping * amplitude, rel=1e-4)
    work = np.sum(-force * velocity) * 2.0 * np.pi / (n * w)
    assert work == pytest.approx(np.pi * damping * amplitude**2 / w, rel=1e-4)


def test_current_drags_by_its_profile():
    """1/2 rho C_d D times the integral of the squared power law over the draft."""
    sea = replace(STILL, current=Current.power_law(1.5, 0.4, 320.0))
    force = ViscousDrag(platform(cylinder()), sea).loads(0.0, moving()).force[0]
    power = 2.0 / 7.0 + 1.0
    integral = 320.0 / power * (1.0 - (200.0 / 320.0) ** power)
    total = 0.5 * RHO * CD * 9.0 * 1.5**2 * integral
    assert force == pytest.approx([total * np.cos(0.4), total * np.sin(0.4), 0.0], rel=1e-4)


def test_only_the_flow_across_an_inclined_member_drags():
    """Turned by an angle a, a cylinder in a current u has 1/2 rho C_d D L (u cos a)^2 across."""
    sea = replace(STILL, current=Current.uniform(2.0, 0.0))
    model = ViscousDrag(platform(cylinder(-60.0, -20.0)), sea)
    angle = 0.3
    force = model.loads(0.0, moving(turn=(0.0, angle, 0.0))).force[0]
    across = 0.5 * RHO * CD * 9.0 * 40.0 * (2.0 * np.cos(angle)) ** 2
    assert force == pytest.approx([across * np.cos(angle), 0.0, -across * np.sin(angle)], rel=1e-12)


def test_rectangular_sides_have_their_own_drag():
    """For flow askew each side's force takes its component of u |u|."""
    sea = replace(STILL, current=Current.uniform(1.0, 0.5))
    member = box((0, 0, -30), (0, 0, -10), (12.0, 7.0), (1.1, 2.2))
    force = ViscousDrag(platform(member), sea).loads(0.0, moving()).force[0]
    scale = 0.5 * RHO * 20.0
    expected = [scale * 1.1 * 7.0 * np.cos(0.5), scale * 2.2 * 12.0 * np.sin(0.5), 0.0]
    assert force == pytest.approx(expected, rel=1e-12)


def test_ends_drag_along_the_axis():
    model = ViscousDrag(platform(cylinder(axial=1.2)), STILL)
    force = model.loads(0.0, moving((0.0, 0.0, 0.7))).force[0]
    area = np.pi * 81.0 / 4.0
    assert force == pytest.approx([0.0, 0.0, -0.5 * RHO * 1.2 * area * 0.49], rel=1e-12)


def test_a_heaved_cylinder_is_wet_to_the_still_water():
    model = ViscousDrag(platform(cylinder()), STILL)
    force = [
        model.loads(0.0, moving((1.0, 0.0, 0.0), at=(0.0, 0.0, z))).force[0, 0] for z in (0, 2.3)
    ]
    assert force[1] / force[0] == pytest.approx((120.0 - 2.3) / 120.0, rel=1e-12)


@pytest.mark.parametrize("stretching", ["none", "vertical", "extrapolation", "wheeler"])
def test_drag_in_waves_is_the_integral_over_the_wet_length(stretching):
    """Against a fine quadrature of the stretched profile of a regular wave."""
    sea = Sea.regular(8.0, 9.0, 320.0)
    model = ViscousDrag(platform(cylinder()), sea, stretching=stretching, spacing=0.5)
    k, w = float(sea.wavenumber[0]), float(sea.frequency[0])
    for phase in (0.1, 2.0, 3.5):
        eta = 4.0 * np.cos(phase)
        top = 0.0 if stretching == "none" else eta
        z = np.linspace(-120.0, top, 200_001)
        low = np.minimum(z, 0.0)
        u = {
            "none": np.exp(k * low), "vertical": np.exp(k * low),
            "extrapolation": np.exp(k * low) + k * np.maximum(z, 0.0),
            "wheeler": np.exp(k * (z - eta) / (1.0 + eta / 320.0)),
        }[stretching] * 4.0 * w * np.cos(phase)  # fmt: skip
        exact = 0.5 * RHO * CD * 9.0 * np.trapezoid(np.abs(u) * u, z)
        moment = 0.5 * RHO * CD * 9.0 * np.trapezoid(np.abs(u) * u * z, z)
        loads = model.loads(phase / w, moving())
        assert loads.force[0, 0] == pytest.approx(exact, rel=2e-3)
        assert loads.moment[0, 1] == pytest.approx(moment, rel=2e-3)


def test_wave_is_felt_at_the_members_own_places():
    """Two columns half a wave apart: opposite forces, and a yawing moment of both."""
    length = 2.0 * np.pi / float(Sea.regular(4.0, 8.0, 320.0).wavenumber[0])
    sea = Sea.regular(4.0, 8.0, 320.0, direction=np.pi / 2)
    pair = [cylinder(-20.0, 10.0, 5.0, at=(7.0, y), name=f"{y}") for y in (0.0, 0.5 * length)]
    one = ViscousDrag(platform(pair[0]), sea, stretching="none").loads(0.7, moving())
    both = ViscousDrag(platform(*pair), sea, stretching="none").loads(0.7, moving())
    assert abs(one.force[0, 1]) > 1e4
    assert abs(both.force[0, 1]) < 1e-3 * abs(one.force[0, 1])
    assert one.moment[0, 2] == pytest.approx(7.0 * one.force[0, 1], rel=1e-12)


def disturbed(motion, j, step):
    """A motion with a rate of direction j changed."""
    changed = replace_rates(motion)
    (changed.velocity if j < 3 else changed.angular_velocity)[0, j % 3] += step
    return changed


def replace_rates(motion):
    return Motion(
        motion.position, motion.rotation, motion.velocity.copy(), motion.angular_velocity.copy(),
        motion.acceleration, motion.angular_acceleration,
    )  # fmt: skip


def test_damping_is_minus_the_slope_of_the_loads():
    members = (
        cylinder(axial=0.8),
        box((5, 0, -16.5), (50, 20, -18.0), (12.0, 7.0), (1.1, 2.2), 0.9),
    )
    reference = (1.0, 2.0, -5.0)
    model = ViscousDrag(platform(*members, reference=reference), irregular())
    motion = moving((0.4, -0.3, 0.8), (0.02, -0.01, 0.03), (0.05, 0.1, -0.2), reference)
    damping, step = model.loads(120.0, motion).damping[0], 1e-5
    for j in range(6):
        ahead, back = (model.loads(120.0, disturbed(motion, j, s)) for s in (step, -step))
        slope = np.concatenate([(ahead.force - back.force)[0], (ahead.moment - back.moment)[0]]) / (
            2.0 * step
        )
        assert damping[:, j] == pytest.approx(-slope, rel=1e-6, abs=1e-7 * np.abs(damping).max())


def test_carrier_of_many_frames_has_the_loads_of_one():
    """A spar cut into frames that move as one body: the same sum, frame by frame."""
    sea, spar = irregular(), cylinder()
    span = np.linspace(0.05, 0.95, 10)
    place = np.column_stack([np.zeros((10, 2)), -120.0 + 130.0 * span])
    axes = exp_so3(np.array([0.0, 0.0, 0.7]))
    carrier = Carrier(Stations("spar", span), place, np.tile(axes, (10, 1, 1)))
    model = ViscousDrag(platform(spar), sea, carrier=carrier)
    rigid = moving((0.4, -0.3, 0.8), (0.02, -0.01, 0.03), (0.05, 0.1, -0.2))
    many = Motion.at_rest(10)
    many.position[:] = place @ rigid.rotation[0].T
    many.rotation[:] = rigid.rotation[0] @ axes
    many.velocity[:] = rigid.velocity + np.cross(rigid.angular_velocity, many.position)
    many.angular_velocity[:] = rigid.angular_velocity
    one, parts = ViscousDrag(platform(spar), sea).loads(80.0, rigid), model.loads(80.0, many)
    moment = parts.moment.sum(axis=0) + np.cross(many.position, parts.force).sum(axis=0)
    assert parts.force.sum(axis=0) == pytest.approx(one.force[0], rel=1e-12)
    assert moment == pytest.approx(one.moment[0], rel=1e-12)
    model.end_step(80.0, many)
    about_first = moment - np.cross(many.position[0], one.force[0])
    assert list(model.record().values())[3:] == pytest.approx(about_first, rel=1e-9)


def test_at_rest_there_is_the_current_alone():
    """Also where the waves do not grow at the start: their drag at time 0 is no mean load."""
    spar, current = platform(cylinder(axial=1.0)), Current.uniform(0.8, 0.3)
    at_rest = [
        ViscousDrag(spar, sea).static_loads(moving())
        for sea in (
            Sea.regular(6.0, 10.0, 320.0, current=current),
            Sea.still(320.0, current=current),
        )
    ]
    np.testing.assert_array_equal(at_rest[0].force, at_rest[1].force)
    np.testing.assert_array_equal(at_rest[0].moment, at_rest[1].moment)
    pull = 0.5 * RHO * CD * 9.0 * 120.0 * 0.8**2
    np.testing.assert_allclose(
        at_rest[0].force[0], [pull * np.cos(0.3), pull * np.sin(0.3), 0.0], rtol=1e-9
    )


def test_loads_depend_on_time_and_motion_alone():
    sea = irregular()
    model, resumed = (ViscousDrag(platform(cylinder()), sea) for _ in range(2))
    motion = moving((0.4, -0.3, 0.8), (0.02, -0.01, 0.03))
    for t in (10.0, 55.0, 30.0):
        model.begin_step(t, 0.02, motion)
        model.loads(t, motion)
        model.end_step(t, motion)
    resumed.restore(model.state())
    first, second = model.loads(77.7, motion), resumed.loads(77.7, motion)
    assert np.array_equal(first.force, second.force)
    assert np.array_equal(first.damping, second.damping)


def test_a_platform_without_members_has_no_drag():
    loads = ViscousDrag(platform(), irregular()).loads(5.0, moving((1.0, 0.0, 0.0)))
    assert not loads.force.any()
