"""Every example runs, and the schema that ships with them is that of the code."""

import json
import runpy
import shutil
from importlib.util import find_spec

import numpy as np
import pytest

import galerna
from galerna import examples
from galerna.case import load
from galerna.schema import FILE, case_schema

SCRIPTS = sorted(path.name for path in examples.folder().glob("*.py"))

#: what must come out of a few seconds of each case: channel, lowest and highest mean
EXPECTED = {
    "demo": ("rotor_power", 3e6, 8e6),
    "on_land": ("rotor_power", 3e6, 8e6),
    "free_decay": ("platform_pitch", 0.05, 0.09),
    "regular_wave": ("platform_surge", 9.0, 16.0),
    "volturnus": ("electrical_power", 10e6, 16e6),
    "turbulent": ("rotor_power", 2e6, 8e6),
    "yawed": ("rotor_power", 1.0e6, 1.8e6),
    "gust": ("rotor_power", 12e6, 20e6),
    "free_wake": ("rotor_power", 1.0e6, 4.5e6),
    "flexible_free_wake": ("rotor_power", 3.5e6, 6.5e6),
    "controlled": ("electrical_power", 2.5e6, 5.5e6),
    "platform_motion": ("rotor_power", 4.5e6, 6.5e6),
    "stop": ("electrical_power", 9.5e6, 10.5e6),
    "rosco": ("rotor_power", 4.5e6, 6.5e6),
}


@pytest.mark.parametrize("name", examples.case_names())
def test_a_built_in_case_runs(name):
    loaded = load(name)
    if name == "rosco" and find_spec("rosco") is None:
        pytest.skip("ROSCO is not installed")
    values = {**loaded.document.values, "outputs": {}, "duration_s": 3.0}
    if "input_file" in (control := values.get("control", {})):
        control["input_file"] = str(loaded.folder / control["input_file"])
    turbulence = values["inflow"].get("turbulence")
    if turbulence:
        turbulence.update(points_across=8, time_step_s=0.4)
    values.get("aerodynamics", {}).pop(
        "flow_output", None
    )  # which a result in memory has no place for
    result = galerna.run(values)
    channel, low, high = EXPECTED[name]
    assert low < float(result[channel].mean()) < high


@pytest.mark.parametrize("name", examples.case_names())
def test_a_built_in_case_says_what_it_is(name):
    loaded = load(name)
    assert loaded.case.name == name
    assert loaded.case.description
    assert loaded.document.text.startswith(f"# yaml-language-server: $schema={FILE}\n")


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_runs(script, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [script])
    runpy.run_path(str(examples.folder() / script), run_name="__main__")
    assert capsys.readouterr().out.strip()


def test_the_shipped_schema_is_that_of_the_code():
    shipped = (examples.folder() / FILE).read_text(encoding="utf-8")
    assert json.loads(shipped) == case_schema(), "run: galerna schema > examples/case.schema.json"


@pytest.mark.parametrize("name", examples.case_names())
def test_the_schema_accepts_the_examples(name):
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.validate(load(name).document.values, case_schema())


def test_the_schema_refuses_what_a_case_refuses():
    jsonschema = pytest.importorskip("jsonschema")
    values = {**load("yawed").document.values, "turbin": "nrel5mw"}
    with pytest.raises(jsonschema.ValidationError, match="turbin"):
        jsonschema.validate(values, case_schema())


def test_a_folder_of_its_name_does_not_hide_a_built_in_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "demo").mkdir()
    assert load("demo").case.turbine == "nrel5mw_oc3"


def test_copied_examples_run_where_they_are(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(examples.case_path("yawed"), tmp_path / "mine.yaml")
    result = galerna.run("mine.yaml", duration=21.0)
    assert result.attrs["case_name"] == "yawed"
    assert np.isfinite(result["rotor_thrust"]).all()
