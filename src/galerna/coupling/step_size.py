"""How long the slowest swings of a machine's parts take, for a time step that resolves them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.structure.assembly import GROUND, Structure
from galerna.structure.beam import Beam, discretise
from galerna.structure.bodies import rigid_body
from galerna.structure.modes import natural_modes
from galerna.structure.options import StructureOptions
from galerna.structure.turbine import axis_curve
from galerna.turbine.model import Blade, Tower, Turbine

STEPS_PER_PERIOD = 6  #: below which a swing is hardly followed
ELEMENTS = 8


def bending_periods(turbine: Turbine, options: StructureOptions) -> dict[str, float]:
    """Periods s of the first bending of a blade in both directions and of the tower.

    Of the flexible parts alone: a blade that is clamped, a tower with all masses on its top.
    """
    periods: dict[str, float] = {}
    if turbine.blade.structure is None:
        return periods
    blade = _clamped(turbine.blade, turbine.blade.length)
    if options.blades == "flexible":
        first, second = _frequencies(blade, 0.0)
        periods["flapwise bending of the blades"] = 1.0 / first
        periods["edgewise bending of the blades"] = 1.0 / second
    if options.tower == "flexible" and turbine.tower.structure is not None:
        length = float(np.linalg.norm(np.diff(turbine.tower.axis, axis=0), axis=1).sum())
        rotor = turbine.number_of_blades * float(blade.mass[:, 0, 0].sum())
        top = rotor + turbine.hub.mass + turbine.nacelle.mass
        periods["bending of the tower"] = (
            1.0 / _frequencies(_clamped(turbine.tower, length), top)[0]
        )
    return periods


def _clamped(part: Blade | Tower, length: float) -> Beam:
    assert part.structure is not None
    sections = replace(part.structure, damping=np.zeros(6), damping_ratio=None)
    curve = axis_curve(part.axis_span, part.axis, np.eye(3), np.zeros(3), sections)
    return discretise(curve, length, sections, np.linspace(0.0, 1.0, ELEMENTS + 1))


def _frequencies(beam: Beam, tip_mass: float) -> tuple[float, float]:
    """The first two frequencies Hz of a beam clamped at its root with a mass kg at its end."""
    s = Structure((0.0, 0.0, 0.0))
    names = s.beam("beam", beam, root=GROUND)
    if tip_mass:
        s.add_mass(names[-1], rigid_body(tip_mass))
    system = s.build()
    first, second = natural_modes(system, system.initial_state(), 2).frequency.tolist()
    return first, second
