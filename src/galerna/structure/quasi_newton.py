"""Secants of an iteration: what a kept or incomplete tangent does not know of the equations.

A correction ``d(x)`` of Newton's method with an approximate tangent leaves out how loads of other
models follow the motion. The steps taken and the changes of ``d`` that came of them tell: of all
points in the plane of the last steps, the next one starts where ``d`` would be the smallest.
Source: Anderson, J. ACM 12 (1965) 547; as interface quasi-Newton of coupled problems: Degroote,
Bathe and Vierendeels, Computers and Structures 87 (2009) 793.
"""

from __future__ import annotations

import numpy as np

from galerna.contract import Array

DEPTH = 5  #: secants kept


class Secants:
    """The last steps of an iteration, and the steps that they advise.

    The first ``judged`` entries of a correction are those that are to become small.
    """

    def __init__(self, judged: int) -> None:
        self._judged = judged
        self._steps: list[Array] = []
        self._changes: list[Array] = []
        self._last: Array | None = None

    def step(self, correction: Array) -> Array:
        """The step to take where ``correction`` (k,) is Newton's."""
        if self._last is not None:
            self._changes = [*self._changes, correction - self._last][-DEPTH:]
        step = correction
        if self._changes and np.isfinite(correction).all():
            changes = np.stack(self._changes, axis=1)
            share = np.linalg.lstsq(
                changes[: self._judged], correction[: self._judged], rcond=1e-8
            )[0]
            step = correction - (np.stack(self._steps, axis=1) + changes) @ share
        self._last = correction
        self._steps = [*self._steps, step][-DEPTH:]
        return step
