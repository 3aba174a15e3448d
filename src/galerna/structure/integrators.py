"""Time integration of frames: generalized-alpha on the Lie group, Newmark-beta as a setting.

Each step finds the increment ``d`` (n,6) of the frames, ``H <- H exp(d)``, at which the
residual vanishes at its end. Sources: Bruls, Cardona and Arnold, Mech. Mach. Theory 48
(2012) 121; Chung and Hulbert, J. Appl. Mech. 60 (1993) 371; scaling of the constraints:
Bottasso, Dopico and Trainelli, Multibody Syst. Dyn. 19 (2008) 3.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numba import njit

from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError

from .blocks import FAST, apply, multiply3, multiply3_transposed
from .forces import Forces
from .frames import exp_se3, inverse_tangents
from .initial import check_positions
from .pairs import PairAnswer, carried_on
from .quasi_newton import Secants
from .scheme import Scheme, Tolerance
from .system import Balance, LoadFunction, State, System

FARTHEST = 1e6  #: m or rad that a frame can move in a step that converges
REFRESH = 0.25  #: contraction of Newton's method above which the tangent is made anew


@njit(cache=True, error_model="numpy")
def _place(
    increment: Array, x0: Array, R0: Array, per_velocity: float, per_acceleration: float,
    x: Array, R: Array, inverse: Array, velocity_tangent: Array, acceleration_tangent: Array,
) -> None:  # fmt: skip
    """Frames at the trial increments, and how twists and rates follow a variation there."""
    for i in range(1, len(x)):
        turn, shift = exp_se3(increment[i])
        x[i] = x0[i] + apply(R0[i], shift)
        R[i] = multiply3(R0[i], turn)
        ahead, _ = inverse_tangents(increment[i])
        inverse[i] = ahead
        for a in range(6):
            for b in range(6):
                velocity_tangent[i, a, b] = per_velocity * ahead[a, b]
                acceleration_tangent[i, a, b] = per_acceleration * ahead[a, b]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _correct(
    variation: Array, inverse: Array, factors: Array, residual: Array, wrench: Array,
    absolute: Array, relative: float, increment: Array, v: Array, v_rate: Array, auxiliary: Array,
    before: Array,
) -> tuple[float, float]:  # fmt: skip
    """Add Newton's variation to the trial; the error left over its tolerance, and the contraction.

    Both are the worst of all kinds, by the changes ``before`` (6,) and now, which replace them.

    The kinds are m, rad, m/s, rad/s, N and N m, each with its tolerance in ``absolute`` (6,)
    and ``relative`` to the largest increment, velocity or ``wrench`` (m,12) of its kind; what a
    correction takes away of forces and moments is the ``residual`` (n,6) before it.
    """
    change_size, size = np.zeros(6), np.zeros(6)
    for i in range(1, len(variation)):
        change = apply(inverse[i], variation[i])
        for k in range(6):
            increment[i, k] += change[k]
            if not abs(increment[i, k]) < FARTHEST:
                return np.inf, 1.0
            v[i, k] += factors[0] * change[k]
            v_rate[i, k] += factors[1] * change[k]
            auxiliary[i, k] += factors[2] * change[k]
            kind = k // 3
            change_size[kind] = max(change_size[kind], abs(change[k]))
            change_size[4 + kind] = max(change_size[4 + kind], abs(residual[i, k]))
            size[kind] = max(size[kind], abs(increment[i, k]))
            size[2 + kind] = max(size[2 + kind], abs(v[i, k]))
    for e in range(len(wrench)):
        for k in range(12):
            kind = 4 + (k // 3) % 2
            size[kind] = max(size[kind], abs(wrench[e, k]))
    change_size[2:4] = factors[0] * change_size[:2]
    left, worst = 0.0, 0.0
    for kind in range(6):
        contraction = min(change_size[kind] / before[kind], 0.9) if before[kind] > 0.0 else 0.5
        error = change_size[kind] * contraction / (1.0 - contraction)
        error /= absolute[kind] + relative * size[kind]
        before[kind] = change_size[kind]
        if error > left:
            left, worst = error, contraction
    return left, worst


@njit(cache=True, error_model="numpy")
def _settle(increment: Array, x0: Array, R0: Array, x: Array, R: Array) -> None:
    """Frames at the accepted increments, rounding taken out of the rotations.

    One step of Newton's iteration towards the nearest orthogonal matrix is enough.
    """
    for i in range(1, len(x)):
        turn, shift = exp_se3(increment[i])
        x[i] = x0[i] + apply(R0[i], shift)
        turned = multiply3(R0[i], turn)
        correction = -0.5 * multiply3_transposed(turned, turned)
        for a in range(3):
            correction[a, a] += 1.5
        R[i] = multiply3(turned, correction)


class Trial:
    """A step under way: ``state`` is where its end is thought to be.

    ``correct`` takes one step of Newton's method under the loads at ``state`` and says
    whether the step has converged; ``settled`` is the end of a converged step.
    """

    def __init__(self, integrator: Integrator, start: State, dt: float) -> None:
        self._start, self._system, self._tolerance = start, integrator.system, integrator.tolerance
        s, n = integrator.scheme, len(integrator.system)
        per_acceleration = (1.0 - s.alpha_m) / (s.beta * dt**2 * (1.0 - s.alpha_f))
        self._factors = np.array(
            [s.gamma / (s.beta * dt), per_acceleration, 1.0 / (s.beta * dt**2)]
        )
        self._scale = per_acceleration * self._system.mass_scale + self._system.stiffness_scale
        self._tangents = np.zeros((3, n, 6, 6))  # inverse, of velocity, of acceleration
        self._before = np.zeros(6)  # changes of the last correction, by kind
        self._fresh = False  # whether the tangent need not be made anew
        self._last: tuple[PairAnswer, Array, Array] | None = None
        self._secants = Secants(6 * n)
        self._residual = np.zeros((n, 6))
        self._predict(s, dt)
        self._place()

    def correct(self, forces: Forces) -> bool:
        """Correct the trial under ``forces``; raises ConvergenceError where it diverges."""
        balance = self._balance(forces)
        variation, multiplier, constraint = self._advised(*self._system.correction(balance))
        state, tolerance = self.state, self._tolerance
        state.multiplier += multiplier
        state.constraint_multiplier += constraint
        error, contraction = _correct(
            variation, self._tangents[0], self._factors, balance.residual,
            balance.pairs.node_wrench, tolerance.absolute, tolerance.relative,
            self._increment, state.velocity, state.acceleration, state.auxiliary, self._before,
        )  # fmt: skip
        if not np.isfinite(error):
            raise self.failure()
        self._fresh = contraction < REFRESH or self._last is None
        self._last = balance.pairs, variation, multiplier
        if error <= 1.0:
            return True
        self._place()
        return False

    def _advised(
        self, variation: Array, multiplier: Array, constraint: Array
    ) -> tuple[Array, Array, Array]:
        """Newton's correction with what the step's earlier ones tell of the loads."""
        parts = variation, multiplier, constraint
        step = self._secants.step(np.concatenate([part.ravel() for part in parts]))
        ends = np.cumsum([part.size for part in parts])
        first, second, third = np.split(step, ends[:-1])
        return first.reshape(variation.shape), second.reshape(multiplier.shape), third

    def _balance(self, forces: Forces) -> Balance:
        """The residual at the trial; the tangent of a fast iteration stays what it was."""
        if self._fresh:
            balance = self._system.residual(self.state, forces)
        else:
            pairs, last = self._system.pairs, self._last
            carried = None if last is None else carried_on(pairs, *last)
            _, velocity_tangent, acceleration_tangent = self._tangents
            balance = self._system.balance(
                self.state, forces, velocity_tangent, acceleration_tangent, carried=carried
            )
        self._residual = balance.residual
        if not np.isfinite(balance.residual).all():
            raise self.failure()
        if not self._fresh:
            self._system.factorise(balance, self._scale)
        return balance

    def settled(self) -> State:
        """The end of the step, rounding taken out of its rotations."""
        start, state = self._start, self.state
        _settle(self._increment, start.position, start.rotation, state.position, state.rotation)
        return state

    def failure(self, iterations: int = 0) -> ConvergenceError:
        """Why the step fails: the frame with the largest residual."""
        worst = int(np.nan_to_num(np.abs(self._residual), nan=np.inf).max(axis=1).argmax())
        often = f" in {iterations} iterations" if iterations else ""
        return ConvergenceError(
            self._system.names[worst],
            f"the step does not converge{often}; the largest residual "
            f"is {np.abs(self._residual[worst]).max():.3g} (N, N m)",
            "try a smaller step or a smaller rho_inf",
            self.state.time,
        )

    def _predict(self, s: Scheme, dt: float) -> None:
        """The end of the step with unchanged accelerations, and its increments."""
        start, state = self._start, self._start.copy()
        state.time = start.time + dt
        old = start.auxiliary
        new = (start.acceleration - s.alpha_m * old) / (1.0 - s.alpha_m)
        state.auxiliary = new
        state.velocity = start.velocity + dt * ((1.0 - s.gamma) * old + s.gamma * new)
        self._increment = dt * start.velocity + dt**2 * ((0.5 - s.beta) * old + s.beta * new)
        self.state = state

    def _place(self) -> None:
        """Put the frames of the trial where its increments say."""
        start, state = self._start, self.state
        _place(
            self._increment, start.position, start.rotation, self._factors[0], self._factors[1],
            state.position, state.rotation, *self._tangents,
        )  # fmt: skip


@dataclass(eq=False)
class Integrator:
    """Steps a system through time with one scheme.

    ``iterations`` is the number that the last step took.
    """

    system: System
    scheme: Scheme = field(default_factory=Scheme.generalized_alpha)
    tolerance: Tolerance = field(default_factory=Tolerance)
    halvings: int = 4
    iterations: int = 0

    def step(self, state: State, dt: float, loads: LoadFunction | None = None) -> State:
        """The state one ``dt`` s later; a step that does not converge is taken in halves.

        ``loads`` is asked for the forces at each trial state. Raises ConvergenceError
        with the frame of the largest residual when the halves fail too, InputError for a
        step that is not a positive time.
        """
        if not 0.0 < dt < np.inf:
            raise InputError("time step", f"{dt:g} s is not a positive time")
        for halving in range(self.halvings + 1):
            pieces = 2**halving
            try:
                trial = state
                for _ in range(pieces):
                    trial = self._one(trial, dt / pieces, loads)
                return trial
            except ConvergenceError as error:
                failure = error
        raise failure

    def begin(self, state: State, dt: float) -> Trial:
        """A step of ``dt`` s under way from ``state``, for a coupling that iterates itself."""
        return Trial(self, state, dt)

    def _one(self, state: State, dt: float, loads: LoadFunction | None) -> State:
        trial, none = self.begin(state, dt), Forces.none(len(self.system))
        for iteration in range(1, self.tolerance.iterations + 1):
            self.iterations = iteration
            if trial.correct(none if loads is None else loads(trial.state)):
                return trial.settled()
        raise trial.failure(self.tolerance.iterations)

    def march(
        self, state: State, dt: float, steps: int, loads: LoadFunction | None = None
    ) -> Iterator[State]:
        """The states after each of ``steps`` equal steps.

        Raises InputError, with the joint named, where the first positions violate a constraint.
        """
        check_positions(self.system, state)
        for _ in range(steps):
            state = self.step(state, dt, loads)
            yield state
