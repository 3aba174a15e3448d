"""The unsteady vortex lattice: lifting surfaces and free wakes as sheets of vortex rings.

The names below load what they need when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

#: public names by the module where each lives
_MODULES = {
    "ages": ("growing_ages", "revolution_ages", "rotor_ages", "uniform_ages"),
    "biot_savart": ("direct_velocity",),
    "blades": ("BladeLattice", "blade_lattice"),
    "cores": ("VortexCore",),
    "field": ("InducedField", "induced_velocity"),
    "lattice": ("Lattice",),
    "loads": ("SurfaceLoads",),
    "mirror": ("MirrorPlane",),
    "sheet": ("Sheet",),
    "free_wake": ("FreeWake",),
    "steady": ("SteadySolution", "solve_steady"),
    "surface": ("Surface",),
    "system": ("BoundSystem",),
    "rotor_axis": ("RotorAxis",),
    "wake": ("Wake",),
    "wings": ("elliptic_wing", "trapezoidal_wing", "wing_corners"),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'galerna.aero.vortex' has no attribute {name!r}")
    return getattr(import_module(f"galerna.aero.vortex.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
