"""One evaluation of the whole rotor: wind and motion in, loads and new memories out."""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from galerna.aero.bem import strips as s
from galerna.aero.bem.curved_flow import curved_flow_moment
from galerna.aero.bem.dynamic_inflow import advance_inflow, slow_time_constant, start_inflow
from galerna.aero.bem.dynamic_stall import advance_stall, start_stall
from galerna.aero.bem.momentum import FASTMATH, Momentum, solve_strip
from galerna.aero.bem.skewed_wake import (
    half_skew_tangent,
    pitt_peters,
    skew_position,
    vortex_cylinder,
)
from galerna.aero.sections import section_coefficients
from galerna.aero.vectors import Vector, add, axis, combine, cross, dot, put, row, scale, subtract
from galerna.contract import Array

# What a strip remembers: rows of ``before`` and ``after``.
GUESS = 0  #: inflow angle of the last balance, rad
NORMAL_LAGS, SWIRL_LAGS = slice(1, 4), slice(4, 7)  #: dynamic inflow
STALL = slice(7, 15)  #: unsteady airfoil
LIFT_SHIFT = 15  #: filtered minus unfiltered lift coefficient
MEMORY_COLUMNS = 16

# What is known of the rotor: ``totals``.
MEAN_WIND = 0  #: m/s relative to the hub, in its axes; three columns
MEAN_INDUCED = 3  #: m/s along the shaft
SKEW = 4  #: tan(chi/2) of the wake
THRUST, TORQUE = 5, 6  #: N, N m
ROTOR_SPEED = 7  #: rad/s
ROOT_MOMENTS = 8  #: in-plane and out-of-plane moment of each blade at its root, N m


FILTER_OFF, FILTER_LOADS, FILTER_FEEDBACK = 0, 1, 2
NO_SKEW, PITT_PETERS, VORTEX_CYLINDER = 0, 1, 2
CALM = 0.1  #: m/s, below which a ratio to the wind means nothing


class Rotor(NamedTuple):
    """What stays the same over a run, for the kernels."""

    air_density: float
    radius: float
    hub_radius: float
    cone: float
    blades: int  #: that are here; the momentum balance has its own number
    strips_per_blade: int
    momentum: Momentum
    induction: bool
    skewed_wake: int
    dynamic_inflow: bool
    unsteady_airfoil: bool
    three_quarter_chord: bool
    spanwise_filter: int
    tip_unloaded: bool
    root_unloaded: bool


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
    present state has lasted for ever. Out: ``after`` (m,16), ``strips`` (m,31), ``totals`` (8 + 2B)
    and the rows of ``force`` N and ``moment`` N m (.,3).
    """
    m = shape.shape[0]
    hub, shaft = row(position, m), axis(rotation, m, 0)
    turning = row(angular_velocity, m)
    for i in range(m):
        s.place_strip(
            i,
            shape,
            points,
            rotation,
            velocity,
            angular_velocity,
            wind,
            hub,
            shaft,
            turning,
            strips,
        )
        _balance(rotor, i, table, shape, before, after, strips)
    _mean_wind(strips, shape, wind, row(velocity, m), rotation, totals)
    _mean_induced(strips, shape, totals)
    if rotor.dynamic_inflow:
        for i in range(m):
            _delay(rotor, i, before, dt, totals, after, strips)
        _mean_induced(strips, shape, totals)
    for i in range(m):
        if rotor.skewed_wake != NO_SKEW:
            _skew(rotor, i, rotation, totals, strips)
        _section(rotor, i, table, stall, shape, before, dt, after, strips)
    if rotor.spanwise_filter != FILTER_OFF:
        _filter_lift(rotor, spanwise, shape, after, strips)
    for i in range(m):
        _load(rotor, i, shape, rotation, strips, force, moment)
    totals[ROTOR_SPEED] = dot(turning, shaft)
    _total(rotor, position, rotation, force, moment, totals)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _balance(
    rotor: Rotor, i: int, table: Array, shape: Array, before: Array, after: Array, strips: Array
) -> None:
    """The induced velocity that balances the static load of a strip."""
    after[i, LIFT_SHIFT] = 0.0
    if not rotor.induction:
        strips[i, s.INDUCED_NORMAL], strips[i, s.INDUCED_SWIRL], strips[i, s.LOSS] = 0.0, 0.0, 1.0
        return
    shift = before[i, LIFT_SHIFT] if rotor.spanwise_filter == FILTER_FEEDBACK else 0.0
    angle, induced, swirl, loss, _ = solve_strip(
        before[i, GUESS],
        table,
        i % rotor.strips_per_blade,
        strips[i, s.PITCH],
        strips[i, s.NORMAL_WIND],
        strips[i, s.TANGENTIAL_WIND],
        s.strip_balance(i, strips, shape, rotor.momentum.blades, shift),
        rotor.momentum,
    )
    after[i, GUESS] = angle
    strips[i, s.INDUCED_NORMAL], strips[i, s.INDUCED_SWIRL], strips[i, s.LOSS] = (
        induced,
        swirl,
        loss,
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _mean_wind(
    strips: Array, shape: Array, wind: Array, hub_velocity: Vector, rotation: Array, totals: Array
) -> None:
    """Mean over the rotor disc of the wind relative to the hub, in the hub's axes."""
    m = shape.shape[0]
    total, mean = 0.0, (0.0, 0.0, 0.0)
    for i in range(m):
        area = strips[i, s.RADIUS] * shape[i, s.WEIGHT] * strips[i, s.RADIAL]
        total += area
        mean = combine(1.0, mean, area, row(wind, i))
    mean = combine(1.0 / total, mean, -1.0, hub_velocity)
    for k in range(3):
        totals[MEAN_WIND + k] = dot(mean, axis(rotation, m, k))


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _mean_induced(strips: Array, shape: Array, totals: Array) -> None:
    """Mean over the rotor disc of the axial induced velocity, and the wake's skew from it."""
    total, induced = 0.0, 0.0
    for i in range(shape.shape[0]):
        area = strips[i, s.RADIUS] * shape[i, s.WEIGHT] * strips[i, s.RADIAL]
        total += area
        induced += area * strips[i, s.INDUCED_NORMAL] / strips[i, s.CONE]
    totals[MEAN_INDUCED] = induced / total
    in_plane = sqrt(totals[MEAN_WIND + 1] ** 2 + totals[MEAN_WIND + 2] ** 2)
    totals[SKEW] = half_skew_tangent(totals[MEAN_WIND], in_plane, totals[MEAN_INDUCED])


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _delay(
    rotor: Rotor, i: int, before: Array, dt: float, totals: Array, after: Array, strips: Array
) -> None:
    """Let the induced velocity of a strip follow its balance with the wake's delay."""
    normal, swirl = strips[i, s.INDUCED_NORMAL], strips[i, s.INDUCED_SWIRL]
    normal_lags, swirl_lags = after[i, NORMAL_LAGS], after[i, SWIRL_LAGS]
    if dt < 0.0:
        start_inflow(normal, normal_lags)
        start_inflow(swirl, swirl_lags)
        return
    wind, fraction = totals[MEAN_WIND], strips[i, s.RADIUS] / rotor.radius
    induction = totals[MEAN_INDUCED] / wind if abs(wind) > CALM else 0.0
    tau = slow_time_constant(wind, induction, rotor.radius)
    strips[i, s.INDUCED_NORMAL] = advance_inflow(
        before[i, NORMAL_LAGS], normal, dt, tau, fraction, normal_lags
    )
    strips[i, s.INDUCED_SWIRL] = advance_inflow(
        before[i, SWIRL_LAGS], swirl, dt, tau, fraction, swirl_lags
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _skew(rotor: Rotor, i: int, rotation: Array, totals: Array, strips: Array) -> None:
    """Vary the induced velocity of a strip over the turn where the wake leaves askew."""
    hub, outwards = strips.shape[0], s.vector(strips, i, s.OUTWARDS)
    cos_delta, sin_delta = skew_position(
        totals[MEAN_WIND + 1],
        totals[MEAN_WIND + 2],
        dot(outwards, axis(rotation, hub, 1)),
        dot(outwards, axis(rotation, hub, 2)),
    )
    cone, fraction = strips[i, s.CONE], strips[i, s.RADIUS] / rotor.radius
    axial, swirl = strips[i, s.INDUCED_NORMAL] / cone, strips[i, s.INDUCED_SWIRL]
    if rotor.skewed_wake == PITT_PETERS:
        axial, swirl = pitt_peters(axial, swirl, fraction, totals[SKEW], cos_delta)
    else:
        axial, swirl = vortex_cylinder(axial, swirl, fraction, totals[SKEW], cos_delta, sin_delta)
    strips[i, s.INDUCED_NORMAL], strips[i, s.INDUCED_SWIRL] = axial * cone, swirl


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _section(
    rotor: Rotor,
    i: int,
    table: Array,
    stall: Array,
    shape: Array,
    before: Array,
    dt: float,
    after: Array,
    strips: Array,
) -> None:
    """Relative velocity, angle of attack and coefficients of a strip."""
    station, chord = i % rotor.strips_per_blade, shape[i, s.CHORD]
    across = strips[i, s.NORMAL_WIND] - strips[i, s.INDUCED_NORMAL]
    along = strips[i, s.TANGENTIAL_WIND] + strips[i, s.INDUCED_SWIRL]
    strips[i, s.SPEED] = sqrt(across * across + along * along)
    strips[i, s.ACROSS], strips[i, s.ALONG] = across, along
    c, sn = strips[i, s.PITCH_COSINE], strips[i, s.PITCH_SINE]
    to_suction, to_trailing = across * c - along * sn, across * sn + along * c
    torsion, curving = 0.0, 0.0
    if rotor.three_quarter_chord:
        curving = strips[i, s.TURNING]
        torsion = strips[i, s.TORSION]  # steady coning bends the flow but accelerates no air
        to_suction += 0.5 * chord * curving
    angle = atan2(to_suction, to_trailing)
    strips[i, s.ANGLE_OF_ATTACK] = angle
    if not rotor.unsteady_airfoil:
        coefficients = section_coefficients(table, station, angle)
    else:
        curving -= torsion  # whose moment the unsteady section has
        start, end = before[i, STALL], after[i, STALL]
        if dt < 0.0:
            start_stall(end, table, station, stall, chord, to_suction, to_trailing, torsion)
            start = end.copy()
        coefficients = advance_stall(
            start,
            table,
            station,
            stall,
            chord,
            to_suction,
            to_trailing,
            torsion,
            max(dt, 0.0),
            end,
        )
    lift, drag, moment = coefficients
    moment += curved_flow_moment(stall[station, 0], chord, strips[i, s.SPEED], angle, curving)
    if (rotor.tip_unloaded and shape[i, s.TO_TIP] <= 0.0) or (
        rotor.root_unloaded and shape[i, s.TO_ROOT] <= 0.0
    ):
        lift, drag, moment = 0.0, 0.0, 0.0  # the loss factor is zero there, and so the circulation
    strips[i, s.LIFT], strips[i, s.DRAG], strips[i, s.MOMENT] = lift, drag, moment


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _filter_lift(rotor: Rotor, spanwise: Array, shape: Array, after: Array, strips: Array) -> None:
    """Let neighbouring sections of a blade share their circulation."""
    n = rotor.strips_per_blade
    around, circulation = np.empty(n), np.empty(n)
    for first in range(0, strips.shape[0], n):
        for j in range(n):
            k = first + j
            around[j] = max(strips[k, s.SPEED], CALM) * shape[k, s.CHORD]
            circulation[j] = around[j] * strips[k, s.LIFT]  # twice
        for i in range(n):
            filtered = 0.0
            for j in range(n):
                filtered += spanwise[i, j] * circulation[j]
            shift = filtered / around[i] - strips[first + i, s.LIFT]
            after[first + i, LIFT_SHIFT] = shift
            strips[first + i, s.LIFT] += shift


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _load(
    rotor: Rotor, i: int, shape: Array, rotation: Array, strips: Array, force: Array, moment: Array
) -> None:
    """Lump a strip's force and moment on its station's frame."""
    chord, weight = shape[i, s.CHORD], shape[i, s.WEIGHT]
    pressure = 0.5 * rotor.air_density * strips[i, s.SPEED] ** 2 * chord
    speed = max(strips[i, s.SPEED], 1e-9)
    c, sn = strips[i, s.ALONG] / speed, strips[i, s.ACROSS] / speed
    normal = pressure * (strips[i, s.LIFT] * c + strips[i, s.DRAG] * sn)
    tangential = pressure * (strips[i, s.LIFT] * sn - strips[i, s.DRAG] * c)
    strips[i, s.NORMAL_FORCE], strips[i, s.TANGENTIAL_FORCE] = normal, tangential
    across, against = s.vector(strips, i, s.NORMAL), s.vector(strips, i, s.TANGENT)
    lumped = combine(weight * normal, across, -weight * tangential, against)
    span = axis(rotation, i, 2)
    lever = combine(1.0, s.arm(rotation, shape, i), shape[i, s.OFFSET], span)
    twisting = pressure * chord * strips[i, s.MOMENT] * weight
    put(force, i, lumped)
    put(moment, i, combine(1.0, cross(lever, lumped), twisting, span))


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _total(
    rotor: Rotor, position: Array, rotation: Array, force: Array, moment: Array, totals: Array
) -> None:
    """Thrust along the shaft, torque about it and the moments at the blades' roots.

    The root axes cone with the blade and do not pitch: x downwind, y in the rotor plane.
    """
    n, blades = rotor.strips_per_blade, rotor.blades
    m = n * blades
    hub = row(position, m)
    shaft, left, up = axis(rotation, m, 0), axis(rotation, m, 1), axis(rotation, m, 2)
    c, sn = cos(rotor.cone), sin(rotor.cone)
    thrust, torque = 0.0, 0.0
    for blade in range(blades):
        turn = 2.0 * pi * blade / blades
        outwards = combine(cos(turn), up, -sin(turn), left)
        across = combine(cos(turn), left, sin(turn), up)
        about = combine(c, shaft, sn, outwards)
        root = scale(rotor.hub_radius, combine(c, outwards, -sn, shaft))
        total, total_moment = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for i in range(blade * n, (blade + 1) * n):
            lumped = row(force, i)
            lever = subtract(row(position, i), hub)
            total = add(total, lumped)
            total_moment = add(total_moment, add(row(moment, i), cross(lever, lumped)))
        thrust += dot(total, shaft)
        torque += dot(total_moment, shaft)
        at_root = subtract(total_moment, cross(root, total))
        totals[ROOT_MOMENTS + 2 * blade] = dot(at_root, about)
        totals[ROOT_MOMENTS + 2 * blade + 1] = dot(at_root, across)
    totals[THRUST], totals[TORQUE] = thrust, torque
