"""A start without a transient: the machine as it turns in the mean wind under its controller.

The operating point comes first, of the rigid rotor and from there of the flexible machine.
Then the shape in which it turns steadily, and the rate at which that shape changes as the
rotor turns on in its weight and the sheared wind, and as base, yaw and pitch move.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.steady import SteadyRotor
from galerna.case import LoadedCase
from galerna.contract import Array, LoadModel, Loads
from galerna.control.options import BaselineOptions
from galerna.coupling.afloat import Floating
from galerna.coupling.controllers import with_gains
from galerna.coupling.equilibrium import SteadyMachine
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.operating_point import (
    OperatingPoint,
    Strategy,
    baseline_strategy,
    general_strategy,
    operating_point,
    rigid_torque,
)
from galerna.coupling.paths import SignalPath
from galerna.inflow.field import WindField
from galerna.kinematics import PrescribedOperation
from galerna.signals import Signal
from galerna.structure import TurbineOptions, with_initial_accelerations
from galerna.structure.frames import log_se3
from galerna.structure.initial import under_way, with_fitting_velocities
from galerna.structure.system import Forces, State
from galerna.turbine.model import Turbine
from galerna.units import DEG

TURN = 0.02  #: rad by which the rotor turns between the shapes whose difference is the velocity
LONGEST = 0.05  #: s, for the same
Describe = Callable[[PrescribedOperation], TurbineOptions]


class Trim:
    """What a case starts from, in the wind of its time 0 without turbulence.

    ``describe`` says what of the machine is flexible and how it is moved, for an operation.
    A platform that floats is held in ``pose`` meanwhile; ``water`` is what it floats in.
    """

    def __init__(
        self,
        case: LoadedCase,
        turbine: Turbine,
        wind: WindField,
        describe: Describe,
        floating: Floating | None = None,
    ) -> None:
        self._case, self._turbine, self._describe = case, turbine, describe
        self._floating = floating
        self._settings = case.case
        self._wind = wind.without_turbulence().held_everywhere()
        self._machine: SteadyMachine | None = None
        self._point: OperatingPoint | None = None

    def find(self, operation: PrescribedOperation) -> tuple[float, float]:
        """Rotor speed rad/s and pitch rad at which the controller, or the power curve, holds it.

        Yaw and azimuth are those of ``operation``. Raises ConvergenceError where there is none.
        """
        control = self._settings.control
        if isinstance(control, BaselineOptions) and control.at_rest:
            return 0.0, control.feather_deg * DEG
        hub = self._wind.hub_velocity(0.0)
        wind_speed = float(np.hypot(hub[0], hub[1]))
        error = float(operation.yaw.value[0] - np.arctan2(hub[1], hub[0]))
        density = self._settings.air_density_kg_m3
        rotor = SteadyRotor(self._turbine, self._aerodynamics(), density, error)
        torque = rigid_torque(rotor, wind_speed)
        strategy = self._strategy(wind_speed)
        rigid = operating_point(torque, strategy)
        guess = Signal.constant(rigid.pitch)
        machine = self._steady(replace(operation, pitch=(guess,) * len(operation.pitch)))
        self._point = operating_point(machine.torque, strategy, rigid)
        if self._floating is not None:
            pitch = np.full(len(operation.pitch), self._point.pitch)
            self._settle(machine, self._point.rotor_speed, pitch)
            self._point = operating_point(machine.torque, strategy, self._point)
        return self._point.rotor_speed, self._point.pitch

    def start(
        self,
        machine: FlexibleMachine,
        operation: PrescribedOperation,
        models: Mapping[str, LoadModel],
    ) -> float:
        """Start a machine as an operation says; returns the torque N m that holds its shaft.

        ``models`` are the loads on it, in the order of its motions.
        """
        steady = self._machine or self._steady(operation)
        speed = float(operation.rotor_speed.value[0])
        if self._floating is not None:
            first_pitch = np.array([angle.value[0] for angle in operation.pitch])
            self._settle(steady, speed, first_pitch)
            self._floating.displace(steady)
        turned = SignalPath(operation.rotor_speed, integral=True)
        pitch = [SignalPath(angle) for angle in operation.pitch]

        def shape(time: float) -> State:
            angles = np.array([angle(time) for angle in pitch])
            return steady.equilibrium(speed, angles, turned(time), time)

        step = min(TURN / max(abs(speed), 1e-9), LONGEST)
        before, after, now = shape(-step), shape(step), shape(0.0)
        found = self._point if self._point_holds(operation) else None
        torque = steady.held_torque(now) if found is None else found.torque
        machine.set_shaft_torque(-torque)
        first = replace(
            machine.system.initial_state(),
            position=now.position,
            rotation=now.rotation,
            velocity=_rate(before, after, 2.0 * step),
        )
        first = with_fitting_velocities(machine.system, first)
        forces = self._forces(machine, first, steady, models)
        first = with_initial_accelerations(machine.system, first, forces)
        step, scheme = self._settings.time_step_s, machine.integrator.scheme
        machine.start(under_way(machine.system, first, scheme, step))
        return torque

    def _forces(
        self,
        machine: FlexibleMachine,
        first: State,
        steady: SteadyMachine,
        models: Mapping[str, LoadModel],
    ) -> Forces:
        """The air's loads of the steady machine, and the water's with their added mass."""
        air = steady.forces().follower.copy()
        machine.start(first)
        water = self._floating.water.models if self._floating is not None else {}
        forces = machine.forces(
            [
                model.loads(0.0, motion) if name in water else Loads.zero(len(motion.position))
                for (name, model), motion in zip(models.items(), machine.motions, strict=True)
            ]
        )
        forces.follower += air
        return forces

    def _settle(self, machine: SteadyMachine, rotor_speed: float, pitch: Array) -> None:
        """Hold the machine where it floats; what cannot float is the platform's or the sea's."""
        assert self._floating is not None
        key = "sea" if self._settings.platform is None else "platform"
        with self._case.blame(key):
            self._floating.settle(machine, rotor_speed, pitch)

    def _point_holds(self, operation: PrescribedOperation) -> bool:
        """Whether an operation is the point that was found, not one that was given in part."""
        if self._point is None:
            return False
        speed, pitch = operation.rotor_speed.value[0], operation.pitch[0].value[0]
        found = self._point.rotor_speed, self._point.pitch
        return bool(np.allclose((speed, pitch), found, rtol=0.0, atol=1e-9))

    def _strategy(self, wind_speed: float) -> Strategy:
        control = self._settings.control
        if not isinstance(control, BaselineOptions):
            return general_strategy(self._turbine, wind_speed)
        fine = control.fine_pitch_deg
        turbine = with_gains(self._case, self._turbine)
        return baseline_strategy(
            turbine, wind_speed, control.above_rated, None if fine is None else fine * DEG
        )

    def _aerodynamics(self) -> BemOptions | None:
        options = self._settings.aerodynamics
        return options if isinstance(options, BemOptions) else None

    def _steady(self, operation: PrescribedOperation) -> SteadyMachine:
        settings = self._settings
        self._machine = SteadyMachine(
            self._turbine,
            self._wind,
            self._held(self._describe(operation)),
            air_density=settings.air_density_kg_m3,
            aerodynamics=self._aerodynamics(),
            drag=settings.tower_and_nacelle_drag,
        )
        return self._machine

    def _held(self, options: TurbineOptions) -> TurbineOptions:
        """The options with a platform that floats held in its pose."""
        if self._floating is None:
            return options
        return replace(options, base_motion=self._floating.pose)


def _rate(before: State, after: State, duration: float) -> Array:
    """Body twists (n,6) that take one state to the other."""
    twist = np.zeros_like(before.velocity)
    for i in range(1, len(twist)):
        R, x = before.rotation[i].T, before.position[i]
        twist[i] = log_se3(R @ after.rotation[i], R @ (after.position[i] - x))
    return twist / duration
