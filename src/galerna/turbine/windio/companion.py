"""The companion of a windIO file: NAME.companion.yaml, what windIO has no place for.

``sources`` names the publication per block, ``published`` lists figures of the
whole turbine to hold galerna against, and ``blade``, ``hub``, ``nacelle``,
``drivetrain``, ``tower``, ``control`` and ``platform`` hold properties in SI
units under the names of ``galerna.turbine.model``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from galerna.errors import did_you_mean
from galerna.turbine.model import Platform, Published
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
    },
}


class Companion:
    """Properties, sources and published figures beside a windIO file; empty where there is none."""

    def __init__(self, block: Block | None = None) -> None:
        self.sources: dict[str, str] = {}
        self.published: tuple[Published, ...] = ()
        self.properties: dict[str, dict[str, Any]] = {part: {} for part in PROPERTIES}
        if block is None:
            return
        for key in block.data:
            if key not in (*PROPERTIES, "sources", "published"):
                valid = (*PROPERTIES, "sources", "published")
                raise block.error(f"unknown key {key!r}", did_you_mean(str(key), valid), key)
        sources = block.optional("sources")
        self.sources = {str(key): sources.text(key) for key in sources.data}
        if block.has("published"):
            self.published = tuple(_published(b) for b in block.blocks("published"))
        for part in PROPERTIES:
            self.properties[part] = _properties(block.optional(part), PROPERTIES[part])
        if block.has("platform"):
            for key in ("reference_point", "mass", "center_of_mass", "inertia"):
                block.block("platform").value(key)

    @property
    def platform(self) -> Platform | None:
        found = self.properties["platform"]
        return Platform(**found) if found else None


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


def _properties(block: Block, valid: dict[str, int]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key in block.data:
        if key not in valid:
            raise block.error(f"unknown key {key!r}", did_you_mean(str(key), valid), key)
        count = valid[key]
        found[key] = tuple(block.array(key, count).tolist()) if count else block.number(key)
    return found
