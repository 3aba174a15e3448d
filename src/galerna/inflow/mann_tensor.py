"""Mann's spectral tensor of sheared turbulence.

Mann, J. (1994), The spatial structure of neutral atmospheric surface-layer
turbulence, J. Fluid Mech. 273, 141-168; equation numbers are those of Mann, J.
(1998), Wind field simulation, Prob. Eng. Mech. 13 (4), 269-282. Axes: x
downwind, y to the left, z up, with dU/dz > 0.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import ArrayLike
from scipy.special import beta, betainc

from galerna.contract import Array

#: where the components 11, 22, 33, 12, 13, 23 stand in a symmetric matrix
SYMMETRIC = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])

Tensor = tuple[float, float, float, float, float, float]

# Eddy lifetime: the hypergeometric function of the model is an incomplete beta function,
# 2F1(1/3, 17/6; 4/3; -1/x^2) x^-2/3 = B(1/3, 5/2)/3 I_s(1/3, 5/2), s = 1/(1 + x^2). Divided by
# s^(1/3) it is smooth over the whole range 0 <= s <= 1 and a table of it is exact to 1e-8.
_SHARE = np.linspace(0.0, 1.0, 4097)
_INTEGRAL = np.ones_like(_SHARE)
_INTEGRAL[1:] = beta(1 / 3, 5 / 2) / 3 * betainc(1 / 3, 5 / 2, _SHARE[1:]) / np.cbrt(_SHARE[1:])
_LIFETIME = 1.0 / np.sqrt(_INTEGRAL)

FAST = {"reassoc", "contract", "arcp", "nsz", "afn"}


def eddy_lifetime(kl: ArrayLike) -> Array:
    """Lifetime of eddies times dU/dz over Gamma, at wavenumber times length scale (n,).

    (kL)^-2/3 [2F1(1/3, 17/6; 4/3; -(kL)^-2)]^-1/2: Mann (1994) eq. 3.6, (1998) eq. 21.
    """
    x = np.asarray(kl, dtype=np.float64)
    share = 1.0 / (1.0 + x**2)
    return 1.0 / (x * np.sqrt(beta(1 / 3, 5 / 2) / 3 * betainc(1 / 3, 5 / 2, share)))


@njit(cache=True, error_model="numpy", fastmath=FAST, inline="always")
def _lifetime(kl2: float) -> float:
    """``eddy_lifetime`` at the square of kL, from the table."""
    share = 1.0 / (1.0 + kl2)
    place = share * 4096.0
    i = min(int(place), 4095)
    value = _LIFETIME[i] + (place - i) * (_LIFETIME[i + 1] - _LIFETIME[i])
    return value * (1.0 + kl2) ** (1.0 / 6.0) / math.sqrt(kl2)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def sheared_tensor(k1: float, k2: float, k3: float, gamma: float) -> Tensor:
    """Components 11, 22, 33, 12, 13, 23 at k L, for L = 1 and alpha epsilon^(2/3) = 1.

    The tensor of a length scale L is L^(11/3) times this one at the wavenumbers k L.
    ``k1`` must not be zero. Mann (1998) eqs. 16-20 and 22-23.
    """
    h2 = k1 * k1 + k2 * k2
    k_2 = h2 + k3 * k3
    b1 = gamma * _lifetime(k_2) * k1  # beta k1
    k30 = k3 + b1
    k0_2 = h2 + k30 * k30
    c1 = b1 * k1 * (k0_2 - 2.0 * k30 * k30 + b1 * k30) / (k_2 * h2)
    h = math.sqrt(h2)
    c2 = k2 * k0_2 / (h2 * h) * math.atan2(b1 * h, k0_2 - k30 * b1)
    zeta1 = c1 - k2 / k1 * c2
    zeta2 = k2 / k1 * c1 + c2
    # E(k0) / (4 pi k0^4) of von Karman's spectrum; one k0^2 gives way to k^2 for each w
    energy = (1.0 + k0_2) ** (-17.0 / 6.0) / (4.0 * math.pi)
    stretch = k0_2 / k_2
    return (
        energy * (k0_2 - k1 * k1 - 2.0 * k1 * k30 * zeta1 + h2 * zeta1 * zeta1),
        energy * (k0_2 - k2 * k2 - 2.0 * k2 * k30 * zeta2 + h2 * zeta2 * zeta2),
        energy * h2 * stretch * stretch,
        energy * (-k1 * k2 - k1 * k30 * zeta2 - k2 * k30 * zeta1 + h2 * zeta1 * zeta2),
        energy * stretch * (-k1 * k30 + h2 * zeta1),
        energy * stretch * (-k2 * k30 + h2 * zeta2),
    )


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _components(wavenumbers: Array, gamma: float, out: Array) -> None:
    for n in range(len(wavenumbers)):
        k1, k2, k3 = wavenumbers[n]
        components = sheared_tensor(k1, k2, k3, gamma)
        for c in range(6):
            out[n, c] = components[c]


def mann_tensor(
    wavenumbers: ArrayLike,
    length_scale: float,
    shear_parameter: float,
    alpha_epsilon: float = 1.0,
) -> Array:
    """Spectral tensor (...,3,3) m5/s2 at wavenumbers (...,3) rad/m, k1 not zero.

    ``length_scale`` m, ``shear_parameter`` Gamma, ``alpha_epsilon`` is alpha
    epsilon^(2/3) in m^(4/3)/s2. Two-sided: its integral over all wavenumbers is
    the covariance. Mann (1994) eqs. 3.16-3.19.
    """
    k = np.asarray(wavenumbers, dtype=np.float64) * length_scale
    flat = np.ascontiguousarray(k.reshape(-1, 3))
    out = np.empty((len(flat), 6))
    _components(flat, shear_parameter, out)
    tensor = out[:, SYMMETRIC].reshape(*k.shape, 3)
    return alpha_epsilon * length_scale ** (11 / 3) * tensor
