"""Gains as ``galerna tune`` is asked for them."""

from __future__ import annotations

from dataclasses import dataclass

from galerna.coupling.gains import Tuning, tuned_gains
from galerna.coupling.steady import FlexibleRotor
from galerna.turbine.model import Turbine


@dataclass(frozen=True)
class TuneSettings:
    """What a user says of the controller: ``frequency`` rad/s, ``damping`` ratio, and switches."""

    frequency: float | None = None
    damping: float = 0.7
    constant_torque: bool = False
    flexible: bool = False
    floating: bool | None = None
    following_wake: bool = False


def tuned(turbine: Turbine, settings: TuneSettings) -> Tuning:
    """The gains of a turbine; raises InputError where it lacks what they need."""
    return tuned_gains(
        turbine,
        natural_frequency=settings.frequency,
        damping_ratio=settings.damping,
        above_rated="constant_torque" if settings.constant_torque else "constant_power",
        floating=settings.floating,
        wake="following" if settings.following_wake else "frozen",
        rotor=FlexibleRotor(turbine) if settings.flexible else None,
    )
