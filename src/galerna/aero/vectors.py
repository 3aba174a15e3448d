"""Vectors of three: as tuples, for kernels, where they stay in registers; and many at once."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit

from galerna.contract import Array

Vector = tuple[float, float, float]


@njit(cache=True)
def row(a: Array, i: int) -> Vector:
    """Row i of an array (n,3)."""
    return a[i, 0], a[i, 1], a[i, 2]


@njit(cache=True)
def axis(rotation: Array, i: int, k: int) -> Vector:
    """Axis k of frame i among the rotations (n,3,3)."""
    return rotation[i, 0, k], rotation[i, 1, k], rotation[i, 2, k]


@njit(cache=True)
def add(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@njit(cache=True)
def subtract(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(cache=True)
def scale(factor: float, a: Vector) -> Vector:
    return factor * a[0], factor * a[1], factor * a[2]


@njit(cache=True)
def combine(x: float, a: Vector, y: float, b: Vector) -> Vector:
    """x a + y b."""
    return x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]


@njit(cache=True)
def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True)
def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(cache=True)
def length(a: Vector) -> float:
    return sqrt(dot(a, a))


@njit(cache=True)
def put(a: Array, i: int, vector: Vector) -> None:
    """Write a vector into row i of an array (n,3)."""
    a[i, 0], a[i, 1], a[i, 2] = vector


def cross_products(a: Array, b: Array) -> Array:
    """Cross products (...,3) of arrays (...,3) that broadcast: NumPy's, without its overhead."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i in range(3):
        out[..., i] = a[..., i - 2] * b[..., i - 1] - a[..., i - 1] * b[..., i - 2]
    return out
