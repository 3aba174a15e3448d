"""Mooring lines: elastic catenaries, networks of them, and dynamic lines by MoorDyn."""

from __future__ import annotations

from typing import Literal

from galerna.contract import LoadModel
from galerna.hydro.strips import Carrier
from galerna.hydro.waves import Sea
from galerna.turbine.platform import Mooring

from .catenary import catenary
from .model import QuasiStaticLines
from .network import Network

__all__ = ["Network", "QuasiStaticLines", "catenary", "mooring_loads"]


def mooring_loads(
    mooring: Mooring, sea: Sea, kind: Literal["quasi_static", "dynamic"], carrier: Carrier
) -> LoadModel:
    """The lines of a platform in a sea, at rest or moving."""
    return QuasiStaticLines(mooring, carrier, sea.depth, sea.density, sea.gravity)
