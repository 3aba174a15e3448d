"""The reference controller: torque by region, collective pitch by a scheduled PID, and its modes.

It is the controller of the reference turbines' reports (NREL/TP-500-38060, section 7) with a
supervisor for what turbines do beside producing power. One torque curve serves production, start
and normal stop alike, and pitch always moves at a finite rate, so that no mode begins with a jump;
an emergency stop alone drops the torque at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, isfinite

import numpy as np

from galerna.contract import Array, Channel
from galerna.control.actuators import lagged, limited
from galerna.control.individual_pitch import IndividualPitch, IndividualPitchSettings
from galerna.control.interface import Demands, Measurements, Stateful
from galerna.control.minimum_pitch import MinimumPitch
from galerna.control.modes import GENERATING, MODES, Events, Supervisor
from galerna.control.options import Mode
from galerna.control.pitch import CollectivePitch, LowPass, PitchGains
from galerna.control.torque import AboveRated, TorqueCurve, torque_curve
from galerna.control.yawing import YawControl, YawSettings
from galerna.errors import InputError
from galerna.turbine.model import Turbine
from galerna.units import DEG

FEATHER = 90.0 * DEG
HOLD_RATED_PITCH = 1.0 * DEG  #: above the minimum, from where region 3 is fully held
START_PITCH_RATE = 1.0 * DEG  #: per second, towards fine pitch
STOP_PITCH_RATE = 2.0 * DEG  #: per second, towards feather in a normal stop
TORQUE_RATE = 0.5  #: of the rated torque per second, where a turbine gives none
BRAKE_TIME = 0.6  #: s, time constant of the brake (NREL/TP-500-38060, Table 5-1)
PARKING_SPEED = 0.1  #: of the rated speed, from where down the brake parks the rotor

CHANNELS = (
    Channel("control_mode", "1", "mode of the controller: 0 production, 1 start-up, 2 normal stop, "
            "3 emergency stop, 4 idling, 5 parked"),
    Channel("filtered_generator_speed", "rad/s", "generator speed that the controller sees"),
    Channel("pitch_integral", "rad", "integral part of the collective pitch"),
    Channel("minimum_pitch", "rad", "lowest pitch in production"),
)  # fmt: skip


@dataclass(frozen=True)
class BaselineSettings:
    """What differs between users of one turbine; ``gains`` replace the turbine's schedule.

    ``events`` (time s, mode) switch the mode; ``fine_pitch`` rad is the lowest angle in
    production. ``pitch_rate`` rad/s and ``highest_pitch`` rad are the actuator's, where they are
    narrower than the turbine's. ``overspeed`` times the rated speed brings an emergency stop;
    ``brake_torque`` N m at the low-speed shaft parks the rotor, by default the rated torque, and
    with ``emergency_brake`` helps in an emergency stop.
    """

    above_rated: AboveRated = "constant_power"
    gains: PitchGains | None = None
    mode: Mode = "production"
    events: Events = ()
    fine_pitch: float | None = None
    pitch_rate: float = inf
    highest_pitch: float = inf
    overspeed: float | None = None
    brake_torque: float | None = None
    emergency_brake: bool = False
    individual_pitch: IndividualPitchSettings | None = None
    yaw: YawSettings | None = None


@dataclass(eq=False)
class BaselineController:
    """Torque, pitch, yaw and brake of a turbine in all of its modes.

    Raises InputError where the turbine gives no gains or no optimal-mode gain.
    """

    turbine: Turbine
    options: BaselineSettings = field(default_factory=BaselineSettings)
    channels = CHANNELS

    def __post_init__(self) -> None:
        control, drivetrain, options = self.turbine.control, self.turbine.drivetrain, self.options
        self.curve: TorqueCurve = torque_curve(control, drivetrain, options.above_rated)
        self.minimum_pitch = MinimumPitch.of(control, options.fine_pitch)
        rated_speed = control.rated_rotor_speed * drivetrain.gear_ratio
        highest = min(control.maximum_pitch, options.highest_pitch)
        self.feather = min(FEATHER, highest)
        self._rate = min(control.maximum_pitch_rate, options.pitch_rate)
        self.pitch = CollectivePitch(self._gains(), rated_speed, highest, self._rate)
        self.filter = LowPass(control.speed_filter_frequency)
        given = control.maximum_torque_rate
        self._torque_rate = given if isfinite(given) else TORQUE_RATE * self.curve.rated_torque
        overspeed = options.overspeed
        fastest = None if overspeed is None else overspeed * control.rated_rotor_speed
        self.supervisor = Supervisor(options.mode, options.events, fastest)
        rated_torque = self.curve.rated_torque * drivetrain.gear_ratio
        self._grip = options.brake_torque if options.brake_torque is not None else rated_torque
        blades, yaw = options.individual_pitch, options.yaw
        self._individual = None if blades is None else IndividualPitch(blades)
        self._yaw = None if yaw is None else YawControl(yaw)
        self._time, self._torque, self._brake = np.nan, 0.0, 0.0
        self._lowest = self._minimum = control.fine_pitch

    def _gains(self) -> PitchGains:
        schedule = self.turbine.control.pitch_schedule
        if self.options.gains is not None:
            return self.options.gains
        if schedule is None:
            raise InputError(
                self.turbine.name, "the turbine has no pitch gains", "galerna tune computes them"
            )
        return PitchGains.of_schedule(schedule)

    @property
    def mode(self) -> Mode:
        """What the turbine does."""
        return self.supervisor.mode

    def demands(self, measured: Measurements) -> Demands:
        """Pitch, torque, yaw rate and brake for what is measured."""
        first = np.isnan(self._time)
        dt = 0.0 if first else measured.time - self._time
        self._time = measured.time
        if first:
            self.pitch.start(float(measured.pitch.mean()))
        if self.supervisor.update(measured.time, measured.rotor_speed) or first:
            self._lowest = self.pitch.angle
        speed = self.filter(measured.generator_speed, dt)
        collective = self._collective(speed, measured.wind_speed, dt)
        torque = self._generator(speed, collective)
        if not first and self.mode != "emergency_stop":
            torque = limited(torque, self._torque, self._torque_rate, dt)
        self._torque = torque
        grip = self._wanted_brake(measured)
        self._brake = grip if first else lagged(grip, self._brake, BRAKE_TIME, dt)
        pitch = collective + self._each_blade(collective, measured, dt)
        return Demands(pitch, torque, self._yaw_rate(measured, dt), self._brake)

    def _collective(self, speed: float, wind: float, dt: float) -> float:
        """The common pitch angle; in a start-up its lower limit comes down from feather."""
        self._minimum = self.minimum_pitch(wind, dt)
        if self.mode not in ("production", "start_up"):
            fastest = inf if self.mode == "emergency_stop" else STOP_PITCH_RATE
            return self.pitch.go(self.feather, fastest, dt)
        ramp = START_PITCH_RATE * dt if self.mode == "start_up" else inf
        self._lowest = max(self._lowest - ramp, self._minimum)
        if self._lowest == self._minimum:
            self.supervisor.mode = "production"
        return self.pitch.hold_speed(speed, self._lowest, dt)

    def _generator(self, speed: float, collective: float) -> float:
        if self.mode not in GENERATING:
            return 0.0
        pitched = (collective - self._minimum) / HOLD_RATED_PITCH
        return self.curve.torque(speed, min(max(pitched, 0.0), 1.0))

    def _wanted_brake(self, measured: Measurements) -> float:
        slow = abs(measured.rotor_speed) < PARKING_SPEED * self.turbine.control.rated_rotor_speed
        stopping = self.mode == "emergency_stop" and self.options.emergency_brake
        return self._grip if stopping or (self.mode == "parked" and slow) else 0.0

    def _each_blade(self, collective: float, measured: Measurements, dt: float) -> Array:
        """Angles (b,) rad of the individual pitch control, in production."""
        if self._individual is None:
            return np.zeros(len(measured.pitch))
        if self.mode != "production":
            self._individual.rest()
            return np.zeros(len(measured.pitch))
        moment = measured.root_moments[:, 0]
        return self._individual(moment, measured.azimuth, collective - self._minimum, dt)

    def _yaw_rate(self, measured: Measurements, dt: float) -> float:
        return self._yaw(measured.yaw_error, dt) if self._yaw is not None else 0.0

    def record(self) -> Mapping[str, float | Array]:
        """The channels of the last demand."""
        return {
            "control_mode": float(MODES.index(self.mode)),
            "filtered_generator_speed": self.filter.value,
            "pitch_integral": self.pitch.integral,
            "minimum_pitch": self._minimum,
        }

    def state(self) -> dict[str, np.ndarray]:
        """Everything that the next demand depends on."""
        own = [self._time, self._torque, self._brake, self._lowest, self._minimum]
        filters = [self.filter.value, self.minimum_pitch.wind.value]
        merged = {"baseline": np.array(own), "filters": np.array(filters)}
        for part in self._parts():
            merged.update(part.state())
        return merged

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Take ``state`` back."""
        own = state["baseline"].tolist()
        self._time, self._torque, self._brake, self._lowest, self._minimum = own
        self.filter.value, self.minimum_pitch.wind.value = state["filters"].tolist()
        for part in self._parts():
            part.restore(state)

    def _parts(self) -> list[Stateful]:
        options: list[Stateful | None] = [self._individual, self._yaw]
        return [self.pitch, self.supervisor, *(part for part in options if part is not None)]
