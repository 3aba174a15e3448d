"""The operating strategy and controller gains of a windIO file, at the generator and in SI."""

from __future__ import annotations

import numpy as np

from galerna.turbine.model import Array, Control
from galerna.turbine.windio.block import Block, merged_grid
from galerna.units import DEG, RPM


def read_control(document: Block, gear_ratio: float, notes: list[str]) -> Control:
    """Control from ``assembly`` and ``control``; windIO's gains see the rotor in rpm and deg."""
    assembly, block = document.block("assembly"), document.optional("control")
    gain = block.number("region2_k", None, 0.0)
    return Control(
        rated_power=block.number("rated_power", None, 0.0) or assembly.number("rated_power", low=0),
        rated_rotor_speed=block.number("rated_rotor_speed", low=0.0) * RPM,
        minimum_rotor_speed=block.number("min_rotor_speed", 0.0, 0.0) * RPM,
        cut_in_wind_speed=assembly.number("cut_in_wind_speed", 3.0, 0.0),
        cut_out_wind_speed=assembly.number("cut_out_wind_speed", 25.0, 0.0),
        optimal_tip_speed_ratio=block.number("optimal_tsr", None, 0.0),
        fine_pitch=block.number("fine_pitch", 0.0) * DEG,
        maximum_pitch=block.number("max_pitch_limit", 90.0) * DEG,
        maximum_pitch_rate=block.number("max_pitch_rate", np.inf / DEG, 0.0) * DEG,
        maximum_torque=block.number("max_gen_torque", None, 0.0),
        maximum_torque_rate=block.number("max_torque_rate", np.inf, 0.0),
        optimal_mode_gain=None if gain is None else gain / (gear_ratio * RPM) ** 2,
        pitch_schedule=_pitch_schedule(block, gear_ratio, notes),
        minimum_pitch_table=_minimum_pitch(block),
        speed_filter_frequency=block.number("lpf_frequency", None, 0.0),
    )


def _pitch_schedule(block: Block, gear_ratio: float, notes: list[str]) -> Array | None:
    """Pitch rad, proportional gain s, integral gain (n,3); positive gains pitch to feather."""
    if not (block.has("pitch_kp") and block.has("pitch_ki")):
        return None
    curves = []
    for key, gain in (("pitch_kp", "kp"), ("pitch_ki", "ki")):
        inner = block.block(key)
        pitch = inner.array("pitch_angle")
        if (np.diff(pitch) <= 0.0).any():
            raise inner.error("must ascend", "", "pitch_angle")
        curves.append((pitch, inner.array(gain, len(pitch))))
    pitch = merged_grid(curves[0][0], curves[1][0])
    gains = np.stack([np.interp(pitch, *curve) for curve in curves], axis=1)
    if gains[0, 1] < 0.0:
        gains = -gains
        notes.append(
            "control: the pitch gains act on reference minus measured speed; their sign was turned"
        )
    return np.column_stack([pitch * DEG, gains * (DEG / RPM / gear_ratio)])


def _minimum_pitch(block: Block) -> Array | None:
    if not block.has("min_pitch_table"):
        return None
    table = block.block("min_pitch_table")
    speed = table.array("wind_speed", low=0.0)
    if (np.diff(speed) <= 0.0).any():
        raise table.error("must ascend", "", "wind_speed")
    return np.column_stack([speed, table.array("min_pitch", len(speed)) * DEG])
