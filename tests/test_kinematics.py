"""The prescribed motion against geometry by hand and finite differences."""

import numpy as np
import pytest
from machines import small_turbine

from galerna.contract import Stations
from galerna.errors import InputError
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal, evaluate

SPAN = np.array([0.0, 0.4, 1.0])
BLADES = tuple(Stations(f"blade{k}", SPAN) for k in (1, 2, 3))
WIGGLY = Signal(np.array([0.0, 1.0, 3.0, 4.0]), np.array([1.0, 2.0, 1.5, 0.2]))


MACHINE = (*BLADES, Stations("hub"), Stations("nacelle"))


def machine(stations=MACHINE, **given):
    operation = {
        "rotor_speed": Signal.constant(0.0),
        "pitch": (Signal.constant(0.0),) * 3,
        **given,
    }
    return PrescribedMotion(small_turbine(), PrescribedOperation(**operation), [stations])


def at(moving, time):
    moving.move(time)
    motion = moving.motions[0]
    return {name: getattr(motion, name).copy() for name in motion.__slots__}


def skew(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def test_the_hub_stands_upwind_and_above_the_tower_top():
    turbine = small_turbine()
    hub = at(machine((Stations("hub"),)), 0.0)
    tilt, overhang = turbine.nacelle.tilt, turbine.nacelle.overhang
    expected = [-overhang * np.cos(tilt), 0.0, 20.9 + overhang * np.sin(tilt)]
    np.testing.assert_allclose(hub["position"][0], expected, atol=1e-12)
    assert hub["rotation"][0][2, 0] < 0.0, "the upwind end of the shaft is lifted"


def test_the_rotor_turns_clockwise_looking_downwind():
    """Blade 1 goes from up (z) to the right (-y) in a quarter turn, and blade 2 leads it."""
    tips = at(machine(azimuth=np.pi / 2), 0.0)["position"]
    assert tips[2, 1] == pytest.approx(-10.5, abs=0.2)
    up = at(machine(), 0.0)["position"]
    assert up[2, 2] > 30.0
    assert up[5, 1] < 0.0 < up[8, 1]


def test_cone_moves_the_tips_upwind_of_the_rotor_plane():
    moving = at(machine(), 0.0)
    shaft = moving["rotation"][9][:, 0]
    root, tip = moving["position"][0], moving["position"][2]
    turbine = small_turbine()
    upwind = 10.0 * np.sin(turbine.hub.cone) + 0.5 * np.cos(turbine.hub.cone)
    assert shaft @ (tip - root) == pytest.approx(-upwind, rel=1e-9)


def test_pitch_to_feather_turns_the_leading_edge_upwind():
    """y points to the trailing edge: with pitch to feather it turns downwind."""
    trailing = at(machine(), 0.0)["rotation"][2][:, 1]
    feathered = at(machine(pitch=(Signal.constant(0.5),) * 3), 0.0)["rotation"][2][:, 1]
    assert feathered[0] > trailing[0] + 0.4


def test_yaw_swings_the_hub_about_the_tower():
    hub = at(machine((Stations("hub"),), yaw=Signal.constant(np.pi / 2)), 0.0)["position"][0]
    assert hub[1] < -1.0, "positive about +z: the upwind end of the nacelle goes to -y"
    assert abs(hub[0]) < 1e-12


def test_at_yaw_error_of_30_deg_the_blade_at_azimuth_90_deg_is_downwind():
    positions = at(machine(yaw=Signal.constant(np.pi / 6), azimuth=np.pi / 2), 0.0)["position"]
    assert positions[2, 0] - positions[0, 0] == pytest.approx(5.0, abs=1.0)


def test_rates_are_the_derivatives_of_the_motion():
    moving = machine(
        rotor_speed=WIGGLY,
        pitch=tuple(Signal(WIGGLY.time, f * WIGGLY.value) for f in (0.1, -0.2, 0.3)),
        yaw=Signal(np.array([0.0, 5.0]), np.array([-0.3, 0.9])),
        azimuth=0.4,
    )
    h = 1e-4
    for time in (0.5, 1.7, 3.3):
        before, now, after = (at(moving, time + d) for d in (-h, 0.0, h))

        def slope(name, before=before, after=after):
            return (after[name] - before[name]) / (2 * h)

        np.testing.assert_allclose(now["velocity"], slope("position"), atol=2e-6)
        np.testing.assert_allclose(now["acceleration"], slope("velocity"), atol=2e-6)
        np.testing.assert_allclose(
            now["angular_acceleration"], slope("angular_velocity"), atol=1e-6
        )
        for R, dR, w in zip(
            now["rotation"], slope("rotation"), now["angular_velocity"], strict=True
        ):
            np.testing.assert_allclose(dR @ R.T, skew(w), atol=1e-6)


def test_frames_stay_rotations():
    R = at(machine(rotor_speed=Signal.constant(1.3), azimuth=2.0), 7.0)["rotation"]
    np.testing.assert_allclose(
        R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (len(R), 1, 1)), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(R), 1.0)


def test_the_azimuth_is_the_exact_integral_of_the_speed():
    moving = machine(rotor_speed=WIGGLY)
    moving.move(6.0)
    exact = 1.5 + 3.5 + 0.85 + 2 * 0.2
    assert moving.record()["azimuth"] == pytest.approx(exact % (2 * np.pi), rel=1e-13)


@pytest.mark.parametrize(
    ("time", "value", "slope", "integral"),
    [
        (-1.0, 1.0, 0.0, -1.0),
        (1.0, 2.0, -0.25, 1.5),
        (2.0, 1.75, -0.25, 3.375),
        (9.0, 0.2, 0.0, 6.85),
    ],
)
def test_signals_are_straight_between_knots_and_constant_outside(time, value, slope, integral):
    assert evaluate(WIGGLY.knots(), 0, 4, time) == pytest.approx((value, slope, integral))


def test_motions_come_in_the_order_of_the_models():
    moving = PrescribedMotion(
        small_turbine(),
        PrescribedOperation(Signal.constant(1.0), (Signal.constant(0.0),) * 3),
        [BLADES, (Stations("tower", np.array([0.0, 1.0])), Stations("nacelle"))],
    )
    blades, rest = moving.motions
    assert blades.position.shape == (9, 3)
    np.testing.assert_allclose(rest.position, [[0, 0, 0], [0, 0, 20], [0, 0, 20]], atol=1e-12)
    assert blades.velocity.flags.c_contiguous


def test_an_unknown_part_is_named():
    with pytest.raises(InputError, match="no part 'blade4'"):
        machine((Stations("blade4", SPAN),))
