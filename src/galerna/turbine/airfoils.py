"""Airfoils from windIO: polars by surface configuration and Reynolds number, shape, camber line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine import unsteady
from galerna.turbine.block import Block
from galerna.turbine.model import Airfoil, Array, Polar, UnsteadyParameters
from galerna.units import DEG

_CAMBER_POINTS = 81


def read_airfoils(document: Block) -> dict[str, tuple[Block, list[Block]]]:
    """Every airfoil of the database: its block and the blocks of its polar configurations."""
    found: dict[str, tuple[Block, list[Block]]] = {}
    for block in document.blocks("airfoils"):
        name = block.text("name")
        if name in found:
            raise block.error(f"a second airfoil is named {name!r}", "names must differ", "name")
        found[name] = block, list(block.blocks("polars"))
        if not found[name][1]:
            raise block.error("has no polars", "", "polars")
    return found


def build_airfoil(
    block: Block, polar_sets: list[Block], weights: dict[str, float], name: str
) -> Airfoil:
    """An airfoil whose polars are the weighted mean of configurations; one weight of 1 is plain."""
    thickness = block.number("rthick", low=0.0, high=1.0)
    shape = _coordinates(block)
    chosen = _chosen(block, polar_sets, weights)
    polars, published = [], None
    for reynolds_sets, weight in chosen:
        for re_set in reynolds_sets.blocks("re_sets"):
            published = _published(re_set) or published
            polars.append((weight, _polar(re_set, reynolds_sets.text("configuration", "default"))))
    if not polars:
        raise block.error("has no polars at any Reynolds number", "", "polars")
    mean = _mean_polars(block, polars) if len(chosen) > 1 else [p for _, p in polars]
    mean.sort(key=lambda p: p.reynolds)
    return Airfoil(
        name=name,
        relative_thickness=thickness,
        aerodynamic_center=block.number("aerodynamic_center", 0.25, 0.0, 1.0),
        polars=tuple(mean),
        unsteady=published or unsteady.fit(mean[-1]),
        coordinates=shape,
        camber=None if shape is None else camber_line(shape),
    )


def camber_line(coordinates: Array) -> Array:
    """Mean line (m,2) of x/c and z/c of a closed outline (n,2), halfway between its sides."""
    nose = int(np.argmin(coordinates[:, 0]))
    upper, lower = coordinates[nose::-1], coordinates[nose:]
    x = (1.0 - np.cos(np.linspace(0.0, np.pi, _CAMBER_POINTS))) / 2.0
    sides = [np.interp(x, *np.unique(s, axis=0).T) for s in (upper, lower)]
    return np.column_stack([x, (sides[0] + sides[1]) / 2.0])


def _chosen(
    block: Block, polar_sets: list[Block], weights: dict[str, float]
) -> list[tuple[Block, float]]:
    by_name = {p.text("configuration", "default"): p for p in polar_sets}
    if not weights:
        return [(polar_sets[0], 1.0)]
    for name in weights:
        if name not in by_name:
            raise block.error(f"no polars of configuration {name!r}", did_you_mean(name, by_name))
    return [(by_name[name], weight) for name, weight in weights.items()]


def _polar(block: Block, configuration: str) -> Polar:
    curves = {}
    for key in ("cl", "cd", "cm"):
        inner = block.block(key)
        grid = inner.grid(first=-180.0, last=180.0)
        curves[key] = grid, inner.array("values", len(grid))
    angles = merged_grid(*(grid for grid, _ in curves.values()))
    lift, drag, moment = (np.interp(angles, grid, values) for grid, values in curves.values())
    if (drag < 0.0).any() and drag.min() < -0.1:
        raise block.error(f"drag coefficient of {drag.min():g}", "drag cannot push", "cd", "values")
    return Polar(block.number("re", low=0.0), angles * DEG, lift, drag, moment, configuration)


def merged_grid(*grids: Array) -> Array:
    """All points of several grids, ascending; points closer than rounding are one."""
    merged = np.unique(np.concatenate(grids))
    return merged[np.append(True, np.diff(merged) > 1e-9 * (merged[-1] - merged[0]))]


def _mean_polars(block: Block, weighted: list[tuple[float, Polar]]) -> list[Polar]:
    """Weighted mean over the configurations at each Reynolds number."""
    by_reynolds: dict[float, list[tuple[float, Polar]]] = {}
    for weight, polar in weighted:
        by_reynolds.setdefault(polar.reynolds, []).append((weight, polar))
    means = []
    for parts in by_reynolds.values():
        if abs(sum(w for w, _ in parts) - 1.0) > 1e-6:
            raise block.error(
                f"the configurations to blend do not all have polars at Re {parts[0][1].reynolds:g}"
            )
        angles = merged_grid(*(p.angle_of_attack for _, p in parts))
        mean = {
            name: sum(w * np.interp(angles, p.angle_of_attack, getattr(p, name)) for w, p in parts)
            for name in ("lift", "drag", "moment")
        }
        tag = " + ".join(f"{w:g} {p.configuration}" for w, p in parts)
        means.append(replace(parts[0][1], angle_of_attack=angles, configuration=tag, **mean))
    return means


def _coordinates(block: Block) -> Array | None:
    """Outline from the trailing edge over the suction side; turned round if the file has it so."""
    if not block.has("coordinates"):
        return None
    inner = block.block("coordinates")
    x = inner.array("x")
    outline = np.column_stack([x, inner.array("y", len(x))])
    nose = int(np.argmin(x))
    if len(x) < 5 or not 0 < nose < len(x) - 1:
        raise inner.error("must run from the trailing edge round the nose and back")
    upper, lower = outline[: nose + 1, 1].mean(), outline[nose:, 1].mean()
    return outline if upper >= lower else outline[::-1].copy()


def _published(block: Block) -> UnsteadyParameters | None:
    """The unsteady parameters of a polar set, if it gives those that have no usual value."""
    needed = ("aoa0", "aoa1", "aoa2", "c_nalpha", "cn1", "cn2", "cd0")
    if not all(block.has(key) for key in needed):
        return None
    return UnsteadyParameters(
        zero_lift_angle=block.number("aoa0") * DEG,
        normal_force_slope=block.number("c_nalpha", low=0.0),
        separation_angles=(block.number("aoa1") * DEG, block.number("aoa2") * DEG),
        critical_normal_force=(block.number("cn1"), block.number("cn2")),
        zero_lift_drag=block.number("cd0"),
        zero_lift_moment=block.number("cm0", 0.0),
        pressure_lag=block.number("T_p", 1.7, 0.0),
        separation_lag=block.number("T_f0", 3.0, 0.0),
        vortex_decay=block.number("T_V0", 6.0, 0.0),
        vortex_travel=block.number("T_VL", 11.0, 0.0),
        indicial_amplitudes=(block.number("A1", 0.3), block.number("A2", 0.7)),
        indicial_exponents=(block.number("b1", 0.14), block.number("b2", 0.53)),
        strouhal=block.number("St_sh", 0.19),
        origin="published",
    )
