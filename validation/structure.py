"""Statics and vibration of beams and turbines against closed forms and published figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from galerna import turbine as turbines
from galerna.contract import Array
from galerna.structure.assembly import GROUND, Structure
from galerna.structure.beam import Curve, discretise, interpolate, nodal_loads, straight, uniform
from galerna.structure.mode_names import name_modes
from galerna.structure.modes import natural_modes
from galerna.structure.statics import static_equilibrium
from galerna.structure.system import Forces, State, System
from galerna.structure.turbine import TurbineOptions, axis_curve, turbine_system
from galerna.structure.whirl import whirl_modes
from galerna.turbine.model import SectionProperties
from galerna.units import RPM

from .framework import Case, Check

INERTIA = np.array([1.0, 1.0, 1.0, 0.1, 0.1, 0.1])  #: of beams whose statics alone matters
ALONG_X = np.stack([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], axis=1)

ELASTICA = "Exact elastica by shooting (Bisshopp and Drucker, Q. Appl. Math. 3 (1945) 272)"
BEND = (
    "GXBeam's test of Bathe and Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961, who give "
    "(-13.4, -23.5, 53.4); other codes (-13.5, -23.7, 53.4) to (-13.72, -23.65, 53.58)"
)
CANTILEVER = "Simpson and Palacios, AIAA 2013-1634, after Geradin and Cardona (2001)"
COMPOSITE = "Wang, Sprague, Jonkman, Johnson, Wind Energy 20 (2017) 1439; BeamDyn and Kynema"
BEAMDYN = "BeamDyn of OpenFAST 5.0.0, one element of order 10"
WRIGHT = "Wright et al., J. Appl. Mech. 49 (1982) 197, as in Bir, AIAA 2009-1035, Table 3a"
ADAMS = "NREL/TP-500-38060, Table 9-1, ADAMS"
FAST = "NREL/TP-500-38060, Table 9-1, FAST"


def clamped(
    curve: Curve, length: float, sections: SectionProperties, n: int
) -> tuple[System, Forces]:
    """A beam of n elements on the ground, and room for loads on it."""
    s = Structure((0.0, 0.0, 0.0))
    s.beam("beam", discretise(curve, length, sections, np.linspace(0, 1, n + 1)), root=GROUND)
    system = s.build()
    return system, Forces.none(len(system))


def slender(length: float) -> tuple[Curve, SectionProperties]:
    """A beam with EI 1 MN m2, stiff enough in tension and shear to be an elastica."""
    curve = straight(np.zeros(3), np.eye(3), length)
    return curve, uniform(np.array([1e10, 1e10, 1e10, 1e6, 1e6, 1e6]), INERTIA)


def roll_up() -> Sequence[Check]:
    length = 10.0
    system, forces = clamped(*_with_length(slender(length), length), 20)
    forces.follower[-1, 4] = 2.0 * np.pi * 1e6 / length
    state = static_equilibrium(system, loads=forces, steps=10)
    gap = float(np.linalg.norm(state.position[-1])) / length
    source = "A moment of 2 pi EI / L closes the circle"
    return [Check("gap between tip and root over length", gap, 0.0, source, 1e-6)]


def _with_length(
    beam: tuple[Curve, SectionProperties], length: float
) -> tuple[Curve, float, SectionProperties]:
    return beam[0], length, beam[1]


def bend_45_degrees() -> Sequence[Check]:
    radius, youngs, shear = 100.0, 1e7, 5e6
    stiffness = np.array([shear, shear, youngs, youngs / 12, youngs / 12, shear / 6])
    length = radius * np.pi / 4

    def arc(span: Array) -> tuple[Array, Array]:
        a = span * np.pi / 4
        c, s, zero = np.cos(a), np.sin(a), np.zeros_like(a)
        outwards, along = np.stack([c, s, zero], 1), np.stack([-s, c, zero], 1)
        position = radius * (outwards - [1.0, 0.0, 0.0])
        return position, np.stack([outwards, np.cross(along, outwards), along], axis=2)

    system, forces = clamped(arc, length, uniform(stiffness, INERTIA), 16)
    forces.dead[-1, 2] = 600.0
    state = static_equilibrium(system, loads=forces, steps=2)
    tip = (state.position[-1] - system.position[-1]) * [-1.0, 1.0, 1.0]
    published = np.array([-13.577, -23.545, 53.458])
    error = float(np.linalg.norm(tip - published) / np.linalg.norm(published))
    checks = [Check("vector error of the tip over its displacement", error, 0.0, BEND, 0.005)]
    return checks + [
        Check(f"tip displacement {axis}", float(value), float(reference), BEND, unit="in",
              relative=True)
        for axis, value, reference in zip("xyz", tip, published, strict=True)
    ]  # fmt: skip


def cantilever_600_kn() -> Sequence[Check]:
    stiffness = np.array([323.1e6, 323.1e6, 480e6, 9.346e6, 9.346e6, 1e6])
    curve = straight(np.zeros(3), np.eye(3), 5.0)
    system, forces = clamped(curve, 5.0, uniform(stiffness, INERTIA), 20)
    forces.dead[-1, 0] = -600e3
    state = static_equilibrium(system, loads=forces)
    x, R = state.position[-1], state.rotation[-1]
    values = (x[0], 5.0 - x[2], np.arctan2(-R[0, 2], R[2, 2]))
    published = (("deflection", -2.159, "m"), ("shortening", 0.596, "m"), ("turn", 0.672, "rad"))
    return [
        Check(f"tip {name}", float(value), reference, CANTILEVER, 0.001, unit)
        for value, (name, reference, unit) in zip(values, published, strict=True)
    ]


def composite_cantilever() -> Sequence[Check]:
    axial_first = 1e3 * np.array(
        [
            [1368.17, 0, 0, 0, 0, 0],
            [0, 88.56, 0, 0, 0, 0],
            [0, 0, 38.78, 0, 0, 0],
            [0, 0, 0, 16.96, 17.61, -0.351],
            [0, 0, 0, 17.61, 59.12, -0.370],
            [0, 0, 0, -0.351, -0.370, 141.47],
        ]
    )
    order = [1, 2, 0, 4, 5, 3]
    sections = uniform(axial_first[np.ix_(order, order)], INERTIA)
    system, forces = clamped(straight(np.zeros(3), ALONG_X, 10.0), 10.0, sections, 40)
    forces.dead[-1, 2] = 150.0
    tip = static_equilibrium(system, loads=forces).position[-1] - [10.0, 0.0, 0.0]
    published = (-0.090272662757, -0.064748848626, 1.22973648292)
    return [
        Check(f"tip displacement u{k + 1}", float(tip[k]), published[k], COMPOSITE, 1e-3, "m", True)
        for k in range(3)
    ]


def elastica(load: float) -> tuple[float, float]:
    """Tip deflection and height over length of a cantilever under a dead tip load F L^2 / EI."""

    def end(curvature: float) -> Array:
        def slope(s: float, y: Array) -> list[float]:
            return [y[1], -load * np.cos(y[0]), np.sin(y[0]), np.cos(y[0])]

        return solve_ivp(slope, (0, 1), [0, curvature, 0, 0], rtol=1e-12, atol=1e-13).y[:, -1]

    root = brentq(lambda curvature: end(curvature)[1], 0.5 * min(load, 1.0), load, xtol=1e-14)
    return float(end(root)[2]), float(end(root)[3])


def cantilever_elastica() -> Sequence[Check]:
    length, checks = 10.0, []
    for load in (0.01, 1.0, 2.0, 5.0, 10.0):
        system, forces = clamped(*_with_length(slender(length), length), 20)
        forces.dead[-1, 0] = load * 1e6 / length**2
        tip = static_equilibrium(system, loads=forces, steps=2).position[-1] / length
        for name, value, exact in zip(("x/L", "z/L"), tip[[0, 2]], elastica(load), strict=True):
            checks.append(Check(f"F = {load:g} EI/L2, tip {name}", float(value), exact, ELASTICA,
                                1e-3, relative=True))  # fmt: skip
    for turns in (0.2, 0.5, 1.0):
        system, forces = clamped(*_with_length(slender(length), length), 20)
        forces.follower[-1, 4] = turns * np.pi * 1e6 / length
        tip = static_equilibrium(system, loads=forces, steps=4).position[-1] / length
        angle = turns * np.pi
        exact = ((1 - np.cos(angle)) / angle, np.sin(angle) / angle)
        for name, value, reference in zip(("x/L", "z/L"), tip[[0, 2]], exact, strict=True):
            checks.append(Check(f"M = {turns:g} pi EI/L, tip {name}", float(value),
                                float(reference), "A circle", 1e-3))  # fmt: skip
    return checks


def mesh_convergence() -> Sequence[Check]:
    length, load, checks = 10.0, 2.0, []
    exact = np.array(elastica(load)) * length
    errors = []
    for n in (5, 10, 20):
        stiff = uniform(np.array([1e12, 1e12, 1e12, 1e6, 1e6, 1e6]), INERTIA)
        system, forces = clamped(slender(length)[0], length, stiff, n)
        forces.dead[-1, 0] = load * 1e6 / length**2
        tip = static_equilibrium(system, loads=forces, steps=2).position[-1, [0, 2]]
        errors.append(np.linalg.norm(tip - exact))
    for k, pair in enumerate(("5 to 10", "10 to 20")):
        rate = float(np.log2(errors[k] / errors[k + 1]))
        checks.append(_at_least(f"order in the mesh, {pair} elements", rate, 2.0, ELASTICA))
    return checks


def _at_least(quantity: str, value: float, bound: float, source: str) -> Check:
    """A rate that must not fall below a bound: judged on what is missing."""
    return Check(f"{quantity} ({value:.2f}): missing to {bound:g}", max(bound - value, 0.0), 0.0,
                 source, 0.05)  # fmt: skip


def nrel_blade(n: int, load: Array, per_metre: float = 0.0) -> Array:
    """Tip displacement (3,) m of the NREL 5 MW blade under a tip load (3,) N or a load N/m."""
    blade = turbines.load("nrel5mw").blade
    assert blade.structure is not None
    curve = axis_curve(blade.axis_span, blade.axis, np.eye(3), np.zeros(3), blade.structure)
    system, forces = clamped(curve, blade.length, blade.structure, n)
    beam = discretise(curve, blade.length, blade.structure, np.linspace(0, 1, n + 1))
    forces.dead[:] = nodal_loads(
        beam, lambda s: np.tile([per_metre, 0, 0, 0, 0, 0.0], (len(s), 1)), blade.length
    )
    forces.dead[-1, :3] += load
    forces.dead[0] = 0.0
    return static_equilibrium(system, loads=forces, steps=2).position[-1] - system.position[-1]


def edgewise_compliance() -> float:
    """Edgewise tip displacement m over load N of the NREL 5 MW blade: the linear integral."""
    blade = turbines.load("nrel5mw").blade
    sections = blade.structure
    assert sections is not None
    span = np.linspace(0.0, 1.0, 20001)
    z, twist = span * blade.length, np.interp(span, sections.span, sections.twist)
    c, s = np.cos(twist), np.sin(twist)
    turn = np.zeros((len(z), 6, 6))
    for k in (0, 3):
        turn[:, k, k], turn[:, k, k + 1], turn[:, k + 1, k], turn[:, k + 1, k + 1] = c, s, -s, c
        turn[:, k + 2, k + 2] = 1.0
    compliance = np.linalg.inv(
        turn @ interpolate(sections, sections.stiffness, span) @ turn.transpose(0, 2, 1)
    )
    lever = np.tile(np.eye(6)[:, 1], (len(z), 1))
    lever[:, 3] = -(blade.length - z)
    return float(np.trapezoid(np.einsum("ni,nij,nj->n", lever, compliance, lever), z))


def nrel_blade_under_load() -> Sequence[Check]:
    kilonewton_x, kilonewton_y = 1e3 * np.eye(3)[:2]
    cases: list[tuple[str, int, Callable[[int], Array], float]] = [
        ("50 kN flapwise, flapwise", 0, partial(nrel_blade, load=50 * kilonewton_x), 4.036183),
        ("200 kN flapwise, flapwise", 0, partial(nrel_blade, load=200 * kilonewton_x), 13.259295),
        ("200 kN flapwise, spanwise", 2, partial(nrel_blade, load=200 * kilonewton_x), -3.359064),
        ("50 kN edgewise, edgewise", 1, partial(nrel_blade, load=50 * kilonewton_y), 1.0485355),
        ("5 kN/m flapwise, flapwise", 0,
         partial(nrel_blade, load=np.zeros(3), per_metre=5e3), 5.022973),
    ]  # fmt: skip
    checks = []
    for name, axis, blade, reference in cases:
        tip = float(blade(40)[axis])
        checks.append(Check(f"{name} tip displacement", tip, reference, BEAMDYN, 0.035, "m", True))
        change = float(blade(20)[axis]) / tip - 1.0
        checks.append(Check(f"{name}: 20 against 40 elements", change, 0.0, "mesh", 0.003))
    small = float(nrel_blade(20, np.array([0.0, 100.0, 0.0]))[1]) / 100.0
    checks.append(
        Check("edgewise compliance", small, edgewise_compliance(),
              "Integral of the sections' compliance along the blade", 1e-3, "m/N", True)
    )  # fmt: skip
    return checks


def rotating_beam() -> Sequence[Check]:
    published = {0: (3.516, 22.035, 61.697), 3: (4.797, 23.32, 62.985), 6: (7.36, 26.809, 66.684),
                 9: (10.226, 31.771, 72.387), 12: (13.17, 37.603, 79.615)}  # fmt: skip
    length, mass = 31.623, 100.0
    stiffness = np.array([1e13, 1e13, 1e12, 1e12, 1e8, 1e10])
    inertia = np.array([mass, mass, mass, 1e-2, 1e-2, 1e-2])
    curve = straight(np.zeros(3), np.eye(3), length)
    system, _ = clamped(curve, length, uniform(stiffness, inertia), 20)
    checks = []
    for speed, frequencies in published.items():
        spin = (np.zeros(3), np.array([float(speed), 0.0, 0.0]))
        state = static_equilibrium(system, spin=spin)
        found = 2 * np.pi * natural_modes(system, state, 4).frequency
        for k, reference in enumerate(frequencies):
            value = float(found[np.abs(found - reference).argmin()])
            checks.append(Check(f"flap {k + 1} at {speed} rad/s", value, reference, WRIGHT, 1e-3,
                                "rad/s", True))  # fmt: skip
    return checks


NREL_MODES = {  # name: FAST, ADAMS in Hz
    "tower fore-aft 1": (0.3240, 0.3195),
    "tower side-side 1": (0.3120, 0.3164),
    "drivetrain 1": (0.6205, 0.6094),
    "blade flap yaw 1": (0.6664, 0.6296),
    "blade flap pitch 1": (0.6675, 0.6686),
    "blade flap collective 1": (0.6993, 0.7019),
    "blade edge pitch 1": (1.0793, 1.0740),
    "blade edge yaw 1": (1.0898, 1.0877),
    "blade flap yaw 2": (1.9337, 1.6507),
    "blade flap pitch 2": (1.9223, 1.8558),
    "blade flap collective 2": (2.0205, 1.9601),
    "tower fore-aft 2": (2.9003, 2.8590),
    "tower side-side 2": (2.9361, 2.9408),
}


def unshearable(sections: SectionProperties) -> SectionProperties:
    """The same beam a thousand times as stiff in shear."""
    stiffness = sections.stiffness.copy()
    stiffness[:, [0, 1], [0, 1]] *= 1e3
    return replace(sections, stiffness=stiffness)


def named_frequencies(gravity: float, shear: bool) -> dict[str, float]:
    """Frequencies Hz of the parked NREL 5 MW by name."""
    turbine = turbines.load("nrel5mw")
    if not shear:
        assert turbine.blade.structure is not None
        assert turbine.tower.structure is not None
        turbine = replace(
            turbine,
            blade=replace(turbine.blade, structure=unshearable(turbine.blade.structure)),
            tower=replace(turbine.tower, structure=unshearable(turbine.tower.structure)),
        )
    options = TurbineOptions(rotor="locked", gravity=(0.0, 0.0, -gravity))
    model = turbine_system(turbine, options)
    state: State = static_equilibrium(model.system)
    modes = natural_modes(model.system, state, 16)
    return dict(zip(name_modes(model, state, modes), modes.frequency.tolist(), strict=True))


def nrel_modes() -> Sequence[Check]:
    plain, full = named_frequencies(0.0, shear=False), named_frequencies(9.80665, shear=True)
    checks = []
    for name, (fast, adams) in NREL_MODES.items():
        nan = float("nan")
        checks += [
            Check(name, plain.get(name, nan), adams, ADAMS, 0.015, "Hz", True),
            Check(name, plain.get(name, nan), fast, FAST, None, "Hz", True),
            Check(f"{name}, shear and weight", full.get(name, nan), adams, ADAMS, None, "Hz", True),
        ]
    return checks


HAWC = (
    "DTU 10 MW, HAWCStab2 structural frequencies as shipped with lacbox (MIT licence), "
    "dtu_10mw_structural.cmb, at 4 m/s (6 rpm) and 11.1 m/s (9.6 rpm)"
)
DTU_MODES = {  # rpm: frequencies in Hz as seen from the ground
    6.0: (0.250929, 0.256377, 0.483535, 0.645481, 0.683133, 0.829324, 1.02974, 1.35676),
    9.6: (0.2501, 0.2564, 0.4481, 0.6675, 0.7550, 0.7798, 1.0954, 1.3373),
}
DTU_NAMES = (
    "tower side-side", "tower fore-aft", "flap backward", "flap collective", "flap forward",
    "edge backward", "edge forward", "second flap backward",
)  # fmt: skip


def dtu_whirl() -> Sequence[Check]:
    turbine, checks = turbines.load("dtu10mw"), []
    for rpm, published in DTU_MODES.items():
        found = whirl_modes(turbine, rpm * RPM, 12).modes.frequency
        found = found[found > 0.1]
        for name, value, reference in zip(DTU_NAMES, found, published, strict=False):
            tolerance = 0.005 if name.startswith("tower") else 0.03
            checks.append(Check(f"{name} at {rpm:g} rpm", float(value), reference, HAWC, tolerance,
                                "Hz", True))  # fmt: skip
    return checks


CASES = [
    Case("structure-roll-up", "structure", "A beam rolled into a circle", roll_up, 5),
    Case("structure-bend", "structure", "The 45-degree bend under 600 lb", bend_45_degrees, 3,
         "Square section of 1 in, E 1e7 psi, Poisson's ratio 0: GA 5e6 lb, EI 1e7/12 lb in2 and, "
         "as GXBeam has it, GJ 5e6/6 lb in2 (polar moment); with the square's own torsion constant "
         "0.1406 in4 the tip is at (-13.73, -23.82, 53.61). 16 elements."),
    Case("structure-cantilever", "structure", "A cantilever under 600 kN", cantilever_600_kn, 2,
         "Tolerance: the published figures' three digits."),
    Case("structure-composite", "structure", "A composite cantilever with coupled sections",
         composite_cantilever, 2),
    Case("structure-elastica", "structure", "Cantilevers under tip forces and moments",
         cantilever_elastica, 6, "20 elements; the exact elastica is integrated beside it."),
    Case("structure-mesh-order", "structure", "Order of convergence in the mesh",
         mesh_convergence, 3, "At least second order is wanted; the element gives about fourth."),
    Case("structure-nrel-blade", "structure", "The NREL 5 MW blade under load",
         nrel_blade_under_load, 6,
         "The reference is not converged itself: from order 5 to 10 its tip moves by 3.0 to 3.7 %, "
         "which is the tolerance. Edgewise it is 2.5 % stiffer than the linear integral of the "
         "sections' compliance, an independent figure that galerna meets within 0.1 %."),
    Case("structure-rotating-beam", "structure", "Frequencies of a rotating beam", rotating_beam, 6,
         "20 elements, clamped at the axis of rotation."),
    Case("structure-dtu-whirl", "structure", "Natural frequencies of the turning DTU 10 MW",
         dtu_whirl, 8,
         "Multiblade coordinates, rotor free, no weight and no wind. HAWCStab2's blades stand in "
         "the wind's steady deflection, galerna's do not: blades are judged within 3 %, the tower "
         "within 0.5 %."),
    Case("structure-nrel-modes", "structure", "Natural frequencies of the parked NREL 5 MW",
         nrel_modes, 8,
         "Judged against ADAMS, whose flexible beams are nearest in kind; FAST's prescribed shapes "
         "are shown. Judged without shear flexibility and without weight: the report gives no "
         "shear stiffness, and the figures agree with ADAMS mode by mode only so, which was found "
         "by comparing and is no proof of what ADAMS had. Tolerance 1.5 %, the difference between "
         "FAST and ADAMS in the first tower modes. With the shear stiffness of the OpenFAST deck "
         "(a tenth of EA) and weight every frequency falls by 1 to 3 %, also shown."),
]  # fmt: skip
