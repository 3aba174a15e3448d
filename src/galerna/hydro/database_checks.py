"""What must hold in a hydrodynamic database, and what tells of mixed-up units and signs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from galerna.contract import Array
from galerna.errors import InputError
from galerna.hydro.database import Complex, HydroDatabase
from galerna.hydro.interpolation import refuse_failed, whole_circle
from galerna.hydro.rigid import MODES
from galerna.hydro.waves.dispersion import group_velocity

_ASYMMETRY = 0.05  # of the largest: coarse meshes of well-known panel codes reach 1 %
_ACTIVE = 0.02  # largest damping below zero, over the modes' largest
_LONG = 0.15  # k times the hull's depth and half its breadth: waves are long below


def checked(base: HydroDatabase, where: str) -> HydroDatabase:
    """The database itself, if it holds together. Raises InputError with the figures.

    Shapes, rising frequencies, symmetric added mass and damping, a damping that takes energy
    (its eigenvalues are not below zero), a density and gravity that belong to water.
    """
    _check_shapes(base, where)
    _check_figures(base, where)
    _check_symmetry(base, where)
    _check_passivity(base, where)
    return base


def _check_shapes(base: HydroDatabase, where: str) -> None:
    n, m = len(base.frequency), len(base.heading)
    wanted = {
        "added_mass": (n, 6, 6),
        "damping": (n, 6, 6),
        "added_mass_infinite": (6, 6),
        "added_mass_zero": (6, 6),
        "excitation": (n, m, 6),
        "mean_drift": (n, m, 6),
        "hydrostatic_stiffness": (6, 6),
        "center_of_buoyancy": (3,),
        "reference_point": (3,),
    }
    for name, shape in wanted.items():
        value = getattr(base, name)
        if value is not None and np.shape(value) != shape:
            raise InputError(where, f"{name} is {np.shape(value)}, expected {shape}", "")


def _check_figures(base: HydroDatabase, where: str) -> None:
    frequency = base.frequency
    if not len(frequency) or frequency[0] <= 0.0 or (np.diff(frequency) <= 0.0).any():
        raise InputError(where, "frequencies must be positive and rise", "give them in rad/s")
    if not len(base.heading) or (np.diff(base.heading) <= 0.0).any():
        raise InputError(where, "headings must rise", "give them in rad, such as -pi ... pi")
    if not (500.0 < base.water_density < 2000.0 and 1.0 < base.gravity < 30.0):
        raise InputError(
            where,
            f"the water has {base.water_density:g} kg/m3 and gravity {base.gravity:g} m/s2",
            "give SI units",
        )
    if not base.displaced_volume > 0.0:
        raise InputError(where, f"displaced volume is {base.displaced_volume:g} m3", "")
    if not base.water_depth > 0.0:
        raise InputError(where, f"water depth is {base.water_depth:g} m", "it is positive")


def scale(matrices: Array) -> Array:
    """Square roots (6,6) of the products of the modes' largest diagonal entries, 1 where 0."""
    diagonal = np.abs(np.diagonal(np.atleast_3d(matrices), axis1=-2, axis2=-1))
    largest = np.nanmax(diagonal.reshape(-1, 6), axis=0)
    root = np.sqrt(np.where(largest > 0.0, largest, 1.0))
    return np.outer(root, root)


def asymmetry(matrices: Array) -> float:
    """Largest difference from the transpose, over ``scale``."""
    return float(np.nanmax(np.abs(matrices - np.swapaxes(matrices, -1, -2)) / scale(matrices)))


def _check_symmetry(base: HydroDatabase, where: str) -> None:
    for name, matrices in (("added mass", base.added_mass), ("damping", base.damping)):
        relative = np.abs(matrices - np.swapaxes(matrices, -1, -2)) / scale(matrices)
        worst = float(np.nanmax(relative))
        if worst > _ASYMMETRY:
            k, i, j = np.unravel_index(np.nanargmax(relative), relative.shape)
            raise InputError(
                where,
                f"{name} of {MODES[i]}-{MODES[j]} is {matrices[k, i, j]:.4g} and of "
                f"{MODES[j]}-{MODES[i]} {matrices[k, j, i]:.4g} at {base.frequency[k]:.4g} rad/s; "
                "they must be equal",
                "look at the mesh, at the lid, or at the order of the file's columns",
            )


def smallest_damping(base: HydroDatabase) -> tuple[float, float]:
    """Smallest eigenvalue of the damping over ``scale``, and its frequency rad/s."""
    symmetric = 0.5 * (base.damping + np.swapaxes(base.damping, 1, 2)) / scale(base.damping)
    solved = ~np.isnan(symmetric).any(axis=(1, 2))
    smallest = np.linalg.eigvalsh(symmetric[solved])[:, 0]
    k = int(smallest.argmin())
    return float(smallest[k]), float(base.frequency[solved][k])


def _check_passivity(base: HydroDatabase, where: str) -> None:
    smallest, frequency = smallest_damping(base)
    if smallest < -_ACTIVE:
        raise InputError(
            where,
            f"the damping at {frequency:.4g} rad/s gives energy to the motion: its smallest "
            f"eigenvalue is {smallest:.3g} of the largest entries",
            "an irregular frequency without a lid, or a wrong sign",
        )


def haskind_damping(base: HydroDatabase) -> Array | None:
    """Damping (n,6,6) that the excitation implies; None unless headings go round.

    Haskind and Newman: B_ij = k / (8 pi rho g c_g) Integral X_i conj(X_j) d beta. It ties the
    scales of damping, excitation and frequency together.
    """
    if not whole_circle(base.heading):
        return None
    around = np.arange(72) * (np.pi / 36.0)
    refuse_failed(base.failed, "checked")
    force: Complex = base.at_headings(around).excitation
    integral = np.einsum("nmi,nmj->nij", force, force.conj()).real * (np.pi / 36.0)
    speed = group_velocity(base.frequency, base.water_depth, base.gravity)
    factor = base.wavenumber / (8.0 * np.pi * base.water_density * base.gravity * speed)
    return np.asarray(factor[:, None, None] * integral)


def haskind_ratio(base: HydroDatabase) -> float | None:
    """Median of damping over Haskind's where that of the strongest translation is large."""
    implied = haskind_damping(base)
    if implied is None:
        return None
    mode = int(np.abs(base.damping[:, range(3), range(3)]).max(axis=0).argmax())
    given, wanted = base.damping[:, mode, mode], implied[:, mode, mode]
    strong = wanted > 0.2 * wanted.max()
    return float(np.median(given[strong] / wanted[strong]))


@dataclass(frozen=True)
class LongWaves:
    """What the longest waves of a database do over what they must; 1 in theory.

    The water around the centre of buoyancy moves with a_x along and a_z upwards: ``surge`` is
    the excitation over a_x (rho V + A11), ``heave`` over C33 plus a_z (rho V + A33); complex,
    so a time factor exp(-i w t) makes ``surge`` negative.
    """

    heave: complex
    surge: complex


def long_waves(base: HydroDatabase) -> LongWaves | None:
    """Ratios at the first frequency; None where even its waves are not long beside the hull."""
    k, height = float(base.wavenumber[0]), float(base.center_of_buoyancy[2])
    height = height if np.isfinite(height) else 0.0
    if k * max(-height, base.displaced_volume ** (1.0 / 3.0)) > _LONG:
        return None
    ahead = np.cos(base.heading)
    m = int(np.abs(ahead).argmax())
    along, upwards = _accelerations(base, k, height)
    mass = base.water_density * base.displaced_volume + np.diagonal(base.added_mass[0])
    force, still = base.excitation[0, m], base.hydrostatic_stiffness[2, 2]
    return LongWaves(
        complex(force[2] / (still - upwards * mass[2])),
        complex(force[0] / (1j * along * mass[0] * ahead[m])),
    )


def _accelerations(base: HydroDatabase, k: float, height: float) -> tuple[float, float]:
    """Sizes 1/s2 of the water's along the waves and upwards, per amplitude, at a height m."""
    up, image = np.exp(k * height), 0.0
    if np.isfinite(base.water_depth):
        image = np.exp(-k * (height + 2.0 * base.water_depth))
    scale = base.gravity * k / (1.0 + np.exp(-2.0 * k * base.water_depth))
    return float(scale * (up + image)), float(scale * (up - image))
