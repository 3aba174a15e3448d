"""Edges of panels: the named spacings, given ones, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from galerna.aero.vortex.spacing import SPACINGS, given_edges, panel_edges
from galerna.errors import InputError


@pytest.mark.parametrize("spacing", SPACINGS)
def test_edges_rise_from_0_to_1_exactly(spacing: str) -> None:
    edges = panel_edges("spanwise", 7, spacing)
    assert len(edges) == 8
    assert (edges[0], edges[-1]) == (0.0, 1.0)
    assert np.all(np.diff(edges) > 0.0)


def test_half_sine_is_the_dissertations_and_nests() -> None:
    fine, coarse = (
        panel_edges("spanwise", 28, "half_sine"),
        panel_edges("spanwise", 14, "half_sine"),
    )
    assert fine[7] == pytest.approx(np.sin(np.radians(22.5)))
    assert np.array_equal(fine[::2], coarse)


def test_cosine_is_the_same_from_both_ends() -> None:
    edges = panel_edges("spanwise", 9, "cosine")
    assert edges + edges[::-1] == pytest.approx(np.ones(10))
    assert edges[1] == pytest.approx(0.5 - 0.5 * np.cos(np.pi / 9))


def test_given_edges_are_taken_as_they_are() -> None:
    assert np.array_equal(panel_edges("chordwise", [0.0, 0.1, 1.0]), [0.0, 0.1, 1.0])
    assert np.array_equal(given_edges("spanwise", [0.2, 0.5]), [0.2, 0.5])


@pytest.mark.parametrize("panels", [0, -3, 2.5, True, "8"])
def test_a_number_of_panels_that_is_none_is_refused(panels: object) -> None:
    with pytest.raises(InputError, match="chordwise"):
        panel_edges("chordwise", panels)


@pytest.mark.parametrize(
    "edges", [[0.0], [0.0, 0.5, 0.5, 1.0], [0.0, np.nan, 1.0], [-0.1, 1.0], [0.0, 1.1], [0.1, 1.0]]
)
def test_edges_that_do_not_rise_from_0_to_1_are_refused(edges: list[float]) -> None:
    with pytest.raises(InputError, match="spanwise"):
        panel_edges("spanwise", edges)


def test_an_unknown_spacing_is_answered_with_the_nearest() -> None:
    with pytest.raises(InputError, match="half_sine"):
        panel_edges("spanwise", 4, "halfsine")
