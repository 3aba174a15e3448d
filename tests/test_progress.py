"""What a person sees while a simulation runs."""

import io

import pytest
from machines import Spring
from rich.console import Console
from test_simulation import spinning

from galerna.progress import ProgressBar, ProgressLine, best, machine


class EagerLine(ProgressLine):
    interval = 0.0


class EagerBar(ProgressBar):
    interval = 0.0


def test_a_line_now_and_then_where_there_is_no_terminal(capsys):
    spinning(Spring()).run(1.0, [EagerLine()])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 9
    assert "of 1.0 s" in lines[0]
    assert "x real time" in lines[0]
    assert "9.55 rpm" in lines[0]


def test_a_bar_on_a_terminal(monkeypatch):
    screen = io.StringIO()
    terminal = Console(file=screen, force_terminal=True, width=120)
    monkeypatch.setattr("rich.console.Console", lambda **_: terminal)
    spinning(Spring()).run(1.0, [EagerBar()])
    shown = screen.getvalue()
    assert "of 1.0 s" in shown
    assert "x real time" in shown
    assert "9.55 rpm" in shown


def test_the_terminal_decides(monkeypatch):
    assert isinstance(best(True), ProgressBar)
    assert isinstance(best(False), ProgressLine)


def test_a_bar_goes_away_when_a_run_fails(monkeypatch):
    screen = io.StringIO()
    terminal = Console(file=screen, force_terminal=True, width=120)
    monkeypatch.setattr("rich.console.Console", lambda **_: terminal)
    bar = EagerBar()
    with pytest.raises(ZeroDivisionError):
        spinning(Spring()).run(1.0, [bar, Failing()])
    assert not bar._progress.live.is_started


class Failing(EagerLine):
    def start(self, simulation, end): ...

    def accepted(self, simulation):
        raise ZeroDivisionError


class Recorded:
    """A simulation that has nothing but a record."""

    def __init__(self, **record):
        self.record = lambda: record


def test_the_power_is_the_generator_s_where_there_is_one():
    assert machine(Recorded(rotor_power=5.297e6)) == "5.297 MW aerodynamic"
    both = Recorded(rotor_power=5.297e6, electrical_power=5e6)
    assert machine(both) == "5.000 MW electrical"
    assert machine(Recorded(electrical_power=-0.0)) == "0.000 MW electrical"
