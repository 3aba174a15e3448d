"""Flat plates of huge span: the unsteady lattice against thin-airfoil theory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from galerna.aero.vortex.ages import growing_ages, uniform_ages
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.unsteady import UnsteadyLattice, UnsteadyOptions
from galerna.aero.vortex.wings import trapezoidal_wing
from galerna.contract import Array
from galerna.units import DEG

from .framework import Case, Check
from .thin_airfoil import gust_lift, kuessner, pitch_lift, plunge_lift, wagner

#: Chords of span: the tips are felt by 2/A = 0.02 %, and the trailing vortices are resolved.
SPAN = 1e4
#: Chords of wake: its end lacks 1/4000 of a steady lift.
LONG_WAKE = 2000.0
#: The issue's own figure for plates, over the final lift; after so many steps.
INDICIAL_TOLERANCE, FIRST_STEPS = 0.01, 10
#: Of the mean lift, at any time: the figure of the indicial functions, which it superposes.
TURBULENT_TOLERANCE = 0.01
#: Of the amplitude, and in phase: the same figure, as an angle 0.57 deg.
OSCILLATION_TOLERANCE, PHASE_TOLERANCE = 0.01, 0.57


@dataclass(frozen=True)
class Wind:
    """An inflow from a function of points (n,3) m and time s."""

    blow: Callable[[Array, float], Array]

    def velocity(self, points: Array, time: float) -> Array:
        """Velocity (n,3) m/s."""
        return self.blow(points, time)


def plate(panels: int, chord: float = 1.0, angle: float = 0.0) -> Array:
    """Corners (panels+1,2,3) m of a plate with its leading edge at x = 0."""
    corners = trapezoidal_wing(
        SPAN * chord, chord, panels, 1, angle_of_attack=angle, spanwise_spacing="uniform"
    )
    return corners - corners[0, 0] * np.array([1.0, 0.0, 1.0])


def march(
    inflow: Wind,
    surface: Callable[[float], Surface],
    ages: Array,
    step: float,
    steps: int,
    start: str = "steady",
) -> tuple[Array, Array]:
    """Times (steps,) s and forces (steps,3) N per density of a plate with a prescribed wake."""
    options = UnsteadyOptions(free=False, tree_error=None, start=start, air_density=1.0)
    lattice = UnsteadyLattice(inflow, ages, options)
    times, forces, now = [], [], 0.0
    for k in range(steps):
        lattice.begin_step(now, step, [surface(now)])
        now = (k + 1) * step
        forces.append(lattice.solve(now, [surface(now)]).loads[0].force)
        times.append(now)
        lattice.end_step(now, [surface(now)])
    return np.array(times), np.array(forces)


def coefficient(force: Array, speed: float = 1.0, chord: float = 1.0) -> Array:
    """Lift coefficients of forces (k,3) N per density."""
    return force[:, 2] / (0.5 * speed**2 * chord**2 * SPAN)


def indicial_ages(panels: int, chords: float, uniform: bool) -> Array:
    """Ages of a wake at one panel of the chord per step: even, or growing behind two chords."""
    step = 1.0 / panels
    if uniform:
        return uniform_ages(step, chords)
    return growing_ages(step, chords, near=2.0, growth=1.1, widest=4.0)


def indicial(
    kind: str, uniform: bool, panels: int = 20, chords: float = 25.0
) -> tuple[Array, Array, int]:
    """Semichords, lift over its final value, and wake panels, in a gust of 0.1 deg.

    ``kind`` "wagner" changes the angle everywhere at once, "kuessner" sends a front along the
    chord, which stands midway between two collocation points at every step.
    """
    angle, lead = 0.1 * DEG, 0.25 / panels if kind == "kuessner" else np.inf

    def blow(points: Array, time: float) -> Array:
        wind = np.zeros_like(points)
        wind[:, 0] = 1.0
        wind[:, 2] = angle * (points[:, 0] <= time + lead)
        return wind

    ages = indicial_ages(panels, chords, uniform)
    body = Surface.at_rest(plate(panels))
    times, force = march(
        Wind(blow), lambda _: body, ages, 1.0 / panels, round(chords * panels), "impulsive"
    )
    lead = lead if kind == "kuessner" else 0.0
    return 2.0 * (times + lead), coefficient(force) / (2.0 * np.pi * angle), len(ages) - 1


def indicial_checks() -> Sequence[Check]:
    return [
        *indicial_kind("wagner", wagner, "Wagner (1925), Bessel integral"),
        *indicial_kind("kuessner", kuessner, "Kuessner (1936), Bessel integral"),
    ]


def indicial_kind(kind: str, theory: Callable[[ArrayLike], Array], source: str) -> list[Check]:
    checks, lift, panels = [], {}, {}
    for wake in ("uniform", "growing"):
        s, lift[wake], panels[wake] = indicial(kind, wake == "uniform")
        error = np.abs(lift[wake] - theory(s))
        leaving = (kind == "kuessner") & (np.abs(s - 2.0) < 0.16)
        judged = (np.arange(len(s)) >= FIRST_STEPS) & ~leaving
        name = f"{kind}, {wake} wake of {panels[wake]} panels"
        checks += [
            Check(f"{name}: largest error over final lift", float(error[judged].max()), 0.0,
                  source, INDICIAL_TOLERANCE),
            Check(f"{name}: lift over final lift at s = 4", float(np.interp(4.0, s, lift[wake])),
                  float(theory(4.0)), source, INDICIAL_TOLERANCE, relative=True),
        ]  # fmt: skip
    if kind == "kuessner":
        checks.append(
            Check("kuessner: error in the steps that see the front leave the plate",
                  float(error[leaving].max()), 0.0, source)
        )  # fmt: skip
    return [
        *checks,
        Check(f"{kind}, growing against uniform wake: largest difference over final lift",
              float(np.abs(lift["growing"] - lift["uniform"]).max()), 0.0,
              "the same lift, dissertation Fig. 4.4", INDICIAL_TOLERANCE),
        Check(f"{kind}: panels of the growing wake over those of the uniform one",
              panels["growing"] / panels["uniform"], 0.0, "dissertation 4.1.2: a fraction"),
    ]  # fmt: skip


@dataclass(frozen=True)
class BladeSection:
    """The section that dissertation 3.2.1 takes at three quarters of the AVATAR blade."""

    chord: float = 3.41
    blade_speed: float = 72.92
    wind_speed: float = 10.5
    twist: float = 4.52 * DEG

    @property
    def speed(self) -> float:
        """Speed m/s of the undisturbed air relative to the section."""
        return float(np.hypot(self.blade_speed, self.wind_speed))

    @property
    def inflow_angle(self) -> float:
        """Angle rad between the relative wind and the rotor plane."""
        return float(np.arctan2(self.wind_speed, self.blade_speed))


def turbulent_wind(speed: float, seed: int = 5) -> Callable[[ArrayLike], Array]:
    """Longitudinal fluctuation m/s at a hub over time s: Kaimal's spectrum, IEC class A.

    Random phases at frequencies up to 20 Hz, spaced evenly in their logarithm.
    """
    deviation, length = 0.16 * (0.75 * speed + 5.6), 8.1 * 42.0
    edges = np.geomspace(2e-3, 20.0, 401)
    frequency = np.sqrt(edges[1:] * edges[:-1])
    x = 4.0 * length / speed
    density = deviation**2 * x / (1.0 + 1.5 * frequency * x) ** (5.0 / 3.0)
    amplitude = np.sqrt(2.0 * density * np.diff(edges))
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, len(frequency))

    def fluctuation(time: ArrayLike) -> Array:
        turns = 2.0 * np.pi * np.multiply.outer(np.asarray(time, dtype=float), frequency)
        return np.cos(turns + phase) @ amplitude

    return fluctuation


def turbulent_section(
    semichords: float = 200.0, panels: int = 16, section: BladeSection | None = None
) -> dict[str, Array]:
    """Lift coefficients over semichords: of the lattice, the convolution and steady sections.

    x runs along the mean relative wind, which carries the turbulence; the fluctuation is along
    the rotor's axis, so most of it is across the section.
    """
    section = BladeSection() if section is None else section
    gust, chord, speed = turbulent_wind(section.wind_speed), section.chord, section.speed
    along, across = np.sin(section.inflow_angle), np.cos(section.inflow_angle)
    attack = section.inflow_angle - section.twist

    def blow(points: Array, time: float) -> Array:
        fluctuation = gust(np.maximum(time - points[:, 0] / speed, 0.0))  # even before
        wind = np.zeros_like(points)
        wind[:, 0] = speed + along * fluctuation
        wind[:, 2] = across * fluctuation
        return wind

    step = chord / panels / speed
    steps = round(0.5 * semichords * panels)
    body = Surface.at_rest(plate(panels, chord, attack))
    ages = growing_ages(step, LONG_WAKE * chord / speed, near=chord / speed, growth=1.05)
    times, force = march(Wind(blow), lambda _: body, ages, step, steps)
    times = np.concatenate([[0.0], times])
    # Velocity normal to the plate over the mean speed: what thin-airfoil theory is linear in.
    normal = np.sin(attack) + gust(times) * np.cos(section.inflow_angle - attack) / speed
    s = 2.0 * speed * times / chord
    return {
        "semichords": s[1:],
        "lattice": coefficient(force, speed, chord),
        "convolution": gust_lift(s, normal)[1:],
        "steady": 2.0 * np.pi * normal[1:],
    }


def turbulence_checks() -> Sequence[Check]:
    lift = turbulent_section()
    mean, after = float(lift["convolution"].mean()), lift["semichords"] > 2.0
    error = (lift["lattice"] - lift["convolution"])[after]
    lag = (lift["steady"] - lift["convolution"])[after]
    source = "convolution of Kuessner's function, dissertation eq. 3.4"
    return [
        Check("mean lift coefficient", float(lift["lattice"].mean()), mean, source,
              TURBULENT_TOLERANCE, relative=True),
        Check("largest difference over the mean lift", float(np.abs(error).max()) / mean, 0.0,
              source, TURBULENT_TOLERANCE),
        Check("largest difference of steady sections over the mean lift",
              float(np.abs(lag).max()) / mean, 0.0, source),
        Check("correlation of the fluctuations",
              float(np.corrcoef(lift["lattice"][after], lift["convolution"][after])[0, 1]), 1.0,
              source, TURBULENT_TOLERANCE),
    ]  # fmt: skip


def oscillating_lift(motion: str, k: float, panels: int = 16, periods: int = 4) -> complex:
    """Complex lift coefficient over the amplitude of a plate that pitches or plunges.

    ``motion`` "pitch" is about the quarter chord with an amplitude of 0.1 deg, "plunge" has the
    same amplitude of downward velocity over speed.
    """
    amplitude, rate = 0.1 * DEG, 2.0 * k  # rad per chord travelled
    per_period = min(round(2 * np.pi / rate * panels), 400)  # a panel a step, or finely enough
    step = 2 * np.pi / rate / per_period
    still = plate(panels)
    arm = still - np.array([0.25, 0.0, 0.0])

    def surface(time: float) -> Surface:
        angle, turning = amplitude * np.sin(rate * time), amplitude * rate * np.cos(rate * time)
        if motion == "plunge":  # downward velocity amplitude sin, from a height of zero mean
            height = amplitude / rate * np.cos(rate * time)
            moved = still + np.array([0.0, 0.0, height])
            velocity = np.zeros_like(still) - np.array([0.0, 0.0, angle])
        else:
            moved = still + np.stack([0 * arm[..., 0], 0 * arm[..., 0], -angle * arm[..., 0]], -1)
            velocity = np.stack([0 * arm[..., 0], 0 * arm[..., 0], -turning * arm[..., 0]], -1)
        return Surface(Lattice(moved), velocity)

    def blow(points: Array, _time: float) -> Array:
        return np.tile([1.0, 0.0, 0.0], (len(points), 1))

    wave = 2 * np.pi / rate  # chords; its vortices must not be smeared
    ages = growing_ages(step, periods * wave, near=wave, growth=1.05, widest=wave / 25)
    times, force = march(Wind(blow), surface, ages, step, periods * per_period)
    last = slice(-per_period, None)
    turning = np.exp(-1j * rate * times[last])
    return complex(2j * np.mean(coefficient(force)[last] * turning)) / amplitude


def oscillation_checks() -> Sequence[Check]:
    checks = []
    for motion in ("pitch", "plunge"):
        for k in (0.05, 0.1, 0.3, 0.6, 1.0):
            value = oscillating_lift(motion, k)
            theory = complex(pitch_lift(k, -0.5) if motion == "pitch" else plunge_lift(k))
            source = "Theodorsen, NACA 496 (1935)"
            checks += [
                Check(f"{motion}, k = {k}: |lift| over amplitude", abs(value), abs(theory), source,
                      OSCILLATION_TOLERANCE, relative=True),
                Check(f"{motion}, k = {k}: phase", float(np.degrees(np.angle(value))),
                      float(np.degrees(np.angle(theory))), source, PHASE_TOLERANCE, "deg"),
            ]  # fmt: skip
    return checks


CASES = (
    Case("lattice-plate-steps", "vortex", "Flat plate: Wagner's and Kuessner's gusts",
         indicial_checks, 10.0,
         "A plate of aspect ratio 10,000 with 20 panels along the chord, a gust of 0.1 deg and 25 "
         "chords of travel, a panel a step, with a uniform wake and with one that grows by 1.1 "
         "behind two chords. Judged from the tenth step on: the first has the impulse of the "
         "added mass. While the sharp front of Kuessner's gust leaves the plate, the last panel "
         "feels it at once; those steps are shown and not judged."),
    Case("lattice-plate-turbulence", "vortex", "Flat plate in continuous turbulence",
         turbulence_checks, 10.0,
         "The section of dissertation 3.2.1 at three quarters of the AVATAR blade: chord 3.41 m, "
         "72.92 m/s, wind 10.5 m/s, Kaimal's spectrum of class A, 200 semichords. The convolution "
         "takes the velocity normal to the plate, of which eq. 3.5's angle is the first order; "
         "it leaves out that the fluctuation along the section changes the pressure."),
    Case("lattice-plate-oscillation", "vortex", "Flat plate in pitch and plunge: Theodorsen",
         oscillation_checks, 30.0,
         "Sixteen panels, a panel a step or 400 steps a period; the fourth period. Pitch is about "
         "the quarter chord."),
)  # fmt: skip
