"""A turbine that is written and read back is the same turbine, and its file is valid windIO."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_windio

from galerna.errors import InputError
from galerna.turbine import load, names, windio
from galerna.turbine.windio.emit import to_yaml
from galerna.turbine.windio.yamlfile import load as load_yaml


def assert_same(found: Any, expected: Any, where: str = "turbine") -> None:
    """Equal all through, floats to the rounding of one unit conversion there and back."""
    if is_dataclass(expected):
        for f in fields(expected):
            assert_same(getattr(found, f.name), getattr(expected, f.name), f"{where}.{f.name}")
    elif isinstance(expected, dict):
        assert found.keys() == expected.keys(), where
        for key in expected:
            assert_same(found[key], expected[key], f"{where}[{key!r}]")
    elif isinstance(expected, np.ndarray):
        scale = np.abs(expected).max(initial=0.0)
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13 * scale, err_msg=where)
    elif isinstance(expected, float):
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-14), where
    elif isinstance(expected, tuple):
        assert len(found) == len(expected), where
        for i, pair in enumerate(zip(found, expected, strict=True)):
            assert_same(*pair, f"{where}[{i}]")
    else:
        assert found == expected, where


@pytest.mark.parametrize("name", names())
def test_built_in_turbines_survive_the_way_out_and_in(name: str, tmp_path: Path) -> None:
    turbine = load(name)
    windio.write(turbine, tmp_path / "out.yaml")
    assert_same(windio.read(tmp_path / "out.yaml"), turbine)


def test_the_windio_package_accepts_what_is_written(tmp_path: Path) -> None:
    import windIO

    windio.write(load("nrel5mw"), tmp_path / "out.yaml")
    windIO.validate(tmp_path / "out.yaml", "turbine/turbine_schema")


def test_a_deck_without_cut_out_and_with_a_rounded_quarter_turn_can_be_written(
    tmp_path: Path,
) -> None:
    """ServoDyn states no cut-out wind speed, and ROSCO's 1.5708 rad are 90.0002 deg."""
    turbine = load("nrel5mw")
    control = replace(turbine.control, cut_out_wind_speed=np.inf, maximum_pitch=1.5708)
    windio.write(replace(turbine, control=control), tmp_path / "out.yaml")
    found = windio.read(tmp_path / "out.yaml").control
    assert found.cut_out_wind_speed == 25.0  # windIO's default
    assert found.maximum_pitch == pytest.approx(np.pi / 2)


def test_sections_at_a_twist_of_their_own_are_turned_to_the_aerodynamic_one(
    tmp_path: Path,
) -> None:
    """A bending moment about a fixed direction gives the same curvature before and after."""
    turbine = windio.read(small_windio.write(tmp_path, small_windio.document()))
    structure = turbine.blade.structure
    turned = replace(structure, twist=structure.twist + 0.1)
    blade = replace(turbine.blade, structure=turned)
    windio.write(replace(turbine, blade=blade), tmp_path / "out.yaml")
    found = windio.read(tmp_path / "out.yaml").blade.structure

    def curvature(sections: Any) -> np.ndarray:
        c, s = np.cos(sections.twist[0]), np.sin(sections.twist[0])
        to_section = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        load = np.concatenate([np.zeros(3), to_section @ [1e6, 2e6, 0.0]])
        return to_section.T @ np.linalg.solve(sections.stiffness[0], load)[3:]

    assert found.twist[0] != pytest.approx(turned.twist[0])
    assert curvature(found) == pytest.approx(curvature(turned), rel=1e-12)
    assert curvature(found) != pytest.approx(curvature(structure), rel=1e-3)


def test_blended_polars_and_several_reynolds_numbers_survive(tmp_path: Path) -> None:
    data = small_windio.document()
    clean = [small_windio.polar(slope=0.12, reynolds=r) for r in (3e6, 9e6)]
    rough = [small_windio.polar(slope=0.08, reynolds=r) for r in (3e6, 9e6)]
    data["airfoils"][1]["polars"] = [
        {"configuration": "clean", "re_sets": clean},
        {"configuration": "rough", "re_sets": rough},
    ]
    entry = data["components"]["blade"]["outer_shape"]["airfoils"][1]
    entry |= {"configuration": ["clean", "rough"], "weight": [0.5, 0.5]}
    turbine = windio.read(small_windio.write(tmp_path, data))
    assert len(turbine.airfoils["thin [0.5 clean + 0.5 rough]"].polars) == 2
    windio.write(turbine, tmp_path / "out.yaml")
    assert_same(windio.read(tmp_path / "out.yaml"), turbine)


def test_point_masses_survive(tmp_path: Path) -> None:
    turbine = windio.read(small_windio.write(tmp_path, small_windio.document()))
    tower = replace(turbine.tower, extra_masses=((12.0, 300.0),))
    windio.write(replace(turbine, tower=tower), tmp_path / "out.yaml")
    [(height, mass)] = windio.read(tmp_path / "out.yaml").tower.extra_masses
    assert (height, mass) == (pytest.approx(12.0), 300.0)


def test_a_turbine_that_windio_cannot_hold_is_refused_and_nothing_written(tmp_path: Path) -> None:
    turbine = load("nrel5mw")
    huge = replace(turbine.nacelle, overhang=30.0)  # windIO knows overhangs up to 20 m
    with pytest.raises(InputError, match="overhang"):
        windio.write(replace(turbine, nacelle=huge), tmp_path / "out.yaml")
    assert list(tmp_path.iterdir()) == []


def test_every_float_comes_back_to_the_same_bits(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    values = (rng.standard_normal(200) * 10.0 ** rng.integers(-300, 300, 200)).tolist()
    path = tmp_path / "floats.yaml"
    path.write_text(to_yaml({"row": values, "blocks": [{"one": v} for v in values]}))
    found = load_yaml(path).data
    assert found["row"] == values
    assert [block["one"] for block in found["blocks"]] == values


def test_text_with_signs_of_yaml_survives(tmp_path: Path) -> None:
    text = 'a: "b" # c\n- [d] {e} & *f'
    path = tmp_path / "text.yaml"
    path.write_text(to_yaml({"text": text}))
    assert load_yaml(path).data == {"text": text}
