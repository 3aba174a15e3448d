"""Reduced frequencies along the span: where the air around a section has time to settle."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galerna.errors import InputError

Array = NDArray[np.float64]

QUASI_STEADY_LIMIT = 0.05  #: below it attached flow is quasi-steady (dissertation 4.2.3)
HIGHLY_UNSTEADY_LIMIT = 0.6  #: above it attached flow is highly unsteady


def reduced_frequency(
    frequency: ArrayLike,
    radius: ArrayLike,
    chord: ArrayLike,
    wind_speed: float,
    rotor_speed: float,
) -> Array:
    """k = omega c / (2 u_r) with u_r^2 = U^2 + (rotor_speed r)^2; dissertation eq. 4.15.

    ``frequency`` (...,) Hz; ``radius`` and ``chord`` (n,) m; ``wind_speed`` m/s;
    ``rotor_speed`` rad/s. Returns (..., n). Raises InputError where nothing moves.
    """
    relative = np.hypot(wind_speed, rotor_speed * np.asarray(radius, dtype=float))
    if not np.all(relative > 0.0):
        raise InputError("reduced frequency", "the relative speed is zero: no wind and no rotation")
    omega = 2.0 * np.pi * np.asarray(frequency, dtype=float)
    return omega[..., None] * np.asarray(chord, dtype=float) / (2.0 * relative)


def blade_passing_frequencies(rotor_speed: float, harmonics: ArrayLike = (1.0, 3.0)) -> Array:
    """Frequencies Hz of the multiples of the rotor's speed rad/s, 1P and 3P unless said."""
    return np.asarray(harmonics, dtype=float) * rotor_speed / (2.0 * np.pi)


def peak_frequency(frequency: ArrayLike, density: ArrayLike) -> float:
    """Frequency Hz at which f S(f), the spectrum's energy per octave, is largest.

    ``frequency`` (m,) Hz > 0 and the power spectral ``density`` (m,). Raises InputError for
    a spectrum without energy.
    """
    f, s = np.asarray(frequency, dtype=float), np.asarray(density, dtype=float)
    if f.shape != s.shape or not np.all(np.isfinite(s)) or not np.any(f * s > 0.0):
        raise InputError("spectrum", "one finite density per frequency and some energy needed")
    return float(f[np.argmax(f * s)])


def energy_fractions(
    frequency: ArrayLike,
    density: ArrayLike,
    radius: ArrayLike,
    chord: ArrayLike,
    wind_speed: float,
    rotor_speed: float,
) -> Array:
    """Shares (n,3) of a spectrum's energy that a station meets below QUASI_STEADY_LIMIT,
    between the limits, and above HIGHLY_UNSTEADY_LIMIT.

    Arguments as in ``reduced_frequency`` with ``density`` (m,) of the velocity at the
    blade; the integral is trapezoidal over the given frequencies.
    """
    f, s = np.asarray(frequency, dtype=float), np.asarray(density, dtype=float)
    peak_frequency(f, s)
    steps = np.diff(f)
    cumulative = np.concatenate(([0.0], np.cumsum(0.5 * steps * (s[1:] + s[:-1]))))
    per_hertz = reduced_frequency(1.0, radius, chord, wind_speed, rotor_speed)
    limits = np.array([QUASI_STEADY_LIMIT, HIGHLY_UNSTEADY_LIMIT]) / per_hertz[:, None]
    below = np.interp(limits, f, cumulative) / cumulative[-1]
    return np.stack([below[:, 0], below[:, 1] - below[:, 0], 1.0 - below[:, 1]], axis=1)
