"""Sums over all waves as periodic tables over time: a step costs the same for any number."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import fft

from galerna.contract import Array

Complex = NDArray[np.complex128]
Table = NDArray[np.float32]

FAST = {"reassoc", "contract", "arcp", "nsz", "afn"}

TOLERANCE = 3e-4  #: standard deviation of the interpolation error over that of the series
_CUBIC = 9.0 / 384.0  #: largest error of four-point interpolation over (w h)^4
_FEWEST = 16  #: samples of a table


@dataclass(frozen=True, eq=False)
class Series:
    """k quantities over time: ``table`` (N,k) over one period, ``step`` s apart from t = 0.

    Between the samples it is a cubic through four of them. From t = 0 it grows over ``ramp`` s.
    """

    table: Table
    step: float
    ramp: float

    def at(self, time: float) -> Array:
        """Values (k,) at a time s."""
        out = np.empty(self.table.shape[1])
        sample(self.table, time / self.step, growth(time, self.ramp), out)
        return out

    def over(self, times: Array) -> Array:
        """Values (m,k) at times (m,) s."""
        return np.stack([self.at(float(time)) for time in times])


@njit(cache=True, error_model="numpy")
def growth(time: float, ramp: float) -> float:
    """From 0 at t = 0 to 1 at ``ramp`` s, with two continuous derivatives."""
    if ramp <= 0.0:
        return 1.0
    s = min(max(time / ramp, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def cubic(s: float) -> tuple[float, float, float, float]:
    """Weights at ``s`` of samples at -1, 0, 1 and 2."""
    a, b, c = s + 1.0, s - 1.0, s - 2.0
    return -s * b * c / 6.0, 0.5 * a * b * c, -0.5 * a * s * c, a * s * b / 6.0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def sample(table: Table, position: float, factor: float, out: Array) -> None:
    """Fill ``out`` (k,) with ``factor`` times a periodic table (N,k) at a position in samples."""
    n = len(table)
    first = np.floor(position)
    w0, w1, w2, w3 = cubic(position - first)
    w0, w1, w2, w3 = factor * w0, factor * w1, factor * w2, factor * w3
    i = int(first) % n
    r0, r1 = table[(i - 1) % n], table[i]
    r2, r3 = table[(i + 1) % n], table[(i + 2) % n]
    for k in range(len(out)):
        out[k] = w0 * r0[k] + w1 * r1[k] + w2 * r2[k] + w3 * r3[k]


def samples_needed(weight: Array, frequency: Array, order: NDArray[np.int64], period: float) -> int:
    """Samples over a period s with which every column meets ``TOLERANCE``.

    ``weight`` (n,k) holds the squared amplitudes at frequencies (n,) rad/s.
    """
    total = weight.sum(axis=0)
    felt = total > 0.0
    if not felt.any():
        return _FEWEST
    eighth = np.max((frequency**8 @ weight)[felt] / total[felt]) ** 0.125
    step = (TOLERANCE / _CUBIC) ** 0.25 / eighth
    least = max(period / step, 2.0 * order.max() + 2.0, _FEWEST)
    return int(fft.next_fast_len(int(np.ceil(least)), real=True))


def tabulate(spectrum: Complex, order: NDArray[np.int64], samples: int) -> Table:
    """Table (N,k) of Re sum_j c_j exp(2 pi i m_j t / T), amplitudes (n,k) and orders (n,)."""
    table = np.empty((samples, spectrum.shape[1]), dtype=np.float32)
    for k, column in enumerate(spectrum.T):
        half = np.zeros(samples // 2 + 1, dtype=complex)
        half[order] = 0.5 * column
        table[:, k] = fft.irfft(half, samples, norm="forward")
    return table
