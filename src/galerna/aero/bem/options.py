"""What a user can choose of the blade-element momentum model: one switch per correction."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

SpanFraction = Annotated[float, Field(ge=0.0, le=1.0)]


class BemOptions(BaseModel):
    """Settings of the blade-element momentum model; the defaults are what the field chooses."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    model: Literal["bem"] = Field(default="bem", description="Blade-element momentum.")
    stations: Annotated[int, Field(ge=3, le=1000)] | tuple[SpanFraction, ...] | None = Field(
        default=None,
        description="Strips per blade: a number of equally spaced stations, a rising list of "
        "span fractions, or nothing for the turbine's own stations.",
    )
    tip_loss: bool = Field(default=True, description="Prandtl's tip loss.")
    root_loss: bool = Field(default=True, description="Prandtl's loss at the blade root.")
    high_thrust: Literal["buhl", "glauert", "wilson_walker", "madsen"] = Field(
        default="buhl",
        description="Empirical thrust of the turbulent wake state: Buhl (2005), Glauert's "
        "parabola times the loss factor, Wilson and Walker's tangent (1984), or the polynomial "
        "of Madsen et al. (2020), HAWC2's.",
    )
    induction: bool = Field(
        default=True, description="Induced velocities; off is pure blade element."
    )
    tangential_induction: bool = Field(default=True, description="Swirl of the wake at the rotor.")
    drag_in_axial_induction: bool = Field(
        default=True, description="Drag in the axial momentum balance."
    )
    drag_in_tangential_induction: bool = Field(
        default=True, description="Drag in the swirl balance."
    )
    skewed_wake: Literal["vortex_cylinder", "pitt_peters", "none"] = Field(
        default="vortex_cylinder",
        description="Azimuthal variation of the induction under yaw and tilt.",
    )
    dynamic_inflow: Literal["oye", "none"] = Field(
        default="oye", description="Lag of the induction behind the rotor's loading."
    )
    unsteady_airfoil: Literal["beddoes_leishman", "none"] = Field(
        default="beddoes_leishman", description="Unsteady section aerodynamics with dynamic stall."
    )
    indicial_response: Literal["jones", "airfoil"] = Field(
        default="jones",
        description="Constants A1, A2, b1, b2 of the attached flow's lag: R. T. Jones' for "
        "incompressible flow, or those in the airfoil's data, which are often meant for the "
        "compressible model of Beddoes and Leishman.",
    )
    rotational_augmentation: Literal["none", "snel", "du_selig"] = Field(
        default="none", description="Stall delay by rotation, applied to the polars beforehand."
    )
    spanwise_filter: Literal["off", "loads", "feedback"] = Field(
        default="off",
        description="Interaction of neighbouring sections under spanwise-varying inflow: on the "
        "loads alone, or fed back into the momentum balance.",
    )
    angle_of_attack_point: Literal["three_quarter_chord", "aerodynamic_center"] = Field(
        default="three_quarter_chord",
        description="Where a turning section reads its angle of attack.",
    )
    tower_influence: bool = Field(
        default=True, description="Tower dam effect and shadow on the wind that the blades meet."
    )
    quasi_steady: bool = Field(
        default=False,
        description="Switch all unsteady parts off at once: dynamic inflow, unsteady airfoil.",
    )

    @property
    def has_dynamic_inflow(self) -> bool:
        """Whether the induction lags behind the loading."""
        return self.dynamic_inflow != "none" and not self.quasi_steady

    @property
    def has_unsteady_airfoil(self) -> bool:
        """Whether section forces have a memory."""
        return self.unsteady_airfoil != "none" and not self.quasi_steady
