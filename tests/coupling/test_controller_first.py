"""A controller's files are looked for before the wind is made, which can take minutes."""

from __future__ import annotations

import pytest

from galerna import machine
from galerna.case import load
from galerna.errors import InputError


@pytest.mark.parametrize(
    "control",
    [
        {"model": "discon", "library": "nothing.so"},
        {"model": "python", "object": "gone.py:Controller"},
        {"model": "baseline", "gains": "gone.yaml"},
    ],
)
def test_a_missing_file_is_told_before_the_wind(
    control: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(machine, "build_wind", lambda *_: pytest.fail("the wind was made"))
    case = {
        "galerna": 1, "turbine": "nrel5mw", "duration_s": 1.0,
        "inflow": {"wind_speed_m_s": 8.0}, "control": control,
    }  # fmt: skip
    with pytest.raises(InputError, match="control"):
        machine.build_machine(load(case))
