"""Wakes of many rows, of which few are summed: nothing spreads, and little is lost."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.ages import growing_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.thinning import Integers, Thinning, summed_rows, turned
from galerna.aero.vortex.unsteady import UnsteadyLattice, UnsteadyOptions
from galerna.aero.vortex.wake import helical_wake, straight_wake
from galerna.contract import Array
from galerna.errors import InputError

from .two_blades import AXIS, rotor

GROWING = growing_ages(0.1, 6.0, near=1.0, growth=1.2, widest=0.5)
ROWS = summed_rows(GROWING)
AGES = 0.1 * np.arange(ROWS[-1] + 1.0)
STEP = np.radians(7.5)
FEW = summed_rows(growing_ages(STEP, 10.0, near=1.0, growth=1.2, widest=4.0 * STEP))
FREE = STEP * np.arange(FEW[-1] + 1.0)


class Steady:
    """A wind of 6 m/s along x."""

    def velocity(self, points: Array, time: float) -> Array:
        return np.broadcast_to([6.0, 0.0, 0.0], points.shape).copy()


def flow(rows: Integers | None = FEW, *, multirate: bool = False) -> UnsteadyLattice:
    """A rotor with a free wake in steady wind."""
    options = UnsteadyOptions(core=VortexCore(0.2), multirate=multirate)
    return UnsteadyLattice(Steady(), FREE, options, summed_rows=rows)


def march(lattice: UnsteadyLattice, steps: range) -> UnsteadyLattice:
    for i in steps:
        lattice.begin_step(i * STEP, STEP, rotor(i * STEP, 2, 8), AXIS)
        lattice.end_step((i + 1) * STEP, rotor((i + 1) * STEP, 2, 8))
    return lattice


def circulation(lattice: UnsteadyLattice, turns: float) -> Array:
    """What one blade's rings hold after so many turns."""
    return march(lattice, range(round(2.0 * np.pi * turns / STEP))).sheets()[-1].circulation


def test_a_thinned_wake_keeps_circulation_over_age() -> None:
    wake = straight_wake(AGES, [np.zeros((4, 3))], [np.ones((4, 3))])
    wake.circulation[0][:] = np.random.default_rng(1).normal(size=wake.circulation[0].shape)
    thin = Thinning(AGES, ROWS).wake(wake)
    assert thin.panels < 0.5 * wake.panels
    for whole in (wake, thin):
        held = (np.diff(whole.ages)[:, None] * whole.circulation[0]).sum(axis=0)
        assert held == pytest.approx(0.1 * wake.circulation[0].sum(axis=0), rel=1e-12)
    assert thin.vertices[0] == pytest.approx(wake.vertices[0][ROWS], abs=1e-12)
    assert thin.circulation[0][0] == pytest.approx(wake.circulation[0][0], rel=1e-15)


def test_chords_of_few_rows_keep_the_area_of_their_circle() -> None:
    """With an error of fourth order; chords between the fluid itself lose it in second order."""
    lost, cut = [], []
    for every in (4, 8):
        rows = np.append([0, 1], np.arange(2, 362, every))
        ages = np.radians(5.0) * np.arange(rows[-1] + 1.0)
        edge = np.array([[0.0, 0.0, 10.0], [0.0, 0.0, 20.0]])
        wake = helical_wake(ages, [edge], AXIS, np.array([6.0, 0.0, 0.0]))
        tip, thin = (w.vertices[0][:, 1] for w in (wake, Thinning(ages, rows).wake(wake)))
        first = int(np.argmax(rows >= 90))
        turn = slice(first, first + 72 // every)
        whole = _area(tip[rows[first] : rows[first] + 72])
        lost.append(_area(thin[turn]) / whole - 1.0)
        cut.append(_area(tip[rows[turn]]) / whole - 1.0)
    assert cut[1] / cut[0] == pytest.approx(4.0, rel=0.1)
    assert lost[1] / lost[0] == pytest.approx(16.0, rel=0.15)


def _area(ring: Array) -> float:
    """Area m2 about x within a closed polygon (k,3) m."""
    return 0.5 * float(np.cross(ring, np.roll(ring, -1, axis=0))[:, 0].sum())


def test_a_velocity_that_turns_with_the_rotor_is_found_everywhere() -> None:
    """A cubic in age, seen from the rotor, is met to rounding; rows that are summed keep theirs."""
    cubic = np.stack([1.0 - 0.3 * AGES**3, AGES + 0.1 * AGES**2, 2.0 - AGES], axis=-1)
    c, s = np.cos(AGES), np.sin(AGES)
    turning = np.stack(
        [cubic[:, 0], c * cubic[:, 1] + s * cubic[:, 2], c * cubic[:, 2] - s * cubic[:, 1]], axis=-1
    )[:, None]
    found = Thinning(AGES, ROWS).everywhere([turning[ROWS]], AXIS)[0]
    assert found == pytest.approx(turning, abs=1e-11)
    random = np.random.default_rng(2).normal(size=(len(ROWS), 2, 3))
    kept = Thinning(AGES, ROWS).everywhere([random], AXIS)[0][ROWS]
    assert kept == pytest.approx(random, abs=1e-13)


def test_what_is_kept_turns_with_the_rotor() -> None:
    kept = turned([np.array([[[1.0, 0.0, 2.0]]])], AXIS, 0.5 * np.pi)[0]
    assert kept == pytest.approx(np.array([[[1.0, -2.0, 0.0]]]), abs=1e-14)


def test_a_swinging_circulation_stays_as_it_was_shed() -> None:
    """With a period of 8 panels at the widest; rows that are remade miss 0.3 of its amplitude."""
    still = [np.zeros((len(AGES), 2, 3))]
    kept, remade = (
        straight_wake(a, [np.zeros((2, 3))], [np.ones((2, 3))]) for a in (AGES, GROWING)
    )
    for step in range(2 * len(AGES)):
        shed = [np.array([np.sin(2.0 * np.pi * step / 40.0)])]
        kept = kept.advanced(still, 0.1, shed)
        remade = remade.advanced([still[0][: len(GROWING)]], 0.1, shed)
    steps = 2 * len(AGES) - 1 - np.arange(len(AGES) - 1)
    assert np.array_equal(kept.circulation[0][:, 0], np.sin(2.0 * np.pi * steps / 40.0))
    thin = Thinning(AGES, ROWS).wake(kept).circulation[0][:, 0]
    middles = 2 * len(AGES) - 0.5 - 0.5 * (ROWS[1:] + ROWS[:-1])
    exact = np.sin(2.0 * np.pi * middles / 40.0)
    assert np.abs(thin - exact).max() < 0.03
    assert np.abs(remade.circulation[0][:, 0] - exact).max() > 0.3


def test_few_rows_serve_a_free_wake() -> None:
    """Rows up to 30 degrees apart give the blades the circulation that all rows give, to 0.5 %."""
    equal, thin = (circulation(flow(rows), 1.5) for rows in (None, FEW))
    assert not np.array_equal(equal, thin)
    assert thin == pytest.approx(equal, rel=0.005)


def test_rows_in_turn_change_nothing_that_is_steady() -> None:
    every, turn = (circulation(flow(multirate=multirate), 1.0) for multirate in (False, True))
    assert not np.array_equal(every, turn)
    assert turn == pytest.approx(every, rel=1e-3)


def test_rows_that_are_summed_in_turn_resume_to_the_bit() -> None:
    whole, other = march(flow(multirate=True), range(9)), flow(multirate=True)
    other.restore(march(flow(multirate=True), range(5)).state())
    march(other, range(5, 9))
    for ours, theirs in zip(other.wake().vertices, whole.wake().vertices, strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("rows", [[0, 2, 65], [0, 1, 59], [0, 1, 1, 65]])
def test_rows_that_do_not_span_the_wake_are_refused(rows: list[int]) -> None:
    with pytest.raises(InputError, match="rise from 0 and 1 to 65"):
        Thinning(AGES, np.array(rows))
