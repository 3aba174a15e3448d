"""The flexible machine: beams, bodies and joints of a turbine as the structure of the time loop.

Load models see their stations ride on the frames; what they answer goes back to the frames
by the transpose. One ``balance`` is one step of Newton's method of the whole structure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from galerna.contract import Array, Channel, Loads, Stations
from galerna.errors import InputError, did_you_mean
from galerna.structure.attachment import Attachment
from galerna.structure.integrators import Integrator, Scheme, Tolerance, Trial
from galerna.structure.pairs import Integers
from galerna.structure.system import ARRAYS, Forces, State
from galerna.structure.turbine import TurbineOptions, TurbineSystem, turbine_system
from galerna.turbine.geometry import part_frames
from galerna.turbine.model import Turbine


class PitchPath:
    """A blade's pitch angle over one step, rad: straight from where it was to where it goes."""

    def __init__(self, angle: float) -> None:
        self.start = self.end = angle
        self.time, self.duration = 0.0, 0.0

    def __call__(self, time: float) -> float:
        share = (time - self.time) / self.duration if self.duration else 1.0
        return self.start + min(max(share, 0.0), 1.0) * (self.end - self.start)

    def go(self, angle: float, time: float, duration: float) -> None:
        """Reach ``angle`` rad ``duration`` s after ``time``."""
        self.start, self.end, self.time, self.duration = self.end, angle, time, duration


def attach(turbine: Turbine, system: TurbineSystem, group: Sequence[Stations]) -> Attachment:
    """The stations of one load model on the frames of the structure, as it was described.

    Raises InputError for a part that the structure does not have.
    """
    placed = [_placed(turbine, system, stations) for stations in group]
    ends, fraction, position, rotation = (
        np.concatenate(column) for column in zip(*placed, strict=True)
    )
    return Attachment(system.system.initial_state(), ends, fraction, position, rotation)


def _placed(
    turbine: Turbine, system: TurbineSystem, stations: Stations
) -> tuple[Integers, Array, Array, Array]:
    """Frames (n,2), fraction (n,) between them, position and rotation of one part's stations."""
    part = stations.part
    if part not in system.parts:
        hint = did_you_mean(part, system.parts)
        raise InputError("stations", f"the turbine {turbine.name!r} has no part {part!r}", hint)
    nodes, span = system.parts[part], system.span[part]
    last = len(span) - 1
    left = np.clip(np.searchsorted(span, stations.span, side="right") - 1, 0, max(last - 1, 0))
    right = np.minimum(left + 1, last)
    width = np.where(right > left, span[right] - span[left], 1.0)
    fraction = np.where(right > left, (stations.span - span[left]) / width, 0.0)
    ends = np.stack([nodes[left], nodes[right]], axis=1)
    origin, axes = system.places[part]
    position, rotation = part_frames(turbine, part, stations.span)
    return ends, fraction, origin + position @ axes.T, axes @ rotation


class FlexibleMachine:
    """A turbine's structure under its load models; see ``simulation.Structure``.

    ``stations`` holds the stations of every load model. The blades pitch along ``pitch``, one
    path each. Raises InputError for a part that the turbine does not have.
    """

    channels: tuple[Channel, ...] = ()

    def __init__(
        self,
        turbine: Turbine,
        stations: Sequence[Sequence[Stations]],
        options: TurbineOptions | None = None,
        *,
        scheme: Scheme | None = None,
        tolerance: Tolerance | None = None,
    ) -> None:
        self.coordinates: Mapping[str, Array] = {}
        self.pitch = tuple(PitchPath(0.0) for _ in range(turbine.number_of_blades))
        options = replace(options or TurbineOptions(), pitch_motion=self.pitch)
        self.parts = turbine_system(turbine, options)
        self.system = self.parts.system
        self.integrator = Integrator(
            self.system, scheme or Scheme.generalized_alpha(), tolerance or Tolerance()
        )
        self._riders = [attach(turbine, self.parts, group) for group in stations]
        self.motions = tuple(riders.motion for riders in self._riders)
        self._forces = Forces.none(len(self.system))
        self.start(self.system.initial_state())

    def start(self, state: State) -> None:
        """Take a state as accepted: an equilibrium, or one that was saved."""
        self.accepted: State = state
        self._follow(state)

    def set_shaft_torque(self, torque: float) -> None:
        """Torque N m that drives the low-speed shaft; a generator's is negative."""
        self.system.set_torque("main bearing", torque)

    def predict(self, time: float, dt: float) -> None:
        """Begin a step of ``dt`` s from the accepted state."""
        self._trial: Trial = self.integrator.begin(self.accepted, dt)
        self._follow(self._trial.state)

    def balance(self, loads: Sequence[Loads]) -> bool:
        """Correct the trial under the loads; True where that did not move it any more."""
        if self._trial.correct(self.forces(loads)):
            return True
        self._follow(self._trial.state)
        return False

    def accept(self) -> None:
        """Commit the step."""
        self.start(self._trial.settled())

    def reject(self, time: float) -> None:
        """Return to the accepted state."""
        self._follow(self.accepted)

    def forces(self, loads: Sequence[Loads]) -> Forces:
        """Loads on the stations as loads on the frames; the array is used again."""
        self._forces.follower[:] = 0.0
        for riders, load in zip(self._riders, loads, strict=True):
            riders.add_loads(load, self._forces.follower)
        return self._forces

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted state."""
        return {}

    def state(self) -> dict[str, np.ndarray]:
        """All that the next step depends on."""
        arrays = {name: getattr(self.accepted, name).copy() for name in ARRAYS}
        return {"time": np.array(self.accepted.time), **arrays}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.start(State(float(state["time"]), *(state[name].copy() for name in ARRAYS)))

    def _follow(self, state: State) -> None:
        for riders in self._riders:
            riders.follow(state)
