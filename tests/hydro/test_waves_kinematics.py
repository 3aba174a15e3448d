"""Water under waves: potential theory's identities, energy, stretching, tables."""

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.hydro.waves import Sea
from galerna.hydro.waves.dispersion import group_velocity
from galerna.hydro.waves.irregular import Band, irregular
from galerna.hydro.waves.kinematics import (
    acceleration_transfer,
    pressure_transfer,
    profiles,
    surface,
    velocity_transfer,
    water_columns,
    water_velocity,
)
from galerna.hydro.waves.spectra import jonswap

POINTS = np.array([[0.0, 0.0, -2.0], [13.0, -4.0, -9.0], [-30.0, 8.0, -27.0]])


def short_crested(depth=30.0, height=2.0):
    band = Band(0.3, 3.77, 650.0)
    w, course, a = irregular(
        lambda w: jonswap(w, height, 10.0, 2.9), band, seed=7, spreading_exponent=6.0
    )
    return Sea(w, course, a, band.period, depth)


def velocity(sea, points, time):
    """Velocity (m,3) by the sum over the waves."""
    phase = sea.amplitude * np.exp(1j * sea.frequency * time)
    return np.einsum("n,nmc->mc", phase, velocity_transfer(sea, points)).real


def slopes(sea, points, time, step=5e-3):
    """The velocity's derivatives (m,3,3), of component i over coordinate j, to fourth order."""
    coarse = central(sea, points, time, 2.0 * step)
    return (4.0 * central(sea, points, time, step) - coarse) / 3.0


def central(sea, points, time, step):
    ahead, back = (
        [velocity(sea, points + sign * step * unit, time) for unit in np.eye(3)]
        for sign in (1.0, -1.0)
    )
    return (np.stack(ahead, axis=2) - np.stack(back, axis=2)) / (2.0 * step)


@pytest.mark.parametrize("depth", [30.0, 400.0, np.inf])
def test_flow_is_free_of_sources_and_of_rotation(depth):
    slope = slopes(short_crested(depth), POINTS, 17.0)
    size = np.abs(slope).max()
    assert np.abs(np.trace(slope, axis1=1, axis2=2)).max() < 1e-7 * size
    assert np.abs(slope - slope.transpose(0, 2, 1)).max() < 1e-7 * size


def test_surface_and_seabed_hold_the_water():
    """w = d(eta)/dt and p = rho g eta at z = 0 to first order; no flow through the seabed."""
    sea = short_crested()
    at_surface = np.array([[3.0, 5.0, 0.0]])
    up = velocity_transfer(sea, at_surface)[:, 0, 2]
    phase = sea.spread(at_surface[:, :2])[:, 0]
    assert up == pytest.approx(1j * sea.frequency * phase, rel=1e-12)
    pressure = pressure_transfer(sea, at_surface)[:, 0]
    assert pressure == pytest.approx(sea.density * sea.gravity * phase, rel=1e-12)
    assert np.abs(velocity_transfer(sea, [[0.0, 0.0, -30.0]])[:, 0, 2]).max() < 1e-15


def test_pressure_accelerates_the_water():
    """rho du/dt = -grad p of the first order, by finite differences."""
    sea, step = short_crested(), 1e-3
    for j, unit in enumerate(np.eye(3)):
        ahead, back = (pressure_transfer(sea, POINTS + s * step * unit) for s in (1.0, -1.0))
        found = sea.density * acceleration_transfer(sea, POINTS)[:, :, j]
        gradient = (ahead - back) / (2.0 * step)
        assert np.abs(found + gradient).max() < 1e-6 * np.abs(found).max()


@pytest.mark.parametrize("depth", [8.0, 60.0])
def test_energy_travels_with_the_group(depth):
    """Mean of p u over the depth is rho g a^2 / 2 times the group velocity."""
    sea = Sea.regular(1.0, 8.0, depth, direction=0.0)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    z = 0.5 * depth * (nodes - 1.0)
    points = np.column_stack([0.0 * z, 0.0 * z, z])
    p, u = pressure_transfer(sea, points)[0], velocity_transfer(sea, points)[0, :, 0]
    flux = 0.5 * depth * weights @ (0.5 * 0.25 * (p * u.conj()).real)
    energy = 0.5 * sea.density * sea.gravity * 0.25
    speed = group_velocity(sea.frequency, depth, sea.gravity)[0]
    assert flux == pytest.approx(energy * speed, rel=1e-12)


def test_deep_water_and_short_waves_do_not_overflow():
    sea = Sea.regular(0.1, 0.8, 4000.0)
    along, upward = profiles(sea, [0.0, -1.0, -3999.0])
    k = float(sea.wavenumber[0])
    assert along[0] == pytest.approx([1.0, np.exp(-k), 0.0], rel=1e-12)
    assert upward[0] == pytest.approx([1.0, np.exp(-k), 0.0], rel=1e-12)


def from_columns(columns, height, time, column=0):
    row = columns.series.at(time)
    return np.array(
        water_velocity(row, columns.layout, column, height, columns.stretching, columns.depth)
    )


def columns_of(sea, stretching, bottom=-30.0):
    places = np.array([[0.0, 0.0], [13.0, -4.0]])
    return water_columns(sea, places, np.zeros(2), np.full(2, bottom), stretching)


def test_columns_follow_the_sum_of_the_waves():
    """Below the surface, at random times and depths; relative to the deviation at the surface."""
    sea = short_crested(height=4.0)
    columns = columns_of(sea, "vertical")
    rng = np.random.default_rng(3)
    errors, found = [], []
    for z, t in zip(rng.uniform(-30.0, 0.0, 400), rng.uniform(0.0, 650.0, 400), strict=True):
        direct = velocity(sea, np.array([[13.0, -4.0, z]]), t)[0]
        errors.append(from_columns(columns, z, t, 1) - direct)
        found.append(velocity(sea, np.array([[13.0, -4.0, 0.0]]), t)[0])
    assert np.std(errors, axis=0).max() < 1e-3 * np.std(found, axis=0).min()


@pytest.mark.parametrize("depth", [30.0, np.inf])
def test_stretched_profiles_above_and_below_the_still_water(depth):
    sea = short_crested(depth, height=4.0)
    columns = {name: columns_of(sea, name) for name in ("vertical", "extrapolation", "wheeler")}
    scale = np.sqrt(np.sum(np.abs(sea.amplitude * sea.frequency) ** 2))
    step = 1e-4
    for t in (12.0, 77.0, 200.0):
        eta = sea.elevation_at().at(t)[0]
        at_still, below = velocity(sea, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -step]]), t)
        slope = (at_still - below) / step
        expected = {
            ("vertical", 1.3): at_still,
            ("extrapolation", 1.3): at_still + 1.3 * slope,
            ("wheeler", eta): at_still,
        }
        for (name, z), value in expected.items():
            assert from_columns(columns[name], z, t) == pytest.approx(value, abs=3e-3 * scale)
        moved = (-5.0 - eta) / (1.0 + eta / depth)
        value = velocity(sea, np.array([[0.0, 0.0, moved]]), t)[0]
        assert from_columns(columns["wheeler"], -5.0, t) == pytest.approx(value, abs=3e-3 * scale)


def test_ten_thousand_frequencies_need_few_levels_and_little_memory():
    band = Band(0.3, 2.0 * np.pi * 1e4 / 3600.0, 3600.0)
    w, course, a = irregular(lambda w: jonswap(w, 6.0, 10.0, 2.9), band, seed=7)
    sea = Sea(w, course, a, band.period, 320.0)
    columns = water_columns(sea, np.zeros((1, 2)), np.zeros(1), np.array([-130.0]))
    assert columns.layout[0, 1] <= 32
    assert columns.series.table.nbytes < 30e6


def test_water_without_waves_at_its_depth_stands_still():
    sea = Sea.regular(0.1, 0.8, 4000.0)
    columns = water_columns(sea, np.zeros((1, 2)), np.array([-900.0]), np.array([-950.0]))
    assert not from_columns(columns, -920.0, 0.3).any()


def test_water_ends_at_the_elevation_or_without_stretching_at_the_still_water():
    sea = short_crested()
    for name, expected in (("none", 0.0), ("wheeler", sea.elevation_at().at(50.0)[0])):
        columns = columns_of(sea, name)
        row = columns.series.at(50.0)
        level = surface(row, columns.layout, 0, columns.stretching)
        assert level == pytest.approx(expected, abs=1e-3)


def test_unknown_stretching_is_refused():
    with pytest.raises(InputError, match="did you mean 'wheeler'"):
        columns_of(short_crested(), "wheelr")
