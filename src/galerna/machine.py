"""From a case to a machine that is ready to run: turbine, wind, loads and motion put together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np

from galerna import doubts
from galerna import turbine as turbines
from galerna.aero.bem.model import BladeElementMomentum
from galerna.aero.bem.options import BemOptions
from galerna.aero.body_drag import BodyDrag
from galerna.case import Case, CaseError, LoadedCase, Problem, Series, parse
from galerna.channel_names import matching, nearest
from galerna.compiling import watch
from galerna.contract import Array, Channel, LoadModel
from galerna.control.drivetrain import PowerTrain
from galerna.errors import InputError
from galerna.inflow.build import BuiltInflow, build
from galerna.inflow.sizing import RotorExtent
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.signals import Signal
from galerna.simulation import Callback, Commander, Probe, Simulation, Structure
from galerna.turbine.model import Turbine
from galerna.units import DEG, RPM

if TYPE_CHECKING:
    import xarray

    from galerna.aero.vortex.model import VortexLattice
    from galerna.aero.vortex.options import VortexLatticeOptions
    from galerna.control.interface import Controller
    from galerna.coupling.afloat import Afloat
    from galerna.coupling.flexible import FlexibleMachine
    from galerna.coupling.floating_modes import FloatingMode
    from galerna.coupling.floating_report import FloatingReport
    from galerna.coupling.trim import Trim
    from galerna.inflow.field import WindField


@dataclass(frozen=True, eq=False)
class Machine:
    """A case come to life: what it simulates, in what wind, how it is run, what is recorded."""

    case: LoadedCase
    turbine: Turbine
    wind: BuiltInflow
    operation: PrescribedOperation
    simulation: Simulation
    channels: tuple[Channel, ...]
    afloat: Afloat | None = None

    def describe(self) -> Iterator[tuple[str, str]]:
        """What was built, in pairs of heading and text."""
        case, simulation = self.case.case, self.simulation
        yield "case", self.case.name
        yield "turbine", f"{case.turbine}, radius {self.turbine.rotor_radius:.4g} m"
        for line in self.wind.description:
            yield "inflow", line
        speed, pitch = self.operation.rotor_speed.value, self.operation.pitch[0].value
        start = f"rotor speed {speed[0] / RPM:.4g} rpm, pitch {pitch[0] / DEG:.4g} deg"
        yield "operation", f"{start}{' at the start' if len(speed) + len(pitch) > 2 else ''}"
        yield "loads", ", ".join(simulation.load_models)
        if self.vortex_lattice is not None:
            from galerna.aero.vortex.summary import describe_lattice

            motion = simulation.structure.motions[list(simulation.load_models).index("rotor")]
            yield from describe_lattice(self.vortex_lattice, motion, case.time_step_s)
        if "bodies" in simulation.load_models and not any(self.turbine.nacelle.drag_area):
            yield "note", "the turbine has no drag areas of the nacelle: the tower alone has drag"
        if self.afloat is not None:
            for note in self.afloat.notes:
                yield "sea", note
            if self.report is not None:
                yield from self.report.lines()
                from galerna.coupling.floating_report import modes_in_words

                yield "frequencies", modes_in_words(self.floating_modes())
        for note in self.turbine.notes:
            yield "note", note
        steps = round(case.duration_s / case.time_step_s)
        yield "records", f"{len(self.channels)} of {len(simulation.channels)} channels"
        yield "time", f"{case.duration_s:g} s in {steps} steps of {case.time_step_s:g} s"

    def flow_writers(
        self, result: Path, overwrite: bool, since: float | None = None
    ) -> list[Callback]:
        """What writes the flow beside a result, where the case asks for it.

        A run that goes on ``since`` a time s continues what stands there.
        """
        model = self.vortex_lattice
        if model is None or model.options.flow_output is None:
            return []
        from galerna.flow_output import FlowWriter, flow_folder

        with self.case.blame("aerodynamics", "flow_output"):
            folder = flow_folder(result)
            return [FlowWriter(model, model.options.flow_output, folder, overwrite, since)]

    @cached_property
    def report(self) -> FloatingReport | None:
        """How its platform floats at rest; None where nothing floats."""
        floating = None if self.afloat is None else self.afloat.floating
        if floating is None or floating.burden is None:
            return None
        from galerna.coupling.floating_report import FloatingReport

        gravity = cast("FlexibleMachine", self.simulation.structure).system.gravity
        return FloatingReport.of(floating.water, floating.burden, floating.settled, gravity)

    def floating_modes(self) -> list[FloatingMode]:
        """The platform's natural modes where it floats at rest; none where nothing floats."""
        from galerna.coupling.build import turbine_options
        from galerna.coupling.floating_report import modes_of

        floating = None if self.afloat is None else self.afloat.floating
        if self.afloat is None or floating is None or floating.burden is None:
            return []
        options = turbine_options(self.case, self.turbine, self.operation, self.afloat)
        return modes_of(
            self.turbine, options, floating.water, floating.burden, floating.settled,
            self.afloat.database,
        )  # fmt: skip

    @property
    def vortex_lattice(self) -> VortexLattice | None:
        """The rotor's model, if it is a vortex lattice."""
        if isinstance(self.case.case.aerodynamics, BemOptions):
            return None
        return cast("VortexLattice", self.simulation.load_models["rotor"])

    def notices(self) -> tuple[str, ...]:
        """What a user should know of the run so far, a line each."""
        wake = self.vortex_lattice.notices if self.vortex_lattice is not None else ()
        return (*wake, *getattr(self.simulation.commander, "notices", ()))

    def close(self) -> None:
        """Let go of what outlives a run otherwise: a controller's process."""
        let_go(self.simulation)

    def doubts(self) -> Iterator[str]:
        """What can be simulated but is hardly meant, a sentence each."""
        yield from doubts.doubts(self.case.case, self.turbine, self.operation, self.wind.mean_speed)
        if self.afloat is not None:
            yield from self.afloat.warnings
        if self.report is not None:
            yield from self.report.doubts()


def build_machine(case: LoadedCase, controller: Controller | None = None) -> Machine:
    """Everything that a run needs, wind included; nothing has moved yet.

    A ``controller`` made in Python commands a case with external control. Raises InputError with
    the line of the key that cannot be satisfied.
    """
    with case.blame("turbine"):
        turbine = load_turbine(case)
    commanding = controller_of(case, turbine, controller)  # its files are looked for at once
    afloat = afloat_of(case, turbine)
    wind = build_wind(case, turbine)
    trim = _trim(case, turbine, wind, afloat)
    with case.blame("operation"):
        operation = _operation(case, turbine, wind.mean_speed, trim)
    simulation = assembled(case, turbine, wind, operation, commanding, afloat, trim)
    channels = _chosen_channels(case, simulation)
    return Machine(case, turbine, wind, operation, simulation, channels, afloat)


def assembled(
    case: LoadedCase,
    turbine: Turbine,
    wind: BuiltInflow,
    operation: PrescribedOperation,
    commanding: Controller | None,
    afloat: Afloat | None = None,
    trim: Trim | None = None,
) -> Simulation:
    """The simulation of a case: loads, structure and controller in its time loop.

    A machine that moves starts as ``trim`` says; without it, it stands as it was described.
    """
    settings = case.case
    with case.blame("aerodynamics"):
        models = load_models(case, turbine, wind, operation)
    if afloat is not None:
        models |= afloat.models
    stations = [model.stations for model in models.values()]
    structure: Structure
    commander: Commander | None = None
    if settings.moves:
        from galerna.coupling.build import control_loop, moving_machine

        with case.blame("structure"):
            structure = moving_machine(case, turbine, operation, stations, afloat)
            torque = None if trim is None else trim.start(structure, operation, models)
        if commanding is not None:
            with case.blame("control"):
                hub_wind = wind.field.hub_velocity
                commander = control_loop(case, turbine, structure, hub_wind, commanding)
                if torque is not None:
                    train = PowerTrain.of(turbine.drivetrain)
                    commander.torque = train.generator_torque(torque)
    else:
        with case.blame("operation"):
            structure = PrescribedMotion(turbine, operation, stations)
    probes: dict[str, Probe] = {"wind": HubWindProbe(wind.field)}
    if afloat is not None:
        probes["waves"] = afloat.probe
    with case.blame("time_step_s"):
        return Simulation(
            structure, models, settings.time_step_s, commander=commander, probes=probes
        )


def let_go(simulation: Simulation) -> None:
    """Close a controller that has something to close, such as a process."""
    close = getattr(simulation.commander, "close", None)
    if close is not None:
        close()


def load_turbine(case: LoadedCase) -> Turbine:
    """The turbine of a case: a built-in name, or a file relative to the case's folder."""
    name = case.case.turbine
    beside = case.folder / name
    return turbines.load(beside if beside.is_file() else name)


def build_wind(case: LoadedCase, turbine: Turbine) -> BuiltInflow:
    """The wind of a case, made for its turbine and duration."""
    watch()
    settings = case.case
    with case.blame("inflow"):
        return build(
            settings.inflow,
            RotorExtent.of(turbine),
            settings.duration_s,
            base_folder=case.folder,
            seed=settings.seed,
        )


def wind_of_result(dataset: xarray.Dataset) -> WindField:
    """The wind of a result, made again from the case in it; InputError where files are gone."""
    case = parse(dataset.attrs["case"], "the result's case", dataset.attrs["case_folder"])
    lasting = case.lasting(float(dataset.attrs["duration_s"]))
    return build_wind(lasting, load_turbine(lasting)).field


def load_models(
    case: LoadedCase, turbine: Turbine, wind: BuiltInflow, operation: PrescribedOperation
) -> dict[str, LoadModel]:
    """The loads on the machine of a case, by name."""
    settings, density = case.case, case.case.air_density_kg_m3
    rotor: LoadModel
    if isinstance(settings.aerodynamics, BemOptions):
        options = settings.aerodynamics
        rotor = BladeElementMomentum(turbine, wind.field, air_density=density, options=options)
    else:
        rotor = _vortex_lattice(settings, settings.aerodynamics, turbine, wind, operation)
    if not settings.tower_and_nacelle_drag:
        return {"rotor": rotor}
    return {"rotor": rotor, "bodies": BodyDrag(turbine, wind.field, air_density=density)}


def _vortex_lattice(
    case: Case,
    options: VortexLatticeOptions,
    turbine: Turbine,
    wind: BuiltInflow,
    operation: PrescribedOperation,
) -> VortexLattice:
    """The vortex lattice of a case; its wake goes further than a box of turbulence reaches."""
    from galerna.aero.vortex.model import VortexLattice

    everywhere = wind.field.held_everywhere()
    return VortexLattice(
        turbine,
        everywhere,
        rotor_speed=operation.rotor_speed.mean(case.duration_s),
        wind_speed=wind.mean_speed,
        time_step=case.time_step_s,
        air_density=case.air_density_kg_m3,
        options=options,
        wake_inflow=everywhere if options.wake_turbulence else everywhere.without_turbulence(),
    )


def controller_of(
    case: LoadedCase, turbine: Turbine, from_outside: Controller | None = None
) -> Controller | None:
    """What commands the machine of a case, if anything does."""
    if case.case.control is None:
        return None
    from galerna.coupling.controllers import controller

    return controller(case, turbine, from_outside)


def afloat_of(case: LoadedCase, turbine: Turbine, duration: float | None = None) -> Afloat | None:
    """The water of a case that has a sea, made for its duration or another one, s."""
    if case.case.sea is None:
        return None
    from galerna.coupling.afloat import build_water

    return build_water(case, turbine, duration)


def _trim(
    case: LoadedCase, turbine: Turbine, wind: BuiltInflow, afloat: Afloat | None
) -> Trim | None:
    """What a machine that moves starts from."""
    if not case.case.moves:
        return None
    from galerna.coupling.build import trim_of

    return trim_of(case, turbine, wind.field, afloat)


def _operation(
    case: LoadedCase, turbine: Turbine, wind_speed: float, trim: Trim | None
) -> PrescribedOperation:
    """Rotor speed, pitch and yaw of a case in SI; what is not given comes from the turbine."""
    operation, blades = case.case.start, turbine.number_of_blades
    speed, pitch = operation.rotor_speed_rpm, operation.pitch_deg
    yaw, azimuth = _signal(operation.yaw_deg, DEG), operation.azimuth_deg * DEG
    if operation.operating_point == "steady" and (speed is None or pitch is None):
        if trim is None:
            point = _steady_point(case, turbine, wind_speed)
        else:
            still = Signal.constant(0.0)
            point = trim.find(PrescribedOperation(still, (still,) * blades, yaw, azimuth))
        speed = point[0] / RPM if speed is None else speed
        pitch = point[1] / DEG if pitch is None else pitch
    each = pitch if isinstance(pitch, tuple) else (pitch or 0.0,) * blades
    if len(each) != blades:
        raise InputError("pitch_deg", f"{len(each)} values for {blades} blades")
    assert speed is not None, "the case would have been refused"
    return PrescribedOperation(
        rotor_speed=_signal(speed, RPM),
        pitch=tuple(_signal(angle, DEG) for angle in each),
        yaw=yaw,
        azimuth=azimuth,
    )


def _steady_point(case: LoadedCase, turbine: Turbine, wind_speed: float) -> tuple[float, float]:
    """Rotor speed rad/s and pitch rad of the turbine's own operating curve."""
    from galerna.aero.bem.steady import power_curve

    settings = case.case
    options = settings.aerodynamics
    curve = power_curve(
        turbine,
        [wind_speed],
        air_density=settings.air_density_kg_m3,
        options=options if isinstance(options, BemOptions) else None,
    )
    return float(curve["rotor_speed"][0]), float(curve["pitch"][0])


def _signal(value: float | Series, unit: float) -> Signal:
    if isinstance(value, Series):
        return Signal(np.array(value.time_s), unit * np.array(value.values))
    return Signal.constant(unit * value)


def _chosen_channels(case: LoadedCase, simulation: Simulation) -> tuple[Channel, ...]:
    """The channels that the case's patterns name; CaseError with every one that names none."""
    patterns, available = case.case.outputs.channels, simulation.channels
    found = [matching(pattern, available) for pattern in patterns]
    problems = [
        Problem(
            ("outputs", "channels", i),
            f"{pattern!r}: no channel has this name",
            nearest(pattern, available),
        )
        for i, (pattern, chosen) in enumerate(zip(patterns, found, strict=True))
        if not chosen
    ]
    if problems:
        raise CaseError(case.document, problems)
    names = {channel.name for chosen in found for channel in chosen}
    return tuple(channel for channel in available if channel.name in names)


class HubWindProbe:
    """The undisturbed wind on the tower axis at the hub's height, as channels."""

    channels = (
        Channel("wind_speed", "m/s", "wind speed at hub height", (), "Wind1VelMag", "m/s"),
        Channel("wind_x", "m/s", "wind along x at hub height", (), "Wind1VelX", "m/s"),
        Channel("wind_y", "m/s", "wind along y at hub height", (), "Wind1VelY", "m/s"),
        Channel("wind_z", "m/s", "wind along z at hub height", (), "Wind1VelZ", "m/s"),
    )

    def __init__(self, wind: WindField) -> None:
        self.coordinates: Mapping[str, Array] = {}
        self._wind = wind

    def record(self, time: float) -> Mapping[str, float | Array]:
        """The wind at ``time`` s."""
        x, y, z = self._wind.hub_velocity(time).tolist()
        return {"wind_speed": (x * x + y * y + z * z) ** 0.5, "wind_x": x, "wind_y": y, "wind_z": z}
