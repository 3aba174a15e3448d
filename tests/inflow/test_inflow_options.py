"""The inflow block of a case: what it accepts and what it refuses."""

import pytest
from pydantic import ValidationError

from galerna.inflow.options import InflowOptions

MANN = {"kind": "mann", "turbulence_class": "B"}


@pytest.mark.parametrize(
    "block",
    [
        {"wind_speed_m_s": 8},
        {"wind_speed_m_s": 8, "shear": {"kind": "power_law"}, "direction_deg": -30},
        {"time_series": {"time_s": [0, 9], "wind_speed_m_s": [8, 9], "direction_deg": [0, 20]}},
        {"time_series_file": {"path": "gust.wnd"}},
        {"wind_speed_m_s": 8, "gust": {"kind": "EWS", "start_s": 5, "direction": "horizontal"}},
        {"wind_speed_m_s": 8, "turbulence": MANN},
        {"wind_speed_m_s": 8, "turbulence": {"kind": "mann", "alpha_epsilon": 0.1}},
        {"wind_speed_m_s": 8, "turbulence": {"kind": "kaimal", "turbulence_intensity": 0.1}},
        {"turbulence": {"kind": "file", "path": "a.bts"}},
        {"wind_speed_m_s": 8, "turbulence": {"kind": "file", "path": "a.bts", "mean": "case"}},
    ],
)
def test_accepted_and_unchanged_by_a_round_trip(block):
    options = InflowOptions.model_validate(block)
    assert InflowOptions.model_validate_json(options.model_dump_json()) == options


@pytest.mark.parametrize(
    ("block", "complaint"),
    [
        ({}, "exactly one of wind_speed_m_s"),
        (
            {"wind_speed_m_s": 8, "time_series": {"time_s": [0, 1], "wind_speed_m_s": [8, 8]}},
            "exactly one of wind_speed_m_s",
        ),
        ({"wind_speed_m_s": float("nan")}, "finite"),
        ({"wind_speed_m_s": -1}, "greater than or equal to 0"),
        ({"wind_speed": 8}, "Extra inputs"),
        ({"wind_speed_m_s": 8, "shear": {"kind": "powerlaw"}}, "'power_law'"),
        ({"wind_speed_m_s": 8, "shear": {"kind": "logarithmic"}}, "roughness_length_m"),
        ({"wind_speed_m_s": 8, "gust": {"kind": "EOG"}}, "start_s"),
        ({"wind_speed_m_s": 8, "turbulence": {"kind": "mann"}}, "exactly one of turbulence_int"),
        ({"wind_speed_m_s": 8, "turbulence": MANN | {"alpha_epsilon": 1}}, "exactly one of"),
        ({"wind_speed_m_s": 8, "turbulence": MANN | {"points": [8, 8, 8]}}, "go together"),
        ({"wind_speed_m_s": 8, "turbulence": {"kind": "file", "path": "a.bts"}}, "leave"),
        ({"time_series": {"time_s": [0, 1], "wind_speed_m_s": [8]}}, "1 values for 2 times"),
        ({"time_series": {"time_s": [1, 0], "wind_speed_m_s": [8, 8]}}, "must ascend"),
    ],
)
def test_refused(block, complaint):
    with pytest.raises(ValidationError, match=complaint):
        InflowOptions.model_validate(block)


def test_immutable():
    options = InflowOptions(wind_speed_m_s=8)
    with pytest.raises(ValidationError):
        options.wind_speed_m_s = 9


def test_every_field_is_described_in_the_schema():
    schema = InflowOptions.model_json_schema()
    for block in [schema, *schema["$defs"].values()]:
        for name, field in block["properties"].items():
            assert name == "kind" or field.get("description"), f"{block['title']}.{name}"
