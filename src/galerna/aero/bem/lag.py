"""The first-order lag, integrated exactly: the block that the unsteady corrections are built of."""

from __future__ import annotations

from math import exp

from numba import njit

FASTMATH = {"reassoc", "contract", "arcp", "nsz", "afn"}


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def first_order_lag(
    value: float, input_before: float, input_after: float, step_ratio: float
) -> float:
    """State y of T y' + y = u after a step, exact where u is linear over the step.

    ``value`` is y and ``input_before`` is u at the step's start, ``input_after`` is u at
    its end, ``step_ratio`` >= 0 is dt/T. L-stable: for any step the result lies within
    the range of the three values, and it stays at ``value`` as dt goes to 0.
    """
    decay = exp(-step_ratio)
    if step_ratio > 1e-3:
        mean_decay = (1.0 - decay) / step_ratio
    else:  # the quotient loses digits; four terms of its series lose none
        x = step_ratio
        mean_decay = 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0))
    return decay * value + (mean_decay - decay) * input_before + (1.0 - mean_decay) * input_after
