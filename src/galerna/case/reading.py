"""From a YAML file, a built-in example's name or a dictionary to a checked case."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from galerna import examples
from galerna.case.document import (
    CaseError,
    Document,
    KeyPath,
    Problem,
    parse_document,
    read_document,
)
from galerna.case.options import Case
from galerna.case.problems import problems_of
from galerna.errors import InputError, did_you_mean

MOST_STEPS = 1e12


@dataclass(frozen=True)
class LoadedCase:
    """A case, the text it came from, and the folder that its file names start from."""

    case: Case
    document: Document
    folder: Path

    @property
    def name(self) -> str:
        """The case's own name, or that of its file."""
        return self.case.name or Path(self.document.name).stem

    def lasting(self, duration: float) -> LoadedCase:
        """The same case over another duration, s; InputError where the rest does not suit it."""
        values = {**self.document.values, "duration_s": duration}
        document = replace(self.document, values=values)
        try:
            return LoadedCase(_validate(document), document, self.folder)
        except CaseError as error:  # the case alone was right: the new duration is to blame
            what = "; ".join(f"{problem.key}: {problem.what}" for problem in error.problems)
            hint = "give another duration, or change the case"
            raise InputError(f"--duration {duration:g}", what, hint) from error

    @contextmanager
    def blame(self, *path: str | int) -> Iterator[None]:
        """Say that an InputError raised inside comes from the key ``path`` of this case."""
        try:
            yield
        except CaseError:
            raise
        except InputError as error:
            what = error.what if error.where == path[-1] else f"{error.where}: {error.what}"
            raise CaseError(self.document, [Problem(path, what, error.hint)]) from error


def load(case: str | Path | Mapping[str, Any] | Case) -> LoadedCase:
    """A case from a YAML file, the name of a built-in example, or a dictionary of the same keys.

    A ``Case`` made in Python will do as well. Raises InputError with everything that is wrong.
    """
    if isinstance(case, Case):
        case = case.model_dump(mode="json", by_alias=True, exclude_unset=True)
    if isinstance(case, Mapping):
        values = json.loads(json.dumps(case, default=_plain))
        text = json.dumps(values, indent=2)
        document = Document("case", text, values)
        return LoadedCase(_validate(document), document, Path.cwd())
    path = Path(case)
    if path.is_file():
        return _from_document(read_document(path), path.resolve().parent)
    if str(case) in examples.case_names():
        return _from_document(read_document(examples.case_path(str(case))), examples.folder())
    hint = did_you_mean(str(case), examples.case_names())
    raise InputError(str(case), "is neither a case file nor a built-in example", hint)


def parse(text: str, name: str = "case.yaml", folder: str | Path = ".") -> LoadedCase:
    """A case from YAML text; InputError with everything that is wrong."""
    return _from_document(parse_document(text, name), Path(folder))


def _from_document(document: Document, folder: Path) -> LoadedCase:
    return LoadedCase(_validate(document), document, folder)


def _validate(document: Document) -> Case:
    try:
        # as JSON, where strict means that true is no number and "10" neither
        case = Case.model_validate_json(json.dumps(document.values), strict=True)
    except ValidationError as error:
        raise CaseError(document, problems_of(error, Case, document.values)) from None
    problems = list(_contradictions(case))
    if problems:
        raise CaseError(document, problems)
    return case


def _contradictions(case: Case) -> Iterator[Problem]:
    """What is wrong between keys that are each right."""
    step, duration, outputs = case.time_step_s, case.duration_s, case.outputs
    if duration < step:
        what = f"{duration:g} s is less than one time_step_s of {step:g} s"
        yield Problem(("duration_s",), what)
    if duration / step > MOST_STEPS:
        yield Problem(("duration_s",), f"{duration:g} s are too many time steps of {step:g} s")
        return
    last = round(duration / step) // case.record_every * case.record_every * step
    if outputs.start_s >= duration:
        what = f"{outputs.start_s:g} s leaves nothing of the {duration:g} s of duration_s"
        yield Problem(("outputs", "start_s"), what)
    elif outputs.start_s > last:
        what = f"{outputs.start_s:g} s leaves no record: the last one is at {last:g} s"
        yield Problem(("outputs", "start_s"), what)
    if outputs.interval_s is not None:
        path = ("outputs", "interval_s")
        if outputs.interval_s > duration:
            what = f"{outputs.interval_s:g} s is longer than duration_s, {duration:g} s"
            yield Problem(path, what)
        yield from _not_whole(path, outputs.interval_s, step)
    flow = getattr(case.aerodynamics, "flow_output", None)
    if flow is not None:
        yield from _not_whole(("aerodynamics", "flow_output", "interval_s"), flow.interval_s, step)


def _not_whole(path: KeyPath, interval: float, step: float) -> Iterator[Problem]:
    """The problem of an interval s that is no whole number of time steps."""
    steps = interval / step
    if abs(steps - round(steps)) > 1e-6 * steps or round(steps) < 1:
        what = f"{interval:g} s is not a whole number of time steps of {step:g} s"
        nearest = max(round(steps), 1) * step
        yield Problem(path, what, f"the nearest is {nearest:g} s")


def _plain(value: Any) -> Any:
    """NumPy numbers and arrays, tuples and paths as JSON knows them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Path):
        return str(value)
    raise InputError("case", f"a {type(value).__name__} cannot stand in a case")
