"""Turbulence boxes with Kaimal's spectra and the coherence of IEC 61400-1.

Veers, P. S. (1988), Three-dimensional wind simulation, SAND88-0152, correlates the
points of a grid, frequency by frequency, with a Cholesky factor. Here the coherence
depends on the distance alone and the grid is regular, so the same covariance is
that of a window in a periodic grid, whose factor is a Fourier transform: circulant
embedding, Dietrich, C. R. and Newsam, G. N. (1997), SIAM J. Sci. Comput. 18 (4).
Where the coherence reaches beyond the window it is led to zero outside it as
Gneiting et al. (2006), J. Comput. Graph. Stat. 15 (3), which keeps the covariance
inside and makes that of the periodic grid nonnegative but for less than 1e-3 of it.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from scipy import fft

from galerna.contract import Array
from galerna.inflow.box import Box
from galerna.inflow.iec import REFERENCE_INTENSITY, TurbulenceClass, normal_turbulence
from galerna.inflow.spectra import (
    KAIMAL_DEVIATIONS,
    kaimal_coherence_decay,
    kaimal_spectra,
)
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

WHERE = "Kaimal box"

_NOTHING = 14.0  #: decay times distance beyond which a coherence (1e-6) counts as none
_LEAST_EXACT = 4.0  #: decay times distance over which the coherence is kept, however small the grid


def kaimal_box(
    shape: tuple[int, int, int],
    spacing: tuple[float, float, float],
    *,
    mean_speed: float,
    hub_height: float,
    seed: int,
    turbulence_class: TurbulenceClass | None = None,
    turbulence_intensity: float | None = None,
    standard_deviation: float | None = None,
    coherent: Literal["u", "uvw"] = "u",
    normalise: Normalisation = "theory",
) -> Box:
    """A box of fluctuations with (nx, ny, nz) points, ``spacing`` m apart, periodic along x.

    ``spacing`` along x is the time step times ``mean_speed``. Give one of the IEC class
    (normal turbulence model), the turbulence intensity, or the standard deviation
    sigma_1 of u in m/s. The standard correlates u alone, and so does TurbSim; ``"uvw"``
    gives v and w the coherence of u. ``Normalisation`` tells of what sigma_1 is meant;
    those of v and w are 0.8 and 0.5 of it. Amplitudes are Gaussian; the seed alone decides
    the numbers. Raises InputError if an argument makes no sense. IEC 61400-1 ed. 3, annex B.
    """
    require_grid(WHERE, shape, spacing)
    require_positive(WHERE, mean_speed=mean_speed, hub_height=hub_height)
    require_one(
        WHERE,
        turbulence_class=turbulence_class,
        turbulence_intensity=turbulence_intensity,
        standard_deviation=standard_deviation,
    )
    require_name(WHERE, "coherent", coherent, ("u", "uvw"))
    require_name(WHERE, "normalise", normalise, NORMALISATIONS)
    if turbulence_class is not None:
        require_name(WHERE, "turbulence class", turbulence_class, tuple(REFERENCE_INTENSITY))
        sigma = normal_turbulence(mean_speed, turbulence_class)
    else:
        sigma = standard_deviation or (turbulence_intensity or 0.0) * mean_speed
    require_positive(WHERE, amount_of_turbulence=sigma)

    frequency = np.arange(1, shape[0] // 2) * mean_speed / (shape[0] * spacing[0])
    spectra = kaimal_spectra(frequency, mean_speed, hub_height, 1.0)
    decay = kaimal_coherence_decay(frequency, mean_speed, hub_height)
    spectrum = _half_spectrum(shape, spacing[1:], decay, coherent, random_generator(seed))
    spectrum[:, 1:] *= np.sqrt(0.5 * spectra.T * frequency[0])[..., None, None, None]
    data = to_space(spectrum)
    for c, ratio in enumerate(KAIMAL_DEVIATIONS):
        expected = float(spectra[:, c].sum() * frequency[0])
        variance = unit_variance(normalise, ratio**2, expected, data[c])
        data[c] *= ratio * sigma / math.sqrt(variance)
    return Box(data, spacing, mean_speed, hub_height, source=WHERE)


def _half_spectrum(
    shape: tuple[int, int, int],
    spacing: tuple[float, float],
    decay: Array,
    coherent: str,
    rng: np.random.Generator,
) -> HalfSpectrum:
    """Modes with E|X|^2 = 1, but for the mean and the highest, which are 0."""
    spectrum = no_modes(shape)
    for modes, component in zip(spectrum[:, 1:], "uvw", strict=True):
        if component in coherent:
            _fill_coherent(modes, decay, spacing, rng)
        else:
            _fill_independent(modes, rng)
    return spectrum


def _complex_normal(rng: np.random.Generator, shape: tuple[int, ...]) -> Modes:
    """Independent complex numbers with E|n|^2 = 1."""
    parts = rng.standard_normal((*shape, 2), dtype=np.float32)
    parts *= np.float32(math.sqrt(0.5))
    return parts.view(np.complex64)[..., 0]


def _fill_independent(modes: HalfSpectrum, rng: np.random.Generator) -> None:
    for mode in modes:
        noise = _complex_normal(rng, mode.shape[1:])
        mode[0], mode[1] = noise.real, noise.imag


def _fill_coherent(
    modes: HalfSpectrum, decay: Array, spacing: tuple[float, float], rng: np.random.Generator
) -> None:
    for mode, rate in zip(modes, decay, strict=True):
        _, ny, nz = mode.shape
        power = embedded_power((ny, nz), spacing, rate)
        noise = _complex_normal(rng, power.shape)
        noise *= np.sqrt(power, dtype=np.float32)
        wind = fft.fft2(noise, overwrite_x=True)[:ny, :nz]
        mode[0], mode[1] = wind.real, wind.imag


def embedded_power(shape: tuple[int, int], spacing: tuple[float, float], decay: float) -> Array:
    """Power (my,mz) of the modes of a periodic grid that holds the grid (ny,nz) in a corner.

    Their sum is 1, and two points of the corner at the distance r m have the covariance
    exp(-decay r), within 1e-3. ``spacing`` (dy, dz) m, ``decay`` 1/m.
    """
    extent = [(n - 1) * d for n, d in zip(shape, spacing, strict=True)]
    exact = max(math.hypot(*extent), _LEAST_EXACT / decay)
    end = exact + 2.0 / decay  # the parabola beyond has the same value and slope at ``exact``
    reach = min(end, _NOTHING / decay)
    sides = [
        fft.next_fast_len(max(n, math.ceil((e + reach) / d)), real=True)
        for n, e, d in zip(shape, extent, spacing, strict=True)
    ]
    y, z = (np.abs(fft.fftfreq(m, 1.0 / (m * d))) for m, d in zip(sides, spacing, strict=True))
    distance = np.hypot(y[:, None], z[None, :])
    parabola = math.exp(-decay * exact) * (0.5 * decay * np.maximum(end - distance, 0.0)) ** 2
    covariance = np.where(distance > exact, parabola, np.exp(-decay * distance))
    power = np.maximum(fft.fft2(covariance).real, 0.0)
    return power / power.sum()
