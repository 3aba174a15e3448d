"""What a controller sees of the machine and what it asks of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from galerna.contract import Array


@dataclass(slots=True)
class Measurements:
    """The machine as its sensors show it, in SI and radians.

    ``generator_speed`` is at the generator's own shaft, ``generator_torque`` N m what acts there
    now. ``pitch`` (b,) per blade. ``yaw_error`` is the nacelle's yaw minus the wind's direction,
    ``wind_speed`` the horizontal one at the hub. ``root_moments`` (b,2) N m out of plane and in
    plane at the blades' roots, positive as thrust and driving torque bend the blades;
    ``tower_top_acceleration`` (3,) m/s2 and ``nacelle_angular_acceleration`` (3,) rad/s2 in
    nacelle axes; ``platform`` (6,) m and rad with its velocity and acceleration.
    """

    time: float
    rotor_speed: float
    generator_speed: float
    generator_torque: float
    electrical_power: float
    pitch: Array
    azimuth: float
    yaw: float = 0.0
    yaw_error: float = 0.0
    wind_speed: float = 0.0
    root_moments: Array = field(default_factory=lambda: np.zeros((3, 2)))
    tower_top_acceleration: Array = field(default_factory=lambda: np.zeros(3))
    platform: Array = field(default_factory=lambda: np.zeros(6))
    platform_velocity: Array = field(default_factory=lambda: np.zeros(6))
    platform_acceleration: Array = field(default_factory=lambda: np.zeros(6))
    nacelle_angular_acceleration: Array = field(default_factory=lambda: np.zeros(3))


@dataclass(slots=True)
class Demands:
    """What a controller asks for: pitch rad per blade, generator torque N m, yaw rate rad/s.

    One pitch angle will do for all blades. ``brake`` N m, from 0 on, is what the brake on the
    low-speed shaft grips with.
    """

    pitch: Array
    generator_torque: float
    yaw_rate: float = 0.0
    brake: float = 0.0


@runtime_checkable
class Controller(Protocol):
    """Any object with this one method can command the machine.

    ``sample_time`` s between calls, where the object has it; otherwise every step. What the next
    demand depends on is in ``state``, where the object has ``state`` and ``restore``: a run whose
    controller does not have them cannot be resumed. With ``channels`` and ``record`` it shows
    states of its own in the results.
    """

    def demands(self, measured: Measurements) -> Demands: ...


class Stateful(Protocol):
    """A part of a controller that remembers something."""

    def state(self) -> dict[str, np.ndarray]: ...
    def restore(self, state: Mapping[str, np.ndarray]) -> None: ...
