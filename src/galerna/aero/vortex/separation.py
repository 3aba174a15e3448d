"""Decambering in the course of time: each solution goes on from the wash last accepted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from galerna.aero.vortex.blades import BladeLattice
from galerna.aero.vortex.decambering import Decambered, Decambering, Solve
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.section_lift import SectionLift
from galerna.aero.vortex.section_polars import SectionPolars
from galerna.aero.vortex.surface import Surface, collocation_velocities
from galerna.contract import Array
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Blade


class Separation:
    """What an unsteady lattice asks to bring its sections' lift to their polars.

    ``found`` is the last solution. As in ``contract.LoadModel``, ``correct`` may be asked many
    times and depends on the accepted wash and its arguments alone.
    """

    def __init__(self, decambering: Decambering) -> None:
        self.decambering = decambering
        self.found: Decambered | None = None
        self._accepted: Array | None = None

    def response(self, solve: Solve, surfaces: Sequence[Surface]) -> Array:
        """Circulations (N,n) m of a wash of 1 m/s; see `Decambering.response`."""
        return self.decambering.response(solve, surfaces)

    def correct(
        self, surfaces: Sequence[Surface], wind: Array, circulation: Array, response: Array
    ) -> Array:
        """Circulations (N,) m2/s in place of those of potential flow.

        ``wind`` (P,3) m/s begins with that at the N collocation points; along the chord the
        undisturbed velocity counts, as it does for drag. ``response`` is the lattice's.
        Raises ConvergenceError that names the strip.
        """
        moving = collocation_velocities(surfaces)
        relative = wind[: len(moving)] - moving
        self.found = self.decambering.solve(
            surfaces, circulation, relative, response, self._accepted
        )
        return self.found.circulation

    def accept(self) -> None:
        """Keep the last solution's wash; part of accepting a step."""
        if self.found is not None:
            self._accepted = self.found.wash

    def state(self) -> dict[str, np.ndarray]:
        """The accepted wash (n,) m/s; empty before the first."""
        return {} if self._accepted is None else {"wash": self._accepted.copy()}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._accepted = np.array(state["wash"]) if "wash" in state else None
        self.found = None


def blade_separation(lattice: BladeLattice, blade: Blade, names: Sequence[str]) -> Separation:
    """For the equal blades of a rotor, called ``names``; InputError where they have no polars."""
    polars = SectionPolars.of_blade(lattice.sections, names[0]).part(lattice.bare_strips)
    chord = lattice.offsets[-1] - lattice.offsets[0]
    tilt = np.arctan2(chord[:, 0], chord[:, 1])
    corners = lattice.place(*blade_frames(blade, lattice.span))
    sections = SectionLift.of_lattice(Lattice(corners), 0.5 * (tilt[1:] + tilt[:-1]))
    count = len(names)
    return Separation(Decambering([polars] * count, [sections] * count, names))
