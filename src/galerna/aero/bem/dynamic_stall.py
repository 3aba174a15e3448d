"""Unsteady section aerodynamics: the Beddoes-Leishman model in state-space form.

After Hansen, Gaunaa & Madsen, "A Beddoes-Leishman type dynamic stall model in
state-space and indicial formulations", Riso-R-1354(EN), 2004: the wake shed by the
section delays the effective angle of attack (two states), the pressure delays the
separation (one), and the separation point its own way back (one). Their model has no
leading-edge vortex: thick sections separate from the trailing edge.

Three things are written differently, without changing the model where it holds:

- The wake's states lag the velocity normal to the chord, w = U sin(alpha), instead of
  the angle. The paper's terms in dU/dt then follow by themselves, and nothing jumps
  where an angle passes +-180 deg.
- cl = cl_st(alpha_E) + (f - f_st(alpha_E)) (cl_att - cl_fs)(alpha_E), equal to the paper's
  f cl_att + (1 - f) cl_fs, gives back the static polar exactly in steady flow, also where
  the polar lies above the line of the attached lift. The difference cl_att - cl_fs has the
  closed form cl_att (3 + sqrt(f)) / (4 + 4 sqrt(f)), free of the paper's 0/0 at f = 1.
- Theory (Garrick, NACA 567, 1936) puts the induced drag of the shed wake at
  (alpha_34 - alpha_E) times the circulatory lift, and the lift of the pitch rate normal to
  the chord: that is the drag used here.

Left out is the paper's shift of the moment with the separation point: cm is the polar's at
alpha_E and the pitch rate's, because the shift divides by a lift that passes zero.

The model describes attached and lightly separated flow from the front. Between
BLEND_START and BLEND_END of |alpha| its answer fades into the static polar.
"""

from __future__ import annotations

from math import atan2, cos, pi, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.aero.bem.attached_flow import attached_line
from galerna.aero.bem.lag import FASTMATH, first_order_lag

Array = NDArray[np.float64]

STATES = 8  #: two wake lags, pressure angle, separation point, and the four inputs of the lags
JONES = (0.165, 0.335, 0.0455, 0.3)  #: A1, A2, b1, b2 of the flat plate (R. T. Jones, NACA 681)
PRESSURE_LAG, SEPARATION_LAG = 1.7, 3.0  #: T_p, T_f in half-chords (Hansen et al., 2004)
BLEND_START, BLEND_END = pi / 4.0, pi / 3.0
SLOWEST_PASSAGE = 50.0  #: s, largest c / 2U, so that a calm leaves finite time constants
UNDECIDED = np.radians(2.5)  #: about zero lift, where Kirchhoff's quotient is 0/0

COLUMNS = 5  #: cl, cd, cm, f_st, cl_att - cl_fs
PARAMETERS = 8  #: see section_parameters


def separation_table(table: Array, zero_lift_angle: Array) -> tuple[Array, Array]:
    """What the model needs of static polars beside themselves.

    ``table`` (n,m,3) holds cl, cd, cm of n sections on m angles evenly from -pi to pi;
    ``zero_lift_angle`` (n,) rad says near which angle the lift passes zero. Returns the
    table with two further columns (n,m,5), the static separation point f_st and
    cl_att - cl_fs, and (n,3): the slope of the attached lift 1/rad, the zero-lift angle rad
    and the drag coefficient there. A section without lift has slope 0 and stays static.
    Source: Hansen et al. (2004), their separation function and fully separated lift; the
    slope is the attached line's, as theirs, the steepest chord of the polar, takes a kink
    near zero lift for the slope.
    """
    angle = np.linspace(-pi, pi, table.shape[1])
    wide = np.zeros((*table.shape[:2], COLUMNS))
    wide[..., :3] = table
    lift_line = np.zeros((len(table), 3))
    for section, near in enumerate(zero_lift_angle):
        lift = table[section, :, 0]
        zero, slope = attached_line(angle, lift, near)
        point = _separation_point(angle, lift, zero, slope)
        attached = slope * (angle - zero)
        root = np.sqrt(point)
        closed = attached * (3.0 + root) / (4.0 + 4.0 * root)
        wide[section, :, 3] = point
        wide[section, :, 4] = np.where(point > 0.0, closed, attached - lift) * (slope > 0.0)
        lift_line[section] = slope, zero, np.interp(zero, angle, table[section, :, 1])
    return wide, lift_line


def _separation_point(angle: Array, lift: Array, zero: float, slope: float) -> Array:
    """Kirchhoff's f_st (m,), 0 from where the flow first separates fully on either side.

    Within UNDECIDED of zero lift the quotient says nothing: f_st runs straight across.
    """
    if slope == 0.0:
        return np.ones_like(lift)
    away = np.abs(angle - zero) > UNDECIDED
    ratio = np.divide(lift, slope * (angle - zero), out=np.ones_like(lift), where=away)
    root = np.clip(2.0 * np.sqrt(np.clip(ratio, 0.0, 1.0)) - 1.0, 0.0, 1.0)
    point = np.interp(angle, angle[away], root[away] ** 2)
    attached = (point > 0.0) | ~away
    start = int(np.searchsorted(angle, zero))
    attached[start:] = np.logical_and.accumulate(attached[start:])
    attached[:start] = np.logical_and.accumulate(attached[:start][::-1])[::-1]
    return np.where(attached, point, 0.0)


def section_parameters(
    lift_line: Array,
    indicial: Array,
    pressure_lag: float = PRESSURE_LAG,
    separation_lag: float = SEPARATION_LAG,
) -> Array:
    """One row (n,8) of constants per section, as ``advance_stall`` takes them.

    ``lift_line`` (n,3) comes from ``separation_table``; ``indicial`` (4,) or (n,4) holds A1,
    A2, b1, b2 of the response to a step of downwash, such as ``JONES``; the lags T_p and
    T_f are in half-chords travelled.
    """
    rows = np.empty((len(lift_line), PARAMETERS))
    rows[:, 0], rows[:, 1] = lift_line[:, 0], lift_line[:, 2]
    rows[:, 2:6] = indicial
    rows[:, 6], rows[:, 7] = pressure_lag, separation_lag
    return rows


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _look_up(table: Array, section: int, angle: float) -> tuple[float, float, float, float, float]:
    """All columns of the wide table at any angle rad, linear on its even grid."""
    last = table.shape[1] - 1
    place = (angle + pi) * (last / (2.0 * pi))
    place -= last * np.floor(place / last)
    left = min(int(place), last - 1)
    t = place - left
    i, j, u = section, left + 1, 1.0 - t
    return (
        u * table[i, left, 0] + t * table[i, j, 0],
        u * table[i, left, 1] + t * table[i, j, 1],
        u * table[i, left, 2] + t * table[i, j, 2],
        u * table[i, left, 3] + t * table[i, j, 3],
        u * table[i, left, 4] + t * table[i, j, 4],
    )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def passage(chord: float, speed: float) -> float:
    """T_u = c / 2U in s."""
    return min(0.5 * chord / max(speed, 1e-9), SLOWEST_PASSAGE)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _pressure_angle(effective: float, slope: float, rate_lift: float) -> float:
    """Angle rad whose attached lift is the unlagged cl of the pressure, within +-90 deg."""
    angle = effective + (rate_lift / slope if slope > 0.0 else 0.0)
    return min(max(angle, -0.5 * pi), 0.5 * pi)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _rate_lift(slope: float, passage: float, torsion_rate: float) -> float:
    """pi T_u omega, the lift of the pitch rate; it fades for sections that hardly lift."""
    return pi * min(slope / (2.0 * pi), 1.0) * passage * torsion_rate


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def model_share(angle: float) -> float:
    """1 in flow from the front, 0 beyond BLEND_END, a half cosine between."""
    if abs(angle) <= BLEND_START:
        return 1.0
    if abs(angle) >= BLEND_END:
        return 0.0
    return 0.5 + 0.5 * cos(pi * (abs(angle) - BLEND_START) / (BLEND_END - BLEND_START))


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def start_stall(
    state: Array,
    table: Array,
    section: int,
    parameters: Array,
    chord: float,
    normal_velocity: float,
    chordwise_velocity: float,
    torsion_rate: float,
) -> None:
    """Set ``state`` (8,) to the flow that has long been as given; see ``advance_stall``."""
    slope = parameters[section, 0]
    speed = sqrt(normal_velocity**2 + chordwise_velocity**2)
    rate_lift = _rate_lift(slope, passage(chord, speed), torsion_rate)
    angle = _pressure_angle(atan2(normal_velocity, chordwise_velocity), slope, rate_lift)
    point = _look_up(table, section, angle)[3]
    state[0] = normal_velocity
    state[1] = normal_velocity
    state[2] = angle
    state[3] = point
    state[4] = normal_velocity
    state[5] = speed
    state[6] = angle
    state[7] = point


@njit(cache=True, error_model="numpy", fastmath=FASTMATH, inline="always")
def _advance_lags(
    state: Array,
    table: Array,
    section: int,
    parameters: Array,
    chord: float,
    normal_velocity: float,
    chordwise_velocity: float,
    torsion_rate: float,
    dt: float,
    advanced: Array,
) -> tuple[float, float]:
    """Write the state at the step's end; return alpha_E rad and the lift of the pitch rate."""
    slope = parameters[section, 0]
    a_1, a_2 = parameters[section, 2], parameters[section, 3]
    b_1, b_2 = parameters[section, 4], parameters[section, 5]
    speed = sqrt(normal_velocity**2 + chordwise_velocity**2)
    travelled = dt / passage(chord, 0.5 * (state[5] + speed))

    advanced[0] = first_order_lag(state[0], state[4], normal_velocity, b_1 * travelled)
    advanced[1] = first_order_lag(state[1], state[4], normal_velocity, b_2 * travelled)
    downwash = (1.0 - a_1 - a_2) * normal_velocity + a_1 * advanced[0] + a_2 * advanced[1]
    effective = atan2(downwash, chordwise_velocity)

    rate_lift = _rate_lift(slope, passage(chord, speed), torsion_rate)
    unlagged = _pressure_angle(effective, slope, rate_lift)
    advanced[2] = first_order_lag(state[2], state[6], unlagged, travelled / parameters[section, 6])
    static_point = _look_up(table, section, advanced[2])[3]
    point = first_order_lag(state[3], state[7], static_point, travelled / parameters[section, 7])
    advanced[3] = min(max(point, 0.0), 1.0)  # against rounding alone
    advanced[4] = normal_velocity
    advanced[5] = speed
    advanced[6] = unlagged
    advanced[7] = static_point
    return effective, rate_lift


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def advance_stall(
    state: Array,
    table: Array,
    section: int,
    parameters: Array,
    chord: float,
    normal_velocity: float,
    chordwise_velocity: float,
    torsion_rate: float,
    dt: float,
    advanced: Array,
) -> tuple[float, float, float]:
    """Unsteady cl, cd, cm of a section at the step's end.

    ``state`` (8,) at the step's start is not changed; ``advanced`` (8,) receives it at the
    end: the two lags of w m/s, the pressure's angle rad, the separation point, and the
    inputs w, U, unlagged angle and separation. ``table`` (n,m,5) and ``parameters`` (n,8)
    come from ``separation_table`` and ``section_parameters``. The velocity of the air
    relative to the three-quarter chord point, m/s, has the parts ``normal_velocity`` (to
    the suction side) and ``chordwise_velocity`` (to the trailing edge);
    ``torsion_rate`` rad/s is nose-up positive; ``chord`` in m.

    The lags are exact for inputs linear over the step and stable for any ``dt``; at
    ``dt`` = 0 the lags are read as they stand. cl and cd are across and along the flow.
    """
    effective, rate_lift = _advance_lags(
        state,
        table,
        section,
        parameters,
        chord,
        normal_velocity,
        chordwise_velocity,
        torsion_rate,
        dt,
        advanced,
    )
    angle = atan2(normal_velocity, chordwise_velocity)
    share = model_share(angle)
    if share == 0.0:
        static = _look_up(table, section, angle)
        return static[0], static[1], static[2]
    point, drag_at_zero = advanced[3], parameters[section, 1]
    lift, drag, moment, static_point, attached_gain = _look_up(table, section, effective)
    circulatory = lift + (point - static_point) * attached_gain
    separation = 0.5 * (sqrt(static_point) - sqrt(point)) - 0.25 * (static_point - point)
    rate_share = rate_lift / max(advanced[5], 1e-9)
    cl = circulatory + rate_share * chordwise_velocity
    cd = drag + (drag - drag_at_zero) * separation
    cd += circulatory * (angle - effective) + rate_share * normal_velocity
    cm = moment - 0.5 * rate_lift
    if share < 1.0:
        static = _look_up(table, section, angle)
        cl = static[0] + share * (cl - static[0])
        cd = static[1] + share * (cd - static[1])
        cm = static[2] + share * (cm - static[2])
    return cl, cd, cm
