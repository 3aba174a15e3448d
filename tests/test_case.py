"""Cases: what is wrong is said with line, key, expectation and the nearest valid name."""

from textwrap import dedent

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from galerna.aero.bem.options import BemOptions
from galerna.aero.vortex.options import VortexLatticeOptions
from galerna.case import Case, CaseError, load, parse
from galerna.case.document import parse_document
from galerna.errors import InputError

GOOD = """\
galerna: 1
turbine: nrel5mw
duration_s: 10
time_step_s: 0.05
inflow:
  wind_speed_m_s: 8.0
  shear: {kind: power_law, exponent: 0.2}
aerodynamics:
  model: bem
operation:
  rotor_speed_rpm: 9.16
  pitch_deg: {time_s: [0, 5], values: [0, 2]}
outputs:
  interval_s: 0.1
"""

BOX = """\
  turbulence: {{kind: mann, turbulence_class: B, points: {}, spacing_m: [1, 2, 3]}}
  shear"""

VORTEX = "model: vortex_lattice\n  "
PLANES = """\
flow_output:
    interval_s: 1
    planes:
      - {{name: {}, corner_m: [0, 0, 0], first_side_m: [1, 0, 0], second_side_m: [0, 1, 0]}}"""


def refused(text):
    with pytest.raises(InputError) as caught:
        parse(dedent(text))
    return str(caught.value)


def test_a_good_case_is_read():
    case = parse(GOOD, "good.yaml").case
    assert case.operation.pitch_deg.values == (0.0, 2.0)
    assert case.aerodynamics.tip_loss
    assert case.record_every == 2


@pytest.mark.parametrize(
    ("wrong", "right", "message"),
    [
        ("turbine: nrel5mw", "turbin: nrel5mw", "line 2: turbin: unknown key"),
        ("turbine: nrel5mw", "turbin: nrel5mw", "did you mean 'turbine'"),
        ("  model: bem", "  model: bem\n  tiploss: true", "10: aerodynamics.tiploss: unknown key"),
        ("  model: bem", "  model: bem\n  tiploss: true", "did you mean 'tip_loss'"),
        ("power_law", "power_low", "7: inflow.shear.kind: expected"),
        ("power_law", "power_low", "did you mean 'power_law'"),
        ("exponent", "exponet", "did you mean 'exponent'"),
        ("exponent: 0.2", "exponent: 7", "inflow.shear.exponent: expected less than or equal to 2"),
        ("8.0", "fast", "6: inflow.wind_speed_m_s: expected a number, found 'fast'"),
        ("duration_s: 10", "duration_s: -10", "3: duration_s: expected greater than 0, found -10"),
        ("duration_s: 10", "duration_s: 0", "3: duration_s: expected greater than 0, found 0"),
        ("duration_s: 10", "duration_s: .nan", "duration_s: expected a finite number, found .nan"),
        ("duration_s: 10", "duration_s: 0.01", "duration_s: 0.01 s is less than one time_step_s"),
        ("interval_s: 0.1", "interval_s: 0.12", "14: outputs.interval_s: 0.12 s is not a whole"),
        ("interval_s: 0.1", "start_s: 12", "14: outputs.start_s: 12 s leaves nothing"),
        ("[0, 5]", "[5, 0]", "12: operation.pitch_deg.time_s: times must rise, found 0 after 5"),
        ("[0, 5]", "[0, 5, 6]", "12: operation.pitch_deg: 3 times for 2 values"),
        ("rotor_speed_rpm: 9.16", "yaw_deg: 0", "10: operation: give rotor_speed_rpm, or"),
        ("galerna: 1", "galerna: 2", "1: galerna: expected 1, found 2"),
        (
            "duration_s: 10",
            "duration_s: 10\nduration_s: 20",
            "4: duration_s: given twice, first in",
        ),
        ("  model: bem", "\tmodel: bem", "9: not valid YAML"),
        ("  model: bem", "\tmodel: bem", "indent with spaces"),
        ("  model: bem", "  tip_loss: maybe", "9: aerodynamics.tip_loss: expected true or false"),
        ("interval_s: 0.1", "channels: x", "14: outputs.channels: expected a list, found 'x'"),
        ("operation:", "operation: steady\nx:", "10: operation: expected a mapping of keys"),
        ("time_step_s: 0.05", "seed: 1.5", "4: seed: expected a whole number, found 1.5"),
        ("[0, 2]", "[0, x]", "12: operation.pitch_deg.values[1]: expected a number, found 'x'"),
        ("8.0", "[8.0, 9.0]", "expected a number, found a list of 2"),
        ("8.0", "true", "6: inflow.wind_speed_m_s: expected a number, found true"),
        ("8.0", '"8.0"', "6: inflow.wind_speed_m_s: expected a number, found '8.0'"),
        ("  model: bem", "  tip_loss: 1", "9: aerodynamics.tip_loss: expected true or false"),
        ("time_step_s: 0.05", 'seed: "1"', "seed: expected a whole number, found '1'"),
        (
            "9.16",
            "[9.16, 9]",
            "11: operation.rotor_speed_rpm: expected a number or a series, found",
        ),
        ("{time_s: [0, 5], values: [0, 2]}", "[]", "pitch_deg: expected 1 value or more, found 0"),
        ("{kind: power_law, exponent: 0.2}", "0.2", "7: inflow.shear: expected a mapping of keys"),
        (
            "interval_s: 0.1",
            "interval_s: 4\n  start_s: 9",
            "start_s: 9 s leaves no record: the last",
        ),
        ("duration_s: 10", "duration_s: 1e308", "3: duration_s: 1e+308 s are too many time steps"),
        ("  shear", BOX.format("[64, 8]"), "7: inflow.turbulence.points[2]: this value is missing"),
        ("model: bem", "model: vortex", "9: aerodynamics.model: expected 'bem', 'vortex_lattice'"),
        ("model: bem", "model: vortex", "did you mean 'vortex_lattice'"),
        ("model: bem", VORTEX + "tip_loss: true", "10: aerodynamics.tip_loss: unknown key"),
        ("model: bem", VORTEX + "wake_stp_deg: 5", "did you mean 'wake_step_deg'"),
        ("model: bem", VORTEX + "wake: fixed", "wake: expected 'free' or 'prescribed', found 'fix"),
        (
            "model: bem",
            VORTEX + "probes_m: [[0, 1]]",
            "10: aerodynamics.probes_m[0][2]: this value",
        ),
        (
            "model: bem",
            VORTEX + "tree_error: 0.5",
            "tree_error: expected less than or equal to 0.1",
        ),
        (
            "model: bem",
            VORTEX + "wake_revolutions: 3\n  wake_length_diameters: 2",
            "aerodynamics: give wake_revolutions or wake_length_diameters, not both",
        ),
        ("model: bem", VORTEX + PLANES.format("a/b"), "planes[0].name: expected letters, digits"),
        (
            "model: bem",
            VORTEX + PLANES.format("wake"),
            "flow_output: no plane may have the name 'wa",
        ),
        (
            "model: bem",
            VORTEX + "flow_output: {interval_s: 0.12}",
            "aerodynamics.flow_output.interval_s: 0.12 s is not a whole number of time steps",
        ),
        (
            "  shear",
            BOX.format("[8, 8, 8, 8]"),
            "7: inflow.turbulence.points: expected 3 values at",
        ),
        ("outputs:", "<<: {seed: 2}\noutputs:", "13: <<: keys must be plain names"),
    ],
)
def test_what_is_wrong_is_said(wrong, right, message):
    assert wrong in GOOD
    assert message in refused(GOOD.replace(wrong, right, 1))


def test_a_run_shorter_than_the_usual_interval_has_a_record():
    text = GOOD.replace("duration_s: 10", "duration_s: 0.02").replace("0.05", "0.001")
    assert parse(text.replace("outputs:\n  interval_s: 0.1\n", "")).case.record_every == 20


def test_a_missing_key_says_what_it_is_for():
    assert "duration_s: this key is missing\n  Simulated time." in refused(
        GOOD.replace("duration_s: 10\n", "")
    )


def test_all_problems_come_at_once():
    text = GOOD.replace("turbine:", "turbin:").replace("8.0", "fast").replace("0.1", "-1")
    with pytest.raises(CaseError) as caught:
        parse(text, "bad.yaml")
    message = str(caught.value)
    assert message.startswith("bad.yaml: 4 problems")
    lines = [line for line in message.splitlines() if line.startswith("  line")]
    assert [line.split(":")[0] for line in lines] == [
        "  line 1",
        "  line 2",
        "  line 6",
        "  line 14",
    ]
    assert caught.value.exit_code == 2


def test_a_block_that_names_no_model_is_for_blade_element_momentum():
    case = parse(GOOD.replace("model: bem", "tip_loss: false")).case
    assert case.aerodynamics == BemOptions(tip_loss=False)


def test_one_line_chooses_the_vortex_lattice():
    case = parse(GOOD.replace("model: bem", "model: vortex_lattice")).case
    assert case.aerodynamics == VortexLatticeOptions()
    assert load(case).case == case


def test_a_dictionary_is_a_case_too():
    loaded = load(
        {
            "galerna": 1,
            "turbine": "nrel5mw",
            "duration_s": np.float64(1.0),
            "inflow": {"wind_speed_m_s": 8},
            "operation": {"rotor_speed_rpm": 9.0, "pitch_deg": np.array([0.0, 1.0, 2.0])},
        }
    )
    assert loaded.case.operation.pitch_deg == (0.0, 1.0, 2.0)
    assert loaded.lasting(3.0).case.duration_s == 3.0


def test_a_dictionary_has_no_lines_to_name():
    with pytest.raises(InputError, match=r"^case: turbin: unknown key"):
        load({**parse(GOOD).document.values, "turbin": "x"})


def test_a_case_made_in_python_is_read_back_as_it_is():
    case = parse(GOOD).case
    assert load(case).case == case


def test_a_case_that_is_not_there_is_answered_with_the_nearest_example():
    with pytest.raises(InputError, match="is neither a case file nor a built-in example"):
        load("no_such_case")


def test_an_error_while_building_gets_the_line_of_its_key():
    loaded = parse(GOOD, "good.yaml")
    with pytest.raises(InputError, match=r"good\.yaml:2: turbine: the box: too small"):  # noqa: SIM117
        with loaded.blame("turbine"):
            raise InputError("the box", "too small")


def test_an_alias_bomb_is_refused():
    layers = "\n".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 9))
    assert "too many values" in refused(f"a0: &a0 [x]\n{layers}\n")


def test_a_list_that_holds_itself_is_refused():
    assert "aliases that refer to themselves" in refused("a: &a [*a]\n")


def test_nesting_without_end_is_refused():
    assert "nested too deep" in refused("a: " + "[" * 500)


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_damaged_cases_are_refused_and_never_crash(data):
    """Characters dropped, changed or put in: a case, or an InputError."""
    text = list(GOOD)
    for _ in range(data.draw(st.integers(1, 6))):
        i = data.draw(st.integers(0, len(text) - 1))
        text[i] = data.draw(
            st.sampled_from(["", " ", "\t", "\n", ":", "[", "{", "&a", "*a", "-", "9", "x", "\0"])
        )
    try:
        case = parse("".join(text)).case
    except InputError:
        return
    assert isinstance(case, Case)


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused(text):
    try:
        parse_document(text, "any")
    except InputError:
        return


def test_a_misspelt_word_for_the_structure_is_told():
    with pytest.raises(InputError, match=r"'flexible', 'rigid' or a block, found 'flexable'"):
        load({
            "galerna": 1, "turbine": "nrel5mw", "duration_s": 1, "structure": "flexable",
            "inflow": {"wind_speed_m_s": 8}, "control": "baseline",
        })  # fmt: skip
