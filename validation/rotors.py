"""What the rotor's validation cases share: reference tables, variants of turbines, means."""

from __future__ import annotations

import csv
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from galerna import turbine as turbines
from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import UniformWind, steady_rotor
from galerna.aero.vortex.model import VortexLattice
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.contract import Array, Inflow, LoadModel
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY, DEG, RPM

DATA = Path(__file__).parent / "data"
STEPS = 48  #: per turn
AVATAR = (9.26, 0.66)  #: tip-speed ratio and thrust coefficient of the dissertation's table 4.3

Options = BemOptions | VortexLatticeOptions  #: of any aerodynamic model of the rotor

#: The lattice as it comes, of a rotor without a tower
LATTICE = VortexLatticeOptions(tower_influence=False)

#: A smaller wake for long runs, with steps of 7.5 degrees: half the panels of the default
BRISK = LATTICE.model_copy(
    update={"wake_revolutions": 5.0, "wake_near_deg": 60.0, "wake_growth": 1.15,
            "wake_widest_deg": 30.0, "wake_step_deg": 7.5}
)  # fmt: skip


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
    options: Options,
    wind_speed: float,
    rotor_speed_rpm: float,
    pitch_deg: float,
    *,
    yaw_deg: float = 0.0,
    turns: int = 4,
    steps: int = STEPS,
    air_density: float = AIR_DENSITY,
) -> dict[str, Array]:
    """Channels over the last of some turns of the rigid machine in uniform wind, and azimuth."""
    wind = UniformWind(np.array([wind_speed, 0.0, 0.0]))
    dt = 60.0 / rotor_speed_rpm / steps
    model = load_model(
        turbine, wind, options, wind_speed, rotor_speed_rpm, dt, air_density=air_density
    )
    operation = constant_operation(turbine, rotor_speed_rpm, pitch_deg, yaw_deg)
    result = march(turbine, model, operation, dt, turns * steps)
    last = {name: values[-steps:] for name, values in result.items()}
    azimuth = np.arange(1, steps + 1) * 360.0 / steps
    return {**last, "azimuth_deg": azimuth, "radius": model.coordinates["radius"]}


def dynamic_pressure_force(turbine: Turbine, wind_speed: float) -> float:
    """What forces N are divided by for their coefficients: 1/2 rho V^2 pi R^2."""
    return float(0.5 * AIR_DENSITY * wind_speed**2 * np.pi * turbine.rotor_radius**2)


def load_model(
    turbine: Turbine,
    inflow: Inflow,
    options: Options,
    wind_speed: float,
    rotor_speed_rpm: float,
    dt: float,
    *,
    air_density: float = AIR_DENSITY,
) -> LoadModel:
    """The aerodynamic model that the options are those of; means and step size a wake."""
    if isinstance(options, VortexLatticeOptions):
        return VortexLattice(
            turbine, inflow, rotor_speed=rotor_speed_rpm * RPM, wind_speed=wind_speed,
            time_step=dt, air_density=air_density, options=options,
        )  # fmt: skip
    return BladeElementMomentum(turbine, inflow, air_density=air_density, options=options)


def constant_operation(
    turbine: Turbine, rotor_speed_rpm: float, pitch_deg: float, yaw_deg: float = 0.0
) -> PrescribedOperation:
    """All blades at one pitch, the rotor at one speed, the nacelle at one yaw."""
    pitch = tuple(Signal.constant(pitch_deg * DEG) for _ in range(turbine.number_of_blades))
    return PrescribedOperation(
        Signal.constant(rotor_speed_rpm * RPM), pitch, Signal.constant(yaw_deg * DEG)
    )


def march(
    turbine: Turbine, model: LoadModel, operation: PrescribedOperation, dt: float, steps: int
) -> dict[str, Array]:
    """The model's channels after each of the steps of the rigid machine, time first."""
    machine = PrescribedMotion(turbine, operation, [model.stations])
    (motion,) = machine.motions
    records = []
    for step in range(steps):
        model.begin_step(step * dt, dt, motion)
        machine.predict(step * dt, dt)
        model.loads((step + 1) * dt, motion)
        model.end_step((step + 1) * dt, motion)
        records.append(model.record())
    return {name: np.array([record[name] for record in records]) for name in records[0]}


@cache
def like_the_avatar() -> tuple[Turbine, float, float, float]:
    """The straightened DTU 10 MW, wind m/s, rpm and the pitch deg of the AVATAR's thrust."""
    turbine, wind = straightened(turbines.load("dtu10mw")), 10.5
    ratio, thrust = AVATAR
    speed = ratio * wind / turbine.rotor_radius / RPM

    def excess(pitch: float) -> float:
        point = steady_rotor(turbine, wind, speed * RPM, pitch * DEG)
        return float(point["thrust_coefficient"]) - thrust

    return turbine, wind, speed, float(brentq(excess, 0.0, 10.0, xtol=1e-3))
