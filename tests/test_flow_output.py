"""The flow beside a result: files for ParaView, when they are due, and what stands there."""

from xml.etree import ElementTree

import numpy as np
import pytest

import galerna
from galerna.aero.vortex.planes import Plane
from galerna.errors import InputError
from galerna.flow_output import wake_patches
from galerna.machine import build_machine

PLANE = {"name": "side", "corner_m": [-50, 0, 10], "first_side_m": [100, 0, 0]}
CASE = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 1.2,
    "time_step_s": 0.15,
    "inflow": {"wind_speed_m_s": 8.0},
    "aerodynamics": {
        "model": "vortex_lattice",
        "spanwise_panels": 4,
        "chordwise_panels": 2,
        "wake_length_diameters": 1.0,
        "wake_step_deg": 10,
        "wake": "prescribed",
        "flow_output": {
            "interval_s": 0.3,
            "start_s": 0.6,
            "planes": [{**PLANE, "second_side_m": [0, 0, 150], "points": [5, 4]}],
        },
    },
    "operation": {"rotor_speed_rpm": 9.16, "pitch_deg": 0.0},
    "outputs": {"interval_s": 0.15},
}


def times(index):
    return [float(e.get("timestep")) for e in ElementTree.parse(index).iter("DataSet")]


def test_wake_and_planes_are_written_when_they_are_due(tmp_path):
    result = galerna.run(CASE, tmp_path / "a.nc")
    folder = tmp_path / "a_flow"
    for name in ("wake", "side"):
        assert times(folder / f"{name}.pvd") == pytest.approx([0.6, 0.9, 1.2])
        assert len(list(folder.glob(f"{name}_*.vtp"))) == 3
    piece = next(ElementTree.parse(folder / "wake_000000.vtp").iter("Piece"))
    bound, wake = 3 * 2 * 4, int(result["wake_panels"][0])
    assert int(piece.get("NumberOfPolys")) == bound + wake


def test_the_flow_of_a_run_that_goes_on_is_left_alone(tmp_path):
    """Two runs into one result: the second is refused before it removes anything."""
    galerna.run(CASE, tmp_path / "a.nc")
    before = sorted(path.name for path in (tmp_path / "a_flow").iterdir())
    fcntl = pytest.importorskip("fcntl")
    with (tmp_path / "a.nc.log").open("ab") as log:
        fcntl.flock(log, fcntl.LOCK_EX)
        with pytest.raises(InputError, match="another run is writing this result"):
            galerna.run(CASE, tmp_path / "a.nc", overwrite=True)
    assert sorted(path.name for path in (tmp_path / "a_flow").iterdir()) == before


def test_an_earlier_flow_is_not_replaced_unless_told(tmp_path):
    galerna.run(CASE, tmp_path / "a.nc")
    (tmp_path / "a.nc").unlink()
    with pytest.raises(InputError, match="pictures of a flow stand here already"):
        galerna.run(CASE, tmp_path / "a.nc")
    assert not (tmp_path / "a.nc").exists()
    galerna.run(CASE, tmp_path / "a.nc", duration=0.9, overwrite=True)
    assert times(tmp_path / "a_flow" / "wake.pvd") == pytest.approx([0.6, 0.9])
    assert len(list((tmp_path / "a_flow").glob("wake_*.vtp"))) == 2


def test_a_result_in_memory_has_no_place_for_it():
    with pytest.raises(InputError, match=r"aerodynamics\.flow_output: there is no folder"):
        galerna.run(CASE)


def test_the_patches_tell_blades_from_wakes():
    machine = build_machine(galerna.load_case(CASE))
    machine.simulation.advance()
    patches = wake_patches(machine.vortex_lattice)
    assert [int(p.on_panels["blade"][0, 0]) for p in patches] == [1, 2, 3, 1, 2, 3]
    assert [bool(p.on_panels["wake"][0, 0]) for p in patches] == [True] * 3 + [False] * 3
    edge, bound = patches[0].points[0], patches[3].points[-1]
    np.testing.assert_allclose(edge, bound)  # the wake begins where the blade's rings end


class TestPlane:
    """Points, velocities and refusals of a plane."""

    def test_points_run_from_the_corner_along_both_sides(self):
        plane = Plane(
            np.array([1.0, 2.0, 3.0]), np.array([4.0, 0, 0]), np.array([0, 0, 6.0]), (3, 4)
        )
        points = plane.points
        assert points.shape == (3, 4, 3)
        np.testing.assert_allclose(points[2, 0], [5.0, 2.0, 3.0])
        np.testing.assert_allclose(points[1, 3], [3.0, 2.0, 9.0])

    def test_a_square_across_the_wind_is_about_its_centre(self):
        points = Plane.across([10.0, 0.0, 90.0], 40.0, 5).points
        np.testing.assert_allclose(points.mean(axis=(0, 1)), [10.0, 0.0, 90.0])
        assert np.ptp(points[..., 0]) == 0.0

    def test_a_dataset_has_units_and_distances(self):
        plane = Plane(np.zeros(3), np.array([0, 3.0, 4.0]), np.array([2.0, 0, 0]), (6, 3))
        made = plane.dataset(lambda points: 2.0 * points)
        assert made.velocity.attrs["units"] == "m/s"
        np.testing.assert_allclose(made["first"], np.linspace(0.0, 5.0, 6))
        np.testing.assert_allclose(made.velocity, 2.0 * made.position)

    @pytest.mark.parametrize(
        ("sides", "message"),
        [
            (([1.0, 0, 0], [2.0, 0, 0]), "its sides span no area"),
            (([0.0, 0, 0], [2.0, 0, 0]), "its sides span no area"),
            (([1.0, 0, np.nan], [2.0, 0, 0]), "first_side: is not three finite numbers"),
        ],
    )
    def test_what_is_no_plane_is_refused(self, sides, message):
        with pytest.raises(InputError, match=message):
            Plane(np.zeros(3), *map(np.array, sides))
