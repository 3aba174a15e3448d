"""The time loop with a load model that does little."""

import time

import numpy as np
import pytest
from machines import Spring, small_turbine

from galerna.contract import Loads, Stations
from galerna.errors import ConvergenceError, InputError
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal
from galerna.simulation import Callback, Simulation

OPERATION = PrescribedOperation(Signal.constant(1.0), (Signal.constant(0.0),) * 3)


def spinning(*models, structure=PrescribedMotion, **options):
    moving = structure(small_turbine(), OPERATION, [m.stations for m in models])
    named = {f"model{i}": m for i, m in enumerate(models)}
    return Simulation(moving, named, 0.1, **options)


class Restless(PrescribedMotion):
    """Finds no balance in steps above ``limit`` s."""

    limit = 0.03

    def predict(self, time, dt):
        self.dt = dt
        super().predict(time, dt)

    def balance(self, loads):
        return self.dt < self.limit


def test_a_step_calls_begin_loads_and_end_in_order():
    model = Spring()
    spinning(model).advance()
    assert model.calls == ["begin", "loads", "end"]


def test_the_clock_does_not_drift():
    simulation = spinning(Spring())
    simulation.run(30.0)
    assert simulation.steps == 300
    assert simulation.time == 300 * 0.1


def test_begin_step_sees_the_accepted_motion_and_loads_the_new_one():
    heights = {}

    class Watcher(Spring):
        def begin_step(self, time, dt, motion):
            heights["begin", round(time, 9)] = motion.position[-1, 2]
            super().begin_step(time, dt, motion)

        def loads(self, time, motion):
            heights["loads", round(time, 9)] = motion.position[-1, 2]
            return super().loads(time, motion)

    simulation = spinning(Watcher())
    simulation.run(0.3)
    assert heights["begin", 0.1] == heights["loads", 0.1]
    assert heights["begin", 0.0] != heights["loads", 0.1]


def test_a_resumed_run_gives_the_same_bits():
    straight = spinning(Spring())
    straight.run(5.0)
    first = spinning(Spring())
    first.run(2.0)
    second = spinning(Spring())
    second.restore({key: value.copy() for key, value in first.state().items()})
    second.run(5.0)
    assert second.state().keys() == straight.state().keys()
    for key, value in straight.state().items():
        np.testing.assert_array_equal(second.state()[key], value)


def test_a_step_that_does_not_converge_is_halved():
    model = Spring()
    simulation = spinning(model, structure=Restless)
    simulation.advance()
    assert model.calls.count("end") == 4
    assert simulation.time == 0.1


def test_a_step_that_never_converges_stops_with_time_and_part():
    class Hopeless(Restless):
        limit = 0.0

    simulation = spinning(Spring(), structure=Hopeless)
    with pytest.raises(ConvergenceError, match=r"structure at t = 0\.0125 s: no balance"):
        simulation.run(1.0)


def test_a_step_that_fails_half_way_leaves_nothing_of_itself():
    class Tiring(Restless):
        def balance(self, loads):
            return self._time < 0.15 and super().balance(loads)

    model = Spring()
    simulation = spinning(model, structure=Tiring)
    simulation.advance()
    before = simulation.state()
    with pytest.raises(ConvergenceError, match="no balance"):
        simulation.advance()
    after = simulation.state()
    assert model.calls.count("end") > 4  # some of its halves had been accepted
    assert all(np.array_equal(before[key], after[key]) for key in before)


def test_a_load_that_is_not_a_number_is_named_at_once():
    blade = Stations("blade2", np.array([0.0, 0.5, 1.0]))
    model = Spring((blade,), fail_at=0.25)
    simulation = spinning(model)
    message = r"model0 at t = 0\.3 s: the load on blade2 at 0\.0% of its span is not a number"
    with pytest.raises(ConvergenceError, match=message):
        simulation.run(1.0)
    assert simulation.steps == 2


def test_an_error_of_a_model_gets_its_time_and_name():
    class Stubborn(Spring):
        def loads(self, time, motion):
            if time > 0.35:
                raise ConvergenceError("blade1", "no inflow angle")
            return super().loads(time, motion)

    with pytest.raises(ConvergenceError, match=r"model0, blade1 at t = 0\.\d+ s: no inflow angle"):
        spinning(Stubborn()).run(1.0)


def test_a_step_larger_than_a_model_permits_is_refused():
    model = Spring()
    model.largest_step = 0.05
    with pytest.raises(InputError, match=r"0\.1 s is too large: model0 permits at most 0\.05 s"):
        spinning(model)


def test_two_channels_of_one_name_are_refused():
    with pytest.raises(InputError, match="model0 and model1 both have a channel 'tip_height'"):
        spinning(Spring(), Spring())


def test_a_callback_can_stop_a_run_and_is_told_of_the_end():
    class Stop(Callback):
        finished = False

        def accepted(self, simulation):
            if simulation.time > 0.45:
                simulation.stop("enough")

        def finish(self, simulation):
            self.finished = True

    simulation, stop = spinning(Spring()), Stop()
    simulation.run(10.0, [stop])
    assert simulation.steps == 5
    assert stop.finished


def test_the_loop_costs_little_beside_its_models():
    """Under 25 us a step for motion, checks and calls; ten times that on a busy machine."""

    class Idle(Spring):
        def begin_step(self, time, dt, motion): ...
        def loads(self, time, motion):
            return self.nothing

        def end_step(self, time, motion): ...

    blades = tuple(Stations(f"blade{k}", np.linspace(0.0, 1.0, 19)) for k in (1, 2, 3))
    model = Idle((*blades, Stations("hub")))

    model.nothing = Loads.zero(58)
    simulation = spinning(model)
    simulation.run(10.0)
    fastest = np.inf
    for _ in range(5):
        begin, steps = time.perf_counter(), simulation.steps
        simulation.run(simulation.time + 200.0)
        fastest = min(fastest, (time.perf_counter() - begin) / (simulation.steps - steps))
    print(f"{1e6 * fastest:.1f} us a step")
    assert fastest < 250e-6
