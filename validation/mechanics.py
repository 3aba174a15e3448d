"""Rigid mechanisms integrated in minimal coordinates, independently of galerna's structure."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from galerna.contract import Array

GRAVITY = 9.81


def _integrate(slope: Callable[[float, Array], Array], start: Array, times: Array) -> Array:
    solution = solve_ivp(slope, (0.0, times[-1]), start, "DOP853", times, rtol=1e-12, atol=1e-12)
    return solution.y.T


def double_pendulum(times: Array) -> Array:
    """Angles (k,2) rad from the vertical of two massless 1 m links with 1 kg at their ends.

    Released from rest, the first link horizontal along x and the second hanging.
    """

    def slope(t: float, y: Array) -> Array:
        a, b, da, db = y
        c, s = np.cos(a - b), np.sin(a - b)
        mass = np.array([[2.0, c], [c, 1.0]])
        force = [-s * db**2 - 2.0 * GRAVITY * np.sin(a), s * da**2 - GRAVITY * np.sin(b)]
        return np.concatenate([y[2:], np.linalg.solve(mass, force)])

    return _integrate(slope, np.array([np.pi / 2, 0.0, 0.0, 0.0]), times)[:, :2]


def heavy_top(inertia: Array, mass: float, center: Array, spin: Array, times: Array) -> Array:
    """Positions (k,3) m of the centre of mass of a top on a fixed point, released upright.

    ``inertia`` (3,3) about the fixed point in body axes; ``spin`` (3,) rad/s in body axes.
    """

    def slope(t: float, y: Array) -> Array:
        R, w = y[:9].reshape(3, 3), y[9:]
        weight = R.T @ np.array([0.0, 0.0, -GRAVITY * mass])
        moment = np.cross(center, weight) - np.cross(w, inertia @ w)
        turning = R @ np.cross(np.eye(3), w)
        return np.concatenate([turning.ravel(), np.linalg.solve(inertia, moment)])

    states = _integrate(slope, np.concatenate([np.eye(3).ravel(), spin]), times)
    return states[:, :9].reshape(-1, 3, 3) @ center


def four_bar(times: Array, lengths: tuple[float, float, float, float], start: float) -> Array:
    """Crank angles (k,) rad of a four-bar linkage that swings under its weight from rest.

    ``lengths`` m of crank, coupler, rocker and ground; uniform slender bars of 1 kg/m in
    the x-z plane, crank pivot at the origin, rocker pivot on the x axis.
    """
    crank, coupler, rocker, ground = lengths

    def points(angle: float) -> Array:
        """Elbows of crank and rocker: the circles about the coupler's and rocker's ends meet."""
        a = crank * np.array([np.cos(angle), np.sin(angle)])
        pivot = np.array([ground, 0.0])
        gap = pivot - a
        reach = np.linalg.norm(gap)
        along = (coupler**2 - rocker**2 + reach**2) / (2 * reach)
        up = np.sqrt(coupler**2 - along**2)
        unit = gap / reach
        return np.array([[0.0, 0.0], a, a + along * unit + up * np.array([-unit[1], unit[0]]),
                         pivot])  # fmt: skip

    def energy_parts(angle: float) -> tuple[float, float]:
        """Generalised inertia kg m2 and potential J."""
        step = 1e-5
        x, slope = points(angle), (points(angle + step) - points(angle - step)) / (2 * step)
        inertia = potential = 0.0
        for k, mass in enumerate((crank, coupler, rocker)):
            a, b = slope[k], slope[k + 1]
            inertia += mass / 3.0 * (a @ a + a @ b + b @ b)
            potential += mass * GRAVITY * 0.5 * (x[k, 1] + x[k + 1, 1])
        return inertia, potential

    def slope(t: float, y: Array) -> Array:
        step = 1e-4
        ahead, back = energy_parts(y[0] + step), energy_parts(y[0] - step)
        inertia_slope = (ahead[0] - back[0]) / (2 * step)
        force = -(ahead[1] - back[1]) / (2 * step) - 0.5 * inertia_slope * y[1] ** 2
        return np.array([y[1], force / energy_parts(y[0])[0]])

    solution = solve_ivp(slope, (0, times[-1]), [start, 0.0], "DOP853", times, rtol=1e-9, atol=1e-9)
    return solution.y[0]


def rolling_disc(times: Array, radius: float, lean: float, spin: Array) -> Array:
    """Centres (k,3) m of a thin disc of 1 kg that rolls without slip on the plane z = 0.

    Its axis is y in body axes, leaning by ``lean`` rad from the horizontal about x; ``spin``
    (3,) rad/s is in global axes. The contact force is eliminated from Newton and Euler.
    """
    c, s = np.cos(lean), np.sin(lean)
    start = np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]])
    body_inertia = np.diag([0.25, 0.5, 0.25]) * radius**2
    up = np.array([0.0, 0.0, 1.0])

    def arm_of(axis: Array) -> Array:
        lowest = up - axis * axis[2]
        return -radius * lowest / np.linalg.norm(lowest)

    def slope(t: float, y: Array) -> Array:
        R, w = y[:9].reshape(3, 3), y[9:12]
        axis = R[:, 1]
        arm, step = arm_of(axis), 1e-6
        axis_rate = np.cross(w, axis)
        arm_rate = (arm_of(axis + step * axis_rate) - arm_of(axis - step * axis_rate)) / (2 * step)
        inertia = R @ body_inertia @ R.T
        hat = np.cross(np.eye(3), arm)
        # centre: v = -w x arm, contact force F = a + g up, Euler: J w' + w x J w = arm x F
        known = -np.cross(w, arm_rate) + GRAVITY * up
        left = inertia - hat @ hat
        rate = np.linalg.solve(left, np.cross(arm, known) - np.cross(w, inertia @ w))
        turning = np.cross(np.eye(3), w) @ R
        return np.concatenate([turning.ravel(), rate, -np.cross(w, arm)])

    center = -arm_of(start[:, 1])
    begin = np.concatenate([start.ravel(), spin, center])
    solution = solve_ivp(slope, (0, times[-1]), begin, "DOP853", times, rtol=1e-10, atol=1e-10)
    return solution.y[12:].T
