"""What a user can choose of the structure: what bends, how finely, and how it stands."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, NonNegativeFloat

Stiffness = Literal["flexible", "rigid"]


class StructureOptions(BaseModel):
    """Settings of the moving machine; each part bends or does not."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    blades: Stiffness = Field("flexible", description="Blades: geometrically exact beams, or not.")
    tower: Stiffness = Field("flexible", description="Tower: a geometrically exact beam, or not.")
    shaft: Stiffness = Field(
        "flexible", description="Low-speed shaft: the turbine's torsion spring and damper, or not."
    )
    yaw_bearing: Stiffness = Field(
        "flexible", description="Yaw bearing: the turbine's torsion spring and damper, or not."
    )
    blade_elements: Annotated[int, Field(ge=1, le=500)] = Field(
        20, description="Beam elements of a flexible blade."
    )
    tower_elements: Annotated[int, Field(ge=1, le=500)] = Field(
        10, description="Beam elements of a flexible tower."
    )
    gravity_m_s2: NonNegativeFloat = Field(9.80665, description="Weight of all parts.")
    coupling: Literal["strong", "loose"] = Field(
        "strong",
        description="Strong: loads and motion are in balance at the end of every step. Loose: "
        "the loads are those of the predicted motion.",
    )
    rho_inf: Annotated[float, Field(ge=0.0, le=1.0)] = Field(
        0.9,
        description="Spectral radius of the time integration at infinite frequency: 1 damps "
        "nothing, 0 damps what is faster than the step at once.",
    )
    alpha_n: Annotated[float, Field(gt=0.0, le=0.5)] | None = Field(
        None,
        description="Newmark-beta with this dissipation, of first order, in place of "
        "generalized-alpha: the dissertation's scheme.",
    )

    @classmethod
    def rigid(cls) -> StructureOptions:
        """Every part rigid; the rotor still turns under its loads."""
        return cls(blades="rigid", tower="rigid", shaft="rigid", yaw_bearing="rigid")
