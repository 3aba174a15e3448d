"""The reference controller: torque by region, collective pitch by a scheduled PI, and its states.

It is the controller of the reference turbines' reports (NREL/TP-500-38060, section 7) with a
supervisor for what turbines do beside producing power.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Literal

import numpy as np

from galerna.control.actuators import limited
from galerna.control.interface import Demands, Measurements
from galerna.control.pitch import CollectivePitch, LowPass, PitchGains
from galerna.control.torque import AboveRated, TorqueCurve, torque_curve
from galerna.errors import InputError, did_you_mean
from galerna.turbine.model import Turbine
from galerna.units import DEG

Mode = Literal["production", "start_up", "normal_stop", "emergency_stop", "idling", "parked"]
MODES: tuple[Mode, ...] = (
    "production", "start_up", "normal_stop", "emergency_stop", "idling", "parked",
)  # fmt: skip
FEATHER = 90.0 * DEG
HOLD_RATED_PITCH = 1.0 * DEG  #: above fine pitch, from where region 3 is not left
START_PITCH_RATE = 1.0 * DEG  #: per second, towards fine pitch
STOP_PITCH_RATE = 2.0 * DEG  #: per second, towards feather in a normal stop


@dataclass(frozen=True)
class BaselineSettings:
    """What differs between users of one turbine; ``gains`` replace the turbine's schedule.

    ``events`` (time s, mode) switch the mode; ``fine_pitch`` rad is the lowest angle in
    production.
    """

    above_rated: AboveRated = "constant_power"
    gains: PitchGains | None = None
    mode: Mode = "production"
    events: tuple[tuple[float, Mode], ...] = ()
    fine_pitch: float | None = None

    def __post_init__(self) -> None:
        for mode in (self.mode, *(mode for _, mode in self.events)):
            if mode not in MODES:
                raise InputError("mode", f"{mode!r} is not known", did_you_mean(mode, MODES))


@dataclass(eq=False)
class BaselineController:
    """Torque and pitch of a turbine in production, start-up, stops, idling and parked.

    Raises InputError where the turbine gives no gains or no optimal-mode gain.
    """

    turbine: Turbine
    options: BaselineSettings = field(default_factory=BaselineSettings)

    def __post_init__(self) -> None:
        control, drivetrain = self.turbine.control, self.turbine.drivetrain
        gains = self.options.gains
        if gains is None and control.pitch_schedule is None:
            raise InputError(
                self.turbine.name, "the turbine has no pitch gains", "galerna tune computes them"
            )
        if gains is None:
            assert control.pitch_schedule is not None
            gains = PitchGains.of_schedule(control.pitch_schedule)
        fine = self.options.fine_pitch
        self.fine_pitch = control.fine_pitch if fine is None else fine
        self.curve: TorqueCurve = torque_curve(control, drivetrain, self.options.above_rated)
        rated_speed = control.rated_rotor_speed * drivetrain.gear_ratio
        self.pitch = CollectivePitch(gains, rated_speed, self.fine_pitch, control.maximum_pitch)
        self.filter = LowPass(control.speed_filter_frequency)
        self._rate = control.maximum_pitch_rate
        self._torque_rate = control.maximum_torque_rate
        self.mode: Mode = self.options.mode
        self._time = -inf

    def demands(self, measured: Measurements) -> Demands:
        """Pitch and torque for what is measured."""
        first = self._time == -inf
        dt = 0.0 if first else measured.time - self._time
        self._switch(self._time, measured.time)
        self._time = measured.time
        speed = self.filter(measured.generator_speed, dt)
        if first:
            self.pitch.start(float(measured.pitch.mean()))
        angle, rate = self._angle(speed, measured, dt)
        now = float(measured.pitch.mean())
        pitch = angle if first else limited(angle, now, rate, dt)
        torque = self._torque(speed, pitch)
        if not first and self.mode != "emergency_stop":
            torque = limited(torque, measured.generator_torque, self._torque_rate, dt)
        return Demands(np.full(len(measured.pitch), pitch), torque)

    def _angle(self, speed: float, measured: Measurements, dt: float) -> tuple[float, float]:
        """Wanted pitch rad and the rate rad/s at which the mode goes there."""
        if self.mode == "production":
            return self.pitch.angle(speed, dt), self._rate
        now = float(measured.pitch.mean())
        if self.mode == "start_up":
            if speed >= self.curve.ramp_end and now <= self.fine_pitch + HOLD_RATED_PITCH:
                self.mode = "production"
            self.pitch.start(now)
            held = self.pitch.angle(speed, 0.0)
            return max(self.fine_pitch, held if speed > self.pitch.reference else -inf), min(
                START_PITCH_RATE, self._rate
            )
        slow = STOP_PITCH_RATE if self.mode == "normal_stop" else inf
        return FEATHER, min(slow, self._rate)

    def _torque(self, speed: float, pitch: float) -> float:
        if self.mode in ("emergency_stop", "idling", "parked"):
            return 0.0
        hold = self.mode == "production" and pitch >= self.fine_pitch + HOLD_RATED_PITCH
        return self.curve.torque(speed, hold)

    def _switch(self, before: float, now: float) -> None:
        for time, mode in self.options.events:
            if before < time <= now:
                self.mode = mode

    def state(self) -> dict[str, np.ndarray]:
        """Everything that the next demand depends on."""
        return {
            **self.pitch.state(),
            "filtered_speed": np.array(self.filter.value),
            "time": np.array(self._time),
            "mode": np.array(MODES.index(self.mode)),
        }

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        self.pitch.restore(state)
        self.filter.value = float(state["filtered_speed"])
        self._time, self.mode = float(state["time"]), MODES[int(state["mode"])]
