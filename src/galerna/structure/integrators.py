"""Time integration of frames: generalized-alpha on the Lie group, Newmark-beta as a setting.

Each step finds the increment ``d`` (n,6) of the frames, ``H <- H exp(d)``, at which the
residual vanishes at its end. Sources: Bruls, Cardona and Arnold, Mech. Mach. Theory 48
(2012) 121; Chung and Hulbert, J. Appl. Mech. 60 (1993) 371; scaling of the constraints:
Bottasso, Dopico and Trainelli, Multibody Syst. Dyn. 19 (2008) 3.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numba import njit

from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError

from .blocks import FAST, apply, multiply3, multiply3_transposed
from .frames import exp_se3, inverse_tangents
from .initial import check_positions
from .pairs import carried_on
from .system import Balance, Forces, LoadFunction, State, System


@dataclass(frozen=True)
class Scheme:
    """Coefficients of a one-step scheme of the generalized-alpha family."""

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float

    @classmethod
    def generalized_alpha(cls, rho_inf: float = 0.9) -> Scheme:
        """Second order, with spectral radius ``rho_inf`` in [0, 1] at infinite frequency."""
        if not 0.0 <= rho_inf <= 1.0:
            raise InputError("rho_inf", f"{rho_inf:g} is outside 0 to 1", "0.9 is a good choice")
        if rho_inf > 0.99:
            warnings.warn(
                f"rho_inf = {rho_inf:g} damps nothing: with joints it is weakly unstable; "
                "0.9 or less is safe",
                stacklevel=2,
            )
        alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0)
        alpha_f = rho_inf / (rho_inf + 1.0)
        gamma = 0.5 + alpha_f - alpha_m
        return cls(alpha_m, alpha_f, 0.25 * (gamma + 0.5) ** 2, gamma)

    @classmethod
    def newmark(cls, alpha_n: float = 0.05) -> Scheme:
        """Newmark-beta with dissipation ``alpha_n``; of second order for alpha_n = 0 alone."""
        if not 0.0 <= alpha_n <= 0.5:
            raise InputError("alpha_n", f"{alpha_n:g} is outside 0 to 0.5")
        if alpha_n < 1e-3:
            warnings.warn(
                f"alpha_n = {alpha_n:g} lets the joints' forces ring; 0.01 or more is safe",
                stacklevel=2,
            )
        gamma = 0.5 + alpha_n
        return cls(0.0, 0.0, 0.25 * (gamma + 0.5) ** 2, gamma)


@dataclass(frozen=True)
class Tolerance:
    """When a step has converged: estimated error of the increments and of the velocities.

    ``relative`` to the largest of its kind in the step, or absolute in m, rad, m/s and rad/s.
    """

    relative: float = 1e-6
    displacement: float = 1e-10
    rotation: float = 1e-10
    velocity: float = 1e-8
    angular_velocity: float = 1e-8
    iterations: int = 20

    @property
    def absolute(self) -> Array:
        """The absolute tolerances (4,) in m, rad, m/s and rad/s."""
        return np.array([self.displacement, self.rotation, self.velocity, self.angular_velocity])


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
    variation: Array, inverse: Array, factors: Array, absolute: Array, relative: float,
    increment: Array, v: Array, v_rate: Array, auxiliary: Array,
) -> float:  # fmt: skip
    """Add Newton's variation to the trial; the change over its tolerance, the worst of kinds.

    The kinds are m, rad, m/s and rad/s, each with its tolerance in ``absolute`` (4,) and
    ``relative`` to the largest increment or velocity of its kind.
    """
    change_size, size = np.zeros(4), np.zeros(4)
    for i in range(1, len(variation)):
        change = apply(inverse[i], variation[i])
        for k in range(6):
            increment[i, k] += change[k]
            v[i, k] += factors[0] * change[k]
            v_rate[i, k] += factors[1] * change[k]
            auxiliary[i, k] += factors[2] * change[k]
            kind = k // 3
            change_size[kind] = max(change_size[kind], abs(change[k]))
            size[kind] = max(size[kind], abs(increment[i, k]))
            size[2 + kind] = max(size[2 + kind], abs(v[i, k]))
    change_size[2:] = factors[0] * change_size[:2]
    return np.max(change_size / (absolute + relative * size))


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

    def _one(self, state: State, dt: float, loads: LoadFunction | None) -> State:
        trial, increment = self._predict(state, dt)
        s, n = self.scheme, len(self.system)
        per_acceleration = (1.0 - s.alpha_m) / (s.beta * dt**2 * (1.0 - s.alpha_f))
        factors = np.array([s.gamma / (s.beta * dt), per_acceleration, 1.0 / (s.beta * dt**2)])
        scale = per_acceleration * self.system.mass_scale + self.system.stiffness_scale
        inverse, velocity_tangent, acceleration_tangent = np.zeros((3, n, 6, 6))
        absolute, none = self.tolerance.absolute, Forces.none(n)
        before, carried = np.inf, None
        for iteration in range(1, self.tolerance.iterations + 1):
            self.iterations = iteration
            _place(
                increment, state.position, state.rotation, factors[0], per_acceleration,
                trial.position, trial.rotation, inverse, velocity_tangent, acceleration_tangent,
            )  # fmt: skip
            forces = none if loads is None else loads(trial)
            balance = self.system.balance(
                trial, forces, velocity_tangent, acceleration_tangent, carried=carried
            )
            if not np.isfinite(balance.residual).all():
                break
            variation, multiplier, constraint = self.system.solve(balance, scale)
            carried = carried_on(self.system.pairs, balance.pairs, variation, multiplier)
            trial.multiplier += multiplier
            trial.constraint_multiplier += constraint
            error = _correct(
                variation, inverse, factors, absolute, self.tolerance.relative,
                increment, trial.velocity, trial.acceleration, trial.auxiliary,
            )  # fmt: skip
            if not np.isfinite(error):
                break
            contraction = min(error / before, 0.9) if np.isfinite(before) else 1.0
            if error * contraction <= 1.0:
                _settle(increment, state.position, state.rotation, trial.position, trial.rotation)
                return trial
            before = error
        raise self._failure(balance, trial.time)

    def _predict(self, state: State, dt: float) -> tuple[State, Array]:
        """A trial at the end of the step with unchanged accelerations, and its increments."""
        s, trial = self.scheme, state.copy()
        trial.time = state.time + dt
        old = state.auxiliary
        trial.auxiliary = (state.acceleration - s.alpha_m * old) / (1.0 - s.alpha_m)
        trial.velocity = state.velocity + dt * ((1.0 - s.gamma) * old + s.gamma * trial.auxiliary)
        increment = dt * state.velocity + dt**2 * ((0.5 - s.beta) * old + s.beta * trial.auxiliary)
        return trial, increment

    def _failure(self, balance: Balance, time: float) -> ConvergenceError:
        worst = int(np.nan_to_num(np.abs(balance.residual), nan=np.inf).max(axis=1).argmax())
        return ConvergenceError(
            self.system.names[worst],
            f"the step does not converge in {self.iterations} iterations; the largest residual "
            f"is {np.abs(balance.residual[worst]).max():.3g} (N, N m)",
            "try a smaller step or a smaller rho_inf",
            time,
        )

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
