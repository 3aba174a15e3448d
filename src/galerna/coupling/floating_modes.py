"""A machine afloat, linear: natural frequencies, and the answer to waves of a frequency."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse.linalg import splu

from galerna.contract import Array, Loads
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.floating import ARM, mass_center
from galerna.hydro.database import Complex, HydroDatabase
from galerna.hydro.rigid import MODES
from galerna.structure.modes import Modes, linearise, natural_modes
from galerna.structure.system import Forces, State

PASSES = 3  #: of a frequency and the coefficients at it
FIRST, NEAREST = 14, 6  #: modes that are computed: from the lowest on, and about a frequency
LOW = 0.2  #: rad/s, of the coefficients with which modes are looked for
MOVED = 0.02  #: of a mode's largest motion: less of the platform's is another part's mode
SLOWEST = 1e-4  #: Hz: slower is a rotor that turns freely


@dataclass(frozen=True)
class FloatingMode:
    """A mode with the platform's largest motion in ``name``; Hz, and of critical damping."""

    name: str
    frequency: float
    damping_ratio: float


def floating_modes(
    machine: FlexibleMachine,
    state: State,
    loads: Sequence[Loads],
    database: HydroDatabase,
    axes: Array | None = None,
) -> list[FloatingMode]:
    """The six modes of the platform about an equilibrium at rest, by rising frequency.

    ``loads`` are those of the load models there, whose mass block of the water is the database's
    added mass at infinite frequency in ``axes`` (3,3), the platform's unless given. Coefficients
    at rest: no viscous drag. A mode has its name from the largest motion of the machine's mass
    centre, rotations counted at 50 m.
    """
    base, node = machine.forces(loads), int(machine.parts.parts["platform"][0])
    turned = _six(state.rotation[node] if axes is None else axes)
    center = state.rotation[node].T @ (
        mass_center(machine.system, state) - state.position[node]
    )  # in the platform's axes
    found = []
    modes = natural_modes(machine.system, state, FIRST, _at(base, node, database, LOW, turned))
    for k, (name, shown) in _named(modes, node, center):
        frequency, ratio, shape = modes.frequency[k], modes.damping_ratio[k], shown
        for _ in range(PASSES):
            forces = _at(base, node, database, 2.0 * np.pi * frequency, turned)
            near = natural_modes(machine.system, state, NEAREST, forces, about_hz=frequency)
            alike = [abs(np.vdot(_motion(one, node, center), shape)) for one in near.shape]
            best = int(np.argmax(alike))
            shape = _motion(near.shape[best], node, center)
            frequency, ratio = near.frequency[best], near.damping_ratio[best]
        found.append(FloatingMode(name, float(frequency), float(ratio)))
    return sorted(found, key=lambda mode: mode.frequency)


def response(
    machine: FlexibleMachine,
    state: State,
    loads: Sequence[Loads],
    database: HydroDatabase,
    frequency: float,
    excitation: Complex,
    axes: Array | None = None,
) -> Complex:
    """Linear answer (n,6) of all frames, in their own axes, to Re[excitation exp(i w t)].

    ``excitation`` (6,) N, N m acts on the platform at ``frequency`` rad/s; see ``floating_modes``.
    """
    node = int(machine.parts.parts["platform"][0])
    turned = _six(state.rotation[node] if axes is None else axes)
    forces = _at(machine.forces(loads), node, database, frequency, turned)
    linear = linearise(machine.system, state, forces)
    s = 1j * frequency
    matrix = s**2 * linear.mass + s * linear.damping + linear.stiffness
    right = np.zeros(matrix.shape[0], dtype=complex)
    own = excitation.reshape(2, 3) @ state.rotation[node]
    right[6 * (node - 1) : 6 * node] = own.ravel()
    found = splu(matrix.tocsc()).solve(right)[: linear.motions].reshape(-1, 6)
    return np.concatenate([np.zeros((1, 6)), found])


def _named(modes: Modes, node: int, center: Array) -> Iterator[tuple[int, tuple[str, Complex]]]:
    """Numbers of the six modes that move the platform most, each with a name of its own.

    The names are those that fit all six best.
    """
    found = []
    for k in range(len(modes)):
        moved = float(np.abs(modes.shape[k, node] / ARM).max())
        if modes.frequency[k] > SLOWEST and moved > MOVED * float(
            np.abs(modes.shape[k] / ARM).max()
        ):
            found.append((k, _motion(modes.shape[k], node, center)))
    found = found[: len(MODES)]
    likeness = np.array([np.abs(shape) for _, shape in found]).reshape(-1, len(MODES))
    for row, column in zip(*linear_sum_assignment(-likeness), strict=True):
        yield found[row][0], (MODES[column], found[row][1])


def _motion(shape: Array, node: int, center: Array) -> Complex:
    """Motion (6,) of the machine's mass centre with the platform, of size 1; turns at 50 m."""
    moved, turned = shape[node, :3], shape[node, 3:]
    whole = np.concatenate([moved + np.cross(turned, center), turned / ARM[3:]])
    return np.asarray(whole / max(float(np.linalg.norm(whole)), 1e-300))


def _six(axes: Array) -> Array:
    """Matrix (6,6) that takes forces and motions from ``axes`` (3,3) to global ones."""
    return np.asarray(np.kron(np.eye(2), axes))


def _at(
    base: Forces, node: int, database: HydroDatabase, frequency: float, turned: Array
) -> Forces:
    """Tangents with the coefficients of a frequency rad/s in place of the infinite one's."""
    added, damping = (found[0] for found in database.coefficients_at([frequency]))
    assert base.mass is not None
    assert base.damping is not None
    mass, loss = base.mass.copy(), base.damping.copy()
    mass[node] += turned @ (added - database.added_mass_infinite) @ turned.T
    loss[node] += turned @ damping @ turned.T
    return Forces(base.dead, base.follower, base.stiffness, loss, mass, base.stiff)
