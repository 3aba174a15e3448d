"""Steady free wakes: they lie where their own velocity carries them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from galerna.aero.vortex.ages import growing_ages, revolution_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.free_wake import FreeWake
from galerna.aero.vortex.helix import turns
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.steady import SteadySolution, solve_steady
from galerna.aero.vortex.symmetry import RotationalSymmetry
from galerna.aero.vortex.wings import trapezoidal_wing
from galerna.errors import ConvergenceError

WIND = np.array([10.0, 0.0, 0.0])
AXIS = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), 10.0)
AGES = revolution_ages(AXIS.speed, 3.0, 20.0)
CORE = VortexCore(0.15)
FREE = FreeWake(length=0.5, tolerance=1e-6)


def blades() -> list[np.ndarray]:
    root = trapezoidal_wing(4.0, 0.4, 1, 5, angle_of_attack=0.08, taper=0.6)
    chord, span, normal = (root + np.array([0.0, 3.0, 0.0])).transpose(2, 0, 1)
    blade = np.stack([normal, chord, span], axis=2)
    return RotationalSymmetry(2, AXIS.direction, AXIS.origin).images(blade)


def rotor(free: FreeWake | None, **options) -> SteadySolution:
    return solve_steady(blades(), WIND, axis=AXIS, ages=AGES, core=CORE, free=free, **options)


@pytest.fixture(scope="module")
def found() -> SteadySolution:
    return rotor(FREE)


def departure(step_deg: float) -> float:
    """Of rows from where the velocity on them takes them by the trapezium rule, m (eq. 8)."""
    ages = revolution_ages(AXIS.speed, 1.5, step_deg)
    flow = solve_steady(blades(), WIND, axis=AXIS, ages=ages, core=CORE, free=FREE)
    last = int(np.searchsorted(ages, 0.5 * 10.0 / 10.0))
    ages, rows = ages[: last + 1], flow.wake.vertices[0][: last + 1]
    turn = turns(ages, AXIS)
    seen = np.einsum("kab,knb->kna", turn, flow.velocity(rows))
    path = np.einsum("kab,knb->kna", turn, rows)
    carried = cumulative_trapezoid(seen, ages, axis=0, initial=0.0)
    return float(np.sqrt(np.mean((path - path[0] - carried) ** 2)))


def test_rows_lie_where_the_velocity_on_them_takes_them_to_second_order() -> None:
    coarse, fine = departure(30.0), departure(15.0)
    assert fine < 0.01
    assert 3.0 < coarse / fine < 6.0


def test_sweeps_draw_nearer_each_time(found) -> None:
    history = np.array(found.history)
    assert len(history) < 25
    assert np.all(history[2:] < 0.7 * history[1:-1])


def test_a_rotor_hinders_its_wake_and_widens_it(found) -> None:
    prescribed = rotor(None)
    tip = -1 if np.linalg.norm(blades()[0][0, -1]) > np.linalg.norm(blades()[0][0, 0]) else 0
    last = int(np.searchsorted(AGES, 0.5))
    free_tip, helix_tip = (f.wake.vertices[0][last, tip] for f in (found, prescribed))
    assert 0.3 < free_tip[0] / helix_tip[0] < 0.95
    assert np.linalg.norm(free_tip[1:]) > 1.02 * np.linalg.norm(helix_tip[1:])
    assert found.force[0] < 0.99 * prescribed.force[0]


def test_one_blade_stands_for_both(found) -> None:
    both = rotor(FREE, symmetry=False)
    assert both.force == pytest.approx(found.force, rel=1e-5, abs=1e-5)
    for a, b in zip(both.wake.vertices, found.wake.vertices, strict=True):
        assert a == pytest.approx(b, abs=1e-4)


def test_a_wing_rolls_its_wake_up_and_sends_it_down() -> None:
    wing = trapezoidal_wing(6.0, 1.0, 2, 12, angle_of_attack=0.15, spanwise_spacing="cosine")
    ages = growing_ages(0.1, 2.0)
    flow = solve_steady([wing], WIND, ages=ages, free=FreeWake(length=2.0), core=VortexCore(0.3))
    row = flow.wake.vertices[0][12]
    carried = flow.wake.vertices[0][0] + ages[12] * WIND
    assert row[6, 2] < carried[6, 2] - 0.1, "the middle goes down"
    assert row[-1, 1] < carried[-1, 1] - 0.02, "the tips go in"
    assert row[-1, 2] > row[6, 2], "and up, beside the middle"
    mirrored = row[::-1] * np.array([1.0, -1.0, 1.0])
    assert row == pytest.approx(mirrored, abs=1e-9)


def test_too_few_sweeps_end_with_advice() -> None:
    with pytest.raises(ConvergenceError, match=r"not found in 2 sweeps(.|\n)*thicker"):
        rotor(FreeWake(sweeps=2, tolerance=1e-8))


def test_a_wake_that_the_wind_cannot_carry_is_reported() -> None:
    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), 40.0)
    ages = revolution_ages(axis.speed, 6.0, 20.0)
    with pytest.raises(ConvergenceError, match="surface 1"):
        solve_steady(blades(), WIND, axis=axis, ages=ages, core=CORE, free=FreeWake())
