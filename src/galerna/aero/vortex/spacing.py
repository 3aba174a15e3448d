"""How panels share a length: places of their edges between 0 and 1."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError, did_you_mean


def uniform(panels: int) -> Array:
    """Equal panels."""
    return np.linspace(0.0, 1.0, panels + 1)


def half_sine(panels: int) -> Array:
    """Panels that grow ever smaller towards 1, where a blade's tip is (dissertation eq. 3.10)."""
    return np.append(np.sin(0.5 * np.pi * np.arange(panels) / panels), 1.0)


def cosine(panels: int) -> Array:
    """Panels that grow smaller towards both ends, as a wing with two tips wants them."""
    return np.append(0.5 - 0.5 * np.cos(np.pi * np.arange(panels) / panels), 1.0)


SPACINGS = {"uniform": uniform, "half_sine": half_sine, "cosine": cosine}


def panel_edges(where: str, panels: int | ArrayLike, spacing: str = "uniform") -> Array:
    """Edges (n+1,) that rise from 0 to 1: of a number of panels, or checked as they are given.

    ``where`` names the argument in an InputError: no panels, an unknown spacing, or given
    edges that do not rise from 0 to 1.
    """
    edges = given_edges(where, panels) if np.ndim(panels) else _spaced(where, panels, spacing)
    if edges[0] != 0.0 or edges[-1] != 1.0:
        raise InputError(where, f"edges go from {edges[0]:g} to {edges[-1]:g}, not from 0 to 1")
    return edges


def given_edges(where: str, edges: ArrayLike) -> Array:
    """Edges (n+1,) that rise within 0 and 1, or InputError."""
    edges = np.array(edges, dtype=float)
    inside = edges.ndim == 1 and len(edges) > 1 and edges[0] >= 0.0 and edges[-1] <= 1.0
    if not inside or not np.all(np.diff(edges) > 0.0):
        raise InputError(where, "at least two edges that rise within 0 and 1 are needed")
    return edges


def _spaced(where: str, panels: object, spacing: str) -> Array:
    if isinstance(panels, bool) or not isinstance(panels, (int, np.integer)) or panels < 1:
        raise InputError(where, f"expected a number of panels from 1, found {panels!r}")
    if spacing not in SPACINGS:
        raise InputError(
            f"spacing of {where}", f"{spacing!r} is unknown", did_you_mean(spacing, SPACINGS)
        )
    return SPACINGS[spacing](int(panels))
