"""Panels of bodies of revolution and what they displace."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.panels import (
    displacement,
    hull_panels,
    is_revolution,
    revolution_panels,
    revolution_profile,
)
from galerna.turbine.platform import Member

SPAR = np.array([[3.25, 0.0], [3.25, -4.0], [4.7, -12.0], [4.7, -120.0], [0.0, -120.0]])
VOLUME = np.pi * (3.25**2 * 4 + 8 / 3 * (3.25**2 + 3.25 * 4.7 + 4.7**2) + 4.7**2 * 108)


def member(name, low, high, *diameters, at=(0.0, 0.0), **more):
    span = np.linspace(0.0, 1.0, len(diameters))
    sides = np.repeat(np.array(diameters)[:, None], 2, axis=1)
    return Member(name, np.array([*at, low]), np.array([*at, high]), span, sides, **more)


def stack():
    return [
        member("top", -4.0, 10.0, 6.5, 6.5),
        member("cone", -12.0, -4.0, 9.4, 6.5),
        Member("tank", np.array([0.0, 0.0, -12.0]), np.array([0.0, 0.0, -120.0]),
               np.array([0.0, 1.0]), np.full((2, 2), 9.4)),
    ]  # fmt: skip


def test_profile_of_a_stack_whatever_way_its_members_run():
    corners, axis = revolution_profile(stack())
    np.testing.assert_allclose(corners, SPAR)
    np.testing.assert_allclose(axis, 0.0)


def test_a_member_that_crosses_the_water_in_its_cone_is_cut_there():
    corners, _ = revolution_profile([member("cone", -10.0, 10.0, 8.0, 4.0)])
    np.testing.assert_allclose(corners, [[3.0, 0.0], [4.0, -10.0], [0.0, -10.0]])


def test_a_step_between_members_is_a_flat_ring():
    corners, _ = revolution_profile(
        [member("column", -20.0, 5.0, 8.0, 8.0), member("plate", -21.0, -20.0, 20.0, 20.0)]
    )
    np.testing.assert_allclose(
        corners, [[4.0, 0.0], [4.0, -20.0], [10.0, -20.0], [10.0, -21.0], [0.0, -21.0]]
    )
    panels = revolution_panels(corners, 2.0, 24)
    found = displacement(*panels.whole())
    assert found.volume == pytest.approx(np.pi * (16.0 * 20.0 + 100.0), rel=1e-12)


@pytest.mark.parametrize(
    ("members", "says"),
    [
        ([], "there are none"),
        ([member("a", -10.0, -5.0, 6.0, 6.0)], "ends below the still water"),
        ([member("a", 1.0, 5.0, 6.0, 6.0)], "no part lies below"),
        ([member("a", -4.0, 5.0, 6.0, 6.0), member("b", -9.0, -5.0, 6.0, 6.0)], "a gap"),
        (
            [member("a", -4.0, 5.0, 6.0, 6.0), member("b", -9.0, -4.0, 6.0, 6.0, at=(3.0, 0.0))],
            "member 'b'.*not a round member on the vertical axis",
        ),
        ([member("a", -4.0, 5.0, 6.0, 6.0, round=False)], "not a round member"),
    ],
)
def test_what_is_no_body_of_revolution_says_why(members, says):
    with pytest.raises(InputError, match=says):
        revolution_profile(members)
    assert not is_revolution(members)


def test_volume_and_waterplane_are_exact_for_any_number_of_sectors():
    for sectors in (12, 40):
        found = displacement(*revolution_panels(SPAR, 4.0, sectors).whole())
        assert found.volume == pytest.approx(VOLUME, rel=1e-12)
        assert found.area == pytest.approx(np.pi * 3.25**2, rel=1e-12)
        np.testing.assert_allclose(found.center[:2], 0.0, atol=1e-10)


def test_waterplane_moment_converges_with_the_fourth_power():
    exact = np.pi * 3.25**4 / 4

    def error(sectors):
        second = displacement(*revolution_panels(SPAR, 10.0, sectors).whole()).second
        assert second[0, 0] == pytest.approx(second[1, 1], rel=1e-9)
        return second[0, 0] / exact - 1.0

    assert error(16) / error(32) == pytest.approx(16.0, rel=0.05)


def test_the_oc3_spar_displaces_what_its_report_says():
    """NREL/TP-500-47535, Table 4-2: buoyancy 80,708,100 N; its C33 and C55 are 0.18 % smaller
    than those of the described circles, as an inscribed polygon of 60 sides would have it."""
    found = displacement(*revolution_panels(SPAR, 2.0, 96).whole())
    weight = 1025.0 * 9.80665
    stiffness = found.stiffness(weight, np.zeros(3))
    assert weight * found.volume == pytest.approx(80_708_100.0, rel=1e-6)
    assert stiffness[2, 2] == pytest.approx(weight * np.pi * 3.25**2, rel=1e-9)
    assert stiffness[2, 2] == pytest.approx(332_941.0, rel=2e-3)
    assert stiffness[4, 4] == pytest.approx(-4_999_180_000.0, rel=2e-3)


def test_panels_are_fine_where_potentials_bend():
    panels = revolution_panels(SPAR, 2.0, 48)
    heights = np.unique(np.round(panels.vertices[:, 2], 9))[::-1]
    steps = -np.diff(heights)
    assert steps.max() <= 2.0 * 1.1
    assert steps[0] == pytest.approx(0.1, rel=0.3)
    assert steps[-1] == pytest.approx(0.1, rel=0.3)
    neighbours = steps[1:] / steps[:-1]
    assert neighbours.min() > 0.6
    assert neighbours.max() < 1.6


def test_normals_point_into_the_water():
    vertices, faces = revolution_panels(SPAR, 4.0, 24).whole()
    a, b, c, d = np.moveaxis(vertices[faces], 1, 0)
    normal = np.cross(c - a, d - b)
    middle = (a + b + c + d) / 4.0
    outwards = np.einsum("ij,ij->i", normal, middle - [0.0, 0.0, -60.0])
    assert (outwards > 0.0).all()
    np.testing.assert_allclose(normal.sum(axis=0)[:2], 0.0, atol=1e-9)


def box(length=6.0, width=4.0, draft=3.0, at=(2.0, -1.0)):
    x, y = length / 2, width / 2
    top = np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]], float)
    vertices = np.append(top, top - [0, 0, draft], axis=0) + np.array([*at, 0.0])
    faces = np.array([[0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0], [4, 7, 6, 5]])
    return vertices, faces


def test_a_box_that_stands_aside():
    """Closed forms of every term, about a point that is not above its centre."""
    found = displacement(*box())
    weight, point = 10.0, np.array([0.5, 0.25, 2.0])
    stiffness = found.stiffness(weight, point)
    volume, area = 6.0 * 4.0 * 3.0, 24.0
    x, y, z = 2.0 - 0.5, -1.0 - 0.25, -1.5 - 2.0
    assert found.volume == pytest.approx(volume)
    np.testing.assert_allclose(found.center, [2.0, -1.0, -1.5])
    wanted = np.zeros((6, 6))
    wanted[2, 2] = area
    wanted[2, 3] = wanted[3, 2] = area * y
    wanted[2, 4] = wanted[4, 2] = -area * x
    wanted[3, 3] = 6.0 * 4.0**3 / 12 + area * y * y + volume * z
    wanted[4, 4] = 4.0 * 6.0**3 / 12 + area * x * x + volume * z
    wanted[3, 4] = wanted[4, 3] = -area * x * y
    wanted[3, 5], wanted[4, 5] = -volume * x, -volume * y
    np.testing.assert_allclose(stiffness, weight * wanted, atol=1e-9)


def test_triangles_are_panels_too():
    vertices, quads = box()
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    panels = hull_panels(vertices, triangles)
    assert panels.count == 10
    assert displacement(*panels.whole()).volume == pytest.approx(72.0)


def test_sizes_that_make_no_mesh():
    with pytest.raises(InputError, match=r"size 0 m and 4 sectors"):
        revolution_panels(SPAR, 0.0, 4)
