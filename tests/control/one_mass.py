"""A turbine as one turning mass under its own rotor's torque: minutes of control in a second."""

from __future__ import annotations

from bisect import bisect
from dataclasses import dataclass
from functools import lru_cache
from math import pi

import numpy as np

from galerna.aero.bem.surface import performance_surface
from galerna.control.actuators import PitchActuator
from galerna.control.baseline import BaselineController, BaselineSettings
from galerna.control.brake import Brake
from galerna.control.drivetrain import PowerTrain
from galerna.control.interface import Controller, Measurements
from galerna.coupling.gains import drive_inertia
from galerna.coupling.strategy import completed
from galerna.turbine import load
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY, DEG

RATIOS = np.linspace(-1.0, 3.0, 13), np.linspace(3.25, 16.0, 52), [20.0, 30.0]
RATIOS = np.concatenate(RATIOS).tolist()
PITCHES = np.concatenate([np.linspace(-2.0, 30.0, 65), np.linspace(32.0, 92.0, 16)])
PITCHES = (PITCHES * DEG).tolist()
DT = 0.05


@lru_cache
def reference(name: str) -> Turbine:
    """A built-in turbine, complete."""
    return completed(load(name))


@lru_cache
def torque_surface(turbine: Turbine) -> list[list[float]]:
    """Torque coefficient over tip-speed ratio and pitch."""
    return performance_surface(turbine, RATIOS, PITCHES)["torque_coefficient"].values.tolist()


def place(grid: list[float], value: float) -> tuple[int, float]:
    """The cell of a grid that a value stands in, and how far along."""
    i = min(max(bisect(grid, value) - 1, 0), len(grid) - 2)
    return i, (min(max(value, grid[0]), grid[-1]) - grid[i]) / (grid[i + 1] - grid[i])


@dataclass
class History:
    """What happened, (n,) each: SI, the torque at the generator, the power into the grid."""

    time: np.ndarray
    speed: np.ndarray
    pitch: np.ndarray
    torque: np.ndarray
    power: np.ndarray
    mode: list[str]


class OneMass:
    """Rotor, drivetrain and generator in one inertia under a controller."""

    def __init__(
        self, turbine: Turbine, controller: Controller, speed: float, pitch: float
    ) -> None:
        self.turbine, self.controller = turbine, controller
        self.speed, self.pitch = speed, np.full(turbine.number_of_blades, pitch)
        self.inertia, self.surface = drive_inertia(turbine), torque_surface(turbine)
        self.train = PowerTrain.of(turbine.drivetrain)
        self.actuator = PitchActuator(0.0, rate=turbine.control.maximum_pitch_rate)
        self.brake, self.torque, self.time = Brake(self.inertia), 0.0, 0.0

    def aerodynamic_torque(self, wind: float) -> float:
        radius, c = self.turbine.rotor_radius, self.surface
        i, s = place(RATIOS, self.speed * radius / wind)
        j, t = place(PITCHES, float(self.pitch.mean()))
        low = c[i][j] + t * (c[i][j + 1] - c[i][j])
        high = c[i + 1][j] + t * (c[i + 1][j + 1] - c[i + 1][j])
        coefficient = low + s * (high - low)
        return 0.5 * AIR_DENSITY * pi * radius**3 * wind**2 * coefficient

    def measured(self, wind: float) -> Measurements:
        return Measurements(
            time=self.time,
            rotor_speed=self.speed,
            generator_speed=self.train.generator_speed(self.speed),
            generator_torque=self.torque,
            electrical_power=self.train.electrical_power(self.torque, self.speed),
            pitch=self.pitch,
            azimuth=0.0,
            wind_speed=wind,
        )

    def step(self, wind: float) -> None:
        demands = self.controller.demands(self.measured(wind))
        self.torque = demands.generator_torque
        self.pitch = self.actuator.after(self.pitch, demands.pitch, DT)
        braking = self.train.shaft_torque(self.torque, self.speed)
        braking += self.brake.torque(demands.brake, self.speed, DT)
        self.speed += DT / self.inertia * (self.aerodynamic_torque(wind) - braking)
        self.time += DT

    def run(self, seconds: float, wind) -> History:
        """March under a wind m/s, a number or a function of time."""
        rows, modes = [], []
        for _ in range(round(seconds / DT)):
            self.step(wind(self.time) if callable(wind) else wind)
            power = self.train.electrical_power(self.torque, self.speed)
            rows.append((self.time, self.speed, self.pitch[0], self.torque, power))
            modes.append(getattr(self.controller, "mode", ""))
        return History(*np.array(rows).T, modes)


def in_operation(name: str, wind: float, **settings) -> OneMass:
    """A turbine near its point of operation, under the baseline controller."""
    turbine = reference(name)
    controller = BaselineController(turbine, BaselineSettings(**settings))
    control, radius = turbine.control, turbine.rotor_radius
    speed = (control.optimal_tip_speed_ratio or 8.0) * wind / radius
    speed = float(np.clip(speed, 1.02 * control.minimum_rotor_speed, control.rated_rotor_speed))
    above = max(wind - (control.rated_wind_speed or 11.0), 0.0)
    return OneMass(turbine, controller, speed, 1.6 * DEG * above)


def at_rest(name: str, mode: str, **settings) -> OneMass:
    """A turbine that stands still, blades feathered."""
    turbine = reference(name)
    controller = BaselineController(turbine, BaselineSettings(mode=mode, **settings))
    return OneMass(turbine, controller, 0.0, 90.0 * DEG)
