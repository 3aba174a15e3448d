"""The structure's speed: a converged step of a whole turbine and of the double pendulum."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median

import numpy as np

from galerna import turbine as turbines
from galerna.contract import Array
from galerna.structure.assembly import GROUND, Structure
from galerna.structure.beam import discretise, straight, uniform
from galerna.structure.initial import with_initial_accelerations
from galerna.structure.integrators import Integrator
from galerna.structure.joints import hinge
from galerna.structure.scheme import Scheme
from galerna.structure.system import Forces, State, System, spin_twists
from galerna.structure.turbine import TurbineOptions, turbine_system
from galerna.units import RPM

from .framework import Benchmark, Figure


def turning_turbine(blade_elements: int) -> tuple[System, State, Forces]:
    """The NREL 5 MW at 12.1 rpm with thrust on its blades, from its undeformed shape."""
    speed = 12.1 * RPM
    options = TurbineOptions(blade_elements=blade_elements, rotor=lambda time: speed)
    model = turbine_system(turbines.load("nrel5mw"), options)
    system = model.system
    state = system.initial_state()
    twists = spin_twists(state, model.hub_center, speed * model.shaft_axis)
    turning = ["hub", *(f"blade{k}" for k in (1, 2, 3))]
    nodes = np.concatenate([[system.names.index("generator")], *(model.parts[p] for p in turning)])
    state.velocity[nodes] = twists[nodes]
    forces = Forces.none(len(system))
    for k in (1, 2, 3):
        blade = model.parts[f"blade{k}"]
        forces.dead[blade, 0] = 700e3 / 3 / len(blade)
    return system, with_initial_accelerations(system, state), forces


def double_pendulum(elements: int) -> tuple[System, State, Forces]:
    """The flexible double pendulum of the dissertation's Table 3.1."""
    sections = uniform(np.array([1e5, 1e5, 1e3, 1, 1, 1e5]), np.array([1, 1, 1, 1e-5, 1e-5, 1e-5]))
    along = np.stack([[0.0, 0, -1], [0, 1.0, 0], [1.0, 0, 0]], axis=1)
    down = np.diag([-1.0, 1.0, -1.0])
    s, span, elbow = Structure(), np.linspace(0, 1, elements + 1), np.array([1.0, 0.0, 0.0])
    one = s.beam("one", discretise(straight(np.zeros(3), along, 1.0), 1.0, sections, span))
    two = s.beam("two", discretise(straight(elbow, down, 1.0), 1.0, sections, span))
    s.join(hinge("shoulder", GROUND, one[0], np.zeros(3), np.array([0.0, 1.0, 0.0])))
    s.join(hinge("elbow", one[-1], two[0], elbow, np.array([0.0, 1.0, 0.0])))
    system = s.build()
    start = with_initial_accelerations(system, system.initial_state())
    return system, start, Forces.none(len(system))


def step_cost(
    system: System, state: State, forces: Forces, dt: float, steps: int
) -> tuple[float, float, float, float]:
    """Median wall ms of a step, of its assembly and of its linear solve; iterations a step."""
    integrator = Integrator(system, Scheme.generalized_alpha(0.8))
    parts: dict[str, list[float]] = {"balance": [], "solve": []}
    timed(system, "balance", parts["balance"])
    timed(system, "solve", parts["solve"])
    *_, state = integrator.march(state, dt, 20, lambda trial: forces)
    walls, iterations, parts["balance"][:], parts["solve"][:] = [], [], [], []
    for _ in range(steps):
        start = time.perf_counter()
        state = integrator.step(state, dt, lambda trial: forces)
        walls.append(time.perf_counter() - start)
        iterations.append(integrator.iterations)
    mean = float(np.mean(iterations))
    assembly, solve = (1e3 * mean * median(parts[name]) for name in ("balance", "solve"))
    return 1e3 * median(walls), assembly, solve, mean


def timed(system: System, name: str, times: list[float]) -> None:
    """Let a method of this one system note how long it takes."""
    method: Callable[..., object] = getattr(system, name)

    def noting(*arguments: object, **options: object) -> object:
        start = time.perf_counter()
        result = method(*arguments, **options)
        times.append(time.perf_counter() - start)
        return result

    setattr(system, name, noting)


def turbine_step() -> Sequence[Figure]:
    figures, cost = [], {}
    for elements, steps in ((20, 300), (200, 60)):
        wall, assembly, solve, iterations = step_cost(*turning_turbine(elements), 0.01, steps)
        name = f"NREL 5 MW, 3 x {elements} blade and 10 tower elements"
        figures += [
            Figure(f"{name}: converged step", wall, "ms", 2.5 if elements == 20 else None),
            Figure(f"{name}: assembly in it", assembly, "ms"),
            Figure(f"{name}: linear solve in it", solve, "ms"),
            Figure(f"{name}: iterations", iterations, "-"),
        ]
        cost[elements] = wall
    ratio = cost[200] / cost[20] / (617 / 77)
    return [*figures, Figure("cost a frame at 3 x 200 over that at 3 x 20", ratio, "-", 1.2)]


def sharpy_step(elements: int, dt: float) -> float | None:
    """CPU ms of SHARPy's structural solution for a step of the same pendulum, if it is there.

    ``GALERNA_SHARPY`` names the Python interpreter that has SHARPy (PyPI ``ic-sharpy``).
    """
    interpreter = os.environ.get("GALERNA_SHARPY")
    if not interpreter:
        return None
    script = Path(__file__).with_name("sharpy_pendulum.py")
    with tempfile.TemporaryDirectory() as folder:
        command = [interpreter, str(script), folder, str(elements), "10", str(dt)]
        run = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    if run.returncode:
        print(f"SHARPy did not run: {run.stderr.strip().splitlines()[-1:]}")
        return None
    return 1e3 * float(run.stdout.split()[-1])


def pendulum_step() -> Sequence[Figure]:
    figures = []
    for dt in (1e-3, 5e-3):
        peer = sharpy_step(20, dt) if dt == 1e-3 else None
        wall, assembly, solve, iterations = step_cost(*double_pendulum(20), dt, 200)
        name = f"flexible double pendulum, 2 x 20 elements, step {1e3 * dt:g} ms"
        figures += [
            Figure(
                f"{name}: converged step",
                wall,
                "ms",
                1.0,
                False,
                "SHARPy, 20 three-node elements" if peer else "",
                peer,
            ),
            Figure(f"{name}: assembly in it", assembly, "ms"),
            Figure(f"{name}: linear solve in it", solve, "ms"),
            Figure(f"{name}: iterations", iterations, "-"),
        ]
    return figures


def large_steps() -> Sequence[Figure]:
    """Errors of both tips over 1 s at large steps, over the length."""
    figures = []
    reference = tip_path(1e-4)
    for dt in (1e-3, 5e-3):
        gap = np.linalg.norm(tip_path(dt) - reference, axis=2).max()
        figures.append(Figure(f"flexible double pendulum, step {1e3 * dt:g} ms: largest error of "
                              "a tip in 1 s", float(gap), "L", 0.01))  # fmt: skip
    return figures


def tip_path(dt: float) -> Array:
    """Positions (k,2,3) m of both tips every 10 ms."""
    system, state, _ = double_pendulum(20)
    tips = [21, 42]
    integrator = Integrator(system, Scheme.generalized_alpha(0.8))
    states = list(integrator.march(state, dt, round(1.0 / dt)))
    return np.array([s.position[tips] for s in states[round(0.01 / dt) - 1 :: round(0.01 / dt)]])


BENCHMARKS = [
    Benchmark("structure-turbine-step", "structure", "One step of the NREL 5 MW", turbine_step),
    Benchmark("structure-pendulum-step", "structure", "One step of the double pendulum",
              pendulum_step),
    Benchmark("structure-large-steps", "structure", "Accuracy of large steps", large_steps),
]  # fmt: skip
