"""Small structures that several tests use."""

import numpy as np

from galerna.structure.assembly import Structure
from galerna.structure.beam import discretise, straight, uniform
from galerna.structure.bodies import rigid_body
from galerna.structure.frames import exp_se3
from galerna.structure.joints import hinge

ALONG_X = np.stack([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], axis=1)
DOWN = np.stack([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]], axis=1)


def coupled_sections(damping=0.0):
    """A uniform section with every entry of its 6x6 matrices filled."""
    random = np.random.default_rng(7)
    spread = random.normal(size=(2, 6, 6)) * 0.15
    size = np.diag(np.sqrt([3e5, 4e5, 1e6, 2e3, 1e3, 8e2]))
    stiffness = (
        size @ (np.eye(6) + spread[0] @ spread[0].T + 0.1 * (spread[0] + spread[0].T)) @ size
    )
    inertia = rigid_body(2.0, np.array([0.03, -0.05, 0.0]), np.array([0.02, 0.03, 0.05]))
    return uniform(stiffness, inertia, np.full(6, damping))


def cantilever(n, sections, length=10.0, gravity=(0.0, 0.0, 0.0)):
    """A vertical beam on the ground; its system and the tip's number."""
    s = Structure(gravity)
    beam = discretise(straight(np.zeros(3), np.eye(3), length), length, sections,
                      np.linspace(0, 1, n + 1))  # fmt: skip
    names = s.beam("beam", beam, root="ground")
    return s.build(), s.index(names[-1])


def double_pendulum(n, sections):
    """Two hinged beams of 1 m, the first along x and the second hanging; and the tips' numbers."""
    s = Structure((0.0, 0.0, -9.81))
    span, y = np.linspace(0, 1, n + 1), np.array([0.0, 1.0, 0.0])
    elbow = np.array([1.0, 0.0, 0.0])
    one = s.beam("one", discretise(straight(np.zeros(3), ALONG_X, 1.0), 1.0, sections, span))
    two = s.beam("two", discretise(straight(elbow, DOWN, 1.0), 1.0, sections, span))
    s.join(hinge("shoulder", "ground", one[0], np.zeros(3), y))
    s.join(hinge("elbow", one[-1], two[0], elbow, y))
    return s.build(), s.index(one[-1]), s.index(two[-1])


def flexible_sections():
    """Table 3.1's flexible pendulum: EA 1000 N, GA 1e5 N, GJ 1e5 N m2, EI 1 N m2, 1 kg/m."""
    return uniform(np.array([1e5, 1e5, 1e3, 1.0, 1.0, 1e5]), np.array([1, 1, 1, 1e-5, 1e-5, 1e-5]))


def disturbed(system, size, seed=1):
    """A state with random shape, velocities, accelerations and joint forces."""
    random = np.random.default_rng(seed)
    state = system.initial_state()
    for i in range(1, len(system)):
        turn, shift = exp_se3(size * random.normal(size=6))
        state.position[i] += state.rotation[i] @ shift
        state.rotation[i] = state.rotation[i] @ turn
    state.velocity[1:] = random.normal(size=(len(system) - 1, 6))
    state.acceleration[1:] = random.normal(size=(len(system) - 1, 6))
    locked = system.pairs.locked
    state.multiplier[locked] = 100.0 * random.normal(size=locked.sum())
    return state
