"""Isotropic materials of a windIO file."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine.windio.block import Block


class Material(NamedTuple):
    """Young's modulus Pa, shear modulus Pa and density kg/m3."""

    young: float
    shear: float
    density: float


def material(document: Block, part: Block) -> Material:
    """The isotropic material that a part names."""
    name = part.text("material")
    materials = {block.text("name"): block for block in document.blocks("materials")}
    if name not in materials:
        raise part.error(f"unknown material {name!r}", did_you_mean(name, materials), "material")
    block = materials[name]
    tiny = float(np.finfo(float).tiny)
    young, density = block.number("E", low=tiny), block.number("rho", low=tiny)
    default = young / (2.0 * (1.0 + block.number("nu", 0.3, -0.99, 0.5)))
    return Material(young, block.number("G", default, tiny), density)
