"""The drivetrain between rotor and grid: gear ratio, losses of gearbox and generator.

Friction takes its share whichever way the power flows: what comes out is what goes in times
the efficiency.
"""

from __future__ import annotations

from dataclasses import dataclass

from galerna.turbine.model import Drivetrain


@dataclass(frozen=True)
class PowerTrain:
    """Speeds, torques and powers on both sides of the gearbox and behind the generator."""

    gear_ratio: float = 1.0
    gearbox_efficiency: float = 1.0
    generator_efficiency: float = 1.0

    @classmethod
    def of(cls, drivetrain: Drivetrain) -> PowerTrain:
        """The drivetrain of a turbine."""
        return cls(
            drivetrain.gear_ratio, drivetrain.gearbox_efficiency, drivetrain.generator_efficiency
        )

    def generator_speed(self, rotor_speed: float) -> float:
        """Speed rad/s of the generator's shaft."""
        return self.gear_ratio * rotor_speed

    def shaft_torque(self, generator_torque: float, rotor_speed: float) -> float:
        """Torque N m that brakes the low-speed shaft under a torque on the generator's."""
        torque = self.gear_ratio * generator_torque
        driven = torque * rotor_speed >= 0.0
        return torque / self.gearbox_efficiency if driven else torque * self.gearbox_efficiency

    def generator_torque(self, shaft_torque: float) -> float:
        """Torque N m on the generator's shaft that brakes a driven low-speed shaft by so much."""
        return shaft_torque * self.gearbox_efficiency / self.gear_ratio

    def electrical_power(self, generator_torque: float, rotor_speed: float) -> float:
        """Power W into the grid; negative where the generator drives the rotor."""
        power = generator_torque * self.generator_speed(rotor_speed)
        efficiency = self.generator_efficiency
        return power * efficiency if power >= 0.0 else power / efficiency
