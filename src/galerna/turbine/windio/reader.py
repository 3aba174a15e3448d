"""windIO v2 in: one file, checked, converted to SI and radians, made into a Turbine."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from galerna.turbine.model import Drivetrain, Hub, Nacelle, Tower, Turbine
from galerna.turbine.windio import yamlfile
from galerna.turbine.windio.blade import read_blade
from galerna.turbine.windio.block import Block
from galerna.turbine.windio.companion import Companion, read_companion
from galerna.turbine.windio.control import read_control
from galerna.turbine.windio.floating import read_platform
from galerna.turbine.windio.schema import validate_document
from galerna.turbine.windio.tower import read_tower
from galerna.units import DEG

_FOUNDATIONS = ("monopile", "jacket")
_CONVERTER = (
    "convert it in Python: from windIO.converters.windIO2windIO import v1p0_to_v2p0; "
    "v1p0_to_v2p0('OLD.yaml', 'NEW.yaml').convert()"
)
_HUB_HEIGHT_TOLERANCE = 0.005  # of the hub height: what files round away


def read(path: str | Path, validate: bool = True) -> Turbine:
    """A turbine from a windIO v2 file and, where there is one, the companion beside it.

    ``validate`` holds the file against the schema of the windIO package first; without
    it only the parts that galerna reads are checked. Raises InputError.
    """
    path = Path(path)
    document = Block(yamlfile.load(path))
    _refuse_other_versions(document)
    notes = validate_document(document.document) if validate else []
    return _turbine(document, read_companion(path), notes)


def _refuse_other_versions(document: Block) -> None:
    version = document.data.get("windIO_version")
    if version is None and "components" in document.data:
        raise document.error(
            "is a windIO v1 file, or a v2 file without its windIO_version; galerna reads v2",
            _CONVERTER,
        )
    if version is None:
        what = "is not a windIO turbine file: it has neither windIO_version nor components"
        raise document.error(what)
    major = str(version).split(".")[0]
    if major != "2":
        hint = _CONVERTER if major == "1" else ""
        raise document.error(f"windIO version {version}; galerna reads 2.x", hint, "windIO_version")


def _turbine(document: Block, companion: Companion, notes: list[str]) -> Turbine:
    extra = companion.properties
    notes += _left_out(document)
    blade, airfoils = read_blade(document, extra["blade"].get("damping_ratio"), notes)
    tower = read_tower(document, extra["tower"].get("damping_ratio"), notes)
    hub = replace(_hub(document), **extra["hub"])
    nacelle = replace(_nacelle(document), **extra["nacelle"])
    drivetrain = replace(_drivetrain(document), **extra["drivetrain"])
    control = read_control(document, drivetrain.gear_ratio, notes)
    return Turbine(
        name=document.text("name"),
        number_of_blades=_number_of_blades(document.block("assembly")),
        blade=blade,
        airfoils=airfoils,
        hub=hub,
        nacelle=nacelle,
        drivetrain=drivetrain,
        tower=tower,
        control=replace(control, **extra["control"]),
        hub_height=_hub_height(document.block("assembly"), tower, nacelle, notes),
        platform=read_platform(document, companion, tower.axis[0], notes),
        sources=companion.sources,
        published=companion.published,
        description=document.text("comments", ""),
        notes=tuple(notes),
    )


def _left_out(document: Block) -> list[str]:
    """Notes on what stands in the file and is not read, or is needed and does not stand there."""
    components, notes = document.block("components"), []
    if foundation := ", ".join(name for name in _FOUNDATIONS if name in components.data):
        notes.append(f"{foundation}: not read; the tower stands rigidly at its base")
    for name, block in (("hub", "hub"), ("nacelle", "drivetrain")):
        if not components.block(block).has("elastic_properties"):
            notes.append(f"{name}: no elastic properties in the file, so it has no mass")
    if not components.optional("drivetrain", "generator").has("rpm_efficiency"):
        notes.append("generator: no efficiency in the file, so it loses nothing")
    return notes


def _number_of_blades(assembly: Block) -> int:
    if str(assembly.data.get("rotor_orientation", "upwind")).lower() != "upwind":
        raise assembly.error("galerna computes upwind rotors only", "", "rotor_orientation")
    return int(assembly.number("number_of_blades", 3.0, 1.0, 10.0))


def _hub_height(assembly: Block, tower: Tower, nacelle: Nacelle, notes: list[str]) -> float:
    """Height of the hub centre, m, as tower and nacelle add up; the stated one is compared."""
    built = tower.axis[-1, 2] + nacelle.shaft_height + nacelle.overhang * np.sin(nacelle.tilt)
    stated = assembly.number("hub_height", 0.0, 0.0)
    if stated and abs(stated - built) > _HUB_HEIGHT_TOLERANCE * stated:
        notes.append(f"hub height: {stated:g} m stated, tower and nacelle add up to {built:g} m")
    return float(built)


def _hub(document: Block) -> Hub:
    block = document.block("components", "hub")
    return Hub(
        radius=block.number("diameter", low=0.0) / 2.0,
        cone=block.number("cone_angle", low=-30.0, high=30.0) * DEG,
        mass=_mass(block),
        inertia=_inertia(block)[0],
        center_of_mass=_location(block)[0],
    )


def _nacelle(document: Block) -> Nacelle:
    """The nacelle; windIO measures the overhang level and the model along the shaft."""
    drivetrain = document.block("components", "drivetrain")
    outer = drivetrain.block("outer_shape")
    tilt = outer.number("uptilt", low=-20.0, high=20.0) * DEG
    level = outer.number("overhang", low=0.0)
    mass, (x, y, z) = _mass(drivetrain), _location(drivetrain)
    return Nacelle(
        overhang=float(level / np.cos(tilt)),
        shaft_height=float(outer.number("distance_tt_hub", low=0.0) - level * np.tan(tilt)),
        tilt=tilt,
        mass=mass,
        center_of_mass=(x, y, z),
        yaw_inertia=_inertia(drivetrain)[2] + mass * (x * x + y * y),
        yaw_bearing_mass=_mass(document.optional("components", "yaw")),
    )


def _drivetrain(document: Block) -> Drivetrain:
    block = document.block("components", "drivetrain")
    gearbox, generator = block.optional("gearbox"), block.optional("generator")
    return Drivetrain(
        gear_ratio=gearbox.number("gear_ratio", 1.0, 1.0),
        gearbox_efficiency=gearbox.number("efficiency", 1.0, 0.0, 1.0),
        generator_efficiency=_generator_efficiency(generator),
        generator_inertia=_inertia(generator)[0],
    )


def _generator_efficiency(generator: Block) -> float:
    """The efficiency at the highest speed of the table."""
    if not generator.has("rpm_efficiency"):
        return 1.0
    table = generator.block("rpm_efficiency")
    efficiency = table.array("values", len(table.array("grid")), low=0.0)
    if not 0.0 < efficiency[-1] <= 1.0:
        raise table.error(f"efficiency of {efficiency[-1]:g}", "it is above 0, at most 1", "values")
    return float(efficiency[-1])


def _mass(part: Block) -> float:
    """Mass of a rigid body, kg; 0 where the file gives none."""
    return float(part.optional("elastic_properties").number("mass", 0.0, 0.0))


def _location(part: Block) -> tuple[float, float, float]:
    """Mass centre of a rigid body, m; the origin where the file gives none."""
    body = part.optional("elastic_properties")
    x, y, z = body.array("location", 3).tolist() if body.has("location") else (0.0, 0.0, 0.0)
    return x, y, z


def _inertia(part: Block) -> tuple[float, float, float]:
    """Moments of inertia of a rigid body about its mass centre, kg m2."""
    body = part.optional("elastic_properties")
    if not body.has("inertia"):
        return 0.0, 0.0, 0.0
    inertia = body.array("inertia")
    if len(inertia) not in (3, 6):
        raise body.error(f"holds {len(inertia)} values where 3 or 6 are expected", "", "inertia")
    x, y, z = inertia[:3].tolist()
    return x, y, z
