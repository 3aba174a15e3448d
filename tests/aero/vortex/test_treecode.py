"""The error of the treecode is the one asked for, whatever the wake and the points."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.descent import Rule
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.treecode import Treecode, choose_rule
from galerna.errors import InputError

RADIUS, PITCH = 63.0, 52.8  # m, m a revolution


def rolled_up(x: np.ndarray, r: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The outer part of a sheet wound about its tip vortex, the more the older it is."""
    part = np.clip((r - 0.7 * RADIUS) / (0.3 * RADIUS), 0.0, 1.0)
    age = 1.0 - np.exp(-angle / 4.0)
    away, turn = (r - 0.93 * RADIUS) * (1.0 - 0.3 * age * part), 2.0 * np.pi * age * part**2
    outer = part > 0.0
    return (
        np.where(outer, x + away * np.sin(turn), x),
        np.where(outer, 0.93 * RADIUS + away * np.cos(turn), r),
    )


def waves(points: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Displacements of some metres that grow with age, as turbulence would cause."""
    random = np.random.default_rng(1)
    moved = np.zeros_like(points)
    for _ in range(20):
        number, height = random.normal(size=3) * 0.1, random.normal(size=3) * 4.0 / np.sqrt(20.0)
        moved += height * np.sin(points @ number + random.uniform(0.0, 6.0))[..., None]
    return moved * (1.0 - np.exp(-angle / 6.0))[..., None]


def wake(angles: np.ndarray, columns: int, core: float, *, distorted: bool = False) -> list[Sheet]:
    """Three helices of a rotor of the size of the NREL 5 MW's, and cores that grow."""
    angle, r = np.meshgrid(angles, np.linspace(0.1, 1.0, columns + 1) * RADIUS, indexing="ij")
    x = PITCH * angle / (2.0 * np.pi)
    if distorted:
        x, r = rolled_up(x, r, angle)
    place = (np.arange(columns) + 0.5) / columns
    load = 80.0 * np.sqrt(1.0 - (2.0 * place - 1.0) ** 8) * (0.85 + 0.15 * place)
    circulation = load * (1.0 + 0.1 * np.sin(4.0 * angles[:-1, None]))
    cores = np.sqrt(core**2 + 0.04 * angle) if core else 0.0
    sheets = []
    for blade in range(3):
        azimuth = angle + 2.0 * np.pi * blade / 3.0
        points = np.stack([x, r * np.cos(azimuth), r * np.sin(azimuth)], axis=-1)
        if distorted:
            points += waves(points, angle)
        sheets.append(Sheet(points, circulation, cores))
    return sheets


UNIFORM = np.radians(5.0) * np.arange(217)
GROWING = np.concatenate(
    [[0.0], np.cumsum(np.minimum(np.radians(5.0) * 1.03 ** np.arange(90), 0.7))]
)
WAKES = {
    "uniform": wake(UNIFORM, 12, 0.5),
    "without cores": wake(UNIFORM, 12, 0.0),
    "thick cores": wake(UNIFORM, 12, 2.0),
    "growing panels": wake(GROWING, 16, 0.5),
    "rolled up": wake(UNIFORM, 12, 0.5, distorted=True),
}


def relative(error: np.ndarray, velocity: np.ndarray) -> tuple[float, float]:
    """Root mean square and 99.9th percentile of an error, over the root mean square velocity."""
    sizes = np.linalg.norm(error.reshape(-1, 3), axis=-1)
    scale = np.sqrt(np.mean(np.sum(velocity.reshape(-1, 3) ** 2, axis=-1)))
    return float(np.sqrt(np.mean(sizes**2)) / scale), float(np.quantile(sizes, 0.999) / scale)


@pytest.fixture(scope="module")
def summed() -> dict[str, np.ndarray]:
    vertices = {name: np.concatenate([s.vertices for s in w]) for name, w in WAKES.items()}
    return {name: direct_velocity(WAKES[name], x) for name, x in vertices.items()}


@pytest.mark.parametrize("error", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("name", WAKES)
def test_a_wakes_own_velocity_has_the_error_asked_for(
    summed: dict[str, np.ndarray], name: str, error: float
) -> None:
    velocity = np.concatenate(Treecode(WAKES[name], error).vertex_velocities(precision="single"))
    root_mean_square, percentile = relative(velocity - summed[name], summed[name])
    assert root_mean_square < 0.5 * error
    assert percentile < error


@pytest.mark.parametrize("error", [1e-2, 1e-3, 1e-4])
def test_points_near_the_rotor_and_far_from_it_have_the_error_asked_for(error: float) -> None:
    sheets = WAKES["rolled up"]
    r, azimuth, x = np.random.default_rng(2).uniform([5, 0, -90], [90, 6.3, 200], (1500, 3)).T
    points = np.stack([x, r * np.cos(azimuth), r * np.sin(azimuth)], axis=-1).reshape(30, 50, 3)
    exact = direct_velocity(sheets, points)
    _, percentile = relative(Treecode(sheets, error).velocity(points) - exact, exact)
    assert percentile < error


@pytest.mark.parametrize("error", [1e-2, 1e-3, 1e-4])
def test_points_along_a_blade_have_the_error_asked_for(error: float) -> None:
    """They lie on the lines of the wake's first vortices, whose cores are felt from afar."""
    sheets = WAKES["uniform"]
    chord = np.linspace(-0.7, 0.2, 10)[:, None, None] * np.array([1.0, 2.0, -1.0])
    points = np.concatenate([sheet.vertices[0] + chord for sheet in sheets])
    exact = direct_velocity(sheets, points)
    _, percentile = relative(Treecode(sheets, error).velocity(points) - exact, exact)
    assert percentile < error


def test_the_far_field_converges_exponentially_with_its_order(
    summed: dict[str, np.ndarray],
) -> None:
    errors = []
    for order in (4, 6, 8, 10):
        tree = Treecode(WAKES["without cores"], rule=Rule(order, 0.6, 0.0, 24))
        velocity = np.concatenate(tree.vertex_velocities())
        errors.append(relative(velocity - summed["without cores"], summed["without cores"])[0])
    assert np.all(np.diff(np.log(errors)) < 2.0 * np.log(0.6))


def test_without_far_patches_the_sum_is_the_direct_one(summed: dict[str, np.ndarray]) -> None:
    tree = Treecode(WAKES["growing panels"], rule=Rule(4, 0.0, 0.0, 24))
    velocity = np.concatenate(tree.vertex_velocities())
    assert relative(velocity - summed["growing panels"], summed["growing panels"])[1] < 1e-11


def test_the_result_does_not_depend_on_the_number_of_threads() -> None:
    sheets = WAKES["rolled up"]
    threads = numba.get_num_threads()
    answers = []
    for count in (1, threads):
        numba.set_num_threads(count)
        answers.append(Treecode(sheets).vertex_velocities(precision="single"))
    for one, other in zip(*answers, strict=True):
        assert np.array_equal(one, other)


def test_only_the_sheets_that_are_asked_for_are_answered() -> None:
    tree = Treecode(WAKES["growing panels"])
    everything = tree.vertex_velocities()
    [third, first] = tree.vertex_velocities([2, 0])
    assert np.array_equal(third, everything[2])
    assert np.array_equal(first, everything[0])


def test_sheets_of_one_panel_and_few_points_are_no_exception() -> None:
    square = np.array([[[0.0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    sheets = [
        Sheet(square, np.ones((1, 1)), 0.01),
        Sheet(square + np.array([5.0, 0, 0]), np.ones((1, 1))),
    ]
    points = np.array([[2.5, 0.3, 0.4], [40.0, 3.0, 1.0]])
    assert Treecode(sheets, 1e-4).velocity(points) == pytest.approx(
        direct_velocity(sheets, points), rel=1e-3, abs=1e-7
    )
    assert Treecode(sheets).velocity(np.zeros((0, 3))).shape == (0, 3)


def test_an_error_that_cannot_be_kept_is_refused() -> None:
    with pytest.raises(InputError, match=r"1e-5 and 0\.1"):
        choose_rule(1e-9)
