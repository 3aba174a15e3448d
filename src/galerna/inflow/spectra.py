"""What theory says of turbulence at points: spectra, variances and coherence.

Mann's model is integrated numerically over the lateral wavenumbers, Kaimal's is
that of IEC 61400-1 ed. 3 (2005), annex B. Mann's spectra are two-sided in rad/m,
Kaimal's one-sided in Hz, as each is written in its field.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.inflow.iec import longitudinal_scale
from galerna.inflow.mann_tensor import FAST, sheared_tensor

#: Scales of u, v, w in Lambda_1 and deviations in sigma_1 (IEC 61400-1 ed. 3, table B.1)
KAIMAL_SCALES = np.array([8.1, 2.7, 0.66])
KAIMAL_DEVIATIONS = np.array([1.0, 0.8, 0.5])

#: Variance over alpha epsilon^(2/3) L^(2/3) of isotropic turbulence, any component
ISOTROPIC_VARIANCE = (
    9 / 55 * math.sqrt(math.pi) * math.gamma(1 / 3) / math.gamma(5 / 6)
)  # = 0.6883, "0.688" where it is rounded

_LOG_STEP = 0.1  #: of the lateral wavenumber
_ANGLES = 64  #: over half a turn
_WIDEST_PHASE = 60.0  #: k d beyond which a lateral distance leaves no coherence to integrate


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _lateral_integral(
    k1: float, gamma: float, dy: float, dz: float, radii: Array, weights: Array, angles: int
) -> Array:
    """Integral over (k2, k3) of uu, vv, ww, uw (real) and uu, vv, ww (imaginary part).

    The tensor times exp(i (k2 dy + k3 dz)), for L = 1; polar, over the half plane k2 > 0,
    as these components are even in k2. ``weights`` (n,) belong to the ``radii`` (n,).
    """
    total = np.zeros(7)
    step = math.pi / angles
    for a in range(angles):
        angle = (a + 0.5) * step
        s, c = math.sin(angle), math.cos(angle)
        for n in range(len(radii)):
            k2, k3 = radii[n] * s, radii[n] * c
            uu, vv, ww, _, uw, _ = sheared_tensor(k1, k2, k3, gamma)
            both_sides = 2.0 * weights[n] * step * math.cos(k2 * dy)
            real = both_sides * math.cos(k3 * dz)
            imaginary = both_sides * math.sin(k3 * dz)
            total[0] += real * uu
            total[1] += real * vv
            total[2] += real * ww
            total[3] += real * uw
            total[4] += imaginary * uu
            total[5] += imaginary * vv
            total[6] += imaginary * ww
    return total


def _lateral_radii(k1: float, distance: float) -> tuple[Array, Array, int]:
    """Radii, their weights k dk, and the number of angles for one k1, all for L = 1.

    Logarithmic from well below to well above k1 and 1/L. With a distance the radii
    end where waves cancel, softly, and are close enough to follow the phase.
    """
    lowest, highest = 1e-4 * min(k1, 1.0), 1e4 * max(k1, 1.0)
    if distance == 0.0:
        radii = np.exp(np.arange(math.log(lowest), math.log(highest), _LOG_STEP))
        return radii, radii**2 * _LOG_STEP, _ANGLES
    limit = max(_WIDEST_PHASE / distance, 30.0 * max(k1, 1.0))
    step = min(_LOG_STEP, 0.8 / (limit * distance))
    radii = np.exp(np.arange(math.log(lowest), math.log(3.0 * limit), step))
    angles = max(_ANGLES, math.ceil(2.0 * limit * distance))
    return radii, radii**2 * step * np.exp(-((radii / limit) ** 4)), angles


def mann_spectra(
    k1: ArrayLike, length_scale: float, shear_parameter: float, alpha_epsilon: float = 1.0
) -> Array:
    """Two-sided spectra F of u, v, w and the co-spectrum of u and w, (n,4) m3/s2.

    ``k1`` (n,) rad/m positive; ``alpha_epsilon`` is alpha epsilon^(2/3), m^(4/3)/s2.
    Each variance is twice the integral over k1 > 0. Mann (1994) eq. 3.20.
    """
    waves = np.asarray(k1, dtype=np.float64) * length_scale
    spectra = [
        _lateral_integral(k, shear_parameter, 0.0, 0.0, *_lateral_radii(k, 0.0))[:4] for k in waves
    ]
    return alpha_epsilon * length_scale ** (5 / 3) * np.array(spectra)


def mann_variances(
    length_scale: float, shear_parameter: float, alpha_epsilon: float = 1.0
) -> Array:
    """Variances of u, v, w and the covariance of u and w, (4,) m2/s2, over all wavenumbers."""
    step = 0.25
    waves = np.exp(np.arange(math.log(1e-5), math.log(1e4), step))
    spectra = mann_spectra(waves, 1.0, shear_parameter)
    below = waves[0] * spectra[0]  # flat
    above = 1.5 * waves[-1] * spectra[-1]  # falls with k1^-5/3; the covariance is nil there
    within = step * (waves @ spectra) - 0.5 * step * (waves[[0, -1]] @ spectra[[0, -1]])
    return alpha_epsilon * length_scale ** (2 / 3) * 2.0 * (below + within + above)


def mann_coherence(
    k1: ArrayLike, dy: float, dz: float, length_scale: float, shear_parameter: float
) -> Array:
    """Complex coherence (n,3) of u, v, w between points ``dy`` and ``dz`` m apart.

    The cross-spectrum over the spectrum at ``k1`` (n,) rad/m: its real part is the
    co-coherence, the square of its modulus the magnitude-squared coherence.
    """
    spacing = math.hypot(dy, dz) / length_scale
    rows = []
    for k in np.asarray(k1, dtype=np.float64) * length_scale:
        apart = _lateral_integral(
            k, shear_parameter, dy / length_scale, dz / length_scale, *_lateral_radii(k, spacing)
        )
        together = _lateral_integral(k, shear_parameter, 0.0, 0.0, *_lateral_radii(k, 0.0))
        rows.append((apart[:3] + 1j * apart[4:]) / together[:3])
    return np.array(rows)


def kaimal_spectra(
    frequency: ArrayLike, mean_speed: float, hub_height: float, standard_deviation: float
) -> Array:
    """One-sided spectra (n,3) m2/s2/Hz of u, v, w at frequencies (n,) Hz.

    ``standard_deviation`` sigma_1 m/s is that of u; IEC 61400-1 ed. 3 eq. B.14.
    """
    f = np.asarray(frequency, dtype=np.float64)[:, None]
    time_scale = KAIMAL_SCALES * longitudinal_scale(hub_height) / mean_speed
    variance = (KAIMAL_DEVIATIONS * standard_deviation) ** 2
    return variance * 4.0 * time_scale / (1.0 + 6.0 * f * time_scale) ** (5 / 3)


def kaimal_coherence_decay(frequency: ArrayLike, mean_speed: float, hub_height: float) -> Array:
    """Decay (n,) 1/m of the coherence of u with distance: Coh = exp(-decay r).

    12 sqrt((f/V)^2 + (0.12/L_c)^2) with L_c = 8.1 Lambda_1; IEC 61400-1 ed. 3 eq. B.16.
    Coh is the modulus of the cross-spectrum over the spectrum (not squared).
    """
    f = np.asarray(frequency, dtype=np.float64)
    return 12.0 * np.hypot(f / mean_speed, 0.12 / (8.1 * longitudinal_scale(hub_height)))
