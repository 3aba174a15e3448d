"""From a case to the water that its platform floats in, and to how it floats at rest."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from galerna.case import Case, LoadedCase
from galerna.contract import Array, LoadModel, Stations
from galerna.coupling.equilibrium import SteadyMachine
from galerna.coupling.floating import (
    PASSES,
    SETTLED,
    Burden,
    Pose,
    WaterAtRest,
    burden_of,
)
from galerna.errors import ConvergenceError, InputError
from galerna.hydro.database import HydroDatabase
from galerna.hydro.drag import ViscousDrag
from galerna.hydro.files import read_database
from galerna.hydro.hull import build_hull
from galerna.hydro.hydrostatics import NonlinearBuoyancy
from galerna.hydro.mooring import mooring_loads
from galerna.hydro.platform_options import PlatformOptions
from galerna.hydro.potential_flow import PotentialFlow
from galerna.hydro.radiation.stored import stored_radiation
from galerna.hydro.rigid import MODES
from galerna.hydro.sea_options import SeaOptions
from galerna.hydro.strips import Carrier
from galerna.hydro.waves import Sea, WaveProbe, build_sea
from galerna.structure.foundation import DOWNWARDS, Spar
from galerna.structure.frames import roll_pitch_yaw, turned_by
from galerna.turbine.model import Tower, Turbine
from galerna.turbine.platform import Platform
from galerna.units import DEG, STANDARD_GRAVITY

SAME_HULL = 0.05  #: of the volume, by which database and platform may differ
SAME_GRAVITY = 1e-4
SAME_DEPTH = 0.05  #: of the depth, by which database and sea may differ
DEEP = 200.0  #: m: waves of 20 s and less do not feel the ground


@dataclass(eq=False)
class Floating:
    """A platform that floats: ``pose`` is where it is held while its machine is trimmed.

    ``displaced`` (6,) m and rad is added to the equilibrium at the start: surge, sway, heave,
    roll, pitch, yaw. ``burden`` and ``settled`` are those of the last equilibrium.
    """

    water: WaterAtRest
    pose: Pose
    displaced: Array
    burden: Burden | None = None
    settled: Pose = field(default_factory=lambda: Pose(np.zeros(3), np.eye(3)))

    def settle(self, machine: SteadyMachine, rotor_speed: float, pitch: Array) -> None:
        """Hold a machine where it floats at a rotor speed rad/s and a pitch (b,) rad.

        Raises ConvergenceError where the platform and what it carries find no balance.
        """
        for _ in range(PASSES):
            states = machine.at(rotor_speed, pitch).states
            self.burden = burden_of(machine.machine, states, self.pose)
            found = self.water.equilibrium(self.burden, self.pose, machine.system.gravity)
            distance = found.distance(self.pose)
            machine.carry(self.pose, found)
            if distance < SETTLED:
                self.settled.take(found)
                self.water.settle(found)
                return
        what = f"platform and rotor find no balance: the last pass moved it by {distance:.3g}"
        raise ConvergenceError("platform", what, "start it with another operation")

    def displace(self, machine: SteadyMachine) -> None:
        """Take the machine from its equilibrium to where it starts."""
        if self.displaced.any():
            machine.carry(self.pose, displaced(self.pose, self.displaced))


def displaced(pose: Pose, by: Array) -> Pose:
    """A pose with displacements m and angles rad (6,) added to its own."""
    return Pose(pose.position + by[:3], turned_by(*(roll_pitch_yaw(pose.rotation) + by[3:])))


@dataclass(frozen=True, eq=False)
class Afloat:
    """The water of a case: its load models, what shows the waves, and the platform in it.

    ``floating`` is None where the platform is moved as is prescribed.
    """

    sea: Sea
    database: HydroDatabase
    models: dict[str, LoadModel]
    probe: WaveProbe
    floating: Floating | None

    @property
    def notes(self) -> tuple[str, ...]:
        """What was made of sea and coefficients, a line each."""
        return (*self.sea.notes, *_of_models(self.models, "notes"))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is in doubt about them."""
        return (*self.sea.warnings, *_of_models(self.models, "warnings"))


def build_water(case: LoadedCase, turbine: Turbine, duration: float | None = None) -> Afloat:
    """The water of a case that has a sea, for its duration or another one, s.

    Raises InputError, with the line of the key, for what cannot be: waves that break, a database
    that lacks what they need, lines that cannot reach.
    """
    settings = case.case
    options = settings.platform or PlatformOptions()
    assert settings.sea is not None, "the case has no sea"
    with case.blame("sea"):
        platform = _platform_of(turbine, settings.sea.water_depth_m)
        sea = build_sea(
            settings.sea,
            settings.duration_s if duration is None else duration,
            settings.seed,
            platform.water_depth,
            _gravity(settings),
            case.folder,
            time_step=settings.time_step_s,
        )
    with case.blame("platform"):
        path = _coefficients_file(case, turbine, platform, options)
        flow = _potential_flow(path, platform, sea, options)
        carrier = carrier_of(platform, turbine.tower, options)
        models = {"hydrodynamics": flow} | _carried(platform, sea, options, settings.sea, carrier)
        at_rest = models
        if carrier.stations.part != "platform":
            rigid = Carrier.rigid(platform)
            at_rest = models | _carried(platform, sea, options, settings.sea, rigid)
        floating = _floating(settings, platform, at_rest, options)
    return Afloat(
        sea, flow.database, models, WaveProbe(sea, platform.reference_point[:2]), floating
    )


def _platform_of(turbine: Turbine, depth: float | None) -> Platform:
    """The platform of a turbine in water of a depth m; InputError where there is none."""
    platform = turbine.platform
    if platform is None:
        what = f"{turbine.name!r} stands on the ground: it has no platform that floats"
        raise InputError("sea", what, "leave the sea out, or take nrel5mw_oc3")
    return platform if depth is None else replace(platform, water_depth=depth)


def _gravity(settings: Case) -> float:
    structure = settings.structure
    return STANDARD_GRAVITY if structure is None else structure.gravity_m_s2


def _coefficients_file(
    case: LoadedCase, turbine: Turbine, platform: Platform, options: PlatformOptions
) -> Path:
    """The file of coefficients that a case names, or its turbine."""
    given = options.hydrodynamics_file
    path = platform.hydrodynamics if given is None else case.folder / given
    if path is not None and path.is_file():
        return path
    what = f"{turbine.name!r} has no file of hydrodynamic coefficients"
    if path is not None:
        what = f"the file of hydrodynamic coefficients {path} is not there"
    hint = "make one with `galerna hydro` and name it in hydrodynamics_file"
    raise InputError("hydrodynamics_file", what, hint)


def _require_hull(base: HydroDatabase, platform: Platform, path: Path) -> None:
    """InputError for coefficients of a hull that displaces another volume."""
    stated = platform.displaced_volume
    if stated and abs(base.displaced_volume / stated - 1.0) > SAME_HULL:
        raise InputError(
            "hydrodynamics_file",
            f"{path.name} is of a hull that displaces {base.displaced_volume:.5g} m3, the platform "
            f"displaces {stated:.5g} m3",
            "name the file of this platform, or compute it (galerna hydro)",
        )


def like_the_sea(base: HydroDatabase, sea: Sea) -> HydroDatabase:
    """Coefficients for the sea's density; InputError where depth or gravity are others.

    All of them are proportional to the density. A depth may differ where both are deep for the
    waves of the lowest frequency, or by a twentieth.
    """
    if abs(base.gravity / sea.gravity - 1.0) > SAME_GRAVITY:
        what = f"its gravity is {base.gravity:g} m/s2, the case's {sea.gravity:g} m/s2"
        raise InputError("hydrodynamics_file", what, "give the same to both")
    shallow = min(base.water_depth, sea.depth)
    if abs(base.water_depth - sea.depth) > SAME_DEPTH * shallow and shallow < DEEP:
        what = f"it is for {base.water_depth:g} m of water, the sea has {sea.depth:g} m"
        raise InputError("hydrodynamics_file", what, "compute it for this depth (galerna hydro)")
    factor = sea.density / base.water_density
    return base if factor == 1.0 else scaled(base, factor)


def scaled(base: HydroDatabase, factor: float) -> HydroDatabase:
    """Coefficients in water of ``factor`` times the density."""
    names = ("added_mass", "damping", "added_mass_infinite", "excitation", "hydrostatic_stiffness")
    changed: dict[str, Any] = {name: factor * getattr(base, name) for name in names}
    for name in ("added_mass_zero", "mean_drift"):
        value = getattr(base, name)
        changed[name] = None if value is None else factor * value
    return replace(base, water_density=factor * base.water_density, **changed)


def _potential_flow(
    path: Path, platform: Platform, sea: Sea, options: PlatformOptions
) -> PotentialFlow:
    """The loads of potential flow with the coefficients of a file."""
    database = like_the_sea(read_database(path, platform), sea)
    _require_hull(database, platform, path)
    fit = stored_radiation(path, database.reference_point, sea.density)
    buoyancy = None
    if options.hydrostatics == "nonlinear":
        hull = build_hull(platform.members)
        buoyancy = NonlinearBuoyancy(hull, platform.reference_point, sea.density, sea.gravity)
    return PotentialFlow(platform, database, sea, options, buoyancy=buoyancy, radiation=fit)


def _carried(
    platform: Platform,
    sea: Sea,
    options: PlatformOptions,
    of_sea: SeaOptions,
    carrier: Carrier,
) -> dict[str, LoadModel]:
    """The loads that ride on a carrier's frames, by name."""
    models: dict[str, LoadModel] = {}
    if of_sea.drag:
        models["drag"] = ViscousDrag(platform, sea, stretching=of_sea.stretching, carrier=carrier)
    if platform.mooring is not None and options.mooring != "none":
        models["mooring"] = mooring_loads(platform.mooring, sea, options.mooring, carrier)
    return models


def carrier_of(platform: Platform, tower: Tower, options: PlatformOptions) -> Carrier:
    """The frames on which drag and lines act: the platform's, or those of a flexible spar.

    The keel's frame is left out: loads with tangents stand at an element's first end.
    """
    if options.model != "flexible_spar":
        return Carrier.rigid(platform)
    span = Spar.of(platform, tower, options.model).span[:-1]
    depth = platform.draft * np.outer(span, [0.0, 0.0, 1.0])
    axes = np.tile(DOWNWARDS, (len(span), 1, 1))
    return Carrier(Stations("spar", span), np.array(platform.reference_point) - depth, axes)


def _floating(
    settings: Case, platform: Platform, models: dict[str, LoadModel], options: PlatformOptions
) -> Floating | None:
    """The platform that floats; None where it is moved.

    A spar is at rest as if it did not bend: all loads then act on the platform's own frame.
    """
    start = options.start
    displaced = np.array([start.surge_m, start.sway_m, start.heave_m])
    turned = DEG * np.array([start.roll_deg, start.pitch_deg, start.yaw_deg])
    by = np.concatenate([displaced, turned])
    if settings.base_motion is not None:
        if options.locked or by.any():
            what = "locked and start are of a platform that floats; base_motion moves this one"
            raise InputError("platform", what, "leave one of them out")
        return None
    locked = tuple(MODES.index(name) for name in options.locked)
    place = np.array(platform.reference_point, dtype=float)
    return Floating(WaterAtRest(models, locked, place), Pose(place.copy(), np.eye(3)), by)


def _of_models(models: dict[str, LoadModel], name: str) -> tuple[str, ...]:
    return tuple(line for model in models.values() for line in getattr(model, name, ()))
