"""What a windIO file means in SI and galerna's axes, and what is said about a wrong one."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_windio
from small_windio import beam, curve, document, polar

from galerna.errors import InputError
from galerna.turbine import Turbine, load, windio
from galerna.units import DEG, RPM


def read(tmp_path: Path, data: dict[str, Any]) -> Turbine:
    return windio.read(small_windio.write(tmp_path, data))


def outer_shape(data: dict[str, Any]) -> dict[str, Any]:
    return data["components"]["blade"]["outer_shape"]


def test_units_are_converted_once(tmp_path: Path) -> None:
    turbine = read(tmp_path, document())
    assert turbine.blade.shape.twist[0] == pytest.approx(10.0 * DEG)
    assert turbine.hub.cone == pytest.approx(3.0 * DEG)
    assert turbine.control.rated_rotor_speed == pytest.approx(30.0 * RPM)
    assert turbine.control.maximum_pitch_rate == pytest.approx(8.0 * DEG)
    thin = turbine.airfoils["thin"].polars[0]
    assert thin.angle_of_attack[[0, -1]] == pytest.approx([-np.pi, np.pi])


def test_torque_gain_is_the_same_power_at_either_shaft(tmp_path: Path) -> None:
    """windIO: k (rotor rpm)^2 is the generator torque; the model: K (generator rad/s)^2."""
    turbine = read(tmp_path, document())
    rotor_rpm, ratio = 20.0, turbine.drivetrain.gear_ratio
    torque = turbine.control.optimal_mode_gain * (rotor_rpm * RPM * ratio) ** 2
    assert torque == pytest.approx(100.0 * rotor_rpm**2)


def test_shaft_lengths_put_the_hub_where_the_file_says(tmp_path: Path) -> None:
    turbine = read(tmp_path, document())
    nacelle = turbine.nacelle
    assert nacelle.overhang * np.cos(nacelle.tilt) == pytest.approx(3.0)
    assert turbine.hub_height == pytest.approx(32.0)


def test_curves_on_grids_of_their_own_keep_all_their_points(tmp_path: Path) -> None:
    shape = read(tmp_path, document()).blade.shape
    assert shape.span == pytest.approx([0.0, 0.5, 1.0])
    assert shape.chord == pytest.approx([1.0, 0.8, 0.5])
    assert shape.twist == pytest.approx(np.array([10.0, 5.0, 0.0]) * DEG)


def test_yaw_inertia_is_taken_from_the_mass_centre_to_the_yaw_axis(tmp_path: Path) -> None:
    data = document()
    body = {"mass": 1000.0, "location": [2.0, 0.5, 1.0], "inertia": [0.0, 0.0, 500.0, 0, 0, 0]}
    data["components"]["drivetrain"]["elastic_properties"] = body
    expected = 500.0 + 1000.0 * (2.0**2 + 0.5**2)
    assert read(tmp_path, data).nacelle.yaw_inertia == pytest.approx(expected)


# section axes ------------------------------------------------------------------


def test_beamdyn_axes_are_kept(tmp_path: Path) -> None:
    turbine = read(tmp_path, document())
    structure = turbine.blade.structure
    assert structure.stiffness[0, 3, 3] == 4e9
    assert structure.inertia[0, 2, 3] == pytest.approx(100.0 * 0.2)  # m y: mass centre behind
    assert turbine.notes == ()


def test_axes_of_the_schema_text_are_exchanged_and_reported(tmp_path: Path) -> None:
    data = document()
    elastic = beam(edge=1e9, flap=4e9)
    inertia = elastic["inertia_matrix"]
    inertia["cm_x"], inertia["cm_y"] = inertia["cm_y"], inertia["cm_x"]
    inertia["i_edge"], inertia["i_flap"] = inertia["i_flap"], inertia["i_edge"]
    data["components"]["blade"]["structure"]["elastic_properties"] = elastic
    turbine = read(tmp_path, data)
    expected = read(tmp_path, document()).blade.structure
    assert turbine.blade.structure.stiffness == pytest.approx(expected.stiffness)
    assert np.abs(turbine.blade.structure.inertia) == pytest.approx(np.abs(expected.inertia))
    assert any("exchanged" in note for note in turbine.notes)


def test_stiffness_and_mass_centre_that_disagree_are_reported(tmp_path: Path) -> None:
    data = document()
    data["components"]["blade"]["structure"]["elastic_properties"] = beam(edge=1e9, flap=4e9)
    assert any("disagree" in note for note in read(tmp_path, data).notes)


def test_missing_stiffness_makes_the_blade_rigid_and_says_so(tmp_path: Path) -> None:
    data = document()
    stiffness = data["components"]["blade"]["structure"]["elastic_properties"]["stiffness_matrix"]
    stiffness["K11"] = [0.0, 0.0]
    turbine = read(tmp_path, data)
    assert turbine.blade.structure is None
    assert any("rigid" in note for note in turbine.notes)


def test_a_beam_without_rotary_inertia_is_taken(tmp_path: Path) -> None:
    data = document()
    inertia = data["components"]["tower"]["structure"]["elastic_properties"]["inertia_matrix"]
    inertia |= {"i_edge": [0.0, 0.0], "i_flap": [0.0, 0.0], "cm_y": [0.0, 0.0]}
    structure = read(tmp_path, data).tower.structure
    assert np.diagonal(structure.inertia[0]) == pytest.approx([100.0] * 3 + [0.0] * 3)


def test_an_offset_mass_needs_the_inertia_of_its_offset(tmp_path: Path) -> None:
    data = document()
    inertia = data["components"]["tower"]["structure"]["elastic_properties"]["inertia_matrix"]
    inertia["i_edge"] = [3.9, 3.9]  # 100 kg/m at 0.2 m have 4 kg m
    with pytest.raises(InputError, match="inertia_matrix: the 6x6 matrix"):
        read(tmp_path, data)


# towers of layers ----------------------------------------------------------------


def layered(data: dict[str, Any], walls: list[float]) -> dict[str, Any]:
    steel = {"name": "steel", "orth": 0, "rho": 8500.0, "E": 210e9, "G": 80.8e9, "nu": 0.3}
    data["materials"] = [steel]
    layers = [
        {"name": f"wall{i}", "material": "steel", "thickness": curve(wall, wall)}
        for i, wall in enumerate(walls)
    ]
    data["components"]["tower"]["structure"] = {"layers": layers}
    return data


def test_tower_of_layers_is_a_tube(tmp_path: Path) -> None:
    tower = read(tmp_path, layered(document(), [0.02])).tower.structure
    outer, inner = 1.5, 1.48
    area, second = np.pi * (outer**2 - inner**2), np.pi / 4 * (outer**4 - inner**4)
    assert tower.mass[0] == pytest.approx(8500.0 * area)
    assert tower.stiffness[0, 2, 2] == pytest.approx(210e9 * area)
    assert tower.stiffness[0, 3, 3] == pytest.approx(210e9 * second)
    assert tower.stiffness[0, 5, 5] == pytest.approx(80.8e9 * 2 * second)


def test_two_layers_make_the_wall_of_their_sum(tmp_path: Path) -> None:
    one = read(tmp_path, layered(document(), [0.03])).tower.structure
    two = read(tmp_path, layered(document(), [0.01, 0.02])).tower.structure
    assert two.stiffness == pytest.approx(one.stiffness)
    assert two.inertia == pytest.approx(one.inertia)


def test_tube_agrees_with_the_one_in_windio_s_own_example() -> None:
    """IEA 15 MW as shipped with windIO: bending stiffness there, computed by WISDEM."""
    import windIO
    from windIO.yaml import load_yaml

    path = Path(windIO.__file__).parent / "examples" / "turbine" / "IEA-15-240-RWT.yaml"
    turbine = load(path)
    given = load_yaml(path)["components"]["tower"]["structure"]["elastic_properties"]
    found = turbine.tower.structure
    assert found.stiffness[0, 3, 3] == pytest.approx(given["stiffness_matrix"]["K44"][0], rel=1e-9)
    assert found.mass[0] == pytest.approx(given["inertia_matrix"]["mass"][0], rel=1e-9)
    assert any("inertia_tt" in note for note in turbine.notes)
    assert any(note.startswith("monopile") for note in turbine.notes)
    assert turbine.control.pitch_schedule[0, 1] > 0.0  # turned to pitch towards feather


# airfoils ------------------------------------------------------------------------


def test_positions_follow_the_thickness_where_none_are_given(tmp_path: Path) -> None:
    data = document()
    for entry in outer_shape(data)["airfoils"]:
        del entry["spanwise_position"]
    data["airfoils"].insert(1, {"name": "mid", "rthick": 0.6, "polars": [{"re_sets": [polar()]}]})
    outer_shape(data)["airfoils"].insert(1, {"name": "mid"})
    assert read(tmp_path, data).blade.shape.airfoil_span == pytest.approx([0.0, 0.5, 1.0])


def test_an_airfoil_where_the_blade_is_not_as_thick_is_noted(tmp_path: Path) -> None:
    data = document()
    outer_shape(data)["airfoils"][1]["spanwise_position"] = 0.9
    assert any("is 0.28 thick" in note for note in read(tmp_path, data).notes)


def test_configurations_are_blended_by_weight(tmp_path: Path) -> None:
    data = document()
    data["airfoils"][1]["polars"] = [
        {"configuration": "clean", "re_sets": [polar(slope=0.12)]},
        {"configuration": "rough", "re_sets": [polar(slope=0.08)]},
    ]
    blend = {"configuration": ["clean", "rough"], "weight": [0.75, 0.25]}
    outer_shape(data)["airfoils"][1] |= blend
    turbine = read(tmp_path, data)
    name = "thin [0.75 clean + 0.25 rough]"
    assert turbine.blade.shape.airfoil_names[-1] == name
    lift = turbine.airfoils[name].polars[0].lift
    assert lift.max() == pytest.approx(0.75 * 1.2 + 0.25 * 0.8)


def test_polars_stand_by_rising_reynolds_number(tmp_path: Path) -> None:
    data = document()
    data["airfoils"][1]["polars"][0]["re_sets"] = [polar(reynolds=9e6), polar(reynolds=3e6)]
    polars = read(tmp_path, data).airfoils["thin"].polars
    assert [p.reynolds for p in polars] == [3e6, 9e6]


def test_published_unsteady_parameters_are_taken(tmp_path: Path) -> None:
    data = document()
    given = {"aoa0": -2.0, "aoa1": 8.0, "aoa2": -9.0, "c_nalpha": 6.0, "cn1": 1.4, "cn2": -0.8}
    data["airfoils"][1]["polars"][0]["re_sets"][0] |= given | {"cd0": 0.007, "T_p": 1.5}
    found = read(tmp_path, data).airfoils["thin"].unsteady
    assert found.origin == "published"
    assert found.zero_lift_angle == pytest.approx(-2.0 * DEG)
    assert (found.pressure_lag, found.separation_lag) == (1.5, 3.0)


def test_outline_from_the_pressure_side_is_turned_round(tmp_path: Path) -> None:
    data = document()
    outline = {"x": [1.0, 0.5, 0.0, 0.5, 1.0], "y": [0.0, -0.05, 0.0, 0.1, 0.0]}
    data["airfoils"][1]["coordinates"] = outline
    thin = read(tmp_path, data).airfoils["thin"]
    assert thin.coordinates[1, 1] == 0.1
    assert np.interp(0.5, *thin.camber.T) == pytest.approx(0.025, abs=1e-3)


# what is said about a wrong file ---------------------------------------------------


def wrong(path: str, value: Any) -> Any:
    """A change to the small document: ``a.b.0.c`` set to a value."""

    def change(data: dict[str, Any]) -> None:
        *parents, last = (int(k) if k.isdigit() else k for k in path.split("."))
        for key in parents:
            data = data[key]
        data[last] = value

    return change


BLADE = "components.blade.outer_shape."
SECTIONS = "components.blade.structure.elastic_properties."
WRONG = {
    "chord of zero": (wrong(BLADE + "chord.values.1", 0.0), "chord.values: chord of 0 m"),
    "negative chord": (wrong(BLADE + "chord.values.1", -1.0), "it must be positive"),
    "NaN": (wrong(BLADE + "chord.values.1", float("nan")), "value 2 is nan; all must be finite"),
    "grid falls": (wrong(BLADE + "chord.grid.1", 1.0), "must ascend: value 3"),
    "grid short": (wrong(BLADE + "chord.grid.2", 0.9), "covers 0 to 0.9; 0 to 1 is needed"),
    "lengths": (wrong(BLADE + "chord.values", [1.0, 0.5]), "holds 2 values where 3 are expected"),
    "twist in rad": (wrong(BLADE + "twist.values.0", 95.0), "windIO v2 wants degrees"),
    "polar range": (
        wrong("airfoils.1.polars.0.re_sets.0.cl.grid.5", 170.0),
        r"covers -180 to 170; -180 to 180 is needed",
    ),
    "negative drag": (
        wrong("airfoils.1.polars.0.re_sets.0.cd.values.2", -0.5),
        "drag coefficient of -0.5",
    ),
    "unknown airfoil": (wrong(BLADE + "airfoils.1.name", "thinn"), "did you mean 'thin'"),
    "no airfoil": (wrong(BLADE + "airfoils", []), "no airfoil stands along the blade"),
    "order": (wrong(BLADE + "airfoils.0.spanwise_position", 1.0), "inboard of the one before"),
    "negative stiffness": (wrong(SECTIONS + "stiffness_matrix.K55.1", -1.0), "K55 is -1 at span 1"),
    "coupling": (wrong(SECTIONS + "stiffness_matrix.K45", [9e9, 9e9]), "not positive definite"),
    "misspelt key": (wrong(BLADE + "section_ofset_x", curve(0, 0)), "'section_offset_x'"),
    "misspelt where windIO lets all pass": (
        wrong("components.hub.elastic_propertys", {}),
        "did you mean 'elastic_properties'",
    ),
    "text": (wrong("components.hub.diameter", "two"), "hub.diameter: expected number, found 'two'"),
    "downwind": (wrong("assembly.rotor_orientation", "downwind"), "upwind rotors only"),
    "version": (wrong("windIO_version", "3.0"), "windIO version 3.0; galerna reads 2.x"),
    "nothing": (wrong("components.tower", None), "expected object, found nothing"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_value_is_named_with_place_and_remedy(name: str, tmp_path: Path) -> None:
    change, text = WRONG[name]
    data = document()
    change(data)
    with pytest.raises(InputError) as caught:
        read(tmp_path, data)
    message = str(caught.value)
    assert text in message
    assert re.match(r".*small\.yaml, line \d+, \w", message), message


def test_the_line_is_the_line(tmp_path: Path) -> None:
    data = document()
    data["components"]["hub"]["diameter"] = -1.0
    path = small_windio.write(tmp_path, data)
    line = 1 + path.read_text().splitlines().index("    diameter: -1.0")
    with pytest.raises(InputError, match=f"line {line}, components.hub.diameter"):
        windio.read(path)


def test_a_missing_key_is_named(tmp_path: Path) -> None:
    data = document()
    del outer_shape(data)["chord"]
    with pytest.raises(InputError, match=r"outer_shape: 'chord' is missing"):
        read(tmp_path, data)


def test_a_missing_key_finds_its_misspelling(tmp_path: Path) -> None:
    path = small_windio.write(tmp_path, document())
    path.write_text(path.read_text().replace("    z:", "    zz:", 1))
    with pytest.raises(InputError, match="zz"):
        windio.read(path, validate=False)


def test_a_strange_key_that_resembles_none_is_noted(tmp_path: Path) -> None:
    data = document()
    data["control"]["peak_thrust_shaving"] = 1.0
    assert any("peak_thrust_shaving" in note for note in read(tmp_path, data).notes)


@pytest.mark.parametrize("name", ["monopile", "jacket"])
def test_a_foundation_that_is_not_read_is_noted(name: str, tmp_path: Path) -> None:
    data = document()
    data["components"][name] = {}
    assert any(note.startswith(name) for note in read(tmp_path, data).notes)


@pytest.mark.parametrize(
    ("part", "key", "said"),
    [
        ("hub", "elastic_properties", "hub: no elastic properties"),
        ("drivetrain", "elastic_properties", "nacelle: no elastic properties"),
        ("drivetrain", "generator", "generator: no efficiency"),
    ],
)
def test_what_the_file_lacks_is_noted(part: str, key: str, said: str, tmp_path: Path) -> None:
    data = document()
    del data["components"][part][key]
    assert any(note.startswith(said) for note in read(tmp_path, data).notes)


@pytest.mark.parametrize("version", [None, "1.0"])
def test_version_one_is_refused_with_the_converter(tmp_path: Path, version: str | None) -> None:
    data = document()
    del data["windIO_version"]
    if version:
        data["windIO_version"] = version
    with pytest.raises(InputError, match="v1p0_to_v2p0"):
        read(tmp_path, data)


def test_an_include_is_followed_and_its_errors_are_found_there(tmp_path: Path) -> None:
    data = document()
    airfoils = data.pop("airfoils")
    airfoils[1]["rthick"] = 7.0
    path = small_windio.write(tmp_path, data)
    path.write_text(path.read_text() + "airfoils: !include foils.yaml\n")
    listed = small_windio.to_yaml({"a": airfoils}).split("\n", 1)[1]
    (tmp_path / "foils.yaml").write_text(listed)
    with pytest.raises(InputError, match=r"foils\.yaml, line \d+, airfoils\[1\]\.rthick"):
        windio.read(path)


def test_a_file_that_includes_itself_ends(tmp_path: Path) -> None:
    path = tmp_path / "snake.yaml"
    path.write_text("tail: !include snake.yaml\n")
    with pytest.raises(InputError, match="include each other"):
        windio.read(path)


@pytest.mark.parametrize("name", ["nrel5mv", "nothing.yaml", "deck.xyz"])
def test_what_cannot_be_found_says_so(name: str) -> None:
    with pytest.raises(InputError):
        load(name)


def test_a_name_mistyped_is_answered_with_the_nearest() -> None:
    with pytest.raises(InputError, match="did you mean 'nrel5mw'"):
        load("nrel5mv")


def test_a_built_in_name_written_as_a_file_is_answered() -> None:
    with pytest.raises(InputError, match="the built-in turbine is 'nrel5mw'"):
        load("nrel5mw.yaml")


# the companion ---------------------------------------------------------------------


def test_companion_gives_what_windio_cannot_hold(tmp_path: Path) -> None:
    path = small_windio.write(tmp_path, document())
    (tmp_path / "small.companion.yaml").write_text(
        "sources: {hub: a book}\nnacelle: {yaw_damping: 5.0, drag_area: [1, 2, 3]}\n"
    )
    turbine = windio.read(path)
    assert turbine.sources == {"hub": "a book"}
    assert turbine.nacelle.yaw_damping == 5.0
    assert turbine.nacelle.drag_area == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nacele: {}", "did you mean 'nacelle'"),
        ("nacelle: {yaw_dampin: 1.0}", "did you mean 'yaw_damping'"),
        ("nacelle: {drag_area: [1.0]}", "holds 1 values where 3"),
        ("platform: {mass: 1.0}", "'reference_point' is missing"),
    ],
)
def test_a_wrong_companion_is_refused(tmp_path: Path, text: str, said: str) -> None:
    path = small_windio.write(tmp_path, document())
    (tmp_path / "small.companion.yaml").write_text(text)
    with pytest.raises(InputError, match=said):
        windio.read(path)
