"""What one simulation is: the blocks of a case file, with units in their names."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    FiniteFloat,
    NonNegativeFloat,
    PositiveFloat,
    Tag,
    field_validator,
    model_validator,
)

from galerna.aero.bem.options import BemOptions
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.control.options import BaselineOptions, Control
from galerna.errors import did_you_mean
from galerna.hydro.platform_options import PlatformOptions
from galerna.hydro.sea_options import SeaOptions
from galerna.inflow.options import InflowOptions
from galerna.structure.options import StructureOptions
from galerna.units import AIR_DENSITY

DEFAULT_INTERVAL = 0.1  #: s
Fraction = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]


class Block(BaseModel):
    """A block of a case: it cannot be changed, and refuses keys it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)


class Series(Block):
    """A quantity over time: straight between its points, constant before and after them."""

    time_s: tuple[FiniteFloat, ...] = Field(min_length=1, description="Times, rising.")
    values: tuple[FiniteFloat, ...] = Field(min_length=1, description="One value for every time.")

    @field_validator("time_s")
    @classmethod
    def _rises(cls, time: tuple[float, ...]) -> tuple[float, ...]:
        for i, (before, after) in enumerate(pairwise(time)):
            if after <= before:
                raise ValueError(f"times must rise, found {after:g} after {before:g} at [{i + 1}]")
        return time

    @model_validator(mode="after")
    def _matches(self) -> Self:
        if len(self.time_s) != len(self.values):
            raise ValueError(f"{len(self.time_s)} times for {len(self.values)} values")
        return self


def _form(value: Any) -> str:
    if isinstance(value, dict | Series):
        return "series"
    return "blades" if isinstance(value, list | tuple) else "number"


Number = Annotated[FiniteFloat, Tag("number")]
OverTime = Annotated[Number | Annotated[Series, Tag("series")], Discriminator(_form)]
PerBlade = Annotated[
    Number
    | Annotated[Series, Tag("series")]
    | Annotated[tuple[OverTime, ...], Field(min_length=1), Tag("blades")],
    Discriminator(_form),
]


class Harmonic(Block):
    """A swing about a mean: mean + amplitude sin(2 pi frequency t + phase)."""

    mean: FiniteFloat = Field(0.0, description="About which it swings.")
    amplitude: FiniteFloat = Field(description="How far it swings to either side.")
    frequency_hz: PositiveFloat = Field(description="Swings in a second.")
    phase_deg: FiniteFloat = Field(0.0, description="Where in the swing it is at time 0.")
    ramp_s: NonNegativeFloat = Field(
        0.0, description="Time from 0 on in which the amplitude grows from nothing, smoothly."
    )


def _smooth_form(value: Any) -> str:
    harmonic = isinstance(value, Harmonic) or (isinstance(value, dict) and "amplitude" in value)
    return "harmonic" if harmonic else _form(value)


SmoothOverTime = Annotated[
    Number | Annotated[Series, Tag("series")] | Annotated[Harmonic, Tag("harmonic")],
    Discriminator(_smooth_form),
]


def _model(value: Any) -> str:
    """Which aerodynamic model a block is for: blade-element momentum where it does not say."""
    if isinstance(value, dict):
        return str(value.get("model", "bem"))
    return str(getattr(value, "model", "bem"))


Aerodynamics = Annotated[
    Annotated[BemOptions, Tag("bem")] | Annotated[VortexLatticeOptions, Tag("vortex_lattice")],
    Discriminator(_model),
]


def _structure(value: Any) -> Any:
    """``flexible`` and ``rigid`` stand for a whole block."""
    whole = {"flexible": StructureOptions(), "rigid": StructureOptions.rigid()}
    if not isinstance(value, str):
        return value
    if value not in whole:
        hint = did_you_mean(value, whole)
        raise ValueError(f"expected 'flexible', 'rigid' or a block, found {value!r}; {hint}")
    return whole[value]


def _sea(value: Any) -> Any:
    """``still`` stands for a sea without waves and current."""
    if not isinstance(value, str):
        return value
    if value != "still":
        raise ValueError(f"expected 'still' or a block with waves and current, found {value!r}")
    return SeaOptions()


def _control(value: Any) -> Any:
    """A model's name stands for its block; a block without a model is the baseline's."""
    if isinstance(value, str):
        return {"model": value}
    if isinstance(value, dict) and "model" not in value:
        return {"model": "baseline", **value}
    return value


def _or_words(*words: str) -> Callable[[dict[str, Any]], None]:
    """Lets the schema of a block take words that stand for it."""
    return lambda schema: schema["anyOf"].insert(0, {"enum": list(words)})


class BaseMotion(Block):
    """How the foot of the tower, or the platform's reference point, is made to move.

    A number stands for an offset that stays, a series for a smooth curve (a cubic spline)
    through its points. Turns are about the moved point, z first and x last.
    """

    surge_m: SmoothOverTime = Field(0.0, description="Along x.")
    sway_m: SmoothOverTime = Field(0.0, description="Along y.")
    heave_m: SmoothOverTime = Field(0.0, description="Along z.")
    roll_deg: SmoothOverTime = Field(0.0, description="About x, the last of the three turns.")
    pitch_deg: SmoothOverTime = Field(0.0, description="About y.")
    yaw_deg: SmoothOverTime = Field(0.0, description="About z, the first of the three turns.")


class Operation(Block):
    """How the machine is run. Every angle and speed is a number, or a series over time.

    With a controller this is how the machine starts.
    """

    operating_point: Literal["given", "steady"] = Field(
        "given",
        description="'steady' takes the rotor speed and the pitch that are not given from the "
        "turbine's own operating curve at the mean wind speed.",
    )
    rotor_speed_rpm: OverTime | None = Field(
        None, description="Rotor speed, positive clockwise looking downwind."
    )
    pitch_deg: PerBlade | None = Field(
        None, description="Blade pitch towards feather: one for all blades, or a list of one each."
    )
    yaw_deg: OverTime = Field(
        0.0, description="Nacelle yaw, positive about the vertical (up); 0 faces wind along +x."
    )
    azimuth_deg: FiniteFloat = Field(0.0, description="Azimuth of blade 1 at time 0; 0 is up.")

    @model_validator(mode="after")
    def _is_determined(self) -> Self:
        if self.operating_point == "given" and self.rotor_speed_rpm is None:
            raise ValueError("give rotor_speed_rpm, or operating_point: steady")
        return self


class Outputs(Block):
    """What is recorded, and when."""

    interval_s: PositiveFloat | None = Field(
        None,
        description="Time between records, a whole number of time steps; about 0.1 s by default.",
    )
    start_s: NonNegativeFloat = Field(
        0.0, description="Records before this time are left out: the start-up transient."
    )
    channels: tuple[str, ...] = Field(
        ("*",),
        min_length=1,
        description="Channel names, or patterns with * and ?; OpenFAST's names will do. "
        "`galerna channels CASE` lists them.",
    )
    blade_stations: tuple[Fraction, ...] = Field(
        (0.25, 0.5, 0.75),
        min_length=1,
        description="Where loads and displacements of flexible blades are shown, as fractions of "
        "the blade's axis.",
    )
    tower_stations: tuple[Fraction, ...] = Field(
        (0.5,),
        min_length=1,
        description="Where loads and displacements of a flexible tower are shown, as fractions "
        "of its axis.",
    )
    energy: bool = Field(
        False,
        description="Keep the account of the wind's work in a machine that moves: the channels "
        "`energy_*`. It makes a step slower by a fifth.",
    )


class Case(Block):
    """One simulation: the turbine, the wind it meets, how it is run and what is recorded."""

    version: Literal[1] = Field(
        alias="galerna", description="Version of the case format that the file was written for."
    )
    name: str = Field("", description="A short name; by default that of the file.")
    description: str = Field("", description="What the case is for.")
    turbine: str = Field(
        min_length=1,
        description="A built-in turbine (galerna turbines), a windIO file or an OpenFAST deck.",
    )
    duration_s: PositiveFloat = Field(description="Simulated time.")
    time_step_s: PositiveFloat = Field(0.02, description="Time step.")
    air_density_kg_m3: PositiveFloat = Field(AIR_DENSITY, description="Density of the air.")
    seed: int = Field(1, ge=0, description="Seed of everything random: same case, same bits.")
    inflow: InflowOptions = Field(description="The wind.")
    aerodynamics: Aerodynamics = Field(
        BemOptions(), description="The aerodynamic model of the rotor; `model` says which."
    )
    tower_and_nacelle_drag: bool = Field(True, description="Drag of the tower and the nacelle.")
    structure: Annotated[StructureOptions | None, BeforeValidator(_structure)] = Field(
        None,
        description="How the machine moves: `flexible`, `rigid`, or a block that says it of each "
        "part. Left out, nothing bends, and without a controller all motion is prescribed.",
        json_schema_extra=_or_words("flexible", "rigid"),
    )
    base_motion: BaseMotion | None = Field(
        None, description="Prescribed motion of the tower's foot or of the platform."
    )
    sea: Annotated[SeaOptions | None, BeforeValidator(_sea)] = Field(
        None,
        description="The water a platform floats in, with waves and current; `still` for none of "
        "these. Left out, a platform stands still, or moves as `base_motion` says.",
        json_schema_extra=_or_words("still"),
    )
    platform: PlatformOptions | None = Field(
        None, description="How the platform floats in the sea, and how it starts."
    )
    control: Annotated[Control | None, BeforeValidator(_control)] = Field(
        None,
        description="The controller: `baseline`, `discon`, `python`, `external`, or a block. "
        "Left out, `operation` prescribes rotor speed, pitch and yaw.",
        json_schema_extra=_or_words("baseline", "discon", "python", "external"),
    )
    operation: Operation | None = Field(
        None,
        description="How the machine is run; with a controller, how it starts: by default at the "
        "controller's operating point in the mean wind.",
    )
    outputs: Outputs = Field(Outputs(), description="What is recorded.")

    @model_validator(mode="after")
    def _is_run(self) -> Self:
        if self.operation is None and self.control is None:
            raise ValueError("give control, such as `control: baseline`, or operation")
        if self.platform is not None and self.sea is None:
            raise ValueError("platform floats in nothing: give a sea, such as `sea: still`")
        return self

    @property
    def moves(self) -> bool:
        """Whether loads move the machine; otherwise all of its motion is prescribed."""
        given = (self.structure, self.control, self.base_motion, self.sea)
        return any(block is not None for block in given)

    @property
    def start(self) -> Operation:
        """How the machine is run, or starts where a controller runs it."""
        if self.operation is not None:
            return self.operation
        if isinstance(self.control, BaselineOptions) and self.control.at_rest:
            return Operation(rotor_speed_rpm=0.0, pitch_deg=self.control.feather_deg)
        return Operation(operating_point="steady")

    @property
    def record_every(self) -> int:
        """Steps from one record to the next; a run has one record at least."""
        interval = self.outputs.interval_s or min(DEFAULT_INTERVAL, self.duration_s)
        return max(int(interval / self.time_step_s + 1e-6), 1)
