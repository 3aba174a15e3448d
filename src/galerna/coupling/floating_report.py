"""What a user should see of a machine afloat before a long run: balance, frequencies, doubts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from galerna.contract import Array, Loads
from galerna.coupling.floating import DIRECTIONS, Burden, Pose, WaterAtRest
from galerna.coupling.floating_modes import FloatingMode, floating_modes
from galerna.structure.frames import roll_pitch_yaw
from galerna.units import DEG

if TYPE_CHECKING:
    from galerna.coupling.flexible import FlexibleMachine
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
        yield "without wind", _in_words(self.upright, self.place)
        weight = self.burden.mass * float(np.linalg.norm(self.gravity))
        yield "weight", f"{weight / 1e6:.6g} MN, {self.burden.mass:.6g} kg"
        for name, load in self.water.loads(self.place).items():
            yield f"{name} at rest", _force_in_words(load)
        force, moment = self.burden.wrench[:3] / 1e3, self.burden.wrench[3:] / 1e6
        shown = ", ".join(f"{f:z.4g}" for f in force)
        turning = ", ".join(f"{m:z.4g}" for m in moment)
        yield "wind and rotor", f"{shown} kN; {turning} MN m about the reference point"
        for name, model in self.water.models.items():
            for line in getattr(model, "describe", lambda pose: ())(self.pose.motion):
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
    machine: FlexibleMachine, loads: list[Loads], database: HydroDatabase
) -> list[FloatingMode]:
    """The platform's natural frequencies about where a machine is, its rotor at rest."""
    state = machine.accepted.copy()
    state.velocity[:] = 0.0
    state.acceleration[:] = 0.0
    return floating_modes(machine, state, loads, database)


def modes_in_words(modes: list[FloatingMode]) -> str:
    """Names and frequencies."""
    order = sorted(modes, key=lambda mode: DIRECTIONS.index(mode.name))
    return ", ".join(f"{mode.name} {mode.frequency:.4g}" for mode in order) + " Hz"


def _in_words(pose: Pose, place: Pose) -> str:
    shift = pose.position - place.position
    values = np.concatenate([shift, roll_pitch_yaw(pose.rotation) / DEG])
    pairs = zip(DIRECTIONS, values, UNITS, strict=True)
    return ", ".join(f"{name} {value:z.3f} {unit}" for name, value, unit in pairs)


def _force_in_words(load: Loads) -> str:
    force, moment = load.force.sum(axis=0) / 1e6, load.moment.sum(axis=0) / 1e6
    shown = ", ".join(f"{value:z.5g}" for value in force)
    turning = ", ".join(f"{value:z.5g}" for value in moment)
    return f"{shown} MN; {turning} MN m"
