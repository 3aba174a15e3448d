"""Natural modes against closed forms, at rest and turning; damping as it was given."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.structure.assembly import Structure
from galerna.structure.beam import uniform
from galerna.structure.bodies import rigid_body
from galerna.structure.joints import hinge, spring
from galerna.structure.modes import linearise, natural_modes
from galerna.structure.statics import static_equilibrium

from .models import cantilever

LENGTH, MASS, EI = 10.0, 3.0, 2e5
EULER = uniform(np.array([1e12, 1e12, 1e11, 1e10, EI, 1e10]),
                np.array([MASS, MASS, MASS, 1e-4, 1e-4, 1e-4]))  # fmt: skip


def frequencies(system, state, count=3):
    return natural_modes(system, state, count).frequency


def test_cantilever_frequencies_converge_faster_than_third_order():
    exact = np.array([1.8751041, 4.6940911]) ** 2 * np.sqrt(EI / MASS) / LENGTH**2 / (2 * np.pi)
    errors = []
    for n in (5, 10, 20):
        system, _ = cantilever(n, EULER, LENGTH)
        found = frequencies(system, system.initial_state(), 2)
        errors.append(np.abs(found / exact - 1))
    assert (np.log2(errors[0][1] / errors[1][1])) > 2.0
    assert errors[2].max() < 2e-4


def test_a_mass_on_springs():
    s = Structure((0.0, 0.0, 0.0))
    s.frame("block", np.zeros(3), mass=rigid_body(2.0, None, np.array([1.0, 2.0, 3.0])))
    stiffness = np.diag([200.0, 450.0, 800.0, 100.0, 50.0, 12.0])
    s.join(spring("feet", "ground", "block", np.zeros(3), stiffness))
    system = s.build()
    found = natural_modes(system, system.initial_state(), 3).frequency * 2 * np.pi
    assert np.allclose(found, [2.0, 5.0, 10.0], rtol=1e-9)


def test_a_turning_frame_feels_centrifugal_and_coriolis_forces():
    """A point on springs of equal stiffness whirls at omega0 +- Omega in turning axes."""
    s = Structure((0.0, 0.0, 0.0))
    s.frame("hub", np.zeros(3), mass=rigid_body(1.0, None, np.ones(3)))
    s.frame("mass", np.zeros(3), mass=rigid_body(1.0, None, np.full(3, 1e-3)))
    s.join(spring("spokes", "hub", "mass", np.zeros(3), np.diag([25.0, 25, 1e6, 1e4, 1e4, 1e4])))
    z = np.array([0.0, 0.0, 1.0])
    s.join(hinge("bearing", "ground", "hub", np.zeros(3), z, angle=lambda time: 0.0))
    system = s.build()
    state = static_equilibrium(system, spin=(np.zeros(3), np.array([0.0, 0.0, 2.0])))
    found = 2 * np.pi * natural_modes(system, state, 4).frequency
    for whirl in (3.0, 7.0):
        assert np.abs(found / whirl - 1).min() < 1e-4


def test_stiffness_proportional_damping_gives_its_ratio():
    sections = uniform(np.diag(EULER.stiffness[0]), np.diag(EULER.inertia[0]), np.full(6, 1e-3))
    system, _ = cantilever(10, sections, LENGTH)
    modes = natural_modes(system, system.initial_state(), 3)
    undamped = modes.frequency / np.sqrt(1.0 - modes.damping_ratio**2)
    assert np.allclose(modes.damping_ratio, np.pi * undamped * 1e-3, rtol=1e-6)


def test_linearised_matrices_are_symmetric_at_rest():
    system, _ = cantilever(4, EULER, LENGTH)
    linear = linearise(system, system.initial_state())
    for matrix in (linear.mass, linear.stiffness):
        assert abs(matrix - matrix.T).max() < 1e-9 * abs(matrix).max()


def test_too_few_frames_are_refused():
    s = Structure()
    with pytest.raises(InputError, match="modes"):
        natural_modes(s.build(), s.build().initial_state())
