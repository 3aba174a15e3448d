"""Floating platforms and moorings from windIO files and their companions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_windio
from small_windio import curve

from galerna.errors import InputError
from galerna.turbine import Turbine, load, windio
from galerna.turbine.windio.emit import to_yaml

STEEL = {"name": "steel", "orth": 0, "rho": 8000.0, "E": 2e11, "nu": 0.3}
SLURRY = {"name": "slurry", "orth": 0, "rho": 2000.0, "E": 1.0, "nu": 0.3}


def round_member(name: str, joint1: str, joint2: str, diameter: float, **more: Any) -> dict:
    return {
        "name": name,
        "joint1": joint1,
        "joint2": joint2,
        "outer_shape": {"shape": "circular", "outer_diameter": curve(diameter, diameter)},
        "Cd": 0.7,
        "structure": {"layers": []},
    } | more


def wall(thickness: float) -> dict[str, Any]:
    return {"name": "wall", "material": "steel", "thickness": curve(thickness, thickness)}


def floating() -> dict[str, Any]:
    """A spar of 40 m draft with one brace, one line and one buoy on it."""
    return {
        "joints": [
            {"name": "keel", "location": [0.0, 0.0, -40.0], "axial_coeffs": {"Cd": 0.9}},
            {"name": "top", "location": [0.0, 0.0, 0.0], "transition": True},
            {"name": "arm", "location": [10.0, 90.0, -20.0], "cylindrical": True},
            {"name": "seabed", "location": [100.0, 90.0, -80.0], "cylindrical": True},
        ],
        "members": [
            round_member("spar", "keel", "top", 4.0, axial_joints=[{"name": "mid", "grid": 0.5}]),
            round_member("brace", "mid", "arm", 1.0),
        ],
    }


def mooring() -> dict[str, Any]:
    return {
        "nodes": [
            {"name": "a", "node_type": "fixed", "joint": "seabed", "anchor_type": "any"},
            {"name": "b", "node_type": "free", "location": [0.0, 50.0, -50.0], "node_mass": 9.0},
            {"name": "c", "node_type": "vessel", "joint": "arm", "fairlead_type": "rigid"},
        ],
        "lines": [
            {
                "name": name,
                "line_type": "main",
                "unstretched_length": 60.0,
                "node1": first,
                "node2": second,
            }
            for name, first, second in (("lower", "a", "b"), ("upper", "b", "c"))
        ],
        "line_types": [{"name": "main", "diameter": 0.18, "type": "chain"}],
        "anchor_types": [{"name": "any", "type": "suction"}],
    }


BODY = "reference_point: [0, 0, 0], mass: 4.0e+5, center_of_mass: [0, 0, -25], inertia: [1, 2, 3]"


def document() -> dict[str, Any]:
    data = small_windio.document()
    data["components"] |= {"floating_platform": floating(), "mooring": mooring()}
    data["materials"] = [STEEL, SLURRY]
    return data


def read(tmp_path: Path, data: dict[str, Any], companion: str = "") -> Turbine:
    path = small_windio.write(tmp_path, data)
    if companion:
        (tmp_path / "small.companion.yaml").write_text(companion)
    return windio.read(path)


def members(data: dict[str, Any]) -> list[dict[str, Any]]:
    return data["components"]["floating_platform"]["members"]


# geometry ----------------------------------------------------------------------------


def test_members_stand_between_their_joints(tmp_path: Path) -> None:
    platform = read(tmp_path, document(), f"platform: {{{BODY}}}").platform
    spar, brace = platform.members
    assert np.array_equal(spar.start, [0.0, 0.0, -40.0])
    assert brace.start == pytest.approx([0.0, 0.0, -20.0])
    assert brace.end == pytest.approx([0.0, 10.0, -20.0])  # 10 m at 90 deg
    assert np.array_equal(spar.sides, [[4.0, 4.0]] * 2)
    assert spar.round
    assert np.array_equal(spar.drag_coefficient, [[0.7, 0.7]])
    assert (spar.axial_drag_coefficient, brace.axial_drag_coefficient) == (0.9, 0.0)
    assert platform.draft == 40.0
    assert platform.water_depth == 80.0


def test_a_joint_can_stand_relative_to_another(tmp_path: Path) -> None:
    data = document()
    joints = data["components"]["floating_platform"]["joints"]
    joints[1] = {
        "name": "top",
        "location": [1.0, 2.0, 40.0],
        "relative": "keel",
        "relative_dims": [False, False, True],
        "transition": True,
    }
    spar = read(tmp_path, data, f"platform: {{{BODY}}}").platform.members[0]
    assert spar.end == pytest.approx([1.0, 2.0, 0.0])


@pytest.mark.parametrize(("rotation", "sides"), [(0.0, [3.0, 2.0]), (90.0, [2.0, 3.0])])
def test_rectangles_have_their_first_side_level(
    tmp_path: Path, rotation: float, sides: list[float]
) -> None:
    data = document()
    members(data)[1] |= {
        "Cd": [0.5, 1.5],
        "Cdy": 2.0,
        "outer_shape": {
            "shape": "rectangular",
            "side_length_a": curve(3.0, 3.0),
            "side_length_b": curve(2.0, 2.0),
            "rotation": rotation,
        },
    }
    brace = read(tmp_path, data, f"platform: {{{BODY}}}").platform.members[1]
    assert np.array_equal(brace.sides, [sides] * 2)
    assert not brace.round
    assert np.array_equal(brace.drag_coefficient, [[0.5, 2.0], [1.5, 2.0]])
    first, second, along = brace.axes().T
    assert along == pytest.approx([0.0, 1.0, 0.0])
    assert abs(first[2]) < 1e-15  # level
    assert second == pytest.approx([0.0, 0.0, 1.0])


def test_axes_of_upright_members_are_global() -> None:
    (spar,) = load("nrel5mw_oc3").platform.members
    assert np.array_equal(spar.axes(), np.eye(3))


def test_the_companion_overrides_members(tmp_path: Path) -> None:
    text = f"platform: {{{BODY}}}\nmembers: {{brace: {{sides: [2, 3], drag_coefficient: [1, 2]}}}}"
    spar, brace = read(tmp_path, document(), text).platform.members
    assert spar.round
    assert not brace.round
    assert np.array_equal(brace.sides, [[2.0, 3.0]] * 2)
    assert np.array_equal(brace.drag_coefficient, [[1.0, 2.0]])


# mass ----------------------------------------------------------------------------------


def test_mass_of_a_tube_with_bulkhead_and_ballast(tmp_path: Path) -> None:
    """Closed forms: tube, plate at a quarter, and 50 m3 of slurry standing on the keel."""
    data = document()
    del members(data)[1]
    data["components"]["floating_platform"]["joints"][2]["location"] = [2.0, 90.0, -20.0]
    members(data)[0]["structure"] = {
        "outfitting_factor": 1.1,
        "layers": [wall(0.05)],
        "bulkhead": {"material": "steel", "thickness": {"grid": [0.25], "values": [0.1]}},
        "ballast": [
            {"variable_flag": False, "material": "slurry", "volume": 50.0, "grid": [0.0, 0.2]},
            {"variable_flag": True, "grid": [0.2, 0.5]},
        ],
    }
    turbine = read(tmp_path, data)
    r, inside, h = 2.0, 1.95, 40.0
    tube = 1.1 * 8000.0 * np.pi * (r**2 - inside**2) * h
    plate = 1.1 * 8000.0 * np.pi * inside**2 * 0.1
    ballast, height = 50.0 * 2000.0, 50.0 / (np.pi * inside**2)
    parts = [(tube, -20.0), (plate, -30.0), (ballast, -40.0 + height / 2)]
    own = [
        tube * ((r**2 + inside**2) / 4 + h**2 / 12),
        plate * inside**2 / 4,
        ballast * (inside**2 / 4 + height**2 / 12),
    ]
    mass = tube + plate + ballast
    center = sum(m * z for m, z in parts) / mass
    roll = sum(i + m * (z - center) ** 2 for i, (m, z) in zip(own, parts, strict=True))
    yaw = tube * (r**2 + inside**2) / 2 + (plate + ballast) * inside**2 / 2
    platform = turbine.platform
    assert platform.mass == pytest.approx(mass, rel=1e-12)
    assert platform.center_of_mass == pytest.approx((0.0, 0.0, center), abs=2e-3)
    assert platform.inertia == pytest.approx((roll, roll, yaw), rel=2e-4)
    assert any("variable ballast of spar is left out" in note for note in turbine.notes)


def test_rigid_bodies_and_the_transition_piece_weigh(tmp_path: Path) -> None:
    data = document()
    data["components"]["floating_platform"] |= {
        "transition_piece_mass": 100.0,
        "rigid_bodies": [
            {
                "joint1": "keel",
                "mass": 300.0,
                "cost": 0.0,
                "cm_offset": [4.0, 0.0, 0.0],
                "moments_of_inertia": [10.0, 20.0, 30.0],
            }
        ],
    }
    platform = read(tmp_path, data).platform
    assert platform.mass == 400.0
    assert platform.center_of_mass == pytest.approx((3.0, 0.0, -30.0))
    reduced = 300.0 * 100.0 / 400.0
    expected = (10.0 + reduced * 40.0**2, 20.0 + reduced * (40.0**2 + 4.0**2), 30.0 + reduced * 16)
    assert platform.inertia == pytest.approx(expected)


def test_what_the_companion_states_wins_and_is_not_noted(tmp_path: Path) -> None:
    text = f"platform: {{{BODY}, draft: 39.0, additional_damping: [1, 2, 3, 4, 5, 6]}}"
    turbine = read(tmp_path, document(), text)
    platform = turbine.platform
    assert (platform.mass, platform.inertia, platform.draft) == (4e5, (1.0, 2.0, 3.0), 39.0)
    assert np.array_equal(platform.additional_damping, np.diag([1.0, 2, 3, 4, 5, 6]))
    assert not any(note.startswith("platform") for note in turbine.notes)


def test_a_file_of_coefficients_lies_beside_the_companion(tmp_path: Path) -> None:
    text = f"platform: {{{BODY}, hydrodynamics: waves.nc}}"  # it need not be there to read
    assert read(tmp_path, document(), text).platform.hydrodynamics == tmp_path / "waves.nc"


# mooring -------------------------------------------------------------------------------


def test_nodes_and_lines(tmp_path: Path) -> None:
    lines = read(tmp_path, document(), f"platform: {{{BODY}}}").platform.mooring
    assert [node.kind for node in lines.nodes] == ["fixed", "connection", "vessel"]
    assert lines.node("a").position == pytest.approx([0.0, 100.0, -80.0])
    assert lines.node("b").mass == 9.0
    assert lines.node("c").position == pytest.approx([0.0, 10.0, -20.0])
    assert [(line.first, line.second, line.length) for line in lines.lines] == [
        ("a", "b", 60.0),
        ("b", "c", 60.0),
    ]


def test_a_chain_of_a_diameter_alone_is_that_of_the_standard(tmp_path: Path) -> None:
    """windIO's 0.18 m displace as much as a chain of 100 mm: 199 kg/m, 854 MN."""
    turbine = read(tmp_path, document(), f"platform: {{{BODY}}}")
    chain = turbine.platform.mooring.lines[0].line_type
    assert chain.mass == pytest.approx(199.0)
    assert chain.stiffness == pytest.approx(854e6)
    displaced = 1025.0 * np.pi / 4 * 0.18**2
    assert chain.weight == pytest.approx((199.0 - displaced) * 9.80665)
    assert any("chain of 100 mm" in note for note in turbine.notes)


def test_the_companion_states_lines(tmp_path: Path) -> None:
    text = (
        f"platform: {{{BODY}}}\nmooring: {{yaw_stiffness: 5.0, seabed_friction: 0.5, "
        "line_types: {main: {mass: 10, weight: 80, stiffness: 1.0e+6}}}"
    )
    turbine = read(tmp_path, document(), text)
    lines = turbine.platform.mooring
    assert (lines.yaw_stiffness, lines.seabed_friction) == (5.0, 0.5)
    chain = lines.lines[0].line_type
    assert (chain.mass, chain.weight, chain.stiffness) == (10.0, 80.0, 1e6)
    assert not any(note.startswith("mooring") for note in turbine.notes)


# what is refused -------------------------------------------------------------------------


def unknown_joint(data: dict) -> None:
    members(data)[1]["joint1"] = "midd"


def unknown_node(data: dict) -> None:
    data["components"]["mooring"]["lines"][0]["node1"] = "d"


def no_transition(data: dict) -> None:
    del data["components"]["floating_platform"]["joints"][1]["transition"]


def two_of_a_name(data: dict) -> None:
    data["components"]["floating_platform"]["joints"][2]["name"] = "mid"


def a_polygon(data: dict) -> None:
    sides = {"side_lengths1": [1.0] * 3, "side_lengths2": [1.0] * 3, "angles": [60.0] * 3}
    members(data)[1]["outer_shape"] = {"shape": "polygonal", **sides}


def a_wire(data: dict) -> None:
    data["components"]["mooring"]["line_types"][0]["type"] = "polyester"


def misspelt(data: dict) -> None:
    data["components"]["mooring"]["lines"][0]["unstretched_lenght"] = 1.0


def thick_wall(data: dict) -> None:
    members(data)[0]["structure"]["layers"] = [wall(2.1)]


def no_length(data: dict) -> None:
    members(data)[1]["joint2"] = "mid"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (unknown_joint, r"unknown joint 'midd'\s+did you mean 'mid'"),
        (unknown_node, "'d' is not there"),
        (no_transition, "no joint has 'transition: true'"),
        (two_of_a_name, "a second joint is named 'mid'"),
        (a_polygon, "a polygonal cross section"),
        (a_wire, "a line of polyester without mass_density and stiffness"),
        (misspelt, "unstretched_length"),
        (thick_wall, "is thicker than half the member"),
        (no_length, "both joints stand at the same place"),
        (lambda _: None, "nothing of it has mass"),
    ],
)
def test_wrong_platforms_are_refused(tmp_path: Path, change: Any, said: str) -> None:
    data = document()
    change(data)
    with pytest.raises(InputError, match=said):
        read(tmp_path, data)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("platform: {mass: 1.0}", "'reference_point' is missing"),
        (f"platform: {{{BODY}}}\nmembers: {{brase: {{}}}}", "did you mean 'brace'"),
        (f"platform: {{{BODY}}}\nmembers: {{brace: {{side: 1}}}}", "did you mean 'sides'"),
        (
            f"platform: {{{BODY}}}\nmooring: {{line_types: {{man: {{mass: 1}}}}}}",
            "did you mean 'main'",
        ),
        ("platform: {additional_damping: [1.0]}", "holds 1 values where 6"),
    ],
)
def test_wrong_companions_are_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        read(tmp_path, document(), text)


@pytest.mark.parametrize("text", ["members: {a: {}}", "mooring: {yaw_stiffness: 1.0}"])
def test_a_companion_of_what_the_file_has_not_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match=r"has these|has no mooring"):
        read(tmp_path, small_windio.document(), text)


# out -----------------------------------------------------------------------------------


def test_a_connection_and_a_rectangle_survive_the_way_out_and_in(tmp_path: Path) -> None:
    text = f"platform: {{{BODY}}}\nmembers: {{brace: {{sides: [2, 3]}}}}"
    turbine = read(tmp_path, document(), text)
    windio.write(turbine, tmp_path / "out.yaml")
    found, expected = windio.read(tmp_path / "out.yaml").platform, turbine.platform
    assert np.array_equal(found.members[1].sides, expected.members[1].sides)
    assert found.members[0].axial_drag_coefficient == 0.9
    assert np.array_equal(found.mooring.node("b").position, expected.mooring.node("b").position)
    assert found.mooring.lines == expected.mooring.lines


def test_the_companion_is_written_relative_to_its_folder(tmp_path: Path) -> None:
    turbine = read(tmp_path, document(), f"platform: {{{BODY}, hydrodynamics: waves.nc}}")
    windio.write(turbine, tmp_path / "out.yaml")
    assert 'hydrodynamics: "waves.nc"' in (tmp_path / "out.companion.yaml").read_text()


# built in --------------------------------------------------------------------------------


def test_oc3_is_moored_as_in_its_report() -> None:
    """NREL/TP-500-47535, Tables 3-1, 4-2 and 5-1."""
    platform = load("nrel5mw_oc3").platform
    (spar,) = platform.members
    depth = spar.start[2] + spar.span * spar.length
    assert depth == pytest.approx([-120.0, -12.0, -4.0, 10.0])
    line = platform.mooring.lines[0]
    assert (line.length, line.line_type.weight) == (902.2, 698.094)
    displaced = 1025.0 * np.pi / 4 * line.line_type.diameter**2
    assert (line.line_type.mass - displaced) * 9.80665 == pytest.approx(698.094, rel=1e-5)
    for i in (1, 2, 3):
        anchor, fairlead = (
            platform.mooring.node(f"{n}{i}").position for n in ("anchor", "fairlead")
        )
        assert np.hypot(*anchor[:2]) == pytest.approx(853.87)
        assert np.hypot(*fairlead[:2]) == pytest.approx(5.2)
        assert (anchor[2], fairlead[2]) == (-320.0, -70.0)
    assert platform.mooring.yaw_stiffness == 98.34e6
    assert platform.hydrodynamics.name == "nrel5mw_oc3.hydro.nc"


def test_volturnus_shares_the_rotor_and_floats_on_its_own_hull() -> None:
    turbine, ashore = load("iea15mw_volturnus"), load("iea15mw")
    assert np.array_equal(turbine.blade.structure.stiffness, ashore.blade.structure.stiffness)
    assert turbine.control.rated_power == ashore.control.rated_power
    assert turbine.hub_height == pytest.approx(150.0, abs=1e-6)
    assert turbine.tower.axis[0, 2] == 15.0
    platform = turbine.platform
    assert len(platform.members) == 10
    assert platform.mooring.node("fairlead1").position == pytest.approx([-58.0, 0.0, -14.0])
    assert to_yaml({"mass": platform.mass}) == "mass: 17854000.0\n"
