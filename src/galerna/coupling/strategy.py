"""What a turbine's description leaves open for its controller, from its own rotor.

Each figure is computed once for a turbine: by blade-element momentum theory, rigid, in uniform
wind along the shaft.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from galerna.aero.bem.steady import SteadyRotor
from galerna.control.torque import AboveRated
from galerna.coupling.gains import optimal_mode_gain, rated_pitch, rated_wind_speed, tuned_gains
from galerna.turbine.model import Turbine
from galerna.units import DEG

TURBINES = 16  #: whose figures are kept
PITCH_STEP = 0.5 * DEG  #: each way, of the derivative
ABOVE_RATED = 1.3  #: times the rated wind speed, where the root moments' sensitivity is taken


@lru_cache(TURBINES)
def completed(turbine: Turbine, above_rated: AboveRated = "constant_power") -> Turbine:
    """The turbine with an optimal-mode gain and a pitch schedule, its own where it has them."""
    control, notes = turbine.control, list(turbine.notes)
    if control.optimal_mode_gain is None:
        gain = optimal_mode_gain(turbine)
        control = replace(control, optimal_mode_gain=gain)
        notes.append(f"optimal-mode gain from its own power coefficient: {gain:.4g} N m s2")
    if control.pitch_schedule is None:
        gains = tuned_gains(turbine, above_rated=above_rated).gains
        rows = np.column_stack([gains.pitch, gains.proportional, gains.integral])
        control = replace(control, pitch_schedule=rows)
        notes.append("pitch gains tuned to its own rotor")
    return replace(turbine, control=control, notes=tuple(notes))


@lru_cache(TURBINES)
def root_moment_by_pitch(turbine: Turbine) -> float:
    """How much the out-of-plane root moment falls with pitch, N m/rad, well above rated."""
    rotor, control = SteadyRotor(turbine), turbine.control
    wind = ABOVE_RATED * (control.rated_wind_speed or rated_wind_speed(turbine, rotor))
    pitch, speed = rated_pitch(turbine, rotor, wind), control.rated_rotor_speed
    less, more = (
        float(rotor.at(wind, speed, angle)["aerodynamic_root_out_of_plane_moment"])
        for angle in (pitch - PITCH_STEP, pitch + PITCH_STEP)
    )
    return (less - more) / (2.0 * PITCH_STEP)
