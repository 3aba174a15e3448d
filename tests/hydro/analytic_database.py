"""Hydrodynamic coefficients in closed form, which obey the relations of Kramers and Kronig."""

import numpy as np
from scipy.special import dawsn

from galerna.hydro.database import HydroDatabase

ROUND = np.deg2rad(np.arange(-180.0, 181.0, 30.0))


def gaussian(width, frequency):
    """Damping w^2 exp(-width w^2) and its added mass over that at infinity (n,)."""
    u = np.sqrt(width) * frequency
    return u**2 * np.exp(-(u**2)) / width, (1.0 - 2.0 * u * dawsn(u)) / np.sqrt(np.pi * width)


def gaussian_response(width, time):
    """The impulse response of ``gaussian`` (k,)."""
    t = time / np.sqrt(width)
    return (1.0 - 0.5 * t**2) * np.exp(-0.25 * t**2) / (2.0 * np.sqrt(np.pi) * width**1.5)


WIDTHS = {(0, 0): 1.0, (0, 4): 1.5, (4, 4): 2.0, (1, 1): 1.0, (1, 3): 1.5, (3, 3): 2.0, (2, 2): 1.2}
SIZES = {
    (0, 0): 4e5, (0, 4): -4e6, (4, 4): 4e7, (1, 1): 4e5, (1, 3): 4e6, (3, 3): 4e7, (2, 2): 1e5,
}  # fmt: skip


def spar_like(frequency=None, **changes):
    """A body of revolution: surge-pitch and sway-roll radiate one wave each, heave another."""
    w = np.arange(1, 81) * 0.05 if frequency is None else frequency
    A, B = np.zeros((len(w), 6, 6)), np.zeros((len(w), 6, 6))
    infinite = np.diag([8e6, 8e6, 2.4e5, 3.8e10, 3.8e10, 0.0])
    infinite[0, 4] = infinite[4, 0] = -4.8e8
    infinite[1, 3] = infinite[3, 1] = 4.8e8
    for (i, j), width in WIDTHS.items():
        damping, mass = gaussian(width, w)
        A[:, i, j] = A[:, j, i] = SIZES[i, j] * mass
        B[:, i, j] = B[:, j, i] = SIZES[i, j] * damping
    return HydroDatabase(**{
        "frequency": w, "added_mass": infinite + A, "damping": B,
        "added_mass_infinite": infinite, "heading": ROUND, "excitation": excitation(w),
        "hydrostatic_stiffness": np.diag([0.0, 0.0, 3.3e5, -5e9, -5e9, 0.0]),
        "displaced_volume": 8029.0, "center_of_buoyancy": np.array([0.0, 0.0, -62.0]),
        "reference_point": np.zeros(3), "water_depth": 320.0,
    } | changes)  # fmt: skip


def excitation(w):
    """Waves that push with the cosine of their heading (n,m,6)."""
    c, s = np.cos(ROUND), np.sin(ROUND)
    X = np.zeros((len(w), len(ROUND), 6), dtype=complex)
    level = np.exp(-0.5 * w)[:, None]
    X[:, :, 0], X[:, :, 1] = 1e6j * level * c, 1e6j * level * s
    X[:, :, 2] = 3.3e5 * level
    X[:, :, 3], X[:, :, 4] = 2e7j * level * s, -2e7j * level * c
    return X


def heave_only(frequency, size=1e5, decay=0.25, own=0.8, mass=2.4e5, stiffness=3.3e5):
    """Heave of the response ``size e^(-decay t) (cos own t - decay / own sin own t)``."""
    s = 1j * frequency
    K = size * s / ((s + decay) ** 2 + own**2)
    A, B = np.zeros((len(frequency), 6, 6)), np.zeros((len(frequency), 6, 6))
    infinite = np.zeros((6, 6))
    infinite[2, 2] = mass
    A[:, 2, 2], B[:, 2, 2] = K.imag / frequency, K.real
    C = np.zeros((6, 6))
    C[2, 2] = stiffness
    return spar_like(
        frequency, added_mass=infinite + A, damping=B, added_mass_infinite=infinite,
        hydrostatic_stiffness=C,
    )  # fmt: skip
