"""An OpenFAST deck, from its .fst file down, made into a Turbine in SI and radians.

Signs turned on the way: ElastoDyn's overhang, shaft tilt and precone are negative for
an upwind rotor, galerna's are positive. The axes of AeroDyn's and BeamDyn's blades
(x towards the suction side, y towards the trailing edge, twist about -z) are galerna's.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from galerna.turbine.geometry import axis_tangents, section_rotations
from galerna.turbine.model import (
    Airfoil,
    Array,
    Blade,
    BladeShape,
    Nacelle,
    Platform,
    SectionProperties,
    Tower,
    Turbine,
)
from galerna.turbine.openfast import aerodyn, elastodyn, servodyn
from galerna.turbine.openfast.beamdyn import BeamBlade, check_axis, read_beamdyn
from galerna.turbine.openfast.deck import Deck

_BEAMDYN = 2  # CompElast
_LENGTHS_AGREE = 0.01  # of the blade's length
_MASSES_AGREE = 0.01
_PLATFORM_MOTIONS = ("Sg", "Sw", "Hv", "R", "P", "Y")
_NO_PREBEND = 1e-3  # of the blade's length


def read(path: str | Path) -> Turbine:
    """The turbine of an OpenFAST deck (.fst); ``notes`` say what was decided or left out.

    Raises InputError with file, line and keyword.
    """
    return _Reader(Deck.open(Path(path))).turbine()


class _Reader:
    """Follows one deck's files; collects what it decides in ``notes``."""

    def __init__(self, deck: Deck) -> None:
        self.deck = deck
        self.notes: list[str] = []
        self.sources: dict[str, str] = {}
        self.elastodyn = deck.file("EDFile")
        self.aerodyn = self._aerodyn()
        self.servodyn = self._optional("CompServo", "ServoFile")
        for block, file in (
            ("airfoils", self.aerodyn),
            ("hub", self.elastodyn),
            ("nacelle", self.elastodyn),
            ("drivetrain", self.elastodyn),
            ("control", self.servodyn),
        ):
            if file is not None:
                self._credit(block, file)

    def turbine(self) -> Turbine:
        airfoils, blade = self.blade()
        drag_area = aerodyn.read_nacelle_drag(self.aerodyn)
        nacelle = elastodyn.read_nacelle(self.elastodyn, self.servodyn, drag_area)
        drivetrain = elastodyn.read_drivetrain(self.elastodyn, self.servodyn)
        tower = self.tower()
        return Turbine(
            name=self.deck.path.stem,
            number_of_blades=self.elastodyn.integer("NumBl", low=1, high=10),
            blade=blade,
            airfoils=airfoils,
            hub=elastodyn.read_hub(self.elastodyn),
            nacelle=nacelle,
            drivetrain=drivetrain,
            tower=tower,
            control=servodyn.read_control(self.servodyn, drivetrain.gear_ratio, self.notes),
            hub_height=_hub_height(tower, nacelle),
            platform=self.platform(),
            sources=self.sources,
            description=self.deck.lines[1].strip() if len(self.deck.lines) > 1 else "",
            notes=tuple(self.notes),
        )

    def _credit(self, block: str, file: Deck) -> Deck:
        """Name the file that a block comes from."""
        self.sources[block] = f"OpenFAST deck {self.deck.path.name}, {file.path.name}"
        return file

    # blade ----------------------------------------------------------------------

    def blade(self) -> tuple[dict[str, Airfoil], Blade]:
        airfoils, names = aerodyn.read_airfoils(self.aerodyn, self.notes)
        blade_file = self._credit("blade.outer_shape", self.aerodyn.file("ADBlFile(1)"))
        nodes = aerodyn.read_blade_nodes(blade_file, names)
        check_axis(blade_file, "BlSpn", nodes.centers)
        used = {name: airfoils[name] for name in nodes.airfoils}
        for deck, key in ((self.aerodyn, "ADBlFile"), (self.elastodyn, "BldFile")):
            self._warn_of_different_blades(deck, key)
        beam = self._beamdyn()
        if beam is None:
            return used, self._modal_blade(nodes, used)
        length, wanted = beam.axis[-1, 2], nodes.centers[-1, 2]
        if abs(length - wanted) > _LENGTHS_AGREE * wanted:
            self.notes.append(
                f"blade: BeamDyn's blade is {length:g} m long, AeroDyn's {wanted:g} m; "
                "AeroDyn's nodes were placed by their fraction of its length"
            )
        nodes = replace(nodes, centers=nodes.centers * [1.0, 1.0, length / wanted])
        shape = _shape(nodes, used, beam.span, beam.axis)
        return used, Blade(beam.span, beam.axis, shape, beam.structure)

    def _modal_blade(self, nodes: aerodyn.BladeNodes, airfoils: dict[str, Airfoil]) -> Blade:
        """Without BeamDyn: ElastoDyn's pitch axis, with the prebend of AeroDyn's nodes."""
        axis = _prebent_pitch_axis(nodes)
        steps = np.linalg.norm(np.diff(axis, axis=0), axis=1)
        span = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
        if np.abs(axis[:, 0]).max() > _NO_PREBEND * steps.sum():
            self.notes.append(
                "blade: ElastoDyn's straight blade was laid along the prebend of AeroDyn's nodes"
            )
        return Blade(span, axis, _shape(nodes, airfoils, span, axis), self._modal_sections())

    def _modal_sections(self) -> SectionProperties:
        length = elastodyn.blade_length(self.elastodyn)
        file = self._credit("blade.structure", self.elastodyn.file("BldFile(1)"))
        return elastodyn.read_blade_structure(file, length, self.notes)

    def _beamdyn(self) -> BeamBlade | None:
        """The BeamDyn blade if the deck names one that is there, whether it is in use or not."""
        if not self.deck.names_file("BDBldFile(1)"):
            return None
        in_use = self.deck.integer("CompElast", 1) == _BEAMDYN
        name = self.deck.text("BDBldFile(1)")
        if not in_use and not self.deck.beside(name).is_file():
            self.notes.append(f"blade: the deck names {name}, which is not there, and does not use")
            return None
        file = self.deck.file("BDBldFile(1)")
        sections = self._credit("blade.structure", file.file("BldFile"))
        beam = read_beamdyn(file, sections)
        if not in_use:
            self.notes.append("blade: sections from the deck's BeamDyn file, which it does not use")
            self._compare_masses(beam)
        return beam

    def _compare_masses(self, beam: BeamBlade) -> None:
        """Say so where ElastoDyn's blade, which the deck uses, has another mass than BeamDyn's."""
        modal = elastodyn.read_blade_structure(self.elastodyn.file("BldFile(1)"), 1.0, [])
        length = elastodyn.blade_length(self.elastodyn)
        masses = [float(np.trapezoid(s.mass, s.span)) * length for s in (beam.structure, modal)]
        if abs(masses[0] - masses[1]) > _MASSES_AGREE * masses[1]:
            self.notes.append(
                f"blade: BeamDyn's sections, taken here, weigh {masses[0]:.0f} kg, "
                f"ElastoDyn's {masses[1]:.0f} kg"
            )

    def _warn_of_different_blades(self, deck: Deck, key: str) -> None:
        names = {deck.text(f"{key}({k})") for k in (1, 2, 3) if deck.has(f"{key}({k})")}
        if len(names) > 1:
            self.notes.append(f"blade: the blades differ in {key}; all are taken as blade 1")

    # tower and platform -----------------------------------------------------------

    def tower(self) -> Tower:
        ed = self.elastodyn
        base, top = ed.number("TowerBsHt", 0.0), ed.number("TowerHt")
        if top <= base:
            line = ed.entry("TowerHt").line
            raise ed.error("TowerHt must be larger than TowerBsHt", "", line)
        span, diameter, drag = aerodyn.read_tower_shape(self.aerodyn, base, top)
        if not diameter.any():
            self.notes.append("tower: AeroDyn gives no diameters; it does not disturb the wind")
        axis = np.zeros((len(span), 3))
        axis[:, 2] = base + span * (top - base)
        file = self._credit("tower", ed.file("TwrFile"))
        structure = elastodyn.read_tower_structure(file, top - base, self.notes)
        return Tower(span, axis, diameter, drag, structure)

    def platform(self) -> Platform | None:
        """A floating platform; that of a fixed substructure is left out."""
        ed = self.elastodyn
        if self.deck.integer("CompSub", 0) > 0:
            self.notes.append("substructure: SubDyn is not read; the tower is clamped at its base")
            return None
        if not any(ed.flag(f"Ptfm{motion}DOF", False) for motion in _PLATFORM_MOTIONS):
            return None
        hydro = self._optional("CompHydro", "HydroFile")
        volume = hydro.number("PtfmVol0", 0.0, 0.0) if hydro else 0.0
        depth = 0.0
        for deck in (self.deck, hydro):
            if deck is not None and depth == 0.0:
                depth = deck.number("WtrDpth", 0.0, 0.0)
        self._credit("platform", ed)
        return elastodyn.read_platform(ed, depth, volume)

    # files ------------------------------------------------------------------------

    def _aerodyn(self) -> Deck:
        """The AeroDyn file; a deck without aerodynamics has no airfoils to read."""
        if not self.deck.names_file("AeroFile"):
            line = self.deck.entry("AeroFile").line
            raise self.deck.error("the deck has no AeroDyn file", "galerna needs airfoils", line)
        file = self.deck.file("AeroFile")
        if not file.has("ADBlFile(1)"):
            raise file.error(
                "is not an AeroDyn 15 (or later) file: it has no ADBlFile(1)",
                "convert an AeroDyn 14 deck with openfast_toolbox",
            )
        return file

    def _optional(self, switch: str, keyword: str) -> Deck | None:
        """The file of a module that is switched on."""
        if self.deck.integer(switch, 0) == 0 or not self.deck.names_file(keyword):
            return None
        return self.deck.file(keyword)


def _prebent_pitch_axis(nodes: aerodyn.BladeNodes) -> Array:
    """Axis (n,3) m without sweep that the aerodynamic centres lie beside, along their chords.

    A centre at a distance a behind the axis stands at (prebend + a sin(twist), a cos(twist)).
    """
    behind = nodes.centers[:, 1] / np.cos(nodes.twist)
    axis = nodes.centers.copy()
    axis[:, 0] -= behind * np.sin(nodes.twist)
    axis[:, 1] = 0.0
    axis[:, 0] -= axis[0, 0]
    return axis


def _shape(
    nodes: aerodyn.BladeNodes, airfoils: dict[str, Airfoil], axis_span: Array, axis: Array
) -> BladeShape:
    """Outer shape about a reference axis from aerodynamic centres beside it."""
    span = np.interp(nodes.centers[:, 2], axis[:, 2], axis_span)
    beside = nodes.centers - np.stack(
        [np.interp(span, axis_span, axis[:, i]) for i in range(3)], axis=1
    )
    rotation = section_rotations(axis_tangents(axis_span, axis, span), nodes.twist)
    offset = np.einsum("nij,ni->nj", rotation, beside)
    center = np.array([airfoils[name].aerodynamic_center for name in nodes.airfoils])
    return BladeShape(
        span=span,
        chord=nodes.chord,
        twist=nodes.twist,
        relative_thickness=np.array([airfoils[n].relative_thickness for n in nodes.airfoils]),
        leading_edge_offset=center * nodes.chord - offset[:, 1],
        normal_offset=offset[:, 0],
        airfoil_span=span,
        airfoil_names=nodes.airfoils,
    )


def _hub_height(tower: Tower, nacelle: Nacelle) -> float:
    rise = nacelle.shaft_height + nacelle.overhang * np.sin(nacelle.tilt)
    return float(tower.axis[-1, 2] + rise)
