"""The kernel of vortex segments, in both precisions, against Katz and Plotkin's formula."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.sheet import Sheet
from galerna.errors import InputError


def segments_of(sheet: Sheet) -> list[tuple[np.ndarray, ...]]:
    """Starts and ends (k,3), strengths (k,) and mean squares of the core radii (k,)."""
    x = sheet.vertices
    core = np.broadcast_to(sheet.core_radius, x.shape[:2])
    pairs = [
        (x[:, :-1], x[:, 1:], sheet.spanwise_strength, core[:, :-1] ** 2 + core[:, 1:] ** 2),
        (x[:-1], x[1:], sheet.streamwise_strength, core[:-1] ** 2 + core[1:] ** 2),
    ]
    return [(a.reshape(-1, 3), b.reshape(-1, 3), g.ravel(), c.ravel() / 2) for a, b, g, c in pairs]


def plain_velocity(sheet: Sheet, point: np.ndarray) -> np.ndarray:
    """Katz and Plotkin (2001), eq. 2.68, with the core of Vatistas."""
    total = np.zeros(3)
    for start, end, strength, core_squared in segments_of(sheet):
        r1, r2, l = point - start, point - end, end - start
        a, b = np.linalg.norm(r1, axis=1), np.linalg.norm(r2, axis=1)
        cross = np.cross(r1, r2)
        d2 = (cross**2).sum(1) / (l**2).sum(1)
        factor = (1 / a + 1 / b) / (a * b + (r1 * r2).sum(1)) * d2 / np.hypot(d2, core_squared)
        total += (strength / (4 * np.pi) * factor) @ cross
    return total


def helix(core_radius: float = 0.3, rows: int = 180, columns: int = 12) -> Sheet:
    """A wake 200 m long behind a blade of 60 m, of uneven circulation."""
    angle, radius = np.meshgrid(
        np.linspace(0.0, 10 * np.pi, rows + 1), np.linspace(5, 60, columns + 1), indexing="ij"
    )
    vertices = np.stack(
        [20.0 * angle / np.pi, radius * np.cos(angle), radius * np.sin(angle)], axis=-1
    )
    circulation = 80.0 * np.sin(np.linspace(0.2, 3.0, columns))
    circulation = circulation * (1.0 + 0.1 * np.random.default_rng(3).normal(size=(rows, columns)))
    return Sheet(vertices, circulation, core_radius)


@pytest.fixture(scope="module")
def points() -> np.ndarray:
    """In the wake, beside its vertices, and far from it."""
    rng = np.random.default_rng(4)
    anywhere = rng.uniform([-50, -90, -90], [250, 90, 90], (70, 3))
    beside = helix().vertices.reshape(-1, 3)[::29][:80] + rng.normal(scale=0.5, size=(80, 3))
    return np.concatenate([anywhere, beside, [[4000.0, 100.0, 50.0]]])


@pytest.mark.parametrize("core_radius", [0.0, 0.3])
def test_double_precision_is_the_formula(points: np.ndarray, core_radius: float) -> None:
    sheet = helix(core_radius)
    expected = np.array([plain_velocity(sheet, p) for p in points])
    assert direct_velocity([sheet], points) == pytest.approx(expected, rel=1e-9, abs=1e-11)


def test_single_precision_is_good_to_a_part_in_100_000_anywhere(points: np.ndarray) -> None:
    sheet = helix()
    points = np.concatenate([points, sheet.vertices.reshape(-1, 3)])
    double = direct_velocity([sheet], points)
    error = direct_velocity([sheet], points, "single") - double
    assert np.linalg.norm(error) < 1e-5 * np.linalg.norm(double)
    assert np.linalg.norm(error) > 0.0


@pytest.mark.parametrize("core_radius", [0.0, 0.3])
def test_mixed_precision_is_good_to_a_part_in_a_million(
    points: np.ndarray, core_radius: float
) -> None:
    sheet = helix(core_radius)
    x = sheet.vertices
    points = np.concatenate([points, x.reshape(-1, 3), 0.5 * (x[1:] + x[:-1]).reshape(-1, 3)])
    double = direct_velocity([sheet], points)
    error = np.linalg.norm(direct_velocity([sheet], points, "mixed") - double, axis=1)
    size = np.sqrt(np.mean(np.sum(double**2, axis=1)))
    assert error.max() < 1e-6 * size
    assert error.max() > 0.0


@pytest.mark.parametrize("precision", ["double", "mixed", "single"])
@pytest.mark.parametrize("core_radius", [0.0, 0.2])
def test_nothing_is_infinite_on_vertices_segments_and_their_lines(
    precision: str, core_radius: float
) -> None:
    sheet = helix(core_radius, rows=9, columns=3)
    x = sheet.vertices
    middles, beyond = 0.5 * (x[1:] + x[:-1]), 2.0 * x[:, -1] - x[:, -2]
    everywhere = np.concatenate([a.reshape(-1, 3) for a in (x, middles, beyond)])
    for nudge in (0.0, 1e-12, 1e-9, 1e-6):
        assert np.all(np.isfinite(direct_velocity([sheet], everywhere + nudge, precision)))


@pytest.mark.parametrize("core_radius", [0.0, 0.2])
def test_segments_do_not_move_the_points_of_their_own_line(core_radius: float) -> None:
    start, along = np.array([3.0, 1.0, 50.0]), np.array([1.5, 1.2, -1.0])
    folded = start + np.array([[0.0, 1.0], [2.0, 3.5]])[..., None] * along
    points = start + np.array([-2.0, 0.0, 0.3, 0.5, 1.7, 2.0, 9.0])[:, None] * along
    velocity = direct_velocity([Sheet(folded, np.ones((1, 1)), core_radius)], points)
    assert velocity == pytest.approx(0.0, abs=1e-6)


def test_the_swirl_about_a_core_is_largest_at_its_radius() -> None:
    long = np.array([[[-1e4, 0, 0], [1e4, 0, 0]], [[-1e4, 0, -1e6], [1e4, 0, -1e6]]], float)
    distance = np.array([0.25, 0.49, 0.5, 0.51, 1.0])
    points = np.stack([0 * distance, 0 * distance, distance], axis=-1)
    swirl = -direct_velocity([Sheet(long, np.ones((1, 1)), 0.5)], points)[:, 1]
    assert np.argmax(swirl) == 2
    assert swirl[2] == pytest.approx(1.0 / (2 * np.pi * 0.5 * np.sqrt(2.0)), rel=1e-4)


def test_velocities_add_up_over_sheets_and_keep_the_shape_of_the_points() -> None:
    one, other = helix(rows=5, columns=33), helix(rows=130, columns=2)
    points = np.random.default_rng(0).uniform(-60, 60, (5, 13, 3))
    both = direct_velocity([one, other], points)
    assert both.shape == points.shape
    apart = direct_velocity([one], points) + direct_velocity([other], points)
    assert both == pytest.approx(apart, rel=1e-12, abs=1e-12)
    assert direct_velocity([one], points[0, 0]) == pytest.approx(
        direct_velocity([one], points)[0, 0], rel=1e-9, abs=1e-12
    )
    assert direct_velocity([one], np.empty((0, 3))).shape == (0, 3)
    assert np.all(direct_velocity([], points) == 0.0)


def test_sheets_beyond_the_reach_of_single_precision_are_summed_in_double() -> None:
    sheet = helix()
    sheet.vertices[-1] += np.array([5e4, 0.0, 0.0])
    points = np.zeros((1, 3))
    assert np.all(
        direct_velocity([sheet], points, "single") == direct_velocity([sheet], points, "double")
    )


def test_an_unknown_precision_is_refused() -> None:
    with pytest.raises(InputError, match="precision"):
        direct_velocity([helix()], np.zeros((1, 3)), "half")
