"""The file of gains that ``galerna tune`` writes and a baseline controller reads."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, PositiveFloat, ValidationError

from galerna.contract import Array
from galerna.coupling.gains import Tuning
from galerna.turbine.model import Turbine
from galerna.turbine.windio.yamlfile import Document, load
from galerna.units import DEG

VERSION = 1
HINT = "galerna tune TURBINE --output FILE writes one"


class _Schedule(BaseModel):
    """Gains against the generator's speed error, at pitch angles that rise."""

    model_config = ConfigDict(extra="forbid")

    pitch_deg: list[FiniteFloat] = Field(min_length=1)
    proportional_s: list[FiniteFloat]
    integral: list[FiniteFloat]


class _File(BaseModel):
    """The whole file."""

    model_config = ConfigDict(extra="forbid")

    galerna_gains: int
    turbine: str
    above_rated: str
    natural_frequency_rad_s: PositiveFloat
    damping_ratio: PositiveFloat
    optimal_mode_gain_N_m_s2: PositiveFloat
    pitch_schedule: _Schedule


def write_gains(tuning: Tuning, file: Path) -> None:
    """Store gains as YAML, units in the names."""
    gains, rows = tuning.gains, []
    columns = {
        "pitch_deg": gains.pitch / DEG,
        "proportional_s": gains.proportional,
        "integral": gains.integral,
    }
    for name, values in columns.items():
        rows.append(f"  {name}: [{', '.join(f'{value:.8g}' for value in values)}]")
    lines = [
        f"galerna_gains: {VERSION}",
        f"turbine: {tuning.turbine}",
        f"above_rated: {tuning.above_rated}",
        f"natural_frequency_rad_s: {tuning.natural_frequency:.8g}",
        f"damping_ratio: {tuning.damping_ratio:.8g}",
        f"optimal_mode_gain_N_m_s2: {tuning.optimal_mode_gain:.8g}",
        "pitch_schedule:  # gains against the generator's speed error",
        *rows,
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def with_stored_gains(turbine: Turbine, file: Path) -> Turbine:
    """The turbine with pitch gains and optimal-mode gain from a file.

    Raises InputError that says what is wrong with the file, or that it is another turbine's.
    """
    document = load(file)
    try:
        content = _File.model_validate(document.data)
    except ValidationError as error:
        first = error.errors()[0]
        raise document.error(tuple(first["loc"]), str(first["msg"]), HINT) from None
    if content.galerna_gains != VERSION:
        what = f"version {content.galerna_gains} is not known, this galerna reads {VERSION}"
        raise document.error(("galerna_gains",), what)
    if content.turbine != turbine.name:
        what = f"the gains are those of {content.turbine!r}, not of {turbine.name!r}"
        raise document.error(("turbine",), what, "change the name there if they are meant")
    control = replace(
        turbine.control,
        pitch_schedule=_schedule(content.pitch_schedule, document),
        optimal_mode_gain=content.optimal_mode_gain_N_m_s2,
    )
    return replace(turbine, control=control)


def _schedule(given: _Schedule, document: Document) -> Array:
    """Rows (n,3) of pitch rad, proportional and integral gain."""
    n = len(given.pitch_deg)
    for name in ("proportional_s", "integral"):
        values = getattr(given, name)
        if len(values) != n:
            what = f"{len(values)} values for {n} pitch angles"
            raise document.error(("pitch_schedule", name), what)
    if np.any(np.diff(given.pitch_deg) <= 0.0):
        raise document.error(("pitch_schedule", "pitch_deg"), "angles must rise")
    return np.column_stack([DEG * np.array(given.pitch_deg), given.proportional_s, given.integral])
