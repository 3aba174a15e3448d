"""Where the wind's work goes: each share on its own, and what does not add up.

All work is that of the mean of a force at both ends of a step along the increment that the
scheme takes, in body axes. With it the generalized-alpha scheme loses, in a step,

    (1/2 - alpha_f) d . (M da - dg) + h^2 (beta - gamma/2) (d(a.M.a) / 2 + (gamma - 1/2) da.M.da)

of the kinetic energy, where d is the increment, a the auxiliary acceleration, g the force of
inertia M v' and d(..) a change over the step: an identity for gamma = 1/2 + alpha_f - alpha_m,
which holds for frames too because their velocities change in body axes. That is the numerical
dissipation; for Newmark-beta it is the known one (Hughes, The Finite Element Method, 1987,
section 9.1; for generalized alpha: Erlicher, Bonaventura and Bursi, Comput. Mech. 28 (2002) 83).
What is left is the error of taking the work of forces that turn by their means, which falls with
the square of the step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from galerna.contract import Array, Channel
from galerna.structure.frames import log_se3
from galerna.structure.scheme import Scheme
from galerna.structure.system import Forces, State, System

GIVEN = ("electrical", "losses", "brake")
DRIVES = {
    "pitch bearing": "pitch_drives",
    "yaw bearing": "yaw_drive",
    "base": "base_motion",
    "main bearing": "rotor_drive",
}
STORED = ("kinetic", "elastic", "potential")
TEXTS = {
    "wind": "work of the air on the machine",
    "water": "work of the water on the machine, of buoyancy and moorings too",
    "electrical": "energy into the grid",
    "losses": "energy lost in gearbox and generator",
    "brake": "energy taken by the brake",
    "pitch_drives": "work of the pitch drives",
    "yaw_drive": "work of the yaw drive",
    "base_motion": "work of what moves the base",
    "rotor_drive": "work of what turns the rotor",
    "damping": "energy taken by structural damping",
    "numerical": "energy taken by the time integration",
    "kinetic": "change of the kinetic energy",
    "elastic": "change of the elastic energy",
    "potential": "change of the energy in gravity",
    "defect": "what the energies miss to add up",
}
CHANNELS = tuple(Channel(f"energy_{name}", "J", text) for name, text in TEXTS.items())
_NAMES = tuple(name for name in TEXTS if name not in ("defect", *STORED))
_BROUGHT = ("wind", "water", *DRIVES.values())


@dataclass(frozen=True, eq=False, slots=True)
class _End:
    """One end of a step: the state, loads in body axes, power given away, and the pairs.

    ``loads`` (2,n,6) are those of the air and of the water; ``places`` and ``wrenches`` (k,6)
    belong to the pairs that are driven.
    """

    state: State
    loads: Array
    given: Array
    strain: Array
    damping: Array
    places: list[tuple[Array, Array]]
    wrenches: Array


class EnergyLedger:
    """Energies J since the end of the first step that it sees, of one machine."""

    def __init__(self, system: System, scheme: Scheme) -> None:
        self._system, self._scheme = system, scheme
        self._drives = [
            (pair, _NAMES.index(name))
            for pair, _ in system.drives
            for start, name in DRIVES.items()
            if system.pair_names[pair].startswith(start)
        ]
        self._sums, self._opening = np.zeros(len(_NAMES)), np.zeros(3)
        self._last: _End | None = None

    def add(self, state: State, forces: Forces, given: Array) -> None:
        """A step has ended at ``state`` under the air's loads, follower, and the water's, dead.

        ``given`` (3,) W goes into the grid, gearbox and generator, and the brake.
        """
        dead = forces.dead.reshape(-1, 2, 3) @ state.rotation
        loads = np.stack([forces.follower, dead.reshape(-1, 6)])
        end, last = self._end(state, loads, given), self._last
        if last is None:
            self._opening = np.array(self._system.energies(state))
        else:
            self._sums += self._works(last, end)
        self._last = end

    def values(self) -> dict[str, float]:
        """All of CHANNELS, by name."""
        found = dict(zip(_NAMES, self._sums.tolist(), strict=True))
        stored = np.zeros(3)
        if self._last is not None:
            stored = np.array(self._system.energies(self._last.state)) - self._opening
        found.update(zip(STORED, stored.tolist(), strict=True))
        brought = sum(found[name] for name in _BROUGHT)
        spent = sum(value for name, value in found.items() if name not in _BROUGHT)
        found["defect"] = brought - spent
        return {f"energy_{name}": found[name] for name in TEXTS}

    def state(self) -> dict[str, np.ndarray]:
        """What the next step needs beside the machine's state."""
        last = self._last
        loads = np.zeros((2, 0, 6)) if last is None else last.loads.copy()
        given = np.zeros(3) if last is None else last.given
        sums = np.concatenate([self._sums, self._opening, given])
        return {"energy_sums": sums, "energy_loads": loads}

    def restore(self, saved: Mapping[str, np.ndarray], state: State) -> None:
        """Take ``saved`` back, with the machine in ``state``."""
        self._sums, self._opening, given = np.split(
            saved["energy_sums"].copy(), [len(_NAMES), len(_NAMES) + 3]
        )
        loads = saved["energy_loads"]
        self._last = self._end(state, loads, given) if loads.size else None

    def _end(self, state: State, loads: Array, given: Array) -> _End:
        pairs, system = self._system.pair_answer(state), self._system
        damping = np.einsum("mij,mj->mi", system.pairs.damping, pairs.rate)
        places = [
            (
                system.pairs.offset_position[pair, 0].copy(),
                system.pairs.offset_rotation[pair, 0].copy(),
            )
            for pair, _ in self._drives
        ]
        wrenches = pairs.wrench[np.array([pair for pair, _ in self._drives], dtype=np.int64)]
        return _End(state, loads.copy(), np.array(given), pairs.motion, damping, places, wrenches)

    def _works(self, first: _End, second: _End) -> Array:
        """The work of each of the names in one step."""
        works = np.zeros(len(_NAMES))
        dt = second.state.time - first.state.time
        increment = increments(self._scheme, first.state, second.state, dt)
        for kind, both in zip(("wind", "water"), first.loads + second.loads, strict=True):
            works[_NAMES.index(kind)] = 0.5 * np.sum(increment * both)
        start = _NAMES.index(GIVEN[0])
        works[start : start + 3] = 0.5 * dt * (first.given + second.given)
        damping = 0.5 * (first.damping + second.damping)
        works[_NAMES.index("damping")] = np.sum(damping * (second.strain - first.strain))
        works[_NAMES.index("numerical")] = dissipated(
            self._scheme, self._system.inertia, first.state, second.state, dt
        )
        for k, (_, name) in enumerate(self._drives):
            (x0, R0), (x1, R1) = first.places[k], second.places[k]
            moved = log_se3(R0.T @ R1, R0.T @ (x1 - x0))
            works[name] -= 0.5 * (first.wrenches[k] + second.wrenches[k]) @ moved
        return works


def increments(scheme: Scheme, first: State, second: State, dt: float) -> Array:
    """Increments (n,6) of the frames in a step, in body axes."""
    mean = (0.5 - scheme.beta) * first.auxiliary + scheme.beta * second.auxiliary
    return dt * first.velocity + dt**2 * mean


def dissipated(
    scheme: Scheme, inertia: Callable[[Array], Array], first: State, second: State, dt: float
) -> float:
    """Energy J that the scheme takes from the motion in a step; see the module's text.

    ``inertia`` takes twists (n,6) to momenta.
    """
    increment = increments(scheme, first, second, dt)
    a0, a1 = first.auxiliary, second.auxiliary
    change = a1 - a0
    rate = second.acceleration - first.acceleration
    filtered = (0.5 - scheme.alpha_f) * float(np.sum(increment * inertia(change - rate)))
    kinds = [float(np.sum(a * inertia(a))) for a in (a0, a1, change)]
    parabolic = 0.5 * (kinds[1] - kinds[0]) + (scheme.gamma - 0.5) * kinds[2]
    return filtered + dt**2 * (scheme.beta - 0.5 * scheme.gamma) * parabolic
