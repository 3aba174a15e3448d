"""What a user can choose of the controller, with units in the names."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    FiniteFloat,
    NonNegativeFloat,
    PositiveFloat,
    model_validator,
)

Mode = Literal["production", "start_up", "normal_stop", "emergency_stop", "idling", "parked"]


class Options(BaseModel):
    """A block that cannot be changed and refuses keys it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class PitchActuatorOptions(Options):
    """What stands between the demanded pitch and the blades."""

    time_constant_s: NonNegativeFloat = Field(0.0, description="First-order lag; 0 has none.")
    frequency_hz: PositiveFloat | None = Field(
        None, description="Natural frequency of a second-order lag, instead of a time constant."
    )
    damping_ratio: NonNegativeFloat = Field(0.7, description="Damping of the second-order lag.")
    rate_limit_deg_s: PositiveFloat | None = Field(
        None, description="Fastest pitch rate; the turbine's own by default."
    )
    lowest_deg: FiniteFloat = Field(-5.0, description="Lowest angle.")
    highest_deg: FiniteFloat = Field(95.0, description="Highest angle.")

    @model_validator(mode="after")
    def _is_one_actuator(self) -> Self:
        if self.frequency_hz is not None and self.time_constant_s > 0.0:
            raise ValueError("give time_constant_s or frequency_hz, not both")
        if self.lowest_deg >= self.highest_deg:
            raise ValueError(f"no angle is between {self.lowest_deg:g} and {self.highest_deg:g}")
        return self


class IndividualPitchOptions(Options):
    """Blade angles that take the once-per-revolution load off the roots.

    The moments are low-pass filtered with the rated rotor speed as corner frequency.
    """

    integral_gain_deg_per_MN_m_s: NonNegativeFloat | None = Field(
        None,
        description="Pitch per tilt or yaw moment and second; by default it takes the moments "
        "away with a time constant of 5 s.",
    )
    proportional_gain_deg_per_MN_m: NonNegativeFloat = Field(
        0.0, description="Pitch per tilt or yaw moment."
    )
    azimuth_offset_deg: FiniteFloat = Field(
        0.0, description="How far the angles are turned ahead, for the lag of the actuators."
    )
    amplitude_deg: PositiveFloat = Field(5.0, description="Largest angle beside the common one.")
    below_rated: bool = Field(
        False, description="Act at the lowest pitch too; by default it fades out there."
    )


class YawOptions(Options):
    """The nacelle turns slowly into the mean wind when that is far enough to the side."""

    rate_deg_s: PositiveFloat = Field(0.3, description="Rate of the yaw drive.")
    dead_band_deg: NonNegativeFloat = Field(
        8.0, description="Averaged yaw error from which on the nacelle is turned."
    )
    averaging_s: NonNegativeFloat = Field(
        60.0, description="Time constant over which the yaw error is averaged."
    )


class Event(Options):
    """A change of the controller's mode."""

    time_s: NonNegativeFloat = Field(description="When.")
    mode: Mode = Field(description="What the turbine does from then on.")


def _listed(value: Any) -> Any:
    """A list as the tuple that strict validation wants of what is not JSON any more."""
    return tuple(value) if isinstance(value, list) else value


class ControlOptions(Options):
    """What all controllers share."""

    sample_time_s: PositiveFloat | None = Field(
        None, description="Time between calls of the controller; every time step by default."
    )
    pitch_actuator: PitchActuatorOptions = Field(
        PitchActuatorOptions(), description="Lag and limits of the blades' pitch."
    )
    torque_time_constant_s: NonNegativeFloat = Field(
        0.0, description="First-order lag of the generator's torque; 0 has none."
    )


class BaselineOptions(ControlOptions):
    """The reference controller: torque by region, collective pitch by a scheduled PI."""

    model: Literal["baseline"] = Field("baseline", description="galerna's own controller.")
    above_rated: Literal["constant_power", "constant_torque"] = Field(
        "constant_power", description="What the generator holds above rated speed."
    )
    gains: str | None = Field(
        None, description="A file that galerna tune wrote; the turbine's own gains by default."
    )
    mode: Mode = Field("production", description="What the turbine does at the start.")
    events: Annotated[tuple[Event, ...], BeforeValidator(_listed)] = Field(
        (), description="Changes of the mode."
    )
    fine_pitch_deg: FiniteFloat | None = Field(
        None, description="Lowest pitch in production; the turbine's own by default."
    )
    individual_pitch: IndividualPitchOptions | None = Field(
        None, description="Individual pitch control; `{}` is one with its defaults."
    )
    yaw: YawOptions | None = Field(
        None, description="Yaw control; `{}` is one with its defaults, left out is none."
    )
    overspeed_percent: float | None = Field(
        None,
        gt=100.0,
        description="Rotor speed, of the rated one, that brings an emergency stop; left out, "
        "none does, as in the reference controllers.",
    )
    brake_torque_kN_m: NonNegativeFloat | None = Field(
        None, description="Brake on the low-speed shaft; the rated torque by default."
    )
    emergency_brake: bool = Field(
        False, description="Whether the brake helps in an emergency stop; it parks in any case."
    )

    @property
    def at_rest(self) -> bool:
        """Whether the mode begins with a rotor that stands still, blades feathered."""
        return self.mode in ("start_up", "idling", "parked")

    @property
    def feather_deg(self) -> float:
        """The pitch of a rotor at rest: feathered, as far as the actuators go."""
        return min(90.0, self.pitch_actuator.highest_deg)


class DisconOptions(ControlOptions):
    """A controller in a Bladed-style library, run in a process of its own."""

    model: Literal["discon"] = Field("discon", description="A Bladed-style DISCON library.")
    library: str = Field(
        "rosco", description="The library's file; 'rosco' finds the one of the rosco package."
    )
    input_file: str | None = Field(
        None, description="The file that the library reads; it works in that file's folder."
    )
    output_folder: str | None = Field(
        None,
        description="Where what the library writes and prints is kept; discarded by default.",
    )
    pitch_control: Literal["individual", "collective"] = Field(
        "individual", description="Which pitch demands count: one per blade, or a common one."
    )
    brake_torque_kN_m: NonNegativeFloat = Field(
        0.0, description="Brake on the low-speed shaft, where the library sets record 36 to 1."
    )
    timeout_s: PositiveFloat = Field(
        30.0, description="Wall-clock time after which a call that does not return is an error."
    )


class PythonOptions(ControlOptions):
    """A controller in Python: an object with one method, ``demands(measured)``."""

    model: Literal["python"] = Field("python", description="Any Python object.")
    object: str = Field(
        min_length=1,
        description="Where it is: 'module:name' or 'file.py:name'; a class or a function is "
        "called with the turbine, anything else is the controller itself.",
    )


class ExternalOptions(ControlOptions):
    """No controller: pitch and torque come from ``step`` in a Python program."""

    model: Literal["external"] = Field("external", description="Stepped from Python.")


Control = Annotated[
    BaselineOptions | DisconOptions | PythonOptions | ExternalOptions,
    Field(discriminator="model"),
]
