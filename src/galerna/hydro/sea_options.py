"""The ``sea:`` block of a case: every field with its unit, checked before anything runs."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

Positive = Annotated[FiniteFloat, Field(gt=0.0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0.0)]
Angle = Annotated[FiniteFloat, Field(ge=-360.0, le=360.0)]
Stretching = Literal["none", "vertical", "extrapolation", "wheeler"]


class _Block(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class _Waves(_Block):
    direction_deg: Angle = Field(
        0.0, description="Where the waves go, positive about the vertical upwards, 0 along x."
    )


class StillWater(_Block):
    """No waves."""

    kind: Literal["still"] = "still"


class RegularWaves(_Waves):
    """Waves of one height and period."""

    kind: Literal["regular"]
    height_m: Positive = Field(description="From trough to crest.")
    period_s: Positive = Field(description="Between two crests.")
    phase_deg: Angle = Field(0.0, description="0: a crest stands at the origin at time 0.")


class _Irregular(_Waves):
    significant_height_m: Positive = Field(description="Four standard deviations.")
    peak_period_s: Positive = Field(description="Period of the most energy.")
    amplitudes: Literal["random_phase", "white_noise"] = Field(
        "random_phase",
        description="Random phases alone, so that every seed has the spectrum itself; or random "
        "amplitudes too, as in a Gaussian sea, which has it on average over the seeds.",
    )
    spreading_exponent: Positive | None = Field(
        None,
        description="s of a spreading over the directions with cos^2s of half the angle from the "
        "main one; long crests if not given.",
    )
    lowest_frequency_hz: Positive | None = Field(
        None, description="Lowest frequency; half of the peak's if not given."
    )
    highest_frequency_hz: Positive | None = Field(
        None,
        description="Highest frequency; six times the peak's if not given, which leaves out "
        "0.1 % of the variance.",
    )
    seed: int | None = Field(None, description="Seed; that of the case if not given.")

    @model_validator(mode="after")
    def _rising(self) -> Self:
        lowest, highest = self.lowest_frequency_hz, self.highest_frequency_hz
        if lowest is not None and highest is not None and lowest >= highest:
            raise ValueError("lowest_frequency_hz must be below highest_frequency_hz")
        return self


class Jonswap(_Irregular):
    """The spectrum of a growing sea (Hasselmann et al., 1973), as IEC 61400-3 has it."""

    kind: Literal["jonswap"]
    peak_enhancement: Annotated[FiniteFloat, Field(ge=1.0, le=10.0)] | None = Field(
        None, description="gamma; that of IEC 61400-3 for the height and period if not given."
    )


class PiersonMoskowitz(_Irregular):
    """The spectrum of a fully developed sea (Pierson and Moskowitz, 1964)."""

    kind: Literal["pierson_moskowitz"]


class ElevationSeries(_Waves):
    """Waves from an elevation at the origin over the time of the run, without its mean."""

    kind: Literal["elevation_series"]
    path: str | None = Field(
        None, description="CSV file of time in s and elevation in m, relative to the case file."
    )
    time_s: tuple[FiniteFloat, ...] | None = Field(None, description="Even times, instead.")
    elevation_m: tuple[FiniteFloat, ...] | None = Field(
        None, description="The elevation at each time."
    )
    lowest_frequency_hz: NotNegative = Field(0.0, description="Lower frequencies are left out.")
    highest_frequency_hz: Positive | None = Field(
        None, description="Higher frequencies are left out; none if not given."
    )

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.time_s is None) != (self.elevation_m is None):
            raise ValueError("time_s and elevation_m go together")
        if (self.path is None) == (self.time_s is None):
            raise ValueError("give either path or time_s and elevation_m")
        return self


Waves = Annotated[
    StillWater | RegularWaves | Jonswap | PiersonMoskowitz | ElevationSeries,
    Field(discriminator="kind"),
]


class UniformCurrent(_Block):
    """The same current at every depth."""

    profile: Literal["uniform"]
    speed_m_s: NotNegative = Field(description="Speed.")
    direction_deg: Angle = Field(0.0, description="Where it goes, like that of the waves.")


class PowerLawCurrent(_Block):
    """A current that falls with a power of the height above the seabed."""

    profile: Literal["power"]
    speed_m_s: NotNegative = Field(description="Speed at the still water.")
    direction_deg: Angle = Field(0.0, description="Where it goes, like that of the waves.")
    exponent: Annotated[FiniteFloat, Field(ge=0.0, le=2.0)] = Field(
        1.0 / 7.0, description="Exponent; 1/7 in IEC 61400-3."
    )


class CurrentTable(_Block):
    """A current given at depths, straight between them and constant beyond."""

    profile: Literal["table"]
    depth_m: tuple[NotNegative, ...] = Field(min_length=2, description="Rising depths.")
    speed_m_s: tuple[NotNegative, ...] = Field(description="Speed at each depth.")
    direction_deg: Angle | tuple[Angle, ...] = Field(
        0.0, description="Where it goes, like that of the waves; one or at each depth."
    )

    @model_validator(mode="after")
    def _same_length(self) -> Self:
        columns = {"speed_m_s": self.speed_m_s, "direction_deg": self.direction_deg}
        for name, values in columns.items():
            if isinstance(values, tuple) and len(values) != len(self.depth_m):
                depths = len(self.depth_m)
                raise ValueError(f"{name} has {len(values)} values for {depths} depths in depth_m")
        return self


CurrentProfile = Annotated[
    UniformCurrent | PowerLawCurrent | CurrentTable, Field(discriminator="profile")
]


class SeaOptions(_Block):
    """The water that a platform floats in: its depth, waves, current, and viscous drag."""

    water_density_kg_m3: Positive = Field(1025.0, description="Density of the water.")
    water_depth_m: Positive | None = Field(
        None, description="Depth; that of the turbine's platform if not given."
    )
    waves: Waves = Field(StillWater(), description="First-order waves.")
    current: CurrentProfile | None = Field(
        None, description="A steady current, felt by the drag alone; it does not bend the waves."
    )
    ramp_s: NotNegative = Field(
        20.0,
        description="Time over which the waves grow from none: two usual wave periods, so that "
        "no force begins with a step.",
    )
    drag: bool = Field(True, description="Viscous drag of the members (Morison).")
    stretching: Stretching = Field(
        "wheeler",
        description="Water velocities above the still water, for the drag: none, and drag up to "
        "the still water alone; or up to the elevation, with the velocity of the still water, its "
        "tangent there, or the whole profile stretched (Wheeler).",
    )
