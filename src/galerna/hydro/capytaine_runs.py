"""Coefficients of a hull by capytaine (Ancellin and Dias, JOSS 4, 2019), a panel code.

Its time factor is exp(-i w t) and its waves go towards the heading, as here: what it calls a
force F is conj(F) here. Its hydrostatic stiffness holds the body's weight and is not used.
The direct method (potentials as unknowns) converges with the square of the panels' width,
the indirect one (sources) only with the width itself.
"""

from __future__ import annotations

import gc
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import Complex, HydroDatabase
from galerna.hydro.far_field import ANGLES, FarField, Moving, Surface, kochin, mean_drift
from galerna.hydro.panels import Displacement, Panels, displacement
from galerna.hydro.revolution import whole_of_revolution
from galerna.hydro.rigid import MODES
from galerna.hydro.waves.dispersion import wavenumber
from galerna.units import DEG, SEA_WATER, STANDARD_GRAVITY

HEADINGS: Array = np.asarray(np.arange(-180.0, 181.0, 30.0) * DEG)
_IN_PLANE = (0, 2, 4)  # what a body of revolution is asked: surge, heave, pitch
_SHALLOWEST = 0.14  # k h from which capytaine's water of finite depth begins

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class _Run:
    """A hull in capytaine, the modes and headings asked of it, and the problems' figures."""

    solver: Any
    body: Any
    modes: tuple[int, ...]
    headings: Array
    depth: float
    density: float
    gravity: float

    @property
    def figures(self) -> dict[str, Any]:
        return {
            "body": self.body,
            "water_depth": self.depth,
            "rho": self.density,
            "g": self.gravity,
        }


@dataclass(frozen=True, eq=False)
class _Row:
    """What one frequency gives: capytaine's results in this house's conventions."""

    added_mass: Array
    damping: Array
    excitation: Complex
    diffraction: Complex
    radiation: Complex

    @classmethod
    def failed(cls, headings: int) -> _Row:
        """Nothing but NaN."""
        shapes = [(6, 6), (6, 6), (headings, 6), (headings, len(ANGLES)), (6, len(ANGLES))]
        return cls(*(np.full(shape, np.nan) for shape in shapes))


def compute(
    panels: Panels,
    frequencies: ArrayLike,
    headings: ArrayLike = HEADINGS,
    *,
    reference_point: ArrayLike = (0.0, 0.0, 0.0),
    water_depth: float = np.inf,
    water_density: float = SEA_WATER,
    gravity: float = STANDARD_GRAVITY,
    displaced: Displacement | None = None,
    moving: Moving | None = None,
    progress: Progress | None = None,
) -> HydroDatabase:
    """Coefficients at ``frequencies`` (n,) rad/s and ``headings`` (m,) rad.

    Panels that know a symmetry stand about the vertical through the reference point. A body of
    revolution is asked for surge, heave and pitch in waves along x alone, the rest follows by
    turning. ``displaced`` gives hydrostatics better than the panels', about the z axis of the
    reference point. ``moving`` gives the mean drift of the moving hull, without it that of
    a held one. ``progress`` is told how many of all frequencies are done. Frequencies that
    fail become NaN, with one warning. Zero frequency comes with infinite depth alone: in
    finite depth heave's added mass has no limit there, it grows with -log(k h). Raises
    InputError where capytaine is missing, for frequencies below what it can do in this depth,
    and where all fail.
    """
    frequency = np.asarray(frequencies, dtype=float)
    asked, reference = np.asarray(headings, float), np.asarray(reference_point, float)
    _check_frequencies(frequency, water_depth, gravity)
    run = _run(panels, asked, reference, (water_depth, water_density, gravity))
    rows, failures = _solve_all(run, frequency, progress)
    base = _assembled(run, panels, reference, frequency, rows, displaced)
    far = FarField(np.stack([r.diffraction for r in rows]), np.stack([r.radiation for r in rows]))
    if not failures:
        base = replace(base, mean_drift=mean_drift(base, far, moving))
    settings = _settings(run, panels, base, "held" if moving is None else "moving")
    full = whole_of_revolution(base, asked) if panels.revolution else base
    return replace(full.symmetrised(), settings=settings)


def _check_frequencies(frequency: Array, depth: float, gravity: float) -> None:
    where = "frequencies of the hydrodynamic database"
    if not len(frequency) or frequency.min() <= 0.0 or (np.diff(frequency) <= 0.0).any():
        raise InputError(where, "must be positive and rise", "give rad/s, such as 0.05 ... 5")
    lowest = lowest_frequency(depth, gravity)
    if frequency[0] < lowest:
        raise InputError(
            where,
            f"begin at {frequency[0]:.4g} rad/s; in water {depth:g} m deep capytaine begins at "
            f"{lowest:.4g} rad/s (k h = {_SHALLOWEST:g})",
            "begin there; added mass hardly changes below",
        )


def lowest_frequency(depth: float, gravity: float) -> float:
    """The lowest frequency rad/s that capytaine solves beside 0; 0 in infinite depth."""
    kh = _SHALLOWEST
    return float(np.sqrt(gravity / depth * kh * np.tanh(kh))) if np.isfinite(depth) else 0.0


def capytaine() -> Any:
    """The panel code's module. Raises InputError where it is not installed."""
    try:
        import capytaine
    except ImportError as error:
        raise InputError(
            "capytaine",
            "computes hydrodynamic coefficients and is not installed",
            "pip install 'galerna[hydro]'",
        ) from error
    return capytaine


def _run(panels: Panels, headings: Array, reference: Array, water: tuple[float, ...]) -> _Run:
    cpt = capytaine()
    shift = np.zeros(3) if _is_symmetric(panels) else reference * [1.0, 1.0, 0.0]
    hull = _mesh(cpt, panels, panels.vertices - shift, panels.faces)
    lid = None
    if len(panels.lid_faces):
        lid = _mesh(cpt, panels, panels.lid_vertices - shift, panels.lid_faces)
    elif not _is_symmetric(panels):
        lid = hull.generate_lid()
    dofs = cpt.rigid_body_dofs(rotation_center=(0.0, 0.0, reference[2]))
    named = {name: dofs[name.capitalize()] for name in MODES}
    body = cpt.FloatingBody(mesh=hull, lid_mesh=lid, dofs=named)
    modes = _IN_PLANE if panels.revolution else tuple(range(6))
    return _Run(_solver(), body, modes, np.zeros(1) if panels.revolution else headings, *water)


def _solver() -> Any:
    gc.collect()
    return capytaine().BEMSolver(method="direct")


def _is_symmetric(panels: Panels) -> bool:
    return panels.sectors > 1 or panels.mirrored


def _mesh(cpt: Any, panels: Panels, vertices: Array, faces: np.ndarray) -> Any:
    mesh = cpt.Mesh(vertices=vertices, faces=faces, auto_check=False)
    if panels.mirrored:
        mesh = cpt.ReflectionSymmetricMesh(mesh, plane="xOz")
    return mesh if panels.sectors == 1 else cpt.RotationSymmetricMesh(mesh, n=panels.sectors)


def _solve_all(
    run: _Run, frequency: Array, progress: Progress | None
) -> tuple[list[_Row], list[str]]:
    rows, failures = [], []
    for k, w in enumerate(frequency):
        try:
            # matrices of all frequencies would stay in one solver's memory
            rows.append(_row(replace(run, solver=_solver()), float(w)))
        except Exception as error:  # whatever stops one frequency: the batch goes on and says so
            rows.append(_Row.failed(len(run.headings)))
            failures.append(f"{w:.4g} rad/s ({str(error).splitlines()[0]})")
        if progress is not None:
            progress(k + 1, len(frequency))
    if len(failures) == len(frequency):
        raise InputError("capytaine", f"no frequency was solved: {failures[0]}", "see the mesh")
    if failures:
        listed = "; ".join(failures[:5]) + ("; ..." if len(failures) > 5 else "")
        warnings.warn(
            f"capytaine: {len(failures)} of {len(frequency)} frequencies were not solved and are "
            f"NaN: {listed}",
            stacklevel=3,
        )
    return rows, failures


def _radiation(run: _Run, frequency: float) -> list[Any]:
    kind = capytaine().RadiationProblem
    return [
        _solve(run, kind(omega=frequency, radiating_dof=MODES[j], **run.figures)) for j in run.modes
    ]


def _solve(run: _Run, problem: Any) -> Any:
    return run.solver.solve(problem, _check_wavelength=False)


def _row(run: _Run, frequency: float) -> _Row:
    """One frequency: all of it shares the influence matrices, which capytaine keeps."""
    radiation = _radiation(run, frequency)
    added = _matrix(run, radiation, "added_mass")
    damping = _matrix(run, radiation, "radiation_damping")
    kind = capytaine().DiffractionProblem
    diffraction = [
        _solve(run, kind(omega=frequency, wave_direction=float(b), **run.figures))
        for b in run.headings
    ]
    sent = np.zeros((6, len(ANGLES)), complex)
    sent[list(run.modes)] = _kochin(run, radiation, frequency)
    excitation = np.stack([_excitation(run, result) for result in diffraction])
    return _Row(added, damping, excitation, _kochin(run, diffraction, frequency), sent)


def _matrix(run: _Run, results: list[Any], quantity: str) -> Array:
    """Matrix (6,6) of a real coefficient, zero in the modes that are not asked for."""
    matrix = np.zeros((6, 6))
    for j, result in zip(run.modes, results, strict=True):
        for i in run.modes:
            matrix[i, j] = getattr(result, quantity)[MODES[i]]
    return matrix


def _excitation(run: _Run, result: Any) -> Complex:
    """Diffraction and undisturbed wave together (6,), turned to exp(+i w t)."""
    from capytaine.bem.airy_waves import froude_krylov_force

    undisturbed = froude_krylov_force(result.problem)
    force = np.zeros(6, complex)
    for i in run.modes:
        force[i] = np.conj(result.forces[MODES[i]] + undisturbed[MODES[i]])
    return force


def _kochin(run: _Run, results: list[Any], frequency: float) -> Complex:
    mask, mesh = run.body.hull_mask, run.body.mesh
    surface = Surface(mesh.faces_centers, mesh.faces_normals, mesh.faces_areas)
    potential = np.conj(np.stack([r.potential[mask] for r in results]))
    velocity = np.conj(np.stack([r.problem.boundary_condition[mask] for r in results]))
    number = float(wavenumber(frequency, run.depth, run.gravity))
    return kochin(surface, potential, velocity, number, run.depth)


def _limit(run: _Run, frequency: float) -> Array:
    """Added mass (6,6) at a limiting frequency."""
    return _matrix(run, _radiation(run, frequency), "added_mass")


def _assembled(
    run: _Run,
    panels: Panels,
    reference: Array,
    frequency: Array,
    rows: list[_Row],
    displaced: Displacement | None = None,
) -> HydroDatabase:
    sideways = reference * [1.0, 1.0, 0.0]
    vertices, faces = panels.whole()
    if not _is_symmetric(panels):
        vertices = vertices - sideways
    displaced = displacement(vertices, faces) if displaced is None else displaced
    height = reference * [0.0, 0.0, 1.0]
    return HydroDatabase(
        frequency=frequency,
        added_mass=np.stack([r.added_mass for r in rows]),
        damping=np.stack([r.damping for r in rows]),
        added_mass_infinite=_limit(run, np.inf),
        added_mass_zero=None if np.isfinite(run.depth) else _limit(run, 0.0),
        heading=run.headings,
        excitation=np.stack([r.excitation for r in rows]),
        hydrostatic_stiffness=displaced.stiffness(run.density * run.gravity, height),
        displaced_volume=displaced.volume,
        center_of_buoyancy=displaced.center + sideways,
        reference_point=reference,
        water_depth=run.depth,
        water_density=run.density,
        gravity=run.gravity,
    )


def _settings(run: _Run, panels: Panels, base: HydroDatabase, drift: str) -> dict[str, str | float]:
    lid = run.body.lid_mesh
    return {
        "program": f"capytaine {capytaine().__version__}",
        "method": "direct",
        "panels": float(panels.count),
        "symmetry": _symmetry(panels),
        "panel_volume_m3": displacement(*panels.whole()).volume,
        "lid_panels": float(0 if lid is None else lid.nb_faces),
        "longest_panel_m": float(2.0 * run.body.mesh.faces_radiuses.max()),
        "drift": f"far field, hull {drift}",
    }


def _symmetry(panels: Panels) -> str:
    parts = ["mirrored"] if panels.mirrored else []
    return ", ".join([f"{panels.sectors} sectors", *parts, *["revolution"] * panels.revolution])
