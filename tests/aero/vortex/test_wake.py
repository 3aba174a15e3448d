"""Wakes whose rows are labelled by age: shapes, conservation, rates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna.aero.vortex.ages import growing_ages, uniform_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.wake import THINNEST, Wake, helical_wake, straight_wake
from galerna.errors import InputError

GROWING = growing_ages(0.05, 4.0, near=0.3, growth=1.2, widest=0.35)


def rotor(azimuth: float, speed: float, wind: np.ndarray, ages: np.ndarray) -> tuple[Wake, list]:
    """Helical wakes of two coned blades at an azimuth, and their trailing edges."""
    radius = np.linspace(1.0, 5.0, 6)
    edges = []
    for start in (0.0, np.pi):
        angle = azimuth + start
        edges.append(
            np.stack([0.1 * radius, -radius * np.sin(angle), radius * np.cos(angle)], axis=1)
        )
    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]), speed)
    return helical_wake(ages, edges, axis, wind), edges


@pytest.mark.parametrize("fraction", [0.3, 1.0])
@pytest.mark.parametrize("wind", [[8.0, 0.0, 0.0], [7.0, 3.0, -1.0]])
def test_a_helix_stays_the_same_helix(fraction: float, wind: list[float]) -> None:
    speed, wind = 1.2, np.array(wind)
    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]))
    wake, edges = rotor(0.0, speed, wind, GROWING)
    azimuth, step = 0.0, fraction * wake.step
    for _ in range(40):
        blown = [np.broadcast_to(wind, x.shape) for x in wake.vertices]
        wake = wake.advanced(blown, step, [np.zeros(5)] * 2, axis)
        azimuth += speed * step
        expected, edges = rotor(azimuth, speed, wind, GROWING)
        wake.attach(edges)
    for x, y in zip(wake.vertices, expected.vertices, strict=True):
        assert np.abs(x - y).max() < 1e-12 * np.abs(y).max()


def test_straight_interpolation_would_shrink_a_helix() -> None:
    wake, _ = rotor(0.0, 1.2, np.array([8.0, 0.0, 0.0]), GROWING)
    for step in range(40):
        blown = [np.broadcast_to([8.0, 0.0, 0.0], x.shape) for x in wake.vertices]
        wake = wake.advanced(blown, wake.step, [np.zeros(5)] * 2)
        wake.attach(rotor(1.2 * (step + 1) * wake.step, 1.2, np.zeros(3), GROWING)[1])
    assert np.hypot(*wake.vertices[0][-1, -1, 1:]) < 0.99 * 5.0


def test_equal_panels_shift_to_the_bit() -> None:
    random = np.random.default_rng(1)
    ages = uniform_ages(0.1, 1.0)
    vertices, circulation = random.normal(size=(11, 4, 3)), random.normal(size=(10, 3))
    velocity, shed = random.normal(size=(11, 4, 3)), random.normal(size=3)
    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]))
    for about in (None, axis):
        centre = None if about is None else np.zeros((11, 3))
        wake = Wake(ages, (vertices,), (circulation,), centre)
        moved = wake.advanced([velocity], wake.step, [shed], about)
        expected = vertices + 0.1 * velocity
        assert np.array_equal(moved.vertices[0][1:], expected[:-1])
        assert np.array_equal(moved.circulation[0], np.vstack([shed, circulation[:-1]]))


def test_circulation_over_age_is_conserved_but_for_what_enters_and_leaves() -> None:
    random = np.random.default_rng(2)
    wake = straight_wake(GROWING, [np.zeros((4, 3))], [np.ones((4, 3))])
    wake.circulation[0][:] = random.normal(size=wake.circulation[0].shape)
    shed = random.normal(size=3)
    step = 0.7 * wake.step
    moved = wake.advanced([np.ones_like(wake.vertices[0])], step, [shed])
    width = np.diff(GROWING)[:, None]
    before, after = ((width * w.circulation[0]).sum(axis=0) for w in (wake, moved))
    assert after == pytest.approx(before + step * (shed - wake.circulation[0][-1]), rel=1e-12)


def test_substeps_from_the_last_shedding_do_not_spread_the_wake() -> None:
    """Elapsed times are always counted from the shed wake: 4 quarters are as one step."""
    wake, _ = rotor(0.0, 1.2, np.array([8.0, 0.0, 0.0]), GROWING)
    random = np.random.default_rng(3)
    axis = RotorAxis(np.zeros(3), np.array([1.0, 0.0, 0.0]))
    velocity = [random.normal(size=x.shape) for x in wake.vertices]
    shed = [random.normal(size=5) for _ in range(2)]
    whole = wake.advanced(velocity, wake.step, shed, axis)
    almost = wake.advanced(velocity, wake.step * (1.0 - 1e-7), shed, axis)
    assert np.abs(whole.vertices[1][1:] - almost.vertices[1][1:]).max() < 1e-5


def test_vorticity_of_a_growing_wake_travels_with_the_flow() -> None:
    """The upwind scheme spreads a vortex but moves its centre exactly."""
    wake = straight_wake(GROWING, [np.zeros((2, 3))], [np.tile([10.0, 0.0, 0.0], (2, 1))])
    wind = [np.broadcast_to([10.0, 0.0, 0.0], wake.vertices[0].shape)]
    for _ in range(15):
        wake = wake.advanced(wind, wake.step, [np.ones(1)])
        wake.attach([np.zeros((2, 3))])
    circulation = wake.circulation[0][:, 0]
    strength = -np.diff(circulation, append=0.0)
    centre = (strength * wake.vertices[0][1:, 0, 0]).sum() / strength.sum()
    assert strength.sum() == pytest.approx(1.0)
    assert centre == pytest.approx(10.0 * 15 * wake.step, rel=1e-10)
    spread = (strength * (wake.vertices[0][1:, 0, 0] - centre) ** 2).sum()
    assert 0.0 < spread**0.5 < 0.4 * centre


def test_a_step_beyond_the_first_panel_is_refused() -> None:
    wake = straight_wake(GROWING, [np.zeros((2, 3))], [np.ones((2, 3))])
    with pytest.raises(InputError, match=r"at most 0\.05 s"):
        wake.advanced([np.ones_like(wake.vertices[0])], 0.051, [np.ones(1)])


def test_panels_that_shrink_are_refused() -> None:
    wake = straight_wake(np.array([0.0, 0.1, 0.15]), [np.zeros((2, 3))], [np.ones((2, 3))])
    with pytest.raises(InputError, match="narrower than the first"):
        wake.advanced([np.ones_like(wake.vertices[0])], 0.05, [np.ones(1)])


def test_cores_grow_with_age_and_leave_the_trailing_edge_singular() -> None:
    wake = straight_wake(GROWING, [np.zeros((3, 3))], [np.ones((3, 3))])
    wake.circulation[0][:] = 5.0
    sheet = wake.sheets(VortexCore(0.2))[0]
    radius = np.broadcast_to(sheet.core_radius, sheet.vertices.shape[:2])
    assert np.all(radius[0] == 0.0)
    assert np.all(np.diff(radius[1:, 0]) > 0.0)
    way = np.linalg.norm(wake.vertices[0][1] - wake.vertices[0][0], axis=1).mean()
    assert radius[1, 0] == pytest.approx(THINNEST * way)
    assert radius[-1, 0] == pytest.approx(VortexCore(0.2).radius(GROWING[-1], 5.0))
    assert np.all(wake.core_radius(VortexCore(0.2), edge=0.2)[0] >= 0.2)
    first, rest = (wake.sheets(VortexCore(0.2), rows=r)[0] for r in (slice(1), slice(1, None)))
    assert first.circulation.shape == (1, 2)
    assert rest.circulation.shape == (len(GROWING) - 2, 2)


def test_the_wake_itself_does_not_change() -> None:
    wake, edges = rotor(0.0, 1.2, np.array([8.0, 0.0, 0.0]), GROWING)
    before = replace(wake, vertices=tuple(x.copy() for x in wake.vertices))
    moved = wake.advanced([np.ones_like(x) for x in wake.vertices], 0.02, [np.ones(5)] * 2)
    moved.attach(edges)
    assert all(np.array_equal(a, b) for a, b in zip(wake.vertices, before.vertices, strict=True))
