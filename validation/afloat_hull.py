"""What hulls displace: the OC3 spar and VolturnUS-S beside their reports."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from galerna import turbine
from galerna.errors import InputError
from galerna.hydro.hull import build_hull
from galerna.hydro.hydrostatics import Hydrostatics, hydrostatics
from galerna.turbine.platform import Member
from galerna.turbine.summary import summary
from galerna.units import SEA_WATER, STANDARD_GRAVITY

from .framework import Case, Check, NotRunError

OC3 = "NREL/TP-500-47535, Table 4-2"
VOLTURNUS = "NREL/TP-5000-76773 as commonly quoted"
HYDRODYN = "HydroDyn file of the UMaineSemi deck, IEA Wind TCP Task 37"
WEIGHT = SEA_WATER * STANDARD_GRAVITY
PANELS = 2.5e-3  #: 60 panels inside a circle, as WAMIT's: sin(6 deg) / (6 deg) is 0.18 % less


def _members(name: str) -> Sequence[Member]:
    platform = turbine.load(name).platform
    assert platform is not None
    return platform.members


def _still(name: str) -> Hydrostatics:
    return hydrostatics(build_hull(_members(name)))


def _inscribed() -> Hydrostatics:
    """The spar with 60 panels around, whose corners lie on the circles as WAMIT's do."""
    (spar,) = _members("nrel5mw_oc3")
    angle = 2.0 * np.pi / 60
    sides = spar.sides * np.sqrt(np.sin(angle) / angle)
    return hydrostatics(build_hull([replace(spar, sides=sides)], facets=60))


def spar() -> Iterator[Check]:
    found, inscribed = _still("nrel5mw_oc3"), _inscribed()
    yield Check("buoyancy", WEIGHT * found.volume, 80708100.0, OC3, 1e-5, "N", relative=True)
    for name, k, published, unit in (
        ("heave", 2, 332941.0, "N/m"),
        ("pitch", 4, -4.99918e9, "N m/rad"),
    ):
        stiffness, panels = found.stiffness[k, k], inscribed.stiffness[k, k]
        title = f"stiffness in {name}"
        yield Check(title, stiffness, published, OC3, PANELS, unit, relative=True)
        title += ", 60 panels around"
        yield Check(title, panels, published, OC3, 5e-5, unit, relative=True)


def semisubmersible() -> Iterator[Check]:
    try:
        found = _still("iea15mw_volturnus")
    except InputError as e:
        raise NotRunError(str(e)) from e
    depth = found.center_of_buoyancy[2]
    yield Check("displacement", found.volume, 20206.34889, HYDRODYN, 1e-4, "m3", relative=True)
    yield Check("centre of buoyancy", depth, -13.63, VOLTURNUS, 0.005, "m")
    yield from _balance(found)


def _balance(found: Hydrostatics) -> Iterator[Check]:
    """What is left of buoyancy for the lines to pull: shown beside the report's machine."""
    machine = turbine.load("iea15mw_volturnus")
    rows = {row.quantity: row.value or 0.0 for row in summary(machine)}
    mass = sum(rows[name] for name in ("rotor_nacelle_mass", "tower_mass", "platform_mass"))
    published = WEIGHT * 20206.0 - STANDARD_GRAVITY * 20093e3
    source = f"{VOLTURNUS}: 20,206 m3 and 20,093 t in all"
    pull = WEIGHT * found.volume - STANDARD_GRAVITY * mass
    yield Check("buoyancy less weight", pull, published, source, unit="N")


CASES = [
    Case("afloat-spar-statics", "afloat", "Buoyancy of the OC3 spar", spar, 1,
         "Buoyancy alone, without the weight of the structure. The hull is exact; the report's "
         "stiffness is that of WAMIT's panels, 60 around with their corners on the circle, which "
         "take 0.18 % off area and volume: with the same panels the figures agree."),
    Case("afloat-volturnus-statics", "afloat", "Buoyancy of VolturnUS-S", semisubmersible, 2,
         "The hull is the union of columns and pontoons of 12.5 m x 7 m; what they share counts "
         "once. Rotor and nacelle here are those of the windIO file, 43 t lighter than the "
         "report's, and the tower 14 t lighter, while the platform's 17,854 t are 15 t more than "
         "in the report's table of the whole system: the lines are left 0.42 MN more to pull."),
]  # fmt: skip
