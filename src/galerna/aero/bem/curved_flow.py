"""The moment of a section that turns: its chord meets a flow that is curved.

A flat section that turns at the rate omega meets along its chord the downwash of one that is
bent to an arc. Thin-airfoil theory (Glauert, The Elements of Aerofoil and Airscrew Theory,
1926) gives such an arc the lift of the angle at the three-quarter chord and a moment against
omega about the quarter chord. Together they take energy from a section that twists about any
axis of its chord; the lift alone would give it some about every axis between the two points.
"""

from __future__ import annotations

from numba import njit

from galerna.aero.bem.dynamic_stall import model_share, passage
from galerna.aero.bem.lag import FASTMATH


@njit(cache=True, error_model="numpy", fastmath=FASTMATH)
def curved_flow_moment(
    slope: float, chord: float, speed: float, angle: float, rate: float
) -> float:
    """Moment coefficient about the quarter chord of a section that turns, -cl_alpha/8 T_u omega.

    ``slope`` 1/rad is that of the attached lift, 2 pi of a plate; ``chord`` in m, ``speed``
    m/s of the air, ``angle`` of attack rad; ``rate`` rad/s is nose-up positive. It fades with
    the unsteady section's terms out of the flow from the front.
    """
    return -0.125 * slope * model_share(angle) * passage(chord, speed) * rate
