"""What the shaft and the nacelle show."""

from __future__ import annotations

import numpy as np

from galerna.contract import Array
from galerna.coupling import channels as c
from galerna.coupling.snapshot import Snapshot, cross, named, true_acceleration, turned
from galerna.structure.frames import rotation_about
from galerna.structure.turbine import TurbineSystem, generator_inertias
from galerna.turbine.model import Turbine


class ShaftSensors:
    """The rotor's load on the shaft's tip, which is the hub's centre, and the nacelle's sensor."""

    channels = c.SHAFT + c.NACELLE

    def __init__(self, turbine: Turbine, parts: TurbineSystem) -> None:
        system, drivetrain = parts.system, turbine.drivetrain
        self.hub, self.nacelle = system.names.index("hub"), system.names.index("nacelle")
        flexible = "shaft" in system.pair_names
        self._pair = system.pair("shaft" if flexible else "main bearing")
        # a rigid shaft's hub carries the generator, which the shaft's load turns
        self._generator = 0.0 if flexible else generator_inertias(drivetrain)[0]
        self._tilted = rotation_about(1, turbine.nacelle.tilt)
        self._sensor = np.array([0.0, 0.0, turbine.nacelle.shaft_height])

    def record(self, at: Snapshot, rotor_speed: float) -> dict[str, float | Array]:
        """All channels; ``rotor_speed`` rad/s is the hub's in the nacelle."""
        load = self._rotor_load(at)
        shaft_axes = at.state.rotation[self.nacelle] @ self._tilted
        fixed = turned(at.state.rotation[self.hub].T @ shaft_axes, load)
        rows = np.concatenate([load, fixed[[1, 2, 4, 5]], [load[3] * rotor_speed]])
        return {**named(c.SHAFT, rows), **named(c.NACELLE, self._acceleration(at))}

    def _rotor_load(self, at: Snapshot) -> Array:
        """Load (6,) of the rotor on the shaft at the hub's centre, in the hub's axes."""
        load = at.node_wrench[self._pair, 6:].copy()
        rate = at.state.acceleration[self.hub, 3]
        x, y, z = at.state.velocity[self.hub, 3:]
        load[3:] += self._generator * np.array([rate, x * z, -x * y])
        return load

    def _acceleration(self, at: Snapshot) -> Array:
        """Acceleration (3,) m/s2 on the shaft above the yaw axis, in the shaft's axes."""
        spin, rate = at.state.velocity[self.nacelle, 3:], at.state.acceleration[self.nacelle, 3:]
        arm = self._sensor
        sensed = true_acceleration(at.state, self.nacelle)
        sensed = sensed + cross(rate, arm) + cross(spin, cross(spin, arm))
        return sensed @ self._tilted
