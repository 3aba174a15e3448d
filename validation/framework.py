"""Cases that hold galerna against published, analytical or independent results.

A case is a function that returns ``Check``s. A module lists its cases in
``CASES``; ``validation/__init__.py`` lists the modules. Tolerances stand in the
code, with their reason, before the case runs. A check without a tolerance is
shown and not judged. A case that cannot run here, for want of another program, raises
``NotRunError`` with the reason.
"""

from __future__ import annotations

import json
import math
import time
import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from galerna.errors import InputError, did_you_mean


class NotRunError(Exception):
    """A case needs what is not installed here; says what, and how to get it."""


@dataclass(frozen=True)
class Check:
    """One number beside its reference.

    ``relative`` says that ``tolerance`` is a fraction of the reference, otherwise
    it is in ``unit``. ``tolerance`` None: shown, not judged. ``source`` names the
    publication or the derivation of the reference.
    """

    quantity: str
    value: float
    reference: float
    source: str
    tolerance: float | None = None
    unit: str = ""
    relative: bool = False

    @property
    def difference(self) -> float:
        """Value minus reference, as a fraction of the reference where ``relative``."""
        change = self.value - self.reference
        return change / abs(self.reference) if self.relative else change

    @property
    def passed(self) -> bool | None:
        """Whether the difference is within the tolerance; None if not judged."""
        if self.tolerance is None:
            return None
        return bool(math.isfinite(self.value) and abs(self.difference) <= self.tolerance)


def statement(text: str, holds: bool, source: str, *, judged: bool = False) -> Check:
    """A sentence of the literature, 1 where galerna's figures bear it out and 0 where not."""
    return Check(text, float(holds), 1.0, source, 0.0 if judged else None, "1: holds")


@dataclass(frozen=True)
class Case:
    """A named validation case: ``run`` computes its checks; ``seconds`` is its usual cost.

    ``story`` is what a reader of the validation page should know: settings,
    known flaws of the reference, and what a failed check means.
    """

    name: str
    group: str
    title: str
    run: Callable[[], Iterable[Check]]
    seconds: float
    story: str = ""


@dataclass(frozen=True)
class Outcome:
    """What a case gave: its checks, or the error that stopped it, or why it was left out."""

    case: Case
    checks: tuple[Check, ...]
    seconds: float
    error: str = ""
    left_out: str = ""

    @property
    def failed(self) -> bool:
        return bool(self.error) or any(check.passed is False for check in self.checks)


def select(cases: Sequence[Case], names: Iterable[str]) -> list[Case]:
    """The cases of the groups or names given, in their own order; all where none is given."""
    names = list(names)
    valid = {case.name for case in cases} | {case.group for case in cases}
    for name in names:
        if name not in valid:
            raise InputError(f"validate {name}", "no such case or group", did_you_mean(name, valid))
    return [case for case in cases if not names or {case.name, case.group} & set(names)]


def run_case(case: Case) -> Outcome:
    """Run one case; an error in it is an outcome, not the end of the others."""
    start = time.perf_counter()
    checks: tuple[Check, ...] = ()
    error = left_out = ""
    try:
        checks = tuple(case.run())
    except NotRunError as reason:
        left_out = str(reason)
    except Exception:
        error = traceback.format_exc()
    return Outcome(case, checks, time.perf_counter() - start, error, left_out)


def as_records(outcomes: Iterable[Outcome]) -> list[dict[str, object]]:
    """One flat record per check, as ``galerna validate --json`` writes them."""
    records: list[dict[str, object]] = []
    for outcome in outcomes:
        case = outcome.case
        records += [
            {
                "case": case.name,
                "group": case.group,
                "quantity": check.quantity,
                "unit": check.unit,
                "reference": float(check.reference),
                "source": check.source,
                "value": float(check.value),
                "difference": float(check.difference),
                "relative": check.relative,
                "tolerance": None if check.tolerance is None else float(check.tolerance),
                "passed": check.passed,
            }
            for check in outcome.checks
        ]
        if outcome.error:
            records.append({"case": case.name, "group": case.group, "quantity": "runs to its end",
                            "unit": "", "reference": None, "source": "", "value": None,
                            "difference": None, "relative": False, "tolerance": None,
                            "passed": False, "error": outcome.error})  # fmt: skip
        if outcome.left_out:
            records.append({"case": case.name, "group": case.group, "quantity": "left out",
                            "unit": "", "reference": None, "source": outcome.left_out,
                            "value": None, "difference": None, "relative": False,
                            "tolerance": None, "passed": None})  # fmt: skip
    return records


def write_json(outcomes: Iterable[Outcome], path: Path) -> None:
    """Write the records of ``as_records`` to a JSON file."""
    path.write_text(json.dumps(as_records(outcomes), indent=1) + "\n")


def verdict(check: Check) -> str:
    """The word for a check in a table."""
    return {True: "pass", False: "FAIL", None: "shown"}[check.passed]


def row(check: Check) -> tuple[str, str, str, str, str, str]:
    """Quantity, reference, value, difference, tolerance and verdict as text."""
    unit = f" [{check.unit}]" if check.unit else ""

    def amount(x: float | None) -> str:
        if x is None or math.isnan(x):
            return "-"
        return f"{100 * x:.3g} %" if check.relative else f"{x:.4g}"

    return (
        check.quantity + unit,
        "-" if math.isnan(check.reference) else f"{check.reference:.6g}",
        f"{check.value:.6g}",
        amount(check.difference),
        amount(check.tolerance),
        verdict(check),
    )


HEADINGS = ("quantity", "reference", "galerna", "difference", "tolerance", "verdict")


def by_source(checks: Iterable[Check]) -> dict[str, list[Check]]:
    """Checks by the source of their reference, in the order in which those come first."""
    groups: dict[str, list[Check]] = {}
    for check in checks:
        groups.setdefault(check.source, []).append(check)
    return groups


def page(outcomes: Sequence[Outcome]) -> str:
    """The validation page of the documentation, in Markdown."""
    judged = [c.passed for o in outcomes for c in o.checks if c.passed is not None]
    lines = [
        "# Validation",
        "",
        "Generated by `galerna validate --page docs/validation.md`. Tolerances stand in "
        "`validation/` beside the reason for them; a failed check stays on this page.",
        "",
        f"{len(outcomes)} cases, {sum(judged)} of {len(judged)} judged checks pass.",
    ]
    for outcome in outcomes:
        case = outcome.case
        lines += ["", f"## {case.title}", "", f"`galerna validate {case.name}`"]
        if case.story:
            lines += ["", " ".join(case.story.split())]
        if outcome.left_out:
            lines += ["", f"Left out: {outcome.left_out}"]
        if outcome.error:
            lines += ["", "The case stopped with an error:", "", "```", outcome.error, "```"]
        for source, checks in by_source(outcome.checks).items():
            lines += ["", f"Reference: {source}", "", "| " + " | ".join(HEADINGS) + " |"]
            lines += ["|---|---:|---:|---:|---:|---|"]
            lines += [
                "| " + " | ".join(cell.replace("|", "\\|") for cell in row(check)) + " |"
                for check in checks
            ]
    return "\n".join(lines) + "\n"
