"""A small turbine with everything askew, and a load model that does little, for tests."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from galerna.contract import Array, Channel, Loads, Motion, Stations
from galerna.turbine.model import (
    Airfoil,
    Blade,
    BladeShape,
    Control,
    Drivetrain,
    Hub,
    Nacelle,
    Polar,
    Tower,
    Turbine,
    UnsteadyParameters,
)

FLAT_PLATE = Airfoil(
    name="plate",
    relative_thickness=0.1,
    aerodynamic_center=0.25,
    polars=(
        Polar(
            1e6,
            np.linspace(-np.pi, np.pi, 73),
            np.sin(2.0 * np.linspace(-np.pi, np.pi, 73)),
            0.01 + np.sin(np.linspace(-np.pi, np.pi, 73)) ** 2,
            np.zeros(73),
        ),
    ),
    unsteady=UnsteadyParameters(0.0, 6.28, (0.2, -0.2), (1.2, -1.2), 0.01, 0.0),
)


def small_turbine() -> Turbine:
    """Three prebent blades of 10 m with tilt, cone and overhang on a tower of 20 m."""
    span = np.array([0.0, 0.5, 1.0])
    shape = BladeShape(
        span=span,
        chord=np.array([1.0, 0.8, 0.3]),
        twist=np.array([0.2, 0.1, 0.0]),
        relative_thickness=np.full(3, 0.1),
        leading_edge_offset=np.array([0.3, 0.2, 0.1]),
        normal_offset=np.zeros(3),
        airfoil_span=np.array([0.0, 1.0]),
        airfoil_names=("plate", "plate"),
    )
    axis = np.array([[0.0, 0.0, 0.0], [-0.1, 0.05, 5.0], [-0.5, 0.1, 10.0]])
    return Turbine(
        name="small",
        number_of_blades=3,
        blade=Blade(axis_span=span, axis=axis, shape=shape),
        airfoils={"plate": FLAT_PLATE},
        hub=Hub(radius=0.5, cone=0.05),
        nacelle=Nacelle(overhang=1.5, shaft_height=0.9, tilt=0.09),
        drivetrain=Drivetrain(),
        tower=Tower(
            axis_span=np.array([0.0, 1.0]),
            axis=np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 20.0]]),
            diameter=np.array([1.5, 1.0]),
            drag_coefficient=np.ones(2),
        ),
        control=Control(50e3, 6.0, 2.0, 4.0, 25.0),
        hub_height=21.03,
    )


class Spring:
    """A load model with memory: the drag of its past, and as many stations as asked."""

    def __init__(self, stations: tuple[Stations, ...] | None = None, fail_at: float = np.inf):
        self.stations = stations or (Stations("hub"), Stations("blade1", np.linspace(0.0, 1.0, 3)))
        self.channels = (
            Channel("tip_height", "m", "height of the tip", (), "TipZ", "m", 1.0),
            Channel("pull", "N", "pull on the stations", ("node",), "N{node}Pull", "kN", 1e-3),
        )
        self.coordinates: Mapping[str, Array] = {"node": np.arange(1.0, self._count + 1.0)}
        self.largest_step = np.inf
        self.fail_at = fail_at
        self.calls: list[str] = []
        self._memory = np.zeros((self._count, 3))
        self._tip_height = 0.0

    @property
    def _count(self) -> int:
        return sum(len(s) for s in self.stations)

    def begin_step(self, time: float, dt: float, motion: Motion) -> None:
        self.calls.append("begin")
        self._decay = np.exp(-dt)

    def loads(self, time: float, motion: Motion) -> Loads:
        self.calls.append("loads")
        force = self._decay * self._memory - motion.velocity
        if time >= self.fail_at:
            force[0, 1] = np.nan
        return Loads(force, np.zeros_like(force))

    def end_step(self, time: float, motion: Motion) -> None:
        self.calls.append("end")
        self._memory = self._decay * self._memory - motion.velocity
        self._tip_height = float(motion.position[-1, 2])

    def record(self) -> Mapping[str, float | Array]:
        return {
            "tip_height": self._tip_height,
            "pull": np.linalg.norm(self._memory, axis=1),
        }

    def state(self) -> dict[str, np.ndarray]:
        return {"memory": self._memory.copy(), "tip_height": np.array(self._tip_height)}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        self._memory = state["memory"].copy()
        self._tip_height = float(state["tip_height"])
