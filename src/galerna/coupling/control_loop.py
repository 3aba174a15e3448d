"""The controller in the loop: what it measures, what it asks for, what the actuators make of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import floor
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array, Channel
from galerna.control.actuators import PitchActuator, lagged
from galerna.control.brake import Brake
from galerna.control.drivetrain import PowerTrain
from galerna.control.external import ExternalController
from galerna.control.interface import Controller, Demands, Measurements
from galerna.control.python_controller import (
    ask,
    blamed,
    channels_of,
    controller_name,
    record_of,
    sample_time_of,
    state_of,
)
from galerna.control.yawing import wrapped
from galerna.coupling.flexible import FlexibleMachine
from galerna.errors import ControllerError
from galerna.units import DEG, RPM

CHANNELS = (
    Channel("generator_speed", "rad/s", "generator speed", (), "GenSpeed", "rpm", 1.0 / RPM),
    Channel("generator_torque", "N m", "generator torque", (), "GenTq", "kN-m", 1e-3),
    Channel("electrical_power", "W", "electrical power", (), "GenPwr", "kW", 1e-3),
    Channel("drivetrain_losses", "W", "power lost in gearbox and generator"),
    Channel("pitch_demand", "rad", "demanded blade pitch", ("blade",), "BlPitchC{blade}", "deg",
            1.0 / DEG),
    Channel("torque_demand", "N m", "demanded generator torque"),
    Channel("brake_torque", "N m", "torque of the brake at the low-speed shaft"),
    Channel("yaw_rate_demand", "rad/s", "demanded yaw rate"),
    Channel("yaw_error", "rad", "nacelle yaw minus wind direction at the hub"),
)  # fmt: skip
CLOCK_TOLERANCE = 1e-9  #: s


class ControlLoop:
    """A controller that commands a machine; see ``simulation.Commander``.

    ``hub_wind`` gives the undisturbed wind (3,) m/s at the hub at a time. The controller is
    asked every ``sample_time`` s, or its own, or before every step, and its demands hold until it
    is asked again. ``torque_lag`` s is the generator's time constant; ``held_inertia`` kg m2 is
    what the brake holds.
    """

    def __init__(
        self,
        machine: FlexibleMachine,
        controller: Controller,
        train: PowerTrain,
        actuator: PitchActuator,
        hub_wind: Callable[[float], Array],
        sample_time: float | None = None,
        *,
        torque_lag: float = 0.0,
        held_inertia: float = 1.0,
    ) -> None:
        self.machine, self.controller = machine, controller
        self._train, self._actuator, self._hub_wind = train, actuator, hub_wind
        self._torque_lag, self._brake = torque_lag, Brake(held_inertia)
        self._sample_time = sample_time or sample_time_of(controller)
        self.coordinates: Mapping[str, Array] = {}
        self._own = channels_of(controller)
        self.channels: tuple[Channel, ...] = (*CHANNELS, *self._own)
        self._next = -np.inf
        self.demands = Demands(machine.pitch_angles(0.0), 0.0)
        self._held = self.demands  # in the last step: these, but for what was overridden
        self.torque = np.nan  #: N m that the generator gives
        self._braking = 0.0  # N m
        self._once: dict[str, Any] = {}
        self._measured: Measurements | None = None

    def command(self, time: float, dt: float) -> None:
        """Ask the controller if it is time, and set the machine for the step from ``time`` s."""
        self._held = demands = self._demanded(time)
        machine, speed = self.machine, self.machine.drive_speed
        pitch = self._actuator.after(machine.pitch_angles(time), demands.pitch, dt)
        machine.go_pitch(pitch, time, dt)
        if demands.yaw_rate:
            machine.go_yaw(machine.yaw_drive(time) + demands.yaw_rate * dt, time, dt)
        started = not np.isnan(self.torque)
        before = self.torque if started else demands.generator_torque
        self.torque = lagged(demands.generator_torque, before, self._torque_lag, dt)
        self._braking = self._brake.torque(demands.brake, speed, dt)
        machine.set_shaft_torque(-self._train.shaft_torque(self.torque, speed) - self._braking)
        self._measured = None

    def override(
        self,
        pitch: ArrayLike | None = None,
        torque: float | None = None,
        yaw_rate: float | None = None,
        brake: float | None = None,
    ) -> None:
        """Replace demands in the next step; an external controller keeps them."""
        values = {
            "pitch": pitch,
            "generator_torque": torque,
            "yaw_rate": yaw_rate,
            "brake": brake,
        }
        self._once = {name: value for name, value in values.items() if value is not None}

    def measure(self, time: float) -> Measurements:
        """What the sensors show of the accepted state."""
        if self._measured is None or self._measured.time != time:
            self._measured = self._sensed(time)
        return self._measured

    def _sensed(self, time: float) -> Measurements:
        machine, torque, speed = self.machine, self._torque_now, self.machine.drive_speed
        wind, yaw = self._hub_wind(time), self.machine.yaw
        return Measurements(
            time=time,
            rotor_speed=machine.rotor_speed,
            generator_speed=self._train.generator_speed(speed),
            generator_torque=torque,
            electrical_power=self._train.electrical_power(torque, speed),
            pitch=machine.pitch_angles(time),
            azimuth=machine.azimuth,
            yaw=yaw,
            yaw_error=wrapped(yaw - float(np.arctan2(wind[1], wind[0]))),
            wind_speed=float(np.hypot(wind[0], wind[1])),
            root_moments=machine.root_moments(),
            tower_top_acceleration=machine.tower_top_acceleration(),
            platform=machine.platform_motion(),
            platform_velocity=machine.platform_velocity(),
            platform_acceleration=machine.platform_acceleration(),
            nacelle_angular_acceleration=machine.nacelle_angular_acceleration(),
        )

    def _demanded(self, time: float) -> Demands:
        """What holds for the next step."""
        if time >= self._next - CLOCK_TOLERANCE:
            asked = ask(self.controller, self.measure(time))
            self.demands = self._checked(asked, time, controller_name(self.controller))
            self._next = self._after(time)
        if not self._once:
            return self.demands
        once, self._once = self._once, {}
        demands = self._checked(replace(self.demands, **once), time, "step")
        if isinstance(self.controller, ExternalController):
            self.controller.hold(demands)
            self.demands = demands
        return demands

    def _after(self, time: float) -> float:
        """When the controller is asked next: so many sample times from 0, no sum that drifts."""
        sample = self._sample_time
        return (floor((time + CLOCK_TOLERANCE) / sample) + 1) * sample if sample else time

    def _checked(self, demands: Demands, time: float, where: str) -> Demands:
        """The demands with a pitch for every blade; ControllerError where that cannot be."""
        blades = len(self.machine.pitch)
        try:
            pitch = np.array(demands.pitch, dtype=float)
            others = (demands.generator_torque, demands.yaw_rate, demands.brake)
            torque, yaw_rate, brake = (float(value) for value in others)
        except (TypeError, ValueError) as error:
            hint = "pitch takes an angle per blade, all else one number"
            raise ControllerError(where, f"asks for {demands}", hint, time) from error
        if pitch.shape not in ((), (1,), (blades,)):
            what = f"asks for pitch angles of shape {pitch.shape} for {blades} blades"
            raise ControllerError(where, what, time=time)
        if not np.isfinite(pitch.sum() + torque + yaw_rate + brake):
            raise ControllerError(where, f"asks for {demands}", "it must be numbers", time)
        if brake < 0.0:
            raise ControllerError(where, f"asks for a brake of {brake:g} N m", "0 is none", time)
        return Demands(np.broadcast_to(pitch, blades).copy(), torque, yaw_rate, brake)

    @property
    def _torque_now(self) -> float:
        return 0.0 if np.isnan(self.torque) else self.torque

    def power_given(self, speed: float) -> Array:
        """Power (3,) W into the grid, into gearbox and generator as losses, and into the brake.

        At a ``speed`` rad/s of the generator, seen at the low-speed shaft.
        """
        torque = self._torque_now
        electrical = self._train.electrical_power(torque, speed)
        losses = self._train.shaft_torque(torque, speed) * speed - electrical
        return np.array([electrical, losses, self._braking * speed])

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the accepted state."""
        torque, speed, demands = self._torque_now, self.machine.drive_speed, self._held
        electrical = self._train.electrical_power(torque, speed)
        measured = self.measure(self.machine.accepted.time)
        return {
            "generator_speed": self._train.generator_speed(speed),
            "generator_torque": torque,
            "electrical_power": electrical,
            "drivetrain_losses": self._train.shaft_torque(torque, speed) * speed - electrical,
            "pitch_demand": demands.pitch.copy(),
            "torque_demand": demands.generator_torque,
            "brake_torque": self._braking,
            "yaw_rate_demand": demands.yaw_rate,
            "yaw_error": measured.yaw_error,
            **record_of(self.controller, self._own, measured.time),
        }

    @property
    def resumable(self) -> str:
        """Why a run cannot be resumed; empty where it can."""
        missing = [n for n in ("state", "restore") if not hasattr(self.controller, n)]
        if not missing:
            return ""
        what = " and no ".join(missing)
        return f"{controller_name(self.controller)} has no {what}: what it remembers is lost"

    def state(self) -> dict[str, np.ndarray]:
        """The demands that hold, the actuators' states, and what the controller remembers."""
        demands = self.demands
        others = [demands.generator_torque, demands.yaw_rate, demands.brake]
        own = {
            "clock": np.array(self._next),
            "pitch": demands.pitch.copy(),
            "others": np.array([*others, self.torque, self._braking]),
            **self._actuator.state(),
            **self._brake.state(),
        }
        remembered = state_of(self.controller, self.machine.accepted.time)
        return {**own, **{f"controller/{name}": value for name, value in remembered.items()}}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self._next, self._measured, self._once = float(state["clock"]), None, {}
        *others, self.torque, self._braking = state["others"].tolist()
        self._held = self.demands = Demands(state["pitch"].copy(), *others)
        self._actuator.restore(state)
        self._brake.restore(state)
        if hasattr(self.controller, "restore"):
            prefix = "controller/"
            own = {k.removeprefix(prefix): v for k, v in state.items() if k.startswith(prefix)}
            with blamed(self.controller):
                self.controller.restore({name: value.copy() for name, value in own.items()})

    def close(self) -> None:
        """Let go of what the controller holds, where it holds something."""
        close: Callable[[], None] | None = getattr(self.controller, "close", None)
        if close is not None:
            close()

    @property
    def notices(self) -> Sequence[str]:
        """What the controller has to say after a run."""
        return tuple(getattr(self.controller, "notices", ()))
