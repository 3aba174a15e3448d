"""Seas against the spectra they are made from, and the water's motion against theory."""

from __future__ import annotations

from collections.abc import Sequence
from math import log, pi, sqrt

import numpy as np

from galerna.contract import Array, Motion
from galerna.hydro.drag import ViscousDrag
from galerna.hydro.waves.dispersion import group_velocity
from galerna.hydro.waves.irregular import HIGHEST, LOWEST, Band, irregular
from galerna.hydro.waves.kinematics import pressure_transfer, velocity_transfer
from galerna.hydro.waves.sea import Sea
from galerna.hydro.waves.spectra import default_peak_enhancement, jonswap
from galerna.turbine.platform import Member, Platform

from .framework import Case, Check

HEIGHT, PERIOD, DEPTH = 6.0, 10.0, 320.0
SEEDS = 200
DURATION = 3600.0

OPENFAST = (
    "Spectrum of OpenFAST's SeaState (modules/seastate/src/Waves.f90, Apache-2.0), integrated "
    "from 0.001 to 2 Hz"
)
TARGET = "the spectrum's own integral over the sea's frequencies"
GAUSS = "a Gaussian process of this spectrum"
PRINTED = "derived: docs/theory/waves.md, eq. (8)"

PUBLISHED = {  # Hs m, Tp s: 4 sqrt(m0) m, Tz / Tp, density at the peak m2/Hz
    (6.0, 10.0): (6.003816760, 0.7694562628, 64.54591824),
    (2.44, 8.1): (2.439977858, 0.7120777885, 4.317641614),
    (9.14, 13.6): (9.126755598, 0.7403637964, 151.1137888),
    (12.7, 14.1): (12.71556734, 0.7782766953, 443.1914182),
    (3.66, 9.7): (3.659983851, 0.7115611277, 11.63364546),
}


def published_spectra() -> Sequence[Check]:
    checks = []
    f = np.linspace(0.001, 2.0, 200_001)
    for (height, period), (from_m0, crossing, peak) in PUBLISHED.items():
        gamma = default_peak_enhancement(height, period)
        s = 2.0 * pi * jonswap(2.0 * pi * f, height, period, gamma)
        m0, m2 = np.trapezoid(s, f), np.trapezoid(s * f**2, f)
        at_peak = 2.0 * pi * float(jonswap(2.0 * pi / period, height, period, gamma))
        sea = f"Hs {height:g} m, Tp {period:g} s"
        checks += [
            Check(f"4 sqrt(m0), {sea}", 4 * sqrt(m0), from_m0, OPENFAST, 1e-5, "m", True),
            Check(f"Tz / Tp, {sea}", sqrt(m0 / m2) / period, crossing, OPENFAST, 1e-4, "", True),
            Check(f"density at the peak, {sea}", at_peak, peak, OPENFAST, 1e-6, "m2/Hz", True),
        ]
    return checks


def density(w: Array) -> Array:
    return jonswap(w, HEIGHT, PERIOD, default_peak_enhancement(HEIGHT, PERIOD))


def band() -> Band:
    peak = 2.0 * pi / PERIOD
    return Band(LOWEST * peak, HIGHEST * peak, DURATION)


def gaussian_sea(seed: int) -> Sea:
    w, course, a = irregular(density, band(), amplitudes="white_noise", seed=seed)
    return Sea(w, course, a, DURATION, DEPTH)


def moment(order: int, lowest: float, highest: float) -> float:
    """Moment of the spectrum over the angular frequency, between two frequencies rad/s."""
    w = np.linspace(lowest, highest, 20_001)
    return float(np.trapezoid(w**order * density(w), w))


def elevation_statistics() -> Sequence[Check]:
    """Of the elevation over time, 200 seeds of an hour."""
    whole = band()
    edges = np.array([0.4, 0.55, 0.7, 0.9, 1.3, 2.0, 3.7])
    variance, crossing, third, fourth, spectra = [], [], [], [], []
    for seed in range(SEEDS):
        elevation = gaussian_sea(seed).elevation_at().table[:, 0].astype(float)
        variance.append(elevation.var())
        up = np.count_nonzero((elevation[:-1] < 0.0) & (elevation[1:] >= 0.0))
        crossing.append(up / DURATION)
        scaled = elevation / elevation.std()
        third.append(np.mean(scaled**3))
        fourth.append(np.mean(scaled**4))
        part = 2.0 * np.abs(np.fft.rfft(elevation, norm="forward")) ** 2
        w = 2.0 * pi / DURATION * np.arange(len(part))
        spectra.append(np.histogram(w, edges, weights=part)[0])
    m0, m2 = (moment(k, whole.lowest, whole.highest) for k in (0, 2))
    checks = [
        Check("mean variance", float(np.mean(variance)), HEIGHT**2 / 16, "Hs^2 / 16", 0.01, "m2",
              True),
        Check("mean variance", float(np.mean(variance)), m0, TARGET, 0.01, "m2", True),
        Check("zero-crossing period", float(1 / np.mean(crossing)), 2 * pi * sqrt(m0 / m2), GAUSS,
              0.01, "s", True),
        Check("skewness", float(np.mean(third)), 0.0, GAUSS, 0.01),
        Check("kurtosis", float(np.mean(fourth)), 3.0, GAUSS, 0.02),
    ]  # fmt: skip
    for low, high, found in zip(edges[:-1], edges[1:], np.mean(spectra, axis=0), strict=True):
        name = f"variance from {low:g} to {high:g} rad/s"
        checks.append(Check(name, float(found), moment(0, low, high), TARGET, 0.03, "m2", True))
    return checks


def printed(seed: int, samples: int, step: float, height: float, period: float) -> float:
    """Variance m2 of one sea by the dissertation's eqs. 2.116-2.118 as printed."""
    generator = np.random.default_rng(seed)
    w = 2.0 * pi * np.arange(1, samples // 2) / (samples * step)
    u1, u2 = 1.0 - generator.random((2, len(w)))
    white = np.sqrt(-2.0 * np.log(u1)) * np.exp(2j * pi * u2)
    two_sided = 0.5 * jonswap(w, height, period, default_peak_enhancement(height, period))
    half = np.zeros(samples // 2 + 1, dtype=complex)
    half[1:-1] = white * np.sqrt(samples * two_sided / step)
    return float(np.fft.irfft(half, samples).var())


def printed_formulas() -> Sequence[Check]:
    """The dissertation's sea of Fig. 2.13, and ours."""
    height, period, samples, step = 5.49, 14.656, 16_384, 0.25
    shares = [printed(seed, samples, step, height, period) for seed in range(SEEDS)]
    gamma = default_peak_enhancement(height, period)
    w = np.linspace(1e-3, pi / step, 200_001)
    target = float(np.trapezoid(jonswap(w, height, period, gamma), w))
    ours = Band(LOWEST * 2 * pi / period, HIGHEST * 2 * pi / period, samples * step)
    variances = []
    for seed in range(SEEDS):
        _, _, a = irregular(
            lambda w: jonswap(w, height, period, gamma), ours, amplitudes="white_noise", seed=seed
        )
        variances.append(0.5 * np.sum(np.abs(a) ** 2))
    return [
        Check("printed eqs. 2.116-2.118: variance over the spectrum's",
              float(np.mean(shares)) / target, 1.0 / pi, PRINTED, 0.03, "", True),
        Check("ours: variance over the spectrum's", float(np.mean(variances)) / target, 1.0,
              PRINTED, 0.015, "", True),
    ]  # fmt: skip


def energy_flux() -> list[Check]:
    """Power of a regular wave through a vertical plane, by quadrature of p u."""
    checks = []
    nodes, weights = np.polynomial.legendre.leggauss(80)
    for depth in (20.0, 320.0):
        sea = Sea.regular(HEIGHT, PERIOD, depth)
        reach = min(depth, 250.0)
        z = 0.5 * reach * (nodes - 1.0)
        points = np.column_stack([0.0 * z, 0.0 * z, z])
        p = sea.amplitude[0] * pressure_transfer(sea, points)[0]
        u = sea.amplitude[0] * velocity_transfer(sea, points)[0, :, 0]
        flux = 0.5 * reach * float(weights @ (0.5 * (p * u.conj()).real))
        energy = sea.density * sea.gravity * sea.variance
        expected = energy * float(group_velocity(sea.frequency, depth, sea.gravity)[0])
        checks.append(Check(f"power of waves of 6 m and 10 s, {depth:g} m deep", flux, expected,
                            "energy times group velocity", 1e-6, "W/m", True))  # fmt: skip
    return checks


def spar() -> Platform:
    """The OC3 spar's outside (NREL/TP-500-47535, Table 3-1), drag coefficient 0.6."""
    sides = np.repeat([[9.4], [9.4], [6.5], [6.5]], 2, axis=1)
    member = Member(
        "spar", np.array([0.0, 0.0, -120.0]), np.array([0.0, 0.0, 10.0]),
        np.array([0.0, 108.0, 116.0, 130.0]) / 130.0, sides, True, np.full((1, 2), 0.6),
    )  # fmt: skip
    return Platform((0.0,) * 3, 1.0, (0.0,) * 3, (1.0,) * 3, members=(member,))


def surging(model: ViscousDrag, amplitude: float, n: int = 360) -> float:
    """First harmonic N of the drag over a cycle of surge with a velocity amplitude m/s."""
    motion = Motion.at_rest(1)
    cosine, force = np.cos(2.0 * pi * np.arange(n) / n), []
    for value in cosine:
        motion.velocity[0, 0] = amplitude * value
        force.append(model.loads(0.0, motion).force[0, 0])
    return -2.0 * float(np.mean(np.array(force) * cosine))


def drag_of_the_spar() -> list[Check]:
    """Surge in still water against the equivalent damping 8/(3 pi) c V."""
    area = 108.0 * 9.4 + 8.0 * 0.5 * (9.4 + 6.5) + 4.0 * 6.5
    c = 0.5 * 1025.0 * 0.6 * area
    found = surging(ViscousDrag(spar(), Sea.still(DEPTH)), 1.0)
    source = "8 / (3 pi) times rho/2 C_d A V^2"
    return [Check("OC3 spar surging at 1 m/s", found, 8 / (3 * pi) * c, source, 1e-4, "N", True)]


def water() -> Sequence[Check]:
    return [*energy_flux(), *drag_of_the_spar(), *largest_wave()]


def largest_wave() -> list[Check]:
    """Mean of the largest crest of an hour against that of as many Rayleigh crests."""
    crests = [float(gaussian_sea(seed).elevation_at().table.max()) for seed in range(SEEDS)]
    whole = band()
    m0, m2 = (moment(k, whole.lowest, whole.highest) for k in (0, 2))
    scale = log(DURATION * sqrt(m2 / m0) / (2.0 * pi))
    expected = sqrt(m0) * (sqrt(2.0 * scale) + 0.5772 / sqrt(2.0 * scale))
    source = "Cartwright and Longuet-Higgins (1956), asymptotic for many waves"
    return [Check("mean largest crest of an hour", float(np.mean(crests)), expected, source, 0.02,
                  "m", True)]  # fmt: skip


CASES = [
    Case("afloat-wave-spectra", "afloat", "JONSWAP spectra", published_spectra, 1,
         "Peak enhancement by IEC 61400-3."),
    Case("afloat-wave-statistics", "afloat", "Elevation of a JONSWAP sea of 6 m and 10 s",
         elevation_statistics, 4,
         "200 seeds of an hour with random amplitudes, by the elevation over time. The mean "
         "variance of 200 hours is known within 0.5 % (standard deviation), a band's within 1 %: "
         "tolerances are 1 % and 3 %. The spectrum's own integral is 0.13 % above Hs^2/16, because "
         "the factor of its peak enhancement is a fit; frequencies above six times the peak's, "
         "which are left out, hold 0.1 %."),
    Case("afloat-wave-printed", "afloat", "The dissertation's white noise as printed",
         printed_formulas, 3,
         "Eqs. 2.116-2.118 give 1/pi of the spectrum's variance, whatever step and length: shown "
         "by doing as they say. Tolerance: three standard deviations of the mean of 200 seeds."),
    Case("afloat-water", "afloat", "Water under waves, and drag in it", water, 4,
         "Power of a wave by pressure and velocity over the depth; drag of a surging spar; the "
         "largest crests, within 2 %: the standard deviation of the mean is 0.7 %, and the formula "
         "counts crests of a narrow spectrum."),
]  # fmt: skip
