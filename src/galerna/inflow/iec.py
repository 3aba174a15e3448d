"""Figures of IEC 61400-1 (ed. 3, 2005, and ed. 4, 2019) that depend on class and height."""

from __future__ import annotations

from typing import Literal

TurbineClass = Literal["I", "II", "III"]
TurbulenceClass = Literal["A+", "A", "B", "C"]

#: V_ref m/s, ten-minute mean with a return period of 50 years (Table 1)
REFERENCE_SPEED: dict[TurbineClass, float] = {"I": 50.0, "II": 42.5, "III": 37.5}

#: I_ref at 15 m/s (Table 1; A+ came with edition 4)
REFERENCE_INTENSITY: dict[TurbulenceClass, float] = {"A+": 0.18, "A": 0.16, "B": 0.14, "C": 0.12}


def normal_turbulence(hub_speed: float, turbulence_class: TurbulenceClass) -> float:
    """Standard deviation sigma_1 m/s of the normal turbulence model (6.3.1.3, eq. 11)."""
    return REFERENCE_INTENSITY[turbulence_class] * (0.75 * hub_speed + 5.6)


def longitudinal_scale(hub_height: float) -> float:
    """Turbulence scale parameter Lambda_1 m (6.3, eq. 5)."""
    return 0.7 * min(hub_height, 60.0)


def yearly_extreme_speed(turbine_class: TurbineClass) -> float:
    """Steady extreme wind speed V_e1 m/s at hub height, once a year (6.3.2.1)."""
    return 0.8 * 1.4 * REFERENCE_SPEED[turbine_class]
