"""Covariance of the Fourier modes of a box, for Mann's tensor on a coarse lateral grid.

A box is long against the length scale L, but seldom wide. So the tensor is not
sampled at the modes (k2, k3) but integrated over the cell of wavenumbers around
each: the modes of one k1 then hold the whole one-point spectrum at k1, however
narrow the box, and the coherence at a distance r keeps the share
sin(pi r/W)/(pi r/W) of the first period W, with its images making up for what a
long correlation loses. Mann (1998) section 4 has the same idea with sinc^2 in
place of the cell. What a cell cannot hold is the phase between heights where k1 is
below its width: there the lean of the eddies is lost.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.contract import Array
from galerna.inflow.mann_tensor import FAST, sheared_tensor
from galerna.inflow.spectra import mann_spectra

Factor = NDArray[np.float32]


@cache
def _gauss_points(count: int) -> tuple[NDArray, Array, Array, Array]:
    """Where each cell's points start (count + 1,), their cells, places in (-1, 1) and weights.

    Cells in the order of ``numpy.fft.fftfreq``; the nearer to zero, the more points.
    """
    cells = np.fft.fftfreq(count, 1.0 / count)
    away = np.abs(cells)
    numbers = np.select([away < 1, away < 4, away < 12], [24, 4, 2], 1)
    rules = {n: np.polynomial.legendre.leggauss(n) for n in np.unique(numbers)}
    start = np.concatenate([[0], np.cumsum(numbers)])
    places, weights = (np.concatenate([rules[n][i] for n in numbers]) for i in (0, 1))
    return start, np.repeat(cells, numbers), places, weights


def axis_quadrature(count: int, width: float, finest: float) -> tuple[NDArray, Array, Array]:
    """Gauss points of every cell of one axis, in the order of ``numpy.fft.fftfreq``.

    Returns where each cell's points start (count + 1,), the points and their weights
    (n,), in the unit of ``width``, the cells' own. The points crowd around zero,
    k = c sinh(s) with c = ``finest``, as the tensor has detail at k2, k3 ~ k1.
    """
    start, cell, place, weight = _gauss_points(count)
    low, high = (np.arcsinh((cell + edge) * width / finest) for edge in (-0.5, 0.5))
    s = 0.5 * (low + high) + 0.5 * (high - low) * place
    return start, finest * np.sinh(s), 0.5 * (high - low) * weight * finest * np.cosh(s)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _cells(k1: float, gamma: float, y: tuple, z: tuple, out: Array) -> None:
    """Add the tensor's integral over each lateral cell to ``out`` (6,ny,nz)."""
    y_start, y_point, y_weight = y
    z_start, z_point, z_weight = z
    for j in range(len(y_start) - 1):
        for l in range(len(z_start) - 1):
            for m in range(y_start[j], y_start[j + 1]):
                for n in range(z_start[l], z_start[l + 1]):
                    weight = y_weight[m] * z_weight[n]
                    tensor = sheared_tensor(k1, y_point[m], z_point[n], gamma)
                    for c in range(6):
                        out[c, j, l] += weight * tensor[c]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _aliases(k1: float, gamma: float, y: Array, z: Array, widths: tuple, out: Array) -> None:
    """Add the first ring of wavenumbers that look the same on the grid to ``out`` (6,ny,nz)."""
    for j in range(len(y)):
        for l in range(len(z)):
            for m in range(-1, 2):
                for n in range(-1, 2):
                    if m == 0 and n == 0:
                        continue
                    k2 = y[j] + m * len(y) * widths[0]
                    k3 = z[l] + n * len(z) * widths[1]
                    tensor = sheared_tensor(k1, k2, k3, gamma)
                    for c in range(6):
                        out[c, j, l] += widths[0] * widths[1] * tensor[c]


@njit(cache=True, error_model="numpy")
def _factors(cells: Array, out: Factor) -> None:
    """Lower triangular factors of (6,ny,nz) in the order 11, 21, 31, 22, 32, 33.

    A direction without energy of its own gets a column of zeros.
    """
    for j in range(cells.shape[1]):
        for l in range(cells.shape[2]):
            uu, vv, ww, uv, uw, vw = cells[:, j, l]
            nothing = 1e-12 * (uu + vv + ww)
            a = math.sqrt(uu) if uu > nothing else 0.0
            b, c = (uv / a, uw / a) if a > 0.0 else (0.0, 0.0)
            rest = vv - b * b
            d = math.sqrt(rest) if rest > nothing else 0.0
            e = (vw - b * c) / d if d > 0.0 else 0.0
            f = math.sqrt(max(ww - c * c - e * e, 0.0))
            out[0, j, l], out[1, j, l], out[2, j, l] = a, b, c
            out[3, j, l], out[4, j, l], out[5, j, l] = d, e, f


class LateralModes:
    """Factors of the covariance of the lateral modes at any k1, for L = 1.

    ``shape`` (ny, nz) modes; ``period`` (y, z) and ``spacing`` (x, y, z) in length
    scales. With ``point_values`` the box holds the wind at points: what a lateral
    grid cannot tell from its modes is added to them, so that the spectrum at a
    point is the theory's up to the highest k1. Without, it holds means over cells.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        period: tuple[float, float],
        spacing: tuple[float, float, float],
        shear_parameter: float,
        point_values: bool,
    ) -> None:
        self.shape, self.spacing = shape, spacing
        self.shear_parameter, self.point_values = shear_parameter, point_values
        self.width = (2.0 * math.pi / period[0], 2.0 * math.pi / period[1])
        self.k2, self.k3 = (
            np.asarray(2.0 * math.pi * np.fft.fftfreq(n, p / n), dtype=np.float64)
            for n, p in zip(shape, period, strict=True)
        )

    def factors(self, k1: float, k1_width: float) -> Factor:
        """Factors (6,ny,nz) of the mean covariance over ``k1_width`` around ``k1``.

        They stand for E[X X^T] of the modes X with unit k1 width. The wavenumber counts
        in the order of arrival of the planes, so along x it is ``-k1``.
        """
        half = 0.5 * k1_width / math.sqrt(3.0)
        # two Gauss points where the spectrum bends within the width, the middle elsewhere
        waves = (k1 - half, k1 + half) if k1 < 8.0 * k1_width else (k1,)
        cells = np.zeros((6, *self.shape))
        for wave in waves:
            self._add(cells, wave)
        cells /= len(waves)
        if self.point_values:
            self._add_unresolved(cells, mann_spectra(waves, 1.0, self.shear_parameter).mean(axis=0))
        else:
            cells *= self._cell_filter(k1)
        out = np.empty(cells.shape, dtype=np.float32)
        _factors(cells, out)
        return out

    def _add(self, cells: Array, k1: float) -> None:
        y, z = (
            axis_quadrature(n, d, min(k1, 1.0)) for n, d in zip(self.shape, self.width, strict=True)
        )
        _cells(-k1, self.shear_parameter, y, z, cells)
        if self.point_values:
            _aliases(-k1, self.shear_parameter, self.k2, self.k3, self.width, cells)

    def _add_unresolved(self, cells: Array, spectra: Array) -> None:
        """Spread evenly what the spectra at a point hold beyond the first ring of aliases."""
        uu, vv, ww, uw = (spectra - cells[[0, 1, 2, 4]].sum(axis=(1, 2))) / np.prod(self.shape)
        uu, vv, ww = max(uu, 0.0), max(vv, 0.0), max(ww, 0.0)
        limit = math.sqrt(uu * ww)
        cells[0] += uu
        cells[1] += vv
        cells[2] += ww
        cells[4] += min(max(uw, -limit), limit)

    def _cell_filter(self, k1: float) -> Array:
        """Share (ny,nz) of the energy that is left of a mean over a cell of the grid."""
        shares = [
            np.sinc(np.asarray(k) * d / (2.0 * math.pi)) ** 2
            for k, d in zip((k1, self.k2[:, None], self.k3[None, :]), self.spacing, strict=True)
        ]
        return shares[0] * shares[1] * shares[2]
