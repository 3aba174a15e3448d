"""One evaluation of the whole rotor: wind and motion in, loads and new memories out."""

from __future__ import annotations

from math import atan2, cos, sin, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from galerna.aero.bem import strips as s
from galerna.aero.bem.dynamic_inflow import advance_inflow, slow_time_constant, start_inflow
from galerna.aero.bem.dynamic_stall import advance_stall, start_stall
from galerna.aero.bem.momentum import FASTMATH, Momentum, solve_strip
from galerna.aero.sections import section_coefficients
from galerna.contract import Array

# What a strip remembers: rows of ``before`` and ``after``.
GUESS = 0  #: inflow angle of the last balance, rad
NORMAL_LAGS, SWIRL_LAGS = slice(1, 4), slice(4, 7)  #: dynamic inflow
STALL = slice(7, 15)  #: unsteady airfoil
LIFT_SHIFT = 15  #: filtered minus unfiltered lift coefficient
MEMORY_COLUMNS = 16

# What is known of the rotor: ``totals``.
MEAN_WIND = slice(0, 3)  #: m/s relative to the hub
MEAN_NORMAL_WIND, MEAN_INDUCED = 3, 4  #: m/s along the shaft, m/s
THRUST, TORQUE = 5, 6  #: N, N m
ROTOR_SPEED = 7  #: rad/s
ROOT_MOMENTS = 8  #: in-plane and out-of-plane moment of each blade at its root, N m

SEEN_COLUMNS = 19  #: of a frame: position, rotation, velocity, angular velocity, time

FILTER_OFF, FILTER_LOADS, FILTER_FEEDBACK = 0, 1, 2


class Rotor(NamedTuple):
    """What stays the same over a run, for the kernels."""

    air_density: float
    radius: float
    hub_radius: float
    cone: float
    strips_per_blade: int
    momentum: Momentum
    induction: bool
    dynamic_inflow: bool
    unsteady_airfoil: bool
    three_quarter_chord: bool
    spanwise_filter: int
    ends_unloaded: bool


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def rotor_loads(
    rotor: Rotor,
    points: Array,
    position: Array,
    rotation: Array,
    velocity: Array,
    angular_velocity: Array,
    wind: Array,
    shape: Array,
    table: Array,
    stall: Array,
    spanwise: Array,
    before: Array,
    dt: float,
    after: Array,
    strips: Array,
    totals: Array,
    force: Array,
    moment: Array,
) -> None:
    """Loads on all strips; the hub's frame stands behind those of the m strips.

    In: ``points`` and ``wind`` (m,3) at the aerodynamic centres, the frames, ``shape`` (m,7),
    ``table`` (n,k,5) and ``stall`` (n,9) of the n stations of a blade, ``spanwise`` (n,n), the
    strips' memories ``before`` (m,16) and the step ``dt`` s; a negative one means that the
    present state has lasted for ever. Out: ``after`` (m,16), ``strips`` (m,29), ``totals`` (8 + 2B)
    and the rows of ``force`` N and ``moment`` N m (.,3).
    """
    m = shape.shape[0]
    hub, shaft = position[m], rotation[m, :, 0]
    for i in range(m):
        s.place_strip(
            strips[i],
            shape[i],
            points[i],
            position[i],
            rotation[i],
            velocity[i],
            angular_velocity[i],
            wind[i],
            hub,
            shaft,
        )
        _balance(rotor, i, table, shape, before, after, strips)
    _mean_flow(strips, shape, wind, velocity[m], shaft, totals)
    for i in range(m):
        _induce(rotor, i, before, dt, totals, after, strips)
        _section(rotor, i, table, stall, shape, before, dt, after, strips)
    if rotor.spanwise_filter != FILTER_OFF:
        _filter_lift(rotor, spanwise, after, strips)
    for i in range(m):
        _load(rotor, i, shape, rotation, strips, force, moment)
    totals[ROTOR_SPEED] = s.dot(angular_velocity[m], shaft)
    _total(rotor, position, hub, rotation[m], force, moment, totals)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _balance(  # type: ignore[no-untyped-def]
    rotor, i, table, shape, before, after, strips
) -> None:
    """The induced velocity that balances the static load of a strip."""
    strip, station = strips[i], i % rotor.strips_per_blade
    after[i, LIFT_SHIFT] = 0.0
    if not rotor.induction:
        strip[s.QUASI_NORMAL] = strip[s.QUASI_SWIRL] = 0.0
        strip[s.LOSS] = 1.0
        return
    shift = before[i, LIFT_SHIFT] if rotor.spanwise_filter == FILTER_FEEDBACK else 0.0
    balance = s.strip_balance(strip, shape[i], rotor.momentum.blades, shift)
    angle, induced, swirl, loss, _ = solve_strip(
        before[i, GUESS],
        table,
        station,
        strip[s.PITCH],
        strip[s.NORMAL_WIND],
        strip[s.TANGENTIAL_WIND],
        balance,
        rotor.momentum,
    )
    after[i, GUESS] = angle
    strip[s.QUASI_NORMAL], strip[s.QUASI_SWIRL], strip[s.LOSS] = induced, swirl, loss


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _mean_flow(strips, shape, wind, hub_velocity, shaft, totals) -> None:  # type: ignore[no-untyped-def]
    """Means over the rotor disc of the wind relative to the hub and of the induced velocity."""
    total, induced = 0.0, 0.0
    mean = totals[MEAN_WIND]
    mean[:] = 0.0
    for i in range(shape.shape[0]):
        area = strips[i, s.RADIUS] * shape[i, s.WEIGHT] * strips[i, s.RADIAL]
        total += area
        induced += area * strips[i, s.QUASI_NORMAL] / strips[i, s.CONE]
        for k in range(3):
            mean[k] += area * wind[i, k]
    for k in range(3):
        mean[k] = mean[k] / total - hub_velocity[k]
    totals[MEAN_NORMAL_WIND] = s.dot(mean, shaft)
    totals[MEAN_INDUCED] = induced / total


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _induce(rotor, i, before, dt, totals, after, strips) -> None:  # type: ignore[no-untyped-def]
    """The induced velocity that a strip meets: the balanced one, delayed and skewed."""
    strip = strips[i]
    normal, swirl = strip[s.QUASI_NORMAL], strip[s.QUASI_SWIRL]
    if rotor.dynamic_inflow:
        if dt < 0.0:
            start_inflow(normal, after[i, NORMAL_LAGS])
            start_inflow(swirl, after[i, SWIRL_LAGS])
        else:
            wind = totals[MEAN_NORMAL_WIND]
            fraction = strip[s.RADIUS] / rotor.radius
            induction = totals[MEAN_INDUCED] / wind if abs(wind) > 0.1 else 0.0
            tau = slow_time_constant(wind, induction, rotor.radius)
            normal = advance_inflow(
                before[i, NORMAL_LAGS], normal, dt, tau, fraction, after[i, NORMAL_LAGS]
            )
            swirl = advance_inflow(
                before[i, SWIRL_LAGS], swirl, dt, tau, fraction, after[i, SWIRL_LAGS]
            )
    strip[s.INDUCED_NORMAL], strip[s.INDUCED_SWIRL] = normal, swirl


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _section(  # type: ignore[no-untyped-def]
    rotor, i, table, stall, shape, before, dt, after, strips
) -> None:
    """Relative velocity, angle of attack and coefficients of a strip."""
    strip, station, chord = strips[i], i % rotor.strips_per_blade, shape[i, s.CHORD]
    across = strip[s.NORMAL_WIND] - strip[s.INDUCED_NORMAL]
    along = strip[s.TANGENTIAL_WIND] + strip[s.INDUCED_SWIRL]
    strip[s.SPEED] = sqrt(across * across + along * along)
    strip[s.INFLOW_ANGLE] = atan2(across, along)
    c, sn = cos(strip[s.PITCH]), sin(strip[s.PITCH])
    to_suction, to_trailing = across * c - along * sn, across * sn + along * c
    if rotor.three_quarter_chord:
        to_suction += 0.5 * chord * strip[s.TURNING]
    angle = atan2(to_suction, to_trailing)
    strip[s.ANGLE_OF_ATTACK] = angle
    if not rotor.unsteady_airfoil:
        lift, drag, moment = section_coefficients(table, station, angle)
    else:
        turning = strip[s.TURNING] if rotor.three_quarter_chord else 0.0
        start = before[i, STALL]
        if dt < 0.0:
            start_stall(
                after[i, STALL], table, station, stall, chord, to_suction, to_trailing, turning
            )
            start = after[i, STALL].copy()
        lift, drag, moment = advance_stall(
            start,
            table,
            station,
            stall,
            chord,
            to_suction,
            to_trailing,
            turning,
            max(dt, 0.0),
            after[i, STALL],
        )
    strip[s.LIFT], strip[s.DRAG], strip[s.MOMENT] = lift, drag, moment


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _filter_lift(rotor, spanwise, after, strips) -> None:  # type: ignore[no-untyped-def]
    """Let neighbouring sections of a blade share their lift."""
    n = rotor.strips_per_blade
    for first in range(0, strips.shape[0], n):
        for i in range(n):
            filtered = 0.0
            for j in range(n):
                filtered += spanwise[i, j] * strips[first + j, s.LIFT]
            after[first + i, LIFT_SHIFT] = filtered - strips[first + i, s.LIFT]
        for i in range(n):
            strips[first + i, s.LIFT] += after[first + i, LIFT_SHIFT]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _load(rotor, i, shape, rotation, strips, force, moment) -> None:  # type: ignore[no-untyped-def]
    """Lump a strip's force and moment on its station's frame."""
    strip = strips[i]
    at_end = min(shape[i, s.TO_TIP], shape[i, s.TO_ROOT]) <= 0.0
    if rotor.ends_unloaded and at_end:  # the loss factor is zero there, and so is the lift
        strip[s.LIFT] = strip[s.DRAG] = strip[s.MOMENT] = 0.0
    pressure = 0.5 * rotor.air_density * strip[s.SPEED] ** 2 * shape[i, s.CHORD]
    c, sn = cos(strip[s.INFLOW_ANGLE]), sin(strip[s.INFLOW_ANGLE])
    normal = pressure * (strip[s.LIFT] * c + strip[s.DRAG] * sn)
    tangential = pressure * (strip[s.LIFT] * sn - strip[s.DRAG] * c)
    strip[s.NORMAL_FORCE], strip[s.TANGENTIAL_FORCE] = normal, tangential
    weight = shape[i, s.WEIGHT]
    twisting = pressure * shape[i, s.CHORD] * strip[s.MOMENT] * weight
    across, against = strip[s.NORMAL], strip[s.TANGENT]
    axes = rotation[i]
    arm = np.empty(3)
    for k in range(3):
        force[i, k] = weight * (normal * across[k] - tangential * against[k])
        arm[k] = (
            axes[k, 0] * shape[i, s.CENTER_X]
            + axes[k, 1] * shape[i, s.CENTER_Y]
            + axes[k, 2] * shape[i, s.OFFSET]
        )
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        moment[i, k] = arm[a] * force[i, b] - arm[b] * force[i, a] + twisting * axes[k, 2]


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _total(  # type: ignore[no-untyped-def]
    rotor, position, hub, hub_axes, force, moment, totals
) -> None:
    """Thrust along the shaft, torque about it and the moments at the blades' roots.

    The root axes cone with the blade and do not pitch: x downwind, y in the rotor plane.
    """
    n = rotor.strips_per_blade
    shaft = hub_axes[:, 0]
    thrust, torque = 0.0, 0.0
    root, across, about = np.empty(3), np.empty(3), np.empty(3)
    for blade in range(int(rotor.momentum.blades)):
        turn = 2.0 * np.pi * blade / rotor.momentum.blades
        in_plane, out_of_plane = 0.0, 0.0
        for k in range(3):
            outwards = cos(turn) * hub_axes[k, 2] - sin(turn) * hub_axes[k, 1]
            across[k] = cos(turn) * hub_axes[k, 1] + sin(turn) * hub_axes[k, 2]
            about[k] = cos(rotor.cone) * shaft[k] + sin(rotor.cone) * outwards
            root[k] = rotor.hub_radius * (cos(rotor.cone) * outwards - sin(rotor.cone) * shaft[k])
        for i in range(blade * n, (blade + 1) * n):
            for k in range(3):
                a, b = (k + 1) % 3, (k + 2) % 3
                x, y = position[i, a] - hub[a], position[i, b] - hub[b]
                at_hub = moment[i, k] + x * force[i, b] - y * force[i, a]
                at_root = at_hub - root[a] * force[i, b] + root[b] * force[i, a]
                thrust += force[i, k] * shaft[k]
                torque += at_hub * shaft[k]
                in_plane += at_root * about[k]
                out_of_plane += at_root * across[k]
        totals[ROOT_MOMENTS + 2 * blade] = in_plane
        totals[ROOT_MOMENTS + 2 * blade + 1] = out_of_plane
    totals[THRUST], totals[TORQUE] = thrust, torque


@njit(cache=True)
def remember(position, rotation, velocity, angular_velocity, time, seen) -> None:  # type: ignore[no-untyped-def]
    """Copy a motion of n frames and its time into ``seen`` (n,19)."""
    for i in range(seen.shape[0]):
        seen[i, 0:3], seen[i, 3:6], seen[i, 6:9] = position[i], velocity[i], angular_velocity[i]
        for k in range(3):
            seen[i, 9 + 3 * k : 12 + 3 * k] = rotation[i, k]
        seen[i, 18] = time


@njit(cache=True)
def same(position, rotation, velocity, angular_velocity, time, seen) -> bool:  # type: ignore[no-untyped-def]
    """Whether a motion and its time are, to the bit, those of ``remember``."""
    for i in range(seen.shape[0]):
        if seen[i, 18] != time:
            return False
        for k in range(3):
            if (
                seen[i, k] != position[i, k]
                or seen[i, 3 + k] != velocity[i, k]
                or seen[i, 6 + k] != angular_velocity[i, k]
            ):
                return False
            for j in range(3):
                if seen[i, 9 + 3 * k + j] != rotation[i, k, j]:
                    return False
    return True
