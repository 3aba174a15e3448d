"""The structure under its load models: same places as the rigid machine, loads in balance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.contract import Loads, Stations
from galerna.coupling.flexible import FlexibleMachine, tolerance_for
from galerna.errors import ConvergenceError, InputError
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal
from galerna.simulation import Simulation
from galerna.structure import Tolerance, TurbineOptions, with_initial_accelerations
from galerna.structure.system import with_spin
from galerna.units import DEG

NREL = turbines.load("nrel5mw")
SPAN = np.linspace(0.0, 1.0, 15)
GROUP = (
    Stations("blade1", SPAN), Stations("blade3", SPAN), Stations("hub"), Stations("nacelle"),
    Stations("tower", SPAN),
)  # fmt: skip


@pytest.mark.parametrize("elements", [0, 12])
def test_stations_are_where_the_rigid_machine_has_them(elements: int) -> None:
    pitch, azimuth = 5.0 * DEG, 40.0 * DEG
    options = TurbineOptions(
        blade_elements=elements, tower_elements=elements, pitch=pitch, azimuth=azimuth
    )
    machine = FlexibleMachine(NREL, [GROUP], options)
    operation = PrescribedOperation(
        Signal.constant(0.0), (Signal.constant(pitch),) * 3, azimuth=azimuth
    )
    rigid = PrescribedMotion(NREL, operation, [GROUP]).motions[0]
    assert machine.motions[0].position == pytest.approx(rigid.position, abs=1e-9)
    assert machine.motions[0].rotation == pytest.approx(rigid.rotation, abs=1e-9)


class Push:
    """A steady force downwind on the blades: a load model without memory."""

    stations = (Stations("blade1", SPAN), Stations("blade2", SPAN), Stations("blade3", SPAN))
    channels = ()
    coordinates: dict[str, np.ndarray] = {}  # noqa: RUF012
    largest_step = np.inf

    def __init__(self) -> None:
        self.work, self._before = 0.0, None

    def begin_step(self, time, dt, motion) -> None:
        self._dt, self._start = dt, motion.position.copy()

    def loads(self, time, motion) -> Loads:
        loads = Loads.zero(len(motion.position))
        loads.force[:, 0] = 20000.0
        return loads

    def end_step(self, time, motion) -> None:
        self.work += 20000.0 * (motion.position - self._start)[:, 0].sum()

    def record(self):
        return {}

    def state(self):
        return {}

    def restore(self, state) -> None:
        pass


def turning(machine: FlexibleMachine, push: Push, speed: float) -> None:
    """Start with the rotor turning, its accelerations those of the loads."""
    parts = machine.parts
    names = [name for name in parts.parts if name.startswith(("blade", "hub"))]
    nodes = [parts.parts[name] for name in names] + [[machine.system.names.index("generator")]]
    state = machine.system.initial_state()
    state = with_spin(state, parts.hub_center, speed * parts.shaft_axis, np.concatenate(nodes))
    machine.start(state)
    forces = machine.forces([push.loads(0.0, machine.motions[0])])
    machine.start(with_initial_accelerations(machine.system, state, forces))


def test_the_work_of_loads_and_torque_is_the_change_of_energy() -> None:
    push = Push()
    machine = FlexibleMachine(NREL, [push.stations])
    torque, dt, angle = -3e6, 0.0025, 0.0
    machine.set_shaft_torque(torque)
    turning(machine, push, 1.2)
    simulation = Simulation(machine, {"push": push}, dt)
    before = sum(machine.system.energies(machine.accepted))
    damped = 0.0
    generator = machine.system.names.index("generator")
    for _ in range(200):
        speed = machine.accepted.velocity[generator, 3]
        rate = machine.system.dissipation(machine.accepted)
        simulation.advance()
        angle += 0.5 * dt * (speed + machine.accepted.velocity[generator, 3])
        damped += 0.5 * dt * (rate + machine.system.dissipation(machine.accepted))
    change = sum(machine.system.energies(machine.accepted)) - before
    balance = push.work + torque * angle - damped
    scale = abs(push.work) + abs(torque * angle)
    assert change == pytest.approx(balance, abs=2e-3 * scale)
    assert abs(push.work) > 0.1 * scale


def test_a_run_continues_from_its_state_with_the_same_bits() -> None:
    results = []
    for halfway in (False, True):
        push = Push()
        machine = FlexibleMachine(NREL, [push.stations], TurbineOptions(blade_elements=6))
        turning(machine, push, 1.0)
        simulation = Simulation(machine, {"push": push}, 0.02)
        for i in range(10):
            simulation.advance()
            if halfway and i == 4:
                saved = simulation.state()
                machine = FlexibleMachine(NREL, [push.stations], TurbineOptions(blade_elements=6))
                simulation = Simulation(machine, {"push": Push()}, 0.02)
                simulation.restore(saved)
        results.append(machine.accepted.position)
    assert np.array_equal(*results)


def test_a_part_that_does_not_exist_is_named() -> None:
    with pytest.raises(InputError, match="blade4"):
        FlexibleMachine(NREL, [(Stations("blade4", SPAN),)])


class Damper(Push):
    """A force against the velocity downwind: it takes energy."""

    asked = 0

    def loads(self, time, motion) -> Loads:
        self.asked += 1
        loads = Loads.zero(len(motion.position))
        loads.force[:, 0] = -50.0 * motion.velocity[:, 0]
        return loads


def energy_after(loose: bool, dt: float, tolerance: Tolerance | None = None) -> tuple[float, int]:
    """Energy J after half a second of swinging against a damper, and how often it was asked."""
    damper = Damper()
    options = TurbineOptions(blade_elements=6, tower_elements=4)
    machine = FlexibleMachine(NREL, [damper.stations], options, tolerance=tolerance, loose=loose)
    turning(machine, damper, 1.2)
    simulation, damper.asked = Simulation(machine, {"damper": damper}, dt), 0
    for _ in range(round(0.5 / dt)):
        simulation.advance()
    return sum(machine.system.energies(machine.accepted)), damper.asked


def test_loose_coupling_errs_in_energy_where_strong_coupling_does_not() -> None:
    exact, _ = energy_after(False, 0.01, Tolerance(relative=1e-9))
    strong, often = energy_after(False, 0.01)
    loose, once = energy_after(True, 0.01)
    assert once == 50
    assert often > 1.5 * once
    assert abs(loose - exact) > 10.0 * abs(strong - exact)


class Explosive(Push):
    """A force that grows with the velocity it makes, faster than any step can follow."""

    def loads(self, time, motion) -> Loads:
        loads = Loads.zero(len(motion.position))
        loads.force[:] = 2e5 * motion.velocity
        return loads


def test_a_step_that_finds_no_balance_names_time_part_and_frame() -> None:
    load = Explosive()
    machine = FlexibleMachine(NREL, [load.stations], TurbineOptions(blade_elements=6))
    turning(machine, load, 1.0)
    with pytest.raises(ConvergenceError, match=r"structure, .*blade\d.* of its span at t = ") as it:
        Simulation(machine, {"load": load}, 0.02, halvings=1).advance()
    assert it.value.time > 0.0


class Drag(Push):
    """Damping that the structure's tangent knows nothing of, N s/m at each station."""

    def __init__(self, damping: float) -> None:
        super().__init__()
        self.damping, self.calls = damping, 0

    def loads(self, time, motion) -> Loads:
        self.calls += 1
        loads = super().loads(time, motion)
        loads.force -= self.damping * motion.velocity
        return loads


@pytest.mark.parametrize("damping", [1000.0, 4000.0])
def test_damping_that_outweighs_the_blades_inertia_in_a_step_converges(damping: float) -> None:
    drag = Drag(damping)
    machine = FlexibleMachine(NREL, [drag.stations], TurbineOptions(blade_elements=6))
    simulation = Simulation(machine, {"drag": drag}, 0.02)
    for _ in range(25):
        simulation.advance()
    assert drag.calls < 8 * 25


def test_a_small_machine_is_brought_as_close_to_balance_as_a_large_one() -> None:
    """What is left over goes with the weight; a balance to 10 N would be none at all."""
    system = FlexibleMachine(NREL, []).system
    small = replace(system, weight=1e-3 * system.weight)
    assert tolerance_for(system).force == pytest.approx(10.0, rel=0.1)
    assert tolerance_for(small).force == pytest.approx(1e-3 * tolerance_for(system).force)
    assert tolerance_for(small).moment == pytest.approx(1e-3 * tolerance_for(system).moment)
