"""A vortex ring moves itself: the speed that the core gives it, and a steady travel."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from galerna.aero.vortex.field import InducedField
from galerna.aero.vortex.sheet import Sheet
from galerna.contract import Array

RADIUS, CIRCULATION = 1.0, 1.0


def speed_of_the_core(core: float) -> float:
    """Of a thin ring whose elements have the core of `biot_savart` about their tangents.

    The element at the angle theta induces G (1 - cos theta) / (4 pi R 8 sin^3(theta/2)) along the
    axis, times d^2 / sqrt(d^4 + r_c^4) with the distance d = R (1 - cos theta) to its tangent.
    """

    def element(theta: float) -> float:
        sine = np.sin(0.5 * theta)
        d = 2.0 * RADIUS * sine**2
        return 0.5 / sine * d**2 / np.sqrt(d**4 + core**4)

    whole = quad(element, 0.0, 0.3, limit=200)[0] + quad(element, 0.3, np.pi)[0]
    return CIRCULATION / (4.0 * np.pi * RADIUS) * whole


def ring_sheet(ring: Array, core: float) -> Sheet:
    """The ring as the first row of a sheet whose other row is far away."""
    vertices = np.stack([ring, ring + np.array([1e5, 0.0, 0.0])])
    return Sheet(vertices, np.full((1, len(ring) - 1), CIRCULATION), core)


def circle(segments: int) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, segments + 1)
    angle[-1] = 0.0
    return RADIUS * np.stack([np.zeros_like(angle), np.cos(angle), np.sin(angle)], axis=1)


@pytest.mark.parametrize("core", [0.02, 0.1])
def test_a_ring_moves_at_the_speed_of_its_core(core: float) -> None:
    errors = []
    for segments in (200, 400):
        velocity = InducedField([ring_sheet(circle(segments), core)]).velocity(circle(segments))
        assert np.abs(velocity - velocity[0]).max() < 1e-9
        errors.append(abs(abs(velocity[0, 0]) / speed_of_the_core(core) - 1.0))
    assert errors[1] < 2e-3
    assert errors[1] < 0.6 * errors[0]


def test_a_ring_keeps_its_radius_and_speed_while_it_travels() -> None:
    ring, step = circle(100), 0.1
    start, past, speeds = ring.copy(), None, []
    for _ in range(40):
        velocity = InducedField([ring_sheet(ring, 0.1)]).velocity(ring)
        ring = ring + step * (velocity if past is None else 1.5 * velocity - 0.5 * past)
        past = velocity
        speeds.append(velocity[:, 0].mean())
    travelled = abs(ring[0, 0] - start[0, 0])
    assert travelled == pytest.approx(4.0 * speed_of_the_core(0.1), rel=0.01)
    assert np.hypot(ring[:, 1], ring[:, 2]) == pytest.approx(np.full(101, RADIUS), rel=1e-6)
    assert np.ptp(speeds) < 1e-6 * abs(speeds[0])
