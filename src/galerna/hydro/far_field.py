"""Mean drift of a hull from the waves that it sends to infinity.

Maruo (1960) and Newman (1967): momentum and angular momentum of the far field. The far field
of a potential phi with normal velocity v on the hull is its Kochin function

    H(theta) = 1/(4 pi) Integral (v w - phi dw/dn) dS,
    w = cosh k(z+h)/cosh kh exp(i k (x cos theta + y sin theta)),

here with the time factor exp(i w t). The factors of the forces are those of the far field of
the source in water of finite depth; capytaine 3.0's own function has (K h)^2 for (k h)^2 and
w for g k / w there, K = w^2/g, which loses most of the force where k h is small (checked
against MacCamy and Fuchs' cylinder).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from galerna.contract import Array
from galerna.hydro.database import Complex, HydroDatabase

ANGLES = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)


@dataclass(frozen=True)
class Moving:
    """What moves with a hull: mass matrix (6,6) and restoring (6,6) beside that of buoyancy.

    Both about the hull's reference point.
    """

    inertia: Array
    restoring: Array


@dataclass(frozen=True, eq=False)
class FarField:
    """Kochin functions over ``ANGLES`` (t,), per amplitude of the wave and of the motion.

    ``diffraction`` (n,m,t) m3/s per m, ``radiation`` (n,6,t) about the reference point.
    """

    diffraction: Complex
    radiation: Complex


@dataclass(frozen=True, eq=False)
class Surface:
    """Panels of the whole wetted hull: centres (f,3) m, normals (f,3) outwards, areas (f,) m2."""

    center: Array
    normal: Array
    area: Array


def kochin(
    surface: Surface, potential: Complex, velocity: Complex, wavenumber: float, depth: float
) -> Complex:
    """Kochin functions (..., t) over ``ANGLES`` of potentials (..., f) and normal velocities."""
    c, s = np.cos(ANGLES), np.sin(ANGLES)
    x, y, z = surface.center.T
    rise, slope = _vertical(z, wavenumber, depth)
    wave = np.exp(1j * wavenumber * (np.outer(x, c) + np.outer(y, s))) * surface.area[:, None]
    nx, ny, nz = surface.normal.T
    across = 1j * wavenumber * (np.outer(nx, c) + np.outer(ny, s))
    gradient = (rise[:, None] * across + (slope * nz)[:, None]) * wave
    return np.asarray((velocity @ (rise[:, None] * wave) - potential @ gradient) / (4.0 * np.pi))


def _vertical(z: Array, wavenumber: float, depth: float) -> tuple[Array, Array]:
    """cosh k(z+h)/cosh kh and its derivative over z, without overflow."""
    up = np.exp(wavenumber * z)
    if not np.isfinite(depth):
        return up, wavenumber * up
    image = np.exp(-wavenumber * (z + 2.0 * depth))
    scale = 1.0 + np.exp(-2.0 * wavenumber * depth)
    return (up + image) / scale, wavenumber * (up - image) / scale


def motions(base: HydroDatabase, moving: Moving) -> Complex:
    """Motions (n,m,6) per amplitude of the wave, m/m and rad/m: the linear operators."""
    w = base.frequency[:, None, None]
    spring = base.hydrostatic_stiffness + moving.restoring
    dynamic = spring - w**2 * (moving.inertia + base.added_mass) + 1j * w * base.damping
    solved = np.linalg.solve(dynamic, np.swapaxes(base.excitation, 1, 2))
    return np.asarray(np.swapaxes(solved, 1, 2))


def mean_drift(base: HydroDatabase, far: FarField, moving: Moving | None) -> Array:
    """Mean force and yaw moment (n,m,6) N/m2, N/m; heave, roll and pitch are left 0.

    The hull takes no energy from the waves, so the force is that of the sent waves,
    c Integral |H|^2 (cos beta - cos theta) d theta, which is as exact as they are.
    """
    total = far.diffraction
    if moving is not None:
        total = total + np.einsum("nmj,njt->nmt", motions(base, moving), far.radiation)
    flux = np.abs(total) ** 2 * (2.0 * np.pi / len(ANGLES) * _strength(base))[:, None, None]
    ahead = np.stack([np.cos(base.heading), np.sin(base.heading)], axis=1)
    away = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
    drift = np.zeros((*total.shape[:2], 6))
    drift[:, :, :2] = flux.sum(axis=2)[:, :, None] * ahead - flux @ away
    drift[:, :, 5] = _yaw(base, total)
    return drift


def _strength(base: HydroDatabase) -> Array:
    """Force (n,) N per radian of a unit Kochin function: 2 pi rho k^3 h / ((kh)^2-(Kh)^2+Kh)."""
    k, h = base.wavenumber, base.water_depth
    if not np.isfinite(h):
        return np.asarray(2.0 * np.pi * base.water_density * k**2)
    deep = base.frequency**2 / base.gravity * h
    amplitude = k**2 * h / ((k * h) ** 2 - deep**2 + deep)
    return np.asarray(2.0 * np.pi * base.water_density * k * amplitude)


def _yaw(base: HydroDatabase, total: Complex) -> Array:
    """Mean yaw moment (n,m): angular momentum of the sent waves and of their part in the sea's."""
    k, rate = base.wavenumber, _derivative(total)
    spin = (np.conj(total) * rate).imag.sum(axis=2) * 2.0 * np.pi / len(ANGLES)
    ahead = np.stack([_at(rate[:, m], beta) for m, beta in enumerate(base.heading)], axis=1)
    mixed = (_interference(base) / k)[:, None] * ahead.imag
    return np.asarray(mixed + (_strength(base) / k)[:, None] * spin)


def _interference(base: HydroDatabase) -> Array:
    """Force (n,) N per unit Kochin function and amplitude, of sent waves with the sea's."""
    w = base.frequency
    return np.asarray(2.0 * np.pi * base.water_density * base.gravity * base.wavenumber / w)


def _derivative(values: Complex) -> Complex:
    """Derivative over the angle of periodic values (..., t), by Fourier series."""
    order = np.fft.fftfreq(len(ANGLES), 1.0 / len(ANGLES))
    return np.asarray(np.fft.ifft(1j * order * np.fft.fft(values, axis=-1), axis=-1))


def _at(values: Complex, angle: float) -> Complex:
    """Periodic values (n,t) at one angle (n,)."""
    knots = np.append(ANGLES, 2.0 * np.pi)
    spline = CubicSpline(
        knots, np.append(values, values[:, :1], axis=1), axis=1, bc_type="periodic"
    )
    return np.asarray(spline(angle % (2.0 * np.pi)))


def energy_error(base: HydroDatabase, far: FarField, moving: Moving | None) -> Array:
    """How far (n,m) the energy sent away is from that taken out of the sea, over their size.

    Sent c Integral |H|^2, taken -2 pi rho g k/w Re H(beta): 0 for a hull that keeps no energy.
    """
    total = far.diffraction
    if moving is not None:
        total = total + np.einsum("nmj,njt->nmt", motions(base, moving), far.radiation)
    sent = (np.abs(total) ** 2).sum(axis=2) * (2.0 * np.pi / len(ANGLES) * _strength(base))[:, None]
    ahead = np.stack([_at(total[:, m], b) for m, b in enumerate(base.heading)], axis=1).real
    taken = -_interference(base)[:, None] * ahead
    return np.asarray((taken - sent) / np.maximum(np.abs(taken), np.abs(sent)))
