"""Panels of even size: the surface stays, its lines stay, the angles open."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.hull import Hull, build_hull, wetted_surface
from galerna.hydro.nearest import onto
from galerna.hydro.remesh import even_panels, quality
from galerna.turbine.platform import Member


def member(start: list[float], end: list[float], *sides: float, round: bool = True) -> Member:
    span = np.array([0.0, 1.0])
    return Member("one", np.array(start), np.array(end), span, np.array([sides] * 2), round=round)


COLUMN = member([0.0, 0.0, -10.0], [0.0, 0.0, 5.0], 6.0, 6.0)
PONTOON = member([0.0, 0.0, -8.0], [12.0, 0.0, -8.0], 4.0, 3.0, round=False)
DEGREE = np.pi / 180.0


def edges(hull: Hull) -> np.ndarray:
    corners = hull.vertices[hull.triangles]
    return np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)


def is_closed_below_water(hull: Hull) -> bool:
    """Every edge is passed once each way, but for those on the still water."""
    passed = hull.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    known = {(int(a), int(b)) for a, b in passed}
    alone = [e for e in known if e[::-1] not in known]
    return len(known) == len(passed) and not hull.vertices[np.ravel(alone).astype(int), 2].any()


def test_a_box_stays_a_box() -> None:
    box = member([0.0, 0.0, -4.0], [0.0, 0.0, 2.0], 8.0, 5.0, round=False)
    wet = wetted_surface(build_hull([box]))
    panels = even_panels(wet, 1.0)
    assert panels.volume == pytest.approx(160.0, rel=1e-12)
    assert panels.area == pytest.approx(8.0 * 5.0 + 2.0 * 4.0 * 13.0, rel=1e-12)
    found = quality(panels)
    assert found.smallest_angle > 30.0 * DEGREE
    assert found.largest_aspect < 3.0
    assert edges(panels).max() < 1.5
    assert is_closed_below_water(panels)


def test_a_column_keeps_its_volume_and_waterplane() -> None:
    """Panels err by far less than chords inside the circle, and by a higher order."""
    wet = wetted_surface(build_hull([COLUMN]))
    errors = [even_panels(wet, size).volume / wet.volume - 1.0 for size in (2.4, 1.2)]
    inscribed = (2.4 / 3.0) ** 2 / 6.0
    assert abs(errors[0]) < 0.1 * inscribed
    assert errors[0] / errors[1] > 2.0**2
    panels = even_panels(wet, 1.2)
    assert -panels.area_vectors().sum(axis=0)[2] == pytest.approx(9.0 * np.pi, rel=0.01)
    assert panels.vertices[:, 2].max() == 0.0
    assert quality(panels).smallest_angle > 25.0 * DEGREE


def test_a_pontoon_on_a_column_gets_even_panels() -> None:
    pytest.importorskip("manifold3d")
    wet = wetted_surface(build_hull([COLUMN, PONTOON]))
    assert quality(wet).smallest_angle < 1.0 * DEGREE
    panels = even_panels(wet, 1.0)
    assert quality(panels).smallest_angle > 10.0 * DEGREE
    assert panels.volume == pytest.approx(wet.volume, rel=2e-3)
    assert is_closed_below_water(panels)
    assert quality(panels).panels == pytest.approx(wet.area / 0.433, rel=0.35)


def test_nearest_points_lie_on_corners_edges_and_faces() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    triangle = Hull(corners, np.array([[0, 1, 2]]))
    points = np.array([[-1, -1, 1], [2, -1, 0], [-1, 3, 0], [0.5, -1, 2], [1, 1, 1], [0.2, 0.3, 5]])
    expected = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0.2, 0.3, 0]]
    assert onto(triangle, points) == pytest.approx(np.array(expected, dtype=float), abs=1e-15)


@pytest.mark.parametrize("size", [0.0, 0.01])
def test_too_many_panels_are_refused(size: float) -> None:
    with pytest.raises(InputError, match="at most 50000"):
        even_panels(build_hull([COLUMN]), size)
