"""ElastoDyn: configuration, masses, drivetrain, platform, and its modal blade and tower.

ElastoDyn knows the flapwise and edgewise bending stiffness and the mass per length
of a blade, and the same of a tower; shear, extension, torsion and rotary inertia do
not exist in it. The section matrices made from it are rigid where it is silent
(far stiffer than any real beam) and have no rotary inertia, and a note says so.
"""

from __future__ import annotations

import numpy as np

from galerna.turbine.cross_section import inertia_matrix, stiffness_matrix
from galerna.turbine.model import (
    Array,
    Drivetrain,
    Hub,
    Nacelle,
    Platform,
    SectionProperties,
)
from galerna.turbine.openfast.deck import Deck
from galerna.units import DEG

#: A direction that ElastoDyn leaves out adds this fraction of the bending flexibility.
RIGID = 1e-4
#: what ElastoDyn does not say of a modal part
_MODAL = (
    "ElastoDyn gives no shear, axial and torsional stiffness and no rotary inertia; "
    f"the stiffnesses are rigid (they add {RIGID:g} of the bending flexibility), the "
    "inertia is zero"
)
_PERCENT = 0.01


def read_hub(deck: Deck) -> Hub:
    """ElastoDyn's cone is positive downwind, galerna's upwind."""
    return Hub(
        radius=deck.number("HubRad", low=0.0),
        cone=-deck.number("PreCone(1)", low=-89.0, high=89.0) * DEG,
        mass=deck.number("HubMass", 0.0, 0.0),
        inertia=deck.number("HubIner", 0.0, 0.0),
        center_of_mass=deck.number("HubCM", 0.0),
    )


def read_nacelle(deck: Deck, servo: Deck | None, drag_area: tuple[float, float, float]) -> Nacelle:
    """ElastoDyn's overhang and tilt are negative for an upwind rotor with its nose up."""
    overhang = -deck.number("OverHang")
    if overhang <= 0.0:
        line = deck.entry("OverHang").line
        raise deck.error("the rotor is downwind", "galerna computes upwind rotors only", line)
    return Nacelle(
        overhang=overhang,
        shaft_height=deck.number("Twr2Shft"),
        tilt=-deck.number("ShftTilt", low=-89.0, high=89.0) * DEG,
        mass=deck.number("NacMass", 0.0, 0.0),
        center_of_mass=(
            deck.number("NacCMxn", 0.0),
            deck.number("NacCMyn", 0.0),
            deck.number("NacCMzn", 0.0),
        ),
        yaw_inertia=deck.number("NacYIner", 0.0, 0.0),
        yaw_bearing_mass=deck.number("YawBrMass", 0.0, 0.0),
        yaw_stiffness=servo.number("YawSpr", 0.0, 0.0) if servo else 0.0,
        yaw_damping=servo.number("YawDamp", 0.0, 0.0) if servo else 0.0,
        drag_area=drag_area,
    )


def read_drivetrain(deck: Deck, servo: Deck | None) -> Drivetrain:
    return Drivetrain(
        gear_ratio=deck.number("GBRatio", 1.0, 1e-3),
        gearbox_efficiency=deck.number("GBoxEff", 100.0, 0.0, 100.0) * _PERCENT,
        generator_efficiency=(servo.number("GenEff", 100.0, 0.0, 100.0) if servo else 100.0)
        * _PERCENT,
        generator_inertia=deck.number("GenIner", 0.0, 0.0),
        shaft_stiffness=deck.number("DTTorSpr", 0.0, 0.0),
        shaft_damping=deck.number("DTTorDmp", 0.0, 0.0),
    )


def read_platform(deck: Deck, water_depth: float, displaced_volume: float) -> Platform | None:
    """The platform as a rigid body; None where ElastoDyn gives it no mass."""
    mass = deck.number("PtfmMass", 0.0, 0.0)
    if mass == 0.0:
        return None
    x, y, z = (deck.number(f"PtfmCM{axis}t", 0.0) for axis in "xyz")
    roll, pitch, yaw = (deck.number(f"Ptfm{axis}Iner", 0.0, 0.0) for axis in "RPY")
    return Platform(
        reference_point=(0.0, 0.0, deck.number("PtfmRefzt", 0.0)),
        mass=mass,
        center_of_mass=(x, y, z),
        inertia=(roll, pitch, yaw),
        displaced_volume=displaced_volume,
        water_depth=water_depth,
    )


def blade_length(deck: Deck) -> float:
    """Length of the pitch axis from root to tip, m."""
    length = deck.number("TipRad", low=0.0) - deck.number("HubRad", low=0.0)
    if length <= 0.0:
        raise deck.error("TipRad must be larger than HubRad", "", deck.entry("TipRad").line)
    return length


def read_blade_structure(deck: Deck, length: float, notes: list[str]) -> SectionProperties:
    """Sections of a modal blade; the axes are those of the structural twist."""
    table = deck.table("NBlInpSt", "BlFract", least=2)
    span = _fractions(deck, table, "BlFract")
    mass = _positive(deck, table, "BMassDen", deck.number("AdjBlMs", 1.0, 0.0))
    flap = _positive(deck, table, "FlpStff", deck.number("AdjFlSt", 1.0, 0.0))
    edge = _positive(deck, table, "EdgStff", deck.number("AdjEdSt", 1.0, 0.0))
    notes.append(f"blade: {_MODAL}")
    return SectionProperties(
        span=span,
        stiffness=_modal_stiffness(edge, flap, length),
        inertia=inertia_matrix(mass, (0.0, 0.0), (0.0, 0.0)),
        twist=deck.column(table, "StrcTwst") * DEG,
        damping_ratio=deck.number("BldFlDmp(1)", 0.0, 0.0) * _PERCENT,
    )


def read_tower_structure(deck: Deck, length: float, notes: list[str]) -> SectionProperties:
    """Sections of a modal tower; x is downwind, so fore-aft bending is about y."""
    table = deck.table("NTwInpSt", "HtFract", least=2)
    span = _fractions(deck, table, "HtFract")
    mass = _positive(deck, table, "TMassDen", deck.number("AdjTwMa", 1.0, 0.0))
    fore_aft = _positive(deck, table, "TwFAStif", deck.number("AdjFASt", 1.0, 0.0))
    side_side = _positive(deck, table, "TwSSStif", deck.number("AdjSSSt", 1.0, 0.0))
    notes.append(f"tower: {_MODAL}")
    return SectionProperties(
        span=span,
        stiffness=_modal_stiffness(side_side, fore_aft, length),
        inertia=inertia_matrix(mass, (0.0, 0.0), (0.0, 0.0)),
        twist=np.zeros_like(span),
        damping_ratio=deck.number("TwrFADmp(1)", 0.0, 0.0) * _PERCENT,
    )


def _modal_stiffness(about_x: Array, about_y: Array, length: float) -> Array:
    """Stiffness (n,6,6) from bending alone, rigid in the other directions.

    A cantilever's tip gives way by L^3/(3 EI) in bending and by L/(kGA) in shear, and a
    section turns by L/EI and L/GJ: kGA = 3 EI/(RIGID L^2) and GJ = EI/RIGID.
    """
    bending = np.maximum(about_x, about_y)
    force = 3.0 * bending / (RIGID * length**2)
    return stiffness_matrix(force, (about_x, about_y), (force, force), bending / RIGID)


def _fractions(deck: Deck, table: dict[str, Array], name: str) -> Array:
    """A column that ascends from 0 to 1."""
    span = deck.column(table, name)
    if abs(span[0]) > 1e-6 or abs(span[-1] - 1.0) > 1e-6 or (np.diff(span) <= 0.0).any():
        raise deck.error(f"column {name} must ascend from 0 to 1")
    return np.clip(span, 0.0, 1.0)


def _positive(deck: Deck, table: dict[str, Array], name: str, factor: float) -> Array:
    values = deck.column(table, name) * factor
    if values.min() <= 0.0:
        raise deck.error(f"column {name} must be positive, with its adjustment factor too")
    return values
