"""Coefficients from capytaine against closed forms; conventions; failures that are said."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import h2vp, jvp

from galerna.errors import InputError
from galerna.hydro.database import HydroDatabase
from galerna.hydro.database_checks import checked, haskind_ratio, long_waves
from galerna.hydro.far_field import Moving, motions
from galerna.hydro.panels import Panels, hull_panels, revolution_panels

pytest.importorskip("capytaine")
from galerna.hydro import capytaine_runs
from galerna.hydro.capytaine_runs import compute
from galerna.hydro.far_field import FarField, energy_error, mean_drift

RHO, G = 1025.0, 9.80665


def cylinder_drift(k, depth, radius=1.0):
    """Mean force N/m2 on a cylinder from the sea's bed up: MacCamy and Fuchs' (1954) waves.

    With the scattered far field sqrt(2 / pi k r) f(theta) per amplitude, the force is
    rho g (c_g / c) Integral |f|^2 (1 - cos theta) d theta / (pi k).
    """
    order = np.arange(40)
    part = np.where(order == 0, 1, 2) * jvp(order, k * radius) / h2vp(order, k * radius)
    angle = np.linspace(0.0, 2 * np.pi, 400, endpoint=False)
    sent = (part[:, None] * np.cos(order[:, None] * angle)).sum(axis=0)
    ratio = 0.5 * (1.0 + 2.0 * k * depth / np.sinh(2.0 * k * depth))
    integral = np.mean(np.abs(sent) ** 2 * (1.0 - np.cos(angle))) * 2 * np.pi
    return RHO * G * ratio * integral / (np.pi * k)


NUMBERS, DEPTH = np.array([0.3, 0.8, 2.0]), 2.0


@pytest.fixture(scope="module")
def standing():
    """A cylinder of radius 1 m from the bed through the surface, and its far field."""
    profile = np.array([[1.0, 0.0], [1.0, -DEPTH]])
    panels = revolution_panels(profile, 0.06, 48)
    run = capytaine_runs._run(panels, np.zeros(1), np.zeros(3), (DEPTH, RHO, G))
    w = np.sqrt(G * NUMBERS * np.tanh(NUMBERS * DEPTH))
    rows, failures = capytaine_runs._solve_all(run, w, None)
    assert not failures
    base = replace(
        _floating(w), excitation=np.stack([r.excitation for r in rows]), frequency=w,
        heading=np.zeros(1), water_depth=DEPTH,
    )  # fmt: skip
    far = FarField(np.stack([r.diffraction for r in rows]), np.stack([r.radiation for r in rows]))
    return base, far


def _floating(w):
    zero = np.zeros((len(w), 6, 6))
    return HydroDatabase(
        w, zero, zero, zero[0], np.zeros(1), np.zeros((len(w), 1, 6), complex), zero[0], 1.0,
        np.zeros(3), np.zeros(3), DEPTH,
    )  # fmt: skip


def test_excitation_of_maccamy_and_fuchs(standing):
    """Size and phase for the time factor exp(+i w t) and waves towards x; for long waves it is
    2 i rho g tanh(kh) pi a^2, a quarter of a period ahead of the crest."""
    base, _ = standing
    exact = 4.0 * RHO * G * np.tanh(NUMBERS * DEPTH) / (NUMBERS**2 * h2vp(1, NUMBERS))
    np.testing.assert_allclose(base.excitation[:, 0, 0] / exact, 1.0, atol=4e-3)
    assert np.angle(base.excitation[0, 0, 0]) == pytest.approx(np.pi / 2, abs=0.1)


def test_mean_drift_of_maccamy_and_fuchs(standing):
    base, far = standing
    found = mean_drift(base, far, None)[:, 0]
    wanted = [cylinder_drift(k, DEPTH) for k in NUMBERS]
    np.testing.assert_allclose(found[:, 0], wanted, rtol=0.02)
    np.testing.assert_allclose(found[:, [1, 5]], 0.0, atol=1e-3 * found[0, 0])


def test_energy_sent_is_energy_taken(standing):
    base, far = standing
    assert np.abs(energy_error(base, far, None)).max() < 0.015


FREQUENCY = np.array([0.4, 1.5, 2.5, 3.6, 4.6])


def sphere(sectors=24):
    """Half a sphere of radius 1 m, fine enough for the waves of FREQUENCY."""
    angle = np.linspace(0.0, np.pi / 2, 9)
    corners = np.stack([np.cos(angle), -np.sin(angle)], axis=1)
    corners[-1, 0] = 0.0
    return revolution_panels(corners, 0.3, sectors)


@pytest.fixture(scope="module")
def hemisphere():
    return compute(sphere(), FREQUENCY)


def test_a_hemisphere_of_hulme(hemisphere):
    """Hulme, J. Fluid Mech. 121 (1982): added mass over displaced mass, 0.8310 in heave and 0.5
    in surge in the long-wave limit, 0.5 in heave and 0.2732 in surge in the short-wave limit."""
    mass = RHO * hemisphere.displaced_volume
    assert hemisphere.added_mass_zero is not None
    zero, infinite = hemisphere.added_mass_zero / mass, hemisphere.added_mass_infinite / mass
    assert zero[2, 2] == pytest.approx(0.8310, rel=0.02)
    assert zero[0, 0] == pytest.approx(0.5, rel=0.02)
    assert infinite[2, 2] == pytest.approx(0.5, rel=0.02)
    assert infinite[0, 0] == pytest.approx(0.2732, rel=0.02)


def test_damping_is_that_of_the_sent_waves(hemisphere):
    assert haskind_ratio(hemisphere) == pytest.approx(1.0, abs=0.01)
    checked(hemisphere, "hemisphere")


def test_long_waves_push_in_phase(hemisphere):
    long = long_waves(hemisphere)
    assert long is not None
    assert long.heave == pytest.approx(1.0, abs=0.05)
    assert long.surge == pytest.approx(1.0, abs=0.05)


def test_sway_is_surge_turned(hemisphere):
    a = hemisphere.added_mass
    np.testing.assert_allclose(a[:, 1, 1], a[:, 0, 0])
    np.testing.assert_allclose(a[:, 1, 3], -a[:, 0, 4])
    aside = hemisphere.excitation_at(FREQUENCY, np.pi / 2)
    ahead = hemisphere.excitation_at(FREQUENCY, 0.0)
    np.testing.assert_allclose(aside[:, 1], ahead[:, 0], rtol=1e-6)
    np.testing.assert_allclose(aside[:, 3], -ahead[:, 4], rtol=1e-6)


def plain(panels: Panels) -> Panels:
    """The same panels without the knowledge of their symmetry."""
    whole = hull_panels(*panels.whole())
    lid = Panels(panels.lid_vertices, panels.lid_faces, np.zeros((0, 3)), np.zeros((0, 4)),
                 panels.sectors)  # fmt: skip
    vertices, faces = lid.whole()
    return Panels(whole.vertices, whole.faces, vertices, faces)


def test_a_hull_without_known_symmetry_finds_the_same():
    panels, w, headings = sphere(12), np.array([2.0]), np.array([0.0, 0.7])
    inertia = np.diag([2000.0, 2000.0, 2000.0, 500.0, 500.0, 500.0])
    moving = Moving(inertia, np.diag([0.0, 0.0, 0.0, 5e3, 5e3, 0.0]))
    known = compute(panels, w, headings, moving=moving)
    found = compute(plain(panels), w, headings, moving=moving)
    scale = np.abs(known.added_mass[0, 0, 0])
    np.testing.assert_allclose(found.added_mass, known.added_mass, atol=5e-3 * scale)
    np.testing.assert_allclose(found.damping, known.damping, atol=5e-3 * scale)
    force = np.abs(known.excitation).max()
    np.testing.assert_allclose(found.excitation, known.excitation, atol=5e-3 * force)
    assert known.mean_drift is not None
    drift = np.abs(known.mean_drift).max()
    np.testing.assert_allclose(found.mean_drift, known.mean_drift, atol=0.02 * drift)


def test_a_hull_that_stands_aside_refers_to_its_own_point():
    panels, w, aside = sphere(12), np.array([2.0]), np.array([30.0, -12.0, 0.0])
    here = compute(panels, w, np.zeros(1))
    moved = plain(panels)
    there = compute(
        replace(moved, vertices=moved.vertices + aside, lid_vertices=moved.lid_vertices + aside),
        w, np.zeros(1), reference_point=aside,
    )  # fmt: skip
    force = np.abs(here.excitation).max()
    np.testing.assert_allclose(there.excitation, here.excitation, atol=5e-3 * force)
    np.testing.assert_allclose(there.center_of_buoyancy, here.center_of_buoyancy + aside, atol=1e-6)
    np.testing.assert_allclose(
        there.hydrostatic_stiffness[:3, :3], here.hydrostatic_stiffness[:3, :3], atol=1e-6
    )


def test_long_waves_carry_the_hull_with_the_water(hemisphere):
    """Heave is the elevation, surge leads it by a quarter: the circles of deep water."""
    inertia = RHO * hemisphere.displaced_volume * np.diag([1.0, 1.0, 1.0, 0.3, 0.3, 0.3])
    lift = np.zeros((6, 6))
    lift[3, 3] = lift[4, 4] = 3e4
    ahead = hemisphere.at_headings(np.zeros(1))
    found = motions(ahead, Moving(inertia, lift))[0, 0]
    assert found[2] == pytest.approx(1.0, abs=0.03)
    assert found[0] == pytest.approx(-1j, abs=0.03)


def test_failed_frequencies_are_counted_and_named(monkeypatch):
    solve = capytaine_runs._solve

    def failing(run, problem):
        if problem.omega == 1.5:
            raise RuntimeError("no convergence")
        return solve(run, problem)

    monkeypatch.setattr(capytaine_runs, "_solve", failing)
    told = []
    with pytest.warns(UserWarning, match=r"1 of 2 frequencies.*1\.5 rad/s \(no convergence\)"):
        base = compute(sphere(8), [0.8, 1.5], progress=lambda done, of: told.append((done, of)))
    assert told == [(1, 2), (2, 2)]
    np.testing.assert_array_equal(base.failed, [1.5])
    assert np.isfinite(base.added_mass[0]).all()
    assert np.isnan(base.added_mass[1, 0, 0])
    assert base.mean_drift is None
    with pytest.raises(InputError, match="no frequency was solved"), warnings.catch_warnings():
        compute(sphere(8), [1.5])


@pytest.mark.parametrize(
    ("frequency", "says"), [([], "positive and rise"), ([1.0, 0.5], "rise"), ([0.01], "k h = 0.14")]
)
def test_frequencies_that_cannot_be(frequency, says):
    with pytest.raises(InputError, match=says):
        compute(sphere(8), frequency, water_depth=50.0)
