"""Mooring lines: catenaries beside MoorPy, the OC3 line over its distance, the system's statics."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq

from galerna import turbine as turbines
from galerna.contract import Motion
from galerna.hydro.mooring import Catenary, MooringLines, catenary
from galerna.hydro.strips import Carrier

from .framework import Case, Check
from .rotors import columns, table

MOORPY = "MoorPy, tests/test_catenary.py at 30b7fc4 (BSD-3)"
#: x, z m, length m, EA N, weight N/m, friction (None: no seabed); H and V N at A, H and V at B,
#: length on the seabed m. The first of the three taut lines in the middle is followed by one
#: which MoorPy's search gives up and takes for a straight spring.
MOORPY_LINES = (
    ("friction holds the anchor", 400, 200, 500.0, 7.51e12, 800.0, 5.0,
     0.0, 0.0, 96643.43501616362, 237751.75997440016, 202.81030003199982),
    ("rests without friction", 400, 200, 500.0, 7.51e12, 800.0, 0.0,
     96643.42815934008, 0.0, 96643.42815934008, 237751.75535996316, 202.81030580004602),
    ("rests with friction", 400, 200, 500.0, 7.51e12, 800.0, 0.1,
     80418.60434855078, 0.0, 96643.42877136687, 237751.75577183915, 202.81030528520108),
    ("hangs, light", 400, 200, 500.0, 7.51e12, 200.0, None,
     43694.580989249596, -22365.599350216216, 43694.580989249596, 77634.40064978378, 0.0),
    ("hangs, short", 89.9, 59.2, 130.0, 7.51e8, 881.05, None,
     31373.229006023103, -26650.341270116318, 31373.229006023103, 87886.15872988368, 0.0),
    ("buoyant", 37.96888656874307, 20.49078283711694, 100.0, 7.51e8, -881.0549577007893, None,
     6428.437434537766, 53178.729367882406, 6428.437434537766, -34926.76640219652, 0.0),
    ("taut", 246.22420940032947, 263.55766330843164, 360.6256626239693, 7e8, 3.08735, 0.0,
     71116.8, 75567.3, 71116.8, 76680.6, 0.0),
    ("taut, a straight spring in MoorPy", 246.22420940032947, 263.55766330843164,
     360.63566262396927, 7e8, 3.08735, 0.0, 56804.6, 60803.4, 56804.6, 60803.4, 0.0),
    ("taut, longest", 246.22420940032947, 263.55766330843164, 360.64566262396926, 7e8, 3.08735,
     0.0, 46077.1, 48765.2, 46077.1, 49878.6, 0.0),
    ("taut, near the surface", 119.3237383002058, 52.49668849178113, 130.36140355177318, 7e8,
     34.91060469991227, 0.0, 72694.145, 29715.173, 72694.145, 34266.168, 0.0),
)  # fmt: skip
JONKMAN = "Jonkman, NREL/TP-500-41958 (2007), eqs. 2-35 and 2-36, from galerna's tensions"


def moorpy_cases() -> Sequence[Check]:
    checks = []
    for name, x, z, length, stiffness, weight, friction, *published in MOORPY_LINES:
        height = None if friction is None else 0.0
        line = catenary(x, z, length, weight, stiffness, friction=friction or 0.0, height=height)
        found = (line.horizontal_a, line.vertical_a, line.horizontal_b, line.vertical_b,
                 line.resting)  # fmt: skip
        spring = name.endswith("in MoorPy")
        for what, value, reference in zip(
            ("H at A", "V at A", "H at B", "V at B", "resting"), found, published, strict=True
        ):
            unit, near = ("m", 1e-6) if what == "resting" else ("N", 1e-6)
            nothing = reference == 0.0
            tolerance = None if spring and not nothing else near if nothing else 1e-3
            checks.append(
                Check(f"{name}: {what}", value, reference, MOORPY, tolerance, unit, not nothing)
            )
        if spring:
            reached = hanging_reach(line, length, weight, stiffness)
            for what, value, given in zip(("distance", "rise"), reached, (x, z), strict=True):
                text = f"{name}: {what} by the tensions"
                checks.append(Check(text, value, given, JONKMAN, 1e-9, "m", True))
    return checks


def hanging_reach(
    line: Catenary, length: float, weight: float, stiffness: float
) -> tuple[float, float]:
    """Distance and rise m of a hanging line from its tensions."""
    H, low, high = line.horizontal_b, line.vertical_a, line.vertical_b
    x = H / weight * (np.arcsinh(high / H) - np.arcsinh(low / H)) + H * length / stiffness
    z = (line.tension_b - line.tension_a) / weight
    return x, z + (high**2 - low**2) / (2.0 * stiffness * weight)


LINE = (902.2, 698.094, 384.243e6)  #: of the OC3-Hywind: m, N/m, N
RISE = 250.0  #: m
FAST = "MooringLineFD of the OC3 deck, FAST v6.10b-jmj: rounded to 0.1 kN and 0.1 m"
SHARPY = "SHARPy, eqs. 2.103 and 2.104"
#: its figure is drawn from a table in steps of 0.5 m, where 901.6 m hang at 858 m and all at 858.5
FIGURE = "dissertation, on Fig. 2.7: all of the line hangs beyond this distance"
TABLE_STEP = 0.5  #: m


def oc3_line() -> Sequence[Check]:
    rows = table("afloat/oc3_mooring_line.csv")
    names = ("distance_m", "fast_tension_kN", "fast_horizontal_kN", "fast_suspended_m",
             "fast_anchor_kN", "sharpy_horizontal_N", "sharpy_vertical_N")  # fmt: skip
    distance, *published = columns(rows, *names)
    lines = [catenary(float(x), RISE, *LINE) for x in distance]
    found = np.array([
        (line.tension_b / 1e3, line.horizontal_b / 1e3, LINE[0] - line.resting,
         line.tension_a / 1e3, line.horizontal_b, line.vertical_b)
        for line in lines
    ]).T  # fmt: skip
    checks = []
    what = ("tension", "horizontal tension", "suspended length", "tension at the anchor")
    for name, value, reference in zip(what, found[:4], published[:4], strict=True):
        unit = "m" if "length" in name else "kN"
        worst = float(np.abs(value - reference).max())
        text = f"{name}, largest difference over 25 distances from 653 to 893 m"
        checks.append(Check(text, worst, 0.0, FAST, 0.0501, unit))
    for name, value, reference in zip(
        ("horizontal", "vertical"), found[4:], published[4:], strict=True
    ):
        worst = float(np.abs(value / reference - 1.0).max())
        checks.append(Check(f"{name} force, the same", worst, 0.0, SHARPY, 1e-6, "-"))
    lifts = float(brentq(lambda x: catenary(x, RISE, *LINE).vertical_a - 1e-6, 850.0, 870.0))
    checks.append(Check("all of the line hangs beyond", lifts, 858.5, FIGURE, TABLE_STEP, "m"))
    return checks


MAP = "MAP++ 1.20.10, summary of OpenFAST's test of the OC3-Hywind, line 1"
REPORT = "NREL/TP-500-47535 (2010), linear representation of the moorings, section 5"


def oc3_statics() -> Sequence[Check]:
    platform = turbines.load("nrel5mw_oc3").platform
    assert platform is not None
    assert platform.mooring is not None
    lines = MooringLines(platform.mooring, Carrier.rigid(platform), platform.water_depth)
    motion = Motion.at_rest(1)
    loads = lines.loads(0.0, motion)
    lines.end_step(0.0, motion)
    record, K = lines.record(), loads.stiffness[0] if loads.stiffness is not None else None
    assert K is not None
    line = catenary(848.67, RISE, *LINE)
    yaw = K[5, 5] - platform.mooring.yaw_stiffness
    published = (
        ("horizontal tension", line.horizontal_b, 736939.302, MAP, 1e-5, "N"),
        ("vertical tension", line.vertical_b, 535728.001, MAP, 1e-5, "N"),
        ("tension, of the system", np.max(record["fairlead_tension"]), 911089.471, MAP, 1e-5, "N"),
        ("length on the seabed", np.max(record["grounded_length"]), 134.785, MAP, 1e-4, "m"),
        ("pull on the platform", -loads.force[0, 2], 1.607e6, REPORT, 1e-3, "N"),
        ("C11", K[0, 0], 41180.0, REPORT, 1e-3, "N/m"),
        ("C22", K[1, 1], 41180.0, REPORT, 1e-3, "N/m"),
        ("C33", K[2, 2], 11940.0, REPORT, 1e-3, "N/m"),
        ("C44", K[3, 3], 311.1e6, REPORT, 2e-3, "N m/rad"),
        ("C55", K[4, 4], 311.1e6, REPORT, 2e-3, "N m/rad"),
        ("C66", yaw, 11.56e6, REPORT, 1e-3, "N m/rad"),
        ("C15", K[0, 4], -2.821e6, REPORT, 3e-3, "N/rad"),
        ("C51", K[4, 0], -2.816e6, REPORT, 3e-3, "N m/m"),
    )
    return [
        Check(name, float(value), reference, source, tolerance, unit, True)
        for name, value, reference, source, tolerance, unit in published
    ]


CASES = [
    Case("afloat-catenary", "afloat", "Elastic lines beside MoorPy", moorpy_cases, 2,
         "Resting, with friction, hanging, buoyant and taut. One of the taut lines has the same "
         "vertical tension at both ends in MoorPy, which its own weight forbids: its search fell "
         "back to a straight spring there. It is shown, and galerna's tensions are put into the "
         "textbook equations instead."),
    Case("afloat-mooring-line", "afloat", "A line of the OC3-Hywind over its distance", oc3_line, 1,
         "Fig. 2.7 of the dissertation; docs/figures/mooring_line.png. The FAST table is rounded, "
         "so agreement is within half of its last digit. The dissertation's 858.5 m, beyond which "
         "all of the line hangs, is the first row of that table where it does; its rows are 0.5 m "
         "apart, and 901.6 of 902.2 m hang at 858 m."),
    Case("afloat-mooring-statics", "afloat", "Moorings of the OC3-Hywind at rest", oc3_statics, 1,
         "The report's matrix came from finite differences in FAST: its C15 and C51 differ by "
         "0.2 %, galerna's are equal as they must be without friction. It counts C66 without the "
         "additional yaw spring."),
]  # fmt: skip
