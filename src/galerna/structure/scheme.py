"""Coefficients of the time integration, and when one of its steps has converged.

Sources: Chung and Hulbert, J. Appl. Mech. 60 (1993) 371; Newmark, J. Eng. Mech. Div. 85 (1959) 67.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError


@dataclass(frozen=True)
class Scheme:
    """Coefficients of a one-step scheme of the generalized-alpha family."""

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float

    @classmethod
    def generalized_alpha(cls, rho_inf: float = 0.9) -> Scheme:
        """Second order, with spectral radius ``rho_inf`` in [0, 1] at infinite frequency."""
        if not 0.0 <= rho_inf <= 1.0:
            raise InputError("rho_inf", f"{rho_inf:g} is outside 0 to 1", "0.9 is a good choice")
        if rho_inf > 0.99:
            warnings.warn(
                f"rho_inf = {rho_inf:g} damps nothing: with joints it is weakly unstable; "
                "0.9 or less is safe",
                stacklevel=2,
            )
        alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0)
        alpha_f = rho_inf / (rho_inf + 1.0)
        gamma = 0.5 + alpha_f - alpha_m
        return cls(alpha_m, alpha_f, 0.25 * (gamma + 0.5) ** 2, gamma)

    @classmethod
    def newmark(cls, alpha_n: float = 0.05) -> Scheme:
        """Newmark-beta with dissipation ``alpha_n``; of second order for alpha_n = 0 alone."""
        if not 0.0 <= alpha_n <= 0.5:
            raise InputError("alpha_n", f"{alpha_n:g} is outside 0 to 0.5")
        if alpha_n < 1e-3:
            warnings.warn(
                f"alpha_n = {alpha_n:g} lets the joints' forces ring; 0.01 or more is safe",
                stacklevel=2,
            )
        gamma = 0.5 + alpha_n
        return cls(0.0, 0.0, 0.25 * (gamma + 0.5) ** 2, gamma)


@dataclass(frozen=True)
class Tolerance:
    """When a step has converged: the errors that are left, each kind against its own size.

    ``relative`` to the largest increment, velocity, force or moment in the structure, or
    absolute in m, rad, m/s, rad/s, N and N m.
    """

    relative: float = 1e-6
    displacement: float = 1e-10
    rotation: float = 1e-10
    velocity: float = 1e-8
    angular_velocity: float = 1e-8
    force: float = 1e-3
    moment: float = 1e-3
    iterations: int = 20

    @property
    def absolute(self) -> Array:
        """The absolute tolerances (6,) in m, rad, m/s, rad/s, N and N m."""
        return np.array([self.displacement, self.rotation, self.velocity, self.angular_velocity,
                         self.force, self.moment])  # fmt: skip
