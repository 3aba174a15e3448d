"""windIO v2 in: one file, checked, converted to SI and radians, made into a Turbine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine import elastic, yamlfile
from galerna.turbine.airfoils import build_airfoil, merged_grid, read_airfoils
from galerna.turbine.block import Block
from galerna.turbine.companion import Companion, read_companion
from galerna.turbine.control import read_control
from galerna.turbine.model import (
    Airfoil,
    Array,
    Blade,
    BladeShape,
    Drivetrain,
    Hub,
    Nacelle,
    SectionProperties,
    Tower,
    Turbine,
)
from galerna.units import DEG

_SAME_POSITION = 1e-6  # of the span


def read(path: str | Path, validate: bool = True) -> Turbine:
    """A turbine from a windIO v2 file and, where there is one, the companion beside it.

    ``validate`` holds the file against the schema of the windIO package first; without
    it only the parts that galerna reads are checked. Raises InputError.
    """
    path = Path(path)
    document = Block(yamlfile.load(path))
    _refuse_other_versions(document)
    notes: list[str] = []
    if validate:
        from galerna.turbine.schema import validate_document

        notes += validate_document(document.document)
    return _Reader(document, read_companion(path), notes).turbine()


def _refuse_other_versions(document: Block) -> None:
    version = document.data.get("windIO_version")
    if version is None and "components" in document.data:
        raise document.error(
            "is a windIO v1 file, or a v2 file without its windIO_version; galerna reads v2",
            "convert it: from windIO.converters.windIO2windIO import v1p0_to_v2p0; "
            "v1p0_to_v2p0('OLD.yaml', 'NEW.yaml').convert()",
        )
    if version is None:
        raise document.error(
            "is not a windIO turbine file: it has neither windIO_version nor components"
        )
    if str(version).split(".")[0] != "2":
        raise document.error(f"windIO version {version}; galerna reads 2.x", "", "windIO_version")


class _Reader:
    """Takes one document apart; collects what it decides in ``notes``."""

    def __init__(self, document: Block, companion: Companion, notes: list[str]) -> None:
        self.document, self.companion, self.notes = document, companion, notes
        self.components = document.block("components")
        self.assembly = document.block("assembly")

    def turbine(self) -> Turbine:
        blade, airfoils = self.blade()
        tower = self.tower()
        hub, nacelle, drivetrain = self.hub(), self.nacelle(), self.drivetrain()
        control = read_control(self.document, drivetrain.gear_ratio, self.notes)
        return Turbine(
            name=self.document.text("name"),
            number_of_blades=self.number_of_blades(),
            blade=blade,
            airfoils=airfoils,
            hub=hub,
            nacelle=nacelle,
            drivetrain=drivetrain,
            tower=tower,
            control=replace(control, **self.companion.properties["control"]),
            hub_height=self.hub_height(tower, nacelle),
            platform=self.companion.platform,
            sources=self.companion.sources,
            published=self.companion.published,
            description=self.document.text("comments", ""),
            notes=tuple(self.notes),
        )

    def number_of_blades(self) -> int:
        if str(self.assembly.data.get("rotor_orientation", "upwind")).lower() != "upwind":
            raise self.assembly.error(
                "galerna computes upwind rotors only", "", "rotor_orientation"
            )
        return int(self.assembly.number("number_of_blades", 3.0, 1.0, 10.0))

    def hub_height(self, tower: Tower, nacelle: Nacelle) -> float:
        """Height of the hub centre by the geometry; the stated one is compared with it."""
        stated = self.assembly.number("hub_height", 0.0, 0.0)
        rise = nacelle.shaft_height + nacelle.overhang * np.sin(nacelle.tilt)
        built = float(tower.axis[-1, 2] + rise)
        if stated and abs(stated - built) > 0.01 * stated:
            self.notes.append(
                f"hub height: {stated:g} m is stated, tower and nacelle add up to {built:g} m"
            )
        return built

    # blade -------------------------------------------------------------------

    def blade(self) -> tuple[Blade, dict[str, Airfoil]]:
        block = self.components.block("blade")
        axis_span, axis = reference_axis(block.block("reference_axis"))
        shape_block = block.block("outer_shape")
        placed, airfoils = self.placed_airfoils(shape_block)
        shape = self.blade_shape(shape_block, placed)
        blade = Blade(axis_span, axis, shape, None)
        if block.optional("structure").has("elastic_properties"):
            blade = replace(blade, structure=self.blade_structure(block, shape))
        return blade, airfoils

    def blade_shape(self, block: Block, placed: list[tuple[float, str]]) -> BladeShape:
        curves = {key: block.curve(key) for key in ("chord", "twist", "rthick", "section_offset_y")}
        if block.has("section_offset_x"):
            curves["section_offset_x"] = block.curve("section_offset_x")
        self.check_shape(block, curves)
        span = merged_grid(*(grid for grid, _ in curves.values()))
        at_span = {key: np.interp(span, *curve) for key, curve in curves.items()}
        return BladeShape(
            span=span,
            chord=at_span["chord"],
            twist=at_span["twist"] * DEG,
            relative_thickness=at_span["rthick"],
            leading_edge_offset=at_span["section_offset_y"],
            normal_offset=at_span.get("section_offset_x", np.zeros_like(span)),
            airfoil_span=np.array([position for position, _ in placed]),
            airfoil_names=tuple(name for _, name in placed),
        )

    def check_shape(self, block: Block, curves: Mapping[str, tuple[Array, Array]]) -> None:
        grid, chord = curves["chord"]
        if (chord <= 0.0).any():
            i = int(np.argmin(chord))
            raise block.error(
                f"chord of {chord[i]:g} m at span {grid[i]:.4g}; it must be positive",
                "",
                "chord",
                "values",
            )
        if np.abs(curves["twist"][1]).max() > 90.0:
            raise block.error("twist beyond 90 deg", "windIO v2 wants degrees", "twist", "values")
        thickness = curves["rthick"][1]
        if (thickness <= 0.0).any() or (thickness > 1.0).any():
            raise block.error("relative thickness outside 0 to 1", "", "rthick", "values")

    def placed_airfoils(self, shape: Block) -> tuple[list[tuple[float, str]], dict[str, Airfoil]]:
        """Where each airfoil stands along the span, and the airfoils that stand somewhere."""
        database = read_airfoils(self.document)
        placed: list[tuple[float, str]] = []
        airfoils: dict[str, Airfoil] = {}
        for entry in shape.blocks("airfoils"):
            name = entry.text("name")
            if name not in database:
                raise entry.error(f"unknown airfoil {name!r}", did_you_mean(name, database), "name")
            block, polar_sets = database[name]
            weights = blend_weights(entry)
            full_name = name if len(weights) < 2 else f"{name} [{blend_text(weights)}]"
            if full_name not in airfoils:
                airfoils[full_name] = build_airfoil(block, polar_sets, weights, full_name)
            position = self.position(shape, entry, airfoils[full_name].relative_thickness, placed)
            placed.append((position, full_name))
        if not placed:
            raise shape.error("no airfoil stands along the blade", "", "airfoils")
        return placed, airfoils

    def position(
        self, shape: Block, entry: Block, thickness: float, placed: list[tuple[float, str]]
    ) -> float:
        """Span of an airfoil; from the thickness along the blade where the file gives none."""
        inboard = placed[-1][0] if placed else 0.0
        if entry.has("spanwise_position"):
            position = float(entry.number("spanwise_position", low=0.0, high=1.0))
        else:
            grid, along = shape.curve("rthick")
            reached = np.flatnonzero((along <= thickness + 1e-9) & (grid >= inboard))
            if len(reached) == 0:
                raise entry.error(
                    f"the blade is nowhere as thin as this airfoil ({thickness:g})",
                    "give its spanwise_position",
                )
            i = int(reached[0])
            position = float(
                np.interp(-thickness, -along[max(i - 1, 0) : i + 1], grid[max(i - 1, 0) : i + 1])
            )
        if placed and position <= inboard:
            raise entry.error(
                f"stands at {position:g}, not outboard of the airfoil before it ({inboard:g})"
            )
        return position

    def blade_structure(self, blade: Block, shape: BladeShape) -> SectionProperties:
        block = blade.block("structure", "elastic_properties")
        span, stiffness, inertia, damping = elastic.read_sections(block)
        beamdyn = elastic.edge_is_about_x(span, stiffness)
        if beamdyn != elastic.mass_center_is_along_y(span, inertia):
            self.notes.append(
                "blade sections: the bending stiffness and the mass centre disagree on which axis "
                "lies along the chord; the stiffness was followed"
            )
        if not beamdyn:
            stiffness, inertia = elastic.exchanged(stiffness), elastic.exchanged(inertia)
            self.notes.append(
                "blade sections: K44 is the flapwise stiffness, so x lies along the chord as in "
                "windIO's text; x and y were exchanged to BeamDyn's axes"
            )
        twist = np.interp(span, shape.span, shape.twist)
        ratio = self.companion.properties["blade"].get("damping_ratio")
        return SectionProperties(span, stiffness, inertia, twist, damping, ratio)

    # hub, nacelle, drivetrain, tower -----------------------------------------

    def hub(self) -> Hub:
        block = self.components.block("hub")
        mass, location, inertia = rigid_body(block)
        return Hub(
            radius=block.number("diameter", low=0.0) / 2.0,
            cone=block.number("cone_angle", low=-30.0, high=30.0) * DEG,
            mass=mass,
            inertia=inertia[0],
            center_of_mass=location[0],
            **self.companion.properties["hub"],
        )

    def nacelle(self) -> Nacelle:
        """The nacelle; windIO measures the overhang level, the model along the shaft."""
        drivetrain = self.components.block("drivetrain")
        outer = drivetrain.block("outer_shape")
        tilt = outer.number("uptilt", low=-20.0, high=20.0) * DEG
        level = outer.number("overhang", low=0.0)
        mass, location, inertia = rigid_body(drivetrain)
        x, y, z = location
        return Nacelle(
            overhang=float(level / np.cos(tilt)),
            shaft_height=float(outer.number("distance_tt_hub", low=0.0) - level * np.tan(tilt)),
            tilt=tilt,
            mass=mass,
            center_of_mass=(x, y, z),
            yaw_inertia=inertia[2] + mass * (x * x + y * y),
            yaw_bearing_mass=rigid_body(self.components.optional("yaw"))[0],
            **self.companion.properties["nacelle"],
        )

    def drivetrain(self) -> Drivetrain:
        block = self.components.block("drivetrain")
        gearbox, generator = block.optional("gearbox"), block.optional("generator")
        gear_ratio = gearbox.number("gear_ratio", 1.0, 1.0)
        return Drivetrain(
            gear_ratio=gear_ratio,
            gearbox_efficiency=gearbox.number("efficiency", 1.0, 0.0, 1.0),
            generator_efficiency=self.generator_efficiency(generator),
            generator_inertia=rigid_body(generator)[2][0],
            **self.companion.properties["drivetrain"],
        )

    def generator_efficiency(self, generator: Block) -> float:
        """The efficiency at the highest speed of the table."""
        if not generator.has("rpm_efficiency"):
            return 1.0
        table = generator.block("rpm_efficiency")
        efficiency = table.array("values", len(table.array("grid")), low=0.0)
        if efficiency.max() > 1.0:
            raise table.error(f"efficiency of {efficiency.max():g}", "1 is the most", "values")
        return float(efficiency[-1])

    def tower(self) -> Tower:
        block = self.components.block("tower")
        span, axis = reference_axis(block.block("reference_axis"))
        outer = block.block("outer_shape")
        diameter = outer.curve("outer_diameter", low=0.0)
        drag = outer.curve("cd", low=0.0)
        full = merged_grid(span, diameter[0], drag[0])
        structure, masses = self.tower_structure(block, span, axis)
        return Tower(
            axis_span=full,
            axis=np.stack([np.interp(full, span, axis[:, i]) for i in range(3)], axis=1),
            diameter=np.interp(full, *diameter),
            drag_coefficient=np.interp(full, *drag),
            structure=structure,
            extra_masses=masses,
        )

    def tower_structure(
        self, tower: Block, axis_span: Array, axis: Array
    ) -> tuple[SectionProperties | None, tuple[tuple[float, float], ...]]:
        if not tower.optional("structure").has("elastic_properties"):
            return None, ()
        block = tower.block("structure", "elastic_properties")
        span, stiffness, inertia, damping = elastic.read_sections(block)
        ratio = self.companion.properties["tower"].get("damping_ratio")
        masses: tuple[tuple[float, float], ...] = ()
        if block.has("point_mass"):
            points = block.block("point_mass")
            grid = points.array("grid", low=0.0)
            heights = np.interp(grid, axis_span, axis[:, 2])
            masses = tuple(zip(heights, points.array("mass", len(grid), 0.0), strict=True))
        zero = np.zeros_like(span)
        return SectionProperties(span, stiffness, inertia, zero, damping, ratio), masses


def reference_axis(block: Block) -> tuple[Array, Array]:
    """Fractions (n,) and points (n,3) m of a reference axis."""
    curves = [block.curve(key) for key in ("x", "y", "z")]
    span = merged_grid(*(grid for grid, _ in curves))
    axis = np.stack([np.interp(span, *curve) for curve in curves], axis=1)
    if (np.diff(axis[:, 2]) <= 0.0).any():
        raise block.error("must rise all along", "z goes from the root or base outwards", "z")
    return span, axis


def rigid_body(part: Block) -> tuple[float, list[float], list[float]]:
    """Mass kg, mass centre (3,) m and inertia (6,) kg m2 about it; zero where absent."""
    if not part.has("elastic_properties"):
        return 0.0, [0.0] * 3, [0.0] * 6
    body = part.block("elastic_properties")
    location, inertia = body.array("location", 3), body.array("inertia", 6)
    return body.number("mass", low=0.0), location.tolist(), inertia.tolist()


def blend_weights(entry: Block) -> dict[str, float]:
    """Weight per polar configuration of an airfoil; empty where the file names none."""
    if not entry.has("configuration"):
        return {}
    names = entry.value("configuration")
    if not isinstance(names, list) or not names or not all(isinstance(n, str) for n in names):
        raise entry.error("expected a list of names", "", "configuration")
    default = len(names) == 1 and not entry.has("weight")
    weights = np.ones(1) if default else entry.array("weight", len(names), 0.0)
    if abs(weights.sum() - 1.0) > 1e-6:
        raise entry.error(f"the weights add up to {weights.sum():g} instead of 1", "", "weight")
    return {n: float(w) for n, w in zip(names, weights, strict=True) if w > 0.0}


def blend_text(weights: Mapping[str, float]) -> str:
    return " + ".join(f"{weight:g} {name}" for name, weight in weights.items())
