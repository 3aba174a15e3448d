"""How unsteady lattices and their wakes are computed."""

from __future__ import annotations

from dataclasses import dataclass

from galerna.aero.vortex.convection import SCHEMES
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.mirror import MirrorPlane
from galerna.errors import InputError, did_you_mean
from galerna.units import AIR_DENSITY

STARTS = ("steady", "impulsive")


@dataclass(frozen=True, eq=False)
class UnsteadyOptions:
    """How the wakes of `UnsteadyLattice` move and are summed.

    ``free`` wakes move with the whole velocity, others with the wind. ``scheme`` is one of
    ``convection.SCHEMES``. ``core`` is that of the wake's vortices, None the singular vortex.
    ``tree_error`` is the relative error of the fast summation, None sums directly;
    ``wake_precision`` is of the velocities that wakes induce on wakes. With ``multirate`` rows
    behind wide panels get a new induced velocity when fluid has crossed these, in the scheme of
    Adams and Bashforth. ``start`` "steady" begins with the wake of the steady flow, "impulsive"
    without vortices in it. ``quasi_steady`` gives
    the whole wake the present circulation. ``hold_influences`` takes from the first ``solve`` of a
    step, for all others, what vortices of circulation 1 do to the boundary condition, and the
    velocity by the wake but for its first panels: iterations of a coupling move the surfaces
    little. ``classical_shedding`` leaves the circulation at the beginning of a step in
    one ring, as most programs do.
    """

    free: bool = True
    scheme: str = "adams_bashforth"
    core: VortexCore | None = None
    tree_error: float | None = 1e-3
    wake_precision: str = "single"
    start: str = "steady"
    quasi_steady: bool = False
    multirate: bool = False
    hold_influences: bool = False
    classical_shedding: bool = False
    mirror: MirrorPlane | None = None
    air_density: float = AIR_DENSITY
    rings: str = "quarter_chord"

    def __post_init__(self) -> None:
        for name, valid in (("scheme", SCHEMES), ("start", STARTS)):
            value = getattr(self, name)
            if value not in valid:
                raise InputError(f"{name} of the wake", f"{value!r}", did_you_mean(value, valid))
