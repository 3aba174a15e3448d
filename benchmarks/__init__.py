"""Speed and scale; ``python -m benchmarks`` runs them."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from .framework import Benchmark

MODULES = (
    "bem",
    "turbulence",
    "structure",
    "vortex_kernels",
    "vortex",
    "machine",
    "machine_start",
    "machine_vortex",
    "afloat",
    "discon",
)


def benchmarks() -> Sequence[Benchmark]:
    """Every benchmark, in the order of the documentation."""
    return [b for name in MODULES for b in import_module(f".{name}", __name__).BENCHMARKS]
