"""Turbulence boxes of Mann's model: anisotropic, incompressible, sheared turbulence.

Mann, J. (1998), Wind field simulation, Prob. Eng. Mech. 13 (4), 269-282. The box
is a sum of Fourier modes with Gaussian amplitudes of the covariance given by the
spectral tensor. Modes are drawn plane by plane of k1 and brought to (y, z) at
once, and make way for the box in their own memory.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numba import njit
from numpy.typing import ArrayLike
from scipy import fft

from galerna.contract import Array
from galerna.errors import InputError
from galerna.inflow.box import Box
from galerna.inflow.mann_modes import Factor, LateralModes
from galerna.inflow.mann_tensor import FAST
from galerna.inflow.spectra import ISOTROPIC_VARIANCE, mann_variances
from galerna.inflow.synthesis import (
    NORMALISATIONS,
    HalfSpectrum,
    Modes,
    Normalisation,
    no_modes,
    random_generator,
    require_grid,
    require_name,
    require_one,
    require_positive,
    to_space,
    unit_variance,
)

WHERE = "Mann box"

_NODES_PER_DECADE = 24  #: of k1, at which the covariance is integrated; between, interpolated
_MODES_AT_ONCE = 1 << 18  #: lateral modes in work at a time, for the cache and the memory


def alpha_epsilon_isotropic(standard_deviation: float, length_scale: float) -> float:
    """alpha epsilon^(2/3), m^(4/3)/s2, of isotropic turbulence with sigma m/s and L m.

    Of sheared turbulence the standard deviation of u comes out larger: by 1.80 at
    Gamma = 3.9. IEC 61400-1 ed. 3 gives sigma_iso = 0.55 sigma_1 for its Gamma = 3.9.
    """
    return standard_deviation**2 / (ISOTROPIC_VARIANCE * length_scale ** (2 / 3))


def mann_box(
    shape: tuple[int, int, int],
    spacing: tuple[float, float, float],
    *,
    length_scale: float,
    shear_parameter: float,
    mean_speed: float,
    hub_height: float,
    seed: int,
    alpha_epsilon: float | None = None,
    standard_deviation: float | None = None,
    turbulence_intensity: float | None = None,
    normalise: Normalisation = "theory",
    high_frequency_compensation: bool = True,
    lateral_period: float = 2.0,
) -> Box:
    """A box of fluctuations with (nx, ny, nz) points, ``spacing`` m apart, periodic along x.

    Give one of ``alpha_epsilon`` (alpha epsilon^(2/3), m^(4/3)/s2), the standard
    deviation of u in m/s, or the turbulence intensity (its ratio to ``mean_speed``);
    ``Normalisation`` tells of what the deviation is meant. Its mean over x is zero at
    every (y, z). With ``high_frequency_compensation`` the box holds the wind at points,
    without it the mean over cells of the grid. The modes have a period over y and z of
    ``lateral_period`` times the box: with 1 its opposite sides are alike; a longer one
    costs time, not memory, and serves the coherence of far points at low k1.
    The seed alone decides the numbers. Raises InputError if an argument makes no sense.
    """
    require_grid(WHERE, shape, spacing)
    require_positive(WHERE, length_scale=length_scale, mean_speed=mean_speed)
    _check_amount(alpha_epsilon, standard_deviation, turbulence_intensity)
    _check_options(shear_parameter, normalise, lateral_period)
    modes = _lateral_modes(
        shape, spacing, length_scale, shear_parameter, high_frequency_compensation, lateral_period
    )
    spectrum, expected = _half_spectrum(shape, modes, random_generator(seed))
    data = to_space(spectrum)
    if alpha_epsilon is not None:
        data *= np.float32(math.sqrt(alpha_epsilon) * length_scale ** (1 / 3))
    else:
        deviation = standard_deviation or (turbulence_intensity or 0.0) * mean_speed
        theory = float(mann_variances(1.0, shear_parameter)[0])
        variance = unit_variance(normalise, theory, expected, data[0])
        data *= np.float32(deviation / math.sqrt(variance))
    return Box(data, spacing, mean_speed, hub_height, source=WHERE)


def _check_amount(
    alpha_epsilon: float | None, standard_deviation: float | None, intensity: float | None
) -> None:
    amounts = {
        "alpha_epsilon": alpha_epsilon,
        "standard_deviation": standard_deviation,
        "turbulence_intensity": intensity,
    }
    require_one(WHERE, **amounts)
    require_positive(WHERE, **{name: x for name, x in amounts.items() if x is not None})


def _check_options(shear_parameter: float, normalise: str, lateral_period: float) -> None:
    require_name(WHERE, "normalise", normalise, NORMALISATIONS)
    if not (math.isfinite(shear_parameter) and shear_parameter >= 0.0):
        raise InputError(WHERE, f"shear parameter is {shear_parameter:g}, expected 0 or more")
    if not 1.0 <= lateral_period < math.inf:
        raise InputError(WHERE, f"lateral period is {lateral_period:g}, expected 1 or more")


def _lateral_modes(
    shape: tuple[int, int, int],
    spacing: tuple[float, float, float],
    length_scale: float,
    shear_parameter: float,
    point_values: bool,
    period: float,
) -> LateralModes:
    """The modes over y and z, in length scales."""
    ny, nz = (n if period == 1.0 else fft.next_fast_len(math.ceil(period * n)) for n in shape[1:])
    dx, dy, dz = (d / length_scale for d in spacing)
    return LateralModes((ny, nz), (ny * dy, nz * dz), (dx, dy, dz), shear_parameter, point_values)


def _half_spectrum(
    shape: tuple[int, int, int], modes: LateralModes, rng: np.random.Generator
) -> tuple[HalfSpectrum, float]:
    """Fourier modes along x at the points (y, z), and the variance of u expected of them.

    For L = 1 and alpha epsilon^(2/3) = 1. The mean and the highest wavenumber are left out.
    """
    nx, ny, nz = shape
    spectrum = no_modes(shape)
    width = 2.0 * math.pi / (nx * modes.spacing[0])
    batch = max(1, _MODES_AT_ONCE // math.prod(modes.shape))
    variance = 0.0
    for first, last, low, high in _intervals(nx // 2 - 1, modes, width):
        for n in range(first, last, batch):
            planes = np.arange(n, min(n + batch, last))
            share = np.log(planes / low[0]) / math.log(high[0] / low[0])
            amplitude = _shape_of(planes * width) * math.sqrt(0.5 * width)
            noise = rng.standard_normal((len(planes), 3, 2, *modes.shape), dtype=np.float32)
            block = np.empty((len(planes), 3, *modes.shape), dtype=np.complex64)
            variance += _fill(noise, low[1], high[1], share, amplitude, block)
            wind = fft.ifft2(block, norm="forward", overwrite_x=True)[:, :, :ny, :nz]
            place = spectrum[:, planes[0] : planes[-1] + 1]
            place[:, :, 0] = np.moveaxis(wind.real, 0, 1)
            place[:, :, 1] = np.moveaxis(wind.imag, 0, 1)
    return spectrum, variance


def _shape_of(k1: ArrayLike) -> Array:
    """Square root of the isotropic spectrum's shape: what the factors are interpolated over."""
    return (1.0 + np.square(np.asarray(k1, dtype=np.float64))) ** (-5 / 12)


Node = tuple[float, Factor]


def _intervals(
    count: int, modes: LateralModes, width: float
) -> Iterator[tuple[int, int, Node, Node]]:
    """Ranges of planes 1..count with the factors at their two ends, over ``_shape_of``."""
    number = 2 + math.ceil(_NODES_PER_DECADE * math.log10(max(count, 2)))
    nodes = np.unique(np.rint(np.geomspace(1, count + 1, number)).astype(int))

    def node(n: int) -> Node:
        k1 = float(n * width)
        return float(n), modes.factors(k1, width) / np.float32(_shape_of(k1))

    low = node(nodes[0])
    for first, last in pairwise(nodes):
        high = node(last)
        yield int(first), int(last), low, high
        low = high


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _fill(
    noise: Factor, low: Factor, high: Factor, share: Array, amplitude: Array, out: Modes
) -> float:
    """Correlate noise (n,3,2,ny,nz) into modes (n,3,ny,nz); returns what var(u) expects of them."""
    variance = 0.0
    for n in range(out.shape[0]):
        b = np.float32(amplitude[n] * share[n])
        a = np.float32(amplitude[n] - b)
        for j in range(out.shape[2]):
            for l in range(out.shape[3]):
                x = complex(noise[n, 0, 0, j, l], noise[n, 0, 1, j, l])
                y = complex(noise[n, 1, 0, j, l], noise[n, 1, 1, j, l])
                z = complex(noise[n, 2, 0, j, l], noise[n, 2, 1, j, l])
                uu = a * low[0, j, l] + b * high[0, j, l]
                vu = a * low[1, j, l] + b * high[1, j, l]
                wu = a * low[2, j, l] + b * high[2, j, l]
                vv = a * low[3, j, l] + b * high[3, j, l]
                wv = a * low[4, j, l] + b * high[4, j, l]
                ww = a * low[5, j, l] + b * high[5, j, l]
                out[n, 0, j, l] = uu * x
                out[n, 1, j, l] = vu * x + vv * y
                out[n, 2, j, l] = wu * x + wv * y + ww * z
                variance += 4.0 * uu * uu
    return variance
