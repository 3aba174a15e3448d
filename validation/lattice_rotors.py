"""Rotors by the vortex lattice: size of the mesh, wake models, Phase VI, remeshing."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import xarray

from galerna.aero.bem.steady import UniformWind, steady_rotor
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.contract import Array
from galerna.units import DEG, RPM

from .framework import Case, Check, statement
from .lattice_steady import Mesh, SteadyRotor, steady_lattice
from .phase_vi import ATTACHED_WIND, NORMAL, TIP_PITCH_DEG, TORQUE, phase_vi
from .rotors import (
    LATTICE,
    constant_operation,
    like_the_avatar,
    load_model,
    march,
    table,
)

SOURCE = "dissertation 3.3.1, AVATAR rotor, table {}"
BASE = Mesh(chordwise=16, spanwise=28, revolutions=7.0)
CHORDWISE, SPANWISE, REVOLUTIONS = (4, 8, 16, 32, 64), (7, 14, 20, 28, 56), (1, 3, 5, 7, 10, 20)

#: relative errors of C_T and C_P to the largest size, of the dissertation's tables 3.2 to 3.4
SPANWISE_ERRORS = {14: (-0.0112, -0.0186), 28: (-0.0119, -0.0069)}
CHORDWISE_ERRORS = {16: (-0.0615, -0.0478), 32: (-0.0258, -0.0197), 64: (-0.0083, -0.0063)}
WAKE_ERRORS = {1: (0.0767, 0.1380), 3: (0.0183, 0.0328), 5: (0.00728, 0.0130), 10: (0.0016, 0.0028)}

ENOUGH = 0.01  #: of thrust and power: what the size of a lattice may cost
#: of thrust and power by the wake's growing panels, which the dissertation finds below 0.5 %
REMESHED = 0.005

Coefficients = tuple[float, float]


def avatar_like(mesh: Mesh) -> Coefficients:
    """C_T and C_P of the stand-in for the AVATAR, prescribed wake, without drag."""
    rotor = steady_lattice(*like_the_avatar(), mesh)
    return rotor.thrust_coefficient, rotor.power_coefficient


def error(mesh: Mesh, best: Mesh) -> Coefficients:
    """What C_T and C_P of a mesh are off those of the best, as fractions."""
    ours, exact = avatar_like(mesh), avatar_like(best)
    return ours[0] / exact[0] - 1.0, ours[1] / exact[1] - 1.0


def study(name: str, size: int) -> Mesh:
    """The base mesh with another size."""
    other: dict[str, Any] = {name: size}
    return replace(BASE, **other)


def _study(
    name: str, sizes: Sequence[int], wanted: dict[int, Coefficients], source: str, unit: str
) -> Iterator[Check]:
    best = study(name, sizes[-1])
    for size in sizes[:-1]:
        for text, value, reference in zip(
            ("C_T", "C_P"), error(study(name, size), best), wanted.get(size, (0.0, 0.0)),
            strict=True,
        ):  # fmt: skip
            shown = source if size in wanted else "the largest size"
            quantity = f"{size} {unit} over {sizes[-1]}: error of {text}"
            yield Check(quantity, value, reference, shown)


def mesh_convergence() -> Iterator[Check]:
    """Tables 3.2 to 3.4, and the size that a user needs."""
    yield from _study("spanwise", SPANWISE, SPANWISE_ERRORS, SOURCE.format("3.2"), "panels of span")
    yield from _chordwise()
    yield from _study("revolutions", REVOLUTIONS, WAKE_ERRORS, SOURCE.format("3.4"), "revolutions")
    source = "dissertation 3.3.1: 0.2 % and 0.3 % from steps of 8 deg to 0.5 deg"
    for text, value in zip(
        ("C_T", "C_P"), error(replace(BASE, step_deg=8.0), replace(BASE, step_deg=1.0)), strict=True
    ):
        yield Check(f"steps of 8 deg over 1 deg: error of {text}", value, 0.0, source, 0.005)
    best = Mesh(chordwise=64, spanwise=28, revolutions=20.0)
    user = Mesh(chordwise=8, spanwise=20, revolutions=9.0)
    for text, value in zip(("C_T", "C_P"), error(user, best), strict=True):
        quantity = f"8 x 20 panels, 9 revolutions over 64 x 28 and 20: error of {text}"
        yield Check(quantity, value, 0.0, "the largest size", ENOUGH)


def edges(chordwise: int) -> Mesh:
    """The base mesh with rings on its panels' edges, as other lattices have them."""
    return replace(BASE, chordwise=chordwise, rings="edges")


def _chordwise() -> Iterator[Check]:
    """Table 3.3: rings and normals as the dissertation's, and as galerna's."""
    best = study("chordwise", CHORDWISE[-1])
    for size in (16, 32, 64):
        for text, own, true, wanted in zip(
            ("C_T", "C_P"), error(edges(size), edges(128)), error(edges(size), best),
            CHORDWISE_ERRORS[size], strict=True,
        ):  # fmt: skip
            quantity = f"{size} panels of chord over 128, rings on edges: error of {text}"
            yield Check(quantity, own, wanted, SOURCE.format("3.3"), TREND)
            quantity = f"{size} panels of chord, rings on edges: error of {text}"
            yield Check(quantity, true, 0.0, "64 panels of galerna's own")
    for size in CHORDWISE[:-1]:
        judged = ENOUGH if size >= 8 else None
        for text, value in zip(("C_T", "C_P"), error(study("chordwise", size), best), strict=True):
            quantity = f"{size} panels of chord, galerna's own, over 64: error of {text}"
            yield Check(quantity, value, 0.0, "64 panels", judged)


#: of the errors by chordwise panels, which depend on the rotor's camber lines
TREND = 0.01

DESIGN = (10.0, 7.5)  #: wind m/s and tip-speed ratio for which the DTU 10 MW is made


@cache
def design_point() -> tuple[float, float, float]:
    """Wind m/s, rotor speed rpm and pitch deg of the DTU 10 MW's best power."""
    turbine = like_the_avatar()[0]
    wind, ratio = DESIGN
    return wind, ratio * wind / turbine.rotor_radius / RPM, 0.0


def at_point(point: str, *, free: bool) -> SteadyRotor:
    """The straightened DTU 10 MW by the steady lattice at one of ``POINTS``."""
    turbine, *operation = like_the_avatar()
    wind, speed, pitch = operation if point == "as the AVATAR" else design_point()
    return steady_lattice(turbine, wind, speed, pitch, Mesh(step_deg=10.0, free=free))


POINTS = ("as the AVATAR", "design point")


@cache
def bem_point(point: str) -> xarray.Dataset:
    """The same by blade-element momentum."""
    turbine, *operation = like_the_avatar()
    wind, speed, pitch = operation if point == "as the AVATAR" else design_point()
    return steady_rotor(turbine, wind, speed * RPM, pitch * DEG)


def by_bem(point: str) -> Coefficients:
    """C_T and C_P by blade-element momentum."""
    bem = bem_point(point)
    return float(bem["thrust_coefficient"]), float(bem["power_coefficient"])


#: C_T and C_P of table 4.3: wake, drag
TABLE_43 = {
    (True, False): (0.66, 0.52), (True, True): (0.66, 0.48),
    (False, True): (0.68, 0.50), (False, False): (0.68, 0.55),
}  # fmt: skip


def wake_models() -> Iterator[Check]:
    """Table 4.3: free and prescribed wake, with and without drag, BEM."""
    source = "dissertation 4.2.1, AVATAR rotor, table 4.3"
    for point in POINTS:
        rotors = {free: at_point(point, free=free) for free in (True, False)}
        for (free, drag), wanted in TABLE_43.items():
            rotor = rotors[free]
            ours = (
                (rotor.thrust_with_drag, rotor.power_with_drag)
                if drag
                else (rotor.thrust_coefficient, rotor.power_coefficient)
            )
            wake = "free" if free else "prescribed"
            name = f"{point}: {wake} wake, {'drag' if drag else 'no drag'}"
            yield Check(f"{name}: C_T", ours[0], wanted[0], source)
            yield Check(f"{name}: C_P", ours[1], wanted[1], source)
        for text, value, figure in zip(("C_T", "C_P"), by_bem(point), (0.66, 0.45), strict=True):
            yield Check(f"{point}: BEM: {text}", value, figure, source)
        yield from _wake_statements(point, rotors, source)


def _wake_statements(point: str, rotors: dict[bool, SteadyRotor], source: str) -> Iterator[Check]:
    free, held = rotors[True], rotors[False]
    thrust = free.thrust_coefficient / held.thrust_coefficient - 1.0
    power = free.power_coefficient / held.power_coefficient - 1.0
    alike = point == "as the AVATAR"
    limits = FREE if alike else (None, None)
    yield Check(f"{point}: the free wake's change of C_T", thrust, -0.03, source, limits[0])
    yield Check(f"{point}: the free wake's change of C_P", power, -0.05, source, limits[1])
    drag = held.power_with_drag / held.power_coefficient - 1.0
    judged = None if alike else DRAG
    yield Check(f"{point}: drag's change of C_P, prescribed wake", drag, -0.08, source, judged)
    bem = by_bem(point)
    yield statement(f"{point}: the free wake comes closer to BEM in thrust",
                    abs(free.thrust_with_drag - bem[0]) < abs(held.thrust_with_drag - bem[0]),
                    source, judged=True)  # fmt: skip
    yield statement(f"{point}: and in power",
                    abs(free.power_with_drag - bem[1]) < abs(held.power_with_drag - bem[1]),
                    source, judged=True)  # fmt: skip


#: "a few percent" of another rotor's thrust and power; "about 8 %"
FREE, DRAG = (0.03, 0.05), 0.02


def phase_vi_lattice() -> Iterator[Check]:
    """Torque and normal force coefficients at 7 and 10 m/s, with drag."""
    source = "NREL UAE Phase VI, sequence H"
    measured = table("phase_vi_sections.csv")
    turbine = phase_vi()
    pitch = TIP_PITCH_DEG - turbine.blade.shape.twist[-1] / DEG
    for row in table("phase_vi_performance.csv"):
        wind, speed, density = (
            float(row[name]) for name in ("wind_speed_m_s", "rpm", "rho_kg_m3")
        )  # fmt: skip
        if row["sequence"] != "H" or wind > 10.0:
            continue
        attached = wind == ATTACHED_WIND
        rotor = steady_lattice(turbine, wind, speed, pitch, PHASE_VI_MESH, density)
        angle = rotor.angle_of_attack
        normal = rotor.lift_coefficient * np.cos(angle) + rotor.drag_coefficient * np.sin(angle)
        scale = 0.5 * density * wind**3 * np.pi * turbine.rotor_radius**2 / (speed * RPM)
        yield Check(f"{wind:g} m/s: torque", rotor.power_with_drag * scale,
                    float(row["lsstqcor_nm"]), source, TORQUE if attached else None, "N m",
                    relative=True)  # fmt: skip
        for place in (m for m in measured if m["file_name"] == row["file_name"]):
            at = float(place["r_over_R"])
            value = float(np.interp(at * 5.029, rotor.radius, normal))
            judged = NORMAL if attached and 0.4 < at < 0.9 else None
            yield Check(f"{wind:g} m/s, {at:.0%} of the radius: normal force coefficient", value,
                        float(place["cn"]), source, judged)  # fmt: skip


PHASE_VI_MESH = Mesh(revolutions=5.0, step_deg=10.0, free=True)


def remeshing() -> Iterator[Check]:
    """Growing panels against equal ones: thrust, power and the time of a step."""
    _half_a_turn(GROWING, 0.0, steps=1)  # compiles what both need
    _half_a_turn(EQUAL, 0.0, steps=1)
    for yaw in (0.0, 30.0):
        growing, equal = (_half_a_turn(options, yaw) for options in (GROWING, EQUAL))
        judged = REMESHED if yaw == 0.0 else None
        for name in ("rotor_thrust", "rotor_power"):
            rms = float(np.sqrt(np.mean((growing[name] / equal[name] - 1.0) ** 2)))
            text = name.removeprefix("rotor_")
            quantity = f"{yaw:g} deg of yaw, {text}: root mean square of the relative difference"
            yield Check(quantity, rms, 0.0, "galerna, equal panels", judged)
        source = "dissertation 4.1.2: 90 % of the time saved, in turbulence"
        left = float(growing["wake_panels"][0] / equal["wake_panels"][0])
        yield Check(
            f"{yaw:g} deg of yaw: share of the wake's panels saved", 1.0 - left, 0.9, source
        )
        saved = float(1.0 - growing["seconds"][0] / equal["seconds"][0])
        yield Check(f"{yaw:g} deg of yaw: share of the time saved", saved, 0.9, source)


def _half_a_turn(
    options: VortexLatticeOptions, yaw_deg: float, steps: int = 36
) -> dict[str, Array]:
    """Channels over steps of 5 degrees from the steady rotor, and the CPU ``seconds`` of all."""
    turbine, wind, speed, pitch = like_the_avatar()
    dt = 60.0 / speed / 72
    model = load_model(turbine, UniformWind(np.array([wind, 0.0, 0.0])), options, wind, speed, dt)
    started = time.process_time()
    history = march(turbine, model, constant_operation(turbine, speed, pitch, yaw_deg), dt, steps)
    return {**history, "seconds": np.array([time.process_time() - started])}


GROWING = LATTICE.model_copy(update={"wake_revolutions": 5.0})
EQUAL = GROWING.model_copy(update={"wake_growth": 1.0})


CASES = (
    Case("lattice-mesh", "vortex", "Lattice of the DTU 10 MW rotor: convergence with its size",
         lambda: tuple(mesh_convergence()), 60.0,
         "The dissertation's AVATAR blade is not public. The straightened DTU 10 MW stands in for "
         "it at its tip-speed ratio of 9.26, pitched to its thrust coefficient of 0.66; prescribed "
         "wake, no drag, 16 x 28 panels and 7 revolutions but for what is varied. With rings on "
         "the panels' edges and the panels' own normals the error falls as the dissertation's "
         "does, with the first power of the panel: what it calls converged at 64 panels is not. "
         "galerna takes the normals at the collocation points."),
    Case("lattice-wake-models", "vortex", "Free and prescribed wakes, drag, and BEM",
         lambda: tuple(wake_models()), 60.0,
         "The straightened DTU 10 MW at the AVATAR's tip-speed ratio and thrust, and at its own "
         "design point (tip-speed ratio 7.5, pitch 0), where its sections lift as they are made "
         "to; 8 x 20 panels. Coefficients are those of another rotor and shown. What a free wake "
         "takes grows with the thrust and is judged at the AVATAR's: at the design point, at a "
         "thrust coefficient of 0.88 with the prescribed wake, it is 7 % and 14 %. Drag's share of "
         "power grows as a rotor is pitched away from its best lift, in BEM as well (15 % as the "
         "AVATAR, 9 % at the design point): judged at the latter."),
    Case("lattice-phase-vi", "vortex", "NREL Phase VI by the lattice with drag",
         lambda: tuple(phase_vi_lattice()), 60.0,
         "Free wake of five revolutions, 8 x 20 panels with the camber of the polar. Judged at 7 "
         "m/s with the tolerances of phase-vi-torque and phase-vi-sections; at 10 m/s the blade is "
         "stalled inboard, which a lattice without decambering does not know."),
    Case("lattice-remeshing", "vortex", "Growing against equal wake panels",
         lambda: tuple(remeshing()), 110.0,
         "Free wake of five revolutions, over half a revolution from the steady rotor in steps of "
         "5 deg, growing panels as they come. Judged in uniform inflow, as in the dissertation. "
         "The time is that of start and steps, with the treecode on both sides; the dissertation's "
         "90 % are of direct sums, whose cost goes with the square of the panels."),
)  # fmt: skip
