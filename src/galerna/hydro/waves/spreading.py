"""Directions of a short-crested sea: one for each frequency."""

from __future__ import annotations

from math import gamma, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import betaincinv

from galerna.contract import Array

_GOLDEN = 0.5 * (sqrt(5.0) - 1.0)


def density(angle: ArrayLike, exponent: float) -> Array:
    """Density 1/rad of directions at angles (n,) rad from the main one, -pi to pi.

    cos^2s of half the angle (Longuet-Higgins, Cartwright and Smith, 1963), ``exponent`` s.
    """
    scale = gamma(exponent + 1.0) / (2.0 * sqrt(pi) * gamma(exponent + 0.5))
    return np.asarray(scale * np.abs(np.cos(0.5 * np.asarray(angle))) ** (2.0 * exponent))


def quantile(share: ArrayLike, exponent: float) -> Array:
    """The angle (n,) rad from the main direction below which a ``share`` (n,) of it stands.

    The squared sine of half the angle follows a beta distribution, (1/2, s + 1/2).
    """
    centred = 2.0 * np.asarray(share) - 1.0
    sine = np.sqrt(betaincinv(0.5, exponent + 0.5, np.abs(centred)))
    return np.asarray(2.0 * np.sign(centred) * np.arcsin(sine))


def directions(n: int, main: float, exponent: float, generator: np.random.Generator) -> Array:
    """Directions (n,) rad of n neighbouring frequencies, distributed about ``main`` rad.

    Each frequency has one, so that no two waves of a frequency stand in a fixed pattern and
    the sea is the same everywhere (Jefferys, 1987). Shares follow each other by the golden
    section from a random start: already a few neighbours cover the distribution.
    """
    share = (generator.random() + _GOLDEN * np.arange(n)) % 1.0
    return main + quantile(share, exponent)
