"""Natural frequencies of beams and turbines, at rest and turning, against published tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from galerna import turbine as turbines
from galerna.structure.beam import straight, uniform
from galerna.structure.mode_names import name_modes
from galerna.structure.modes import natural_modes
from galerna.structure.statics import static_equilibrium
from galerna.structure.turbine import TurbineOptions, turbine_system
from galerna.structure.whirl import whirl_modes
from galerna.turbine.model import Drivetrain, SectionProperties
from galerna.units import RPM

from .framework import Case, Check
from .structure import clamped

WRIGHT = "Wright et al., J. Appl. Mech. 49 (1982) 197, as in Bir, AIAA 2009-1035, Table 3a"
ADAMS = "NREL/TP-500-38060, Table 9-1, ADAMS"
FAST = "NREL/TP-500-38060, Table 9-1, FAST"


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


def gearless(drivetrain: Drivetrain) -> Drivetrain:
    """The generator as a body on the low-speed shaft, of the inertia that the rotor feels."""
    inertia = drivetrain.generator_inertia * drivetrain.gear_ratio**2
    return replace(drivetrain, generator_inertia=inertia, gear_ratio=1.0)


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
            drivetrain=gearless(turbine.drivetrain),
        )
    options = TurbineOptions(rotor="locked", gravity=(0.0, 0.0, -gravity))
    model = turbine_system(turbine, options)
    state = static_equilibrium(model.system)
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
         "by comparing and is no proof of what ADAMS had. For the same reason the generator is a "
         "body on the low-speed shaft there, which rolls with the nacelle; behind its gearbox it "
         "does not, and the second side-side mode is 5 % higher. Tolerance 1.5 %, the difference "
         "between FAST and ADAMS in the first tower modes. With the shear stiffness of the "
         "OpenFAST deck (a tenth of EA), weight and the gearbox, frequencies fall by up to 3 %, "
         "also shown."),
]  # fmt: skip
