"""A machine afloat, linear: natural frequencies, and the answer to waves of a frequency."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu

from galerna.contract import Array, Loads
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.floating import ARM, DIRECTIONS
from galerna.hydro.database import Complex, HydroDatabase
from galerna.structure.modes import linearise, natural_modes
from galerna.structure.system import Forces, State

PASSES = 4  #: of a frequency and the coefficients at it
MODES = 9  #: that are computed about a frequency: platform, tower, the turning rotor
MOVED = 1e-4  #: of a mode's largest motion: less of the platform's is another part's mode


@dataclass(frozen=True)
class FloatingMode:
    """A mode with the platform's largest motion in ``name``; Hz, and of critical damping."""

    name: str
    frequency: float
    damping_ratio: float


def floating_modes(
    machine: FlexibleMachine, state: State, loads: Sequence[Loads], database: HydroDatabase
) -> list[FloatingMode]:
    """The six modes of the platform about an equilibrium at rest, by rising frequency.

    ``loads`` are those of the load models there, whose mass block of the water is the database's
    added mass at infinite frequency. Coefficients at rest: no viscous drag.
    """
    base = machine.forces(loads)
    node = int(machine.parts.parts["platform"][0])
    found = []
    for direction, frequency in _first_guesses(machine, state, base, node):
        for _ in range(PASSES):
            forces = _at(base, node, database, 2.0 * np.pi * frequency)
            name, frequency, ratio = _nearest(machine, state, forces, node, direction, frequency)
        found.append(FloatingMode(name, frequency, ratio))
    return sorted(found, key=lambda mode: mode.frequency)


def response(
    machine: FlexibleMachine,
    state: State,
    loads: Sequence[Loads],
    database: HydroDatabase,
    frequency: float,
    excitation: Complex,
) -> Complex:
    """Linear answer (n,6) of all frames, in their own axes, to Re[excitation exp(i w t)].

    ``excitation`` (6,) N, N m acts on the platform at ``frequency`` rad/s; see ``floating_modes``.
    """
    node = int(machine.parts.parts["platform"][0])
    forces = _at(machine.forces(loads), node, database, frequency)
    linear = linearise(machine.system, state, forces)
    s = 1j * frequency
    matrix = s**2 * linear.mass + s * linear.damping + linear.stiffness
    right = np.zeros(matrix.shape[0], dtype=complex)
    turned = excitation.reshape(2, 3) @ state.rotation[node]
    right[6 * (node - 1) : 6 * node] = turned.ravel()
    found = splu(matrix.tocsc()).solve(right)[: linear.motions].reshape(-1, 6)
    return np.concatenate([np.zeros((1, 6)), found])


def _first_guesses(
    machine: FlexibleMachine, state: State, forces: Forces, node: int
) -> Iterator[tuple[int, float]]:
    modes = natural_modes(machine.system, state, 3 * MODES, forces)
    taken: set[int] = set()
    for k in range(len(modes)):
        direction, share = _direction(modes.shape[k], node)
        if share > MOVED and direction not in taken and modes.frequency[k] > 0.0:
            taken.add(direction)
            yield direction, float(modes.frequency[k])


def _nearest(
    machine: FlexibleMachine, state: State, forces: Forces, node: int, direction: int, near: float
) -> tuple[str, float, float]:
    """The mode of a direction whose frequency is nearest."""
    modes = natural_modes(machine.system, state, MODES, forces, about_hz=near)
    same = [k for k in range(len(modes)) if _direction(modes.shape[k], node)[0] == direction]
    best = min(same, key=lambda k: abs(modes.frequency[k] - near))
    return DIRECTIONS[direction], float(modes.frequency[best]), float(modes.damping_ratio[best])


def _direction(shape: Array, node: int) -> tuple[int, float]:
    """The platform's largest motion in a mode, and how large it is beside all others."""
    own = np.abs(shape[node]) / ARM
    everywhere = float((np.abs(shape) / ARM).max())
    return int(own.argmax()), float(own.max()) / everywhere


def _at(base: Forces, node: int, database: HydroDatabase, frequency: float) -> Forces:
    """Tangents with the coefficients of a frequency rad/s in place of the infinite one's."""
    added, damping = (found[0] for found in database.coefficients_at([frequency]))
    assert base.mass is not None
    assert base.damping is not None
    mass, loss = base.mass.copy(), base.damping.copy()
    mass[node] += added - database.added_mass_infinite
    loss[node] += damping
    return Forces(base.dead, base.follower, base.stiffness, loss, mass, base.stiff)
