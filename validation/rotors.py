"""What the rotor's validation cases share: reference tables, variants of turbines, means."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np

from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import UniformWind
from galerna.contract import Array
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY, DEG, RPM

DATA = Path(__file__).parent / "data"
STEPS = 48  #: per turn


def table(name: str) -> list[dict[str, str]]:
    """The rows of a reference table, without the comments above its heading."""
    lines = (DATA / name).read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def columns(rows: list[dict[str, str]], *names: str) -> tuple[Array, ...]:
    """The named columns of a table as numbers."""
    return tuple(np.array([float(row[name]) for row in rows]) for name in names)


def straightened(turbine: Turbine) -> Turbine:
    """The turbine without tilt and cone, its sections' aerodynamic centres on the pitch axis."""
    shape = turbine.blade.shape
    center = np.array([turbine.airfoils[name].aerodynamic_center for name in shape.airfoil_names])
    offset = np.interp(shape.span, shape.airfoil_span, center) * shape.chord
    axis = turbine.blade.axis * np.array([0.0, 0.0, 1.0])
    blade = replace(
        turbine.blade,
        axis=axis,
        shape=replace(shape, leading_edge_offset=offset, normal_offset=0.0 * shape.chord),
    )
    return replace(
        turbine,
        blade=blade,
        hub=replace(turbine.hub, cone=0.0),
        nacelle=replace(turbine.nacelle, tilt=0.0),
    )


def turning(
    turbine: Turbine,
    options: BemOptions,
    wind_speed: float,
    rotor_speed_rpm: float,
    pitch_deg: float,
    *,
    yaw_deg: float = 0.0,
    turns: int = 4,
    air_density: float = AIR_DENSITY,
) -> dict[str, Array]:
    """Channels over the last of some turns of the rigid machine in uniform wind, and azimuth."""
    wind = UniformWind(np.array([wind_speed, 0.0, 0.0]))
    model = BladeElementMomentum(turbine, wind, air_density=air_density, options=options)
    blades = turbine.number_of_blades
    operation = PrescribedOperation(
        Signal.constant(rotor_speed_rpm * RPM),
        tuple(Signal.constant(pitch_deg * DEG) for _ in range(blades)),
        Signal.constant(yaw_deg * DEG),
    )
    machine = PrescribedMotion(turbine, operation, [model.stations])
    (motion,) = machine.motions
    dt = 60.0 / rotor_speed_rpm / STEPS
    records = []
    for step in range(turns * STEPS):
        model.begin_step(step * dt, dt, motion)
        machine.predict(step * dt, dt)
        model.loads((step + 1) * dt, motion)
        model.end_step((step + 1) * dt, motion)
        records.append(model.record())
    last = records[-STEPS:]
    result = {name: np.array([record[name] for record in last]) for name in last[0]}
    azimuth = np.arange(1, STEPS + 1) * 360.0 / STEPS
    return {**result, "azimuth_deg": azimuth, "radius": model.coordinates["radius"]}
