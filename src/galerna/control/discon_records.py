"""The records of the swap array: what a Bladed-style library is told, and what it demands.

Numbers, units and signs are those of the Bladed manual's appendix A as OpenFAST's ServoDyn fills
them (module BladedInterface, 2024), with ServoDyn's extended records from 1000 on; the first
record has the number 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

import numpy as np

from galerna.control.interface import Demands, Measurements
from galerna.errors import ControllerError
from galerna.turbine.model import Turbine

FIRST_CALL, LATER_CALL = 0.0, 1.0  #: record 1
LOG_START, MOST_LOGGED = 165, 300  #: records 63 and 62
EXTENDED_VERSION, PLATFORM = 1.0, 1001  #: record 1000, and 66: where the platform's motion begins
CONTACTOR, BRAKE, PITCH, COLLECTIVE, TORQUE, YAW_RATE = 35, 36, 42, 45, 47, 48
PITCH_OVERRIDE, TORQUE_OVERRIDE, YAW_OVERRIDE, BRAKE_TORQUE = 55, 56, 102, 107
ASKED = (
    CONTACTOR, BRAKE, PITCH, PITCH + 1, PITCH + 2, COLLECTIVE, TORQUE, YAW_RATE,
    PITCH_OVERRIDE, TORQUE_OVERRIDE, YAW_OVERRIDE, BRAKE_TORQUE,
)  # fmt: skip
BRAKE_OFF, BRAKE_ON, BRAKE_BY_TORQUE = 0, 1, 16  #: record 36; the last refers to record 107


@dataclass(frozen=True)
class Record:
    """A measured value: its number, what it is, its unit, and where it comes from."""

    number: int
    what: str
    unit: str
    value: Callable[[Measurements], float]
    blade: int = 1  #: the turbine has it where it has this blade


def _per_blade(
    numbers: tuple[int, int, int], what: str, unit: str, value: Callable[[Measurements, int], float]
) -> list[Record]:
    """One record for each of three blades."""

    def of_blade(i: int) -> Callable[[Measurements], float]:
        return lambda m: value(m, i)

    return [
        Record(number, f"{what}, blade {i + 1}", unit, of_blade(i), i + 1)
        for i, number in enumerate(numbers)
    ]


def _platform(first: int, what: str, name: str, units: tuple[str, str]) -> list[Record]:
    """Six records of the platform's motion: three along and three about the axes."""

    def component(i: int) -> Callable[[Measurements], float]:
        return lambda m: getattr(m, name)[i]

    sense = ("along x", "along y", "along z", "about x", "about y", "about z")
    return [
        Record(first + i, f"platform {what} {sense[i]}", units[i // 3], component(i))
        for i in range(6)
    ]


#: what is measured anew before every call; status (1) and last demanded pitch (11) come before
MEASURED: tuple[Record, ...] = (
    Record(2, "time", "s", lambda m: m.time),
    *_per_blade((4, 33, 34), "pitch", "rad", lambda m, i: m.pitch[i]),
    Record(14, "generator torque times speed", "W",
           lambda m: m.generator_torque * m.generator_speed),
    Record(15, "electrical power", "W", lambda m: m.electrical_power),
    Record(20, "generator speed", "rad/s", lambda m: m.generator_speed),
    Record(21, "rotor speed", "rad/s", lambda m: m.rotor_speed),
    Record(23, "generator torque", "N m", lambda m: m.generator_torque),
    Record(24, "wind direction minus nacelle yaw", "rad", lambda m: -m.yaw_error),
    Record(27, "wind speed at the hub", "m/s", lambda m: m.wind_speed),
    *_per_blade((30, 31, 32), "root moment out of plane", "N m", lambda m, i: m.root_moments[i, 0]),
    Record(37, "nacelle yaw", "rad", lambda m: m.yaw),
    Record(53, "tower-top acceleration fore-aft", "m/s2", lambda m: m.tower_top_acceleration[0]),
    Record(54, "tower-top acceleration side-to-side", "m/s2",
           lambda m: m.tower_top_acceleration[1]),
    Record(60, "azimuth", "rad", lambda m: m.azimuth),
    *_per_blade((69, 70, 71), "root moment in plane", "N m", lambda m, i: m.root_moments[i, 1]),
    Record(82, "nacelle roll acceleration", "rad/s2", lambda m: m.nacelle_angular_acceleration[0]),
    Record(83, "nacelle nodding acceleration", "rad/s2",
           lambda m: m.nacelle_angular_acceleration[1]),
    Record(84, "nacelle yaw acceleration", "rad/s2", lambda m: m.nacelle_angular_acceleration[2]),
    *_platform(PLATFORM, "displacement", "platform", ("m", "rad")),
    *_platform(PLATFORM + 6, "velocity", "platform_velocity", ("m/s", "rad/s")),
    *_platform(PLATFORM + 12, "acceleration", "platform_acceleration", ("m/s2", "rad/s2")),
)  # fmt: skip


class Swap:
    """Rows of what a library is told about one turbine, and demands from what it answers.

    ``sample_time`` s lies between the calls; with ``individual`` pitch the demands are those
    per blade (records 42 to 44), otherwise the collective one (45). ``brake_torque`` N m is that
    of the whole brake on the low-speed shaft. What a library asks for in vain is told once each
    in ``notices``.
    """

    def __init__(
        self,
        turbine: Turbine,
        sample_time: float,
        individual: bool = True,
        brake_torque: float = 0.0,
    ) -> None:
        self._blades, self._gear_ratio = turbine.number_of_blades, turbine.drivetrain.gear_ratio
        self._individual, self._brake_torque = individual, brake_torque
        self._records = tuple(r for r in MEASURED if r.blade <= self._blades)
        self.told = (1, 11, *(record.number for record in self._records))
        self.constant = {**constants(turbine), 3: sample_time, 28: float(individual)}
        self.initial = {CONTACTOR: 1.0}
        self.notices: list[str] = []

    def row(self, measured: Measurements, status: float, pitch_demand: float) -> bytes:
        """The values of the records ``told``, in single precision."""
        values = [record.value(measured) for record in self._records]
        return np.array([status, pitch_demand, *values], dtype="<f4").tobytes()

    def demands(self, values: tuple[float, ...], where: str, time: float) -> Demands:
        """What the values of the records ``ASKED`` demand.

        Raises ControllerError for demands that are no numbers, or a generator that is not there.
        """
        asked = dict(zip(ASKED, values, strict=True))
        used = [PITCH + i for i in range(self._blades)] if self._individual else [COLLECTIVE]
        for number in (*used, CONTACTOR, BRAKE, TORQUE, YAW_RATE, YAW_OVERRIDE):
            if not isfinite(asked[number]):
                what = f"record {number} of its answer is {asked[number]}"
                raise ControllerError(where, what, "look at its input file and its log", time)
        if round(asked[CONTACTOR]) not in (0, 1):
            what = f"it asks for generator {asked[CONTACTOR]:g} (record {CONTACTOR})"
            raise ControllerError(where, what, "there is one: 1 on, 0 off", time)
        self._notice(asked)
        pitch = np.array([asked[number] for number in used])
        return Demands(
            pitch if self._individual else np.full(self._blades, pitch[0]),
            asked[TORQUE] if round(asked[CONTACTOR]) else 0.0,
            0.0 if asked[YAW_OVERRIDE] else asked[YAW_RATE],
            self._brake(asked, where, time),
        )

    def _brake(self, asked: dict[int, float], where: str, time: float) -> float:
        """Brake torque N m at the low-speed shaft; record 107 is at the generator's."""
        wanted = round(asked[BRAKE])
        if wanted == BRAKE_ON:
            return self._brake_torque
        if wanted != BRAKE_BY_TORQUE:
            return 0.0
        if not isfinite(asked[BRAKE_TORQUE]):
            what = f"record {BRAKE_TORQUE} of its answer is {asked[BRAKE_TORQUE]}"
            raise ControllerError(where, what, "look at its input file and its log", time)
        return abs(asked[BRAKE_TORQUE]) * self._gear_ratio

    def _notice(self, asked: dict[int, float]) -> None:
        brake = round(asked[BRAKE])
        vain = {
            "the brake (record 36 = 1) has no torque: give it brake_torque_kN_m":
                brake == BRAKE_ON and self._brake_torque == 0.0,
            f"the brake (record 36 = {brake}) is not known: 0, 1 and 16 are":
                brake not in (BRAKE_OFF, BRAKE_ON, BRAKE_BY_TORQUE),
            "the pitch override (record 55) has no effect": asked[PITCH_OVERRIDE] != 0.0,
            "the torque override (record 56) has no effect": asked[TORQUE_OVERRIDE] != 0.0,
            "yaw by torque (record 102) has no effect": asked[YAW_OVERRIDE] != 0.0,
        }  # fmt: skip
        for notice, asked_for in vain.items():
            if asked_for and notice not in self.notices:
                self.notices.append(notice)


def constants(turbine: Turbine) -> dict[int, float]:
    """Records that do not change in a run, from the turbine's published figures."""
    control, ratio = turbine.control, turbine.drivetrain.gear_ratio
    rate = control.maximum_pitch_rate if isfinite(control.maximum_pitch_rate) else 0.0
    return {
        5: control.fine_pitch,
        6: control.fine_pitch,
        7: control.maximum_pitch,
        8: -rate,
        9: rate,
        13: control.rated_power,
        16: control.optimal_mode_gain or 0.0,
        17: control.minimum_rotor_speed * ratio,
        18: control.rated_rotor_speed * ratio,
        19: control.rated_rotor_speed * ratio,
        22: control.rated_torque or 0.0,
        61: float(turbine.number_of_blades),
        62: float(MOST_LOGGED),
        63: float(LOG_START),
        66: float(PLATFORM),
        1000: EXTENDED_VERSION,
    }
