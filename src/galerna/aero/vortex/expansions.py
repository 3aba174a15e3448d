"""Truncated Taylor series of harmonic functions, in the fewest coefficients.

Where r = x - y, f(r) = 1/|r| is harmonic, so of its derivatives D_k = d^k f, k = (a, b, c),
only those with c = 0 or 1 are independent: D_(a,b,2) = -D_(a+2,b,0) - D_(a,b+2,0). A harmonic
function is then h(s) = sum_k S_k(s) h_k, with h_k its derivatives at s = 0 and S_k the harmonic
polynomials whose derivatives there are 1 for k and 0 else; (p + 1)^2 of them up to order p,
as for spherical harmonics. Adding two k and reducing c = 2 is all that is needed to shift a
multipole series M (h(r) = sum M_k D_k(r)) or a local one L, and to turn the first into the
second: L_k = sum_m M_m D_(k+m), the fast multipole method of Greengard and Rokhlin (1987) in
Cartesian coordinates (Duan and Krasny 2001, J. Comput. Chem. 22, for the recurrence of D).

Kernels work on many expansions or points at once, the lanes: arrays (coefficient, lane).
"""

from __future__ import annotations

from functools import lru_cache
from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from galerna.aero.vortex.simd import FASTMATH, prefer_wide_vectors
from galerna.contract import Array

LANES = 32


class Indices(NamedTuple):
    """Where the coefficients k = (a,b,c) of a series of some order stand, and their neighbours.

    The first ``independent`` have c < 2 and ascending order |k|; those with c = 2 follow, and a
    last place, always zero, stands for coefficients that do not exist.
    """

    order: int
    independent: int
    up_to: Array  # (order+1,): number of independent coefficients of order at most that
    exponents: Array  # (total,3)
    lower: Array  # (total,3): place of k - e_x, k - e_y, k - e_z
    lower_twice: Array  # (total,2): of k - 2 e_x, k - 2 e_y
    traded: Array  # (total,2): of (a+2,b,0), (a,b+2,0) if c = 2, of (a-2,b,1), (a,b-2,1) if c = 0
    total: Array  # (independent,independent): place of k + m


@lru_cache
def indices(order: int) -> Indices:
    """The `Indices` of series up to ``order``."""
    keys = [
        (a, n - c - a, c) for n in range(order + 1) for c in (0, 1) for a in range(n - c, -1, -1)
    ]
    independent = len(keys)
    keys += [(a, n - a, 2) for n in range(order - 1) for a in range(n, -1, -1)]
    place = {key: i for i, key in enumerate(keys)}

    def find(a: int, b: int, c: int) -> int:
        return place.get((a, b, c), len(keys))

    def trade(a: int, b: int, c: int) -> tuple[int, int]:
        if c == 2:
            return find(a + 2, b, 0), find(a, b + 2, 0)
        return (find(a - 2, b, 1), find(a, b - 2, 1)) if c == 0 else (len(keys), len(keys))

    sums = [
        [find(a + d, b + e, c + f) for d, e, f in keys[:independent]]
        for a, b, c in keys[:independent]
    ]
    return Indices(
        order,
        independent,
        np.array([(n + 1) ** 2 for n in range(order + 1)]),
        np.array(keys, dtype=float),
        np.array([(find(a - 1, b, c), find(a, b - 1, c), find(a, b, c - 1)) for a, b, c in keys]),
        np.array([(find(a - 2, b, c), find(a, b - 2, c)) for a, b, c in keys]),
        np.array([trade(*key) for key in keys]),
        np.array(sums),
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def harmonic_polynomials(k, order, x, y, z, s):  # type: ignore[no-untyped-def]
    """S_k (total+1,lanes) up to order at (x,y,z) (lanes,) each.

    Euler's theorem for homogeneous functions gives n S_k from its three derivatives.
    """
    lanes = len(x)
    s[0] = 1.0
    s[-1] = 0.0
    for i in range(1, k.up_to[order]):
        over = 1.0 / (k.exponents[i, 0] + k.exponents[i, 1] + k.exponents[i, 2])
        sx, sy = s[k.lower[i, 0]], s[k.lower[i, 1]]
        sz, sxx, syy = s[k.lower[i, 2]], s[k.traded[i, 0]], s[k.traded[i, 1]]
        for lane in range(lanes):
            dz = sz[lane] - sxx[lane] - syy[lane]
            s[i, lane] = over * (x[lane] * sx[lane] + y[lane] * sy[lane] + z[lane] * dz)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def inverse_distance_derivatives(k, r, d):  # type: ignore[no-untyped-def]
    """D_k (total+1,LANES) of 1/|r| at r (4 LANES,), x before y before z; r is spent."""
    prefer_wide_vectors()
    for n in range(LANES):
        x, y, z = r[n], r[LANES + n], r[2 * LANES + n]
        over = 1.0 / (x * x + y * y + z * z)
        d[0, n] = sqrt(over)
        r[n], r[LANES + n], r[2 * LANES + n], r[3 * LANES + n] = x * over, y * over, z * over, over
    d[-1] = 0.0
    for i in range(1, k.independent):
        a, b, c = k.exponents[i]
        order = a + b + c
        once, twice = (1.0 - 2.0 * order) / order, (1.0 - order) / order
        _extend(
            r, d[i], d[k.lower[i, 0]], d[k.lower[i, 1]], d[k.lower[i, 2]],
            d[k.lower_twice[i, 0]], d[k.lower_twice[i, 1]],
            (a * once, b * once, c * once, a * (a - 1.0) * twice, b * (b - 1.0) * twice),
        )  # fmt: skip
    for i in range(k.independent, len(k.exponents)):
        dxx, dyy = d[k.traded[i, 0]], d[k.traded[i, 1]]
        for n in range(LANES):
            d[i, n] = -(dxx[n] + dyy[n])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _extend(r, d, da, db, dc, daa, dbb, factors):  # type: ignore[no-untyped-def]
    """n r^2 D_k + (2n-1) sum_i k_i x_i D_(k-e_i) + (n-1) sum_i k_i (k_i-1) D_(k-2e_i) = 0."""
    prefer_wide_vectors()
    fa, fb, fc, faa, fbb = factors
    for n in range(LANES):
        first = fa * r[n] * da[n] + fb * r[LANES + n] * db[n] + fc * r[2 * LANES + n] * dc[n]
        d[n] = first + r[3 * LANES + n] * (faa * daa[n] + fbb * dbb[n])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_local_series(k, moments, derivatives, lanes, local):  # type: ignore[no-untyped-def]
    """Add to local (total+1,) the series of dipole moments (independent,LANES) far away.

    L_k = sum_m M_m D_(k+m) for 1 <= |k|, 1 <= |m| and |k| + |m| <= order.
    """
    part = np.empty(LANES)
    for order in range(1, k.order):
        count = k.up_to[k.order - order] - 1
        for i in range(k.up_to[order - 1], k.up_to[order]):
            part[:] = 0.0
            at = k.total[i]
            for j in range(1, 1 + count % 4):
                _add_product(part, moments[j], derivatives[at[j]])
            for j in range(1 + count % 4, 1 + count, 4):
                _add_products(
                    part, moments[j], moments[j + 1], moments[j + 2], moments[j + 3],
                    derivatives[at[j]], derivatives[at[j + 1]],
                    derivatives[at[j + 2]], derivatives[at[j + 3]],
                )  # fmt: skip
            for n in range(lanes):
                local[i] += part[n]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _add_product(part, m, d):  # type: ignore[no-untyped-def]
    prefer_wide_vectors()
    for n in range(LANES):
        part[n] += m[n] * d[n]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _add_products(part, m0, m1, m2, m3, d0, d1, d2, d3):  # type: ignore[no-untyped-def]
    prefer_wide_vectors()
    for n in range(LANES):
        part[n] += (m0[n] * d0[n] + m1[n] * d1[n]) + (m2[n] * d2[n] + m3[n] * d3[n])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def complete(k, local):  # type: ignore[no-untyped-def]
    """Fill in the dependent coefficients of a local series (total+1,)."""
    for i in range(k.independent, len(k.exponents)):
        local[i] = -(local[k.traded[i, 0]] + local[k.traded[i, 1]])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_dipoles(k, s, dx, dy, dz, moments):  # type: ignore[no-untyped-def]
    """Add dipoles (lanes,), at places y whose polynomials S_k(-y) are s, to moments (k,).

    The potential d.grad_y 1/|x - y| has the moments M_k = -d.(grad S_k)(-y).
    """
    for i in range(1, k.up_to[k.order - 1]):
        sx, sy, sz = s[k.lower[i, 0]], s[k.lower[i, 1]], s[k.lower[i, 2]]
        sxx, syy = s[k.traded[i, 0]], s[k.traded[i, 1]]
        total = 0.0
        for lane in range(len(dx)):
            total += (
                dx[lane] * sx[lane]
                + dy[lane] * sy[lane]
                + dz[lane] * (sz[lane] - sxx[lane] - syy[lane])
            )
        moments[i] -= total


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_shifted_moments(k, moments, s, shifted):  # type: ignore[no-untyped-def]
    """Add moments (k,), moved by a distance of polynomials s (total+1,1), to shifted (total+1,)."""
    for n in range(1, k.order):
        for i in range(k.up_to[n - 1], k.up_to[n]):
            for j in range(k.up_to[k.order - 1 - n]):
                shifted[k.total[i, j]] += moments[i] * s[j, 0]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def reduce_moments(k, moments):  # type: ignore[no-untyped-def]
    """Trade the dependent moments (total+1,) for independent ones."""
    for i in range(k.independent, len(k.exponents)):
        moments[k.traded[i, 0]] -= moments[i]
        moments[k.traded[i, 1]] -= moments[i]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def shift_local(k, local, s, shifted):  # type: ignore[no-untyped-def]
    """Write the series local (total+1,) at a place of polynomials s (total+1,1) to shifted."""
    for n in range(1, k.order):
        for i in range(k.up_to[n - 1], k.up_to[n]):
            total = 0.0
            for j in range(k.up_to[k.order - 1 - n]):
                total += local[k.total[i, j]] * s[j, 0]
            shifted[i] = total
    complete(k, shifted)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def add_gradient(k, local, s, u, v, w):  # type: ignore[no-untyped-def]
    """Add the gradient of a local series to u, v, w (lanes,) at places of polynomials s."""
    for i in range(k.up_to[k.order - 2]):
        gx, gy, gz = local[k.total[i, 1]], local[k.total[i, 2]], local[k.total[i, 3]]
        for lane in range(len(u)):
            u[lane] += gx * s[i, lane]
            v[lane] += gy * s[i, lane]
            w[lane] += gz * s[i, lane]
