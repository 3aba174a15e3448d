"""Airfoils from windIO: polars by surface configuration and Reynolds number, shape, camber line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from galerna.errors import did_you_mean
from galerna.turbine import unsteady
from galerna.turbine.model import Airfoil, Array, Polar, UnsteadyParameters
from galerna.turbine.outline import camber_line, suction_side_first
from galerna.turbine.windio.block import Block, merged_grid
from galerna.units import DEG


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


def blend_weights(entry: Block) -> dict[str, float]:
    """Weight per polar configuration of an airfoil on the blade; empty where none is named."""
    if not entry.has("configuration"):
        return {}
    names = entry.value("configuration")
    if not isinstance(names, list) or not names or not all(isinstance(n, str) for n in names):
        raise entry.error("expected a list of names", "", "configuration")
    alone = len(names) == 1 and not entry.has("weight")
    weights = np.ones(1) if alone else entry.array("weight", len(names), 0.0)
    if abs(weights.sum() - 1.0) > 1e-6:
        raise entry.error(f"the weights add up to {weights.sum():g} instead of 1", "", "weight")
    return {n: float(w) for n, w in zip(names, weights, strict=True) if w > 0.0}


def blend_name(name: str, weights: dict[str, float]) -> str:
    """The airfoil's name, with the blend where there is one: ``NAME [0.7 clean + 0.3 rough]``."""
    if len(weights) < 2:
        return name
    return f"{name} [{' + '.join(f'{weight:g} {part}' for part, weight in weights.items())}]"


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
    if drag.min() < -0.1:
        raise block.error(f"drag coefficient of {drag.min():g}", "drag cannot push", "cd", "values")
    return Polar(block.number("re", low=0.0), angles * DEG, lift, drag, moment, configuration)


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
    """Outline from the trailing edge over the suction side and back."""
    if not block.has("coordinates"):
        return None
    inner = block.block("coordinates")
    x = inner.array("x")
    outline = np.column_stack([x, inner.array("y", len(x))])
    if len(x) < 5 or not 0 < int(np.argmin(x)) < len(x) - 1:
        raise inner.error("must run from the trailing edge round the nose and back")
    return suction_side_first(outline)


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
