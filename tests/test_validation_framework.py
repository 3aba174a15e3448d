"""The judge itself: differences, verdicts, selection."""

import json
import math

import numpy as np
import pytest

from galerna.errors import InputError
from galerna.validating import judge
from validation.framework import (
    Case,
    Check,
    NotRunError,
    as_records,
    page,
    run_case,
    select,
    write_json,
)


def check(value, tolerance=0.1, relative=True):
    return Check("x", value, 2.0, "arithmetic", tolerance=tolerance, relative=relative)


def test_a_relative_difference_is_a_fraction_of_the_reference():
    assert check(2.1).difference == pytest.approx(0.05)
    assert check(2.1, relative=False).difference == pytest.approx(0.1)


def test_verdicts():
    assert check(2.19).passed is True
    assert check(2.21).passed is False
    assert check(math.nan).passed is False
    assert check(5.0, tolerance=None).passed is None


def test_an_error_in_a_case_is_a_failed_outcome_with_its_text():
    def broken():
        raise ValueError("no such polar")

    outcome = run_case(Case("broken", "rotor", "Broken", broken, 1))
    assert outcome.failed
    assert "no such polar" in outcome.error
    assert as_records([outcome])[0]["passed"] is False
    assert "no such polar" in page([outcome])


def test_a_case_that_lacks_another_program_is_left_out_and_says_so():
    def lacking():
        raise NotRunError("needs the package rosco")

    outcome = run_case(Case("lacking", "machine", "Lacking", lacking, 1))
    assert not outcome.failed
    (record,) = as_records([outcome])
    assert (record["passed"], record["source"]) == (None, "needs the package rosco")
    assert "Left out: needs the package rosco" in page([outcome])


def test_selection_by_group_or_name_and_a_misspelt_one_is_answered():
    cases = [Case(n, g, n, list, 1) for n, g in [("a-b", "rotor"), ("c-d", "vortex")]]
    assert [c.name for c in select(cases, ["vortex"])] == ["c-d"]
    assert [c.name for c in select(cases, ["a-b"])] == ["a-b"]
    assert len(select(cases, [])) == 2
    with pytest.raises(InputError, match="rotor"):
        select(cases, ["rotr"])


def test_numbers_of_numpy_go_into_json(tmp_path):
    figure = Check("x", np.float32(2.1), np.float64(2.0), "arithmetic", np.float32(0.1))
    outcome = run_case(Case("a", "rotor", "A", lambda: [figure], 1))
    write_json([outcome], tmp_path / "out.json")
    (record,) = json.loads((tmp_path / "out.json").read_text())
    assert record["passed"] is True
    assert record["difference"] == pytest.approx(0.1, rel=1e-5)


def test_rows_of_one_name_stand_under_their_own_references(capsys):
    checks = [
        Check("power", 1.0, 1.0, "Jonkman (2009)", 0.1),
        Check("thrust", 2.0, 2.0, "Jonkman (2009)", 0.1),
        Check("power", 1.1, 1.0, "momentum theory", 0.2),
    ]
    case = Case("two", "rotor", "Two references", lambda: checks, 1)
    assert judge([case], None, None) == 0
    told = capsys.readouterr().out
    first, second = told.index("Reference: Jonkman (2009)"), told.index("Reference: momentum")
    assert told.index("rotor: Two references (two") < first < told.index("thrust") < second
    assert told.count("Reference:") == 2
    assert told[first:second].count("power") == told[second:].count("power") == 1
