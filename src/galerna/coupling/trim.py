"""A start without a transient: the machine turning steadily under the loads of the mean wind."""

from __future__ import annotations

import numpy as np

from galerna.coupling.flexible import FlexibleMachine
from galerna.structure.initial import with_initial_accelerations
from galerna.structure.system import with_spin


def start_turning(machine: FlexibleMachine, speed: float) -> None:
    """Start undeformed with the rotor turning at a speed rad/s."""
    parts, system = machine.parts, machine.system
    turning = [nodes for name, nodes in parts.parts.items() if name.startswith(("blade", "hub"))]
    if "generator" in system.names:
        turning.append(np.array([system.names.index("generator")]))
    state = with_spin(
        system.initial_state(), parts.hub_center, speed * parts.shaft_axis, np.concatenate(turning)
    )
    machine.start(with_initial_accelerations(system, state))
