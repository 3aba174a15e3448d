"""Ctrl-C and SIGTERM: a run ends where its state is known, or at once if asked twice."""

from __future__ import annotations

import signal

import pytest
from machines import Spring
from test_simulation import spinning

from galerna.interrupting import AfterTheStep, InterruptedRunError, Terminated, interruptible


class Sender(Spring):
    """Gets signals within a step."""

    def __init__(self, *numbers):
        super().__init__()
        self.numbers = numbers

    def loads(self, time, motion):
        if time > 0.45:
            for number in self.numbers:
                signal.raise_signal(number)
        return super().loads(time, motion)


def test_a_run_ends_after_the_step_under_way():
    simulation = spinning(Sender(signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        simulation.run(1.0, [AfterTheStep()])
    assert simulation.time == pytest.approx(0.5)
    assert simulation.accepted_state() is not None


def test_a_second_signal_ends_it_at_once():
    simulation = spinning(Sender(signal.SIGINT, signal.SIGTERM))
    with pytest.raises(Terminated):
        simulation.run(1.0, [AfterTheStep()])
    assert simulation.time == pytest.approx(0.4)


def test_the_signals_are_given_back():
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    simulation = spinning(Sender(signal.SIGTERM))
    with pytest.raises(InterruptedRunError) as caught, interruptible():
        simulation.run(1.0, [AfterTheStep()])
    assert caught.value.exit_code == 143
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before
