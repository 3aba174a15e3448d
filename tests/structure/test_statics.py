"""Static equilibrium: closed forms, orders of convergence, and errors that name the cause."""

import numpy as np
import pytest

from galerna.errors import ConvergenceError, InputError
from galerna.structure.assembly import Structure
from galerna.structure.beam import discretise, nodal_loads, straight, uniform
from galerna.structure.bodies import moved, rigid_body, weight_of
from galerna.structure.frames import rotation_about
from galerna.structure.joints import ALL, Joint, hinge, rigid
from galerna.structure.statics import static_equilibrium
from galerna.structure.system import Forces

from .models import ALONG_X, cantilever, coupled_sections

INERTIA = np.array([1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3])
SLENDER = uniform(np.array([1e10, 1e10, 1e10, 1e6, 1e6, 1e6]), INERTIA)


def test_a_moment_rolls_the_beam_into_a_circle():
    system, tip = cantilever(10, SLENDER)
    forces = Forces.none(len(system))
    forces.follower[tip, 4] = 2 * np.pi * 1e6 / 10.0
    state = static_equilibrium(system, loads=forces, steps=10)
    assert np.abs(state.position[tip]).max() < 1e-8


def test_the_coupled_beam_is_exact_under_end_loads_in_the_linear_range():
    """Compliance of a uniform beam: integral of the sections' compliance times the moments."""
    sections = coupled_sections()
    load = np.array([0.01, -0.02, 0.03, 0.01, 0.02, -0.01])
    compliance = np.linalg.inv(sections.stiffness[0])
    expected = np.zeros(6)
    z, w = np.polynomial.legendre.leggauss(4)
    for arm, weight in zip(5.0 * (1 - z), 5.0 * w, strict=True):  # distance to the tip
        lever = np.eye(6)
        lever[3, 1], lever[4, 0] = -arm, arm
        expected += weight * lever.T @ compliance @ lever @ load
    for n in (1, 3):
        system, tip = cantilever(n, sections)
        forces = Forces.none(len(system))
        forces.dead[tip] = load * 1e-3
        state = static_equilibrium(system, loads=forces)
        shift = (state.position[tip] - [0, 0, 10.0]) * 1e3
        assert np.allclose(shift, expected[:3], atol=2e-6 * np.abs(expected[:3]).max(), rtol=0)


def test_large_bending_converges_at_fourth_order_in_the_mesh():
    tips = []
    for n in (4, 8, 16, 64):
        system, tip = cantilever(n, SLENDER)
        forces = Forces.none(len(system))
        forces.dead[tip, 0] = 1e6 / 10.0**2
        tips.append(static_equilibrium(system, loads=forces).position[tip])
    errors = [np.linalg.norm(tip - tips[-1]) for tip in tips[:3]]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 3.5).all()


def test_a_distributed_load_and_weight_give_the_textbook_deflection():
    q, length = 2.0, 10.0
    system, tip = cantilever(4, SLENDER, length)
    beam = discretise(straight(np.zeros(3), np.eye(3), length), length, SLENDER,
                      np.linspace(0, 1, 5))  # fmt: skip
    forces = Forces.none(len(system))
    forces.dead[1:] = nodal_loads(
        beam, lambda s: np.tile([q, 0, 0, 0, 0, 0.0], (len(s), 1)), length
    )[1:]
    deflection = static_equilibrium(system, loads=forces).position[tip, 0]
    assert deflection == pytest.approx(q * length**4 / 8e6, rel=1e-4)
    weighed, tip = cantilever(4, SLENDER, length, gravity=(q, 0.0, 0.0))
    assert static_equilibrium(weighed).position[tip, 0] == pytest.approx(deflection, rel=1e-5)


def test_the_root_carries_the_load():
    system, tip = cantilever(6, SLENDER)
    forces = Forces.none(len(system))
    forces.dead[tip, 1] = 1e3
    state = static_equilibrium(system, loads=forces)
    root = system.internal_loads(state, "beam")[0]
    with pytest.raises(InputError, match="beam"):
        system.internal_loads(state, "beem")
    x = state.position[tip]
    assert np.allclose(root[:3], [0, 1e3, 0], atol=1e-4)
    assert np.allclose(root[3:], np.cross(x, [0, 1e3, 0]), atol=1e-3)


def test_the_loads_of_a_beam_off_its_frame_are_its_sections():
    """A beam that starts 2 m from the frame that carries it, in axes of its own."""
    s = Structure((0.0, 0.0, 0.0))
    s.frame("hub", [1.0, 0.0, 0.0], mass=rigid_body(1.0, None, np.ones(3)))
    s.join(rigid("weld", "ground", "hub", np.array([1.0, 0.0, 0.0])))
    root = np.array([3.0, 0.0, 0.0])
    names = s.beam("beam", discretise(straight(root, ALONG_X, 10.0), 10.0, SLENDER,
                                      np.linspace(0, 1, 3)), root="hub")  # fmt: skip
    system = s.build()
    forces = Forces.none(len(system))
    forces.dead[s.index(names[-1]), 1] = 1.0
    state = static_equilibrium(system, loads=forces)
    at_root = system.internal_loads(state, "beam")[0]
    assert np.allclose(at_root, [0, 1, 0, -10, 0, 0], atol=1e-3)


@pytest.mark.parametrize("n", [1, 2, 5, 20])
@pytest.mark.parametrize("root", ["ground", "hub", None])
def test_the_root_carries_all_of_the_weight_and_of_the_loads(n, root):
    """A bar of 2000 N on its own frame or on another, with 3 N across at its first node."""
    s = Structure((0.0, 0.0, -10.0))
    s.frame("hub", np.zeros(3), mass=rigid_body(500.0, None, np.ones(3)))
    s.join(rigid("weld", "ground", "hub", np.zeros(3)))
    curve = straight(np.array([2.0, 0.0, 0.0]), np.eye(3), 10.0)
    sections = uniform(np.full(6, 1e9), 20.0 * INERTIA)
    names = s.beam("bar", discretise(curve, 10.0, sections, np.linspace(0, 1, n + 1)), root=root)
    if root is None:
        s.join(rigid("clamp", "ground", names[0], np.array([2.0, 0.0, 0.0])))
    system = s.build()
    forces = Forces.none(len(system))
    forces.dead[s.index(names[0]), :3] = [0.0, 3.0, 0.0]
    state = static_equilibrium(system, loads=forces)
    at_root = system.internal_loads(state, "bar", forces)[0]
    expected = [0, 3, -2000, 0, 0, 0 if root is None else -6]  # the load has an arm of 2 m
    assert np.allclose(at_root, expected, atol=1e-4)


@pytest.mark.parametrize(
    ("field", "shape", "expected"),
    [("dead", (2, 6), r"\(4, 6\)"), ("follower", (4, 3), r"\(4, 6\)"),
     ("mass", (4, 6), r"\(4, 6, 6\)")],
)  # fmt: skip
def test_forces_of_the_wrong_shape_are_refused(field, shape, expected):
    system, _ = cantilever(3, SLENDER)
    forces = Forces.none(len(system))
    setattr(forces, field, np.zeros(shape))
    with pytest.raises(InputError, match=f"{field}.*{expected}"):
        static_equilibrium(system, loads=forces)


def test_steady_rotation_of_a_bar_pulls_as_it_should():
    """Root tension m omega^2 L^2 / 2 of a bar that turns about its root."""
    s = Structure((0.0, 0.0, 0.0))
    curve = straight(np.zeros(3), np.eye(3), 10.0)
    names = s.beam("bar", discretise(curve, 10.0, SLENDER, np.linspace(0, 1, 5)))
    s.join(rigid("clamp", "ground", names[0], np.zeros(3)))
    system = s.build()
    state = static_equilibrium(system, spin=(np.zeros(3), np.array([3.0, 0.0, 0.0])))
    root = -system.pair_answer(state).node_wrench[system.pair("clamp"), :6]
    assert root[2] == pytest.approx(1.0 * 9.0 * 10.0**2 / 2, rel=1e-6)


def test_redundant_joints_are_named():
    s = Structure()
    s.frame("bar", [0.0, 0, 0], mass=rigid_body(1.0, None, np.ones(3)))
    y = np.array([0.0, 1.0, 0.0])
    s.join(hinge("left", "ground", "bar", np.zeros(3), y))
    s.join(hinge("right", "ground", "bar", y, y))
    with pytest.raises(InputError, match=r"left, right.*hold the same motion twice"):
        s.build()


def test_contradicting_joints_are_named():
    s = Structure()
    s.frame("bar", [0.0, 0, 0], mass=rigid_body(1.0, None, np.ones(3)))
    y = np.array([0.0, 1.0, 0.0])
    s.join(rigid("weld", "ground", "bar", np.zeros(3)))
    s.join(hinge("motor", "ground", "bar", y, y, angle=lambda t: 0.3 + t))
    with pytest.raises(InputError, match=r"weld, motor.*contradict"):
        s.build()


def test_driven_joints_that_agree_are_redundant_and_not_contradicting():
    """Both shift the bar by 0.1 m, one of them with an arm of 10 m."""
    s = Structure()
    s.frame("bar", [0.0, 0, 0], mass=rigid_body(1.0, None, np.ones(3)))
    for name, y in (("left", 0.0), ("right", 10.0)):
        s.join(Joint(name, "ground", "bar", np.array([0.0, y, 0.0]), locked=ALL,
                     placement=lambda t: (np.array([0.1, 0.0, 0.0]), np.eye(3))))  # fmt: skip
    with pytest.raises(InputError, match=r"left, right.*hold the same motion twice"):
        s.build()


@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_long_bent_elements_with_offset_mass_keep_positive_inertia(n):
    """An arc of 12 m: mass and first moment exact, every node's mass matrix positive."""

    def arc(s):
        t = 1.2 * s
        position = 10 * np.stack([1 - np.cos(t), 0 * t, np.sin(t)], axis=1)
        return position, np.array([rotation_about(1, angle) for angle in t])

    inertia = rigid_body(3.0, np.array([0.2, -0.1, 0.0]), np.array([0.1, 0.2, 0.25]))
    beam = discretise(arc, 12.0, uniform(np.full(6, 1e6), inertia), np.linspace(0, 1, n + 1))
    total = sum(
        moved(M, R, x) for M, R, x in zip(beam.mass, beam.rotation, beam.position, strict=True)
    )
    assert all(np.linalg.eigvalsh(M)[0] > 0 for M in beam.mass)
    assert total[0, 0] == pytest.approx(36.0, rel=1e-12)
    assert weight_of(total)[1] == pytest.approx(36 * (10 - 9.8 * np.sin(1.2) / 1.2), rel=1e-4)


class Narrow:
    """A constraint on two frames that forgets the second one."""

    name, frames, holonomic = "narrow", ("ground", "brick"), True

    def violation(self, time, x, R, v):
        return np.zeros(1)

    def directions(self, time, x, R):
        return np.ones((1, 6))


def test_a_constraint_of_the_wrong_width_is_named():
    s = Structure()
    s.frame("brick", [0.0, 0, 0], mass=rigid_body(1.0, None, np.ones(3)))
    s.constrain(Narrow())
    with pytest.raises(InputError, match=r"narrow: .*\(1, 6\).*\(1, 12\)"):
        s.build()


def test_loads_that_are_no_numbers_are_named():
    system, tip = cantilever(2, SLENDER)
    forces = Forces.none(len(system))
    forces.dead[tip, 1] = np.nan
    with pytest.raises(InputError, match=r"beam\[2\]: the loads are not finite"):
        static_equilibrium(system, loads=forces)


def test_a_loose_structure_is_an_error_that_says_where():
    s = Structure()
    s.frame("brick", [0.0, 0, 0], mass=rigid_body(1.0, None, np.ones(3)))
    with pytest.raises(ConvergenceError, match="brick"):
        static_equilibrium(s.build())


def test_bad_input_is_named():
    s = Structure()
    with pytest.raises(InputError, match="did you mean 'ground'"):
        s.join(rigid("weld", "grund", "ground", np.zeros(3)))
    s.frame("brick", [0.0, 0, 0], mass=rigid_body(1.0, None, np.ones(3)))
    s.join(rigid("weld", "ground", "brick", np.zeros(3)))
    with pytest.raises(InputError, match="weld: there is a joint of this name already"):
        s.join(hinge("weld", "ground", "brick", np.zeros(3), np.ones(3)))
    s.frame("ghost", [0.0, 0, 0])
    with pytest.raises(InputError, match="ghost"):
        s.build()
    lopsided = np.diag(INERTIA)
    lopsided[3, 4] = 5e-4
    with pytest.raises(InputError, match="not symmetric"):
        cantilever(2, uniform(lopsided, INERTIA))
    with pytest.raises(InputError, match="damping"):
        cantilever(2, uniform(INERTIA, INERTIA, np.full(6, -0.1)))
    with pytest.raises(InputError, match="do not grow"):
        discretise(straight(np.zeros(3), np.eye(3), 1.0), 1.0, SLENDER, np.array([0, 0.7, 0.5, 1]))
    with pytest.raises(InputError, match="no direction"):
        hinge("pin", "ground", "ghost", np.zeros(3), np.zeros(3))
    with pytest.raises(InputError, match="finite"):
        rigid_body(np.nan)
    with pytest.raises(InputError, match="symmetric"):
        rigid_body(1.0, None, np.eye(3) + np.diag([0.5, 0.0], 1))
    skew, heavy = np.diag([1.0, 1.0, 1.1]), np.diag([-1.0, 1, 1, 1, 1, 1])
    with pytest.raises(InputError, match="rotation"):
        s.frame("skew", np.zeros(3), skew)
    with pytest.raises(InputError, match="rotation"):
        s.join(Joint("skew", "ground", "brick", np.zeros(3), skew))
    for place in (np.zeros(2), np.array([0.0, np.nan, 0.0])):
        with pytest.raises(InputError, match=r"lost.*position"):
            s.frame("lost", place)
        with pytest.raises(InputError, match=r"lost.*position"):
            s.join(rigid("lost", "ground", "brick", place))
    for mass in (heavy, np.nan * heavy, np.eye(3)):
        with pytest.raises(InputError, match=r"brick.*mass"):
            s.add_mass("brick", mass)
    with pytest.raises(InputError, match="steps"):
        static_equilibrium(cantilever(2, SLENDER)[0], steps=0)
    with pytest.raises(InputError, match=r"12 m.*10 m"):
        discretise(straight(np.zeros(3), np.eye(3), 10.0), 12.0, SLENDER, np.array([0.0, 1.0]))
    with pytest.raises(InputError, match="not positive definite"):
        cantilever(2, uniform(np.array([1.0, 1, 1, 1, -1, 1]), INERTIA))
