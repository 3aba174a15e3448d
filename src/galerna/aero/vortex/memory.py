"""What an unsteady lattice remembers from one step to the next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from galerna.aero.vortex.convection import Convection, Earlier
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.wake import Wake
from galerna.contract import Array


@dataclass(frozen=True, eq=False)
class Memory:
    """Everything the next step depends on, but for the factorisation.

    ``wake`` as it was last shed, ``elapsed`` s ago, ``convection`` its motion since and
    ``shed`` (n,) the time integrals of what the trailing edges have shed since; the surfaces'
    corners and circulations now, and the ``past`` circulations ``past_step`` s before (0: none);
    the ``trailing`` circulations (h,n) for as long as they still have to be shed, newest first,
    and the ``times`` (h,) s before now when they were.
    ``speed`` m/s is the highest of the air along the surfaces, to judge the wake by; ``sheds``
    counts the rows shed.
    """

    wake: Wake
    corners: list[Array]
    circulation: list[Array]
    speed: float
    shed: list[Array]
    trailing: list[Array]
    times: list[Array]
    elapsed: float = 0.0
    convection: Convection | None = None
    earlier: Earlier | None = None
    past: list[Array] = field(default_factory=list)
    past_step: float = 0.0
    sheds: int = 0

    def rates(self, circulation: Sequence[Array], dt: float) -> list[Array]:
        """Rates (m,n) m2/s2 to the circulations ``dt`` s from now, by backward differences.

        Of second order from the second step on (eq. 2.85), for steps of any length.
        """
        if self.past_step == 0.0:
            return [(g - b) / dt for g, b in zip(circulation, self.circulation, strict=True)]
        ratio = dt / self.past_step
        now, past = (1.0 + 2.0 * ratio) / (1.0 + ratio), ratio**2 / (1.0 + ratio)
        return [
            (now * g - (1.0 + ratio) * b + past * a) / dt
            for g, b, a in zip(circulation, self.circulation, self.past, strict=True)
        ]


def to_arrays(memory: Memory) -> dict[str, np.ndarray]:
    """A memory as plain arrays, one of each kind for each surface."""
    kinds: dict[str, Sequence[Array]] = {
        "vertices": memory.wake.vertices,
        "wake_circulation": memory.wake.circulation,
        "corners": memory.corners,
        "circulation": memory.circulation,
        "shed": memory.shed,
        "trailing": memory.trailing,
        "time": memory.times,
        "past": memory.past,
    }
    arrays = {"times": np.array([memory.elapsed, memory.past_step, memory.speed])}
    if memory.wake.centre is not None:
        arrays["centre"] = memory.wake.centre
    if memory.earlier is not None:
        kinds["earlier"] = memory.earlier.velocity
        kinds["held"] = memory.earlier.induced
        arrays["earlier_step"] = np.array(memory.earlier.step)
    if memory.convection is not None:
        kinds["velocity"] = memory.convection.velocity
        kinds["acceleration"] = memory.convection.acceleration or ()
        kinds["induced"] = memory.convection.induced
        axis = memory.convection.axis
        if axis is not None:
            arrays["axis"] = np.concatenate([axis.origin, axis.direction, [axis.speed]])
    arrays["surfaces"] = np.array(len(memory.corners))
    arrays["sheds"] = np.array(memory.sheds)
    for kind, values in kinds.items():
        arrays |= {f"{kind}_{i}": a.copy() for i, a in enumerate(values)}
    return arrays


def from_arrays(arrays: Mapping[str, np.ndarray], ages: Array) -> Memory:
    """The inverse of ``to_arrays``."""

    def kind(name: str) -> list[Array]:
        keys = (f"{name}_{i}" for i in range(int(arrays["surfaces"])))
        return [arrays[k].copy() for k in keys if k in arrays]

    elapsed, past_step, speed = (float(t) for t in arrays["times"])
    axis = arrays.get("axis")
    rotor = None if axis is None else RotorAxis(axis[:3], axis[3:6], float(axis[6]))
    convection = None
    if velocity := tuple(kind("velocity")):
        acceleration = tuple(kind("acceleration")) or None
        convection = Convection(velocity, acceleration, rotor, tuple(kind("induced")))
    past = None
    if "earlier_step" in arrays:
        held = tuple(kind("held"))
        past = Earlier(tuple(kind("earlier")), float(arrays["earlier_step"]), held)
    centre = arrays["centre"].copy() if "centre" in arrays else None
    return Memory(
        Wake(ages, tuple(kind("vertices")), tuple(kind("wake_circulation")), centre),
        kind("corners"),
        kind("circulation"),
        speed,
        kind("shed"),
        kind("trailing"),
        kind("time"),
        elapsed,
        convection,
        past,
        kind("past"),
        past_step,
        int(arrays["sheds"]),
    )
