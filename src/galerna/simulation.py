"""The time loop: command, predict, iterate to balance, accept, record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Protocol

import numpy as np
from numba import njit

from galerna.contract import Array, Channel, LoadModel, Loads, Motion
from galerna.errors import ConvergenceError, InputError

Record = dict[str, float | Array]

LARGEST_UNDO = 1_000_000  #: bytes that are copied before every step at most


class Stateful(Protocol):
    """Whatever the next step depends on."""

    def state(self) -> dict[str, np.ndarray]: ...
    def restore(self, state: Mapping[str, np.ndarray]) -> None: ...


class Described(Protocol):
    """Whatever has channels to show."""

    @property
    def channels(self) -> tuple[Channel, ...]: ...
    @property
    def coordinates(self) -> Mapping[str, Array]: ...


class Part(Described, Protocol):
    """A part of the machine, with the channels of its accepted state."""

    def record(self) -> Mapping[str, float | Array]: ...


class Probe(Described, Protocol):
    """What is measured beside the machine, at a time in s."""

    def record(self, time: float) -> Mapping[str, float | Array]: ...


class Structure(Part, Stateful, Protocol):
    """What moves under the loads.

    ``motions`` holds one motion for every load model: the accepted one between
    steps, the trial one between ``predict`` and ``accept``. ``balance`` corrects the
    trial with the loads on it, or says that they are in balance and leaves it as it is;
    ``reject`` returns to the accepted motion.
    """

    motions: tuple[Motion, ...]

    def predict(self, time: float, dt: float) -> None: ...
    def balance(self, loads: Sequence[Loads]) -> bool: ...
    def accept(self) -> None: ...
    def reject(self, time: float) -> None: ...


class Commander(Part, Stateful, Protocol):
    """What commands the machine: a controller with its actuators.

    ``command`` reads the accepted state at ``time`` s and says what happens in the next ``dt`` s.
    """

    def command(self, time: float, dt: float) -> None: ...


class Callback:
    """What happens beside the simulation: saving, reporting, stopping."""

    def start(self, simulation: Simulation, end: float) -> None:
        """Called before the first step of a run that ends at ``end`` s."""

    def accepted(self, simulation: Simulation) -> None:
        """Called after every accepted step."""

    def finish(self, simulation: Simulation) -> None:
        """Called at the end of a run, however it ended."""


class Simulation:
    """A structure under its load models, marched through time.

    ``load_models`` stand in the order of ``structure.motions``; the ``commander`` is asked
    once before every step; ``probes`` have channels and nothing else. Where a step of
    ``time_step`` s finds no balance within ``iterations``, it is halved, ``halvings`` times
    at most. Raises InputError for a step larger than a model permits or for two channels of
    one name, and ConvergenceError where a step fails.
    """

    def __init__(
        self,
        structure: Structure,
        load_models: Mapping[str, LoadModel],
        time_step: float,
        *,
        commander: Commander | None = None,
        probes: Mapping[str, Probe] | None = None,
        iterations: int = 30,
        halvings: int = 3,
    ) -> None:
        self.structure, self.time_step = structure, time_step
        self.load_models = dict(load_models)
        self.iterations, self.halvings = iterations, halvings
        self.steps = 0  #: accepted so far
        self.stopped = ""  #: why the run is to end early
        self.probes = dict(probes or {})
        self.commander = commander
        self._undo: dict[str, np.ndarray] | None = {}  # what the step under way has commanded
        self._light = True  # whether that is little enough to be kept for every step
        self._committing = False  # whether a part has accepted a step that another has not
        commanding = {} if commander is None else {"control": commander}
        self._parts: dict[str, Part] = {"structure": structure, **self.load_models, **commanding}
        self._stateful: dict[str, Stateful] = {
            "structure": structure,
            **self.load_models,
            **commanding,
        }
        self._models = tuple(
            (name, model, motion)
            for (name, model), motion in zip(
                self.load_models.items(), structure.motions, strict=True
            )
        )
        self._check_steps()
        self.channels = self._unique_channels()
        self.coordinates = self._common_coordinates()

    @property
    def time(self) -> float:
        """Time of the accepted state, s: a whole number of steps, without drift."""
        return self.steps * self.time_step

    def run(self, end: float, callbacks: Sequence[Callback] = ()) -> None:
        """March to the step nearest to ``end`` s, or until something calls ``stop``."""
        last = round(end / self.time_step)
        started: list[Callback] = []
        try:
            for callback in callbacks:
                callback.start(self, last * self.time_step)
                started.append(callback)
            while self.steps < last and not self.stopped:
                self.advance()
                for callback in callbacks:
                    callback.accepted(self)
        finally:
            for callback in started:
                callback.finish(self)

    def stop(self, reason: str) -> None:
        """End the run after the present step; ``reason`` goes into the results."""
        self.stopped = reason

    def advance(self) -> None:
        """One step of ``time_step``, in smaller ones where it does not converge."""
        self._undo = self._commanded()
        if self.commander is not None:
            self.commander.command(self.time, self.time_step)
        self._step(self.time, self.time_step, self.halvings)
        self.steps += 1
        self._undo, self._committing = {}, False

    def record(self) -> Record:
        """Every channel of the accepted state."""
        values: Record = {}
        for part in self._parts.values():
            values.update(part.record())
        for probe in self.probes.values():
            values.update(probe.record(self.time))
        return values

    def state(self) -> dict[str, np.ndarray]:
        """Everything that the next step depends on, by ``part/name``."""
        return {"steps": np.array(self.steps), **self._state(self._stateful)}

    def accepted_state(self) -> dict[str, np.ndarray] | None:
        """``state`` at ``time``, also where a step was begun and has failed.

        None where the step got so far that it cannot be taken back.
        """
        if self._committing or self._undo is None:
            return None
        return {**self.state(), **self._undo}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take back what ``state`` gave; the run continues with the same bits."""
        self._restore(state)
        self._undo, self._committing = {}, False

    def _restore(self, state: Mapping[str, np.ndarray]) -> None:
        self.steps = int(state["steps"])
        for name, part in self._stateful.items():
            prefix = f"{name}/"
            part.restore(
                {key.removeprefix(prefix): v for key, v in state.items() if key.startswith(prefix)}
            )

    def _state(self, names: Iterable[str]) -> dict[str, np.ndarray]:
        parts = ((name, self._stateful[name].state()) for name in names)
        return {f"{name}/{key}": value for name, state in parts for key, value in state.items()}

    def _commanded(self) -> dict[str, np.ndarray] | None:
        """The state of all that a command changes; None once that is too large for every step."""
        if not self._light:
            return None
        state = self._state(name for name in ("structure", "control") if name in self._stateful)
        self._light = sum(value.nbytes for value in state.values()) < LARGEST_UNDO
        return state

    def _step(self, time: float, dt: float, halvings: int) -> None:
        try:
            self._balance(time, dt)
        except ConvergenceError as error:
            if halvings == 0 or isinstance(error, LoadsNotFiniteError):
                raise
            self.structure.reject(time)
            self._halve(time, 0.5 * dt, halvings - 1)
            return
        self._committing = True
        for _, model, motion in self._models:
            model.end_step(time + dt, motion)
        self.structure.accept()

    def _halve(self, time: float, dt: float, halvings: int) -> None:
        """Two steps of ``dt``, or none: where the second fails, the first is taken back."""
        accepted, committing = self.state(), self._committing
        try:
            self._step(time, dt, halvings)
            self._step(time + dt, dt, halvings)
        except ConvergenceError:
            self._restore(accepted)
            self._committing = committing
            raise

    def _balance(self, time: float, dt: float) -> None:
        for _, model, motion in self._models:
            model.begin_step(time, dt, motion)
        self.structure.predict(time, dt)
        for _ in range(self.iterations):
            loads = [self._loads(*entry, time + dt) for entry in self._models]
            if self.structure.balance(loads):
                return
        what = f"no balance of loads and motion in {self.iterations} iterations, dt = {dt:.3g} s"
        raise ConvergenceError("structure", what, "try a smaller time_step_s", time + dt)

    def _loads(self, name: str, model: LoadModel, motion: Motion, time: float) -> Loads:
        try:
            loads = model.loads(time, motion)
        except ConvergenceError as error:
            where = f"{name}, {error.where}"
            raise ConvergenceError(where, error.what, error.hint, error.time or time) from error
        bad = _first_not_finite(loads.force, loads.moment)
        if bad >= 0:
            what = f"the load on {_station(model, bad)} is not a number"
            raise LoadsNotFiniteError(name, what, time=time)
        return loads

    def _check_steps(self) -> None:
        for name, model in self.load_models.items():
            if self.time_step > model.largest_step:
                permitted = f"{name} permits at most {model.largest_step:.4g} s"
                raise InputError("time_step_s", f"{self.time_step:.4g} s is too large: {permitted}")

    def _described(self) -> Iterator[tuple[str, Described]]:
        yield from self._parts.items()
        yield from self.probes.items()

    def _unique_channels(self) -> tuple[Channel, ...]:
        owners: dict[str, str] = {}
        for owner, part in self._described():
            for channel in part.channels:
                if channel.name in owners:
                    both = f"{owners[channel.name]} and {owner}"
                    raise InputError("channels", f"{both} both have a channel {channel.name!r}")
                owners[channel.name] = owner
        return tuple(channel for _, part in self._described() for channel in part.channels)

    def _common_coordinates(self) -> dict[str, Array]:
        common: dict[str, Array] = {}
        for owner, part in self._described():
            for name, values in part.coordinates.items():
                if name in common and not np.array_equal(common[name], values):
                    raise InputError("channels", f"{owner} has a coordinate {name!r} of its own")
                common[name] = np.asarray(values)
        return common


class LoadsNotFiniteError(ConvergenceError):
    """A load is not a number: a smaller step will not help, the run ends."""


@njit(cache=True)
def _first_not_finite(force: Array, moment: Array) -> int:
    """Row of the first load (n,3) that is not finite, -1 if all are."""
    for i in range(force.shape[0]):
        if not np.isfinite(force[i].sum() + moment[i].sum()):
            return i
    return -1


def _station(model: LoadModel, row: int) -> str:
    """The station in a row of a load model's loads, in words."""
    for stations in model.stations:
        if row < len(stations):
            if len(stations) == 1:
                return stations.part
            return f"{stations.part} at {stations.span[row]:.1%} of its span"
        row -= len(stations)
    return f"row {row}"
