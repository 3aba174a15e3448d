"""Drag of tower and nacelle against hand calculation, turned and moving frames."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from galerna import turbine as turbines
from galerna.aero.body_drag import BodyDrag
from galerna.contract import LoadModel, Motion
from galerna.turbine.geometry import axis_positions

DENSITY = 1.2


class Uniform:
    def __init__(self, wind):
        self.wind = np.asarray(wind, dtype=float)

    def velocity(self, points, time):
        return np.tile(self.wind, (len(points), 1))


@pytest.fixture(scope="module")
def turbine():
    land = turbines.load("nrel5mw")
    return replace(land, nacelle=replace(land.nacelle, drag_area=(20.0, 60.0, 40.0)))


def standing(turbine, model):
    tower = turbine.tower
    span = model.stations[0].span
    motion = Motion.at_rest(len(span) + 1)
    motion.position[:-1] = axis_positions(tower.axis_span, tower.axis, span)
    motion.position[-1] = tower.axis[-1]
    return motion


def test_total_drag_of_a_tower_in_uniform_wind(turbine):
    model = BodyDrag(turbine, Uniform([9.0, 0.0, 0.0]), air_density=DENSITY)
    assert isinstance(model, LoadModel)
    loads = model.loads(0.0, standing(turbine, model))
    tower = turbine.tower
    height = tower.axis[:, 2]
    line = 0.5 * DENSITY * tower.drag_coefficient * tower.diameter * 81.0
    assert loads.force[:-1, 0].sum() == pytest.approx(np.trapezoid(line, height), rel=1e-12)
    assert not loads.force[:-1, 1:].any()
    # Overturning moment about the ground: forces at their offsets, exact for a linear line load.
    model_moment = loads.force[:-1, 0] @ height + loads.moment[:-1, 1].sum()
    mid = 0.5 * (height[1:] + height[:-1])
    middle = 0.5 * (line[1:] + line[:-1])
    exact = np.sum(
        (line[:-1] * height[:-1] + 4 * middle * mid + line[1:] * height[1:]) * np.diff(height) / 6
    )
    assert model_moment == pytest.approx(exact, rel=1e-12)


def test_nacelle_drag_acts_at_the_shaft(turbine):
    model = BodyDrag(turbine, Uniform([9.0, 0.0, 0.0]), air_density=DENSITY)
    loads = model.loads(0.0, standing(turbine, model))
    drag = 0.5 * DENSITY * 20.0 * 81.0
    np.testing.assert_allclose(loads.force[-1], [drag, 0.0, 0.0])
    np.testing.assert_allclose(loads.moment[-1], [0.0, turbine.nacelle.shaft_height * drag, 0.0])


def test_moving_with_the_wind_feels_nothing_and_turning_turns(turbine):
    wind = np.array([9.0, 2.0, 0.0])
    model = BodyDrag(turbine, Uniform(wind), air_density=DENSITY)
    motion = standing(turbine, model)
    motion.velocity[:] = wind
    assert not model.loads(0.0, motion).force.any()
    turn = Rotation.from_rotvec([0.2, -0.1, 0.4]).as_matrix()
    still = standing(turbine, model)
    before = model.loads(0.0, still)
    turned = standing(turbine, model)
    turned.position[:] = turned.position @ turn.T
    turned.rotation[:] = turn
    after = BodyDrag(turbine, Uniform(turn @ wind), air_density=DENSITY).loads(0.0, turned)
    np.testing.assert_allclose(after.force, before.force @ turn.T, atol=1e-9)
    np.testing.assert_allclose(after.moment, before.moment @ turn.T, atol=1e-9)


def test_fore_aft_motion_is_damped(turbine):
    model = BodyDrag(turbine, Uniform([9.0, 0.0, 0.0]), air_density=DENSITY)
    still, moving = standing(turbine, model), standing(turbine, model)
    moving.velocity[:, 0] = 0.01
    change = model.loads(0.0, moving).force[:, 0] - model.loads(0.0, still).force[:, 0]
    still_force = model.loads(0.0, still).force[:, 0]
    np.testing.assert_allclose(change, -2 * 0.01 / 9.0 * still_force, rtol=1e-3)


def test_record_shows_the_accepted_step_and_loads_are_pure(turbine):
    model = BodyDrag(turbine, Uniform([9.0, 0.0, 0.0]), air_density=DENSITY)
    motion = standing(turbine, model)
    model.begin_step(0.0, 0.1, motion)
    first, second = model.loads(0.1, motion), model.loads(0.1, motion)
    assert np.array_equal(first.force, second.force)
    assert model.record()["tower_drag_force"] == 0.0
    model.end_step(0.1, motion)
    record = model.record()
    assert set(record) == {channel.name for channel in model.channels}
    assert record["tower_drag_force"] == pytest.approx(first.force[:-1, 0].sum())
    model.restore(model.state())
