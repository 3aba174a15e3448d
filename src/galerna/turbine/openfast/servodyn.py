"""ServoDyn and ROSCO's DISCON.IN: operating strategy and controller gains."""

from __future__ import annotations

import numpy as np

from galerna.turbine.model import Array, Control
from galerna.turbine.openfast.deck import Deck
from galerna.units import DEG, RPM

_SIMPLE, _BLADED = 1, 5  # ServoDyn's VSContrl and PCMode
_UNKNOWN = Control(0.0, 0.0, 0.0, 0.0, np.inf)


def read_control(servo: Deck | None, gear_ratio: float, notes: list[str]) -> Control:
    """ROSCO's gains where the deck has them, else ServoDyn's simple torque law, else nothing."""
    if servo is None:
        notes.append("control: the deck has no ServoDyn; rated power and speed are unknown (0)")
        return _UNKNOWN
    discon = _controller_input(servo, notes)
    if discon is not None:
        return _rosco(discon, gear_ratio)
    if servo.integer("VSContrl", 0) == _SIMPLE:
        return _simple(servo, gear_ratio)
    notes.append("control: the deck states no gains; rated power and speed are unknown (0)")
    return _UNKNOWN


def _controller_input(servo: Deck, notes: list[str]) -> Deck | None:
    """ROSCO's input file; many decks name one that their own controller never reads."""
    bladed = _BLADED in (servo.integer("VSContrl", 0), servo.integer("PCMode", 0))
    if not bladed or not servo.names_file("DLL_InFile"):
        return None
    name = servo.text("DLL_InFile")
    if not servo.beside(name).is_file():
        notes.append(f"control: the deck names {name}, which is not there")
        return None
    discon = servo.file("DLL_InFile")
    if discon.has("PC_GS_angles"):
        return discon
    notes.append(f"control: {name} is not a ROSCO file; its gains were not read")
    return None


def _simple(servo: Deck, gear_ratio: float) -> Control:
    """ServoDyn's VSContrl = 1: torque by the square of the speed up to the rated one."""
    torque = servo.number("VS_RtTq", low=0.0)
    speed = servo.number("VS_RtGnSp", low=0.0) * RPM
    efficiency = servo.number("GenEff", 100.0, 0.0, 100.0) / 100.0
    return Control(
        rated_power=torque * speed * efficiency,
        rated_rotor_speed=speed / gear_ratio,
        minimum_rotor_speed=0.0,
        cut_in_wind_speed=0.0,
        cut_out_wind_speed=np.inf,
        fine_pitch=servo.number("BlPitchF(1)", 0.0) * DEG,
        maximum_pitch_rate=servo.number("PitManRat(1)", np.inf / DEG, 0.0) * DEG,
        rated_torque=torque,
        optimal_mode_gain=servo.number("VS_Rgn2K", low=0.0) / RPM**2,
    )


def _rosco(discon: Deck, gear_ratio: float) -> Control:
    """ROSCO works in SI at the generator; its table of lowest pitch spans the operating winds."""
    lowest = _lowest_pitch(discon)
    return Control(
        rated_power=discon.number("VS_RtPwr", low=0.0),
        rated_rotor_speed=discon.number("PC_RefSpd", low=0.0) / gear_ratio,
        minimum_rotor_speed=discon.number("VS_MinOMSpd", 0.0, 0.0) / gear_ratio,
        cut_in_wind_speed=0.0 if lowest is None else float(lowest[0, 0]),
        cut_out_wind_speed=np.inf if lowest is None else float(lowest[-1, 0]),
        optimal_tip_speed_ratio=discon.number("VS_TSRopt", low=0.0),
        fine_pitch=discon.number("PC_FinePit", 0.0),
        maximum_pitch=discon.number("PC_MaxPit", np.pi / 2),
        maximum_pitch_rate=discon.number("PC_MaxRat", np.inf, 0.0),
        rated_torque=discon.number("VS_RtTq", low=0.0),
        maximum_torque=discon.number("VS_MaxTq", low=0.0),
        maximum_torque_rate=discon.number("VS_MaxRat", np.inf, 0.0),
        optimal_mode_gain=discon.number("VS_Rgn2K", low=0.0),
        pitch_schedule=_pitch_schedule(discon),
        minimum_pitch_table=lowest,
        speed_filter_frequency=discon.number("F_LPFCornerFreq", low=0.0),
    )


def _pitch_schedule(discon: Deck) -> Array:
    """Pitch rad, gains s and rad/rad (n,3); ROSCO's act on reference minus measured speed."""
    pitch, proportional, integral = (
        _array(discon, f"PC_GS_{key}", "PC_GS_n") for key in ("angles", "KP", "KI")
    )
    if (np.diff(pitch) <= 0.0).any():
        raise discon.error("PC_GS_angles must ascend", "", discon.entry("PC_GS_angles").line)
    return np.column_stack([pitch, -proportional, -integral])


def _lowest_pitch(discon: Deck) -> Array | None:
    """Wind speed m/s and lowest pitch rad (n,2); None for a single entry that means nothing."""
    count = "PS_BldPitchMin_N"
    if discon.integer(count, 0) < 2:
        return None
    winds, pitch = (_array(discon, key, count) for key in ("PS_WindSpeeds", "PS_BldPitchMin"))
    if (np.diff(winds) <= 0.0).any():
        raise discon.error("PS_WindSpeeds must ascend", "", discon.entry("PS_WindSpeeds").line)
    return np.column_stack([winds, pitch])


def _array(discon: Deck, keyword: str, count: str) -> Array:
    entry, n = discon.entry(keyword), discon.integer(count, low=1)
    if n != len(entry.values):
        raise discon.error(
            f"{keyword} has {len(entry.values)} values; {count} says {n}", "", entry.line
        )
    return np.array(discon.numbers(keyword, n))
