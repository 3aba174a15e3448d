"""What a user should see of a machine afloat before a long run: balance, frequencies, doubts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array, Loads
from galerna.coupling.equilibrium import turn
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.floating import Burden, Pose, WaterAtRest, at_rest
from galerna.coupling.floating_modes import FloatingMode, floating_modes
from galerna.hydro.rigid import MODES
from galerna.structure import TurbineOptions
from galerna.structure.frames import roll_pitch_yaw
from galerna.structure.statics import static_equilibrium
from galerna.structure.system import Forces, State
from galerna.turbine.model import Turbine
from galerna.units import DEG

if TYPE_CHECKING:
    from galerna.hydro.database import HydroDatabase

IMBALANCE = 0.005  #: of the weight, between weight, buoyancy and lines where it was described
LEAN, SINK = 1.0 * DEG, 0.5  #: rad and m, at rest without wind
UNITS = ("m", "m", "m", "deg", "deg", "deg")


@dataclass(frozen=True, eq=False)
class FloatingReport:
    """A platform at rest under its burden at ``pose``, and where it was described, at ``place``.

    ``upright`` is where it would float without the wind.
    """

    water: WaterAtRest
    burden: Burden
    pose: Pose
    place: Pose
    upright: Pose
    gravity: Array

    @classmethod
    def of(cls, water: WaterAtRest, burden: Burden, pose: Pose, gravity: Array) -> FloatingReport:
        """The report of an equilibrium; raises InputError where it capsizes without wind."""
        calm = Burden(burden.mass, burden.center, np.zeros(6))
        place = Pose(water.place.position.copy(), water.place.rotation.copy())
        return cls(water, burden, pose, place, water.equilibrium(calm, place, gravity), gravity)

    def lines(self) -> Iterator[tuple[str, str]]:
        """Pairs of heading and text."""
        yield "floats at", _in_words(self.pose, self.place)
        yield "", f"without wind at {_in_words(self.upright, self.place)}"
        weight = self.burden.mass * float(np.linalg.norm(self.gravity))
        yield "forces", f"weight: {weight / 1e6:.4f} MN, {self.burden.mass:.6g} kg"
        for name, load in self.water.loads(self.place).items():
            force, moment = load.force.sum(axis=0), load.moment.sum(axis=0)
            if np.abs(force).max() > 1.0 or np.abs(moment).max() > 1.0:
                yield "", f"{name}, as described: {_force_in_words(force, moment)}"
        force, moment = self.burden.wrench[:3], self.burden.wrench[3:]
        yield "", f"wind and rotor: {_force_in_words(force, moment)}"
        for name, model in self.water.models.items():
            for line in getattr(model, "describe", lambda motion: ())(self.pose.motion):
                yield name, line

    def doubts(self) -> Iterator[str]:
        """A sentence for each thing that is hardly meant."""
        weight = self.burden.mass * float(np.linalg.norm(self.gravity))
        upward = sum(float(load.force[:, 2].sum()) for load in self.loads_at_place())
        excess = upward / weight - 1.0
        if abs(excess) > IMBALANCE:
            yield (
                f"buoyancy less the pull of the lines is {upward / 1e6:.5g} MN, the weight "
                f"{weight / 1e6:.5g} MN: {excess:+.2%}; mass, ballast or volume may be off"
            )
        moved = self.upright.position - self.place.position
        roll, pitch, _ = roll_pitch_yaw(self.upright.rotation)
        if abs(moved[2]) > SINK:
            yield f"without wind it floats {moved[2]:+.3g} m from where it was described"
        for name, angle in (("roll", roll), ("pitch", pitch)):
            if abs(angle) > LEAN:
                yield f"without wind it leans by {angle / DEG:.3g} deg in {name}"

    def loads_at_place(self) -> list[Loads]:
        """The water's loads where the platform was described."""
        return list(self.water.loads(self.place).values())


def modes_of(
    turbine: Turbine, options: TurbineOptions, water: WaterAtRest, burden: Burden,
    pose: Pose, database: HydroDatabase,
) -> list[FloatingMode]:  # fmt: skip
    """The platform's modes about a pose in which it floats under a burden, its rotor held."""
    held = replace(options, rotor_motion=None, rotor="locked", pitch_motion=None, yaw_motion=None)
    models = list(water.models.values())
    machine = FlexibleMachine(turbine, [model.stations for model in models], held)
    node = int(machine.parts.parts["platform"][0])
    first = machine.accepted.copy()
    everything = np.arange(1, len(machine.system))
    turn(first, everything, first.position[node].copy(), pose.rotation)
    first.position[everything] += pose.position - first.position[node]

    def loads(state: State) -> Forces:
        machine.start(state)
        forces = machine.forces(
            [at_rest(model, at) for model, at in zip(models, machine.motions, strict=True)]
        )
        forces.dead[node] += burden.wrench
        return forces

    state = static_equilibrium(machine.system, first, loads, tolerance=1e-6)
    loads(state)
    return floating_modes(machine, state, machine.loads, database, water.axes(pose))


def modes_in_words(modes: list[FloatingMode]) -> str:
    """Names and frequencies."""
    order = sorted(modes, key=lambda mode: MODES.index(mode.name))
    return ", ".join(f"{mode.name} {mode.frequency:.4g}" for mode in order) + " Hz"


def _in_words(pose: Pose, place: Pose) -> str:
    shift = pose.position - place.position
    values = np.concatenate([shift, roll_pitch_yaw(pose.rotation) / DEG])
    pairs = zip(MODES, values, UNITS, strict=True)
    return ", ".join(f"{name} {value:z.3f} {unit}" for name, value, unit in pairs)


def _force_in_words(force: Array, moment: Array) -> str:
    pushes = ", ".join(f"{value / 1e6:z.4f}" for value in force)
    turns = ", ".join(f"{value / 1e6:z.2f}" for value in moment)
    return f"{pushes} MN and {turns} MN m"
