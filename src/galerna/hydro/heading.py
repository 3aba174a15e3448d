"""Mean yaw and lean of a platform: the axes in which its potential-flow coefficients hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import atan2, cos, exp, floor, hypot, isnan, nan, pi, sin
from typing import Generic, TypeVar

import numpy as np
from numba import njit

from galerna.contract import Array
from galerna.errors import InputError

CUT_OFF = 0.01  #: Hz
LEAN_CUT_OFF = 0.001  #: Hz: of a pitch of 0.03 Hz 3 % pass
BIN = pi / 36.0  #: rad: a cosine between two such is off by 0.1 % of its size at most

T = TypeVar("T")


def share_of_step(cut_off: float, dt: float) -> float:
    """What a low pass of first order with a cut-off in Hz takes of a change in ``dt`` s."""
    return 1.0 - exp(-2.0 * pi * cut_off * dt)


def require_cut_off(where: str, cut_off: float, what: str) -> float:
    """The cut-off in Hz; InputError if it is negative."""
    if cut_off < 0.0:
        raise InputError(where, f"cut-off of {cut_off:g} Hz: the mean {what} needs one from 0 on")
    return cut_off


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
        self.cut_off = require_cut_off("heading_cut_off_hz", cut_off, "yaw")
        self.fixed = fixed
        self._angle = nan if fixed is None else fixed

    def over_step(self, rotation: Array) -> float:
        """Heading rad of a step that begins with a rotation (3,3)."""
        return yaw_of(rotation) if isnan(self._angle) else self._angle

    def settled(self, rotation: Array) -> float:
        """Heading rad of a platform that rests with a rotation (3,3)."""
        return yaw_of(rotation) if self.fixed is None else self.fixed

    def commit(self, dt: float, before: float, rotation: Array) -> None:
        """Follow from ``before`` to the rotation (3,3) at the end of a step."""
        if self.fixed is None:
            change = nearest_turn(yaw_of(rotation) - before)
            self._angle = before + share_of_step(self.cut_off, dt) * change

    def state(self) -> dict[str, np.ndarray]:
        """The mean yaw."""
        return {"heading": np.array(self._angle)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take the mean yaw back."""
        self._angle = float(state["heading"])


@njit(cache=True, error_model="numpy")
def lean_of(rotation: Array) -> Array:
    """The shortest turn (3,) rad, global axes, that takes z to the body's axis."""
    x, y, up = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    level = hypot(x, y)
    share = atan2(level, up) / level if level > 0.0 else 1.0
    return np.array([-share * y, share * x, 0.0])


@njit(cache=True, error_model="numpy")
def mean_axes(yaw: float, lean: Array) -> Array:
    """The axes (3,3), as columns, of a platform that yaws by ``yaw`` rad and then leans (3,)."""
    c, s, angle = cos(yaw), sin(yaw), hypot(lean[0], lean[1])
    first = sin(angle) / angle if angle > 0.0 else 1.0
    second = 2.0 * (sin(0.5 * angle) / angle) ** 2 if angle > 0.0 else 0.5
    x, y = lean[0], lean[1]
    tilt = np.array([
        [1.0 - second * y * y, second * x * y, first * y],
        [second * x * y, 1.0 - second * x * x, -first * x],
        [-first * y, first * x, 1.0 - second * angle * angle],
    ])  # fmt: skip
    axes = np.empty((3, 3))
    for k in range(3):
        axes[k, 0], axes[k, 1] = c * tilt[k, 0] + s * tilt[k, 1], c * tilt[k, 1] - s * tilt[k, 0]
        axes[k, 2] = tilt[k, 2]
    return axes


class MeanLean:
    """Lean (3,) rad, global axes, behind a low pass of first order; none where it is ``upright``.

    It begins at the lean of the platform at rest, if that is told, or of the first step, and
    is held over a step. Raises InputError for a negative cut-off in Hz.
    """

    def __init__(self, cut_off: float = LEAN_CUT_OFF, upright: bool = False) -> None:
        self.cut_off = require_cut_off("lean_cut_off_hz", cut_off, "lean")
        self.upright = upright
        self._lean = np.full(3, 0.0 if upright else nan)

    def over_step(self, rotation: Array) -> Array:
        """Lean (3,) of a step that begins with a rotation (3,3)."""
        return lean_of(rotation) if isnan(self._lean[2]) else self._lean

    def settle(self, rotation: Array) -> None:
        """Begin at the lean of a platform that rests with a rotation (3,3)."""
        if not self.upright:
            self._lean = lean_of(rotation)

    def commit(self, dt: float, before: Array, rotation: Array) -> None:
        """Follow from ``before`` to the rotation (3,3) at the end of a step."""
        if not self.upright:
            self._lean = before + share_of_step(self.cut_off, dt) * (lean_of(rotation) - before)

    def state(self) -> dict[str, np.ndarray]:
        """The mean lean."""
        return {"lean": self._lean.copy()}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take the mean lean back."""
        self._lean = np.array(state["lean"], dtype=float)


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
