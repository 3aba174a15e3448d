"""What AeroDyn's node at the very tip adds to a rotor's thrust.

Prandtl's factor is zero at the tip. galerna takes the circulation there as zero; AeroDyn's last
node has an axial induction of one instead, so that the wind does not reach it: it meets the rotor's
own speed along the rotor plane, at an angle of attack of minus the blade's pitch, and is loaded as
its polar says. Half a panel, 0.68 m of each blade, takes that load. It is emulated here from that
sentence alone, nothing is fitted.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import groupby

import numpy as np

from galerna import turbine as turbines
from galerna.aero.bem.options import BemOptions
from galerna.aero.sections import BladeSections, blade_sections
from galerna.contract import Array
from galerna.turbine.model import Turbine
from galerna.units import AIR_DENSITY, DEG, RPM

from .bem import AERODYN, steady_curve
from .framework import Case, Check
from .minnema_pierce import corrected_loads, section_forces
from .rotors import table, turning

MEASURED = 0.01  #: of the node's load, were it what is said above


def tip_force(
    sections: BladeSections, pitch: float, speed: float, *, unsteady_model: bool
) -> tuple[float, float]:
    """Force N/m across and along the rotor plane at an air speed in it; ``pitch`` rad of the chord.

    By the polar, or by the steady limit of AeroDyn's unsteady model.
    """
    lift, drag = (
        float(coefficient[-1])
        for coefficient in section_forces(
            sections,
            np.full(len(sections), -pitch),
            np.full(len(sections), speed),
            unsteady_model=unsteady_model,
        )
    )
    pressure = 0.5 * AIR_DENSITY * speed**2 * float(sections.chord[-1])
    return pressure * lift, -pressure * drag


def node_at_the_tip() -> Iterator[Check]:
    """The load of AeroDyn's last node, straight rigid blades, against the sentence above."""
    sections = blade_sections(turbines.load("nrel5mw"))
    rows = [row for row in table("openfast_nrel5mw_bem.csv") if row["geometry"] == "clean"]
    for wind, group in groupby(rows, key=lambda row: row["wind_speed_m_s"]):
        of_wind = list(group)
        last = {key: float(value) for key, value in of_wind[-1].items() if key != "geometry"}
        radius, force = np.array(
            [(float(row["radius_m"]), float(row["normal_force_n_m"])) for row in of_wind]
        ).T
        pitch = last["pitch_deg"] * DEG + float(sections.twist[-1])
        speed = last["rotor_speed_rpm"] * RPM * last["radius_m"]
        across, along = tip_force(sections, pitch, speed, unsteady_model=False)
        wanted = last["normal_force_n_m"], last["tangential_force_n_m"]
        for value, reference, text in zip(
            (across, along), wanted, ("across", "along"), strict=True
        ):
            yield Check(f"{wind} m/s: force {text} the rotor plane at the tip", value, reference,
                        AERODYN, MEASURED, "N/m", relative=True)  # fmt: skip
        whole = 3.0 * float(np.trapezoid(force, radius))
        part = 1.5 * (radius[-1] - radius[-2]) * force[-1]
        yield Check(f"{wind} m/s: thrust without that node", whole - part, whole, AERODYN, None,
                    "N", relative=True)  # fmt: skip


@cache
def loads_with_the_node(
    turbine: Turbine, options: BemOptions, wind: float, speed: float, pitch: float
) -> tuple[float, float]:
    """Thrust N and torque N m with AeroDyn's section forces and its node at the tip."""
    turn, sections = turning(turbine, options, wind, speed, pitch), blade_sections(turbine)
    radius: Array = turn["radius"]
    thrust, torque = corrected_loads(sections, turn, radius)
    chord_pitch = float((turn["inflow_angle"] - turn["angle_of_attack"])[..., -1].mean())
    across, along = tip_force(
        sections, chord_pitch, speed * RPM * float(radius[-1]), unsteady_model=True
    )
    length = 0.5 * turbine.number_of_blades * float(radius[-1] - radius[-2])
    return (
        thrust * float(turn["rotor_thrust"].mean()) + length * across,
        torque * float(turn["rotor_torque"].mean()) + length * along * float(radius[-1]),
    )


def steady_curve_with_the_node() -> Iterator[Check]:
    """The published steady curve with the node at the tip as AeroDyn has it."""
    yield from steady_curve(loads_with_the_node, judged=True)


NODE_STORY = """
Where Prandtl's factor is zero AeroDyn's node has an axial induction of one: it meets the rotor's
own speed alone, at an angle of attack of minus its pitch. Its load is that of the polar there. The
last row of each wind is what its half panel takes from the thrust.
"""
CURVE_STORY = """
bem-nrel5mw-steady once more, with the same tolerances: galerna's loads and that of half a panel at
the tip as AeroDyn has it. Of the difference in thrust, -0.7 % below rated and +3.0 % at 17 m/s,
0.1 % is left. galerna's own tip carries nothing, as Prandtl's factor says.
"""

CASES = (
    Case("bem-openfast-tip-node", "rotor", "NREL 5 MW: the load of AeroDyn's node at the tip",
         lambda: tuple(node_at_the_tip()), 1, NODE_STORY),
    Case("bem-nrel5mw-steady-tip-node", "rotor",
         "NREL 5 MW, steady operation, with AeroDyn's node at the tip",
         lambda: tuple(steady_curve_with_the_node()), 60, CURVE_STORY),
)  # fmt: skip
