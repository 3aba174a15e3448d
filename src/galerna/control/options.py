"""What a user can choose of the controller, with units in the names."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    NonNegativeFloat,
    PositiveFloat,
)

Mode = Literal["production", "start_up", "normal_stop", "emergency_stop", "idling", "parked"]


class Options(BaseModel):
    """A block that cannot be changed and refuses keys it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class PitchActuatorOptions(Options):
    """What stands between the demanded pitch and the blades."""

    time_constant_s: NonNegativeFloat = Field(0.0, description="First-order lag; 0 has none.")
    rate_limit_deg_s: PositiveFloat | None = Field(
        None, description="Fastest pitch rate; the turbine's own by default."
    )
    lowest_deg: FiniteFloat = Field(-5.0, description="Lowest angle.")
    highest_deg: FiniteFloat = Field(95.0, description="Highest angle.")


class Event(Options):
    """A change of the controller's mode."""

    time_s: NonNegativeFloat = Field(description="When.")
    mode: Mode = Field(description="What the turbine does from then on.")


class ControlOptions(Options):
    """What all controllers share."""

    sample_time_s: PositiveFloat | None = Field(
        None, description="Time between calls of the controller; every time step by default."
    )
    pitch_actuator: PitchActuatorOptions = Field(
        PitchActuatorOptions(), description="Lag and limits of the blades' pitch."
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
    events: tuple[Event, ...] = Field((), description="Changes of the mode.")
    fine_pitch_deg: FiniteFloat | None = Field(
        None, description="Lowest pitch in production; the turbine's own by default."
    )


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
