"""Free decays of the OC3 spar in still water beside OpenFAST's, and natural frequencies."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial

import numpy as np
import xarray

from .afloat import UNITS, likeness, motion, openfast_decay, parked, swing
from .framework import Case, Check

OPENFAST = "OpenFAST v5.0.0, rigid, WAMIT radiation by convolution, MAP++ lines"
PERIOD, DAMPING = 0.01, 0.10  #: as was asked for: of the reference
ALIKE = 0.05  #: of the size of a coupled motion; its correlation is to be above 0.95
STEP = 0.05  #: s
#: cycles that count, period s, and the coupled motions that are shown
DECAYS: dict[str, tuple[int, float, tuple[str, ...]]] = {
    "surge": (4, 123.5, ("pitch", "heave")),
    "heave": (8, 30.9, ("surge", "pitch")),
    "pitch": (8, 29.6, ("surge", "heave")),
    "yaw": (8, 8.26, ()),
}
FILES = {"surge": "surge10", "heave": "heave3", "pitch": "pitch5", "yaw": "yaw5"}


@cache
def decay(name: str) -> xarray.Dataset:
    """A free decay by galerna."""
    reference, rest = openfast_decay(FILES[name]), at_rest()
    start = {
        f"{motion}_{UNITS[motion]}": float(reference[motion][0] - rest[motion]) for motion in UNITS
    }
    duration = float(reference["time"][-1])
    return parked(duration, "still", platform={"start": start}, time_step_s=STEP)


@cache
def at_rest() -> dict[str, float]:
    """The motions m, deg at which the machine floats in still water."""
    result = parked(STEP, "still", time_step_s=STEP, outputs={"interval_s": STEP})
    return {name: float(motion(result, name)[0]) for name in UNITS}


def free_decay(name: str) -> Iterator[Check]:
    """Period and damping of one decay, and the motions that it brings about."""
    cycles, period, coupled = DECAYS[name]
    result, reference = decay(name), openfast_decay(FILES[name])
    time = result["time"].values
    found = swing(time, motion(result, name), cycles, period)
    wanted = swing(reference["time"], reference[name], cycles, period)
    yield Check(f"period of {name}", found[0], wanted[0], OPENFAST, PERIOD, "s", True)
    yield Check(f"damping ratio of {name}", found[1], wanted[1], OPENFAST, DAMPING, "-", True)
    for other in (name, *coupled):
        size, correlation = likeness(
            time, motion(result, other), reference["time"], reference[other]
        )
        judged = ALIKE if np.ptp(reference[other]) > 0.05 else None
        text = f"{other} in the decay of {name}"
        yield Check(f"{text}: size beside OpenFAST's", size, 1.0, OPENFAST, judged, "-")
        yield Check(f"{text}: correlation", correlation, 1.0, OPENFAST, judged and 0.05, "-")
        yield Check(
            f"{text}: range", np.ptp(motion(result, other)), np.ptp(reference[other]),
            OPENFAST, None, UNITS[other], True,
        )  # fmt: skip


CASES = [
    Case(
        f"afloat-decay-{name}",
        "afloat",
        f"Free decay in {name}",
        partial(lambda which: list(free_decay(which)), name),
        25.0,
        "Rigid turbine, rotor held, no air, still water, from OpenFAST's own first position (which "
        "is not its equilibrium but for one motion). Both series are read in the same way: "
        "the extremes of the first cycles, their spacing and the decrement of the ranges.",
    )
    for name in DECAYS
]
