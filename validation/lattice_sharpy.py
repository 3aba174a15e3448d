"""The steady vortex lattice of the NREL 5 MW rotor beside SHARPy's and OpenFAST's."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np

from galerna import turbine as turbines
from galerna.aero.vortex.ages import revolution_ages
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.steady import SteadySolution, solve_steady
from galerna.aero.vortex.surface import Surface
from galerna.contract import Array
from galerna.structure.frames import rotation_about
from galerna.turbine.model import Turbine
from galerna.units import RPM

from .framework import Case, Check
from .lattice_steady import SHAFT, Mesh, SteadyRotor, steady_lattice
from .rotors import columns, table

SHARPY = "SHARPy 2.4, steady lattice (del Carre et al., JOSS 4(44), 1885, 2019)"
WIND, SPEED_RPM, RADIUS, DENSITY = 11.4, 12.1, 63.0, 1.225
SHAPE = (9, 21)  #: corners
#: the same rings, boundary condition and formula: only rounding and the 7 digits of the
#: table should differ; the wanted limit is 1 %
SAME = 1e-5

EXAMPLE_WIND = 12.0  #: m/s of SHARPy's example with OpenFAST's rotor without drag
EXAMPLE = "SHARPy's example wind_turbine (commit 98813d7f): OpenFAST, polars without drag"
EXAMPLE_SHARPY = "SHARPy's example wind_turbine (commit 98813d7f): SHARPy"
FINE = Mesh(chordwise=32, spanwise=40)
FREE = Mesh(step_deg=10.0, free=True)


@cache
def reference() -> dict[str, Array]:
    """SHARPy's lattice (9,21,3), circulations (8,20) and corner forces (9,21,3) of blade 1."""
    rows = [
        {name: value or "nan" for name, value in row.items()}
        for row in table("sharpy_nrel5mw_lattice.csv")
    ]

    def grid(*names: str) -> Array:
        return np.stack([c.reshape(SHAPE) for c in columns(rows, *names)], axis=2)

    result = {"corners": grid("x_m", "y_m", "z_m")}
    for revolutions in (2, 7):
        circulation = grid(f"circulation_{revolutions}")
        result[f"circulation_{revolutions}"] = circulation[:-1, :-1, 0]
        force = grid(*(f"force_{axis}_{revolutions}" for axis in "xyz"))
        result[f"force_{revolutions}"] = force
    return result


@cache
def on_sharpys_lattice(revolutions: int, rings: str = "edges") -> SteadySolution:
    """galerna's steady lattice on the corners of SHARPy's."""
    corners = reference()["corners"]
    speed = SPEED_RPM * RPM
    blades = [corners @ rotation_about(0, angle).T for angle in 2.0 * np.pi * np.arange(3) / 3]
    surfaces = [Surface.turning(blade, speed * SHAFT, rings=rings) for blade in blades]
    return solve_steady(
        surfaces, WIND * SHAFT, axis=RotorAxis(np.zeros(3), SHAFT, speed),
        ages=revolution_ages(speed, revolutions), density=DENSITY,
    )  # fmt: skip


def coefficients(solution: SteadySolution) -> tuple[float, float]:
    """Thrust and power coefficients with the radius that SHARPy takes."""
    force = 0.5 * DENSITY * WIND**2 * np.pi * RADIUS**2
    torque = solution.moment()[0]
    return float(solution.force[0] / force), float(torque * SPEED_RPM * RPM / (force * WIND))


def one_to_one() -> Iterator[Check]:
    """The same rings, hence the same circulations and forces."""
    for revolutions in (2, 7):
        ours = on_sharpys_lattice(revolutions)
        found = {"circulation": ours.circulation[0], "force": ours.loads[0].corner_force}
        for name, values in found.items():
            theirs = reference()[f"{name}_{revolutions}"]
            error = float(np.abs(values - theirs).max() / np.abs(theirs).max())
            quantity = f"{revolutions} revolutions: {name}, largest difference over its maximum"
            yield Check(quantity, error, 0.0, SHARPY, SAME)
        force = reference()[f"force_{revolutions}"]
        moment = np.cross(reference()["corners"], force).sum(axis=(0, 1))[0]
        scale = 0.5 * DENSITY * WIND**2 * np.pi * RADIUS**2
        wanted = (3 * force[..., 0].sum() / scale, 3 * moment * SPEED_RPM * RPM / (scale * WIND))
        for name, value, other in zip(("C_T", "C_P"), coefficients(ours), wanted, strict=True):
            quantity = f"{revolutions} revolutions: {name}"
            yield Check(quantity, value, float(other), SHARPY, SAME, relative=True)
    own = coefficients(on_sharpys_lattice(7, "quarter_chord"))
    on_edges = coefficients(on_sharpys_lattice(7))
    for name, value, other in zip(("C_T", "C_P"), own, on_edges, strict=True):
        quantity = f"7 revolutions, galerna's rings on the same corners: {name}"
        yield Check(quantity, value, other, SHARPY, None, relative=True)


@cache
def example_rotor() -> Turbine:
    """The NREL 5 MW without tilt and cone, its chord on the pitch axis as built."""
    turbine = turbines.load("nrel5mw")
    return replace(
        turbine,
        hub=replace(turbine.hub, cone=0.0),
        nacelle=replace(turbine.nacelle, tilt=0.0),
    )


def example(mesh: Mesh) -> SteadyRotor:
    """The rotor of SHARPy's example."""
    return steady_lattice(example_rotor(), EXAMPLE_WIND, SPEED_RPM, 0.0, mesh)


def refined() -> Iterator[Check]:
    """Our lattice as it comes and refined, beside OpenFAST's rotor without drag."""
    coarse, fine, free = (example(mesh) for mesh in (Mesh(), FINE, FREE))
    for name in ("thrust_coefficient", "power_coefficient"):
        text, limit = name.replace("_", " "), getattr(fine, name)
        quantity = f"prescribed wake, 8 x 20 over 32 x 40 panels: {text}"
        yield Check(quantity, getattr(coarse, name), limit, "finer lattice", CONVERGED,
                    relative=True)  # fmt: skip
        for wanted, source in (OPENFAST_TOTALS[name], SHARPY_TOTALS[name]):
            for wake, value in (("prescribed", limit), ("free", getattr(free, name))):
                yield Check(f"{wake} wake: {text}", value, wanted, source, None, relative=True)
    rows = table("openfast_nrel5mw_zero_drag.csv")
    place, *loads = columns(rows, "r_over_R", "out_of_plane", "in_plane")
    for name, theirs, values in zip(("out", "in"), loads, (free.c_out, free.c_in), strict=True):
        for at, wanted in zip(place[:-1], theirs[:-1], strict=True):
            ours = float(np.interp(at * RADIUS, free.radius, values) * RADIUS)
            yield Check(
                f"free wake: d(c_{name})/d(r/R) at {at:.2f} R", ours, float(wanted), EXAMPLE
            )


#: two percent of a load is less than what camber lines and polars are apart
CONVERGED = 0.02
OPENFAST_TOTALS = {
    "thrust_coefficient": (0.69788, EXAMPLE), "power_coefficient": (0.48813, EXAMPLE)
}  # fmt: skip
SHARPY_TOTALS = {
    "thrust_coefficient": (0.70, EXAMPLE_SHARPY), "power_coefficient": (0.52, EXAMPLE_SHARPY)
}  # fmt: skip

CASES = (
    Case("lattice-sharpy", "vortex", "NREL 5 MW: the same lattice as SHARPy's",
         lambda: tuple(one_to_one()), 5.0,
         "Steady rotor of 3 x 8 x 20 panels at 11.4 m/s, 12.1 rpm, pitch 0, without drag and "
         "vortex cores, wake of 2 and 7 revolutions in 5-degree panels moved by the free stream "
         "alone: thrust and power are too high on purpose, the case compares lattices. Rings on "
         "the panels' edges, as SHARPy has them. With galerna's own rings and normals the same "
         "corners give the figures shown last: SHARPy's are not converged along the chord."),
    Case("lattice-nrel5mw", "vortex",
         "NREL 5 MW: the lattice refined, beside OpenFAST without drag",
         lambda: tuple(refined()), 60.0,
         "12 m/s, 12.1 rpm, pitch 0, no tilt and cone. The lattice has the camber lines of the "
         "airfoils' outlines, OpenFAST their polars, whose zero-lift angles are up to 2 deg "
         "higher: loads are shown, not judged."),
)  # fmt: skip
