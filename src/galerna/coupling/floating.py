"""Where a platform floats at rest: water and moorings against weight and the rotor's loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from galerna.contract import Array, LoadModel, Loads, Motion
from galerna.coupling.flexible import FlexibleMachine
from galerna.errors import ConvergenceError, InputError
from galerna.hydro.rigid import MODES, constant_force_stiffness
from galerna.structure.frames import exp_so3
from galerna.structure.system import State, System

NEWTON_STEPS = 50
PASSES = 12  #: of the structure's loads and the pose, at most
SETTLED = 1e-4  #: m and rad, by which a pose changes from one pass to the next
NEUTRAL = 1e-9  #: of the largest stiffness: less holds nothing
LEFT_LOOSE = 1e-6  #: of the weight, that may act where nothing holds
ARM = np.array([1.0, 1.0, 1.0, 0.02, 0.02, 0.02])  #: 1 and 1/m
REACH = np.outer(ARM, ARM)  #: compares N/m with N m/rad
LARGEST_STEP = np.array([20.0] * 3 + [0.2] * 3)  #: m and rad, of one Newton step


@dataclass(eq=False)
class Pose:
    """Where a platform's reference point is held, (3,) m, and how it is turned, (3,3)."""

    position: Array
    rotation: Array

    def __call__(self, time: float) -> tuple[Array, Array]:
        return self.position, self.rotation

    def moved(self, step: Array) -> Pose:
        """This pose after a shift m and a turn rad (6,) in global axes."""
        return Pose(self.position + step[:3], exp_so3(step[3:]) @ self.rotation)

    def take(self, other: Pose) -> None:
        """Be where another one is."""
        self.position, self.rotation = other.position.copy(), other.rotation.copy()

    def distance(self, other: Pose) -> float:
        """The larger of shift m and turn rad between two poses, for small ones."""
        turn = np.abs(self.rotation - other.rotation).max()
        return float(max(np.abs(self.position - other.position).max(), turn))

    @property
    def motion(self) -> Motion:
        """The platform's frame at rest there."""
        motion = Motion.at_rest(1)
        motion.position[0], motion.rotation[0] = self.position, self.rotation
        return motion


@dataclass(frozen=True, eq=False)
class Burden:
    """What stands on a platform: ``mass`` kg, its ``center`` (3,) m in the platform's axes, and
    the other loads on it, ``wrench`` (6,) N, N m about the reference point in global axes."""

    mass: float
    center: Array
    wrench: Array


def at_rest(model: LoadModel, motion: Motion) -> Loads:
    """The loads of a model on what rests there, mean ones alone."""
    static: Callable[[Motion], Loads] | None = getattr(model, "static_loads", None)
    return model.loads(0.0, motion) if static is None else static(motion)


class WaterAtRest:
    """The loads of water and moorings on a platform at rest, by the names of their models.

    It is free to move but for the ``locked`` directions: 0 to 2 along, 3 to 5 about the axes.
    ``place`` (3,) m is where its reference point stood as it was described.
    """

    def __init__(
        self,
        models: Mapping[str, LoadModel],
        locked: tuple[int, ...] = (),
        place: Array | None = None,
    ) -> None:
        self.models, self.locked = models, locked
        self.place = Pose(np.zeros(3) if place is None else place, np.eye(3))
        self._free = np.array([k for k in range(6) if k not in locked], dtype=np.int64)

    def loads(self, pose: Pose) -> dict[str, Loads]:
        """The loads of each model at a pose, mean ones alone."""
        motion = pose.motion
        return {name: at_rest(model, motion) for name, model in self.models.items()}

    def settle(self, pose: Pose) -> None:
        """Tell the models that ask for it where the platform rests."""
        for model in self.models.values():
            told = getattr(model, "settle", None)
            if told is not None:
                told(pose.motion)

    def axes(self, pose: Pose) -> Array:
        """Axes (3,3) in which the water's added mass is taken about a pose."""
        for model in self.models.values():
            found = getattr(model, "axes_at", None)
            if found is not None:
                return np.asarray(found(pose.motion))
        return np.eye(3)

    def total(self, pose: Pose) -> tuple[Array, Array]:
        """Their sum (6,) about the reference point in global axes, and its stiffness (6,6)."""
        wrench, stiffness = np.zeros(6), np.zeros((6, 6))
        for load in self.loads(pose).values():
            wrench += np.concatenate([load.force.sum(axis=0), load.moment.sum(axis=0)])
            if load.stiffness is not None:
                stiffness += load.stiffness.sum(axis=0)
        return wrench, stiffness

    def equilibrium(self, burden: Burden, start: Pose, gravity: Array) -> Pose:
        """The pose at which all loads balance under a burden whose loads do not turn.

        Raises ConvergenceError where none is found, such as for a platform that capsizes.
        """
        pose, scale = start, burden.mass * float(np.linalg.norm(gravity))
        for _ in range(NEWTON_STEPS):
            residual, stiffness = self.balance(burden, pose, gravity)
            step = self._step(residual, stiffness, scale)
            share = min(1.0, float((LARGEST_STEP / np.maximum(np.abs(step), 1e-12)).min()))
            pose = pose.moved(share * step)
            if np.abs(step).max() < 1e-9 and np.abs(residual[self._free]).max() < 1e-6 * scale:
                self._require_stability(stiffness)
                return pose
        raise ConvergenceError(
            "platform",
            "no pose is found in which it floats at rest; last "
            f"at x, y, z = {np.round(pose.position, 2).tolist()} m",
            "check mass, centre of mass, buoyancy and moorings (galerna check shows them)",
        )

    def _step(self, residual: Array, stiffness: Array, scale: float) -> Array:
        """Newton's step (6,) in the free directions; nothing along what nothing holds."""
        free = np.ix_(self._free, self._free)
        values, axes = np.linalg.eigh(0.5 * (stiffness + stiffness.T)[free] * REACH[free])
        held = np.abs(values) > NEUTRAL * np.abs(values).max(initial=0.0)
        size = ARM[self._free]
        loose = axes[:, ~held].T @ (size * residual[self._free])
        if np.abs(loose).max(initial=0.0) > LEFT_LOOSE * scale:
            where = MODES[self._free[np.abs(axes[:, ~held]).max(axis=1).argmax()]]
            what = f"nothing holds it in {where} against a mean load of {np.abs(loose).max():.3g} N"
            raise InputError("platform", what, "give it moorings, or lock that direction")
        step = np.zeros(6)
        own = (stiffness[free] * REACH[free], size * residual[self._free])
        step[self._free] = size * np.linalg.lstsq(*own, rcond=NEUTRAL)[0]
        return step

    def _require_stability(self, stiffness: Array) -> None:
        """InputError where a small motion from the equilibrium would grow."""
        free = np.ix_(self._free, self._free)
        values, axes = np.linalg.eigh(0.5 * (stiffness + stiffness.T)[free] * REACH[free])
        if not len(values) or values[0] > -NEUTRAL * values[-1]:
            return
        worst = int(self._free[np.abs(axes[:, 0]).argmax()])
        unit = "N/m" if worst < 3 else "N m/rad"
        raise InputError(
            "platform",
            f"it is unstable in {MODES[worst]}: weight, buoyancy and moorings together "
            f"restore {stiffness[worst, worst]:.4g} {unit}",
            "lower the centre of mass, or enlarge the waterplane",
        )

    def balance(self, burden: Burden, pose: Pose, gravity: Array) -> tuple[Array, Array]:
        """The sum of all loads (6,) on a platform and its stiffness (6,6), in global axes."""
        wrench, stiffness = self.total(pose)
        weight, turning = weight_wrench(burden, pose, gravity)
        return wrench + weight + burden.wrench, stiffness + turning


def weight_wrench(burden: Burden, pose: Pose, gravity: Array) -> tuple[Array, Array]:
    """Weight (6,) about the reference point in global axes, and its stiffness (6,6)."""
    arm, weight = pose.rotation @ burden.center, burden.mass * gravity
    return np.concatenate([weight, np.cross(arm, weight)]), constant_force_stiffness(weight, arm)


def burden_of(machine: FlexibleMachine, states: tuple[State, ...], pose: Pose) -> Burden:
    """What a machine that is held in a pose puts on its base, mean over some shapes."""
    system = machine.system
    total = float(system.weight[:, 0].sum())
    centers, wrenches = [], []
    for state in states:
        centers.append(pose.rotation.T @ (mass_center(system, state) - pose.position))
        wrenches.append(base_reaction(machine, state))
    burden = Burden(total, np.mean(centers, axis=0), np.mean(wrenches, axis=0))
    weight, _ = weight_wrench(burden, pose, system.gravity)
    return Burden(total, burden.center, burden.wrench - weight)


def mass_center(system: System, state: State) -> Array:
    """Centre (3,) m of all mass that weighs, global axes."""
    first = system.weight[:, :1] * state.position + np.einsum(
        "nij,nj->ni", state.rotation, system.weight[:, 1:]
    )
    return np.asarray(first.sum(axis=0) / float(system.weight[:, 0].sum()))


def base_reaction(machine: FlexibleMachine, state: State) -> Array:
    """What a machine puts on the joint that holds its platform, (6,) about it in global axes."""
    system = machine.system
    pair = system.pair("base")
    node = system.pairs.ends[pair, 1]
    own = system.node_wrenches(state)[pair, 6:].reshape(2, 3)
    return np.asarray((own @ state.rotation[node].T).ravel())
