"""Momentum balance of one strip: a single residual in the inflow angle that always has a root.

After Ning (2014), "A simple solution method for the blade element momentum equations with
guaranteed convergence", Wind Energy 17, 1327-1345, the inflow angle phi is the unknown. The
thrust balance gives the relative speed W(phi), the force on the mass flow is parallel to the
velocity that it induces, u_t / u_n = Ct / Cn, and the residual is the balance of the in-plane
velocities,

    W cos(phi) - u_t - U_t = 0

with U_n, U_t the velocities without the rotor, u_n = a U_n the induced velocity against the
wind and u_t the swirl. The thrust curve is continued through a = 1, where the flow reverses,
so W(phi) is one continuous positive branch, infinite at both ends of its interval: the residual
goes from plus to minus infinity between -pi/2 and 3 pi/2 for every U_t, zero and negative
included, and a bracket of the root is known without a search. Divided by W it stays finite.
Wind from behind is the same problem mirrored.
"""

from __future__ import annotations

from math import acos, cos, exp, pi, sin, sqrt
from typing import NamedTuple

from numba import njit

from galerna.aero.bem.options import BemOptions
from galerna.aero.sections import section_coefficients
from galerna.contract import Array

FASTMATH = {"reassoc", "contract", "arcp", "nsz", "afn"}
HIGH_THRUST = {"buhl": 0, "glauert": 1, "wilson_walker": 2, "madsen": 3}
MADSEN = (0.0883, 0.0586, 0.2460)  #: of C_T^3, C_T^2 and C_T
LOWEST_LOSS = 1e-3  #: keeps the balance finite at the very tip and root
STANDSTILL = 1e-12  #: of U_n / W; what is below counts as no answer
SLOWEST = 1e-6  #: m/s; a normal velocity below this counts as this one
FLATTEST = 1e-15  #: of sin(phi), so that what divides by it stays finite
TOLERANCE = 1e-10  #: of the residual, which is of order 1
NARROWEST = 1e-14  #: rad, of a bracket
PATIENCE = 8  #: evaluations of false position alone
FIRST_STEP, LARGEST_STEP = 1e-7, 0.1  #: rad, bounds of the first bracket around the guess


Strip = tuple[float, float, float, float, float, float]


class Momentum(NamedTuple):
    """Switches of the momentum balance as numbers, for the kernels."""

    blades: float
    tip_loss: float
    root_loss: float
    high_thrust: int
    drag_axial: float
    swirl: float
    drag_swirl: float

    @classmethod
    def of(cls, options: BemOptions, blades: int) -> Momentum:
        """The switches of ``options`` for a rotor with this number of blades."""
        return cls(
            float(blades),
            float(options.tip_loss),
            float(options.root_loss),
            HIGH_THRUST[options.high_thrust],
            float(options.drag_in_axial_induction),
            float(options.tangential_induction),
            float(options.drag_in_tangential_induction),
        )


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def prandtl_loss(exponent: float, sine: float) -> float:
    """Prandtl's factor F = 2/pi arccos(exp(-exponent / |sin(phi)|)), 1 to within 1e-8.

    ``exponent`` is B/2 (R - r)/r at the tip and B/2 (r - R_root)/R_root at the root.
    """
    size = max(abs(sine), 1e-9)
    if exponent > 18.0 * size:
        return 1.0
    return 2.0 / pi * acos(exp(-exponent / size))


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _madsen_slowness(load: float, sine: float) -> float:
    """U_n / W where 1 - a = W sin(phi) / U_n and C_T / F = 4 load (W / U_n)^2.

    Newton's method from above on a function of W / U_n that is convex for a positive load.
    """
    if load <= 0.0:  # a propeller: momentum theory
        return (sine * sine + load) / sine if sine > 0.0 else -1.0
    a_3, a_2, a_1 = MADSEN
    ratio = (1.0 + 2.0 * abs(sine) / sqrt(load)) / sqrt(load)
    for _ in range(60):
        thrust = 4.0 * load * ratio * ratio
        value = ((a_3 * thrust + a_2) * thrust + a_1) * thrust + sine * ratio - 1.0
        slope = ((3.0 * a_3 * thrust + 2.0 * a_2) * thrust + a_1) * 2.0 * thrust / ratio + sine
        step = value / slope
        ratio -= step
        if abs(step) < 1e-13 * ratio:
            break
    return 1.0 / ratio


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def _turbulent_slowness(load: float, loss: float, sine: float, high_thrust: int) -> float:
    """U_n / W from the empirical thrust of the turbulent wake state, for a positive load."""
    square = sine * sine
    if high_thrust == 2:
        tangent, crossing = 0.6, 0.64  # 1 - 2 a and (1 - a)^2 at a = 0.2
        return (tangent * sine + sqrt(tangent**2 * square + 4.0 * load * crossing)) / (
            2.0 * crossing
        )
    loss = loss if high_thrust == 0 else 1.0
    reversed_flow = sine < 0.0  # a > 1: on along the tangent
    bend = (5.0 / 3.0 - loss) ** 2 if reversed_flow else loss * (loss - 4.0 / 3.0)
    root = 2.0 * loss * load + bend * square
    return sqrt(root) + (5.0 / 3.0 - loss) * sine if root > 0.0 else -1.0


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def slowness(load: float, loss: float, sine: float, high_thrust: int) -> float:
    """U_n / W from the thrust balance at an inflow angle; not positive where there is none.

    ``load`` is sigma Cn / (4 F), so that kappa = load / sin^2(phi). Up to a = 0.4 (0.2 for
    Wilson and Walker) it is momentum theory, W sin(phi) = U_n / (1 + kappa). Beyond, the
    empirical thrust: Buhl (2005), NREL/TP-500-36834; Glauert's parabola times F; or the
    tangent from a = 0.2 of Wilson and Walker (1984). Each is solved for 1 - a in closed form.
    Madsen et al. (2020), Wind Energ. Sci. 5, 1-27, have one polynomial a(C_T / F) for all.
    Where the flow reverses, a > 1, the curves go on straight (Madsen's as it is) up to the
    propeller brake, C_T = 4 F a (a - 1), which is momentum theory again.
    """
    square = sine * sine
    critical = 0.2 if high_thrust == 2 else 0.4
    if high_thrust == 3:
        slow = _madsen_slowness(load, sine)
    elif sine > 0.0 and load * (1.0 - critical) <= critical * square:
        return (square + load) / sine
    elif load <= 0.0:
        return -1.0
    else:
        slow = _turbulent_slowness(load, loss, sine, high_thrust)
    return min(slow, (square - load) / sine) if sine < 0.0 else slow


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def balance(
    phi: float,
    table: Array,
    station: int,
    pitch: float,
    normal: float,
    tangential: float,
    strip: Strip,
    switches: Momentum,
) -> tuple[float, float, float, float]:
    """Residual at ``phi``, U_n / W, swirl over W and loss factor.

    The residual is that of the module times U_n / W over U_n + |U_t|, so of order 1.
    ``normal`` > 0; ``pitch`` is the angle from the rotor plane to the chord. ``strip`` holds
    the solidities of the normal and the tangential balance, the exponents of tip and root
    loss, the sign that mirrors the section when the wind comes from behind, and a lift
    coefficient to add to the polar's.
    """
    sigma_normal, sigma_tangential, tip, root, mirror, lift_shift = strip
    sine, cosine = sin(phi), cos(phi)
    sine = sine if abs(sine) > FLATTEST else FLATTEST
    lift, drag, _ = section_coefficients(table, station, mirror * phi - pitch)
    lift = mirror * (lift + lift_shift)
    loss = 1.0
    if switches.tip_loss > 0.0:
        loss = prandtl_loss(tip, sine)
    if switches.root_loss > 0.0:
        loss *= prandtl_loss(root, sine)
    loss = max(loss, LOWEST_LOSS)
    force_normal = lift * cosine + switches.drag_axial * drag * sine
    force_tangential = lift * sine - switches.drag_swirl * drag * cosine
    load = sigma_normal * force_normal / (4.0 * loss)
    slow = slowness(load, loss, sine, switches.high_thrust)
    if slow <= STANDSTILL:
        return (1.0 if cosine > 0.0 else -1.0), slow, 0.0, loss
    swirl = 0.0
    if switches.swirl > 0.0:
        if abs(load) > 1e-9 * abs(sine):
            induced = slow - sine
            swirl = induced * sigma_tangential * force_tangential / (sigma_normal * force_normal)
        else:
            swirl = sigma_tangential * force_tangential / (4.0 * loss * sine)
    residual = normal * (cosine - swirl) - tangential * slow
    return residual / (normal + abs(tangential)), slow, swirl, loss


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def solve_strip(
    guess: float,
    table: Array,
    station: int,
    pitch: float,
    normal: float,
    tangential: float,
    strip: Strip,
    switches: Momentum,
) -> tuple[float, float, float, float, int]:
    """Inflow angle, induced velocity against the wind, swirl (m/s), loss factor, evaluations.

    ``normal`` may have any sign (``strip`` carries the matching mirror). The root is bracketed
    from ``guess`` outwards, where a bracket is certain since the
    ends have their own signs, and refined with the false position of
    Anderson and Bjorck (1973); should that be slow, bisection takes every second turn.
    """
    mirror = strip[4]
    normal = max(abs(normal), SLOWEST)
    low, high = -0.5 * pi, 1.5 * pi
    at = guess if low < guess < high else 0.0
    value, slow, swirl, loss = balance(
        at, table, station, pitch, normal, tangential, strip, switches
    )
    step = min(max(2.0 * abs(value), FIRST_STEP), LARGEST_STEP)  # the slope is of order 1
    step = step if value > 0.0 else -step
    other, other_value, evaluations = at, value, 1
    while value * other_value > 0.0 and low < at < high and abs(value) > TOLERANCE:
        other, other_value = at, value
        at = min(max(at + step, low), high)
        value, slow, swirl, loss = balance(
            at, table, station, pitch, normal, tangential, strip, switches
        )
        step *= 4.0
        evaluations += 1
    if at in (low, high):
        value = 1.0 if at == low else -1.0  # in exact arithmetic
    end = evaluations + PATIENCE
    while abs(value) > TOLERANCE and abs(at - other) > NARROWEST:
        trial = at - value * (at - other) / (value - other_value)
        if evaluations > end and evaluations % 2 == 0:
            trial = 0.5 * (at + other)
        trial_value, slow, swirl, loss = balance(
            trial, table, station, pitch, normal, tangential, strip, switches
        )
        if trial_value * value < 0.0:
            other, other_value = at, value
        else:
            shrink = 1.0 - trial_value / value
            other_value *= shrink if shrink > 0.0 else 0.5
        at, value = trial, trial_value
        evaluations += 1
    if slow <= STANDSTILL:  # the root lies within rounding of the end of W(phi)
        at = other
        value, slow, swirl, loss = balance(
            at, table, station, pitch, normal, tangential, strip, switches
        )
    speed = normal / slow if slow > STANDSTILL else 0.0
    return at, mirror * (normal - speed * sin(at)), swirl * speed, loss, evaluations
