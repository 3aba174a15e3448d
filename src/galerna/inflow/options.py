"""The ``inflow:`` block of a case: every field with its unit, checked before anything runs."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

from galerna.inflow.iec import TurbineClass, TurbulenceClass

Positive = Annotated[FiniteFloat, Field(gt=0.0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0.0)]
Angle = Annotated[FiniteFloat, Field(ge=-360.0, le=360.0)]
Fraction = Annotated[FiniteFloat, Field(gt=0.0, le=1.0)]
Count = Annotated[int, Field(ge=2, le=100_000)]
Sign = Literal["positive", "negative"]

LEAST_EXPONENT, LARGEST_EXPONENT = -1.0, 2.0  #: of a power law over the height


class Block(BaseModel):
    """A part of the case: immutable, and no key that it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class WindOverTime(Block):
    """The wind at hub height over time, straight between the times and held beyond them."""

    time_s: tuple[FiniteFloat, ...] = Field(min_length=2, description="Ascending times.")
    wind_speed_m_s: tuple[NotNegative, ...] = Field(description="Wind speed at each time.")
    direction_deg: tuple[FiniteFloat, ...] | None = Field(
        None, description="Wind direction at each time, positive about the vertical upwards."
    )
    upflow_deg: tuple[FiniteFloat, ...] | None = Field(
        None, description="Angle above the horizontal at each time."
    )

    @model_validator(mode="after")
    def _same_length(self) -> Self:
        n = len(self.time_s)
        for name in ("wind_speed_m_s", "direction_deg", "upflow_deg"):
            values = getattr(self, name)
            if values is not None and len(values) != n:
                raise ValueError(f"{name} has {len(values)} values for {n} times in time_s")
        if any(b <= a for a, b in zip(self.time_s, self.time_s[1:], strict=False)):
            raise ValueError("time_s must ascend")
        return self


class WindFile(Block):
    """OpenFAST's uniform wind over time."""

    path: str = Field(description="File .wnd or .hh, relative to the case file.")
    reference_length_m: Positive | None = Field(
        None, description="Length of the file's linear shears; the rotor diameter if not given."
    )


class NoShear(Block):
    """The same mean speed at every height."""

    kind: Literal["none"]


class PowerLaw(Block):
    """Mean speed with a power of the height."""

    kind: Literal["power_law"]
    exponent: Annotated[FiniteFloat, Field(ge=LEAST_EXPONENT, le=LARGEST_EXPONENT)] = Field(
        0.2, description="Exponent; IEC 61400-1 takes 0.2 for normal wind on land."
    )


class Logarithmic(Block):
    """Mean speed with the logarithm of the height."""

    kind: Literal["logarithmic"]
    roughness_length_m: Positive = Field(description="Roughness length of the surface.")


class LinearShear(Block):
    """Mean speed on a straight line over the height."""

    kind: Literal["linear"]
    gradient_per_m: FiniteFloat = Field(
        description="Change of the speed per metre of height, over the speed at hub height."
    )


Shear = Annotated[NoShear | PowerLaw | Logarithmic | LinearShear, Field(discriminator="kind")]


class Gust(Block):
    """What the transient events of IEC 61400-1 share."""

    start_s: NotNegative = Field(description="Time at which the event begins.")


class Eog(Gust):
    """Extreme operating gust."""

    kind: Literal["EOG"]
    turbine_class: TurbineClass = Field("I", description="Wind turbine class.")
    turbulence_class: TurbulenceClass = Field("B", description="Turbulence class.")


class Edc(Gust):
    """Extreme direction change."""

    kind: Literal["EDC"]
    turbulence_class: TurbulenceClass = Field("B", description="Turbulence class.")
    sign: Sign = Field("positive", description="Sense of the turn about the vertical upwards.")


class Ecd(Gust):
    """Extreme coherent gust with direction change."""

    kind: Literal["ECD"]
    sign: Sign = Field("positive", description="Sense of the turn about the vertical upwards.")


class Ews(Gust):
    """Extreme wind shear."""

    kind: Literal["EWS"]
    turbulence_class: TurbulenceClass = Field("B", description="Turbulence class.")
    direction: Literal["vertical", "horizontal"] = Field("vertical", description="Of the shear.")
    sign: Sign = Field("positive", description="More wind above, or to the left, if positive.")


AnyGust = Annotated[Eog | Edc | Ecd | Ews, Field(discriminator="kind")]


class Turbulence(Block):
    """What every kind of turbulence shares."""

    margin_m: NotNegative | None = Field(
        None, description="Room around the rotor; a tenth of its radius (a quarter afloat)."
    )
    below_box: Literal["error", "hold"] = Field(
        "error", description="Below the lowest row: an error, or that row held down to the ground."
    )


class Generated(Turbulence):
    """What the generated boxes share: amount, seed and grid, each with a default that fits."""

    turbulence_intensity: Fraction | None = Field(
        None, description="Standard deviation of u over the mean wind speed at hub height."
    )
    turbulence_class: TurbulenceClass | None = Field(
        None, description="Amount of the normal turbulence model of IEC 61400-1 instead."
    )
    normalise: Literal["box", "theory", "sample"] = Field(
        "box",
        description="The amount is what a box of this size is expected to hold, that of the whole "
        "spectrum (a finite box then holds less), or that of this very sample.",
    )
    seed: int | None = Field(None, description="Seed; that of the case if not given.")
    points_across: Annotated[int, Field(ge=4, le=512)] = Field(
        32, description="Points over the width; the same spacing holds over the height."
    )
    time_step_s: Positive = Field(0.1, description="Time between two planes of the box.")
    points: tuple[Count, Count, Count] | None = Field(
        None, description="Points along, across and up, with spacing_m, instead of a fitting grid."
    )
    spacing_m: tuple[Positive, Positive, Positive] | None = Field(
        None, description="Spacing along, across and up, with points."
    )

    def amounts(self) -> dict[str, object]:
        """What may say how much turbulence there is; exactly one does."""
        return {
            "turbulence_intensity": self.turbulence_intensity,
            "turbulence_class": self.turbulence_class,
        }

    @model_validator(mode="after")
    def _one_amount_and_grid(self) -> Self:
        amounts = self.amounts()
        if sum(value is not None for value in amounts.values()) != 1:
            raise ValueError(f"give exactly one of {', '.join(amounts)}")
        if (self.points is None) != (self.spacing_m is None):
            raise ValueError("points and spacing_m go together")
        return self


class Mann(Generated):
    """Mann's sheared turbulence (1998)."""

    kind: Literal["mann"]
    length_scale_m: Positive | None = Field(
        None, description="Length scale L; 0.8 Lambda_1 of IEC 61400-1 if not given."
    )
    shear_parameter: NotNegative = Field(3.9, description="Gamma; 0 is isotropic.")
    alpha_epsilon: Positive | None = Field(
        None, description="alpha epsilon^(2/3) in m^(4/3)/s2, instead of an intensity or class."
    )

    def amounts(self) -> dict[str, object]:
        return {**super().amounts(), "alpha_epsilon": self.alpha_epsilon}


class Kaimal(Generated):
    """Kaimal spectra with the coherence of IEC 61400-1."""

    kind: Literal["kaimal"]
    coherent: Literal["u", "uvw"] = Field(
        "u", description="Components with the standard's coherence; it gives that of u alone."
    )


class TurbSimFile(Turbulence):
    """A TurbSim file (.bts)."""

    kind: Literal["file"]
    path: str = Field(description="File, relative to the case file.")
    mean: Literal["file", "case"] = Field(
        "file", description="Mean wind of the file, or its fluctuations about that of the case."
    )


class Hawc2Files(Turbulence):
    """Three HAWC2 files of fluctuations."""

    kind: Literal["hawc2"]
    paths: tuple[str, str, str] = Field(description="Files of u, v and w.")
    points: tuple[Count, Count, Count] = Field(description="Points along, across and up.")
    spacing_m: tuple[Positive, Positive, Positive] = Field(
        description="Spacing along, across and up."
    )
    first_row: Literal["left", "right"] = Field(
        "right",
        description="Side, looking downwind, of the first row across in the file: right as Mann's "
        "generators write it, left as InflowWind reads it.",
    )
    bottom_m: float | None = Field(
        None, description="Height of the lowest row; if not given, the box is centred on the hub."
    )
    turbulence_intensity: Fraction | None = Field(
        None, description="Scale the box so that the deviation of u is this times the mean speed."
    )


AnyTurbulence = Annotated[Mann | Kaimal | TurbSimFile | Hawc2Files, Field(discriminator="kind")]


class InflowOptions(Block):
    """The undisturbed wind: a mean over time and height, an event, and turbulence."""

    wind_speed_m_s: NotNegative | None = Field(
        None, description="Steady mean wind speed at hub height."
    )
    time_series: WindOverTime | None = Field(
        None, description="Mean wind at hub height over time, instead of a steady speed."
    )
    time_series_file: WindFile | None = Field(
        None, description="The same from a file of OpenFAST's uniform wind."
    )
    direction_deg: Angle = Field(
        0.0,
        description="Direction the wind blows to, positive about the vertical upwards, 0 along x; "
        "the yaw error is the nacelle's yaw minus this. Adds to that of a time series.",
    )
    upflow_deg: Annotated[FiniteFloat, Field(gt=-90.0, lt=90.0)] = Field(
        0.0, description="Angle of the wind above the horizontal. Adds to that of a time series."
    )
    veer_deg_per_m: FiniteFloat = Field(
        0.0, description="Change of the direction per metre above the hub."
    )
    shear: Shear = Field(NoShear(kind="none"), description="Mean speed over the height.")
    gust: AnyGust | None = Field(None, description="A transient event of IEC 61400-1.")
    turbulence: AnyTurbulence | None = Field(None, description="Turbulence on top of the mean.")

    @property
    def mean_in_file(self) -> bool:
        """Whether the turbulence file brings the mean wind along."""
        return isinstance(self.turbulence, TurbSimFile) and self.turbulence.mean == "file"

    @model_validator(mode="after")
    def _one_mean_wind(self) -> Self:
        sources = ("wind_speed_m_s", "time_series", "time_series_file")
        given = [name for name in sources if getattr(self, name) is not None]
        if self.mean_in_file:
            if given or not isinstance(self.shear, NoShear) or self.veer_deg_per_m:
                raise ValueError(
                    "the turbulence file holds the mean wind and its shear: leave "
                    f"{', '.join(sources)}, shear and veer_deg_per_m out, or set mean: case"
                )
        elif len(given) != 1:
            raise ValueError(f"give exactly one of {', '.join(sources)}")
        return self
