"""What makes coupled steps cheap: smooth far wakes, influences held in a step, rows in turn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna.aero.vortex.ages import growing_ages, uniform_ages
from galerna.aero.vortex.convection import due_rows, periods
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.far_wake import FarWake
from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.unsteady import UnsteadyLattice, UnsteadyOptions
from galerna.aero.vortex.wake import Wake, helical_wake
from galerna.aero.vortex.wings import trapezoidal_wing
from galerna.contract import Array

from .two_blades import AXIS, rotor

CORE = VortexCore(0.1)
WIND = np.array([6.0, 0.0, 0.0])


def laid_out(surfaces: list[Surface]) -> Wake:
    """The helix behind the blades, with uneven circulation."""
    ages = growing_ages(0.1, 20.0, near=2.0, growth=1.1, widest=0.4)
    wake = helical_wake(ages, [s.lattice.vertices[-1] for s in surfaces], AXIS, WIND)
    rng = np.random.default_rng(1)
    return replace(
        wake, circulation=tuple(rng.normal(20.0, 5.0, g.shape) for g in wake.circulation)
    )


def field(sheets, precision):  # type: ignore[no-untyped-def]
    return InducedField(sheets, precision=precision)


def errors(wake: Wake, surfaces: list[Surface], monkeypatch: pytest.MonkeyPatch) -> Array:
    """Errors (P,) of the interpolated velocity over its root mean square."""
    monkeypatch.setattr("galerna.aero.vortex.chordwise.WORTH", 0.0)
    smooth = FarWake(wake, CORE, field).velocity(surfaces)
    exact = FarWake(wake, CORE, field, smooth=False).velocity(surfaces)
    assert np.abs(smooth - exact).max() > 0.0
    return np.linalg.norm(smooth - exact, axis=1) / np.sqrt((exact**2).sum(axis=1).mean())


def test_interpolation_along_chords_keeps_the_wakes_velocity(monkeypatch) -> None:
    surfaces = rotor(0.3)
    assert errors(laid_out(surfaces), surfaces, monkeypatch).max() < 5e-4


def test_rows_that_return_to_a_blade_are_summed_at_every_point(monkeypatch) -> None:
    """A row of the far wake is blown back to half a metre above the blade."""
    surfaces = rotor(0.3)
    wake = laid_out(surfaces)
    blade = surfaces[0].lattice.corners
    wake.vertices[1][60] = 0.5 * (blade[3] + blade[4]) + np.array([0.5, 0.0, 0.0])
    assert errors(wake, surfaces, monkeypatch).max() < 5e-4


@pytest.mark.parametrize("bend", [0.0, 0.02])
def test_later_solutions_of_a_step_keep_influences_and_follow_the_motion(bend: float) -> None:
    """A wing that turns up by 0.2 degrees as a whole, or bends by 2 cm, between two solutions."""
    wind = Uniform()
    first = trapezoidal_wing(10.0, 1.0, 4, 12, angle_of_attack=np.radians(4.0))
    turn, c, s = first.copy(), np.cos(0.0035), np.sin(0.0035)
    turn[..., 0], turn[..., 2] = (
        c * first[..., 0] + s * first[..., 2],
        c * first[..., 2] - s * first[..., 0],
    )
    turn[..., 2] += bend * (first[..., 1] / 5.0) ** 2
    loads = []
    for hold in (False, True):
        options = UnsteadyOptions(free=False, hold_influences=hold, core=CORE)
        lattice = UnsteadyLattice(wind, uniform_ages(0.2, 4.0), options)
        lattice.begin_step(0.0, 0.2, [Surface.at_rest(first)])
        before = lattice.solve(0.2, [Surface.at_rest(first)]).loads[0].force[2]
        moved = Surface(Surface.at_rest(turn).lattice, 10.0 * (turn - first))
        loads.append(lattice.solve(0.2, [moved]).loads[0].force[2] - before)
    assert abs(loads[0]) > 1.0
    assert loads[1] == pytest.approx(loads[0], rel=0.01)


class Uniform:
    """A wind of 10 m/s along x."""

    def velocity(self, points: Array, time: float) -> Array:
        return np.broadcast_to([10.0, 0.0, 0.0], points.shape).copy()


def test_every_row_is_due_once_in_the_time_that_fluid_takes_to_cross_its_panel() -> None:
    ages = growing_ages(0.1, 10.0, near=1.0, growth=1.2, widest=0.4)
    often = np.zeros(len(ages), dtype=int)
    for sheds in range(12):
        often[due_rows(ages, sheds)] += 1
    width = np.concatenate([[0.1], np.diff(ages)])
    assert np.array_equal(often * periods(ages), np.full(len(ages), 12))
    assert np.all(periods(ages) <= width / 0.1 + 1e-6)
    assert periods(ages)[-1] == 4


def marched(options: UnsteadyOptions, ages: Array, steps: int) -> UnsteadyLattice:
    lattice = UnsteadyLattice(Gusts(), ages, options)
    dt = float(ages[1])
    for i in range(steps):
        lattice.begin_step(i * dt, dt, rotor(i * dt, 2, 5), AXIS)
        lattice.end_step((i + 1) * dt, rotor((i + 1) * dt, 2, 5))
    return lattice


class Gusts:
    """A wind along x with gusts of a tenth that it carries along."""

    def velocity(self, points: Array, time: float) -> Array:
        out = np.zeros_like(points)
        out[:, 0] = WIND[0] * (1.0 + 0.1 * np.sin((points[:, 0] - WIND[0] * time) / 10.0))
        return out


def test_equal_rows_in_turn_are_all_rows() -> None:
    ages = uniform_ages(0.2, 6.0)
    wakes = [
        marched(UnsteadyOptions(core=CORE, multirate=multirate), ages, 4).wake().vertices[0]
        for multirate in (False, True)
    ]
    assert np.array_equal(*wakes)


def test_rows_in_turn_leave_the_blades_their_circulation() -> None:
    """To 0.5 % after a turn and a half, where rolled up vortices are 2 % of the radius apart."""
    ages = growing_ages(0.15, 12.0, near=1.5, growth=1.2, widest=0.6)
    every, turn = (
        marched(UnsteadyOptions(core=CORE, multirate=multirate), ages, 60).sheets()[-1].circulation
        for multirate in (False, True)
    )
    assert not np.array_equal(every, turn)
    assert turn == pytest.approx(every, rel=0.005)


def test_rows_in_turn_resume_to_the_bit() -> None:
    ages = growing_ages(0.15, 6.0, near=0.6, growth=1.2, widest=0.6)
    options = UnsteadyOptions(core=CORE, multirate=True, hold_influences=True)
    whole = marched(options, ages, 7)
    other = UnsteadyLattice(Gusts(), ages, options)
    other.restore(marched(options, ages, 4).state())
    for i in range(4, 7):
        other.begin_step(i * 0.15, 0.15, rotor(i * 0.15, 2, 5), AXIS)
        other.end_step((i + 1) * 0.15, rotor((i + 1) * 0.15, 2, 5))
    for ours, theirs in zip(other.wake().vertices, whole.wake().vertices, strict=True):
        assert np.array_equal(ours, theirs)
