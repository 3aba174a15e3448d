"""Corrections of blade-element momentum: the spanwise filter, unsteady sections, wakes, tower."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.special import ellipe, ellipk, hankel2

from galerna import turbine as turbines
from galerna.aero.bem.dynamic_inflow import advance_inflow, start_inflow, time_constant_ratio
from galerna.aero.bem.dynamic_stall import (
    JONES,
    advance_stall,
    section_parameters,
    separation_table,
    start_stall,
)
from galerna.aero.bem.options import BemOptions
from galerna.aero.bem.skewed_wake import vortex_cylinder
from galerna.aero.bem.spanwise_filter import filter_matrix, filter_response, keep_total
from galerna.aero.bem.steady import steady_rotor
from galerna.aero.reduced_frequency import (
    QUASI_STEADY_LIMIT,
    blade_passing_frequencies,
    reduced_frequency,
)
from galerna.aero.sections import blade_sections, strip_weights
from galerna.aero.tower_influence import across_tower
from galerna.contract import Array

from .framework import Case, Check

DISSERTATION = "dissertation, section 4.1.3, eq. 4.11"
LENGTH = 60.0  #: m, of a blade that tapers from 4.5 m to 1.5 m

#: The filter's response is a fit with a largest error of 7 % (dissertation 4.1.3).
FIT_TOLERANCE = 0.07
#: Waves of at most a quarter of the blade, in its middle half: the ends still reach there
#: with 0.36 c/y of the wave's own mean over a period, below 2 % of its amplitude.
WAVE_TOLERANCE = 0.02
#: Linear interpolation between 241 stations 0.25 m apart and cells of 1.5 to 6 cm.
GRID_TOLERANCE = 1e-3


#: Thrust and power with the filter over those without, from the differences to the lattice
#: that the dissertation's table 4.10 prints.
TURBULENT_CHANGE = (0.9875 / 1.0157, 0.9870 / 1.0559)


def filtered_wing() -> Sequence[Check]:
    span = np.linspace(0.0, LENGTH, 241)
    chord = 4.5 - 3.0 * span / LENGTH
    matrix = filter_matrix(span, chord)
    middle = np.abs(span - LENGTH / 2) < LENGTH / 4
    checks = [
        Check("H_c at 10 chords", float(filter_response(1.0, 0.1)), 0.6,
              "lattice, dissertation 4.1.3: about 40 % less", FIT_TOLERANCE, relative=True),
        Check("H_c at 1 chord", float(filter_response(1.0, 1.0)), 0.1,
              "lattice, dissertation 4.1.3: about 90 % less", FIT_TOLERANCE, relative=True),
        Check("constant load, largest value anywhere", float((matrix.sum(axis=1)).max()), 1.0,
              "a constant sheds no vorticity", 1e-9),
        Check("constant load, smallest value anywhere", float((matrix.sum(axis=1)).min()), 1.0,
              "a constant sheds no vorticity", 1e-9),
    ]  # fmt: skip
    for wavelength in (15.0, 6.0, 3.0):
        error = 0.0
        for phase in (0.0, 1.0, 2.0):
            wave = np.cos(2 * np.pi * span / wavelength + phase)
            expected = filter_response(chord, 1.0 / wavelength) * wave
            error = max(error, float(np.abs(matrix @ wave - expected)[middle].max()))
        checks.append(
            Check(f"wave of {wavelength:g} m against H_c, middle half, largest error / amplitude",
                  error, 0.0, DISSERTATION, WAVE_TOLERANCE)
        )  # fmt: skip
    bump = np.exp(-(((span - LENGTH) / 4.0) ** 2))
    root, tip = (matrix @ bump)[[0, -1]]
    checks.append(
        Check("load at the tip alone: share that reaches the root", float(root / tip), 0.0,
              "no neighbourhood of root and tip", WAVE_TOLERANCE)
    )  # fmt: skip
    load = 1.0 + 0.3 * np.sin(2 * np.pi * span / 13.0) + 0.2 * np.cos(2 * np.pi * span / 30.0)
    coarse = filter_matrix(span, chord, grid_points=1024) @ load
    checks.append(
        Check("uniform grids of 1024 and 4096 points, largest difference",
              float(np.abs(coarse - matrix @ load).max()), 0.0, "the same lift", GRID_TOLERANCE)
    )  # fmt: skip
    weight, _ = strip_weights(span, LENGTH)
    lossy = load * np.sqrt(1.0 - (span / LENGTH) ** 8)
    total = weight @ (matrix @ lossy) / (weight @ lossy) - 1.0
    kept = weight @ keep_total(matrix, weight, lossy) / (weight @ lossy) - 1.0
    return [
        *checks,
        Check("change of the total lift, tapered wing, load falling at the tip", float(total),
              0.0, "eq. 4.11 with the local chord does not keep totals", None),
        Check("the same with the total kept", float(kept), 0.0, "definition", 1e-12),
    ]  # fmt: skip


def filtered_rotor() -> Sequence[Check]:
    checks = []
    for name, speed, ratio in (("nrel5mw", 9.0, 7.5), ("dtu10mw", 9.0, 7.5)):
        turbine = turbines.load(name)
        rotation = ratio * speed / turbine.rotor_radius
        thrust = {}
        for mode in ("off", "loads", "feedback"):
            options = BemOptions(spanwise_filter=mode)
            point = steady_rotor(turbine, speed, rotation, 0.0, options=options)
            thrust[mode] = float(point.thrust), float(point.power)
        checks += [
            Check(
                f"{name}, filter on {mode}: {quantity} over unfiltered",
                thrust[mode][i] / thrust["off"][i],
                TURBULENT_CHANGE[i],
                "dissertation, table 4.10: AVATAR rotor, lower turbulence, filter on loads",
            )
            for mode in ("loads", "feedback")
            for i, quantity in enumerate(("thrust", "power"))
        ]
    return checks


def plate(indicial: Sequence[float]) -> tuple[Array, Array]:
    angle = np.linspace(-np.pi, np.pi, 721)
    polar = np.stack([2 * np.pi * angle, 0 * angle, 0 * angle], axis=1)
    table, lift_line = separation_table(polar[None], np.zeros(1))
    return table, section_parameters(lift_line, np.array(indicial))


def plunging_lift(k: float, indicial: Sequence[float], steps: int = 300) -> complex:
    """Complex lift over 2 pi alpha of a plate of chord 2 m at 1 m/s that plunges slightly."""
    table, parameters = plate(indicial)
    times = np.arange((5 + int(20 * k)) * steps + 1) * (2 * np.pi / k / steps)
    normal = 1e-3 * np.cos(k * times)
    state, advanced = np.empty(8), np.empty(8)
    start_stall(state, table, 0, parameters, 2.0, normal[0], 1.0, 0.0)
    lift = [0.0]
    for before, after, w in zip(times[:-1], times[1:], normal[1:], strict=True):
        coefficients = advance_stall(
            state, table, 0, parameters, 2.0, w, 1.0, 0.0, after - before, advanced
        )
        lift.append(coefficients[0])
        state, advanced = advanced, state
    period = slice(-steps, None)
    return complex(
        2 * np.mean(np.array(lift)[period] * np.exp(-1j * k * times[period])) / 2e-3 / np.pi
    )


def unsteady_plate() -> Sequence[Check]:
    checks = []
    for k in (0.05, 0.1, 0.3, 0.6):
        theory = hankel2(1, k) / (hankel2(1, k) + 1j * hankel2(0, k))
        value = plunging_lift(k, JONES)
        checks += [
            Check(f"|C| at k = {k}", abs(value), abs(theory), "Theodorsen, NACA 496 (1935)", 0.02),
            Check(f"phase of C at k = {k}", float(np.degrees(np.angle(value))),
                  float(np.degrees(np.angle(theory))), "Theodorsen, NACA 496 (1935)", 1.5, "deg"),
        ]  # fmt: skip
        airfoil = plunging_lift(k, (0.3, 0.7, 0.14, 0.53))
        checks.append(
            Check(f"|C - theory| at k = {k} with A, b = 0.3 0.7 0.14 0.53", abs(airfoil - theory),
                  0.0, "these belong to a compressible model with impulsive loads", None)
        )  # fmt: skip
    return checks


def delayed_wake() -> Sequence[Check]:
    tau, fraction = 8.0, 0.7
    fast = time_constant_ratio(fraction) * tau
    times = np.linspace(0.0, 30.0, 601)
    state, advanced = np.empty(3), np.empty(3)
    start_inflow(0.0, state)
    state[2] = 1.0  # the load has just stepped
    response = [0.0]
    for before, after in pairwise(times):
        response.append(advance_inflow(state, 1.0, after - before, tau, fraction, advanced))
        state, advanced = advanced, state
    # W_int jumps to k = 0.6 and rises with tau_1; W follows it with tau_2.
    slow = 0.4 * tau / (tau - fast)
    exact = 1.0 - slow * np.exp(-times / tau) - (1.0 - slow) * np.exp(-times / fast)
    return [
        Check(f"response to a step after {times[i]:g} s", response[i], float(exact[i]),
              "Oye's equations solved by hand; Snel & Schepers (1995)", 1e-9)
        for i in (20, 100, 300)
    ]  # fmt: skip


def skewed_cylinder() -> Sequence[Check]:
    checks = []
    for x in (0.25, 0.45, 0.75, 0.9):
        m = 4 * x / (1 + x) ** 2
        radial = ((2 - m) * ellipk(m) - 2 * ellipe(m)) / np.sqrt(m) / (2 * np.pi * np.sqrt(x))
        growth = (vortex_cylinder(1.0, 0.0, x, 0.1, 1.0, 0.0)[0] - 1.0) / 0.1
        # Oye's polynomial is made to stay finite at the tip: it leaves the integral there.
        checks.append(
            Check(f"first harmonic of the axial induction at {x:g} R", growth, float(4 * radial),
                  "skewed vortex cylinder, elliptic integrals; Branlard & Gaunaa (2016)",
                  0.02 if x < 0.8 else None, relative=True)
        )  # fmt: skip
    return checks


def tower() -> Sequence[Check]:
    y = np.linspace(-15.0, 15.0, 30001)
    deficit = [
        across_tower(10.0, v, 0.6, False)[0] - across_tower(10.0, v, 0.6, True)[0] for v in y
    ]
    return [
        Check("wind on the axis 2 radii upstream", 1.0 + across_tower(-2.0, 0.0, 0.6, True)[0],
              0.75, "potential flow about a circle", 1e-12),
        Check("wind beside the tower", 1.0 + across_tower(0.0, 1.0, 0.6, False)[0], 2.0,
              "potential flow about a circle", 1e-12),
        Check("momentum deficit of the shadow over C_d", float(np.trapezoid(deficit, y)) / 0.6,
              1.0, "the tower's drag; the width follows r, not x", 0.02),
    ]  # fmt: skip


def unsteadiness() -> Sequence[Check]:
    turbine = turbines.load("dtu10mw")
    sections = blade_sections(turbine)
    radius = turbine.hub.radius + sections.position[:, 2]
    speed = 0.945 * 102.88 / turbine.rotor_radius
    k = reduced_frequency(blade_passing_frequencies(speed), radius, sections.chord, 10.5, speed)
    fraction = radius / turbine.rotor_radius
    source = "dissertation 4.2.3, AVATAR 10 MW (not public); here the DTU 10 MW, same tip speed"
    checks = [
        Check(f"k of 1P at {x} R", float(np.interp(x, fraction, k[0])), reference, source, None)
        for x, reference in ((0.45, 0.055), (0.75, 0.022))
    ]
    for row, name, reference in ((0, "1P", 0.5), (1, "3P", 0.9)):
        outer = fraction[k[row] > QUASI_STEADY_LIMIT].max()
        checks.append(
            Check(f"{name} is unsteady (k > 0.05) inside r/R", float(outer), reference, source)
        )
    return checks


CASES = (
    Case("spanwise-filter", "rotor", "Spanwise filter on a finite tapered wing", filtered_wing, 1.0,
         "A wing of 60 m with chords from 4.5 m to 1.5 m, 241 stations."),
    Case("spanwise-filter-rotor", "rotor", "Spanwise filter on rotors in uniform wind",
         filtered_rotor, 10.0,
         "There are no fluctuations to smooth: what changes comes from the circulation's fall "
         "at root and tip. The dissertation's rotor is not public and its wind was turbulent, so "
         "only the size of the change can be compared."),
    Case("unsteady-plate", "rotor", "Beddoes-Leishman section: a plunging flat plate",
         unsteady_plate, 10.0,
         "Attached flow of the four-state model with Jones' constants; tolerances are the "
         "accuracy of his two-term approximation."),
    Case("dynamic-inflow-step", "rotor", "Dynamic inflow: a step of the load", delayed_wake, 1.0),
    Case("skewed-cylinder", "rotor", "Skewed wake: the vortex cylinder", skewed_cylinder, 1.0,
         "The sine and cosine parts for all skew angles are held against Biot-Savart integrals "
         "in the tests."),
    Case("tower-influence", "rotor", "Tower: dam effect and shadow", tower, 1.0),
    Case("reduced-frequency", "rotor", "Reduced frequencies along the blade", unsteadiness, 1.0),
)  # fmt: skip
