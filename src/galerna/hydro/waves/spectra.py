"""Spectra of the sea's elevation: one-sided densities over the angular frequency."""

from __future__ import annotations

from math import exp, log, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array


def default_peak_enhancement(significant_height: float, peak_period: float) -> float:
    """Peak enhancement of IEC 61400-3 for a height m and a period s: between 1 and 5."""
    ratio = peak_period / sqrt(significant_height)
    if ratio <= 3.6:
        return 5.0
    return exp(5.75 - 1.15 * ratio) if ratio <= 5.0 else 1.0


def jonswap(
    frequency: ArrayLike, significant_height: float, peak_period: float, peak_enhancement: float
) -> Array:
    """Density (n,) m2 s/rad at frequencies (n,) rad/s (IEC 61400-3; Hasselmann et al., 1973).

    Its integral is Hs^2/16 within 0.5 % for a ``peak_enhancement`` of 1 to 5: the factor
    1 - 0.287 ln(gamma) is a fit.
    """
    w, peak = np.asarray(frequency, dtype=float), 2.0 * pi / peak_period
    x = np.maximum(w / peak, 1e-2)
    width = np.where(x <= 1.0, 0.07, 0.09)
    enhanced = peak_enhancement ** np.exp(-0.5 * ((x - 1.0) / width) ** 2)
    scale = 0.3125 * significant_height**2 / peak * (1.0 - 0.287 * log(peak_enhancement))
    return np.asarray(scale * x**-5.0 * np.exp(-1.25 * x**-4.0) * enhanced)


def pierson_moskowitz(frequency: ArrayLike, significant_height: float, peak_period: float) -> Array:
    """The same for a fully developed sea (Pierson and Moskowitz, 1964); integral Hs^2/16."""
    return jonswap(frequency, significant_height, peak_period, 1.0)


def share_left_out(lowest: float, highest: float, peak: float) -> tuple[float, float]:
    """Shares of the variance of Pierson and Moskowitz below and above two frequencies rad/s.

    With a peak enhancement above 1 both are smaller.
    """

    def below(frequency: float) -> float:
        return exp(-1.25 * (peak / frequency) ** 4) if frequency > 0.05 * peak else 0.0

    return below(lowest), 1.0 - below(highest)
