"""Channels found by our name, by OpenFAST's, and the nearest names where there is none."""

from __future__ import annotations

import re

import pytest
from typer.testing import CliRunner

from galerna.case import CaseError, load
from galerna.channel_list import channels_of, chosen
from galerna.channel_names import ALIASES, matching, nearest, shown_openfast
from galerna.cli import app
from galerna.contract import Channel
from galerna.errors import InputError
from galerna.machine import build_machine

CHANNELS = (
    Channel("electrical_power", "W", "power", (), "GenPwr", "kW", 1e-3),
    Channel("blade_root_out_of_plane_moment", "N m", "moment", ("blade",), "RootMyc{blade}"),
    Channel("angle_of_attack", "rad", "angle", ("blade", "radius"), "AB{blade}N{node:03d}Alpha"),
    Channel("tip_out_of_plane_displacement", "m", "tip", ("blade",), "OoPDefl{blade}"),
    Channel("axial_induction", "1", "induction"),
)


@pytest.mark.parametrize(
    ("pattern", "name"),
    [
        ("GenPwr", "electrical_power"),
        ("genpwr", "electrical_power"),
        ("RootMyc2", "blade_root_out_of_plane_moment"),
        ("RootMOoP3", "blade_root_out_of_plane_moment"),
        ("AB2N013Alpha", "angle_of_attack"),
        ("TipDxc1", "tip_out_of_plane_displacement"),
        ("axial_*", "axial_induction"),
    ],
)
def test_a_channel_answers_to_both_names(pattern: str, name: str) -> None:
    assert [channel.name for channel in matching(pattern, CHANNELS)] == [name]


def test_a_name_that_nobody_has_is_answered_with_the_nearest() -> None:
    assert matching("GenPow", CHANNELS) == ()
    assert "GenPwr" in nearest("GenPow", CHANNELS)
    assert "electrical_power" in nearest("electric_power", CHANNELS)
    assert "blade_root*" in nearest("blade_root", CHANNELS)
    assert "galerna channels" in nearest("qqqq", CHANNELS)


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [
        ("blade_rot*", "'blade_root*'"),
        ("*_indction", "'*induction'"),
        ("tip_*_displacment", "'tip_out_of_plane_displacement'"),
        ("electricl_powe?", "'electrical_power'"),
    ],
)
def test_a_pattern_s_letters_are_compared_without_its_wildcards(
    pattern: str, expected: str
) -> None:
    assert matching(pattern, CHANNELS) == ()
    assert expected in nearest(pattern, CHANNELS)
    assert "galerna channels" in nearest("qqqq*", CHANNELS)


def test_what_is_meant_names_channels() -> None:
    for name in re.findall(r"'([^']+)'", nearest("blade_rot*", CHANNELS)):
        assert matching(name, CHANNELS)


MACHINE = {
    "galerna": 1, "turbine": "nrel5mw", "duration_s": 1.0, "inflow": {"wind_speed_m_s": 10.0},
    "structure": {"blade_elements": 4, "tower_elements": 3}, "control": "baseline",
    "outputs": {"blade_stations": [0.1, 0.9], "energy": True},
}  # fmt: skip


def test_a_machine_s_channels_are_listed_with_its_stations() -> None:
    channels, coordinates = channels_of(load(MACHINE))
    names = {channel.name for channel in channels}
    assert coordinates["blade_station"].tolist() == [0.1, 0.9]
    assert {"energy_wind", "tower_base_fore_aft_moment", "electrical_power", "pitch"} <= names
    theirs = [shown_openfast(channel) for channel in channels if channel.openfast]
    assert len(theirs) == len(set(theirs)), "no two channels under one name in an .outb"
    assert set(ALIASES.values()) <= set(theirs)


def test_the_wind_is_not_made_for_a_list() -> None:
    absent = {"kind": "file", "path": "nowhere.bts"}
    case = {**MACHINE, "inflow": {"turbulence": absent}}
    channels, _ = channels_of(load(case))
    assert "wind_speed" in {channel.name for channel in channels}


def test_a_rigid_machine_has_no_sections_but_root_and_tower_loads() -> None:
    channels, _ = channels_of(load({**MACHINE, "structure": "rigid"}))
    names = {channel.name for channel in channels}
    assert {"blade_root_in_plane_moment", "tower_base_fore_aft_moment"} <= names
    assert "blade_flapwise_moment" not in names


def test_a_pattern_that_names_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="no channel") as refused:
        chosen(load(MACHINE), "tower_bse_fore_aft_moment")
    assert "tower_base_fore_aft_moment" in str(refused.value)


def test_every_name_that_a_case_asks_for_in_vain_is_told() -> None:
    wanted = ["rotor_thrust", "rotor_trust", "nope_*", "rotor_pwr"]
    case = load({
        "galerna": 1, "turbine": "nrel5mw", "duration_s": 1.0, "inflow": {"wind_speed_m_s": 8.0},
        "operation": {"rotor_speed_rpm": 9.0}, "outputs": {"channels": wanted},
    })  # fmt: skip
    with pytest.raises(CaseError) as refused:
        build_machine(case)
    paths = [problem.path for problem in refused.value.problems]
    assert paths == [("outputs", "channels", i) for i in (1, 2, 3)]
    assert "did you mean 'rotor_thrust'" in str(refused.value)


def test_the_command_prints_a_line_for_every_channel() -> None:
    told = CliRunner().invoke(app, ["channels", "controlled", "TwrBsMyt"])
    assert told.exit_code == 0, told.output
    assert "tower_base_fore_aft_moment" in told.output
    assert "TwrBsMyt [kN-m]" in told.output
