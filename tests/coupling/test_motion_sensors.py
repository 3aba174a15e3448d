"""What sensors show of the motion of base and nacelle: derivatives of where they are."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.coupling.flexible import FlexibleMachine
from galerna.structure import TurbineOptions, with_initial_accelerations
from galerna.structure.frames import rotation_about
from galerna.structure.initial import under_way, with_fitting_velocities
from galerna.structure.placing import placed

NREL = turbines.load("nrel5mw")
STEP, STEPS = 2e-3, 200
INNER = slice(1, -1)  #: where differences are central


def swinging(time: float) -> tuple[np.ndarray, np.ndarray]:
    """A base that surges, heaves and pitches, each at its own frequency."""
    place = np.array([2.0 * np.sin(0.9 * time), 0.0, 0.3 * np.cos(0.7 * time)])
    return place, rotation_about(1, 0.1 * np.sin(1.3 * time + 0.4))


@pytest.fixture(scope="module")
def seen() -> dict[str, np.ndarray]:
    """Motions of a rigid machine on a swinging base, step by step."""
    machine = FlexibleMachine(
        NREL, [], TurbineOptions(blade_elements=0, tower_elements=0, base_motion=swinging)
    )
    state = with_fitting_velocities(machine.system, placed(machine.system, 0.0))
    state = with_initial_accelerations(machine.system, state)
    machine.start(under_way(machine.system, state, machine.integrator.scheme, STEP))
    rows: dict[str, list[np.ndarray]] = {"motion": [], "velocity": [], "acceleration": []}
    rows["nacelle"] = []
    for i in range(STEPS):
        machine.predict(i * STEP, STEP)
        while not machine.balance([]):
            pass
        machine.accept()
        rows["motion"].append(machine.platform_motion())
        rows["velocity"].append(machine.platform_velocity())
        rows["acceleration"].append(machine.platform_acceleration())
        rows["nacelle"].append(machine.nacelle_angular_acceleration())
    return {name: np.array(values) for name, values in rows.items()}


@pytest.mark.parametrize(("of", "rate"), [("motion", "velocity"), ("velocity", "acceleration")])
def test_rates_of_the_base_are_derivatives(seen, of, rate) -> None:
    derivative = np.gradient(seen[of], STEP, axis=0)[INNER]
    scale = np.abs(derivative).max()
    assert scale > 0.1
    assert seen[rate][INNER] == pytest.approx(derivative, abs=1e-3 * scale)


def test_a_rigid_nacelle_turns_with_the_base(seen) -> None:
    nodding = seen["acceleration"][INNER, 4]
    assert seen["nacelle"][INNER, 1] == pytest.approx(nodding, rel=1e-3)
