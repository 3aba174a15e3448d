"""From a case to the water that its platform floats in, and to how it floats at rest."""

from __future__ import annotations

from dataclasses import dataclass

from galerna.case import LoadedCase
from galerna.contract import Array, LoadModel
from galerna.coupling.equilibrium import SteadyMachine
from galerna.coupling.floating import (
    PASSES,
    SETTLED,
    Burden,
    Pose,
    WaterAtRest,
    burden_of,
)
from galerna.errors import ConvergenceError
from galerna.simulation import Probe
from galerna.structure.frames import roll_pitch_yaw, turned_by
from galerna.turbine.model import Turbine


@dataclass(eq=False)
class Floating:
    """A platform that floats: ``pose`` is where it is held while its machine is trimmed.

    ``displaced`` (6,) m and rad is added to the equilibrium at the start: surge, sway, heave,
    roll, pitch, yaw.
    """

    water: WaterAtRest
    pose: Pose
    displaced: Array
    burden: Burden | None = None

    def settle(self, machine: SteadyMachine, rotor_speed: float, pitch: Array) -> None:
        """Hold a machine where it floats at a rotor speed rad/s and a pitch (b,) rad.

        Raises ConvergenceError where the platform and what it carries find no balance.
        """
        for _ in range(PASSES):
            states = machine.at(rotor_speed, pitch).states
            self.burden = burden_of(machine.machine, states, self.pose)
            found = self.water.equilibrium(self.burden, self.pose, machine.system.gravity)
            distance = found.distance(self.pose)
            machine.carry(self.pose, found)
            if distance < SETTLED:
                return
        what = f"platform and rotor find no balance: the last pass moved it by {distance:.3g}"
        raise ConvergenceError("platform", what, "start it with another operation")

    def displace(self, machine: SteadyMachine) -> None:
        """Take the machine from its equilibrium to where it starts."""
        if self.displaced.any():
            machine.carry(self.pose, displaced(self.pose, self.displaced))


def displaced(pose: Pose, by: Array) -> Pose:
    """A pose with displacements m and angles rad (6,) added to its own."""
    return Pose(pose.position + by[:3], turned_by(*(roll_pitch_yaw(pose.rotation) + by[3:])))


@dataclass(frozen=True, eq=False)
class Afloat:
    """The water of a case: its load models, what shows the waves, and the platform in it.

    ``floating`` is None where the platform is moved as is prescribed.
    """

    models: dict[str, LoadModel]
    probe: Probe
    floating: Floating | None


def build_water(case: LoadedCase, turbine: Turbine) -> Afloat:
    """The water of a case that has a sea."""
    raise NotImplementedError
