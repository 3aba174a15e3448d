"""AirfoilInfo files: polars by Reynolds number, unsteady parameters, outline."""

from __future__ import annotations

import numpy as np

from galerna.turbine import unsteady
from galerna.turbine.model import Airfoil, Array, Polar, UnsteadyParameters
from galerna.turbine.openfast.deck import Deck
from galerna.turbine.outline import camber_line, suction_side_first
from galerna.units import DEG

_MILLION = 1e6
_END_OF_RANGE = 0.01  # deg: a table may end that close to -180 and 180
_NO_LIFT = 0.05  # largest lift coefficient of what is taken for a cylinder
_QUARTER_CHORD = 0.25
_THICKNESS_POINTS = 201


def read_airfoil(deck: Deck, name: str, columns: dict[str, int], notes: list[str]) -> Airfoil:
    """An airfoil; ``columns`` places Alfa, Cl, Cd and Cm in the tables (from 1, 0 for none)."""
    polars = _polars(deck, columns)
    reference, outline = _outline(deck)
    published = None if outline is None else relative_thickness(outline)
    lifting = max(float(np.abs(p.lift).max()) for p in polars) > _NO_LIFT
    if published is None and lifting:
        notes.append(f"airfoil {name}: no coordinates, so its relative thickness is unknown (0)")
    given = _unsteady_parameters(next(deck.parts("Re")))
    return Airfoil(
        name=name,
        relative_thickness=(0.0 if lifting else 1.0) if published is None else published,
        aerodynamic_center=reference,
        polars=tuple(sorted(polars, key=lambda p: p.reynolds)),
        unsteady=given or unsteady.fit(polars[0]),
        coordinates=outline,
        camber=None if outline is None else camber_line(outline),
    )


def relative_thickness(outline: Array) -> float:
    """Largest thickness, in chords, of an outline (n,2) from the trailing edge round the nose."""
    nose = int(np.argmin(outline[:, 0]))
    x = np.linspace(outline[nose, 0], outline[:, 0].max(), _THICKNESS_POINTS)
    upper = np.interp(x, outline[nose::-1, 0], outline[nose::-1, 1])
    lower = np.interp(x, outline[nose:, 0], outline[nose:, 1])
    return float(np.clip((upper - lower).max(), 0.0, 1.0))


def _polars(deck: Deck, columns: dict[str, int]) -> list[Polar]:
    """The tables without a control surface's setting, one at each Reynolds number."""
    count = deck.integer("NumTabs", default=1, low=1)
    parts = list(deck.parts("Re"))
    if len(parts) < count:
        raise deck.error(f"NumTabs says {count} tables; {len(parts)} have a keyword Re")
    polars: dict[float, Polar] = {}
    for part in parts[:count]:
        reynolds = part.number("Re", low=0.0) * _MILLION
        if reynolds not in polars:
            polars[reynolds] = _polar(part, columns, reynolds)
    return list(polars.values())


def _polar(deck: Deck, columns: dict[str, int], reynolds: float) -> Polar:
    start = deck.entry("NumAlf").line
    count = deck.integer("NumAlf", low=2)
    table, _ = deck.rows(start, count, max(columns.values()), "polar")
    zero = np.zeros(count)
    alpha, lift, drag, moment = (
        table[:, columns[key] - 1] if columns[key] else zero for key in ("Alfa", "Cl", "Cd", "Cm")
    )
    if (np.diff(alpha) <= 0.0).any():
        line = start + 1 + int(np.argmax(np.diff(alpha) <= 0.0))
        raise deck.error("polar: the angles of attack must ascend", "", line)
    if alpha[0] > -180.0 + _END_OF_RANGE or alpha[-1] < 180.0 - _END_OF_RANGE:
        raise deck.error(
            f"polar covers {alpha[0]:g} to {alpha[-1]:g} deg; expected -180 to 180",
            "extend it, for example by the method of Viterna",
            start,
        )
    return Polar(reynolds, np.clip(alpha, -180.0, 180.0) * DEG, lift, drag, moment)


def _unsteady_parameters(deck: Deck) -> UnsteadyParameters | None:
    """The file's parameters; None if it leaves one without a usual value to be calculated."""
    needed = ("alpha0", "alpha1", "alpha2", "C_nalpha", "Cn1", "Cn2", "Cd0")
    if not deck.flag("InclUAdata", False) or any(deck.is_default(key) for key in needed):
        return None
    return UnsteadyParameters(
        zero_lift_angle=deck.number("alpha0") * DEG,
        normal_force_slope=deck.number("C_nalpha", low=0.0),
        separation_angles=(deck.number("alpha1") * DEG, deck.number("alpha2") * DEG),
        critical_normal_force=(deck.number("Cn1"), deck.number("Cn2")),
        zero_lift_drag=deck.number("Cd0"),
        zero_lift_moment=deck.number("Cm0", 0.0),
        pressure_lag=deck.number("T_p", 1.7, 0.0),
        separation_lag=deck.number("T_f0", 3.0, 0.0),
        vortex_decay=deck.number("T_V0", 6.0, 0.0),
        vortex_travel=deck.number("T_VL", 11.0, 0.0),
        indicial_amplitudes=(deck.number("A1", 0.3), deck.number("A2", 0.7)),
        indicial_exponents=(deck.number("b1", 0.14), deck.number("b2", 0.53)),
        strouhal=deck.number("St_sh", 0.19),
        origin="published",
    )


def _outline(deck: Deck) -> tuple[float, Array | None]:
    """Reference point (x/c) and outline: trailing edge, suction side, nose, pressure side."""
    if not deck.has("NumCoords") or not deck.entry("NumCoords").values[0].startswith("@"):
        return _QUARTER_CHORD, None
    shape = deck.file("NumCoords")
    start = shape.entry("NumCoords")
    count = shape.integer("NumCoords", low=6)
    points, _ = shape.rows(start.line, count, 2, "coordinates")
    outline = points[1:]
    outline = np.roll(outline, -_trailing_edge(outline), axis=0)
    nose = int(np.argmin(outline[:, 0]))
    if not 2 <= nose < len(outline) - 2:
        raise shape.error("the coordinates do not run round the nose", "", start.line)
    return float(points[0, 0]), suction_side_first(outline)


def _trailing_edge(outline: Array) -> int:
    """Where the outline starts: 0 if one end lies on the trailing edge."""
    x = outline[:, 0]
    at_end = max(x[0], x[-1]) >= x.max() - 1e-6
    return 0 if at_end else int(np.argmax(x))
