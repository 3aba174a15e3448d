"""The joints of a floating platform: named points, some of them along members."""

from __future__ import annotations

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine.model import Array
from galerna.turbine.windio.block import Block
from galerna.units import DEG


class Joints:
    """Positions (3,) m of joints by name, global axes, and the foot of the tower among them."""

    def __init__(self, floating: Block) -> None:
        self.position: dict[str, Array] = {}
        self.axial_drag: dict[str, float] = {}
        self.transition: str | None = None
        for block in floating.blocks("joints"):
            self._add(block, block.text("name"), self._location(block))
            self._note_transition(block)
            coefficients = block.optional("axial_coeffs")
            self.axial_drag[block.text("name")] = coefficients.number("Cd", 0.0, 0.0)
        for member in floating.blocks("members"):
            self._along(member)

    def of(self, block: Block, key: str) -> Array:
        """The position of the joint that ``block[key]`` names."""
        name = block.text(key)
        if name not in self.position:
            what = f"unknown joint {name!r}"
            raise block.error(what, did_you_mean(name, self.position), key)
        return self.position[name]

    def _add(self, block: Block, name: str, position: Array) -> None:
        if name in self.position:
            raise block.error(f"a second joint is named {name!r}", "names must differ", "name")
        self.position[name] = position

    def _location(self, block: Block) -> Array:
        """Cartesian position of (x, y, z), or of (r, angle in deg, z)."""
        a, b, z = block.array("location", 3).tolist()
        if block.data.get("cylindrical"):
            return np.array([a * np.cos(b * DEG), a * np.sin(b * DEG), z])
        location = np.array([a, b, z])
        if block.text("relative", "origin") == "origin":
            return location
        dims = np.array(block.data.get("relative_dims", [True] * 3), dtype=float)
        if dims.shape != (3,):
            raise block.error("expected three of true and false", "", "relative_dims")
        return location + dims * self.of(block, "relative")

    def _note_transition(self, block: Block) -> None:
        if not block.data.get("transition"):
            return
        if self.transition is not None:
            what = f"a second transition joint beside {self.transition!r}"
            raise block.error(what, "the tower stands on one", "transition")
        self.transition = block.text("name")

    def _along(self, member: Block) -> None:
        """Joints on the axis of a member."""
        if not member.has("axial_joints"):
            return
        start, end = self.of(member, "joint1"), self.of(member, "joint2")
        for block in member.blocks("axial_joints"):
            fraction = block.number("grid", low=0.0, high=1.0)
            self._add(block, block.text("name"), start + fraction * (end - start))
