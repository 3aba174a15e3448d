"""Momentum balance of one strip: a single residual in the inflow angle that always has a root.

After Ning (2014), "A simple solution method for the blade element momentum equations with
guaranteed convergence", Wind Energy 17, 1327-1345, the inflow angle phi is the unknown. The
thrust balance gives the relative speed W(phi); the residual is the balance of the in-plane
velocities,

    W cos(phi) - u_t - U_t = 0,   u_n / u_t = Cn / Ct   (the force on the mass flow is parallel
                                                         to the velocity it induces)

with U_n, U_t the velocities without the rotor, u_n = a U_n the induced velocity against the
wind and u_t the swirl. The thrust curve is continued through a = 1, where the flow reverses,
so W(phi) is one smooth positive branch, infinite at both ends of its interval: the residual
goes from plus to minus infinity between -pi/2 and 3 pi/2 for every U_t, zero and negative
included, and a bracket of the root is known without a search. Wind from behind is the same
problem mirrored.
"""

from __future__ import annotations

from math import acos, cos, exp, pi, sin, sqrt
from typing import NamedTuple

from numba import njit

from galerna.aero.bem.options import BemOptions
from galerna.aero.sections import section_coefficients

FASTMATH = {"reassoc", "contract", "arcp", "nsz", "afn"}
HIGH_THRUST = {"buhl": 0, "glauert": 1, "wilson_walker": 2}
LOWEST_LOSS = 1e-3  #: keeps the balance finite at the very tip and root
SLOWEST = 1e-6  #: m/s; a normal velocity below this counts as this one
TOLERANCE = 1e-9  #: rad, of the inflow angle
FIRST_STEP = 0.01  #: rad, width of the first bracket around the guess
MOST_ITERATIONS = 100


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
def prandtl_loss(exponent, sine):  # type: ignore[no-untyped-def]
    """Prandtl's factor F = 2/pi arccos(exp(-exponent / |sin(phi)|)), not below LOWEST_LOSS.

    ``exponent`` is B/2 (R - r)/r at the tip and B/2 (r - R_root)/R_root at the root.
    """
    return max(2.0 / pi * acos(exp(-exponent / max(abs(sine), 1e-9))), LOWEST_LOSS)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def speed_ratio(balance, loss, sine, high_thrust):  # type: ignore[no-untyped-def]
    """W / U_n from the thrust balance at an inflow angle; infinity where none exists.

    ``balance`` is sigma Cn / (4 F), so kappa = balance / sin^2(phi). Up to a = 0.4 (0.2 for
    Wilson and Walker) it is momentum theory, W sin(phi) = U_n / (1 + kappa). Beyond, the
    empirical thrust: Buhl (2005), NREL/TP-500-36834; Glauert's parabola times F; or the
    tangent from a = 0.2 of Wilson and Walker (1984). Each is solved for 1 - a in closed form.
    """
    square = sine * sine
    critical = 0.2 if high_thrust == 2 else 0.4
    if sine > 0.0 and balance * (1.0 - critical) <= critical * square:
        below = square + balance
        return sine / below if below > 0.0 else float("inf")
    if high_thrust == 2:
        tangent, crossing = 1.0 - 2.0 * critical, (1.0 - critical) ** 2
        root = (tangent * sine) ** 2 + 4.0 * balance * crossing
        below = tangent * sine + sqrt(max(root, 0.0))
        return 2.0 * crossing / below if balance > 0.0 and below > 0.0 else float("inf")
    loss = loss if high_thrust == 0 else 1.0
    root = 2.0 * loss * balance - loss * (4.0 / 3.0 - loss) * square
    below = sqrt(max(root, 0.0)) + (5.0 / 3.0 - loss) * sine
    return 1.0 / below if root > 0.0 and below > 0.0 else float("inf")


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def balance(phi, table, station, pitch, normal, tangential, strip, switches):  # type: ignore[no-untyped-def]
    """Residual of the in-plane velocities (m/s), W, swirl u_t and loss factor at ``phi``.

    ``normal`` > 0; ``pitch`` is the angle from the rotor plane to the chord. ``strip`` holds
    the solidities of the normal and the tangential balance, the exponents of tip and root
    loss, the sign that mirrors the section when the wind comes from behind, and a lift
    coefficient to add to the polar's.
    """
    sigma_normal, sigma_tangential, tip, root, mirror, lift_shift = strip
    sine, cosine = sin(phi), cos(phi)
    lift, drag, _ = section_coefficients(table, station, mirror * phi - pitch)
    lift = mirror * (lift + lift_shift)
    loss = 1.0
    if switches.tip_loss > 0.0:
        loss = prandtl_loss(tip, sine)
    if switches.root_loss > 0.0:
        loss *= prandtl_loss(root, sine)
    force_normal = lift * cosine + switches.drag_axial * drag * sine
    force_tangential = lift * sine - switches.drag_swirl * drag * cosine
    load = sigma_normal * force_normal / (4.0 * loss)
    ratio = speed_ratio(load, loss, sine, switches.high_thrust)
    far = 1e3 * (normal + abs(tangential))
    if not ratio * normal < far:
        return (far if cosine > 0.0 else -far), far, 0.0, loss
    speed = ratio * normal
    swirl = 0.0
    if switches.swirl > 0.0:
        if abs(load) > 1e-9 * abs(sine):
            induced = normal - speed * sine
            swirl = induced * sigma_tangential * force_tangential / (sigma_normal * force_normal)
        else:
            swirl = speed * sigma_tangential * force_tangential / (4.0 * loss * sine)
    return speed * cosine - swirl - tangential, speed, swirl, loss


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def solve_strip(guess, table, station, pitch, normal, tangential, strip, switches):  # type: ignore[no-untyped-def]
    """Inflow angle, induced velocity against the wind, swirl (m/s), loss factor and evaluations.

    ``normal`` may have any sign (``strip`` carries the matching mirror). The root is bracketed
    from ``guess`` outwards and refined with the false position of Anderson and Bjorck (1973).
    """
    mirror = strip[4]
    normal = max(abs(normal), SLOWEST)
    low, high = -0.5 * pi, 1.5 * pi
    at = min(max(guess, low), high)
    value, speed, swirl, loss = balance(
        at, table, station, pitch, normal, tangential, strip, switches
    )
    step = FIRST_STEP if value > 0.0 else -FIRST_STEP
    evaluations = 1
    other, other_value = at, value
    while value * other_value > 0.0:  # both ends of the whole interval have their sign
        other, other_value = at, value
        at = min(max(at + step, low), high)
        value, speed, swirl, loss = balance(
            at, table, station, pitch, normal, tangential, strip, switches
        )
        step *= 4.0
        evaluations += 1
    while abs(at - other) > TOLERANCE and value != 0.0 and evaluations < MOST_ITERATIONS:
        trial = at - value * (at - other) / (value - other_value)
        trial_value, speed, swirl, loss = balance(
            trial, table, station, pitch, normal, tangential, strip, switches
        )
        if trial_value * value < 0.0:
            other, other_value = at, value
        else:
            shrink = 1.0 - trial_value / value
            other_value *= shrink if shrink > 0.0 else 0.5
        converged = abs(trial - at) < TOLERANCE
        at, value = trial, trial_value
        evaluations += 1
        if converged:
            break
    return at, mirror * (normal - speed * sin(at)), swirl, loss, evaluations
