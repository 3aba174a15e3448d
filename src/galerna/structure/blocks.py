"""Products of small matrices inside kernels, several times as fast as calls of BLAS."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit

from galerna.contract import Array

FAST = {"reassoc", "contract", "arcp", "nsz", "afn"}


def _product(rows: int, inner: int, columns: int) -> Callable[[Array, Array], Array]:
    """``A @ B`` for blocks of known size, which the compiler unrolls."""

    @njit(cache=True, error_model="numpy", fastmath=FAST)
    def product(A: Array, B: Array) -> Array:
        C = np.zeros((rows, columns))
        for i in range(rows):
            for k in range(inner):
                a = A[i, k]
                for j in range(columns):
                    C[i, j] += a * B[k, j]
        return C

    return product


def _transposed_product(rows: int, inner: int, columns: int) -> Callable[[Array, Array], Array]:
    """``A.T @ B`` for blocks of known size."""

    @njit(cache=True, error_model="numpy", fastmath=FAST)
    def transposed_product(A: Array, B: Array) -> Array:
        C = np.zeros((rows, columns))
        for i in range(rows):
            for k in range(inner):
                a = A[k, i]
                for j in range(columns):
                    C[i, j] += a * B[k, j]
        return C

    return transposed_product


multiply3 = _product(3, 3, 3)
multiply6 = _product(6, 6, 6)
multiply_12_6_12 = _product(12, 6, 12)
multiply3_transposed = _transposed_product(3, 3, 3)
multiply6_transposed = _transposed_product(6, 6, 6)
multiply_12_6_6_transposed = _transposed_product(12, 6, 6)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def apply(A: Array, b: Array) -> Array:
    """Matrix times vector for small blocks."""
    c = np.zeros(A.shape[0])
    for i in range(A.shape[0]):
        for k in range(A.shape[1]):
            c[i] += A[i, k] * b[k]
    return c


@njit(cache=True, error_model="numpy", fastmath=FAST)
def apply_transposed(A: Array, b: Array) -> Array:
    """``A.T @ b`` for small blocks."""
    c = np.zeros(A.shape[1])
    for k in range(A.shape[0]):
        for i in range(A.shape[1]):
            c[i] += A[k, i] * b[k]
    return c
