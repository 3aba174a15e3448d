"""The transient wind events of IEC 61400-1 (ed. 3 and 4, section 6.3.2).

Each is immutable, takes the hub wind and the time since it began, and answers the
hub wind with the event in it; ``iec`` gives it the amplitude of the standard.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from math import atan, cos, pi, sin
from typing import Protocol, Self

from galerna.errors import InputError
from galerna.inflow.iec import (
    TurbineClass,
    TurbulenceClass,
    longitudinal_scale,
    normal_turbulence,
    yearly_extreme_speed,
)
from galerna.inflow.mean import Course, HubWind


class Gust(Protocol):
    """A transient event, ``since`` s after it began."""

    def on(self, wind: HubWind, since: float) -> HubWind: ...


@dataclass(frozen=True)
class WithGust:
    """A course of the wind with an event that begins at ``start`` s."""

    course: Course
    gust: Gust
    start: float

    def at(self, time: float) -> HubWind:
        """The hub wind at ``time`` s."""
        wind = self.course.at(time)
        return wind if time <= self.start else self.gust.on(wind, time - self.start)


@dataclass(frozen=True)
class ExtremeOperatingGust:
    """EOG: dip, gust, dip (6.3.2.2, eq. 17-18). ``amplitude`` V_gust m/s, ``period`` s."""

    amplitude: float
    period: float = 10.5

    @classmethod
    def iec(
        cls,
        hub_speed: float,
        hub_height: float,
        rotor_diameter: float,
        turbine_class: TurbineClass,
        turbulence_class: TurbulenceClass,
    ) -> Self:
        """Amplitude of eq. 17; InputError above the wind speed where it vanishes."""
        fluctuation = _damped_turbulence(hub_speed, hub_height, rotor_diameter, turbulence_class)
        extreme = yearly_extreme_speed(turbine_class)
        if hub_speed >= extreme:
            what = f"hub speed {hub_speed:g} m/s is not below the yearly extreme {extreme:g} m/s"
            raise InputError("gust EOG", what)
        return cls(min(1.35 * (extreme - hub_speed), 3.3 * fluctuation))

    def on(self, wind: HubWind, since: float) -> HubWind:
        if since >= self.period:
            return wind
        phase = pi * since / self.period
        change = -0.37 * self.amplitude * sin(3.0 * phase) * (1.0 - cos(2.0 * phase))
        return wind._replace(gust=wind.gust + change)


@dataclass(frozen=True)
class ExtremeDirectionChange:
    """EDC: the wind turns by ``angle`` rad about +z and stays (6.3.2.4, eq. 20-21)."""

    angle: float
    period: float = 6.0

    @classmethod
    def iec(
        cls,
        hub_speed: float,
        hub_height: float,
        rotor_diameter: float,
        turbulence_class: TurbulenceClass,
        sign: int = 1,
    ) -> Self:
        """Angle of eq. 20, at most 180 deg, positive about +z for ``sign`` 1."""
        fluctuation = _damped_turbulence(hub_speed, hub_height, rotor_diameter, turbulence_class)
        return cls(sign * min(4.0 * atan(fluctuation / hub_speed), pi))

    def on(self, wind: HubWind, since: float) -> HubWind:
        return wind._replace(direction=wind.direction + self.angle * _rise(since, self.period))


@dataclass(frozen=True)
class ExtremeCoherentGust:
    """ECD: the wind rises by ``amplitude`` m/s, turns by ``angle`` rad, stays (6.3.2.5)."""

    angle: float
    amplitude: float = 15.0
    period: float = 10.0

    @classmethod
    def iec(cls, hub_speed: float, sign: int = 1) -> Self:
        """Angle of eq. 24, positive about +z for ``sign`` 1; the rise is 15 m/s in 10 s."""
        return cls(sign * (pi if hub_speed < 4.0 else math.radians(720.0 / hub_speed)))

    def on(self, wind: HubWind, since: float) -> HubWind:
        rise = _rise(since, self.period)
        return wind._replace(
            gust=wind.gust + self.amplitude * rise, direction=wind.direction + self.angle * rise
        )


@dataclass(frozen=True)
class ExtremeWindShear:
    """EWS: linear shear that comes and goes (6.3.2.6, eq. 26-27).

    The gradients 1/s, to the left and upwards, are half of what they reach midway.
    """

    lateral_gradient: float
    vertical_gradient: float
    period: float = 12.0

    @classmethod
    def iec(
        cls,
        hub_speed: float,
        hub_height: float,
        rotor_diameter: float,
        turbulence_class: TurbulenceClass,
        direction: str,
        sign: int = 1,
    ) -> Self:
        """Gradients of eq. 26 or 27; ``direction`` is ``vertical`` or ``horizontal``."""
        sigma = normal_turbulence(hub_speed, turbulence_class)
        scale = (rotor_diameter / longitudinal_scale(hub_height)) ** 0.25
        gradient = sign * (2.5 + 0.2 * 6.4 * sigma * scale) / rotor_diameter
        return cls(0.0, gradient) if direction == "vertical" else cls(gradient, 0.0)

    def on(self, wind: HubWind, since: float) -> HubWind:
        if since >= self.period:
            return wind
        course = 1.0 - cos(2.0 * pi * since / self.period)
        return wind._replace(
            lateral_gradient=wind.lateral_gradient + self.lateral_gradient * course,
            vertical_gradient=wind.vertical_gradient + self.vertical_gradient * course,
        )


def _rise(since: float, period: float) -> float:
    """From 0 to 1 along half a cosine, then 1."""
    return 1.0 if since >= period else 0.5 * (1.0 - cos(pi * since / period))


def _damped_turbulence(
    hub_speed: float, hub_height: float, rotor_diameter: float, turbulence_class: TurbulenceClass
) -> float:
    """sigma_1 / (1 + 0.1 D / Lambda_1), m/s: the turbulence that a rotor feels as one."""
    sigma = normal_turbulence(hub_speed, turbulence_class)
    return sigma / (1.0 + 0.1 * rotor_diameter / longitudinal_scale(hub_height))
