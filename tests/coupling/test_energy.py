"""The account of energy: the scheme's loss is an identity, and the rest adds up."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from galerna.case import load
from galerna.coupling.energy import EnergyLedger, dissipated, increments
from galerna.coupling.flexible import FlexibleMachine
from galerna.machine import build_machine
from galerna.structure import Scheme, TurbineOptions, with_initial_accelerations
from galerna.structure.forces import Forces
from galerna.turbine import load as load_turbine

NREL = load_turbine("nrel5mw")


def falling(rho_inf: float, dt: float, duration: float) -> tuple[FlexibleMachine, list]:
    """A machine that begins to bend under its weight, no wind; all its states."""
    options = TurbineOptions(blade_elements=6, tower_elements=4, rotor="locked")
    machine = FlexibleMachine(NREL, [], options, scheme=Scheme.generalized_alpha(rho_inf))
    states = [with_initial_accelerations(machine.system, machine.system.initial_state())]
    machine.start(states[0])
    for step in range(round(duration / dt)):
        machine.predict(step * dt, dt)
        while not machine.balance([]):
            pass
        machine.accept()
        states.append(machine.accepted)
    return machine, states


@pytest.mark.parametrize("rho_inf", [0.9, 0.3])
def test_what_the_scheme_takes_is_exact_step_by_step(rho_inf: float) -> None:
    """Kinetic energy changes by the work of the forces of inertia less what the scheme takes."""
    dt = 0.02
    machine, states = falling(rho_inf, dt, 0.4)
    inertia, scheme = machine.system.inertia, machine.integrator.scheme
    for first, second in pairwise(states):
        forces = [inertia(s.acceleration) for s in (first, second)]
        increment = increments(scheme, first, second, dt)
        work = 0.5 * float(np.sum(increment * (forces[0] + forces[1])))
        energies = [0.5 * np.sum(s.velocity * inertia(s.velocity)) for s in (first, second)]
        taken = dissipated(scheme, inertia, first, second, dt)
        scale = max(abs(work), *energies)
        assert energies[1] - energies[0] == pytest.approx(work - taken, abs=1e-6 * scale)


def account(rho_inf: float, dt: float) -> dict[str, float]:
    machine, states = falling(rho_inf, dt, 2.0)
    ledger = EnergyLedger(machine.system, machine.integrator.scheme)
    for state in states:
        ledger.add(state, Forces.none(len(machine.system)), np.zeros(3))
    return ledger.values()


def test_a_machine_without_wind_loses_to_damping_and_to_the_scheme() -> None:
    coarse, fine = account(0.5, 0.02), account(0.5, 0.01)
    assert coarse["energy_damping"] > 0.0
    assert coarse["energy_numerical"] > fine["energy_numerical"] > 0.0
    exchanged = -coarse["energy_potential"]
    assert abs(coarse["energy_defect"]) < 1e-3 * exchanged
    assert abs(fine["energy_defect"]) < 0.5 * abs(coarse["energy_defect"]), "falls with the step"


def test_a_scheme_that_damps_less_takes_less() -> None:
    assert account(0.9, 0.02)["energy_numerical"] < 0.3 * account(0.3, 0.02)["energy_numerical"]


CASE = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 2.0,
    "time_step_s": 0.02,
    "inflow": {"wind_speed_m_s": 12.0, "shear": {"kind": "power_law"}},
    "structure": {"blade_elements": 8, "tower_elements": 4},
    "control": "baseline",
    "outputs": {"energy": True, "channels": ["energy_*", "electrical_power"]},
}


def test_the_wind_s_work_is_accounted_for_and_resumes_to_the_same_bits() -> None:
    simulation = build_machine(load(CASE)).simulation
    for _ in range(30):
        simulation.advance()
    saved = simulation.state()
    for _ in range(10):
        simulation.advance()
    values = simulation.record()
    assert values["energy_wind"] > 1e6
    assert abs(values["energy_defect"]) < 1e-3 * values["energy_wind"]
    assert values["energy_electrical"] == pytest.approx(
        39 * 0.02 * values["electrical_power"], rel=0.1
    )
    simulation.restore(saved)
    for _ in range(10):
        simulation.advance()
    again = simulation.record()
    assert {k: v for k, v in again.items() if k.startswith("energy")} == {
        k: v for k, v in values.items() if k.startswith("energy")
    }
