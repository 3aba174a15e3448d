"""What a user can choose of the vortex lattice; the defaults need not be touched."""

from __future__ import annotations

import re
from typing import Annotated, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    NonNegativeFloat,
    PositiveFloat,
    field_validator,
    model_validator,
)

Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
Point = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
Edges = Annotated[tuple[Fraction, ...], Field(min_length=2)]


class _Block(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class PlaneOptions(_Block):
    """A rectangle in the flow, of which the velocity is written."""

    name: str = Field(description="Of its files: letters, digits, - and _.")
    corner_m: Point = Field(description="One corner: x, y and z.")
    first_side_m: Point = Field(description="From the corner along one side, to its end.")
    second_side_m: Point = Field(description="From the corner along the other side, to its end.")
    points: tuple[Annotated[int, Field(ge=2, le=2000)], Annotated[int, Field(ge=2, le=2000)]] = (
        Field((41, 41), description="Points along the first and the second side.")
    )

    @field_validator("name")
    @classmethod
    def _names_a_file(cls, name: str) -> str:
        if not re.fullmatch(r"[A-Za-z0-9_-]+", name):
            raise ValueError(f"expected letters, digits, - and _, found {name!r}")
        return name


class FlowOutput(_Block):
    """Pictures of the flow for ParaView and its like, in a folder beside the result."""

    interval_s: PositiveFloat = Field(description="Time between two of them.")
    start_s: NonNegativeFloat = Field(0.0, description="None before this time.")
    wake: bool = Field(True, description="The blades' lattices and their wakes.")
    planes: tuple[PlaneOptions, ...] = Field((), description="Rectangles with the velocity.")

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        names = [plane.name for plane in self.planes]
        twice = [name for name in names if names.count(name) > 1]
        if twice:
            raise ValueError(f"two planes have the name {twice[0]!r}")
        if "wake" in names:
            raise ValueError("no plane may have the name 'wake': its files have it")
        return self


class VortexLatticeOptions(_Block):
    """Settings of the unsteady vortex lattice; the defaults need not be touched."""

    # The schema tells the models apart by this key, so it cannot be left out there.
    model_config = ConfigDict(
        frozen=True, extra="forbid", json_schema_extra={"required": ["model"]}
    )

    model: Literal["vortex_lattice"] = Field(
        default="vortex_lattice", description="The unsteady vortex lattice."
    )
    spanwise_panels: Annotated[int, Field(ge=2, le=500)] | Edges = Field(
        default=20,
        description="Panels along a blade, or their edges as rising fractions of its axis that "
        "end at 1.",
    )
    chordwise_panels: Annotated[int, Field(ge=1, le=500)] | Edges = Field(
        default=8, description="Panels along the chord, or their edges, rising from 0 to 1."
    )
    spanwise_spacing: Literal["half_sine", "uniform", "cosine"] = Field(
        default="half_sine",
        description="Where a number of panels stands: ever smaller to the tip, equal, or smaller "
        "to both ends.",
    )
    chordwise_spacing: Literal["uniform", "cosine", "half_sine"] = Field(
        default="uniform", description="The same along the chord."
    )
    camber: Literal["coordinates", "polar", "none"] = Field(
        default="coordinates",
        description="Camber line of the lattice: of the airfoils' outlines, the parabola with "
        "the zero-lift angle of their polars, or a flat plate. An airfoil without an outline "
        "takes that of its polar.",
    )
    root_span: Annotated[float, Field(ge=0.0, lt=1.0)] | None = Field(
        default=None,
        description="Fraction of the blade's axis where the lattice begins; where the airfoils "
        "begin to lift if not given. Inboard of it the polars act alone.",
    )
    wake: Literal["free", "prescribed"] = Field(
        default="free",
        description="Whether the wake moves with the whole velocity, or with the wind alone.",
    )
    wake_step_deg: Annotated[float, Field(gt=0.0, le=60.0)] = Field(
        default=5.0,
        description="Turn of the rotor, at its mean speed, in which one row of wake panels is "
        "shed; rounded to whole time steps.",
    )
    wake_step_s: PositiveFloat | None = Field(
        default=None, description="The time of it instead: for a parked rotor, for instance."
    )
    wake_length_diameters: PositiveFloat = Field(
        default=3.0, description="Length of the wake in rotor diameters, at the mean wind."
    )
    wake_revolutions: PositiveFloat | None = Field(
        default=None, description="Length of the wake in turns of the rotor instead."
    )
    wake_near_deg: NonNegativeFloat = Field(
        default=120.0,
        description="Turn of the rotor behind the blade within which all wake panels are as "
        "short as the first.",
    )
    wake_growth: Annotated[float, Field(ge=1.0, le=2.0)] = Field(
        default=1.1,
        description="Length of a wake panel over that of the one upstream, behind the near "
        "wake; 1 keeps all of them equal.",
    )
    wake_widest_deg: Annotated[float, Field(gt=0.0, le=60.0)] = Field(
        default=20.0, description="Turn of the rotor that the longest wake panel spans."
    )
    wake_scheme: Literal["adams_bashforth", "heun", "euler"] = Field(
        default="adams_bashforth",
        description="How a free wake is moved: of second order with one evaluation a step, or "
        "with two, or of first order.",
    )
    wake_multirate: bool = Field(
        default=True,
        description="Whether rows behind wide wake panels get a new induced velocity only when the "
        "fluid has crossed these; with the scheme of Adams and Bashforth.",
    )
    wake_turbulence: bool = Field(
        default=True, description="Whether turbulence moves the wake too, or its mean wind alone."
    )
    core_radius: NonNegativeFloat = Field(
        default=0.1,
        description="Radius of a vortex core when it is shed, over the mean chord of the lattice.",
    )
    core_growth: NonNegativeFloat = Field(
        default=1e-4,
        description="Squire's turbulent growth of the cores with age, a_1 of delta = 1 + a_1 "
        "Gamma / nu (Bhagwat and Leishman 2002); 0 is laminar.",
    )
    tree_error: Annotated[float, Field(ge=0.0, le=0.1)] = Field(
        default=1e-3,
        description="Error that the fast summation may make in the induced velocity, relative to "
        "its root mean square; it is used where it saves time. 0 sums directly.",
    )
    precision: Literal["single", "double"] = Field(
        default="single",
        description="Of velocities that wakes induce on wakes; the blades have double precision.",
    )
    drag: bool = Field(
        default=True,
        description="Drag from the polars by the sections' lift; off is a rotor without friction.",
    )
    decambering: bool = Field(
        default=False,
        description="Bring the lift of separated sections to their polars.",
    )
    quasi_steady: bool = Field(
        default=False,
        description="At every time the flow of a wake that has always had its present "
        "circulation: no shed vortices, no added mass.",
    )
    start: Literal["steady", "impulsive"] = Field(
        default="steady",
        description="Begin with the wake of the steady rotor, or without a wake.",
    )
    ground: bool = Field(
        default=False, description="The ground or the sea at z = 0, which no flow crosses."
    )
    tower_influence: bool = Field(
        default=True, description="Tower dam effect and shadow on the wind that the blades meet."
    )
    probes_m: tuple[Point, ...] = Field(
        default=(),
        description="Points x, y, z where the velocity of wind and vortices is recorded.",
    )
    flow_output: FlowOutput | None = Field(
        default=None, description="Wake and velocity in planes as VTK files."
    )

    @model_validator(mode="after")
    def _one_length(self) -> Self:
        if {"wake_revolutions", "wake_length_diameters"} <= self.model_fields_set:
            raise ValueError("give wake_revolutions or wake_length_diameters, not both")
        return self
