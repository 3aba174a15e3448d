"""Names for the modes of a turbine, by where their elastic energy is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from galerna.contract import Array

from .modes import Modes
from .system import State
from .turbine import TurbineSystem

BENDING = {"flap": (0, 4), "edge": (1, 3), "torsion": (5,), "tension": (2,)}
TOWER = {"flap": "tower fore-aft", "edge": "tower side-side", "torsion": "tower torsion",
         "tension": "tower tension"}  # fmt: skip


def name_modes(turbine: TurbineSystem, state: State, modes: Modes) -> list[str]:
    """A name for each mode, such as "tower fore-aft 1", "blade flap yaw 1", "drivetrain 1".

    A rotor's asymmetric modes are called by the nacelle motion that they drive: "yaw" where
    the blades to the left and right bend against each other (for edgewise modes up and
    down), "pitch" otherwise; blade 1 is taken to point up.
    """
    kinds = [_kind(turbine, state, shape) for shape in modes.shape]
    seen: Counter[str] = Counter()
    names = []
    for kind in kinds:
        seen[kind] += 1
        names.append(f"{kind} {seen[kind]}")
    return names


def _kind(turbine: TurbineSystem, state: State, shape: Array) -> str:
    system = turbine.system
    answer = system.pair_answer(state)
    moved = shape[system.pairs.ends].reshape(-1, 12)
    strain = np.einsum("mij,mj->mi", answer.direction, moved)
    stress = np.einsum("mij,mj->mi", system.pairs.stiffness, strain)
    energy = np.real(np.conj(strain) * stress)
    shares = _shares(system.pair_names, energy)
    largest = max(shares, key=lambda name: shares[name])
    if largest.startswith("blade"):
        return _rotor_kind(turbine, strain, largest)
    return largest


def _shares(names: list[str], energy: Array) -> dict[str, float]:
    """Elastic energy of the tower and the blades by kind of strain, and of the springs."""
    part = np.array([name.partition(":")[0].rstrip("0123456789") for name in names])
    shares = {}
    for kind, components in BENDING.items():
        by_pair = energy[:, components].sum(axis=1)
        shares[TOWER[kind]] = float(by_pair[part == "tower"].sum())
        shares[f"blade {kind}"] = float(by_pair[part == "blade"].sum())
    shares["drivetrain"] = float(energy[part == "shaft"].sum())
    shares["yaw bearing"] = float(energy[part == "yaw bearing"].sum())
    return shares


def _rotor_kind(turbine: TurbineSystem, strain: Array, kind: str) -> str:
    """Collective, pitch or yaw, from the blades' largest bending."""
    component = {"blade flap": 4, "blade edge": 3}.get(kind, 5)
    amplitudes = _blade_amplitudes(turbine.system.pair_names, strain[:, component])
    azimuth = 2.0 * np.pi * np.arange(len(amplitudes)) / len(amplitudes)
    patterns: Mapping[str, Array] = {
        "collective": np.full(len(amplitudes), np.sqrt(0.5)),
        "pitch": np.cos(azimuth),
        "yaw": np.sin(azimuth),
    }
    if kind == "blade edge":
        patterns = {**patterns, "pitch": patterns["yaw"], "yaw": patterns["pitch"]}
    pattern = max(patterns, key=lambda name: abs(patterns[name] @ amplitudes))
    if kind == "blade edge" and pattern == "collective":
        return "drivetrain"
    return f"{kind} {pattern}"


def _blade_amplitudes(names: list[str], strain: Array) -> Array:
    """The strain of every blade at the element where the blades together strain most."""
    blades: dict[str, list[complex]] = {}
    for name, value in zip(names, strain, strict=True):
        part, _, element = name.partition(":")
        if part.startswith("blade") and element:
            blades.setdefault(part, []).append(value)
    table = np.array(list(blades.values()))
    return table[:, np.abs(table).sum(axis=0).argmax()]
