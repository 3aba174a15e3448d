"""What a user can choose of a platform afloat: its models, what holds it, how it starts."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, NonNegativeFloat, PositiveFloat

Direction = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]


class _Block(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class PlatformStart(_Block):
    """What is added to the equilibrium at the start: a free decay from there."""

    surge_m: FiniteFloat = Field(0.0, description="Along x.")
    sway_m: FiniteFloat = Field(0.0, description="Along y.")
    heave_m: FiniteFloat = Field(0.0, description="Along z.")
    roll_deg: FiniteFloat = Field(0.0, description="About x, the last of the three turns.")
    pitch_deg: FiniteFloat = Field(0.0, description="About y.")
    yaw_deg: FiniteFloat = Field(0.0, description="About z, the first of the three turns.")


class PlatformOptions(_Block):
    """Models of the platform in the sea."""

    model: Literal["rigid", "concentrated_spar", "flexible_spar"] = Field(
        "rigid",
        description="One rigid body; or a spar with all but the piece above still water lumped; "
        "or a spar of two beams and a ballast.",
    )
    hydrostatics: Literal["linear", "nonlinear"] = Field(
        "linear", description="Buoyancy by a restoring matrix, or of the displaced hull."
    )
    radiation: Literal["state_space", "convolution", "none"] = Field(
        "state_space",
        description="Memory of the water: a fitted passive state space, the convolution with the "
        "impulse response that it is tested against, or none.",
    )
    radiation_memory_s: PositiveFloat = Field(
        60.0, description="How far back the convolution reaches."
    )
    drift: Literal["none", "mean", "slow"] = Field(
        "none",
        description="Second-order drift force of the waves: its mean, or Newman's slow one.",
    )
    heading: Literal["mean_yaw", "fixed"] = Field(
        "mean_yaw",
        description="Potential-flow loads in axes that turn with the platform's mean yaw, or not.",
    )
    heading_cut_off_hz: NonNegativeFloat = Field(
        0.01, description="Cut-off of the low-pass filter that takes the mean yaw."
    )
    added_mass_axes: Literal["mean_lean", "upright"] = Field(
        "mean_lean",
        description="Added mass, radiation and additional damping in axes that lean as the "
        "platform does on average, or upright as in OpenFAST.",
    )
    lean_cut_off_hz: NonNegativeFloat = Field(
        0.001, description="Cut-off of the low-pass filter that takes the mean lean."
    )
    mooring: Literal["quasi_static", "dynamic", "none"] = Field(
        "quasi_static",
        description="Lines as elastic catenaries, as MoorDyn's lumped masses (extra moordyn), "
        "or none.",
    )
    additional_damping: bool = Field(
        True, description="The linear damping that the turbine's file adds."
    )
    locked: tuple[Direction, ...] = Field(
        (), description="Directions in which the platform does not move."
    )
    start: PlatformStart = Field(
        PlatformStart(), description="Displacement from the equilibrium at time 0."
    )
    hydrodynamics_file: str | None = Field(
        None,
        description="File of potential-flow coefficients (galerna hydro, or WAMIT's .1 with .3 "
        "and .hst beside it); by default the turbine's.",
    )
