"""Controllers by name: found, made, and blamed by name."""

from __future__ import annotations

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.contract import Channel
from galerna.control.interface import Demands, Measurements
from galerna.control.python_controller import (
    ask,
    channels_of,
    python_controller,
    record_of,
    sample_time_of,
    state_of,
)
from galerna.errors import ControllerError, InputError

NREL = turbines.load("nrel5mw")
FILE = """
from galerna.control.interface import Demands

class Keeps:
    def __init__(self, turbine):
        self.turbine = turbine
    def demands(self, measured):
        return Demands(measured.pitch, 1e3)

def made(turbine):
    return Keeps(turbine)

ready = Keeps(None)
number = 3

def broken(turbine):
    return 1 / 0

class Late:
    def __init__(self, turbine): pass
    def demands(self, measured):
        return {}["torque"]

class Wrong(Late):
    def demands(self, measured):
        return 5.0
"""
NOW = Measurements(7.5, 1.2, 120.0, 4e4, 5e6, np.zeros(3), 0.0)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "mine.py").write_text(FILE)
    return tmp_path


@pytest.mark.parametrize("name", ["Keeps", "made", "ready"])
def test_a_class_a_function_and_an_object_command(folder, name):
    found = python_controller(f"mine.py:{name}", NREL, folder)
    assert found.turbine is (None if name == "ready" else NREL)
    assert ask(found, NOW).generator_torque == 1e3


def test_a_module_on_the_path_will_do(folder, monkeypatch):
    monkeypatch.syspath_prepend(folder)
    assert ask(python_controller("mine:made", NREL, folder), NOW).generator_torque == 1e3


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("mine.py", "module:name"),
        ("mine.py:Keep", "'Keeps'"),
        ("other.py:Keeps", "there is no file"),
        ("no_such_module_of_mine:Keeps", "no module"),
        ("mine.py:number", "no method demands"),
        ("mine.py:broken", "ZeroDivisionError.*mine.py, line 17"),
    ],
)
def test_what_cannot_be_a_controller_is_said(folder, place, said):
    with pytest.raises(InputError, match=said):
        python_controller(place, NREL, folder)


def test_a_file_that_does_not_run_is_said(folder):
    (folder / "bad.py").write_text("import no_such_package\n")
    with pytest.raises(InputError, match=r"bad\.py cannot be imported.*no_such_package"):
        python_controller("bad.py:x", NREL, folder)


def test_a_failure_inside_names_the_controller_the_time_and_the_line(folder):
    late = python_controller("mine.py:Late", NREL, folder)
    with pytest.raises(ControllerError, match=r"Late at t = 7.5 s: raised KeyError.*line 22") as e:
        ask(late, NOW)
    assert isinstance(e.value.__cause__, KeyError)


def controller(**parts):
    """A controller with these methods and attributes beside its demands."""
    return type("Mine", (), {"demands": lambda self, measured: None, **parts})()


def test_what_a_controller_remembers_is_kept_as_arrays():
    kept = state_of(controller(state=lambda self: {"pitch": 0.2, "last": [1, 2]}), 7.5)
    assert kept["pitch"] == 0.2
    assert kept["last"].tolist() == [1, 2]
    assert state_of(controller(), 7.5) == {}


@pytest.mark.parametrize(
    ("state", "said"),
    [
        (lambda self: None, "Mine at t = 7.5 s: raised AttributeError"),
        (lambda self: {"x": {"y": 1}}, "Mine at t = 7.5 s: its state 'x' cannot be saved"),
        (lambda self: 1 / 0, "Mine at t = 7.5 s: raised ZeroDivisionError"),
    ],
)
def test_what_cannot_be_saved_is_said(state, said):
    with pytest.raises(ControllerError, match=said):
        state_of(controller(state=state), 7.5)


def test_channels_of_its_own_are_recorded():
    own = (Channel("gust", "1", "whether it gusts"),)
    mine = controller(channels=own, record=lambda self: {"gust": 1.0, "more": 2.0})
    assert record_of(mine, channels_of(mine), 7.5) == {"gust": 1.0}
    silent = controller(channels=own, record=lambda self: {})
    with pytest.raises(ControllerError, match=r"Mine at t = 7.5 s: raised KeyError: 'gust'"):
        record_of(silent, own, 7.5)
    with pytest.raises(InputError, match="no method record"):
        channels_of(controller(channels=own))
    with pytest.raises(InputError, match="its channels have a str"):
        channels_of(controller(channels=("gust",)))


@pytest.mark.parametrize("own", ["0.1", -1.0, np.nan, np.inf])
def test_a_sample_time_that_is_none_is_said(own):
    assert sample_time_of(controller()) == 0.0
    with pytest.raises(InputError, match="Mine: its sample_time is"):
        sample_time_of(controller(sample_time=own))


def test_an_answer_that_is_none_is_said(folder):
    wrong = python_controller("mine.py:Wrong", NREL, folder)
    with pytest.raises(ControllerError, match="answered with a float"):
        ask(wrong, NOW)
    assert isinstance(ask(python_controller("mine.py:ready", NREL, folder), NOW), Demands)
