"""Gains on disk: what galerna tune writes is what a controller reads."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.case import parse
from galerna.cli import main
from galerna.coupling.controllers import controller
from galerna.coupling.gains import tuned_gains
from galerna.coupling.gains_file import with_stored_gains, write_gains
from galerna.errors import InputError

NREL = turbines.load("nrel5mw")


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    file = tmp_path / "gains.yaml"
    write_gains(tuned_gains(NREL, wind_speeds=[13.0, 20.0]), file)
    return file


def test_comes_back_as_it_was(stored: Path) -> None:
    gains = tuned_gains(NREL, wind_speeds=[13.0, 20.0])
    control = with_stored_gains(NREL, stored).control
    expected = np.column_stack([gains.gains.pitch, gains.gains.proportional, gains.gains.integral])
    assert control.pitch_schedule == pytest.approx(expected, rel=1e-6)
    assert control.optimal_mode_gain == pytest.approx(gains.optimal_mode_gain, rel=1e-6)


def test_a_case_reads_it(stored: Path) -> None:
    text = (
        "galerna: 1\nturbine: nrel5mw\nduration_s: 9\ninflow: {wind_speed_m_s: 12}\n"
        "control: {gains: gains.yaml}\n"
    )
    made = controller(parse(text, "case", stored.parent), NREL)
    schedule = with_stored_gains(NREL, stored).control.pitch_schedule
    assert made.pitch.gains.proportional == pytest.approx(schedule[:, 1])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("galerna_gains: 1", "galerna_gains: 7"), "version 7 is not known"),
        (("turbine: NREL 5 MW", "turbine: another"), "gains are those of 'another'"),
        (("integral: [", "integral: [1.0, "), "3 values for 2 pitch angles"),
        (("  proportional_s", "  proportional_z"), "proportional_s"),
        (("pitch_schedule:", "pitch_schedule: ["), "YAML"),
    ],
)
def test_says_what_is_wrong(stored: Path, change: tuple[str, str], says: str) -> None:
    stored.write_text(stored.read_text().replace(*change))
    with pytest.raises(InputError) as raised:
        with_stored_gains(NREL, stored)
    assert says in str(raised.value)
    assert stored.name in str(raised.value)


def test_a_missing_file_is_named_with_the_case(tmp_path: Path) -> None:
    text = (
        "galerna: 1\nturbine: nrel5mw\nduration_s: 9\ninflow: {wind_speed_m_s: 12}\n"
        "control: {gains: none.yaml}\n"
    )
    with pytest.raises(InputError, match=r"none\.yaml"):
        controller(parse(text, "case", tmp_path), NREL)


def test_tune_prints_and_stores(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "floating.yaml"
    with pytest.raises(SystemExit) as ended:
        main(["tune", "nrel5mw_oc3", "--constant-torque", "--output", str(file)])
    assert not ended.value.code
    printed = capsys.readouterr().out
    assert "K_P [s]" in printed
    assert "0.2" in printed
    oc3 = turbines.load("nrel5mw_oc3")
    published = oc3.control.pitch_schedule[0, 1:]
    schedule = with_stored_gains(oc3, file).control.pitch_schedule
    assert schedule[0, 1:] == pytest.approx(published, rel=0.15)  # NREL/TP-500-47535


def test_tune_refuses_what_cannot_be(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["tune", "nrel5mw", "--frequency", "-1"])
    assert ended.value.code == 2
    assert "must be positive" in capsys.readouterr().err
