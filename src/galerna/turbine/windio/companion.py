"""The companion of a windIO file: NAME.companion.yaml, what windIO has no place for.

``sources`` names the publication per block, ``published`` lists figures of the
whole turbine to hold galerna against, and ``blade``, ``hub``, ``nacelle``,
``drivetrain``, ``tower``, ``control`` and ``platform`` hold properties in SI
units under the names of ``galerna.turbine.model``. ``platform`` may name a file of
potential-flow coefficients, ``hydrodynamics``; ``mooring`` holds what the lines weigh and
stretch by their types; ``members`` what members have otherwise than in the windIO file.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine.model import Published
from galerna.turbine.windio import yamlfile
from galerna.turbine.windio.block import Block

#: What a companion may say of each part, and how many numbers it takes (0: one number).
PROPERTIES: dict[str, dict[str, int]] = {
    "blade": {"damping_ratio": 0},
    "tower": {"damping_ratio": 0},
    "hub": {"pitch_system_inertia": 0},
    "nacelle": {"yaw_stiffness": 0, "yaw_damping": 0, "drag_area": 3},
    "drivetrain": {"shaft_stiffness": 0, "shaft_damping": 0},
    "control": {"rated_wind_speed": 0, "rated_torque": 0, "region_2_rotor_speed": 0},
    "platform": {
        "reference_point": 3,
        "mass": 0,
        "center_of_mass": 3,
        "inertia": 3,
        "displaced_volume": 0,
        "water_depth": 0,
        "draft": 0,
        "additional_damping": 6,
    },
    "mooring": {"yaw_stiffness": 0, "seabed_friction": 0},
}
_TEXTS = {"platform": ("hydrodynamics",)}
_BLOCKS = {"mooring": ("line_types",)}
_RIGID_BODY = ("reference_point", "mass", "center_of_mass", "inertia")
_OF_A_LINE_TYPE = ("diameter", "mass", "weight", "stiffness")
_OF_A_MEMBER = ("sides", "drag_coefficient", "axial_drag_coefficient")
_KEYS = (*PROPERTIES, "members", "sources", "published")


class Companion:
    """Properties, sources and published figures beside a windIO file; empty where there is none."""

    def __init__(self, block: Block | None = None) -> None:
        self.sources: dict[str, str] = {}
        self.published: tuple[Published, ...] = ()
        self.properties: dict[str, dict[str, Any]] = {part: {} for part in PROPERTIES}
        self.line_types: dict[str, Block] = {}
        self.members: dict[str, Block] = {}
        self._block = block
        if block is not None:
            self._read(block)

    def _read(self, block: Block) -> None:
        _refuse_strange_keys(block, _KEYS)
        sources = block.optional("sources")
        self.sources = {str(key): sources.text(key) for key in sources.data}
        if block.has("published"):
            self.published = tuple(_published(b) for b in block.blocks("published"))
        for part in PROPERTIES:
            self.properties[part] = _properties(block.optional(part), part)
        self.line_types = _named(block.optional("mooring", "line_types"), _OF_A_LINE_TYPE)
        self.members = _named(block.optional("members"), _OF_A_MEMBER)
        self._finish_platform(block)

    def _finish_platform(self, block: Block) -> None:
        """Mass needs its place; a diagonal becomes a matrix, a file's name a path."""
        found = self.properties["platform"]
        if any(key in found for key in _RIGID_BODY):
            for key in _RIGID_BODY:
                block.block("platform").value(key)
        if "additional_damping" in found:
            found["additional_damping"] = np.diag(found["additional_damping"])
        if "hydrodynamics" in found:
            found["hydrodynamics"] = block.document.path.parent / found["hydrodynamics"]

    def refuse_parts_of_a_platform(self) -> None:
        """Raise where something is stated of a platform that neither file has."""
        self.refuse_mooring()
        if self._block is None:
            return
        if self.members:
            raise self._block.error("no floating_platform has these", "", "members")
        if self.properties["platform"] and "mass" not in self.properties["platform"]:
            self._block.block("platform").value("mass")

    def refuse_mooring(self) -> None:
        """Raise where something is stated of a mooring that the windIO file does not have."""
        if self._block is not None and self._block.has("mooring"):
            what = "the windIO file has no mooring"
            raise self._block.error(what, "it stands under components, with its lines", "mooring")


def companion_path(path: Path) -> Path:
    """``nrel5mw.companion.yaml`` beside ``nrel5mw.yaml``."""
    return path.with_name(path.stem + ".companion.yaml")


def read_companion(path: Path) -> Companion:
    """The companion of a windIO file, empty if there is none beside it."""
    beside = companion_path(path)
    return Companion(Block(yamlfile.load(beside)) if beside.is_file() else None)


def _published(block: Block) -> Published:
    return Published(
        block.text("quantity"), block.number("value"), block.text("unit"), block.text("source")
    )


def _properties(block: Block, part: str) -> dict[str, Any]:
    counts, texts, blocks = PROPERTIES[part], _TEXTS.get(part, ()), _BLOCKS.get(part, ())
    _refuse_strange_keys(block, (*counts, *texts, *blocks))
    found: dict[str, Any] = {key: block.text(key) for key in texts if key in block.data}
    for key, count in counts.items():
        if key in block.data:
            found[key] = tuple(block.array(key, count).tolist()) if count else block.number(key)
    return found


def _named(block: Block, valid: Iterable[str]) -> dict[str, Block]:
    """Blocks by name, of numbers under valid keys."""
    found = {str(name): block.block(name) for name in block.data}
    for inner in found.values():
        _refuse_strange_keys(inner, valid)
    return found


def _refuse_strange_keys(block: Block, valid: Iterable[str]) -> None:
    for key in block.data:
        if key not in valid:
            raise block.error(f"unknown key {key!r}", did_you_mean(str(key), valid), key)
