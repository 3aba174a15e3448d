"""What a kernel needs to keep the vector units of a processor busy.

Division and square root are the slow instructions of Biot and Savart's law. One reciprocal
square root serves each distance and each segment; it is an estimate, refined by multiplication.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic, overload

FASTMATH = {"reassoc", "contract", "arcp", "nsz", "afn"}
_CACHE_LINE = 64  # bytes
_float32 = np.float32


def inverse_square_root(x: float) -> float:
    """1/sqrt(x) of a positive number, in compiled code; finite for 0 in double precision."""
    raise NotImplementedError("for compiled code")


@overload(inverse_square_root, jit_options={"fastmath": FASTMATH, "error_model": "numpy"})
def _inverse_square_root(x):  # type: ignore[no-untyped-def]
    """Hardware's estimate and Newton's step in single precision; in double, two Taylor steps.

    With y the estimate and e = 1 - x y^2, 1/sqrt(x) = y (1 + e/2 + 3 e^2/8 + 5 e^3/16 + ...).
    """
    if x == types.float32:
        return lambda x: _float32(1.0) / sqrt(x)

    def refined(x):  # type: ignore[no-untyped-def]
        y = _estimate(x)
        e = 1.0 - x * (y * y)
        y += (y * e) * (0.5 + e * (0.375 + e * 0.3125))
        e = 1.0 - x * (y * y)
        return y + (y * e) * (0.5 + e * 0.375)

    return refined


def _halve_the_bits(typing_context: Any, x: types.Type) -> Any:
    """1/sqrt(x) to 3.5 %: halving the bits of a number halves its exponent."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        integer = ir.IntType(64)
        halved = builder.lshr(builder.bitcast(arguments[0], integer), ir.Constant(integer, 1))
        bits = builder.sub(ir.Constant(integer, 0x5FE6EB50C7B537A9), halved)
        return builder.bitcast(bits, ir.DoubleType())

    return types.float64(types.float64), generate


_estimate: Any = intrinsic(_halve_the_bits)


def _prefer_wide_vectors(typing_context: Any) -> Any:
    """Let the function that calls this use 512-bit vectors where the processor has them.

    LLVM keeps to 256 bits on many processors that have 512, lest a few wide instructions lower
    the clock; a kernel that does nothing else gains nearly twice the speed.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        return context.get_dummy_value()

    return types.void(), generate


prefer_wide_vectors: Any = intrinsic(_prefer_wide_vectors)


@njit(cache=True)
def aligned_zeros(size, like):  # type: ignore[no-untyped-def]
    """Zeros (size,) of the type of ``like`` that begin with a cache line."""
    raw = np.zeros(size + _CACHE_LINE // like.itemsize, like.dtype)
    skip = (-raw.ctypes.data) % _CACHE_LINE // like.itemsize
    return raw[skip : skip + size]
