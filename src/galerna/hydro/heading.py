"""Mean yaw of a platform: the axes in which its potential-flow coefficients hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import atan2, exp, floor, nan, pi
from typing import Generic, TypeVar

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError

CUT_OFF = 0.01  #: Hz
BIN = pi / 36.0  #: rad: a cosine between two such is off by 0.1 % of its size at most

T = TypeVar("T")


def yaw_of(rotation: Array) -> float:
    """Yaw rad of a rotation (3,3) that yaws first."""
    return atan2(rotation[1, 0], rotation[0, 0])


def nearest_turn(angle: float) -> float:
    """An angle rad within half a turn of 0."""
    return angle - 2.0 * pi * round(angle / (2.0 * pi))


class MeanHeading:
    """Yaw behind a low pass of first order with a cut-off in Hz; or ``fixed`` at an angle rad.

    It is held over a step and moves when the step is accepted. It begins at the yaw of the
    first step. Raises InputError for a negative cut-off.
    """

    def __init__(self, cut_off: float = CUT_OFF, fixed: float | None = None) -> None:
        if cut_off < 0.0:
            what = f"cut-off of {cut_off:g} Hz: the mean yaw needs one from 0 on"
            raise InputError("heading_cut_off_hz", what)
        self.cut_off, self.fixed = cut_off, fixed
        self._angle = nan if fixed is None else fixed

    def over_step(self, rotation: Array) -> float:
        """Heading rad of a step that begins with a rotation (3,3)."""
        return self._angle if self._angle == self._angle else yaw_of(rotation)

    def settled(self, rotation: Array) -> float:
        """Heading rad of a platform that rests with a rotation (3,3)."""
        return yaw_of(rotation) if self.fixed is None else self.fixed

    def commit(self, dt: float, before: float, rotation: Array) -> None:
        """Follow from ``before`` to the rotation (3,3) at the end of a step."""
        if self.fixed is None:
            share = 1.0 - exp(-2.0 * pi * self.cut_off * dt)
            self._angle = before + share * nearest_turn(yaw_of(rotation) - before)

    def state(self) -> dict[str, np.ndarray]:
        """The mean yaw."""
        return {"heading": np.array(self._angle)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take the mean yaw back."""
        self._angle = float(state["heading"])


class Bins(Generic[T]):
    """What is made for headings ``gap`` rad apart, when one is first needed."""

    def __init__(self, make: Callable[[float], T], gap: float = BIN) -> None:
        self.make, self.gap = make, gap
        self._made: dict[int, T] = {}

    def around(self, heading: float) -> tuple[T, T, float]:
        """Those of the headings below and above, and the share of the latter."""
        place = nearest_turn(heading) / self.gap
        number = floor(place)
        below, share = self._one(number), place - number
        return below, self._one(number + 1) if share > 0.0 else below, share

    def _one(self, number: int) -> T:
        if number not in self._made:
            self._made[number] = self.make(number * self.gap)
        return self._made[number]
