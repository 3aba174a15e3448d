"""Validation cases; ``galerna validate`` runs them."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from .framework import Case

MODULES = (
    "bem",
    "bem_tip_node",
    "phase_vi",
    "corrections",
    "turbulence",
    "structure",
    "vibration",
    "multibody",
    "lattice_plates",
    "lattice_wings",
    "spanwise",
    "lattice_sharpy",
    "lattice_rotors",
    "lattice_yaw",
    "lattice_turbulence",
    "machine_modes",
    "flexible_rotor",
    "machine_land",
    "machine_base_motion",
    "machine_operation",
    "machine_energy",
    "afloat_hull",
    "afloat_mooring",
    "afloat_waves",
    "afloat_database",
    "afloat_radiation",
    "afloat_decay",
    "afloat_sea",
    "afloat_statements",
    "afloat_reasons",
    "afloat_volturnus",
)


def cases() -> Sequence[Case]:
    """Every case, in the order of the documentation."""
    return [case for name in MODULES for case in import_module(f".{name}", __name__).CASES]
