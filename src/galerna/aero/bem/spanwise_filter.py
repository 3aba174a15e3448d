"""Spanwise interaction: neighbouring sections smooth each other's lift.

Blade elements ignore that lift which varies along the span sheds vorticity. For a wing in
a downwash of wavelength lambda the lattice gives the two-dimensional lift times

    H_c(1/lambda) = 0.47 / (k^2 + 3.3 k + 0.47),   k = c/lambda

(dissertation eq. 4.11). The lift is taken to a uniform grid, transformed along the span,
damped with the chord of the point that is asked for, and transformed back to that point
alone. All of it is linear in the lift, so for a given blade it is one constant matrix.

Ends. A transform of finite length takes the lift as periodic. Here the lift is mirrored at
both ends (half-sample symmetry, the cosine transform): root and tip are not neighbours, a
constant lift stays as it is at every station, and with a constant chord the total is kept.
Continuing with zeros would take 0.36 c/y of a constant lift at the distance y from each end,
which is the tip loss counted twice; a straight line taken off first would pass on the two
end stations' own fluctuations along the whole blade.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import dct

from galerna.errors import InputError

Array = NDArray[np.float64]

GRID_POINTS = 4096  #: resolves stations that crowd at the tip: 4 cm on a 160 m blade


def filter_response(chord: ArrayLike, wavenumber: ArrayLike) -> Array:
    """H_c: share of the two-dimensional lift, for chord m and wave number 1/lambda 1/m >= 0.

    Source: dissertation eq. 4.11; the arguments broadcast.
    """
    k = np.asarray(chord) * np.asarray(wavenumber)
    return 0.47 / (k**2 + 3.3 * k + 0.47)


def filter_matrix(
    span: ArrayLike,
    chord: ArrayLike,
    ends: tuple[float, float] | None = None,
    grid_points: int = GRID_POINTS,
) -> Array:
    """Matrix (n,n) that takes a lift distribution at the stations to the filtered one.

    ``span`` (n,) m rises along the blade, ``chord`` (n,) m; ``ends`` m are the blade's root
    and tip where the stations stop short of them. Multiply by lift per length, circulation
    or lift coefficient (..., n): whatever is uniform where sections do not disturb each
    other. Rows add up to 1. Raises InputError for stations or chords that cannot be used.
    """
    z, c = np.asarray(span, dtype=float), np.asarray(chord, dtype=float)
    if z.ndim != 1 or len(z) < 2 or not np.all(np.diff(z) > 0.0):
        raise InputError("spanwise filter", "the stations must be at least two and rise")
    if c.shape != z.shape or not np.all(c > 0.0):
        raise InputError("spanwise filter", "one positive chord per station is needed")
    start, end = (z[0], z[-1]) if ends is None else ends
    if start > z[0] or end < z[-1]:
        raise InputError("spanwise filter", f"stations lie outside {start:g} to {end:g} m")
    grid = start + (end - start) * (np.arange(grid_points) + 0.5) / grid_points
    to_grid = np.stack([np.interp(grid, z, unit) for unit in np.eye(len(z))], axis=1)
    to_modes = dct(to_grid, axis=0) / grid_points
    to_modes[0] /= 2.0
    mode = np.arange(grid_points)
    damped = filter_response(c[:, None], mode / (2.0 * (end - start)))
    matrix = (damped * np.cos(np.pi * np.outer((z - start) / (end - start), mode))) @ to_modes
    return matrix / matrix.sum(axis=1, keepdims=True)  # against rounding alone


def keep_total(matrix: Array, weight: ArrayLike, values: ArrayLike) -> Array:
    """Filtered ``values`` (..., n), scaled to the total before, with strip ``weight`` (n,) m.

    Where the total is zero, or the filter would turn its sign, nothing is scaled.
    """
    before, w = np.asarray(values, dtype=float), np.asarray(weight, dtype=float)
    after = before @ matrix.T
    total = after @ w
    share = np.divide(before @ w, total, out=np.ones_like(total), where=total != 0.0)
    return after * np.where(share > 0.0, share, 1.0)[..., None]
