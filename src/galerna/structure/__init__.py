"""How the machine moves: frames, beams and joints, their equilibria, motions and modes.

The names below load what they need when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

#: public names by the module where each lives
_MODULES = {
    "assembly": ("GROUND", "Structure"),
    "beam": ("discretise", "nodal_loads", "straight", "uniform"),
    "bodies": ("point_mass", "rigid_body"),
    "initial": ("with_initial_accelerations",),
    "integrators": ("Integrator",),
    "joints": ("cylindrical", "hinge", "on_path", "prismatic", "rigid", "spherical", "spring"),
    "mode_names": ("name_modes",),
    "modes": ("natural_modes",),
    "scheme": ("Scheme", "Tolerance"),
    "statics": ("static_equilibrium",),
    "system": ("Forces", "State", "System", "spin_twists"),
    "turbine": ("TurbineOptions", "turbine_system"),
    "whirl": ("whirl_modes",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'galerna.structure' has no attribute {name!r}")
    return getattr(import_module(f"galerna.structure.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
