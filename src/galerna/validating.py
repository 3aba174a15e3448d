"""Finds the validation cases, in an installed package or in a checkout, and judges them."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from galerna.errors import InputError
from galerna.report import tables

_CHECKOUT = Path(__file__).parents[2]


def package() -> str:
    """Name of the package with the cases; InputError where there is none."""
    if find_spec("galerna._validation") is not None:
        return "galerna._validation"
    if not (_CHECKOUT / "validation" / "framework.py").is_file():
        raise InputError("validate", "this installation has no validation cases")
    if str(_CHECKOUT) not in sys.path:
        sys.path.append(str(_CHECKOUT))
    return "validation"


def chosen(names: Sequence[str]) -> list[Any]:
    """The cases of the groups or names given; all where none is given."""
    framework = import_module(f"{package()}.framework")
    return framework.select(import_module(package()).cases(), names)


def judge(cases: Sequence[Any], json_file: Path | None, page: Path | None) -> int:
    """Run cases, print a table for each, write the files asked for; 1 if a check fails."""
    framework = import_module(f"{package()}.framework")
    outcomes = []
    for case in cases:
        outcome = framework.run_case(case)
        outcomes.append(outcome)
        title = f"{case.group}: {case.title} ({case.name}, {outcome.seconds:.1f} s)"
        print(f"\n{title}")
        for source, checks in framework.by_source(outcome.checks).items():
            rows = map(framework.row, checks)
            tables.print_rows(f"Reference: {source}", framework.HEADINGS, rows)
        if outcome.left_out:
            print(f"left out: {outcome.left_out}")
        if outcome.error:
            print(outcome.error, file=sys.stderr)
    if json_file is not None:
        framework.write_json(outcomes, json_file)
    if page is not None:
        page.write_text(framework.page(outcomes))
    failed = list(_failed(outcomes))
    total = "1 case" if len(outcomes) == 1 else f"{len(outcomes)} cases"
    print(f"{total}, {len(failed)} with a failed check" + ":" * bool(failed))
    for name in failed:
        print(f"  {name}")
    return 1 if failed else 0


def _failed(outcomes: Sequence[Any]) -> Iterator[str]:
    return (outcome.case.name for outcome in outcomes if outcome.failed)
