"""Panels of hulls of several members: their symmetry, their lids, and what it saves."""

import numpy as np
import pytest

from galerna.hydro.hull_mesh import platform_panels, symmetry
from galerna.hydro.panels import Panels, displacement
from galerna.turbine.platform import Member, Platform


def column(angle, radius=3.0, diameter=2.0):
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    return Member(f"column at {angle:.1f}", np.array([x, y, -2.0]), np.array([x, y, 1.0]),
                  np.array([0.0, 1.0]), np.full((2, 2), diameter))  # fmt: skip


def floater(*members):
    return Platform((0.0, 0.0, 0.0), 1e4, (0.0, 0.0, -1.0), (1e4, 1e4, 1e4), members=members)


THREE = tuple(column(a) for a in (np.pi, np.pi / 3, -np.pi / 3))


@pytest.mark.parametrize(
    ("members", "found"),
    [
        (THREE, (3, True)),
        (tuple(column(a) for a in np.arange(4) * np.pi / 2), (4, True)),
        ((column(0.0),), (1, True)),
        ((column(0.3), column(0.3 + np.pi)), (2, False)),
        ((column(0.5), column(-0.5), column(2.0, diameter=2.5)), (1, False)),
    ],
)
def test_symmetry_of_members(members, found):
    assert symmetry(members, np.zeros(3)) == found


def test_a_twelfth_of_three_columns_makes_the_whole():
    panels, displaced = platform_panels(floater(*THREE), 0.4)
    assert (panels.sectors, panels.mirrored) == (3, True)
    assert displaced.volume == pytest.approx(3 * np.pi * 2.0, rel=1e-6)
    whole = displacement(*panels.whole())
    assert whole.volume == pytest.approx(displaced.volume, rel=0.02)
    np.testing.assert_allclose(whole.center, displaced.center, atol=0.02)
    np.testing.assert_allclose(whole.second, displaced.second, rtol=0.03, atol=1e-6)


def test_panels_close_over_their_cuts():
    """Every edge of the whole that is not at the still water has a triangle on both sides."""
    vertices, faces = platform_panels(floater(*THREE), 0.4)[0].whole()
    _, number = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    number = number.reshape(-1)
    edges = {(int(t[i - 1]), int(t[i])) for t in number[faces] for i in range(4)}
    edges = {(a, b) for a, b in edges if a != b}
    height = dict(zip(number.tolist(), vertices[:, 2], strict=True))
    open_ones = [e for e in edges if e[::-1] not in edges]
    assert open_ones
    assert all(abs(height[i]) < 1e-6 for e in open_ones for i in e)


def test_lids_lie_inside_the_waterlines_and_do_not_overlap():
    panels, displaced = platform_panels(floater(*THREE), 0.25)
    lid = Panels(panels.lid_vertices, panels.lid_faces, np.zeros((0, 3)), np.zeros((0, 4), int),
                 panels.sectors, panels.mirrored)  # fmt: skip
    vertices, faces = lid.whole()
    centers = vertices[faces].mean(axis=1)[:, :2]
    middles = np.array([member.start[:2] for member in THREE])
    away = np.linalg.norm(centers[:, None] - middles, axis=2).min(axis=1)
    assert away.max() < 1.0
    a, b, c, d = np.moveaxis(vertices[faces], 1, 0)
    area = -0.5 * np.cross(c - a, d - b)[:, 2].sum()  # they look down
    assert 0.6 * displaced.area < area <= displaced.area
    gaps = np.linalg.norm(centers[:, None] - centers, axis=2) + np.eye(len(centers))
    assert gaps.min() > 0.1


def test_coefficients_do_not_depend_on_the_knowledge_of_symmetry():
    pytest.importorskip("capytaine")
    from galerna.hydro.capytaine_runs import compute

    panels, displaced = platform_panels(floater(*THREE), 0.6)
    lid = Panels(panels.lid_vertices, panels.lid_faces, np.zeros((0, 3)), np.zeros((0, 4), int),
                 panels.sectors, panels.mirrored)  # fmt: skip
    plain = Panels(*panels.whole(), *lid.whole())
    headings = np.array([0.0, 0.5, 2.0])
    known = compute(panels, [2.0], headings, displaced=displaced)
    found = compute(plain, [2.0], headings, displaced=displaced)
    for name in ("added_mass", "damping", "excitation", "mean_drift", "added_mass_infinite"):
        a, b = getattr(known, name), getattr(found, name)
        np.testing.assert_allclose(b, a, atol=1e-4 * np.abs(a).max(), err_msg=name)
    assert known.displaced_volume == displaced.volume
