"""Hulls of members: volumes in closed form, unions, the wetted part."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.hull import Hull, build_hull, wetted_surface
from galerna.hydro.hydrostatics import hydrostatics
from galerna.turbine import load
from galerna.turbine.platform import Member


def member(start: list[float], end: list[float], *sides: tuple[float, float], round: bool = True):
    span = np.linspace(0.0, 1.0, len(sides))
    return Member("one", np.array(start), np.array(end), span, np.array(sides), round=round)


COLUMN = member([0.0, 0.0, -10.0], [0.0, 0.0, 5.0], (4.0, 4.0), (4.0, 4.0))


def boundary(hull: Hull) -> np.ndarray:
    """Edges (k,2) that belong to one triangle alone."""
    edges = hull.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    known = {(int(a), int(b)) for a, b in edges}
    assert len(known) == len(edges)  # no edge is passed twice the same way
    return np.array([e for e in known if e[::-1] not in known], dtype=int).reshape(-1, 2)


# one member ----------------------------------------------------------------------------


@pytest.mark.parametrize("end", [[0.0, 0.0, 8.0], [3.0, 4.0, 12.0], [0.0, 9.0, 0.0]])
@pytest.mark.parametrize("facets", [8, 24])
def test_a_frustum_has_its_volume_whatever_its_facets(end: list[float], facets: int) -> None:
    cone = member([0.0, 0.0, 0.0], end, (6.0, 6.0), (2.0, 2.0))
    hull = build_hull([cone], facets)
    assert hull.volume == pytest.approx(np.pi * cone.length * (9.0 + 3.0 + 1.0) / 3.0)
    assert len(boundary(hull)) == 0


@pytest.mark.parametrize("end", [[0.0, 0.0, 5.0], [5.0, 0.0, 0.0], [3.0, 4.0, 0.0]])
def test_a_rectangle_stands_with_its_first_side_level(end: list[float]) -> None:
    hull = build_hull([member([0.0] * 3, end, (3.0, 2.0), (3.0, 2.0), round=False)])
    assert hull.volume == pytest.approx(30.0)
    height = 5.0 if end[2] else 2.0
    assert np.ptp(hull.vertices[:, 2]) == pytest.approx(height)


def test_second_moments_err_with_the_fourth_power_of_the_facets() -> None:
    errors = []
    for facets in (16, 32):
        found = hydrostatics(build_hull([COLUMN], facets))
        assert found.area == pytest.approx(4.0 * np.pi, rel=1e-12)
        errors.append(found.moments[0] / (4.0 * np.pi) - 1.0)
    assert errors[0] == pytest.approx((2.0 * np.pi / 16) ** 4 / 180.0, rel=0.03)
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.05)


# several members -----------------------------------------------------------------------


def test_crossing_members_count_once() -> None:
    pytest.importorskip("manifold3d")
    across = member([-5.0, 0.0, -3.0], [5.0, 0.0, -3.0], (2.0, 2.0), (2.0, 2.0), round=False)
    upright = member([0.0, 0.0, -10.0], [0.0, 0.0, 5.0], (3.0, 4.0), (3.0, 4.0), round=False)
    hull = build_hull([across, upright])
    assert hull.volume == pytest.approx(10.0 * 4.0 + 15.0 * 12.0 - 3.0 * 2.0 * 2.0)
    assert len(boundary(hull)) == 0


def test_equal_cylinders_share_the_volume_that_archimedes_found() -> None:
    pytest.importorskip("manifold3d")
    across = member([-5.0, 0.0, -3.0], [5.0, 0.0, -3.0], (4.0, 4.0), (4.0, 4.0))
    exact = np.pi * 4.0 * (10.0 + 15.0) - 16.0 / 3.0 * 2.0**3
    errors = [abs(build_hull([across, COLUMN], n).volume / exact - 1.0) for n in (16, 32, 64)]
    assert errors[-1] < 1e-4
    assert np.all(np.divide(errors[:-1], errors[1:]) > 3.5)  # at least with the square


def test_members_apart_need_no_union(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "manifold3d", None)
    shift = np.array([5.0, 0.0, 0.0])
    other = replace(COLUMN, start=COLUMN.start + shift, end=COLUMN.end + shift)
    assert build_hull([COLUMN, other]).volume == pytest.approx(2.0 * 60.0 * np.pi)
    nearer = replace(other, start=other.start - 0.25 * shift, end=other.end - 0.25 * shift)
    with pytest.raises(InputError, match=r"galerna\[hydro\]"):
        build_hull([COLUMN, nearer])


def test_volturnus_displaces_what_is_published() -> None:
    """Plan of the pontoons in closed form; 20,206.35 m3 by the WAMIT run of its HydroDyn file.

    Three pontoons of 12.5 m x 7 m meet at the centre, where pairs overlap in triangles and the
    main column lies inside them, and end on the axes of outer columns as wide as they are.
    """
    pytest.importorskip("manifold3d")
    platform = load("iea15mw_volturnus").platform
    half = 6.25
    plan = 12.5 * 51.75 - half**2 / np.sqrt(3.0) - 0.5 * np.pi * half**2
    columns = 3.0 * np.pi * half**2 * 20.0 + np.pi * 25.0 * 13.0
    exact = 3.0 * 7.0 * plan + columns
    assert exact == pytest.approx(20206.34889, abs=1e-5)
    assert platform.displaced_volume == pytest.approx(exact)
    errors = [hydrostatics(build_hull(platform.members, n)).volume / exact - 1.0 for n in (16, 32)]
    assert errors[0] == pytest.approx(1.6e-5, rel=0.05)
    assert errors[0] / errors[1] == pytest.approx(8.0, rel=0.1)
    found = hydrostatics(build_hull(platform.members))
    assert found.center_of_buoyancy == pytest.approx([0.0, 0.0, -13.63], abs=0.005)
    assert found.area == pytest.approx(np.pi * (25.0 + 3.0 * half**2), rel=1e-9)


# the wetted part -------------------------------------------------------------------------


def test_the_wetted_part_is_open_at_the_water_alone() -> None:
    wet = wetted_surface(build_hull([COLUMN], 24))
    edges = boundary(wet)
    assert len(edges) == 48  # each facet is two triangles
    assert np.abs(wet.vertices[edges.ravel(), 2]).max() == 0.0
    assert wet.vertices[:, 2].max() == 0.0
    assert wet.area_vectors().sum(axis=0) == pytest.approx([0.0, 0.0, -4.0 * np.pi], abs=1e-9)
    assert wet.volume == pytest.approx(40.0 * np.pi)  # the waterplane adds nothing at z = 0


def test_a_deck_on_the_water_is_not_wet() -> None:
    awash = replace(COLUMN, end=np.array([0.0, 0.0, 0.0]))
    wet = wetted_surface(build_hull([awash], 24))
    assert wet.area_vectors().sum(axis=0) == pytest.approx([0.0, 0.0, -4.0 * np.pi], abs=1e-9)
    assert len(boundary(wet)) == 24


def test_what_is_below_the_water_stays_whole() -> None:
    sunk = replace(COLUMN, end=np.array([0.0, 0.0, -1.0]))
    hull = build_hull([sunk], 24)
    assert len(wetted_surface(hull).triangles) == len(hull.triangles)


@pytest.mark.parametrize(
    ("members", "said"),
    [
        ([], "has no members"),
        ([replace(COLUMN, start=np.array([0.0, 0.0, 1.0]))], "lies above the water, from z = 1 m"),
    ],
)
def test_no_hull(members: list[Member], said: str) -> None:
    with pytest.raises(InputError, match=said):
        wetted_surface(build_hull(members))
