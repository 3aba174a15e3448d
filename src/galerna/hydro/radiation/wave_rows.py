"""Sums of spectral factors: the rational functions that a passive radiation is made of.

A row m(s) = c (s - A)^-1 G, one wave that the motion sends out, carries off the power
|m v|^2 / 2: the damping is B = Re K = m^H m / 2. With the storage P of ``A^T P + P A = -c^T c``,
K(s) = G^T P (s - A)^-1 G has just that real part. ``A`` is made of q sections [[0, 1], [-a, -b]],
``c`` reads the first state of each. That is stable for a, b > 0; G obeys m(0) = 0.
"""

from __future__ import annotations

from math import exp
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from scipy.linalg import block_diag

from galerna.contract import Array
from galerna.hydro.database import Complex

from .state_space import joined, reciprocal

STEP = 1.5e-8  #: of a parameter, to its difference quotient
NOWHERE = np.zeros(0)


class Rows(NamedTuple):
    """r rows of q sections for m modes: ``a`` (r,q) 1/s2, ``b`` (r,q) 1/s, ``G`` (r,2q,m)."""

    a: Array
    b: Array
    G: Array


@njit(cache=True, error_model="numpy")
def unpacked(parameters: Array, r: int, q: int, m: int) -> tuple[Array, Array, Array]:
    """a, b and G of free parameters.

    First come the logarithms of the sections' frequencies sqrt(a) and of their damping ratios
    b / (2 sqrt(a)), then of G what m(0) = 0 leaves. m(0) is the sum of ``(b g0 + g1) / a`` over
    the sections, so g1 = a y - b g0 where the y of all sections sum to zero.
    """
    a, b, G = np.empty((r, q)), np.empty((r, q)), np.empty((r, 2 * q, m))
    for i in range(r):
        for k in range(q):
            own = exp(parameters[i * q + k])
            a[i, k], b[i, k] = own**2, 2.0 * own * exp(parameters[(r + i) * q + k])
        for j in range(m):
            last = 0.0
            for k in range(q):
                place = 2 * r * q + (i * (2 * q - 1) + k) * m + j
                y = parameters[place + q * m] if k < q - 1 else last
                last -= y
                G[i, 2 * k, j] = parameters[place]
                G[i, 2 * k + 1, j] = a[i, k] * y - b[i, k] * parameters[place]
    return a, b, G


def parameters_of(rows: Rows) -> Array:
    """The parameters that ``unpacked`` takes."""
    a, b, G = rows.a, rows.b, rows.G.reshape(*rows.a.shape, 2, -1)
    y = (G[:, :, 1] + b[..., None] * G[:, :, 0]) / a[..., None]
    free = np.concatenate([G[:, :, 0], y[:, :-1]], axis=1)
    own, ratio = np.sqrt(a).ravel(), (0.5 * b / np.sqrt(a)).ravel()
    return np.concatenate([np.log(own), np.log(ratio), free.ravel()])


@njit(cache=True, error_model="numpy")
def storage(a: Array, b: Array) -> Array:
    """P (2q,2q) of ``A^T P + P A = -c^T c`` for the sections of one row, in closed form."""
    q = len(a)
    P = np.empty((2 * q, 2 * q))
    for k in range(q):
        for n in range(q):
            both, gap = b[k] + b[n], a[n] - a[k]
            s = both / (both * (a[k] * b[n] + b[k] * a[n]) + gap * gap)
            upper, lower = s * (b[k] + gap / both), s * (b[n] - gap / both)
            P[2 * k, 2 * n] = a[k] * s + b[n] * upper
            P[2 * k, 2 * n + 1] = upper
            P[2 * k + 1, 2 * n] = lower
            P[2 * k + 1, 2 * n + 1] = s
    return P


@njit(cache=True, error_model="numpy")
def _reader(G: Array, P: Array) -> Array:
    """G^T P (m,2q), which reads the force from the states of a row."""
    states, m = G.shape
    C = np.zeros((m, states))
    for j in range(m):
        for k in range(states):
            for n in range(states):
                C[j, k] += G[n, j] * P[n, k]
    return C


@njit(cache=True, error_model="numpy")
def transfer(a: Array, b: Array, G: Array, frequency: Array) -> Complex:
    """K(i w) (k,m,m) of all rows together, made symmetric, at frequencies (k,) rad/s."""
    rows, q = a.shape
    m = G.shape[2]
    K = np.zeros((len(frequency), m, m), dtype=np.complex128)
    for i in range(rows):
        C = _reader(G[i], storage(a[i], b[i]))
        for f in range(len(frequency)):
            s = 1j * frequency[f]
            for k in range(q):
                gain = 0.5 / (s * (s + b[i, k]) + a[i, k])
                for n in range(m):
                    g0, g1 = G[i, 2 * k, n], G[i, 2 * k + 1, n]
                    x0, x1 = gain * ((s + b[i, k]) * g0 + g1), gain * (s * g1 - a[i, k] * g0)
                    for j in range(m):
                        part = C[j, 2 * k] * x0 + C[j, 2 * k + 1] * x1
                        K[f, j, n] += part
                        K[f, n, j] += part
    return K


@njit(cache=True, error_model="numpy")
def rise(frequency: Array, apart: Complex) -> Array:
    """The added mass (m,m) whose ``i w`` times it comes nearest to ``apart`` (k,m,m)."""
    m = apart.shape[1]
    mass, square = np.zeros((m, m)), 0.0
    for f in range(len(frequency)):
        square += frequency[f] ** 2
        for i in range(m):
            for j in range(m):
                mass[i, j] += frequency[f] * apart[f, i, j].imag
    for i in range(m):
        for j in range(m):
            mass[i, j] /= square
    return mass


@njit(cache=True, error_model="numpy")
def _residuals(
    a: Array, b: Array, G: Array, frequency: Array, K: Complex, weight: Array, care: Array
) -> Array:
    """Fit minus data, real and imaginary, without what A_inf explains.

    They are weighed by entry, ``weight`` (m,m), and by frequency, ``care`` (n,).
    """
    m, n, row = K.shape[1], len(frequency), 0
    apart = transfer(a, b, G, frequency)
    for f in range(n):
        for i in range(m):
            for j in range(m):
                apart[f, i, j] -= K[f, i, j]
    mass = rise(frequency, apart)
    out = np.empty(m * (m + 1) * n)
    for i in range(m):
        for j in range(i, m):
            for f in range(n):
                own = weight[i, j] * care[f]
                out[row] = own * apart[f, i, j].real
                out[row + 1] = own * (apart[f, i, j].imag - frequency[f] * mass[i, j])
                row += 2
    return out


@njit(cache=True, error_model="numpy")
def around(
    parameters: Array, steps: Array, r: int, q: int,
    frequency: Array, K: Complex, weight: Array, care: Array,
) -> Array:  # fmt: skip
    """Residuals (1 + k, n) at the parameters and after each of k steps along one of them."""
    m = K.shape[1]
    out = np.empty((1 + len(steps), m * (m + 1) * len(frequency)))
    moved = parameters.copy()
    for n in range(1 + len(steps)):
        if n > 0:
            moved[n - 1] += steps[n - 1]
        a, b, G = unpacked(moved, r, q, m)
        found = _residuals(a, b, G, frequency, K, weight, care)
        for k in range(len(found)):
            out[n, k] = found[k]
        if n > 0:
            moved[n - 1] = parameters[n - 1]
    return out


def residuals(parameters: Array, *data: Any) -> Array:
    """Residuals (n,) of the parameters; ``data`` are r, q, frequency, K and the weights."""
    return np.asarray(around(parameters, NOWHERE, *data)[0])


def slopes(parameters: Array, *data: Any) -> Array:
    """Derivative (n,k) of the residuals over the parameters, by forward differences."""
    steps = STEP * np.maximum(1.0, np.abs(parameters))
    found = around(parameters, steps, *data)
    return np.asarray(((found[1:] - found[0]) / steps[:, None]).T)


def realized(rows: Rows) -> tuple[Array, Array]:
    """A (n,n) and B (n,m) of the rows with K = B^T (s - A)^-1 B and A + A^T = -m^T m.

    ``x <- L x`` with P = L^T L makes the stored energy |x|^2 / 2. What rounding leaves of the
    symmetric part is replaced by what it must be, so that the system is passive to the last bit.
    """
    parts = []
    for a, b, G in zip(*rows, strict=True):
        A = block_diag(*([[0.0, 1.0], [-x, -y]] for x, y in zip(a, b, strict=True)))
        values, axes = np.linalg.eigh(storage(a, b))
        root = np.sqrt(np.maximum(values, values[-1] * 1e-15))
        turned = (root[:, None] * axes.T) @ A @ (axes / root)
        row = axes[::2].sum(axis=0) / root
        dissipative = 0.5 * (turned - turned.T) - 0.5 * np.outer(row, row)
        parts.append((dissipative, root[:, None] * (axes.T @ G)))
    A, B = joined(parts)
    return (A, B) if rows.G.shape[2] == 1 else reciprocal(A, B)
