"""Dynamic inflow: the wake takes its time to follow the load (Oye's two-constant model).

Oye's model (Snel & Schepers, ECN-C--95-107, 1995; Hansen, Aerodynamics of Wind
Turbines, 2nd ed., ch. 9) filters the quasi-steady induced velocity W_qs in two steps:

    tau_1 W_int' + W_int = W_qs + k tau_1 W_qs',    tau_2 W' + W = W_int,    k = 0.6

    tau_1 = 1.1 / (1 - 1.3 min(a, 0.5)) R / U,      tau_2 = (0.39 - 0.26 (r/R)^2) tau_1

Because tau_2 / tau_1 depends on the radius alone, partial fractions split it into a
slow lag (tau_1) and a fast lag (tau_2) of W_qs, independent of each other:

    W = c L_tau1[W_qs] + (1 - c) L_tau2[W_qs],      c = (1 - k) / (1 - tau_2 / tau_1)

so no derivative of W_qs is needed and each part is integrated exactly.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from galerna.aero.bem.lag import FASTMATH, first_order_lag

COUPLING = 0.6  #: k
STATES = 3  #: slow lag, fast lag, quasi-steady value at the step's start
SLOWEST_TRANSPORT = 0.1  #: m/s; in a calm the wake still leaves, however slowly


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def slow_time_constant(wind_speed: float, axial_induction: float, rotor_radius: float) -> float:
    """tau_1 in s of the whole rotor.

    ``wind_speed`` m/s is the mean of the wind normal to the rotor (its sign is not
    used), ``axial_induction`` the mean over the rotor, ``rotor_radius`` in m.
    """
    transport = abs(wind_speed) * (1.0 - 1.3 * min(axial_induction, 0.5))
    return 1.1 * rotor_radius / max(transport, SLOWEST_TRANSPORT)


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def time_constant_ratio(radius_fraction: float) -> float:
    """tau_2 / tau_1 at r/R, held between its values at the hub and at the tip."""
    x = min(max(radius_fraction, 0.0), 1.0)
    return 0.39 - 0.26 * x * x


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def start_inflow(quasi_steady: float, state: NDArray[np.float64]) -> None:
    """Set ``state`` (3,) to the wake that has long seen ``quasi_steady`` m/s."""
    state[0] = quasi_steady
    state[1] = quasi_steady
    state[2] = quasi_steady


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def advance_inflow(
    state: NDArray[np.float64],
    quasi_steady: float,
    dt: float,
    tau_1: float,
    radius_fraction: float,
    advanced: NDArray[np.float64],
) -> float:
    """Induced velocity m/s at the step's end; call once for axial, once for tangential.

    ``state`` (3,) m/s holds the slow lag, the fast lag and the quasi-steady velocity at
    the step's start and is not changed; ``advanced`` (3,) receives the same at its end.
    ``quasi_steady`` m/s is the velocity in balance with the load at the step's end,
    taken as linear over the step. Exact for such input, stable for any ``dt``.
    """
    ratio = time_constant_ratio(radius_fraction)
    advanced[0] = first_order_lag(state[0], state[2], quasi_steady, dt / tau_1)
    advanced[1] = first_order_lag(state[1], state[2], quasi_steady, dt / (ratio * tau_1))
    advanced[2] = quasi_steady
    slow_share = (1.0 - COUPLING) / (1.0 - ratio)
    return slow_share * advanced[0] + (1.0 - slow_share) * advanced[1]
