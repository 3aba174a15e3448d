"""What the tolerance of a coupled step costs and leaves: `python -m docs.coupling_error`.

The built-in case ``controlled`` for eight seconds, against a run in which every step is brought
into balance to rounding. Errors are root mean squares over the standard deviation of the run.
"""

from __future__ import annotations

from dataclasses import replace
from time import process_time

import numpy as np

from galerna.case import load
from galerna.contract import Array
from galerna.coupling.flexible import FlexibleMachine
from galerna.machine import Machine, build_machine
from galerna.structure import Tolerance

STEPS, LEFT_OUT = 400, 50
TIGHT = Tolerance(relative=1e-9)
QUANTITIES = ("rotor speed", "tip position", "tip acceleration", "root flap moment", "tower top")


def run(tolerance: Tolerance | None, loose: bool = False) -> tuple[float, float, Array]:
    """Milliseconds and corrections of a step, and the quantities (STEPS,5)."""
    machine = build_machine(load("controlled").lasting(STEPS * 0.02))
    simulation, moving = machine.simulation, flexible(machine)
    moving._loose = loose
    if tolerance is not None:
        moving.integrator.tolerance = tolerance
    bearing = moving.system.pair("pitch bearing 1")
    tip, top = moving.parts.parts["blade1"][-1], moving.parts.parts["tower"][-1]
    rows, corrections, began = [], 0, process_time()
    for _ in range(STEPS):
        simulation.advance()
        corrections += moving._corrections
        at = moving.accepted
        rows.append(
            [
                moving.rotor_speed,
                at.position[tip, 0],
                at.acceleration[tip, 0],
                at.multiplier[bearing, 4],
                at.position[top, 0],
            ]
        )
    return 1e3 * (process_time() - began) / STEPS, corrections / STEPS, np.array(rows)


def flexible(machine: Machine) -> FlexibleMachine:
    """The structure of a machine that bends."""
    structure = machine.simulation.structure
    assert isinstance(structure, FlexibleMachine)
    return structure


def main() -> None:
    _, _, exact = run(TIGHT)
    scale = exact[LEFT_OUT:].std(axis=0)
    print("| coupling | corrections | ms a step | " + " | ".join(QUANTITIES) + " |")
    print("|---" * (3 + len(QUANTITIES)) + "|")
    own = flexible(build_machine(load("controlled").lasting(0.02))).integrator.tolerance
    for name, tolerance, loose in (
        ("strong, 1e-6", replace(own, relative=1e-6), False),
        ("strong, 1e-5", replace(own, relative=1e-5), False),
        ("strong, 1e-4 (as it is)", own, False),
        ("strong, 1e-3", replace(own, relative=1e-3), False),
        ("loose", own, True),
    ):
        cost, corrections, found = run(tolerance, loose)
        error = np.sqrt(((found - exact)[LEFT_OUT:] ** 2).mean(axis=0)) / scale
        cells = " | ".join(f"{e:.1e}" for e in error)
        print(f"| {name} | {corrections:.2f} | {cost:.2f} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
