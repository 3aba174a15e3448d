"""What the generators of turbulence boxes share: the seed and the checks of their arguments."""

from __future__ import annotations

import math

import numpy as np

from galerna.errors import InputError


def random_generator(seed: int) -> np.random.Generator:
    """Generator for a seed of either sign; the same seed gives the same numbers."""
    entropy = [abs(int(seed)), int(seed < 0)]
    return np.random.Generator(np.random.Philox(np.random.SeedSequence(entropy)))


def require_positive(where: str, **figures: float) -> None:
    """Raise InputError unless every figure is finite and greater than zero."""
    for name, value in figures.items():
        if not (math.isfinite(value) and value > 0.0):
            label = name.replace("_", " ")
            raise InputError(where, f"{label} is {value:g}, expected a positive number")


def require_one(where: str, **figures: float | None) -> None:
    """Raise InputError unless exactly one of the figures is given."""
    given = [name for name, value in figures.items() if value is not None]
    if len(given) != 1:
        found = " and ".join(given) if given else "none"
        raise InputError(where, f"expected one of {', '.join(figures)}, found {found}")


def require_shape(where: str, shape: tuple[int, int, int]) -> None:
    """Raise InputError unless a box of this shape can be made: nx even and at least 4."""
    if len(shape) != 3 or shape[0] < 4 or shape[0] % 2 or min(shape[1:]) < 2:
        raise InputError(
            where,
            f"shape is {tuple(shape)}, expected (nx, ny, nz) with nx even and at least 4, "
            "ny and nz at least 2",
        )
