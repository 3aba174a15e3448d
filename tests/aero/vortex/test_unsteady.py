"""Unsteady lattices: thin airfoil theory, wakes that grow, substeps, states, faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import hankel2, i0e, i1e, k0e, k1e

from galerna.aero.vortex.ages import growing_ages, uniform_ages
from galerna.aero.vortex.cores import VortexCore
from galerna.aero.vortex.lattice import Lattice
from galerna.aero.vortex.rotor_axis import RotorAxis
from galerna.aero.vortex.start import drifted_wake
from galerna.aero.vortex.surface import Surface
from galerna.aero.vortex.unsteady import UnsteadyLattice, UnsteadyOptions
from galerna.aero.vortex.wings import elliptic_wing
from galerna.contract import Array
from galerna.errors import ConvergenceError, InputError
from validation.thin_airfoil import kuessner

SPAN, ANGLE = 1e4, np.radians(0.1)
PRESCRIBED = UnsteadyOptions(free=False, start="impulsive", tree_error=None, air_density=1.0)


class Wind:
    """A wind of 1 m/s along x whose vertical part is a function of place and time."""

    def __init__(self, upwards=lambda x, t: 0.0 * x) -> None:  # type: ignore[no-untyped-def]
        self.upwards = upwards

    def velocity(self, points: Array, time: float) -> Array:
        out = np.zeros_like(points)
        out[:, 0] = 1.0
        out[:, 2] = self.upwards(points[:, 0], time)
        return out


def plate(panels: int, angle: float = 0.0) -> Array:
    """Corners of a flat plate of chord 1 m, one panel across its huge span."""
    along = np.linspace(0.0, 1.0, panels + 1)[:, None]
    corners = np.zeros((panels + 1, 2, 3))
    corners[..., 0], corners[..., 2] = along * np.cos(angle), -along * np.sin(angle)
    corners[..., 1] = np.array([-0.5, 0.5]) * SPAN
    return corners


def lift_history(lattice: UnsteadyLattice, place, dt: float, steps: int) -> Array:  # type: ignore[no-untyped-def]
    """Lift (steps,) N/m2 after each step of surfaces that ``place(time)`` gives."""
    lift = np.empty(steps)
    for i in range(steps):
        lattice.begin_step(i * dt, dt, place(i * dt))
        lift[i] = lattice.solve((i + 1) * dt, place((i + 1) * dt)).loads[0].force[2] / SPAN
        lattice.end_step((i + 1) * dt, place((i + 1) * dt))
    return lift


def wagner(s: float) -> float:
    """Wagner's function of the semichords travelled, exactly (Garrick 1938)."""

    def integrand(z: float) -> float:
        x = np.exp(z)
        k = (k0e(x) - k1e(x)) ** 2 * np.exp(-2.0 * x)
        i = np.pi**2 * (i0e(x) + i1e(x)) ** 2 * np.exp(2.0 * x)
        return np.exp(-x * s) / (x * (k + i))

    return 1.0 - quad(integrand, -30.0, np.log(30.0), limit=400)[0]


@pytest.mark.parametrize("growing", [False, True])
def test_a_plate_that_starts_has_wagners_lift_also_with_a_wake_of_few_panels(growing: bool) -> None:
    panels, duration = 10, 10.0
    step = 1.0 / panels
    ages = uniform_ages(step, duration)
    if growing:
        ages = growing_ages(step, 12.0, near=2.0, growth=1.1, widest=0.5)
        assert len(ages) < 0.5 * (len(uniform_ages(step, duration)))
    still = [Surface.at_rest(plate(panels, ANGLE))]
    lift = lift_history(
        UnsteadyLattice(Wind(), ages, PRESCRIBED), lambda t: still, step, round(duration / step)
    )
    for semichords in (2.0, 4.0, 10.0, 20.0):
        got = lift[round(0.5 * semichords / step) - 1] / (np.pi * np.sin(ANGLE))
        assert got == pytest.approx(wagner(semichords), rel=0.01), semichords


@pytest.mark.parametrize("growing", [False, True])
def test_a_plate_that_meets_a_gust_has_kuessners_lift(growing: bool) -> None:
    """Within 1 % once the gust's front has left it; before, a front between points is coarse."""
    panels, duration = 16, 5.0
    step = 1.0 / panels
    ages = uniform_ages(step, duration)
    if growing:
        ages = growing_ages(step, 6.0, near=1.0, growth=1.1, widest=0.5)
    gust = Wind(lambda x, t: np.where(x < t, ANGLE, 0.0))
    still = [Surface.at_rest(plate(panels))]
    lattice = UnsteadyLattice(gust, ages, PRESCRIBED, wake_inflow=Wind())
    lift = lift_history(lattice, lambda t: still, step, round(duration / step))
    for semichords in (2.5, 4.0, 6.0, 10.0):
        got = lift[round(0.5 * semichords / step) - 1] / (np.pi * ANGLE)
        assert got == pytest.approx(kuessner(semichords), rel=0.01), semichords
    assert lift[round(0.5 / step) - 1] / (np.pi * ANGLE) == pytest.approx(kuessner(1.0), rel=0.03)


def test_wagners_lift_converges_with_the_panels() -> None:
    errors = []
    for panels in (8, 16, 32):
        still = [Surface.at_rest(plate(panels, ANGLE))]
        lattice = UnsteadyLattice(Wind(), uniform_ages(1.0 / panels, 1.0), PRESCRIBED)
        lift = lift_history(lattice, lambda t, s=still: s, 1.0 / panels, panels)
        errors.append(abs(lift[-1] / (np.pi * np.sin(ANGLE)) / wagner(2.0) - 1.0))
    assert errors[0] / errors[1] > 1.7
    assert errors[1] / errors[2] > 1.7


def plunge_response(
    frequency: float, panels: int, step: float, options: UnsteadyOptions = PRESCRIBED
) -> complex:
    """Lift of a plate in plunge over Theodorsen's, at a reduced frequency."""
    omega = 2.0 * frequency
    steps = round(2.0 * np.pi / omega / step)
    step = 2.0 * np.pi / omega / steps
    ages = growing_ages(step, 3.0 * steps * step, near=1.0, growth=1.1, widest=max(step, 0.5))
    base, up = plate(panels), np.array([0.0, 0.0, 1e-3])

    def place(t: float) -> list[Surface]:
        speed = np.broadcast_to(omega * np.cos(omega * t) * up, base.shape)
        return [Surface(Lattice(base + np.sin(omega * t) * up), speed)]

    lift = lift_history(UnsteadyLattice(Wind(), ages, options), place, step, 2 * steps)[-steps:]
    times = step * np.arange(steps + 1, 2 * steps + 1)
    got = 2.0 * np.mean(lift * np.exp(-1j * omega * times))
    theodorsen = hankel2(1, frequency) / (hankel2(1, frequency) + 1j * hankel2(0, frequency))
    plunge = -1j * 1e-3
    return got / (np.pi * plunge * (0.25 * omega**2 - 1j * omega * theodorsen))


@pytest.mark.parametrize(
    ("frequency", "panels", "step", "off"),
    [(0.2, 4, 0.25, 0.01), (0.5, 8, 0.125, 0.015), (0.2, 8, 0.5, 0.02), (0.05, 8, 2.0, 0.02)],
)
def test_a_plate_in_plunge_follows_theodorsen_with_short_and_long_steps(
    frequency: float, panels: int, step: float, off: float
) -> None:
    """Steps of 1, 1, 4 and 16 panels."""
    assert abs(plunge_response(frequency, panels, step) - 1.0) < off


def test_the_classical_shedding_needs_short_steps() -> None:
    """What the rings in the first panel are for."""
    classical = replace(PRESCRIBED, classical_shedding=True)
    assert abs(plunge_response(0.05, 8, 2.0, classical) - 1.0) > 0.2


def swinging(time: float) -> list[Surface]:
    """A finite wing that plunges."""
    base = elliptic_wing(6.0, 1.0, 3, 6, angle_of_attack=0.1)
    up = np.array([0.0, 0.0, 0.1])
    speed = np.broadcast_to(2.0 * np.cos(2.0 * time) * up, base.shape)
    return [Surface(Lattice(base + np.sin(2.0 * time) * up), speed)]


def swung(options: UnsteadyOptions, step: float, steps: int, ages: Array) -> UnsteadyLattice:
    lattice = UnsteadyLattice(Wind(), ages, options)
    for i in range(steps):
        lattice.begin_step(i * step, step, swinging(i * step))
        lattice.solve((i + 1) * step, swinging((i + 1) * step))
        lattice.end_step((i + 1) * step, swinging((i + 1) * step))
    return lattice


FREE = UnsteadyOptions(core=VortexCore(0.1), tree_error=None, wake_precision="double")
AGES = growing_ages(0.2, 8.0, near=1.0, growth=1.2, widest=0.6)


def test_quarter_steps_leave_the_wake_of_whole_steps() -> None:
    """To the order of the step: half the step, half the difference."""
    apart, spread = [], []
    for step in (0.2, 0.1, 0.05):
        ages = growing_ages(step, 4.0, near=1.0, growth=1.2, widest=0.6)
        steps = round(2.0 / step)
        whole = swung(FREE, step, steps, ages).wake()
        parts = swung(FREE, 0.25 * step, 4 * steps, ages).wake()
        apart.append(np.abs(whole.vertices[0][1:] - parts.vertices[0][1:]).max())
        difference = np.abs(whole.circulation[0] - parts.circulation[0]).max()
        spread.append(difference / np.abs(whole.circulation[0]).max())
    assert apart[0] < 0.02
    assert spread[0] < 0.05
    assert apart[1] < 0.65 * apart[0]
    assert apart[2] < 0.65 * apart[1]
    assert spread[1] < 0.65 * spread[0]
    assert spread[2] < 0.65 * spread[1]


def test_a_core_thicker_than_the_first_panels_does_not_blunt_the_trailing_edge() -> None:
    lifts = []
    for core in (None, VortexCore(0.1, 0.0)):
        options = UnsteadyOptions(free=False, tree_error=None, core=core)
        lattice = UnsteadyLattice(Wind(), uniform_ages(0.05, 3.0), options)
        lifts.append(lift_history(lattice, swinging, 0.05, 20)[5:])
    assert lifts[1] == pytest.approx(lifts[0], abs=0.01 * np.abs(lifts[0]).max())


@pytest.mark.parametrize("scheme", ["adams_bashforth", "heun", "euler"])
def test_a_resumed_lattice_takes_the_same_steps_to_the_bit(scheme: str) -> None:
    options = UnsteadyOptions(core=VortexCore(0.1), tree_error=None, scheme=scheme)
    step, time = 0.07, 7 * 0.07
    lattice = swung(options, step, 7, AGES)
    resumed = UnsteadyLattice(Wind(), AGES, options)
    resumed.restore({k: v.copy() for k, v in lattice.state().items()})
    for i in range(4):
        for one in (lattice, resumed):
            one.begin_step(time + i * step, step, swinging(time + i * step))
            one.solve(time + (i + 1) * step, swinging(time + (i + 1) * step))
            one.end_step(time + (i + 1) * step, swinging(time + (i + 1) * step))
    a, b = lattice.state(), resumed.state()
    assert a.keys() == b.keys()
    assert all(np.array_equal(a[k], b[k]) for k in a)


def test_a_trial_changes_no_state_and_repeats_itself() -> None:
    lattice = swung(FREE, 0.13, 5, AGES)
    before = {k: v.copy() for k, v in lattice.state().items()}
    answers = []
    for _ in range(2):
        lattice.begin_step(0.65, 0.13, swinging(0.65))
        lattice.solve(0.78, swinging(0.9))  # an iterate that is not accepted
        answers.append(lattice.solve(0.78, swinging(0.78)).loads[0].force)
    assert np.array_equal(*answers)
    after = lattice.state()
    assert all(np.array_equal(before[k], after[k]) for k in before)


class Swirl:
    """A steady flow that turns about the x axis while it blows along it."""

    def velocity(self, points: Array, time: float) -> Array:
        x, y, z = points.T
        return np.stack([1.0 + 0.1 * np.sin(y), -0.8 * z, 0.8 * y + 0.1 * np.cos(x)], axis=1)


@pytest.mark.parametrize(
    ("scheme", "rate"), [("euler", 2.0), ("adams_bashforth", 4.0), ("heun", 4.0)]
)
def test_schemes_converge_at_their_orders(scheme: str, rate: float) -> None:
    """Fluid that has left the trailing edge, against its path line."""
    still = [Surface.at_rest(elliptic_wing(2.0, 1.0, 1, 2))]
    edge = still[0].lattice.vertices[-1]
    path = solve_ivp(
        lambda t, x: Swirl().velocity(x.reshape(-1, 3), t).ravel(),
        (0.0, 1.6),
        edge.ravel(),
        rtol=1e-10,
        atol=1e-10,
    ).y[:, -1]
    errors = []
    for step in (0.1, 0.05, 0.025):
        options = UnsteadyOptions(free=False, tree_error=None, scheme=scheme)
        lattice = UnsteadyLattice(Wind(), uniform_ages(step, 2.0), options, wake_inflow=Swirl())
        steps = round(2.0 / step)
        lift_history(lattice, lambda t: still, step, steps)
        row = lattice.wake().vertices[0][round(1.6 / step)]
        errors.append(np.abs(row.ravel() - path).max())
    assert errors[0] / errors[1] == pytest.approx(rate, rel=0.2)
    assert errors[1] / errors[2] == pytest.approx(rate, rel=0.1)


def test_the_free_wake_of_an_elliptic_wing_rolls_up_without_jumps() -> None:
    options = UnsteadyOptions(core=VortexCore(0.15), start="impulsive")
    still = [Surface.at_rest(elliptic_wing(6.0, 1.0, 3, 16, angle_of_attack=0.15))]
    lattice = UnsteadyLattice(Wind(), uniform_ages(0.2, 12.0), options)
    lifts, before = [], None
    for i in range(60):
        lattice.begin_step(0.2 * i, 0.2, still)
        lifts.append(lattice.solve(0.2 * (i + 1), still).loads[0].force[2])
        lattice.end_step(0.2 * (i + 1), still)
        wake = lattice.wake().vertices[0]
        if before is not None:
            moved = wake[1:] - before[:-1]
            assert np.linalg.norm(moved - np.array([0.2, 0.0, 0.0]), axis=-1).max() < 0.2
        before = wake.copy()
    assert np.abs(np.diff(lifts[5:])).max() < 0.02 * lifts[-1]
    tip, middle = wake[40, -1], wake[40, 8]
    assert tip[2] > middle[2] + 0.1  # the sheet's edge curls up over its sinking middle
    assert abs(tip[1]) < 3.0
    assert np.abs(wake[:, :, 1] + wake[:, ::-1, 1]).max() < 0.02  # and stays symmetric


def test_a_wake_that_diverges_says_where_and_what_to_change() -> None:
    lattice = swung(FREE, 0.2, 3, AGES)
    state = lattice.state()
    state["wake_circulation_0"][4, 2] = np.nan
    lattice.restore(state)
    with pytest.raises(
        ConvergenceError, match=r"(?s)wake of surface 1, row .* thicker core"
    ) as error:
        lattice.begin_step(0.6, 0.2, swinging(0.6))
    assert error.value.time == 0.6


def test_a_wind_that_is_no_number_names_the_surface() -> None:
    gap = Wind(lambda x, t: np.where(x > 0.5, np.nan, 0.0) if t > 0.3 else 0.0 * x)
    options = UnsteadyOptions(free=False, tree_error=None)
    lattice = UnsteadyLattice(gap, AGES, options, names=["left blade"], wake_inflow=Wind())
    lattice.begin_step(0.2, 0.2, swinging(0.2))
    with pytest.raises(InputError, match="inflow at left blade, panel column"):
        lattice.solve(0.4, swinging(0.4))


def test_too_long_a_step_and_unknown_words_are_refused() -> None:
    with pytest.raises(InputError, match=r"at most 0\.2 s"):
        UnsteadyLattice(Wind(), AGES).begin_step(0.0, 0.3, swinging(0.0))
    with pytest.raises(InputError, match="adams_bashforth"):
        UnsteadyOptions(scheme="adams")
    with pytest.raises(InputError, match="begin_step"):
        UnsteadyLattice(Wind(), AGES).solve(0.0, swinging(0.0))


def test_a_steady_start_has_no_transient_and_the_quasi_steady_lift() -> None:
    still = [Surface.at_rest(elliptic_wing(6.0, 1.0, 3, 8, angle_of_attack=0.1))]
    lifts = {}
    for quasi in (False, True):
        options = UnsteadyOptions(free=False, tree_error=None, quasi_steady=quasi)
        lattice = UnsteadyLattice(Wind(), AGES, options)
        lifts[quasi] = lift_history(lattice, lambda t: still, 0.2, 8)
    assert lifts[False] == pytest.approx(np.full(8, lifts[True][0]), rel=1e-9)
    assert np.ptp(lifts[True]) < 1e-12


def test_the_quasi_steady_lift_has_no_memory() -> None:
    still = [Surface.at_rest(plate(4))]
    gust = Wind(lambda x, t: np.full_like(x, 0.01 if 0.45 < t < 0.75 else 0.0))
    options = UnsteadyOptions(free=False, tree_error=None, quasi_steady=True, air_density=1.0)
    lattice = UnsteadyLattice(gust, np.append(AGES, 1e4), options)
    lift = lift_history(lattice, lambda t: still, 0.1, 10)
    assert lift[[4, 5, 6]] == pytest.approx(np.full(3, np.pi * 0.01), rel=0.03)
    assert np.abs(lift[[0, 1, 2, 3, 7, 8, 9]]).max() < 1e-12


@pytest.mark.parametrize("drifted", [False, True])
def test_a_rotor_on_a_moving_axis_begins_with_the_wake_of_its_relative_wind(drifted: bool) -> None:
    """The same rotor, seen by an observer who moves."""
    ages, direction = growing_ages(0.03, 1.0, near=0.09, growth=1.3, widest=0.1), np.eye(3)[0]
    forces = []
    for boost in (np.zeros(3), np.array([1.0, 2.0, -0.5])):

        def rotor(time: float, boost: Array = boost) -> tuple[list[Surface], RotorAxis]:
            radius, along = np.linspace(2.0, 6.0, 6), np.linspace(-0.1, 0.3, 4)[:, None]
            twist = np.arctan(1.0 / radius) - 0.08
            base = np.stack(
                [along * np.sin(twist), along * np.cos(twist), radius + 0.0 * along], axis=2
            )
            blades = []
            for azimuth in (6.0 * time, 6.0 * time + np.pi):
                c, s = np.cos(azimuth), np.sin(azimuth)
                arm = base @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
                speed = np.cross(6.0 * direction, arm) + boost
                blades.append(Surface(Lattice(arm + time * boost), speed))
            return blades, RotorAxis(time * boost, direction, 6.0, boost)

        blades, axis = rotor(0.0)
        core = VortexCore(0.3)
        wind = np.array([6.0, 0.0, 0.0])
        wake = drifted_wake(blades, ages, axis, wind, core) if drifted else None
        lattice = UnsteadyLattice(
            Blowing(wind + boost), ages, UnsteadyOptions(free=False, core=core, tree_error=None)
        )
        for i in range(6):
            lattice.begin_step(0.03 * i, 0.03, *rotor(0.03 * i), wake)
            solution = lattice.solve(0.03 * (i + 1), rotor(0.03 * (i + 1))[0])
            lattice.end_step(0.03 * (i + 1), rotor(0.03 * (i + 1))[0])
        forces.append(np.array([load.force for load in solution.loads]))
    np.testing.assert_allclose(forces[0], forces[1], atol=1e-9 * np.abs(forces[0]).max())


class Blowing:
    """A uniform wind (3,) m/s."""

    def __init__(self, wind: Array) -> None:
        self.wind = wind

    def velocity(self, points: Array, time: float) -> Array:
        return np.broadcast_to(self.wind, points.shape)
