"""Modes of a turbine whose rotor turns while its tower stands: multiblade coordinates.

In body axes the rotor's equations have constant coefficients and so have the tower's, but
not the joint between them. Blade motions written as a collective part and parts that go
with the cosine and sine of each blade's azimuth, and hub motions in axes that do not turn,
make the whole constant. Source: Hansen, Wind Energy 6 (2003) 179; Bir, AIAA 2008-1300.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import block_diag, coo_matrix, csc_matrix, eye

from galerna.contract import Array
from galerna.errors import InputError
from galerna.turbine.model import Turbine

from .constraints import Triplets
from .modes import Linear, Modes, linearise, modes_of
from .pairs import Integers
from .statics import static_equilibrium
from .system import State, with_spin
from .turbine import TurbineOptions, TurbineSystem, turbine_system


@dataclass(frozen=True, eq=False)
class WhirlModes:
    """Modes at a rotor speed rad/s, about the steady shape ``state`` without weight or loads.

    In ``modes.shape`` the frames of the blades hold the collective, cosine and sine part
    in the order of the blades, all others motions in axes that do not turn.
    """

    model: TurbineSystem
    state: State
    modes: Modes


def whirl_modes(
    turbine: Turbine, speed: float, count: int = 10, options: TurbineOptions | None = None
) -> WhirlModes:
    """Modes of the machine with its rotor turning freely at ``speed`` rad/s.

    For three or more equal blades, else InputError; whirl appears in the frequencies as seen
    from the ground.
    """
    if turbine.number_of_blades < 3:
        raise InputError(
            turbine.name, f"{turbine.number_of_blades} blades, whirl modes need three or more",
            "with fewer, coefficients vary in time in any coordinates",
        )  # fmt: skip
    options = replace(options or TurbineOptions(), gravity=(0.0, 0.0, 0.0), azimuth=0.0)
    held = turbine_system(turbine, replace(options, rotor="locked"))
    model = turbine_system(turbine, replace(options, rotor="free"))
    spin = (held.hub_center, speed * held.shaft_axis, rotor_nodes(held))
    state = with_spin(static_equilibrium(held.system, spin=spin), *spin)
    linear = in_multiblade_coordinates(linearise(model.system, state), model, speed)
    return WhirlModes(model, state, modes_of(model.system, linear, count))


def rotor_nodes(model: TurbineSystem) -> Integers:
    """All frames that turn with the rotor."""
    names = model.system.names
    turning = [i for i, name in enumerate(names) if name in ("hub", "generator")]
    blades = [nodes for part, nodes in model.parts.items() if part.startswith("blade")]
    return np.concatenate([turning, *blades])


def in_multiblade_coordinates(linear: Linear, model: TurbineSystem, speed: float) -> Linear:
    """Linear equations of a rotor with blade 1 up, in coordinates that make them constant."""
    T, T1, T2 = (_transform(model, linear, order) for order in range(3))
    M, C, K = linear.mass, linear.damping, linear.stiffness
    return Linear(
        mass=(T.T @ M @ T).tocsc(),
        damping=(T.T @ (C @ T + 2.0 * speed * M @ T1)).tocsc(),
        stiffness=(T.T @ (K @ T + speed * C @ T1 + speed**2 * M @ T2)).tocsc(),
        motions=linear.motions,
    )


def _transform(model: TurbineSystem, linear: Linear, order: int) -> csc_matrix:
    """The multiblade transformation at azimuth 0, or its derivative of an order over azimuth."""
    n = len(model.system)
    blades = [nodes for part, nodes in model.parts.items() if part.startswith("blade")]
    triplets = Triplets()

    def add(row: int, column: int, block: Array) -> None:
        triplets.add(6 * (row - 1) + np.arange(6), 6 * (column - 1) + np.arange(6), block)

    turning = set(rotor_nodes(model).tolist())
    hub_like = turning - {int(node) for nodes in blades for node in nodes}
    for node in range(1, n):
        if node in hub_like:
            add(node, node, np.asarray(np.kron(np.eye(2), _turned_back(order))))
        elif node not in turning and order == 0:
            add(node, node, np.eye(6))
    patterns = _patterns(len(blades), order)
    for k, nodes in enumerate(blades):
        for part, others in enumerate(blades):
            for node, other in zip(nodes, others, strict=True):
                add(int(node), int(other), np.diag(np.full(6, patterns[k, part])))
    motions = triplets.matrix((linear.motions, linear.motions))
    held = linear.stiffness.shape[0] - linear.motions
    rest = eye(held) if order == 0 else coo_matrix((held, held))
    return block_diag([motions, rest]).tocsc()


def _turned_back(order: int) -> Array:
    """Derivative over azimuth, at 0, of the rotation from resting into turning hub axes."""
    back = np.array([[0.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
    return np.eye(3) if order == 0 else np.linalg.matrix_power(back, order)


def _patterns(blades: int, order: int) -> Array:
    """Collective, cosine, sine (and for more blades, higher and reactionless) parts (b,b)."""
    azimuth = 2.0 * np.pi * np.arange(blades) / blades
    out = np.zeros((blades, blades))
    out[:, 0] = order == 0
    for part in range(1, blades):
        harmonic = (part + 1) // 2
        if part == blades - 1 and blades % 2 == 0:
            out[:, part] = (-1.0) ** np.arange(blades) * (order == 0)
            continue
        phase = harmonic * azimuth + 0.5 * np.pi * (order - (part % 2 == 0))
        out[:, part] = harmonic**order * np.cos(phase)
    return out
