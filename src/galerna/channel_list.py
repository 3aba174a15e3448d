"""The channels of a case, without making its wind or finding where it starts."""

from __future__ import annotations

from collections.abc import Mapping

from galerna.case import LoadedCase
from galerna.channel_names import matching, nearest
from galerna.contract import Array, Channel
from galerna.errors import InputError
from galerna.inflow.build import build
from galerna.inflow.options import InflowOptions
from galerna.inflow.sizing import RotorExtent
from galerna.kinematics import PrescribedOperation
from galerna.machine import afloat_of, assembled, controller_of, let_go, load_turbine
from galerna.signals import Signal

WIND_SPEED = 10.0  #: m/s: any will do


def channels_of(case: LoadedCase) -> tuple[tuple[Channel, ...], Mapping[str, Array]]:
    """Every channel that a run of a case has, and the coordinates of their dimensions."""
    settings = case.case
    with case.blame("turbine"):
        turbine = load_turbine(case)
    inflow = InflowOptions(wind_speed_m_s=WIND_SPEED)
    wind = build(inflow, RotorExtent.of(turbine), settings.duration_s)
    still = Signal.constant(0.0)
    speed = Signal.constant(turbine.control.rated_rotor_speed)
    operation = PrescribedOperation(speed, (still,) * turbine.number_of_blades, still)
    afloat = afloat_of(case, turbine, duration=settings.time_step_s)
    simulation = assembled(case, turbine, wind, operation, controller_of(case, turbine), afloat)
    let_go(simulation)
    return simulation.channels, simulation.coordinates


def chosen(case: LoadedCase, pattern: str | None) -> tuple[list[Channel], Mapping[str, Array]]:
    """The channels of a case that a pattern names, in order, and their coordinates.

    Raises InputError, with the nearest names, where it names none.
    """
    channels, coordinates = channels_of(case)
    if pattern is None:
        return list(channels), coordinates
    found = matching(pattern, channels)
    if not found:
        raise InputError(repr(pattern), "no channel has this name", nearest(pattern, channels))
    return list(found), coordinates
