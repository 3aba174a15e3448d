"""Steady wings in linear theory: lifting lines and an infinite wing in a spanwise wave.

Three references for the lattice: Prandtl's line for any chord and angle (dissertation eq.
3.8), the oblique elliptic wing to first order in chord over span (eq. 3.6), and the flat
wing of infinite span whose angle of attack varies along it as a sine, which is solved here
without any approximation beyond small angles.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import iti0k0, k1

from galerna.contract import Array


def lifting_line(
    place: ArrayLike,
    chord: Callable[[Array], Array],
    angle: Callable[[Array], Array],
    harmonics: int = 500,
    points: int = 1500,
) -> Array:
    """Lift coefficients at ``place`` (n,) = 2 y / span, with ``chord`` over half the span.

    ``chord`` and ``angle`` (rad) are functions of the place; lift slope 2 pi. The Fourier
    coefficients of the circulation meet eq. 3.8 in the sense of least squares.
    """
    n = np.arange(1, harmonics + 1)
    theta = np.pi * (np.arange(points) + 0.5) / points
    y = np.cos(theta)
    sines = np.sin(np.outer(theta, n))
    # Multiplied by sin(theta) c, so that tips and pointed ends stay finite.
    c = chord(y)[:, None]
    matrix = sines * (4.0 / np.pi * np.sin(theta)[:, None] + n * c)
    right = angle(y) * np.sin(theta) * c[:, 0]
    coefficients = np.linalg.lstsq(matrix, right, rcond=None)[0]
    at = np.asarray(place, dtype=float)
    return 8.0 / chord(at) * (np.sin(np.outer(np.arccos(at), n)) @ coefficients)


def oblique_elliptic_lift(
    place: ArrayLike, sweep: float, aspect_ratio: float, axis: float
) -> Array:
    """Lift per span of an oblique elliptic wing, over 8 cos(sweep) times the angle of attack.

    The unit is dynamic pressure times mean chord. ``place`` (n,) is 2 y / span, positive
    towards the tip that lies downstream for ``sweep`` rad > 0; ``aspect_ratio`` is the span
    across the flow over the largest chord; ``axis``, in chords before the mid-chord, is the
    line that is straight: 0 for an ellipse, 1/4 for a straight quarter-chord line. The angle
    of attack lies in the plane of the flow. Not uniform at the tips.

    Source: Guermond, J. Fluid Mech. 211 (1990) 497, as dissertation eq. 3.6, which does not say
    from where ``axis`` counts; the theory page derives it.
    """
    y = np.asarray(place, dtype=float)
    ellipse = np.sqrt(1.0 - y**2)
    sine, ratio = np.sin(sweep), aspect_ratio
    # The dissertation's last bracket times sin(sweep), which is finite without sweep.
    tilt = np.log1p(sine) - (1.0 - sine) * np.log(np.cos(sweep))
    trailing = sine * (np.log(8.0 * ratio * ellipse) - (1.0 - 2.0 * axis)) - tilt
    return (
        ellipse * (1.0 - np.pi / (2.0 * ratio))
        - sine / ratio * ellipse * np.arcsin(y)
        + y / ratio * trailing
    )


def wave_loading(chord_over_wavelength: float, points: int = 40) -> tuple[float, float]:
    """Lift and moment of an infinite flat wing in an upwash that varies along it as a sine.

    The first is the lift over that of isolated sections; the second the moment about the
    quarter chord, nose up, over the same lift times the chord (zero for isolated sections).

    All vorticity varies as the same sine, so the sheet's equation is one along the chord. A
    spanwise vortex of circulation G sin(kappa y) and the wake it trails induce the downwash

        G [ kappa/2 + g(x) / 4 pi ] behind it,   -G g(|x|) / 4 pi ahead of it,
        g(x) = int_x^inf 2 kappa K1(kappa t) / t dt = 2 kappa [K1 - pi/2 + int_0^{kappa x} K0]

    whose singular part is that of a plane vortex: vortices and collocation points at the
    zeros of Gauss-Chebyshev quadrature (Stark, AIAA J. 9 (1971) 1854) converge as for an airfoil.
    """
    kappa = 2.0 * np.pi * chord_over_wavelength
    turn = np.pi / (2 * points + 1)
    order = np.arange(1, points + 1)
    vortex = -0.5 * np.cos((2 * order - 1) * turn)
    distance = -0.5 * np.cos(2 * order * turn)[:, None] - vortex
    z = kappa * np.abs(distance)
    near = 2.0 * kappa * (k1(z) - np.pi / 2 + iti0k0(z)[1]) / (4.0 * np.pi)
    downwash = np.where(distance > 0.0, 0.5 * kappa + near, -near)
    circulation = np.linalg.solve(downwash, np.ones(points)) / np.pi
    return float(circulation.sum()), float(-circulation @ (vortex + 0.25))
