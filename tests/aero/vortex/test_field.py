"""The field of sheets: direct or by clusters, with an image or without."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex import field as field_module
from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.field import InducedField, induced_velocity
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.aero.vortex.sheet import Sheet
from galerna.errors import InputError


def wavy(rows: int, columns: int) -> Sheet:
    x, y = np.meshgrid(np.linspace(0, 30, rows + 1), np.linspace(0, 8, columns + 1), indexing="ij")
    circulation = 1.0 + 0.2 * np.sin(np.arange(rows * columns)).reshape(rows, columns)
    return Sheet(np.stack([x, y, 3.0 + np.sin(x + y)], axis=-1), circulation, 0.1)


GROUND = MirrorPlane(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 2.0]))


@pytest.fixture
def always_clusters(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(field_module, "_CLUSTERS", {})
    monkeypatch.setattr(field_module, "_IN_DOUBLE", (0.0, 0.0))


@pytest.mark.parametrize("error", [None, 1e-3])
@pytest.mark.usefixtures("always_clusters")
def test_no_flow_crosses_a_mirror(error: float | None) -> None:
    points = np.random.default_rng(0).uniform([-5, -5, 1], [40, 15, 1], (50, 3))
    velocity = induced_velocity([wavy(40, 9)], points, error=error, mirror=GROUND)
    assert np.abs(velocity[:, 2]).max() < 1e-3 * np.abs(velocity).max()


@pytest.mark.parametrize("error", [None, 1e-3])
@pytest.mark.usefixtures("always_clusters")
def test_an_image_is_a_second_sheet_below_the_ground(error: float | None) -> None:
    above = [wavy(40, 9), wavy(4, 5)]
    # turned over, a sheet's rings run the other way about
    images = [Sheet(GROUND.reflect_points(s.vertices), -s.circulation, 0.1) for s in above]
    velocity = InducedField(above, error=error, mirror=GROUND).vertex_velocities()
    for sheet, value in zip(above, velocity, strict=True):
        expected = direct_velocity([*above, *images], sheet.vertices)
        scale = np.sqrt(np.mean(np.sum(expected**2, axis=-1)))
        assert np.abs(value - expected).max() < (1e-10 if error is None else 2.0 * error) * scale


def test_small_sums_are_direct_and_large_ones_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(field_module, "Treecode", None)
    few = InducedField([wavy(20, 5)], error=1e-2)
    assert np.array_equal(
        few.velocity(np.ones((3, 3))), direct_velocity(few.sheets, np.ones((3, 3)))
    )
    with pytest.raises(TypeError):
        InducedField([wavy(400, 20)], error=1e-2).vertex_velocities()
    assert InducedField([wavy(400, 20)]).vertex_velocities([]) == []


def test_without_an_error_the_sum_is_direct_and_single_precision_is_near_it() -> None:
    sheet = wavy(30, 8)
    exact = InducedField([sheet]).vertex_velocities()[0]
    assert np.array_equal(exact, direct_velocity([sheet], sheet.vertices))
    single = InducedField([sheet], precision="single").vertex_velocities()[0]
    assert 0.0 < np.abs(single - exact).max() < 1e-5 * np.abs(exact).max()


def test_a_mirror_without_direction_is_refused() -> None:
    with pytest.raises(InputError, match="normal: is zero"):
        MirrorPlane(np.zeros(3), np.zeros(3))
    with pytest.raises(InputError, match="point: is not three finite"):
        MirrorPlane(np.array([np.nan, 0, 0]), np.ones(3))


def test_an_error_out_of_range_is_refused_at_once() -> None:
    with pytest.raises(InputError, match="between"):
        InducedField([wavy(2, 2)], error=0.5)
