"""Potential-flow coefficients of a platform: what panel codes compute and files hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from galerna.contract import Array
from galerna.hydro.interpolation import curve_weights, heading_weights, whole_circle
from galerna.hydro.rigid import constant_force_stiffness, shift, turn
from galerna.hydro.waves.dispersion import wavenumber
from galerna.units import SEA_WATER, STANDARD_GRAVITY

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class HydroDatabase:
    """First-order coefficients about ``reference_point`` (3,) m, in SI, axes of the platform.

    ``frequency`` (n,) rad/s rises and is finite and positive; ``added_mass`` and ``damping``
    (n,6,6), ``added_mass_infinite`` and ``added_mass_zero`` (6,6) in kg, kg m, kg m2 and per
    second. ``heading`` (m,) rad rises: where the waves go, 0 along +x. ``excitation`` (n,m,6)
    N/m, N: an elevation Re[a exp(i w t)] above the reference point gives Re[a X exp(i w t)],
    which is WAMIT's convention. ``hydrostatic_stiffness`` (6,6) is of buoyancy alone: minus the
    rate of its force and moment over the motion, without any weight. ``center_of_buoyancy``
    (3,) m is seen from the same origin as the reference point; its height is NaN where a file
    does not tell it. ``mean_drift`` (n,m,6) N/m2 is the mean second-order force in regular
    waves over the amplitude's square.
    """

    frequency: Array
    added_mass: Array
    damping: Array
    added_mass_infinite: Array
    heading: Array
    excitation: Complex
    hydrostatic_stiffness: Array
    displaced_volume: float
    center_of_buoyancy: Array
    reference_point: Array
    water_depth: float
    water_density: float = SEA_WATER
    gravity: float = STANDARD_GRAVITY
    added_mass_zero: Array | None = None
    mean_drift: Array | None = None
    settings: Mapping[str, str | float] = field(default_factory=dict)

    @property
    def buoyancy(self) -> float:
        """Weight N of the displaced water."""
        return self.water_density * self.gravity * self.displaced_volume

    @property
    def failed(self) -> Array:
        """Frequencies rad/s that a panel code did not solve; their rows are NaN."""
        parts = [self.added_mass, self.damping, np.abs(self.excitation)]
        missing = [np.isnan(part).reshape(len(self.frequency), -1).any(axis=1) for part in parts]
        return self.frequency[np.any(missing, axis=0)]

    def coefficients_at(self, frequency: ArrayLike) -> tuple[Array, Array]:
        """Added mass and damping (q,6,6) at frequencies (q,) rad/s within those of the base.

        Cubic splines over frequency; from 0 to the first frequency added mass goes to
        ``added_mass_zero`` (or stays) and damping to 0. Raises InputError outside and where
        a frequency failed.
        """
        weights, first = self._weights(frequency)
        zero = self.added_mass[0] if self.added_mass_zero is None else self.added_mass_zero
        added = np.tensordot(weights, self.added_mass, 1) + np.multiply.outer(first, zero)
        return added, np.tensordot(weights, self.damping, 1)

    def excitation_at(self, frequency: ArrayLike, heading: ArrayLike) -> Complex:
        """Excitation (q,6) of waves of frequencies (q,) rad/s and headings (q,) or one, rad.

        Below the first frequency it goes to what a uniform rise of the sea gives, the
        stiffness' column of heave. Raises InputError like ``coefficients_at`` and for
        headings outside those of the base, unless these go round.
        """
        weights, first = self._weights(frequency)
        still = np.multiply.outer(first, self.hydrostatic_stiffness[:, 2])
        along = heading_weights(self.heading, np.broadcast_to(heading, len(weights)))
        return np.einsum("qf,qh,fhk->qk", weights, along, self.excitation, optimize=True) + still

    def drift_at(self, frequency: ArrayLike, heading: ArrayLike) -> Array | None:
        """Mean drift (q,6) N/m2 like ``excitation_at``; None where the base has none."""
        if self.mean_drift is None:
            return None
        weights, _ = self._weights(frequency)
        along = heading_weights(self.heading, np.broadcast_to(heading, len(weights)))
        return np.einsum("qf,qh,fhk->qk", weights, along, self.mean_drift, optimize=True)

    def _weights(self, frequency: ArrayLike) -> tuple[Array, Array]:
        return curve_weights(self.frequency, np.atleast_1d(frequency), self.failed)

    def symmetrised(self) -> HydroDatabase:
        """The same with added mass and damping equal to their transposes, as theory has it."""

        def half(a: Array) -> Array:
            return 0.5 * (a + np.swapaxes(a, -1, -2))

        zero = None if self.added_mass_zero is None else half(self.added_mass_zero)
        return replace(
            self,
            added_mass=half(self.added_mass),
            damping=half(self.damping),
            added_mass_infinite=half(self.added_mass_infinite),
            added_mass_zero=zero,
        )

    def moved(self, point: ArrayLike) -> HydroDatabase:
        """The same about another reference point (3,) m."""
        arm = self.reference_point - np.asarray(point, dtype=float)
        matrix = shift(arm)
        buoyancy = np.array([0.0, 0.0, self.buoyancy])
        ahead = np.multiply.outer(np.cos(self.heading), arm[0])
        ahead = np.multiply.outer(self.wavenumber, ahead + np.sin(self.heading) * arm[1])
        phase = np.exp(-1j * ahead)
        return replace(
            self._transformed(matrix),
            hydrostatic_stiffness=matrix.T @ self.hydrostatic_stiffness @ matrix
            + constant_force_stiffness(buoyancy, arm),
            excitation=(self.excitation @ matrix) * phase[:, :, None],
            reference_point=np.asarray(point, dtype=float),
        )

    def rotated(self, angle: float) -> HydroDatabase:
        """That of the body turned by ``angle`` rad about the vertical through the reference point.

        Headings turn with it and lie in -pi..pi again where they go round.
        """
        center, axis = self.center_of_buoyancy.copy(), self.reference_point[:2]
        center[:2] = axis + turn(angle)[:2, :2] @ (center[:2] - axis)  # its height may be unknown
        turned = replace(self._transformed(turn(angle).T), center_of_buoyancy=center)
        if whole_circle(self.heading):
            return turned.at_headings(self.heading - angle, self.heading)
        return replace(turned, heading=self.heading + angle)

    def at_headings(self, asked: ArrayLike, named: ArrayLike | None = None) -> HydroDatabase:
        """The same with headings (q,) rad, interpolated; ``named`` is what they are called."""
        weights = heading_weights(self.heading, np.asarray(asked, dtype=float))
        drift = None if self.mean_drift is None else weights @ self.mean_drift
        return replace(
            self,
            heading=np.asarray(asked if named is None else named, dtype=float),
            excitation=weights @ self.excitation,
            mean_drift=drift,
        )

    def _transformed(self, matrix: Array) -> HydroDatabase:
        """With motions that are ``matrix`` (6,6) times the new ones."""

        def both(a: Array) -> Array:
            return matrix.T @ a @ matrix

        return replace(
            self,
            added_mass=both(self.added_mass),
            damping=both(self.damping),
            added_mass_infinite=both(self.added_mass_infinite),
            added_mass_zero=None if self.added_mass_zero is None else both(self.added_mass_zero),
            hydrostatic_stiffness=both(self.hydrostatic_stiffness),
            excitation=self.excitation @ matrix,
            mean_drift=None if self.mean_drift is None else self.mean_drift @ matrix,
        )

    @property
    def wavenumber(self) -> Array:
        """Wave numbers (n,) 1/m of the frequencies."""
        return wavenumber(self.frequency, self.water_depth, self.gravity)
