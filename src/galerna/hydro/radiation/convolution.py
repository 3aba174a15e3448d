"""Radiation by its impulse response: the reference of the state space.

K(t) = 2/pi int_0^inf B(w) cos(w t) dw = -2/pi int_0^inf w (A(w) - A_inf) sin(w t) dw, and the
force is -int K(t - tau) v(tau) dtau (Cummins, Schiffstechnik 9, 1962; Ogilvie 1964).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numba import njit
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.special import sici

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import HydroDatabase

MEMORY = 60.0  #: s
RESOLUTION = 0.01  #: s, of the table of K, linear between: 1e-5 of waves of 1 rad/s
FINER = 20  #: points between two frequencies of the database
BEYOND = 30.0  #: times the last frequency, where the damping's tail ends
LEFT = 1e-4  #: of the largest damping: less at the last frequency has no tail


def impulse_response(database: HydroDatabase, time: ArrayLike, by: str = "damping") -> Array:
    """K(t) (k,6,6) in N/m, N, N m at times (k,) s, from the damping or from the added mass.

    Beyond the last frequency the damping falls with the power that it falls with there, and
    w (A - A_inf) with the first. The added mass gives no value at t = 0.
    """
    times = np.atleast_1d(np.asarray(time, dtype=float))
    if by == "damping":
        still = np.zeros((6, 6))
        w, B = _with_tail(*_resampled(database.frequency, database.damping, still))
        return _symmetric(2.0 / np.pi * _fourier(w, B, times).real)
    zero = database.added_mass_zero
    if by != "added_mass":
        what = f"impulse response by {by!r}: there are 'damping' and 'added_mass'"
        raise InputError("radiation", what)
    rest = database.added_mass - database.added_mass_infinite
    still = rest[0] if zero is None else zero - database.added_mass_infinite
    w, rest = _resampled(database.frequency, rest, still)
    rest = w[:, None, None] * rest
    tail = 0.5 * np.pi - sici(w[-1] * times)[0]
    beyond = tail[:, None, None] * (w[-1] * rest[-1])
    return _symmetric(-2.0 / np.pi * (_fourier(w, rest, times).imag + beyond))


def _symmetric(K: Array) -> Array:
    return 0.5 * (K + K.transpose(0, 2, 1))


def _resampled(frequency: Array, values: Array, zero: Array) -> tuple[Array, Array]:
    """Values (n,6,6) on a finer grid from w = 0 on, where they are ``zero`` without a slope."""
    w = np.concatenate([[0.0], frequency])
    fine = np.interp(np.arange(FINER * (len(w) - 1) + 1) / FINER, np.arange(len(w)), w)
    level, straight = (1, np.zeros((6, 6))), (2, np.zeros((6, 6)))
    curve = CubicSpline(w, np.concatenate([zero[None], values]), bc_type=(level, straight))
    return fine, curve(fine)


def _with_tail(w: Array, B: Array) -> tuple[Array, Array]:
    """Damping with what lies beyond the last frequency, B ~ w^-p as it ends."""
    back = int(np.searchsorted(w, 0.8 * w[-1]))
    left = np.abs(B[-1]) > LEFT * np.abs(B).max(axis=0)
    ratio = np.where(left, B[back] / np.where(left, B[-1], 1.0), 0.0)
    falls = left & (ratio > 1.0)
    power = np.log(np.where(falls, ratio, 1.0)) / np.log(w[-1] / w[back])
    far = np.geomspace(1.0, BEYOND, 600)[1:, None, None]
    tail = np.where(falls, B[-1] * far ** -np.maximum(power, 2.0), 0.0)
    return np.concatenate([w, w[-1] * far[:, 0, 0]]), np.concatenate([B, tail])


def _fourier(w: Array, values: Array, times: Array) -> np.ndarray:
    """int values exp(i w t) dw (k,6,6) of piecewise linear values (n,6,6), exactly."""
    flat = values.reshape(len(w), -1)
    width = np.diff(w)
    kink = np.diff(flat, axis=0) / width[:, None]
    bend = np.diff(kink, axis=0, prepend=0.0, append=0.0)
    out = np.empty((len(times), flat.shape[1]), dtype=complex)
    for k, t in enumerate(times):
        if t * w[-1] < 1e-3:
            out[k] = width @ (0.5 * (flat[1:] + flat[:-1]))
            continue
        wave = np.exp(1j * w * t)
        ends = (flat[-1] * wave[-1] - flat[0] * wave[0]) / (1j * t)
        out[k] = ends - (wave @ bend) / t**2
    return out.reshape(len(times), 6, 6)


class Convolution:
    """Radiation by convolution with the velocities of the last ``memory`` s, trapezoidal.

    ``response`` (k,6,6) is K at multiples of ``RESOLUTION`` from 0 on. Steps may change.
    """

    def __init__(self, response: Array) -> None:
        if len(response) < 2 or not np.isfinite(response).all():
            raise InputError("radiation", "impulse response has no two finite values")
        self.response = np.ascontiguousarray(response)
        self.memory = (len(response) - 1) * RESOLUTION
        self._past = np.zeros(0), np.zeros((0, 6))  # s before now, and the velocities
        self._trial = self._past
        self._dt = 0.0

    @classmethod
    def of(cls, database: HydroDatabase, memory: float = MEMORY) -> Convolution:
        """The convolution of a database's damping."""
        times = np.arange(int(np.ceil(memory / RESOLUTION)) + 1) * RESOLUTION
        return cls(impulse_response(database, times))

    def begin(self, dt: float, velocity: Array) -> tuple[Array, Array]:
        """The integral without the share of the velocity at the step's end."""
        self._dt = dt
        self._trial = self._past if len(self._past[0]) else (np.zeros(1), velocity[None].copy())
        free = _history(self.response, 1.0 / RESOLUTION, *self._trial, dt)
        return free, 0.5 * dt * self.response[0]

    def commit(self, velocity: Array) -> None:
        """Keep the velocity at the step's end, drop what is forgotten."""
        age = np.append(self._trial[0] + self._dt, 0.0)
        first = max(int(np.searchsorted(-age, -self.memory)) - 1, 0)
        self._past = age[first:], np.vstack([self._trial[1], velocity])[first:]

    def state(self) -> dict[str, np.ndarray]:
        """Velocities (k,6) of the past and their age (k,) s."""
        age, velocity = self._past
        return {"radiation_age": age.copy(), "radiation_velocity": velocity.copy()}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take the past back."""
        age, velocity = state["radiation_age"], state["radiation_velocity"]
        self._past = np.array(age, dtype=float), np.array(velocity, dtype=float)


@njit(cache=True, error_model="numpy")
def _history(response: Array, per_second: float, age: Array, velocity: Array, dt: float) -> Array:
    """-int K v (6,) over the past at dt after the newest of velocities (k,6) of ages (k,)."""
    force = np.zeros(6)
    last = len(age) - 1
    for n in range(last + 1):
        before = age[n - 1] if n > 0 else age[n]
        after = age[n + 1] if n < last else -dt
        place = (age[n] + dt) * per_second
        i = int(place)
        if i >= len(response) - 1:
            continue
        high = (place - i) * 0.5 * (before - after)
        low = 0.5 * (before - after) - high
        for j in range(6):
            for k in range(6):
                K = low * response[i, j, k] + high * response[i + 1, j, k]
                force[j] -= K * velocity[n, k]
    return force
