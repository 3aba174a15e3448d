"""The vortex lattice in a turbulence box beside blade-element momentum: dissertation 4.2.3.

The straightened DTU 10 MW stands in for the AVATAR rotor (``rotors.like_the_avatar``); the box
is Mann's with the length and the shear parameter of the dissertation's table 4.2 and its
turbulence intensity, of other random numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.signal import welch

from galerna.aero.bem.options import BemOptions
from galerna.aero.sections import blade_sections
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.contract import Array
from galerna.inflow.field import WindField
from galerna.inflow.mann import mann_box
from galerna.inflow.mean import HubWind, Profile, Steady
from galerna.units import RPM

from .framework import Case, Check, statement
from .rotors import (
    BRISK,
    Options,
    constant_operation,
    dynamic_pressure_force,
    like_the_avatar,
    load_model,
    march,
)

FILTERED = BemOptions(tower_influence=False, spanwise_filter="loads")
MODELS: dict[str, Options] = {
    "UVLM": BRISK,
    "UVLM quasi-steady": BRISK.model_copy(update={"quasi_steady": True}),
    "BEM": BemOptions(tower_influence=False),
    "BEM + filter": FILTERED,
    "BEM quasi-steady + filter": FILTERED.model_copy(update={"quasi_steady": True}),
}
LENGTH_SCALE, SHEAR, INTENSITY, SEED = 29.4, 3.9, 0.16, 100


@dataclass(frozen=True)
class Run:
    """Steps per revolution, revolutions left out at the start, and those looked at."""

    steps: int
    start: int
    revolutions: int


LONG, FINE = Run(48, 3, 15), Run(144, 1, 2)
RADII = (0.45, 0.75)
UNSTEADY, HIGHLY_UNSTEADY = 0.05, 0.6  #: reduced frequencies of thin-airfoil theory
RESOLVED = 6  #: steps per period, from which on a frequency counts as resolved
SOURCE = "dissertation 4.2.3, AVATAR rotor, table {}"

#: Mean and standard deviation: M_out, M_in in MN m (tables 4.8, 4.11), C_T, C_P (4.9, 4.12)
DISSERTATION = {
    "UVLM": ((28.10, 5.59), (3.03, 1.14), (0.54, 0.073), (0.36, 0.091)),
    "UVLM quasi-steady": ((27.77, 6.86), (3.03, 1.45), (0.55, 0.071), (0.37, 0.081)),
    "BEM": ((25.78, 7.61), (2.61, 1.38), (0.51, 0.096), (0.33, 0.109)),
    "BEM + filter": ((25.69, 7.39), (2.52, 1.37), (0.49, 0.089), (0.31, 0.103)),
    "BEM quasi-steady + filter": ((26.08, 6.91), (2.58, 1.29), (0.50, 0.086), (0.31, 0.103)),
}
NAMES = ("M_out", "M_in", "C_T", "C_P")


@cache
def turbulent_wind() -> WindField:
    """The box, long enough for the whole run, about the hub."""
    turbine, wind, _, _ = like_the_avatar()
    box = mann_box(
        (1024, 128, 128), (2.0, 2.0, 2.0), length_scale=LENGTH_SCALE, shear_parameter=SHEAR,
        mean_speed=wind, hub_height=turbine.hub_height, seed=SEED, turbulence_intensity=INTENSITY,
    )  # fmt: skip
    field = WindField(Steady(HubWind(wind)), Profile(turbine.hub_height), box)
    return field.held_everywhere()  # a wake that rolls up leaves the box here and there


def series(model: str, run: Run = LONG) -> dict[str, Array]:
    """What ``_series`` has kept."""
    return _series(model, run)


@cache
def _series(model: str, run: Run) -> dict[str, Array]:
    """Blade 1 and rotor over time after the start; c_out and c_in (time, len(RADII)) 1/m."""
    turbine, wind, speed, pitch = like_the_avatar()
    dt = 60.0 / speed / run.steps
    options = MODELS[model]
    if isinstance(options, VortexLatticeOptions):
        options = options.model_copy(update={"wake_step_deg": 360.0 / run.steps})
    loads = load_model(turbine, turbulent_wind(), options, wind, speed, dt)
    operation = constant_operation(turbine, speed, pitch)
    history = march(turbine, loads, operation, dt, (run.start + run.revolutions) * run.steps)
    history = {name: values[run.start * run.steps :] for name, values in history.items()}
    force, radius = dynamic_pressure_force(turbine, wind), loads.coordinates["radius"]
    at = np.array(RADII) * turbine.rotor_radius
    result: dict[str, Array] = {
        "time": np.linspace(
            0.0, 60.0 / speed * run.revolutions, run.revolutions * run.steps, False
        ),
        "radius": radius,
    }
    for name, channel in (("c_out", "normal_force"), ("c_in", "tangential_force")):
        blade = history[channel][:, 0] / force
        result[name] = np.array([np.interp(at, radius, row) for row in blade])
        result[f"{name}_deviation"] = blade.std(axis=0)
    result["M_out"] = history["aerodynamic_root_out_of_plane_moment"][:, 0] / 1e6
    result["M_in"] = history["aerodynamic_root_in_plane_moment"][:, 0] / 1e6
    result["C_T"] = history["rotor_thrust"] / force
    result["C_P"] = history["rotor_power"] / (force * wind)
    return result


def reduced_frequency_1p(place: int) -> float:
    """Reduced frequency of a change once a revolution at RADII[place]."""
    turbine, wind, speed, _ = like_the_avatar()
    radius = RADII[place] * turbine.rotor_radius
    sections = blade_sections(turbine)
    chord = np.interp(radius, turbine.hub.radius + sections.position[:, 2], sections.chord)
    return float(0.5 * speed * RPM * chord / np.hypot(wind, speed * RPM * radius))


def spectrum(model: str, name: str, place: int, run: Run = LONG) -> tuple[Array, Array]:
    """Reduced frequencies and power spectral density of a force coefficient at RADII[place]."""
    _, _, speed, _ = like_the_avatar()
    values = series(model, run)[name][:, place]
    segment = min(4, run.revolutions) * run.steps
    frequency, power = welch(values, run.steps * speed / 60.0, nperseg=segment)
    per_hertz = reduced_frequency_1p(place) / (speed / 60.0)
    return frequency[1:] * per_hertz, power[1:] / per_hertz


def energy(model: str, name: str, place: int, low: float, high: float, run: Run = LONG) -> float:
    """Variance of a force coefficient between two reduced frequencies."""
    k, power = spectrum(model, name, place, run)
    return float(power[(k >= low) & (k < high)].sum() * (k[1] - k[0]))


def deviation(model: str, name: str) -> float:
    return float(series(model)[name].std())


def tables() -> Iterator[Check]:
    """Tables 4.8, 4.9, 4.11 and 4.12: each model's figures over the unsteady lattice's."""
    base = DISSERTATION["UVLM"]
    for model in MODELS:
        for i, name in enumerate(NAMES):
            source = SOURCE.format("4.8, 4.11" if i < 2 else "4.9, 4.12")
            mean, scatter = DISSERTATION[model][i]
            if model == "UVLM":
                ours = series(model)[name]
                yield Check(f"UVLM: standard deviation over mean of {name}",
                            float(ours.std() / ours.mean()), scatter / mean, source)  # fmt: skip
                continue
            value = float(series(model)[name].mean() / series("UVLM")[name].mean())
            yield Check(f"{model} over UVLM: mean of {name}", value, mean / base[i][0], source)
            value = deviation(model, name) / deviation("UVLM", name)
            yield Check(f"{model} over UVLM: standard deviation of {name}", value,
                        scatter / base[i][1], source)  # fmt: skip


def statements() -> Iterator[Check]:
    """What the dissertation concludes from its tables; judged where theory demands it."""
    source = SOURCE.format("4.8")
    for name in ("M_out", "M_in"):
        yield statement(
            f"quasi-steady lattice: {name} fluctuates more than unsteady",
            deviation("UVLM quasi-steady", name) > deviation("UVLM", name),
            source,
        )
        yield statement(
            f"quasi-steady BEM: {name} fluctuates less than unsteady",
            deviation("BEM quasi-steady + filter", name) < deviation("BEM + filter", name),
            source,
        )
        change = (series("UVLM quasi-steady")[name].mean() / series("UVLM")[name].mean()) - 1.0
        yield Check(
            f"quasi-steady over unsteady lattice: change of the mean of {name}",
            float(change),
            0.0,
            "means are very similar (dissertation 4.2.3)",
            0.05,
        )
    source = SOURCE.format("4.11, 4.12")
    for name in NAMES:
        raw, filtered, lattice = (deviation(m, name) for m in ("BEM", "BEM + filter", "UVLM"))
        yield statement(
            f"the filter lessens BEM's fluctuation of {name}", filtered < raw, source, judged=True
        )
        yield statement(
            f"and brings that of {name} closer to the lattice's",
            abs(filtered - lattice) < abs(raw - lattice),
            source,
        )
        yield statement(f"BEM: {name} fluctuates more than by the lattice", raw > lattice, source)
    yield statement("the lattice's mean M_out exceeds BEM's", bool(
        series("UVLM")["M_out"].mean() > series("BEM")["M_out"].mean()), source)  # fmt: skip


def spectra() -> Iterator[Check]:
    """Figs. 4.38 and 4.58: energy of the force coefficients in bands of reduced frequency."""
    source = "dissertation figures 4.38 and 4.58, read as a statement"
    for place, radius in enumerate(RADII):
        resolved = LONG.steps / RESOLVED * reduced_frequency_1p(place)
        bands = ((UNSTEADY, resolved), (resolved, np.inf))
        for name in ("c_out", "c_in"):
            lattice, quasi, bem = (
                energy(model, name, place, *bands[0])
                for model in ("UVLM", "UVLM quasi-steady", "BEM + filter")
            )
            at = f"{name} at {radius:g} R"
            band = f"0.05 < k < {resolved:.2f}"
            yield statement(f"{at}, {band}: more energy quasi-steady than unsteady (lattice)",
                            quasi > lattice, source, judged=True)  # fmt: skip
            yield statement(f"{at}, {band}: BEM with filter has more than the lattice",
                            bem > lattice, source)  # fmt: skip
            for low, high in bands:
                base = energy("UVLM", name, place, low, high)
                for model in ("UVLM quasi-steady", "BEM", "BEM + filter"):
                    ratio = energy(model, name, place, low, high) / base
                    text = f"{at}, k from {low:.2f} to {high:.2f}: energy, {model} over UVLM"
                    yield Check(text, ratio, 1.0, "the unsteady lattice of this case")


def fine_steps() -> Iterator[Check]:
    """The highly unsteady range, with steps that resolve it."""
    source = "dissertation figure 4.38, read as a statement"
    high = FINE.steps / RESOLVED * reduced_frequency_1p(0)
    for name in ("c_out", "c_in"):
        lattice, quasi = (
            energy(model, name, 0, HIGHLY_UNSTEADY, high, FINE)
            for model in ("UVLM", "UVLM quasi-steady")
        )
        at = f"{name} at {RADII[0]:g} R, {HIGHLY_UNSTEADY:g} < k < {high:.2f}"
        yield Check(f"{at}: energy, quasi-steady over unsteady lattice", quasi / lattice, 1.0,
                    "the unsteady lattice of this case")  # fmt: skip
        yield statement(f"{at}: more energy quasi-steady than unsteady", quasi > lattice, source,
                        judged=True)  # fmt: skip


def _listed() -> tuple[Check, ...]:
    return (*tables(), *statements(), *spectra())


CASES = (
    Case("lattice-turbulence", "vortex", "Lattice and BEM in the same turbulence", _listed, 500.0,
         "Fifteen revolutions after three of start, free wake in the turbulence, drag from the "
         "polars, steps of 7.5 degrees, a wake of five revolutions. Box: L = 29.4 m, Gamma = 3.9, "
         "turbulence intensity 16 %. "
         "Another rotor and other random numbers than the dissertation's: figures are shown. "
         "Judged is what thin-airfoil theory and the filter's definition demand, at frequencies "
         "with six steps a period: at 0.45 R the blade moves by its own chord in a step, and above "
         "that the rate of circulation makes noise (lattice-turbulence-fine)."),
    Case("lattice-turbulence-fine", "vortex", "Lattice in turbulence with steps of 2.5 degrees",
         lambda: tuple(fine_steps()), 250.0,
         "Two revolutions after one of start, in the box of lattice-turbulence, for the reduced "
         "frequencies above 0.6 that its steps do not resolve."),
)  # fmt: skip
