"""The vortex lattice under yaw beside blade-element momentum: dissertation 4.2.2.

The AVATAR rotor is not public; the straightened DTU 10 MW stands in for it at its tip-speed
ratio, pitched to its thrust coefficient (``rotors.like_the_avatar``).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from galerna.aero.bem.options import BemOptions
from galerna.contract import Array

from .framework import Case, Check, statement
from .rotors import BRISK, Options, dynamic_pressure_force, like_the_avatar, turning

SKEW = "BEM skew"  #: Pitt and Peters, as the dissertation's
MODELS: dict[str, Options] = {
    "UVLM": BRISK,
    SKEW: BemOptions(skewed_wake="pitt_peters", tower_influence=False),
    "BEM no skew": BemOptions(skewed_wake="none", tower_influence=False),
    "BEM vortex cylinder": BemOptions(tower_influence=False),
}
TURNS = {"UVLM": 3}  #: from the steady state of the wind without yaw
YAWS = (0.0, 10.0, 20.0, 30.0)
RADII = (0.45, 0.75)
DISSERTATION = "dissertation 4.2.2, AVATAR rotor"
#: deg of azimuth; the same as for blade-element momentum in bem-yaw-azimuths
NEAR = 30.0


@cache
def yawed(model: str, yaw_deg: float) -> dict[str, Array]:
    """Blade 1 and the rotor over the azimuth of one turn.

    ``c_out`` and ``c_in`` (azimuth, len(RADII)) 1/m, ``M_out`` and ``M_in`` N m, ``C_T``, ``C_P``,
    and the means of c_out and c_in along the span with their ``radius`` m.
    """
    turbine, wind, speed, pitch = like_the_avatar()
    turn = turning(turbine, MODELS[model], wind, speed, pitch, yaw_deg=yaw_deg,
                   turns=TURNS.get(model, 8), steps=48)  # fmt: skip
    force = dynamic_pressure_force(turbine, wind)
    radius = np.array(RADII) * turbine.rotor_radius
    result = {"azimuth": turn["azimuth_deg"], "radius": turn["radius"]}
    for name, channel in (("c_out", "normal_force"), ("c_in", "tangential_force")):
        blade = turn[channel][:, 0] / force
        result[name] = np.array([np.interp(radius, turn["radius"], row) for row in blade])
        result[f"mean_{name}"] = blade.mean(axis=0)
    result["M_out"] = turn["aerodynamic_root_out_of_plane_moment"][:, 0]
    result["M_in"] = turn["aerodynamic_root_in_plane_moment"][:, 0]
    result["C_T"] = turn["rotor_thrust"] / force
    result["C_P"] = turn["rotor_power"] / (force * wind)
    return result


def extreme_azimuth(turn: dict[str, Array], values: Array, largest: bool, near: float) -> float:
    """Azimuth deg of the first harmonic's extreme, written within 180 deg of ``near``.

    The harmonic, because a flat extreme jumps from step to step.
    """
    phase = np.exp(-1j * np.radians(turn["azimuth"]))
    place = -np.degrees(np.angle(np.mean(values * phase))) + (0.0 if largest else 180.0)
    return float(near + (place - near + 180.0) % 360.0 - 180.0)


def change(model: str, name: str, yaw_deg: float = 30.0) -> float:
    """Mean of a coefficient at a yaw error over that without, less one."""
    return float(yawed(model, yaw_deg)[name].mean() / yawed(model, 0.0)[name].mean() - 1.0)


def over_skew(model: str, name: str) -> float:
    """Standard deviation at 30 deg over that of BEM with a skewed wake, less one."""
    return float(yawed(model, 30.0)[name].std() / yawed(SKEW, 30.0)[name].std() - 1.0)


def skew_azimuth(name: str, column: int | None) -> float:
    """Azimuth deg where the skewed wake loads blade 1 most, within 180 deg of 270.

    What the lattice's first harmonic has beyond that of BEM without a skewed wake, which holds
    the advancing and retreating of the blade alone; each over its mean.
    """
    turn, bare = yawed("UVLM", 30.0), yawed("BEM no skew", 30.0)
    values, without = (t[name] if column is None else t[name][:, column] for t in (turn, bare))
    return extreme_azimuth(turn, values / values.mean() - without / without.mean(), True, 270.0)


def azimuths() -> Iterator[Check]:
    """Where the lattice's loads are largest and smallest at 30 deg (Figs. 4.22, 4.24, 4.25)."""
    turn = yawed("UVLM", 30.0)
    places: tuple[tuple[str, int | None, str], ...] = (
        ("c_out", 1, "c_out at 0.75 R"), ("c_in", 1, "c_in at 0.75 R"), ("M_out", None, "M_out"),
        ("M_in", None, "M_in"), ("c_in", 0, "c_in at 0.45 R"),
    )  # fmt: skip
    for name, column, text in places:
        inboard = column == 0
        values = turn[name] if column is None else turn[name][:, column]
        most, source = (0.0 if inboard else 270.0), f"{DISSERTATION}, figures 4.22, 4.24, 4.25"
        for word, largest, wanted in (("largest", True, most), ("smallest", False, most - 180)):
            near = wanted % 360.0
            place = extreme_azimuth(turn, values, largest, near)
            yield Check(f"azimuth of the {word} {text}", place, near, source,
                        NEAR if inboard else None, "deg")  # fmt: skip
        if not inboard:
            yield Check(f"azimuth where the skewed wake raises {text} most",
                        skew_azimuth(name, column), 270.0, source, NEAR, "deg")  # fmt: skip


def losses() -> Iterator[Check]:
    """Tables 4.4 and 4.6: what yaw takes, and the loads' fluctuation."""
    source = f"{DISSERTATION}, table 4.4"
    for model, thrust, power in (
        ("UVLM", -0.15, -0.27), (SKEW, -0.20, -0.35), ("BEM no skew", -0.20, -0.35),
        ("BEM vortex cylinder", -0.20, -0.35),
    ):  # fmt: skip
        yield Check(f"30 deg of yaw, {model}: change of C_T", change(model, "C_T"), thrust, source)
        yield Check(f"30 deg of yaw, {model}: change of C_P", change(model, "C_P"), power, source)
    for name in ("C_T", "C_P"):
        yield statement(f"the lattice loses less {name} than BEM with a skewed wake",
                        change("UVLM", name) > change(SKEW, name), source, judged=True)  # fmt: skip
    source = f"{DISSERTATION}, table 4.6"
    for model, out, inside in (("UVLM", -0.52, -0.34), ("BEM no skew", -0.75, -0.59)):
        for name, reference in (("M_out", out), ("M_in", inside)):
            quantity = f"standard deviation of {name}, {model} over {SKEW}, less one"
            yield Check(quantity, over_skew(model, name), reference, source)
    for name in ("M_out", "M_in"):
        quantity = f"standard deviation of {name}, BEM vortex cylinder over {SKEW}, less one"
        yield Check(quantity, over_skew("BEM vortex cylinder", name), over_skew("UVLM", name),
                    "the lattice of this case")  # fmt: skip
    yield statement("M_out fluctuates less than with the skewed wake of BEM",
                    over_skew("UVLM", "M_out") < 0.0, source, judged=True)  # fmt: skip
    yield statement("and more than without", over_skew("UVLM", "M_out")
                    > over_skew("BEM no skew", "M_out"), source, judged=True)  # fmt: skip


def sweep() -> Iterator[Check]:
    """Figs. 4.31 and 4.33: means over the yaw error, each as a fraction of that without."""
    for yaw in YAWS[1:]:
        for name in ("C_T", "C_P", "M_out"):
            reference = change(SKEW, name, yaw)
            yield Check(f"{yaw:g} deg: change of {name}", change("UVLM", name, yaw), reference,
                        "galerna's BEM with Pitt and Peters' skewed wake")  # fmt: skip
    small = max(abs(change("UVLM", "C_T", 10.0) - change(m, "C_T", 10.0)) for m in MODELS)
    source = f"{DISSERTATION}, figure 4.33: very good agreement up to 10 deg"
    yield Check("10 deg: largest difference of the change of C_T", small, 0.0, source, 0.02)


CASES = (
    Case("lattice-yaw-azimuths", "vortex", "Lattice at 30 deg of yaw: where loads are extreme",
         lambda: tuple(azimuths()), 100.0,
         "First harmonics of blade 1 in the third turn, free wake, drag from the polars. Near is "
         "30 deg, as for blade-element momentum in bem-yaw-azimuths. Outboard loads are the sum of "
         "the skewed wake's part, largest at 270 deg, and of the blade's advancing and retreating, "
         "which alone is largest at 155 to 170 deg out of plane and at 20 deg in plane. By the "
         "lattice the two are about equal, so the loads themselves are extreme 30 to 46 deg from "
         "270 and 90 deg: shown. Judged is the skewed wake's part."),
    Case("lattice-yaw-losses", "vortex", "Lattice at 30 deg of yaw: means and fluctuations",
         lambda: tuple(losses()), 100.0,
         "Another rotor than the dissertation's: figures are shown, statements judged."),
    Case("lattice-yaw-sweep", "vortex", "Lattice from 0 to 30 deg of yaw beside BEM",
         lambda: tuple(sweep()), 200.0,
         "BEM's change of the mean is shown beside the lattice's. 2 % is what figure 4.33 calls "
         "very good."),
)  # fmt: skip
