"""Which circulation the trailing edges leave in the wake during a step.

On a lattice with vortices at the quarter of its panels all vorticity stands a quarter of a panel
upstream of where it belongs. The wake begins a quarter panel behind the trailing edge: where
fluid belongs that has left the edge half a panel before. So what enters the wake at a time t is
the trailing circulation at t - tau, tau = c_p / (2 u), with the chord c_p of the last panel and
the speed u of the air off the edge; its mean over a step from t_n to t_n+1 is

    G_n + theta (G_n+1 - G_n),    theta = 1/2 - tau / dt                                   (1)

A step of one panel, u dt = c_p, has theta = 0, the classical rule (eq. 2.72); long steps tend
to the mean of both ends. While G_n+1 is sought it is extrapolated from the last two.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.surface import Surface
from galerna.contract import Array

TAU = 0.5
EARLIEST = -1.0  #: theta of steps so short that G_n-1 is the earliest circulation known


def leads(surface: Surface, edge_velocity: Array, dt: float) -> Array:
    """theta (n,) of eq. (1), for the fluid's velocity (n+1,3) m/s at the trailing edge."""
    lattice = surface.lattice
    off = edge_velocity - Lattice(surface.velocity, lattice.rings).vertices[-1]
    way = np.linalg.norm(0.5 * (off[1:] + off[:-1]), axis=1) * dt
    last = lattice.corners[-1] - lattice.corners[-2]
    chord = np.linalg.norm(0.5 * (last[1:] + last[:-1]), axis=1)
    if lattice.rings == "edges":
        chord = np.zeros_like(chord)
    return np.clip(
        0.5 - TAU * chord / np.maximum(way, 1e-12 * (chord + way) + 1e-300), EARLIEST, 0.5
    )


def shed_circulation(
    leads: Sequence[Array],
    now: Sequence[Array],
    change: Sequence[Array],
    next_change: Sequence[Array] | None = None,
) -> list[Array]:
    """Mean circulations (n,) m2/s that the trailing edges shed in a step, eq. (1).

    ``now`` (m,n) are the bound circulations at its beginning, ``change`` (n,) what the trailing
    ones changed before over as long a time, ``next_change`` in the step, where it is known.
    """
    after = change if next_change is None else next_change
    return [
        g[-1] + np.where(theta > 0.0, theta * ahead, theta * behind)
        for theta, g, behind, ahead in zip(leads, now, change, after, strict=True)
    ]
