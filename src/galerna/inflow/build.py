"""From the ``inflow:`` block of a case to the wind field of a machine."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from galerna.errors import InputError
from galerna.inflow import gusts
from galerna.inflow import options as o
from galerna.inflow.box import Box
from galerna.inflow.bts import read_bts
from galerna.inflow.field import WindField
from galerna.inflow.hawc2 import read_hawc2
from galerna.inflow.iec import longitudinal_scale, normal_turbulence
from galerna.inflow.mean import Course, HubWind, Profile, Steady, TimeSeries
from galerna.inflow.sizing import BoxSize, RotorExtent, mean_deviation, require_room, size_for
from galerna.inflow.uniform_file import read_uniform
from galerna.units import DEG


@dataclass(frozen=True, eq=False)
class BuiltInflow:
    """A wind field, what it is in words, and the mean speed m/s at the hub it was built for."""

    field: WindField
    description: tuple[str, ...]
    mean_speed: float


@dataclass(frozen=True)
class Site:
    """What the block does not say: the machine, how long it runs, the case's folder and seed."""

    rotor: RotorExtent
    duration: float
    folder: Path
    seed: int

    def file(self, path: str) -> Path:
        """A path of the case, which stands relative to the case's folder."""
        return self.folder / path


def build(
    options: o.InflowOptions,
    rotor: RotorExtent,
    duration: float,
    *,
    base_folder: Path | str = ".",
    seed: int = 0,
) -> BuiltInflow:
    """The wind field of a block, for a rotor during ``duration`` s.

    Relative paths start at ``base_folder``; ``seed`` holds for turbulence without its own.
    Raises InputError for files that cannot be used and boxes too small for the rotor.
    """
    site = Site(rotor, duration, Path(base_folder), seed)
    if options.mean_in_file:
        course, profile, mean_speed, box = _wind_of_file(options, site)
    else:
        course, profile, mean_speed = _mean_wind(options, site)
        box = _fluctuations(options.turbulence, mean_speed, site)
    if options.gust is not None:
        course = _with_gust(course, options.gust, rotor)
    held_below = False
    if box is not None and options.turbulence is not None:
        held_below = options.turbulence.below_box == "hold"
        require_room(box, _with_margin(options.turbulence, rotor), duration, held_below)
    field = WindField(course, profile, box, held_below)
    return BuiltInflow(field, _describe(options, mean_speed, box), mean_speed)


def _hub_wind(options: o.InflowOptions, speed: float) -> HubWind:
    return HubWind(speed, options.direction_deg * DEG, options.upflow_deg * DEG)


def _wind_of_file(
    options: o.InflowOptions, site: Site
) -> tuple[Course, Profile, float, Box | None]:
    """The whole wind of a TurbSim file: what the case says beside it is the direction."""
    assert isinstance(options.turbulence, o.TurbSimFile)
    box = read_bts(site.file(options.turbulence.path))
    course = Steady(_hub_wind(options, box.mean_speed))
    return course, Profile.in_box(site.rotor.hub_height), box.mean_speed, box


def _mean_wind(options: o.InflowOptions, site: Site) -> tuple[Course, Profile, float]:
    """The course of the mean wind, its profile, and its mean speed m/s at the hub."""
    profile = _profile(options, site.rotor.hub_height)
    if options.wind_speed_m_s is not None:
        speed = options.wind_speed_m_s
        return Steady(_hub_wind(options, speed)), profile, speed
    if options.time_series is not None:
        series = _series(options.time_series)
    else:
        assert options.time_series_file is not None
        file = options.time_series_file
        reference_length = file.reference_length_m or 2.0 * site.rotor.radius
        series, exponent = read_uniform(site.file(file.path), reference_length)
        if exponent and not isinstance(options.shear, o.NoShear):
            what = f"has a power-law exponent of {exponent:g} and the case has a shear too"
            raise InputError(str(site.file(file.path)), what, "leave inflow.shear out")
        if exponent:
            profile = Profile.power_law(profile.hub_height, exponent, profile.veer)
    series = series.turned(options.direction_deg * DEG, options.upflow_deg * DEG)
    return series, profile, series.mean_speed(site.duration)


def _series(figures: o.WindOverTime) -> TimeSeries:
    return TimeSeries(
        figures.time_s,
        speed=figures.wind_speed_m_s,
        direction=np.multiply(figures.direction_deg or 0.0, DEG),
        upflow=np.multiply(figures.upflow_deg or 0.0, DEG),
    )


def _profile(options: o.InflowOptions, hub_height: float) -> Profile:
    veer = options.veer_deg_per_m * DEG
    match options.shear:
        case o.PowerLaw(exponent=exponent):
            return Profile.power_law(hub_height, exponent, veer)
        case o.Logarithmic(roughness_length_m=roughness_length):
            return Profile.logarithmic(hub_height, roughness_length, veer)
        case o.LinearShear(gradient_per_m=gradient):
            return Profile.linear(hub_height, gradient, veer)
    return Profile(hub_height, veer=veer)


def _with_gust(course: Course, gust: o.AnyGust, rotor: RotorExtent) -> Course:
    """The course with an event of the standard's size for the speed at its beginning."""
    speed = course.at(gust.start_s).speed
    if speed <= 0.0:
        raise InputError("inflow.gust", "needs a wind speed above 0 at its start")
    height, diameter = rotor.hub_height, 2.0 * rotor.radius
    sign = -1 if getattr(gust, "sign", "positive") == "negative" else 1
    event: gusts.Gust
    match gust:
        case o.Eog(turbine_class=strength, turbulence_class=turbulence):
            event = gusts.ExtremeOperatingGust.iec(speed, height, diameter, strength, turbulence)
        case o.Edc(turbulence_class=turbulence):
            event = gusts.ExtremeDirectionChange.iec(speed, height, diameter, turbulence, sign)
        case o.Ecd():
            event = gusts.ExtremeCoherentGust.iec(speed, sign)
        case o.Ews(turbulence_class=turbulence, direction=direction):
            event = gusts.ExtremeWindShear.iec(speed, height, diameter, turbulence, direction, sign)
    return gusts.WithGust(course, event, gust.start_s)


def _fluctuations(turbulence: o.AnyTurbulence | None, mean_speed: float, site: Site) -> Box | None:
    """The box of fluctuations about the mean wind of the case."""
    match turbulence:
        case o.TurbSimFile(path=path):
            return read_bts(site.file(path)).fluctuations()
        case o.Hawc2Files():
            return _from_hawc2(turbulence, mean_speed, site)
        case o.Mann() | o.Kaimal():
            return _generated(turbulence, mean_speed, site)
    return None


def _from_hawc2(files: o.Hawc2Files, mean_speed: float, site: Site) -> Box:
    box = read_hawc2(
        [site.file(path) for path in files.paths],
        files.points,
        files.spacing_m,
        mean_speed=mean_speed,
        hub_height=site.rotor.hub_height,
        first_row=files.first_row,
    )
    if files.bottom_m is not None:
        box = box.standing_on(files.bottom_m)
    if files.turbulence_intensity is None:
        return box
    found = mean_deviation(box)
    if found == 0.0:
        raise InputError(box.source, "holds no turbulence that could be scaled")
    return box.scaled(files.turbulence_intensity * mean_speed / found)


def _generated(turbulence: o.Mann | o.Kaimal, mean_speed: float, site: Site) -> Box:
    """A box of Mann's or Kaimal's turbulence on the grid that fits the rotor, or as given."""
    size = _size(turbulence, mean_speed, site)
    hub_height = site.rotor.hub_height
    seed = site.seed if turbulence.seed is None else turbulence.seed
    if isinstance(turbulence, o.Kaimal):
        from galerna.inflow.kaimal import kaimal_box

        box = kaimal_box(
            size.shape,
            size.spacing,
            mean_speed=mean_speed,
            hub_height=hub_height,
            seed=seed,
            turbulence_class=turbulence.turbulence_class,
            turbulence_intensity=turbulence.turbulence_intensity,
            coherent=turbulence.coherent,
            normalise=turbulence.normalise,
        )
        return box.standing_on(size.bottom)
    from galerna.inflow.mann import mann_box

    deviation = None
    if turbulence.turbulence_class is not None:
        deviation = normal_turbulence(mean_speed, turbulence.turbulence_class)
    box = mann_box(
        size.shape,
        size.spacing,
        length_scale=turbulence.length_scale_m or 0.8 * longitudinal_scale(hub_height),
        shear_parameter=turbulence.shear_parameter,
        mean_speed=mean_speed,
        hub_height=hub_height,
        seed=seed,
        alpha_epsilon=turbulence.alpha_epsilon,
        standard_deviation=deviation,
        turbulence_intensity=turbulence.turbulence_intensity,
        normalise=turbulence.normalise,
    )
    return box.standing_on(size.bottom)


def _size(turbulence: o.Generated, mean_speed: float, site: Site) -> BoxSize:
    if turbulence.points is not None and turbulence.spacing_m is not None:
        height = (turbulence.points[2] - 1) * turbulence.spacing_m[2]
        bottom = site.rotor.hub_height - 0.5 * height
        return BoxSize(turbulence.points, turbulence.spacing_m, bottom)
    return size_for(
        _with_margin(turbulence, site.rotor),
        site.duration,
        mean_speed,
        time_step=turbulence.time_step_s,
        points_across=turbulence.points_across,
    )


def _with_margin(turbulence: o.Turbulence, rotor: RotorExtent) -> RotorExtent:
    return rotor if turbulence.margin_m is None else rotor.with_margin(turbulence.margin_m)


def _describe(options: o.InflowOptions, mean_speed: float, box: Box | None) -> tuple[str, ...]:
    """What was built, a line for each part."""
    lines = [f"mean wind {mean_speed:.4g} m/s at hub height, shear: {options.shear.kind}"]
    if options.direction_deg or options.upflow_deg:
        lines.append(f"direction {options.direction_deg:g} deg, upflow {options.upflow_deg:g} deg")
    if options.gust is not None:
        lines.append(f"gust {options.gust.kind} from {options.gust.start_s:g} s")
    if box is not None:
        nx, ny, nz = box.shape
        dx, dy, dz = box.spacing
        repeats = "repeats" if box.periodic else "lasts"
        lines += [
            f"turbulence: {box.source}, {nx} x {ny} x {nz} points, "
            f"{dx:.4g} x {dy:.4g} x {dz:.4g} m apart",
            f"box {box.width:.4g} m wide, from {box.bottom:.4g} to {box.top:.4g} m; "
            f"{repeats} after {box.length / box.mean_speed:.4g} s",
            f"standard deviation of u {mean_deviation(box):.4g} m/s",
        ]
    return tuple(lines)
