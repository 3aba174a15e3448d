"""The sea of a case."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, PositiveFloat


class SeaOptions(BaseModel):
    """The water."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    water_density_kg_m3: PositiveFloat = 1025.0
