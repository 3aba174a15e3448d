"""The contract between the parts of the machine.

A *load model* (aerodynamics, hydrodynamics, mooring, generator) names the
points of the machine it needs, sees the motion of a frame at each of them and
answers with forces and moments on those frames. ``simulation`` knows every
part through this page alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stations:
    """Points of one part at which a load model reads motion and applies loads.

    ``part`` is ``"blade1"``, ``"blade2"``, ..., ``"hub"``, ``"nacelle"``,
    ``"tower"`` or ``"platform"``. ``span`` (n,) is the fraction of the part's
    reference axis, 0 at the root and 1 at the tip; a rigid body has the one
    station ``[0.0]``. The frame of a blade station lies on the reference axis
    with the section axes of the aerodynamic twist: x towards the suction side,
    y towards the trailing edge, z along the axis to the tip.
    """

    part: str
    span: Array = field(default_factory=lambda: np.zeros(1))

    def __len__(self) -> int:
        return len(self.span)


@dataclass(eq=False, slots=True)
class Motion:
    """Motion of n frames in global axes; the accelerations are true derivatives.

    position (n,3) m, rotation (n,3,3) with the body's axes as columns, velocity
    (n,3) m/s, angular_velocity (n,3) rad/s, acceleration (n,3) m/s2 and
    angular_acceleration (n,3) rad/s2. The frames stand in the order of the load
    model's ``stations``. Read it during the call; its arrays are used again.
    """

    position: Array
    rotation: Array
    velocity: Array
    angular_velocity: Array
    acceleration: Array
    angular_acceleration: Array

    @classmethod
    def at_rest(cls, n: int) -> Motion:
        """n frames at the origin, aligned with the global axes, not moving."""
        zeros = [np.zeros((n, 3)) for _ in range(5)]
        rotation = np.tile(np.eye(3), (n, 1, 1))
        return cls(zeros[0], rotation, *zeros[1:])


@dataclass(eq=False, slots=True)
class Loads:
    """Forces (n,3) N and moments (n,3) N m about the frame origins, global axes.

    ``stiffness``, ``damping`` and ``mass`` (n,6,6), where a load is stiff, are
    minus d(load)/d(dx, dtheta) and its rates, with R <- exp(dtheta) R.
    """

    force: Array
    moment: Array
    stiffness: Array | None = None
    damping: Array | None = None
    mass: Array | None = None

    @classmethod
    def zero(cls, n: int) -> Loads:
        return cls(np.zeros((n, 3)), np.zeros((n, 3)))


@dataclass(frozen=True)
class Channel:
    """A result over time: its name, unit, meaning, dimensions beside time.

    The values along a dimension stand in the load model's ``coordinates``, for
    example ``{"blade": [1, 2, 3], "radius": r}``. ``openfast`` is the name of the
    same quantity in OpenFAST, empty where it has none; ``{blade}`` in it stands
    for the blade's number and ``{node}`` for the station's, both from 1.
    ``openfast_scale`` times the SI value gives OpenFAST's unit.
    """

    name: str
    unit: str
    long_name: str
    dims: tuple[str, ...] = ()
    openfast: str = ""
    openfast_unit: str = ""
    openfast_scale: float = 1.0


@runtime_checkable
class Inflow(Protocol):
    """Undisturbed wind: velocity (n,3) m/s at points (n,3) m and a time in s."""

    def velocity(self, points: Array, time: float) -> Array: ...


@runtime_checkable
class LoadModel(Protocol):
    """A load on the machine; see the module's text for the order of the calls.

    ``begin_step`` gets t_n, dt and the accepted motion at t_n and prepares a
    trial; it changes nothing that ``state`` returns, and calling it again
    replaces the trial. ``loads`` is asked at t_n+1, may be asked many times, and
    depends only on the committed state, the trial and its arguments. ``end_step``
    commits, and gets the time and the motion of the last ``loads``. ``record``
    gives the channels of the accepted step.
    """

    @property
    def stations(self) -> tuple[Stations, ...]: ...
    @property
    def channels(self) -> tuple[Channel, ...]: ...
    @property
    def coordinates(self) -> Mapping[str, Array]: ...
    @property
    def largest_step(self) -> float: ...
    def begin_step(self, time: float, dt: float, motion: Motion) -> None: ...
    def loads(self, time: float, motion: Motion) -> Loads: ...
    def end_step(self, time: float, motion: Motion) -> None: ...
    def record(self) -> Mapping[str, float | Array]: ...
    def state(self) -> dict[str, np.ndarray]: ...
    def restore(self, state: Mapping[str, np.ndarray]) -> None: ...
