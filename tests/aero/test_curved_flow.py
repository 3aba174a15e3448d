"""Sections that turn, against thin-airfoil theory, and the work they do on a blade that twists."""

import numpy as np
import pytest
from numpy import pi

from galerna import turbine
from galerna.aero.bem.curved_flow import curved_flow_moment
from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import UniformWind
from galerna.aero.rigid_rotor import rigid_rotor_motion
from galerna.units import DEG, RPM

CHORD, SPEED, RATE = 2.0, 50.0, 0.7


def thin_airfoil(turning_point):
    """cl and cm about the quarter chord of a plate that turns about a point of its chord.

    Glauert's series of the local angle, A0 - sum An cos(n theta), by quadrature over theta.
    """
    theta = (np.arange(400) + 0.5) * pi / 400
    place = 0.5 * CHORD * (1.0 - np.cos(theta))
    local = RATE * (place - turning_point) / SPEED
    a_0 = local.mean()
    a_1, a_2 = (-2.0 * np.mean(local * np.cos(n * theta)) for n in (1, 2))
    return 2 * pi * (a_0 + 0.5 * a_1), -0.25 * pi * (a_1 - a_2)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.75])
def test_a_turning_plate_has_the_lift_and_moment_of_thin_airfoil_theory(share):
    lift, moment = thin_airfoil(share * CHORD)
    angle = RATE * (0.75 - share) * CHORD / SPEED
    assert lift == pytest.approx(2 * pi * angle, abs=1e-12)
    assert curved_flow_moment(2 * pi, CHORD, SPEED, angle, RATE) == pytest.approx(moment, rel=1e-9)


def test_a_plate_that_twists_about_any_axis_loses_energy():
    """-2 pi (e - 1/4)^2 c/V, with e c from the quarter chord to the axis: none at the middle."""
    for share in np.linspace(-0.5, 1.0, 31):
        lift = 2 * pi * (0.5 - share) * CHORD * RATE / SPEED
        about_axis = share * lift + curved_flow_moment(2 * pi, CHORD, SPEED, 0.0, RATE)
        expected = -2 * pi * (share - 0.25) ** 2 * CHORD * RATE / SPEED
        assert about_axis == pytest.approx(expected, abs=1e-12)


def test_it_fades_out_of_the_flow_from_the_front_and_without_lift():
    assert curved_flow_moment(0.0, CHORD, SPEED, 0.0, RATE) == 0.0
    assert curved_flow_moment(2 * pi, CHORD, SPEED, pi, RATE) == 0.0
    assert np.isfinite(curved_flow_moment(2 * pi, CHORD, 0.0, 0.0, RATE))


def twisting(options, rate):
    """Aerodynamic moments (n,) N m about one blade's axis while every blade twists at a rate.

    At 18 m/s, without induction: each section meets what it would meet alone.
    """
    machine = turbine.load("nrel5mw")
    model = BladeElementMomentum(machine, UniformWind(np.array([18.0, 0, 0])), options=options)
    motion = rigid_rotor_motion(machine, model.sections, 0.0, 12.1 * RPM, 14.9 * DEG)
    n = len(model.sections)
    span = motion.rotation[: 3 * n, :, 2]
    motion.angular_velocity[: 3 * n] += rate * span
    model.begin_step(0.0, 0.01, motion)
    loads = model.loads(0.01, motion)
    return np.einsum("ij,ij->i", loads.moment[:n], span[:n]), model.sections


@pytest.mark.parametrize("unsteady", ["none", "beddoes_leishman"])
@pytest.mark.parametrize("point", ["three_quarter_chord", "aerodynamic_center"])
def test_the_twist_of_a_blade_is_damped(unsteady, point):
    options = BemOptions(
        unsteady_airfoil=unsteady,
        angle_of_attack_point=point,
        induction=False,
        tower_influence=False,
    )
    (faster, sections), (slower, _) = twisting(options, 0.01), twisting(options, -0.01)
    outer = (sections.span > 0.5) & (sections.span < 1.0)
    assert np.all(faster[outer] < slower[outer])


def test_steady_sections_agree_with_long_lasting_unsteady_ones_also_in_moment():
    """Steady coning bends the flow; without torsion both meet it alike."""
    quiet = {"tower_influence": False, "induction": False}
    moments = [twisting(BemOptions(quasi_steady=quasi, **quiet), 0.0)[0] for quasi in (True, False)]
    np.testing.assert_allclose(moments[0], moments[1], rtol=1e-9, atol=1e-6)
