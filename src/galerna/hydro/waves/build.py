"""From the ``sea:`` block of a case to its sea."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, pi
from pathlib import Path
from typing import Any

import numpy as np

from galerna.errors import InputError
from galerna.hydro import sea_options as o
from galerna.hydro.waves import irregular as random_sea
from galerna.hydro.waves import limits
from galerna.hydro.waves.current import Current
from galerna.hydro.waves.measured import from_elevation, read_elevation
from galerna.hydro.waves.sea import Sea
from galerna.hydro.waves.spectra import default_peak_enhancement, jonswap, share_left_out
from galerna.units import DEG, STANDARD_GRAVITY

_HZ = 2.0 * pi  #: rad/s
_LEVEL = 1e-3  #: m: a mean elevation below this is rounding


@dataclass(frozen=True)
class _Run:
    """What the block does not say: how long and finely the case runs, its folder and seed."""

    duration: float
    seed: int
    folder: Path
    time_step: float | None


def build_sea(
    options: o.SeaOptions,
    duration: float,
    seed: int,
    depth: float,
    gravity: float = STANDARD_GRAVITY,
    folder: Path | str = ".",
    *,
    time_step: float | None = None,
) -> Sea:
    """The sea of a block for a run of ``duration`` s, which it does not repeat within.

    ``depth`` m is the platform's, for blocks without one; 0 is unknown. ``seed`` holds for
    waves without their own; relative paths start at ``folder``. With ``time_step`` s, waves that
    are too short for it are refused. Raises InputError for waves that cannot exist.
    """
    h = options.water_depth_m or depth
    if not h > 0.0:
        what = "neither the case nor the turbine gives a water depth"
        raise InputError("sea.water_depth_m", what, "give it in m")
    water: dict[str, Any] = {
        "depth": h,
        "gravity": gravity,
        "density": options.water_density_kg_m3,
        "ramp": options.ramp_s,
        "current": _current(options.current, h),
    }
    run = _Run(duration, seed, Path(folder), time_step)
    waves = options.waves
    if isinstance(waves, o.StillWater):
        return Sea.still(**water)
    if isinstance(waves, o.RegularWaves):
        return _regular(waves, run, water)
    if isinstance(waves, o.ElevationSeries):
        return _measured(waves, run, water)
    return _irregular(waves, run, water)


def _regular(waves: o.RegularWaves, run: _Run, water: dict[str, Any]) -> Sea:
    limits.require_regular(waves.height_m, waves.period_s, water["depth"], water["gravity"])
    frequency = 2.0 * pi / waves.period_s
    return Sea.regular(
        waves.height_m,
        waves.period_s,
        direction=waves.direction_deg * DEG,
        phase=waves.phase_deg * DEG,
        warnings=_resolved(frequency, frequency, run),
        **water,
    )


def _irregular(waves: o.Jonswap | o.PiersonMoskowitz, run: _Run, water: dict[str, Any]) -> Sea:
    height, period = waves.significant_height_m, waves.peak_period_s
    warnings = limits.require_irregular(height, period, water["depth"], water["gravity"])
    enhancement = peak_enhancement(waves)
    band = band_of(waves, run.duration)
    frequency, direction, amplitude = random_sea.irregular(
        lambda w: jonswap(w, height, period, enhancement),
        band,
        amplitudes=waves.amplitudes,
        direction=waves.direction_deg * DEG,
        spreading_exponent=waves.spreading_exponent,
        seed=run.seed if waves.seed is None else waves.seed,
    )
    warnings += _resolved(band.highest, 2.0 * pi / period, run)
    notes = (_describe(waves, enhancement, band, len(frequency)),)
    return Sea(
        frequency, direction, amplitude, band.period, notes=notes, warnings=warnings, **water
    )


def peak_enhancement(waves: o.Jonswap | o.PiersonMoskowitz) -> float:
    """gamma of a block's spectrum."""
    if isinstance(waves, o.PiersonMoskowitz):
        return 1.0
    if waves.peak_enhancement is not None:
        return waves.peak_enhancement
    return default_peak_enhancement(waves.significant_height_m, waves.peak_period_s)


def band_of(waves: o.Jonswap | o.PiersonMoskowitz, duration: float) -> random_sea.Band:
    """The frequencies that a block's sea holds in a run of ``duration`` s.

    Raises InputError where the block's limits leave out the peak.
    """
    peak = 2.0 * pi / waves.peak_period_s
    lowest = (waves.lowest_frequency_hz or 0.0) * _HZ or random_sea.LOWEST * peak
    highest = (waves.highest_frequency_hz or 0.0) * _HZ or random_sea.HIGHEST * peak
    if not lowest < peak < highest:
        what = (
            f"{lowest / _HZ:.4g} to {highest / _HZ:.4g} Hz leave out the spectrum's peak at "
            f"{peak / _HZ:.4g} Hz"
        )
        raise InputError("sea.waves", what, "widen lowest_frequency_hz and highest_frequency_hz")
    repeat = random_sea.repeat_after(duration, waves.peak_period_s)
    return random_sea.Band(lowest, highest, repeat)


def _describe(
    waves: o.Jonswap | o.PiersonMoskowitz, enhancement: float, band: random_sea.Band, n: int
) -> str:
    below, above = share_left_out(band.lowest, band.highest, 2.0 * pi / waves.peak_period_s)
    return (
        f"waves: {waves.kind}, {waves.significant_height_m:g} m and {waves.peak_period_s:g} s, "
        f"peak enhancement {enhancement:.3g}; {n} frequencies from {band.lowest / _HZ:.3g} to "
        f"{band.highest / _HZ:.3g} Hz leave out at most {100.0 * (below + above):.2g} % of the "
        f"variance; they repeat after {band.period:.4g} s"
    )


def _measured(waves: o.ElevationSeries, run: _Run, water: dict[str, Any]) -> Sea:
    where = "sea.waves"
    if waves.path is not None:
        where = str(run.folder / waves.path)
        time, elevation = read_elevation(run.folder / waves.path)
    else:
        time, elevation = np.array(waves.time_s), np.array(waves.elevation_m)
    limits.require_depth(where, float(np.ptp(elevation)), water["depth"])
    highest = inf if waves.highest_frequency_hz is None else waves.highest_frequency_hz * _HZ
    frequency, amplitude, period, mean = from_elevation(
        time,
        elevation,
        duration=run.duration,
        lowest=waves.lowest_frequency_hz * _HZ,
        highest=highest,
        where=where,
    )
    if not len(frequency):
        raise InputError(where, "no frequency stands within the limits", "widen them")
    kept = float(0.5 * np.sum(np.abs(amplitude) ** 2))
    note = (
        f"waves: given elevation, {len(frequency)} frequencies to {frequency[-1] / _HZ:.3g} Hz, "
        f"standard deviation {kept**0.5:.4g} m"
    )
    warnings = _resolved(frequency[-1], frequency[-1], run) if isfinite(highest) else ()
    if abs(mean) > _LEVEL:
        warnings += (f"waves: the elevation's mean of {mean:.4g} m is left out",)
    direction = np.full(len(frequency), waves.direction_deg * DEG)
    return Sea(frequency, direction, amplitude, period, notes=(note,), warnings=warnings, **water)


def _resolved(highest: float, peak: float, run: _Run) -> tuple[str, ...]:
    if run.time_step is None:
        return ()
    return limits.require_resolved(highest, run.time_step, peak)


def _current(profile: o.CurrentProfile | None, depth: float) -> Current:
    if profile is None:
        return Current.none()
    direction = np.multiply(profile.direction_deg, DEG)
    if isinstance(profile, o.CurrentTable):
        return Current.table(profile.depth_m, profile.speed_m_s, direction)
    if isinstance(profile, o.PowerLawCurrent):
        return Current.power_law(profile.speed_m_s, float(direction), depth, profile.exponent)
    return Current.uniform(profile.speed_m_s, float(direction))
