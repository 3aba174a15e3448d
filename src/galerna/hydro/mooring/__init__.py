"""Mooring lines: elastic catenaries, networks of them, and dynamic lines by MoorDyn."""

from __future__ import annotations

from typing import Literal

from galerna.contract import LoadModel
from galerna.hydro.strips import Carrier
from galerna.hydro.waves import Sea
from galerna.turbine.platform import Mooring

from .catenary import Catenary, catenary
from .model import MooringLines
from .network import Network
from .shape import line_shape, shape_in_space

__all__ = [
    "Catenary",
    "MooringLines",
    "Network",
    "catenary",
    "line_shape",
    "mooring_loads",
    "shape_in_space",
]


def mooring_loads(
    mooring: Mooring, sea: Sea, kind: Literal["quasi_static", "dynamic"], carrier: Carrier
) -> LoadModel:
    """The lines of a platform in a sea: catenaries at rest, or MoorDyn's (extra moordyn).

    Raises InputError for lines that cannot be, or where MoorDyn is not there.
    """
    if kind == "dynamic":
        from .moordyn import DynamicLines

        return DynamicLines(mooring, carrier, sea.depth, sea.density, sea.gravity)
    return MooringLines(mooring, carrier, sea.depth, sea.density, sea.gravity)
