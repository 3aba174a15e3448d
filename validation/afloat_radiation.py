"""Radiation of the OC3 spar: what the fit leaves, and its memory beside the convolution's."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from galerna.case import load
from galerna.contract import Array, Motion
from galerna.hydro.database import HydroDatabase
from galerna.hydro.heading import lean_of
from galerna.hydro.platform_options import PlatformOptions
from galerna.hydro.potential_flow import PotentialFlow
from galerna.hydro.radiation import RadiationStateSpace, fit_radiation, impulse_response
from galerna.hydro.rigid import point_mass
from galerna.machine import build_machine
from galerna.structure.frames import exp_so3
from galerna.turbine.platform import Platform

from .afloat import floating_of
from .afloat_database import WAMIT, shipped
from .framework import Case, Check
from .rotors import table

WANTED = 0.03  #: of the largest coefficient
DISSERTATION = {  # modes: largest error of its rational functions, eq. 2.112
    "heave-heave": (2, 2, 0.30),
    "surge-surge": (0, 0, 0.16),
    "pitch-pitch": (4, 4, 0.28),
    "sway-roll": (1, 3, 0.33),
}
RATIONAL = "dissertation, section 2.3, rational functions of Fig. 2.11, largest error"
THEORY = "Cummins (1962), Ogilvie (1964)"


def wamit() -> HydroDatabase:
    """The shipped database with WAMIT's added mass and damping, 25 frequencies."""
    *finite, limit = table("afloat/wamit_oc3_spar.csv")
    coefficients = {
        letter: np.stack([_matrix(row, letter) for row in finite]) for letter in ("A", "B")
    }
    frequency = np.array([float(row["frequency"]) for row in finite])
    return replace(
        shipped(), frequency=frequency, added_mass=coefficients["A"], damping=coefficients["B"],
        added_mass_infinite=_matrix(limit, "A"), added_mass_zero=None,
    )  # fmt: skip


def _matrix(row: dict[str, str], letter: str) -> Array:
    """The matrix (6,6) of a body of revolution from its entries in surge, heave and pitch."""
    surge, couple, heave, pitch = (float(row[letter + pair]) for pair in ("11", "15", "33", "55"))
    matrix = np.diag([surge, surge, heave, pitch, pitch, 0.0])
    matrix[0, 4] = matrix[4, 0] = couple
    matrix[1, 3] = matrix[3, 1] = -couple
    return matrix


def fits() -> Iterator[Check]:
    for name, base in (("own coefficients", shipped()), ("WAMIT's coefficients", wamit())):
        fit = fit_radiation(base)
        yield from _errors(name, fit)
        yield from _certificate(name, base, fit)


def _errors(name: str, fit: RadiationStateSpace) -> Iterator[Check]:
    own = name.startswith("own")
    for modes, (i, j, other) in DISSERTATION.items():
        text = f"{name}, {modes}: largest error"
        error = float(fit.error[i, j])
        judged = WANTED if own or modes != "pitch-pitch" else None
        yield Check(text, error, 0.0, "none" if own else WAMIT, judged, "1")
        yield Check(f"{text} beside the dissertation's", error, other, RATIONAL, None, "1")
        yield Check(f"{name}, {modes}: root mean square", float(fit.rms[i, j]), 0.0, "none",
                    WANTED / 2, "1")  # fmt: skip


def _certificate(name: str, base: HydroDatabase, fit: RadiationStateSpace) -> Iterator[Check]:
    grid = np.geomspace(1e-3, 1e3, 4000)
    K = fit.transfer(grid)
    shift = np.abs(fit.added_mass_infinite - base.added_mass_infinite)[[0, 2, 4], [0, 2, 4]]
    moved = float((shift / base.added_mass_infinite.diagonal()[[0, 2, 4]]).max())
    apart = float(np.abs(K[:, 0, 4] - K[:, 4, 0]).max() / np.abs(K[:, 0, 4]).max())
    still = float(np.abs(fit.transfer(0.0)).max() / np.abs(K).max())
    yield Check(f"{name}: states", len(fit), 0.0, "none", None, "1")
    yield Check(f"{name}: A(inf) moves by at most", moved, 0.0, "none", 1e-3, "1")
    yield Check(f"{name}: surge-pitch less pitch-surge", apart, 0.0, THEORY, 1e-12, "1")
    yield Check(f"{name}: K at rest over its largest", still, 0.0, THEORY, 1e-9, "1")
    yield Check(f"{name}: largest eigenvalue of A + A^T", max(fit.largest_growth, 0.0), 0.0,
                "passive where it is not above 0 but for rounding", 1e-12, "1/s")  # fmt: skip
    yield Check(f"{name}: smallest eigenvalue of Re K over its largest, 0.001 to 1000 rad/s",
                min(fit.smallest_damping(grid), 0.0), 0.0, "passive", 1e-12, "1")  # fmt: skip


def responses() -> Sequence[Check]:
    base = shipped()
    fit = fit_radiation(base)
    base = replace(base, added_mass_infinite=fit.added_mass_infinite)
    times = np.arange(1.0, 60.0, 0.25)
    largest = np.abs(impulse_response(base, 0.0)[0])
    by_damping = impulse_response(base, times)
    checks = []
    for name, found, tolerance in (
        ("added mass", impulse_response(base, times, "added_mass"), 0.02),
        ("the fit", fit.impulse_response(times), 0.01),
    ):
        apart = np.abs(found - by_damping).max(axis=0)
        for modes, (i, j, _) in DISSERTATION.items():
            text = f"impulse response of {modes} from {name}, 1 to 60 s, off that from damping by"
            checks.append(Check(text, float(apart[i, j] / largest[i, j]), 0.0, THEORY, tolerance,
                                "of its start"))  # fmt: skip
    return checks


LUMPS = (  # kg, height m, kg m2: platform, tower, rotor and nacelle (NREL/TP-500-47535, -38060)
    (7_466_330.0, -89.9155, 4.22923e9),
    (249_718.0, 43.4, 1.2e8),
    (350_000.0, 89.6, 0.0),
)
LINES = (  # N/m, N, N m
    *((0, 0, 41_180.0), (0, 4, -2.82e6), (4, 0, -2.82e6), (4, 4, 3.11e8), (2, 2, 11_940.0)),
    *((1, 1, 41_180.0), (1, 3, 2.82e6), (3, 1, 2.82e6), (3, 3, 3.11e8)),
)


def rigid_spar() -> tuple[Array, Array]:
    """Mass (6,6) of the rigid turbine, and what weight and lines restore (6,6)."""
    mass, stiffness = np.zeros((6, 6)), np.zeros((6, 6))
    for lump, height, inertia in LUMPS:
        mass += point_mass(lump, np.array([0.0, 0.0, height]))
        mass[[3, 4], [3, 4]] += inertia
        stiffness[[3, 4], [3, 4]] -= lump * 9.80665 * height
    mass[5, 5] += 1.9e8
    for i, j, value in LINES:
        stiffness[i, j] += value
    stiffness[5, 5] = 1.1e7
    return mass, stiffness


def decay(model: PotentialFlow, start: Array, step: float, duration: float) -> Array:
    """Displacements (k,6) of the spar let go from ``start`` (6,), trapezoidal, small turns."""
    mass, stiffness = rigid_spar()
    weight = model.database.buoyancy * np.eye(6)[2]
    p, v, a = start.copy(), np.zeros(6), np.zeros(6)
    motion, out = _moved(p, v, a), [p]
    for k in range(round(duration / step)):
        model.begin_step(k * step, step, motion)
        new = a.copy()
        for _ in range(3):
            ahead = p + step * v + 0.25 * step**2 * (a + new)
            motion = _moved(ahead, v + 0.5 * step * (a + new), new)
            loads = model.loads((k + 1) * step, motion)
            assert loads.mass is not None
            assert loads.damping is not None
            assert loads.stiffness is not None
            force = np.concatenate([loads.force[0], loads.moment[0]]) - weight
            tangent = mass + loads.mass[0] + 0.5 * step * loads.damping[0]
            tangent += 0.25 * step**2 * (loads.stiffness[0] + stiffness)
            new = new - np.linalg.solve(tangent, mass @ new + stiffness @ ahead - force)
        p, v, a = p + step * v + 0.25 * step**2 * (a + new), v + 0.5 * step * (a + new), new
        motion = _moved(p, v, a)
        model.end_step((k + 1) * step, motion)
        out.append(p)
    return np.array(out)


def _moved(p: Array, v: Array, a: Array) -> Motion:
    """The platform's motion at a displacement, velocity and acceleration (6,)."""
    turn = exp_so3(p[3:])
    return Motion(p[None, :3], turn[None], v[None, :3], v[None, 3:], a[None, :3], a[None, 3:])


def decays() -> Iterator[Check]:
    base = shipped()
    damping = np.diag([1e5, 1e5, 1.3e5, 0.0, 0.0, 1.3e7])
    platform = Platform((0.0, 0.0, 0.0), 7.46633e6, (0.0, 0.0, -89.9155), (4.2e9, 4.2e9, 1.6e8),
                        additional_damping=damping)  # fmt: skip
    for name, mode, start in (("surge", 0, 10.0), ("heave", 2, 3.0), ("pitch", 4, np.deg2rad(5.0))):
        found = []
        for radiation in ("state_space", "convolution"):
            options = PlatformOptions.model_validate({"radiation": radiation})
            model = PotentialFlow(platform, base, None, options)
            found.append(decay(model, start * np.eye(6)[mode], 0.1, 400.0))
        states, past = found
        apart = float(np.abs(states - past)[:, mode].max() / start)
        last = 1000  # the last 100 s
        left = float(np.ptp(states[-last:, mode]) / np.ptp(past[-last:, mode]))
        yield Check(f"{name}: state space less convolution in 400 s, of the start", apart, 0.0,
                    "convolution, 60 s of memory", 5e-3, "1")  # fmt: skip
        yield Check(f"{name}: what is left in the last 100 s, over the convolution's", left, 1.0,
                    "convolution, 60 s of memory", 0.01, "1")  # fmt: skip


def leaning() -> Iterator[Check]:
    """Yaw of the spar about where it floats in wind, its rotor held."""
    for axes, tolerance in (("mean_lean", 0.02), ("upright", None)):
        for wind in (4.0, 18.0, 11.4):
            here = build_machine(load(WORKING | {
                "inflow": {"wind_speed_m_s": wind}, "platform": {"added_mass_axes": axes},
            }))  # fmt: skip
            yaw = next(mode.frequency for mode in here.floating_modes() if mode.name == "yaw")
            pose = floating_of(here).settled
            lean = float(np.rad2deg(np.linalg.norm(lean_of(pose.rotation))))
            text = f"yaw at {wind:g} m/s, a lean of {lean:.1f} deg, {axes.replace('_', ' ')}"
            yield Check(text, yaw, 0.121, UPRIGHT, tolerance, "Hz", True)


UPRIGHT = "OC3 phase IV codes as commonly quoted, upright"
WORKING = {
    "galerna": 1, "turbine": "nrel5mw_oc3", "duration_s": 1.0, "structure": "rigid",
    "sea": "still", "control": "baseline",
}  # fmt: skip
CASES = [
    Case(
        "radiation_lean",
        "afloat",
        "Yaw of a spar that leans",
        lambda: tuple(leaning()),
        60.0,
        "A body of revolution moves no water as it turns about its own axis, leaning or not, and "
        "its lines hold it nearly alike: its frequency in yaw is that of the upright spar. With "
        "coefficients that stay upright, as OpenFAST has them, a share of the added mass in roll "
        "comes in, and slows it.",
    ),
    Case(
        "radiation_fit",
        "afloat",
        "Radiation of the OC3 spar as a passive state space",
        lambda: tuple(fits()),
        4.0,
        "K = B + i w (A - A_inf) of the database that comes with the turbine, and of WAMIT's, "
        "which the dissertation fitted; errors are over the largest coefficient of each entry, "
        "with A_inf as the fit moves it. WAMIT's A55 jumps between 4 and 4.1 rad/s, an irregular "
        "frequency of its panels, by 1e-5 of itself; that is 4 % of K55, and no passive system "
        "follows it: its largest error is shown, not judged.",
    ),
    Case(
        "radiation_response",
        "afloat",
        "Impulse response from damping, from added mass, and of the fit",
        responses,
        2.0,
        "Both Fourier integrals of one function: they agree as far as the coefficients obey the "
        "relations of Kramers and Kronig. What the panels err in A counts w times in K: it is "
        "left 2 %. Earlier than 1 s the added mass lacks what lies above 5 rad/s.",
    ),
    Case(
        "radiation_decay",
        "afloat",
        "Free decays by the state space and by the convolution",
        lambda: tuple(decays()),
        30.0,
        "A rigid spar with linear lines, let go in surge, heave and pitch in still water.",
    ),
]
