"""The controller in the loop: what it measures, what it asks for, what the actuators make of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from galerna.contract import Array, Channel
from galerna.control.actuators import PitchActuator
from galerna.control.drivetrain import PowerTrain
from galerna.control.interface import Controller, Demands, Measurements
from galerna.coupling.flexible import FlexibleMachine
from galerna.errors import InputError
from galerna.units import DEG, RPM

CHANNELS = (
    Channel("generator_speed", "rad/s", "generator speed", (), "GenSpeed", "rpm", 1.0 / RPM),
    Channel("generator_torque", "N m", "generator torque", (), "GenTq", "kN-m", 1e-3),
    Channel("electrical_power", "W", "electrical power", (), "GenPwr", "kW", 1e-3),
    Channel("pitch_demand", "rad", "demanded blade pitch", ("blade",), "BlPitchC{blade}", "deg",
            1.0 / DEG),
)  # fmt: skip


class ControlLoop:
    """A controller that commands a machine; see ``simulation.Commander``.

    ``hub_wind`` gives the undisturbed wind (3,) m/s at the hub at a time. The controller is
    asked every ``sample_time`` s, or before every step.
    """

    channels = CHANNELS

    def __init__(
        self,
        machine: FlexibleMachine,
        controller: Controller,
        train: PowerTrain,
        actuator: PitchActuator,
        hub_wind: Callable[[float], Array],
        sample_time: float | None = None,
    ) -> None:
        self.machine, self.controller = machine, controller
        self._train, self._actuator, self._hub_wind = train, actuator, hub_wind
        self._sample_time = sample_time
        self.coordinates: Mapping[str, Array] = {}
        self._next = -np.inf
        self.demands = Demands(machine.pitch_angles(0.0), 0.0)

    def command(self, time: float, dt: float) -> None:
        """Ask the controller if it is time, and set the machine for the step from ``time`` s."""
        if time >= self._next - 1e-9:
            self.demands = self.controller.demands(self.measure(time))
            self._check()
            self._next = time + (self._sample_time or 0.0)
        pitch = self._actuator.after(self.machine.pitch_angles(time), self.demands.pitch, dt)
        self.machine.go_pitch(pitch, time, dt)
        brake = self._train.shaft_torque(self.demands.generator_torque, self.machine.drive_speed)
        brake += np.sign(self.machine.drive_speed) * self.demands.brake
        self.machine.set_shaft_torque(-brake)

    def measure(self, time: float) -> Measurements:
        """What the sensors show of the accepted state."""
        machine, torque = self.machine, self.demands.generator_torque
        wind = self._hub_wind(time)
        return Measurements(
            time=time,
            rotor_speed=machine.rotor_speed,
            generator_speed=self._train.generator_speed(machine.drive_speed),
            generator_torque=torque,
            electrical_power=self._train.electrical_power(torque, machine.drive_speed),
            pitch=machine.pitch_angles(time),
            azimuth=machine.azimuth,
            yaw=machine.yaw,
            yaw_error=machine.yaw - float(np.arctan2(wind[1], wind[0])),
            wind_speed=float(np.linalg.norm(wind)),
        )

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted state."""
        torque, speed = self.demands.generator_torque, self.machine.drive_speed
        return {
            "generator_speed": self._train.generator_speed(speed),
            "generator_torque": torque,
            "electrical_power": self._train.electrical_power(torque, speed),
            "pitch_demand": self.demands.pitch.copy(),
        }

    def state(self) -> dict[str, np.ndarray]:
        """The demands that hold, and what the controller remembers."""
        own = {
            "next": np.array(self._next),
            "pitch": self.demands.pitch.copy(),
            "others": np.array(
                [self.demands.generator_torque, self.demands.yaw_rate, self.demands.brake]
            ),
        }
        remembered: dict[str, np.ndarray] = getattr(self.controller, "state", dict)()
        return {**own, **{f"controller/{name}": value for name, value in remembered.items()}}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._next = float(state["next"])
        self.demands = Demands(state["pitch"].copy(), *state["others"].tolist())
        prefix = "controller/"
        remembered = {k.removeprefix(prefix): v for k, v in state.items() if k.startswith(prefix)}
        if remembered:
            self.controller.restore(remembered)  # type: ignore[attr-defined]

    def close(self) -> None:
        """Let go of what the controller holds, where it holds something."""
        close: Callable[[], None] | None = getattr(self.controller, "close", None)
        if close is not None:
            close()

    @property
    def notices(self) -> Sequence[str]:
        """What the controller has to say after a run."""
        return tuple(getattr(self.controller, "notices", ()))

    def _check(self) -> None:
        demands = self.demands
        values = [*demands.pitch, demands.generator_torque, demands.yaw_rate, demands.brake]
        if len(demands.pitch) != len(self.machine.pitch):
            what = f"{len(demands.pitch)} pitch angles for {len(self.machine.pitch)} blades"
            raise InputError("control", what)
        if not np.isfinite(values).all():
            raise InputError("control", f"the controller asks for {demands}", "it must be numbers")
