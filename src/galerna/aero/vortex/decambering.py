"""Lift of separated sections: a wash through each strip that brings its lift to its polar.

Separation takes camber away from a section. As with Mukherjee and Gopalarathnam (J. Aircraft
43, 2006), each strip has one unknown that does so, found by Newton's method for all strips
together, because each acts on the others through the vortices. Here it is a wash s added to the
velocity through the panels of the strip. Where strips feel the velocities w across their zero-lift
lines (see ``section_lift``), lift rho V Gamma with the polar's coefficient asks for the wash

    g(w) = (V(w) cl(alpha(w)) - a_0 w) / a_1,

and the lattice, whose circulations respond to washes by the matrix M, gives

    w = w_0 - B s,   B = diag(a_1/a_0) - diag(2/(c a_0)) M,   s = S g(w),

with w_0 in potential flow. In plane flow B is zero. Along the span it stands for induction: a
wave of wash of length lambda comes back to its own strips with the share b = x/(1 + x),
x = (pi^2/2) c/lambda, in lifting-line theory. Where the polar falls by p per radian, waves with
b (1 + p/2 pi) > 1 have nothing to restrain them: neighbouring strips part into stalled and
attached ones, ever shorter the finer the panels. A section does not stall on so much less than
its chord: S mixes the wash along the span, as a diffusion over ``mixing`` chords would, and
takes the short waves out. The largest eigenvalue of B S on rectangular wings, up to 120 panels
across, is 1.00 without mixing, 0.68 with a quarter and 0.56 with half a chord, so that there is
one solution for polars that fall by less than 0, 3 and 5 per radian. Beyond, the solution is the
one that follows from the last.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from galerna.aero.vortex.section_lift import EffectiveFlow, SectionLift, strip_chords
from galerna.aero.vortex.section_polars import SectionPolars
from galerna.aero.vortex.surface import Surface
from galerna.contract import Array
from galerna.errors import ConvergenceError

MIXING = 0.25  #: chords
TOLERANCE = 1e-6  #: of the velocity across, over the speed
ITERATIONS, SETTLING_STEPS = 30, 300
SHORTEST = 0.02  #: of Newton's steps
SLOPE_STEP = np.radians(0.25)  #: on both sides, over which a polar's slope is taken
Solve = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Decambered:
    """A flow whose sections have the lift of their polars.

    ``circulation`` (N,) m2/s of all rings, ``wash`` (n,) m/s of all strips, and the ``flow`` that
    their sections feel: angle of attack (n,) rad and speed (n,) m/s.
    """

    circulation: Array
    wash: Array
    flow: EffectiveFlow


class Decambering:
    """Brings the lift of all strips of some surfaces to their polars.

    ``polars`` and ``sections`` are those of each surface, ``names`` what errors call them.
    ``mixing`` is in chords; 0 mixes nothing.
    """

    def __init__(
        self,
        polars: Sequence[SectionPolars],
        sections: Sequence[SectionLift],
        names: Sequence[str],
        mixing: float = MIXING,
    ) -> None:
        self.polars = SectionPolars.joined(polars)
        self.sections = SectionLift.joined(sections)
        self.mixing = mixing
        self._names = [(n, j) for n, p in zip(names, polars, strict=True) for j in range(len(p))]

    def response(self, solve: Solve, surfaces: Sequence[Surface]) -> Array:
        """Circulations (N,n) m of a wash of 1 m/s through each strip.

        ``solve`` finds circulations (N,n) from normal velocities (N,n), with the wake where it
        follows at once.
        """
        return solve(-_through_panels(np.eye(len(self.polars)), surfaces))

    def solve(
        self,
        surfaces: Sequence[Surface],
        circulation: Array,
        relative_velocity: Array,
        response: Array,
        start: Array | None = None,
    ) -> Decambered:
        """The flow with decambering from potential flow with ``circulation`` (N,) m2/s.

        ``relative_velocity`` (N,3) m/s is that of the air at the collocation points, less that
        of the surfaces; the wake's part may be in it or not. The search goes on from the wash
        ``start`` (n,) m/s. Raises ConvergenceError that names the strip.
        """
        chord, chordwise = _along_chords(surfaces, relative_velocity)
        edge, mix = _trailing(surfaces), self._mixed(surfaces)
        induction = self._induction(response[edge], chord)
        potential = self.sections.across(circulation[edge], chord)
        first = potential if start is None else potential - induction @ start
        across = self._newton(first, potential, induction @ mix, chordwise)
        wash = mix @ self._wanted_wash(across, chordwise)
        flow = self.sections.effective_flow(across, chordwise)
        return Decambered(circulation + response @ wash, wash, flow)

    def feedback(self, surfaces: Sequence[Surface], response: Array) -> Array:
        """B S (n,n): the share of each strip's wanted wash that comes back to all of them."""
        chord = np.concatenate([strip_chords(s.lattice.corners)[0] for s in surfaces])
        return self._induction(response[_trailing(surfaces)], chord) @ self._mixed(surfaces)

    def _newton(self, across: Array, potential: Array, coupling: Array, chordwise: Array) -> Array:
        """The w (n,) m/s of w = w_0 - B S g(w), by Newton's method with shortened steps.

        Where these lead nowhere, the solution is followed as one that settles in time,
        dw/dt = w_0 - B S g(w) - w, in implicit steps: that finds stable ones alone.
        """
        scale = np.hypot(chordwise, potential)
        scale = np.maximum(scale, 1e-3 * scale.max() + np.finfo(float).tiny)

        def residual(w: Array) -> Array:
            return (w - potential + coupling @ self._wanted_wash(w, chordwise)) / scale

        lacking = residual(across)
        for iteration in range(ITERATIONS + SETTLING_STEPS):
            if np.all(np.abs(lacking) <= TOLERANCE):
                return across
            settling = iteration >= ITERATIONS
            matrix = coupling * self._wash_slope(across, chordwise, scale)
            matrix += np.eye(len(across)) * (2.0 if settling else 1.0)
            step = np.linalg.solve(matrix, -lacking * scale)
            share, size = 1.0, np.linalg.norm(lacking)
            lacking = residual(across + step)
            while not settling and np.linalg.norm(lacking) > (1.0 - 0.1 * share) * size:
                if share <= SHORTEST:
                    break
                share *= 0.5
                lacking = residual(across + share * step)
            across = across + share * step
        return self._give_up(np.abs(lacking))

    def _wanted_wash(self, across: Array, chordwise: Array) -> Array:
        """g(w): the wash (n,) m/s that gives strips which feel w (n,) m/s their polars' lift."""
        flow = self.sections.effective_flow(across, chordwise)
        lift = self.polars.at_angle(flow.angle_of_attack)[..., 0]
        return (flow.speed * lift - self.sections.slope * across) / self.sections.wash_slope

    def _wash_slope(self, across: Array, chordwise: Array, scale: Array) -> Array:
        step = SLOPE_STEP * scale
        above = self._wanted_wash(across + step, chordwise)
        return (above - self._wanted_wash(across - step, chordwise)) / (2.0 * step)

    def _induction(self, response: Array, chord: Array) -> Array:
        """B (n,n), from the response (n,n) m."""
        sections = self.sections
        plane = np.diag(sections.wash_slope / sections.slope)
        return plane - 2.0 * response / (chord * sections.slope)[:, None]

    def _mixed(self, surfaces: Sequence[Surface]) -> Array:
        """S (n,n): rows that add up to 1 and mix the washes of each surface along its span."""
        mix = np.zeros((len(self.polars), len(self.polars)))
        first = 0
        for surface in surfaces:
            own = slice(first, first + surface.shape[1])
            mix[own, own] = _diffusion(surface.lattice.corners, self.mixing)
            first = own.stop
        return mix

    def _give_up(self, lacking: Array) -> NoReturn:
        strip = int(np.argmax(lacking))
        name, column = self._names[strip]
        raise ConvergenceError(
            name,
            f"the lift of panel column {column + 1} does not come to its polar: "
            f"{lacking[strip]:.2g} of the speed is missing",
            "mix the wash over more of the span, or switch decambering off",
        )


def _through_panels(wash: Array, surfaces: Sequence[Surface]) -> Array:
    """A wash (n,...) m/s per strip as one per panel (N,...), rows first in each surface."""
    parts, first = [], 0
    for surface in surfaces:
        m, n = surface.shape
        part = wash[first : first + n]
        parts.append(np.tile(part, (m,) + (1,) * (part.ndim - 1)))
        first += n
    return np.concatenate(parts)


def _trailing(surfaces: Sequence[Surface]) -> Array:
    """Numbers (n,) of the rings at the trailing edges."""
    numbers, first = [], 0
    for surface in surfaces:
        m, n = surface.shape
        numbers.append(first + (m - 1) * n + np.arange(n))
        first += m * n
    return np.concatenate(numbers)


def _along_chords(surfaces: Sequence[Surface], relative: Array) -> tuple[Array, Array]:
    """Chords (n,) m, and the mean velocity (n,) m/s along them over the panels of a strip."""
    chords, speeds, first = [], [], 0
    for surface in surfaces:
        m, n = surface.shape
        chord, aft = strip_chords(surface.lattice.corners)
        mean = relative[first : first + m * n].reshape(m, n, 3).mean(axis=0)
        chords.append(chord)
        speeds.append(np.sum(mean * aft, axis=1))
        first += m * n
    return np.concatenate(chords), np.concatenate(speeds)


def _diffusion(corners: Array, mixing: float) -> Array:
    """(W + K)^-1 W (n,n): implicit diffusion along the span over ``mixing`` chords."""
    chord, _ = strip_chords(corners)
    quarter = 0.75 * corners[0] + 0.25 * corners[-1]
    width = np.linalg.norm(np.diff(quarter, axis=0), axis=1)
    apart = 0.5 * (width[1:] + width[:-1])
    conductance = (mixing * 0.5 * (chord[1:] + chord[:-1])) ** 2 / apart
    matrix = np.diag(width)
    inner = np.arange(len(conductance))
    matrix[inner, inner] += conductance
    matrix[inner + 1, inner + 1] += conductance
    matrix[inner, inner + 1] -= conductance
    matrix[inner + 1, inner] -= conductance
    return np.linalg.solve(matrix, np.diag(width))
