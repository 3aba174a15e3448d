"""galerna: floating wind turbines simulated as one machine.

The names below load what they need when they are first used.
"""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

from galerna.kernel_cache import drop_stale_kernels

# Threads that wait for their next work by spinning cost more CPU time than the short kernels and
# small systems here. OpenBLAS reads its setting (2^4 cycles, not 2^26) when NumPy loads it,
# OpenMP when the first parallel kernel runs.
os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "4")
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

if TYPE_CHECKING:
    from galerna.aero.bem.steady import performance_surface, power_curve, steady_rotor
    from galerna.case import Case
    from galerna.case import load as load_case
    from galerna.errors import ConvergenceError, InputError
    from galerna.machine import build_machine
    from galerna.results import open_result, to_csv, to_outb
    from galerna.running import resume, run
    from galerna.session import start
    from galerna.turbine import Turbine
    from galerna.turbine import load as load_turbine
    from galerna.turbine import names as turbine_names

__version__ = "0.1.0"

__all__ = [
    "Case",
    "ConvergenceError",
    "InputError",
    "Turbine",
    "build_machine",
    "load_case",
    "load_turbine",
    "open_result",
    "performance_surface",
    "power_curve",
    "resume",
    "run",
    "start",
    "steady_rotor",
    "to_csv",
    "to_outb",
    "turbine_names",
]

drop_stale_kernels()

#: where each public name lives, and its name there
_HOMES = {
    "Case": ("galerna.case", "Case"),
    "ConvergenceError": ("galerna.errors", "ConvergenceError"),
    "InputError": ("galerna.errors", "InputError"),
    "Turbine": ("galerna.turbine", "Turbine"),
    "build_machine": ("galerna.machine", "build_machine"),
    "load_case": ("galerna.case", "load"),
    "load_turbine": ("galerna.turbine", "load"),
    "open_result": ("galerna.results", "open_result"),
    "performance_surface": ("galerna.aero.bem.steady", "performance_surface"),
    "power_curve": ("galerna.aero.bem.steady", "power_curve"),
    "resume": ("galerna.running", "resume"),
    "run": ("galerna.running", "run"),
    "start": ("galerna.session", "start"),
    "steady_rotor": ("galerna.aero.bem.steady", "steady_rotor"),
    "to_csv": ("galerna.results", "to_csv"),
    "to_outb": ("galerna.results", "to_outb"),
    "turbine_names": ("galerna.turbine", "names"),
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'galerna' has no attribute {name!r}")
    module, attribute = _HOMES[name]
    found = getattr(import_module(module), attribute)
    if "numba" in sys.modules:
        import_module("galerna.compiling").watch()
    return found


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
