"""Hydrodynamic databases: interpolation, other points and axes, checks, NetCDF to the bit."""

from dataclasses import replace

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.database import HydroDatabase
from galerna.hydro.database_checks import checked, haskind_damping, haskind_ratio, long_waves
from galerna.hydro.files import read_database
from galerna.hydro.netcdf import read_netcdf, write_netcdf
from galerna.hydro.rigid import constant_force_stiffness, point_mass, shift, turn
from galerna.turbine.platform import Platform
from galerna.units import DEG

RHO, G = 1025.0, 9.80665
RADIUS, DRAFT = 4.0, 60.0
AREA = np.pi * RADIUS**2
VOLUME = AREA * DRAFT


def strip(frequency):
    """Integrals over the depth of exp(k z) and z exp(k z): a slender column in deep water."""
    k = frequency**2 / G
    fade = np.exp(-k * DRAFT)
    return (1.0 - fade) / k, (-1.0 + fade * (1.0 + k * DRAFT)) / k**2


def column(frequency=None, heading=None) -> HydroDatabase:
    """A slender vertical column in deep water: Morison's inertia and Haskind's damping."""
    w = np.linspace(0.05, 2.0, 60) if frequency is None else frequency
    beta = np.arange(-180, 181, 30) * DEG if heading is None else heading
    first, second = strip(w)
    surge = 2j * RHO * AREA * w**2 * first
    pitch = 2j * RHO * AREA * w**2 * second
    heave = RHO * G * AREA * np.exp(-(w**2) / G * DRAFT)
    plane = np.zeros((len(w), 6), complex)
    plane[:, 0], plane[:, 2], plane[:, 4] = surge, heave, pitch
    excitation = np.einsum("mij,nj->nmi", np.stack([turn(b) for b in beta]), plane)
    mass = RHO * AREA
    added = np.zeros((6, 6))
    added[0, 0] = added[1, 1] = mass * DRAFT
    added[0, 4] = added[4, 0] = -mass * DRAFT**2 / 2.0
    added[1, 3] = added[3, 1] = mass * DRAFT**2 / 2.0
    added[3, 3] = added[4, 4] = mass * DRAFT**3 / 3.0
    added[2, 2] = RHO * 4.0 / 3.0 * RADIUS**3
    stiffness = np.zeros((6, 6))
    stiffness[2, 2] = RHO * G * AREA
    stiffness[3, 3] = stiffness[4, 4] = RHO * G * (AREA * RADIUS**2 / 4 - VOLUME * DRAFT / 2)
    base = HydroDatabase(
        frequency=w,
        added_mass=np.broadcast_to(added, (len(w), 6, 6)).copy(),
        damping=np.zeros((len(w), 6, 6)),
        added_mass_infinite=added,
        heading=beta,
        excitation=excitation,
        hydrostatic_stiffness=stiffness,
        displaced_volume=VOLUME,
        center_of_buoyancy=np.array([0.0, 0.0, -DRAFT / 2]),
        reference_point=np.zeros(3),
        water_depth=np.inf,
        added_mass_zero=1.01 * added,
        mean_drift=np.abs(excitation) * 1e-3,
        settings={"program": "strip theory", "panels": 0.0},
    )
    implied = haskind_damping(base)
    return base if implied is None else replace(base, damping=implied)


def test_interpolation_meets_the_nodes_and_the_function_between():
    base = column()
    at = base.excitation_at(base.frequency, base.heading[4])
    np.testing.assert_allclose(at, base.excitation[:, 4], rtol=1e-6, atol=1.0)
    between = np.array([0.333, 0.777, 1.234])
    exact = column(between, np.array([0.4]))
    found = base.excitation_at(between, 0.4)
    worst = np.abs(found - exact.excitation[:, 0]) / np.abs(base.excitation).max(axis=(0, 1)).clip(
        1
    )
    assert worst.max() < 5e-4  # of which the spline over 30 deg of heading has 2e-4


def test_interpolation_over_frequency_is_of_fourth_order():
    between = np.linspace(0.4, 1.6, 37)
    exact = column(between, np.zeros(1)).excitation[:, 0, 4]

    def error(n):
        base = column(np.linspace(0.1, 2.0, n), np.zeros(1))
        return np.abs(base.excitation_at(between, 0.0)[:, 4] - exact).max()

    assert error(20) / error(40) > 10.0


def test_headings_go_round_and_turns_do_not_count():
    base = column()
    a = base.excitation_at(np.array([1.0]), 170 * DEG)
    b = base.excitation_at(np.array([1.0]), -190 * DEG)
    np.testing.assert_allclose(a, b, rtol=1e-9)
    np.testing.assert_allclose(
        base.excitation_at(np.array([1.0]), 190 * DEG)[0, 1], -a[0, 1], rtol=1e-6
    )


def test_every_wave_has_its_own_heading():
    base = column()
    w, beta = np.array([0.5, 1.0, 1.5]), np.array([0.2, -2.0, 3.0])
    together = base.excitation_at(w, beta)
    alone = np.concatenate([base.excitation_at(w[i : i + 1], beta[i]) for i in range(3)])
    np.testing.assert_allclose(together, alone, rtol=1e-12)


def test_below_the_first_frequency_the_sea_rises_evenly():
    base = column()
    still = base.excitation_at(np.array([0.0]), 1.0)[0]
    np.testing.assert_allclose(still, base.hydrostatic_stiffness[:, 2])
    added, damping = base.coefficients_at(np.array([0.0, base.frequency[0]]))
    np.testing.assert_allclose(added[0], base.added_mass_zero)
    np.testing.assert_allclose(added[1], base.added_mass[0])
    assert not damping[0].any()


def test_missing_frequencies_and_headings_are_errors_with_figures():
    base = column(heading=np.array([0.0, 0.5]))
    with pytest.raises(InputError, match=r"2\.5 rad/s.*0 to 2 rad/s"):
        base.excitation_at(np.array([1.0, 2.5]), 0.1)
    with pytest.raises(InputError, match=r"towards 90 deg.*from 0 to 28\.65 deg"):
        base.excitation_at(np.array([1.0]), 90 * DEG)


def test_failed_frequencies_are_not_interpolated_or_written(tmp_path):
    base = column()
    base.damping[7] = np.nan
    with pytest.raises(InputError, match=rf"interpolated.*\({base.frequency[7]:.4g} rad/s\)"):
        base.coefficients_at(np.array([1.0]))
    with pytest.raises(InputError, match="cannot be written"):
        write_netcdf(base, tmp_path / "x.nc")


def test_another_point_and_back():
    base, point = column(), np.array([3.0, -2.0, 11.0])
    there = base.moved(point)
    back = there.moved(np.zeros(3))
    for name in ("added_mass", "damping", "excitation", "hydrostatic_stiffness", "mean_drift"):
        a, b = getattr(base, name), getattr(back, name)
        np.testing.assert_allclose(a, b, atol=1e-12 * np.abs(a).max(), err_msg=name)


def test_stiffness_about_another_point_is_that_of_the_moved_hull():
    """Minus the rate of rho g V at the centre of buoyancy plus the waterplane's, by hand."""
    base, point = column(), np.array([3.0, -2.0, 11.0])
    moved = base.moved(point).hydrostatic_stiffness
    x, y, z = base.center_of_buoyancy - point
    b, rg = base.buoyancy, RHO * G
    second = AREA * RADIUS**2 / 4
    assert moved[3, 3] == pytest.approx(rg * (second + AREA * y * y) + b * z)
    assert moved[4, 4] == pytest.approx(rg * (second + AREA * x * x) + b * z)
    assert moved[2, 4] == pytest.approx(-rg * AREA * x)
    assert moved[3, 5] == pytest.approx(-b * x)
    assert moved[4, 5] == pytest.approx(-b * y)
    np.testing.assert_allclose(moved[5], 0.0, atol=1e-6 * b)


def test_excitation_elsewhere_refers_to_the_wave_there():
    """In the long run of a wave the same force acts; only the clock's zero differs."""
    base = column()
    moved = base.moved(np.array([10.0, 0.0, 0.0]))
    m = int(np.abs(base.heading).argmin())
    k = base.frequency**2 / G
    np.testing.assert_allclose(
        moved.excitation[:, m, 0], base.excitation[:, m, 0] * np.exp(10j * k), rtol=1e-12
    )


def test_work_does_not_depend_on_the_point():
    base, point = column(), np.array([3.0, -2.0, 11.0])
    motion = np.array([1.0, 2.0, -1.0, 0.02, 0.01, -0.03])
    here = shift(base.reference_point - point) @ motion
    a = motion @ base.moved(point).damping @ motion
    np.testing.assert_allclose(a, here @ base.damping @ here, rtol=1e-10)


def test_a_turned_body_feels_turned_waves():
    base = column()
    angle = 60 * DEG
    turned = base.rotated(angle)
    np.testing.assert_allclose(
        turned.excitation, base.excitation, atol=1e-3 * np.abs(base.excitation).max()
    )
    odd = replace(base, excitation=base.excitation * [1.0, 0.0, 1.0, 0.0, 1.0, 0.0])
    found = odd.rotated(angle).excitation_at(np.array([1.0]), angle)
    np.testing.assert_allclose(
        found[0], turn(angle) @ odd.excitation_at(np.array([1.0]), 0.0)[0], rtol=1e-6
    )


def test_an_unknown_height_does_not_spoil_the_rest_of_a_turned_body():
    base = replace(column(), center_of_buoyancy=np.array([3.0, 1.0, np.nan]))
    center = base.rotated(0.5 * np.pi).center_of_buoyancy
    np.testing.assert_allclose(center[:2], [-1.0, 3.0], atol=1e-12)
    assert np.isnan(center[2])


def test_constant_force_stiffness_is_minus_the_rate_of_its_moment():
    force, arm = np.array([1.0, -2.0, 5.0]), np.array([0.3, 0.7, -2.0])
    stiffness = constant_force_stiffness(force, arm)
    for i in range(3):
        axis = np.eye(3)[i]
        rate = np.cross(np.cross(axis, arm), force)
        np.testing.assert_allclose(-stiffness[3:, 3 + i], rate)


def test_point_mass_has_the_energy_of_its_motion():
    arm, motion = np.array([1.0, -2.0, 3.0]), np.array([0.3, -1.0, 2.0, 0.4, 0.5, -0.6])
    speed = motion[:3] + np.cross(motion[3:], arm)
    assert motion @ point_mass(7.0, arm) @ motion == pytest.approx(7.0 * speed @ speed)


def test_long_waves_tell_the_signs():
    base = column()
    good = long_waves(base)
    assert good is not None
    assert good.heave == pytest.approx(1.0, abs=0.02)
    assert good.surge == pytest.approx(1.0, abs=0.02)  # the force leads the crest by a quarter
    other = long_waves(replace(base, excitation=base.excitation.conj()))
    assert other is not None
    assert other.surge.real < -0.9


def test_haskind_ties_damping_to_excitation():
    base = column()
    assert haskind_ratio(base) == pytest.approx(1.0, abs=1e-6)
    assert haskind_ratio(replace(base, damping=3.0 * base.damping)) == pytest.approx(3.0, rel=1e-5)
    assert haskind_ratio(base.at_headings(np.array([0.0, 1.0]))) is None


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"frequency": np.linspace(2.0, 0.05, 60)}, "positive and rise"),
        ({"heading": np.arange(180, -181, -30) * DEG}, "headings must rise"),
        ({"water_density": 1.025}, r"1\.025 kg/m3"),
        ({"displaced_volume": 0.0}, "displaced volume is 0"),
        ({"excitation": np.zeros((60, 13, 3))}, r"excitation is \(60, 13, 3\)"),
    ],
)
def test_nonsense_is_refused(change, says):
    with pytest.raises(InputError, match=says):
        checked(replace(column(), **change), "here")


def test_asymmetry_and_negative_damping_are_refused():
    base = column()
    base.added_mass[5, 0, 4] *= 1.3
    with pytest.raises(InputError, match=r"added mass of (surge-pitch|pitch-surge)"):
        checked(base, "here")
    base = column()
    base.damping[30] *= -1.0
    with pytest.raises(InputError, match="gives energy to the motion"):
        checked(base, "here")


def test_symmetrised_keeps_what_is_symmetric():
    base = column()
    skew = np.zeros((6, 6))
    skew[0, 4], skew[4, 0] = 1e5, -1e5
    half = replace(base, added_mass=base.added_mass + skew).symmetrised()
    np.testing.assert_allclose(half.added_mass, base.added_mass)


def test_netcdf_keeps_every_bit(tmp_path):
    base = column()
    write_netcdf(base, tmp_path / "base.nc")
    again = read_netcdf(tmp_path / "base.nc")
    for name in HydroDatabase.__dataclass_fields__:
        a, b = getattr(base, name), getattr(again, name)
        if isinstance(a, np.ndarray):
            assert a.dtype == b.dtype
            assert a.tobytes() == b.tobytes(), name
        else:
            assert a == b, name


def test_netcdf_without_the_optional_parts(tmp_path):
    base = replace(column(), added_mass_zero=None, mean_drift=None)
    write_netcdf(base, tmp_path / "base.nc")
    again = read_netcdf(tmp_path / "base.nc")
    assert again.added_mass_zero is None
    assert again.mean_drift is None
    assert again.drift_at(np.array([1.0]), 0.0) is None


def test_files_that_are_none(tmp_path):
    with pytest.raises(InputError, match="is not there"):
        read_netcdf(tmp_path / "no.nc")
    (tmp_path / "text.nc").write_text("no")
    with pytest.raises(InputError, match="not a NetCDF file"):
        read_netcdf(tmp_path / "text.nc")
    platform = Platform((0.0, 0.0, 0.0), 1e6, (0.0, 0.0, -40.0), (1e9, 1e9, 1e8))
    with pytest.raises(InputError, match=r"ends with '\.csv'"):
        read_database(tmp_path / "base.csv", platform)
    with pytest.raises(InputError, match="displaced volume and water depth"):
        read_database(tmp_path / "base.1", platform)
