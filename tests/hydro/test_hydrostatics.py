"""Buoyancy of boxes, cylinders and spheres in closed form; its tangent; its potential."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from galerna.contract import Motion
from galerna.errors import InputError
from galerna.hydro.hull import Hull, build_hull
from galerna.hydro.hydrostatics import Hydrostatics, NonlinearBuoyancy, hydrostatics
from galerna.hydro.platform_options import PlatformOptions
from galerna.hydro.potential_flow import PotentialFlow
from galerna.structure.frames import exp_so3, log_so3, rotation_about
from galerna.turbine import load
from galerna.turbine.platform import Member, Platform

from .analytic_database import spar_like

WEIGHT = 1025.0 * 9.80665
ORIGIN = np.zeros(3)
UPRIGHT = np.eye(3)


def box(width: float, depth: float, draft: float, height: float, x: float = 0.0) -> Hull:
    """An upright box: sides along x and y, from ``-draft`` up by ``height``."""
    start, end = np.array([x, 0.0, -draft]), np.array([x, 0.0, height - draft])
    sides = np.array([[width, depth]] * 2)
    return build_hull([Member("box", start, end, np.array([0.0, 1.0]), sides, round=False)])


def sphere(radius: float, rings: int) -> Hull:
    """Meridians and parallels, every vertex on the sphere."""
    polar = np.linspace(0.0, np.pi, rings + 1)[1:-1]
    around = np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False)
    ring = np.stack([np.cos(around), np.sin(around), np.ones_like(around)], axis=1)
    scale = np.stack([np.sin(polar), np.sin(polar), -np.cos(polar)], axis=1)
    vertices = (scale[:, None] * ring).reshape(-1, 3)
    vertices = radius * np.concatenate([vertices, [[0, 0, -1], [0, 0, 1]]])
    n, i = len(around), np.arange(len(around))
    j = np.roll(i, -1)
    bands = [
        np.stack(t, axis=1) + k * n
        for k in range(rings - 2)
        for t in ((i, j, j + n), (i, j + n, i + n))
    ]
    last, south = (rings - 2) * n, len(vertices) - 2
    caps = [np.stack([0 * i + south, j, i], axis=1), np.stack([0 * i + south + 1, i, j], axis=1)]
    caps[1][:, 1:] += last
    return Hull(vertices, np.concatenate(bands + caps))


def tilted(*angles: float) -> np.ndarray:
    return exp_so3(np.array(angles))


# closed forms ----------------------------------------------------------------------------


def test_a_box_upright() -> None:
    found = hydrostatics(box(8.0, 4.0, 2.0, 5.0, x=3.0))
    assert found.volume == pytest.approx(64.0)
    assert found.center_of_buoyancy == pytest.approx([3.0, 0.0, -1.0], abs=1e-12)
    assert found.area == pytest.approx(32.0)
    assert found.center_of_flotation == pytest.approx([3.0, 0.0], abs=1e-12)
    sxx, syy = 32.0 * (64.0 / 12.0 + 9.0), 32.0 * 16.0 / 12.0
    assert found.moments == pytest.approx([sxx, syy, 0.0], abs=1e-9)
    expected = np.zeros((6, 6))
    expected[2, 2] = 32.0
    expected[2, 4] = expected[4, 2] = -32.0 * 3.0
    expected[3, 3], expected[4, 4] = syy - 64.0, sxx - 64.0
    expected[3, 5] = -64.0 * 3.0
    assert found.stiffness == pytest.approx(WEIGHT * expected, abs=1e-6)


def test_another_reference_point_moves_the_moments() -> None:
    found = hydrostatics(box(8.0, 4.0, 2.0, 5.0), reference_point=(1.0, 0.0, -2.0))
    assert found.center_of_buoyancy == pytest.approx([0.0, 0.0, -1.0], abs=1e-12)
    assert found.stiffness[2, 4] == pytest.approx(WEIGHT * 32.0)
    assert found.stiffness[3, 3] == pytest.approx(WEIGHT * (32.0 * 16.0 / 12.0 + 64.0))


@pytest.mark.parametrize("angle", [0.1, -0.4])
def test_a_box_heels_as_wall_sided_ships_do(angle: float) -> None:
    """About the waterplane's centre V stays; the centre of buoyancy moves by I/V (tan, tan^2/2)."""
    hull = box(8.0, 4.0, 2.0, 6.0)
    rotation = rotation_about(0, angle)
    wrench, _ = NonlinearBuoyancy(hull).loads(ORIGIN, rotation)
    metacentric = 32.0 * 16.0 / 12.0 / 64.0
    tangent = np.tan(angle)
    center = rotation @ [0.0, -metacentric * tangent, -1.0 + metacentric * tangent**2 / 2.0]
    force = np.array([0.0, 0.0, WEIGHT * 64.0])
    assert wrench[:3] == pytest.approx(force, rel=1e-12)
    assert wrench[3:] == pytest.approx(np.cross(center, force), rel=1e-12, abs=1e-6)


@pytest.mark.parametrize("height", [-1.5, 0.0, 0.7])
def test_a_sphere_converges_with_the_square_of_its_facets(height: float) -> None:
    """Volume of a cap, waterplane of a circle, no moment about the centre."""
    radius = 2.0
    depth = radius - height
    volume = np.pi * depth**2 * (3.0 * radius - depth) / 3.0
    errors = []
    for rings in (16, 32):
        wrench, K = NonlinearBuoyancy(sphere(radius, rings)).loads(
            np.array([3.0, 1.0, height]), tilted(0.3, -0.2, 0.5)
        )
        area = np.pi * (radius**2 - height**2)
        errors.append([wrench[2] / WEIGHT / volume - 1.0, K[2, 2] / WEIGHT / area - 1.0])
        assert np.abs(wrench[3:]).max() < 1e-2 * WEIGHT * volume
    assert np.abs(errors[-1]).max() < 0.01
    assert np.divide(*errors) == pytest.approx([4.0, 4.0], rel=0.12)


def test_the_spar_of_oc3() -> None:
    """Frustum and cylinders in closed form; NREL/TP-500-47535, Table 4-2: 80,708,100 N."""
    found = hydrostatics(build_hull(load("nrel5mw_oc3").platform.members))
    top, bottom = np.pi * 3.25**2, np.pi * 4.7**2
    mean = np.pi * (3.25**2 + 3.25 * 4.7 + 4.7**2) / 3.0
    volume = 4.0 * top + 8.0 * mean + 108.0 * bottom
    assert found.volume == pytest.approx(volume, rel=1e-12)
    assert WEIGHT * found.volume == pytest.approx(80708100.0, rel=1e-6)
    assert found.stiffness[2, 2] == pytest.approx(WEIGHT * top, rel=1e-12)
    assert found.stiffness[2, 2] == pytest.approx(332941.0, rel=2e-3)
    assert found.stiffness[4, 4] == pytest.approx(-4.99918e9, rel=2e-3)


# anywhere ----------------------------------------------------------------------------------


def test_submerged_and_dry() -> None:
    hull = box(8.0, 4.0, 2.0, 5.0)
    buoyancy = NonlinearBuoyancy(hull)
    wrench, K = buoyancy.loads(np.array([0.0, 0.0, -20.0]), tilted(0.2, 0.4, 0.1))
    assert wrench[:3] == pytest.approx([0.0, 0.0, WEIGHT * 160.0])
    assert K[2] == pytest.approx(np.zeros(6), abs=1e-6)
    wrench, K = buoyancy.loads(np.array([0.0, 0.0, 20.0]), tilted(0.2, 0.4, 0.1))
    assert not wrench.any()
    assert not K.any()


@pytest.mark.parametrize("height", [-3.5, -1.0, 0.0, 1.5])
def test_the_tangent_is_the_rate_of_the_load(height: float) -> None:
    """Heeled until the deck is awash and a corner of the keel is out."""
    buoyancy = NonlinearBuoyancy(box(8.0, 4.0, 2.0, 5.0, x=1.0), (0.5, -0.5, 1.0))
    position, rotation = np.array([2.0, 1.0, height]), tilted(0.3, 0.5, -0.4)
    _, K = buoyancy.loads(position, rotation)
    step = 1e-5
    for i, direction in enumerate(np.eye(6)):
        ends = [
            buoyancy.loads(
                position + s * step * direction[:3], exp_so3(s * step * direction[3:]) @ rotation
            )[0]
            for s in (1.0, -1.0)
        ]
        rate = (ends[0] - ends[1]) / (2.0 * step)
        assert -rate == pytest.approx(K[:, i], abs=1e-7 * np.abs(K).max())


def test_no_work_around_a_closed_path() -> None:
    """The path heels far enough that the deck comes under and the keel comes out."""
    buoyancy = NonlinearBuoyancy(box(8.0, 4.0, 2.0, 5.0, x=1.0))
    phases = np.linspace(0.0, 2.0 * np.pi, 801)
    path = [
        (
            np.array([np.sin(t), np.cos(t), 1.5 * np.sin(t + 1.0)]),
            tilted(0.7 * np.sin(t), 0.6 * np.cos(t), 0.3 * np.sin(2.0 * t)),
        )
        for t in phases
    ]
    work = largest = 0.0
    for (x0, R0), (x1, R1) in pairwise(path):
        turn = log_so3(R1 @ R0.T)
        wrench, _ = buoyancy.loads(0.5 * (x0 + x1), exp_so3(0.5 * turn) @ R0)
        work += wrench @ np.concatenate([x1 - x0, turn])
        largest = max(largest, abs(work))
    assert abs(work) < 1e-5 * largest


def linear_loads(still: Hydrostatics, reference: np.ndarray, position, rotation) -> np.ndarray:
    """What the platform's linear model makes of a hull's hydrostatics."""
    base = spar_like(
        hydrostatic_stiffness=still.stiffness,
        displaced_volume=still.volume,
        center_of_buoyancy=still.center_of_buoyancy,
        reference_point=reference,
    )
    body = Platform(tuple(reference), 1.0, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    motion = Motion.at_rest(1)
    motion.position[0], motion.rotation[0] = position, rotation
    loads = PotentialFlow(body, base, options=PlatformOptions(radiation="none")).static_loads(
        motion
    )
    return np.concatenate([loads.force[0], loads.moment[0]])


@pytest.mark.parametrize("yaw", [0.0, 0.8, -2.9])
def test_linear_buoyancy_is_the_limit_of_small_lean_at_any_yaw(yaw: float) -> None:
    hull = box(8.0, 4.0, 2.0, 5.0, x=1.0)
    reference = np.array([0.5, -0.5, 1.0])
    still, exact = hydrostatics(hull, reference), NonlinearBuoyancy(hull, reference)
    moved, turned = np.array([0.3, 0.2, 0.1]), np.array([0.05, 0.04, 0.03])
    errors = []
    for scale in (1.0, 0.5, 0.25):
        at = reference + scale * moved, exp_so3(scale * turned) @ rotation_about(2, yaw)
        errors.append(np.linalg.norm(linear_loads(still, reference, *at) - exact.loads(*at)[0]))
    assert errors[0] < 0.01 * WEIGHT * still.volume
    assert np.divide(errors[:-1], errors[1:]) == pytest.approx([4.0, 4.0], rel=0.1)
    at = reference, rotation_about(2, yaw)
    assert linear_loads(still, reference, *at) == pytest.approx(exact.loads(*at)[0], abs=1e-6)


def test_a_dry_hull_has_no_hydrostatics() -> None:
    with pytest.raises(InputError, match=r"displaces nothing; its lowest point is at z = 1 m"):
        hydrostatics(box(8.0, 4.0, -1.0, 5.0))
