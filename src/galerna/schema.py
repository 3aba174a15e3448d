"""The JSON schema of case files, from the models that check them: editors complete with it."""

from __future__ import annotations

from typing import Any

from galerna import examples
from galerna.case import Case

FILE = "case.schema.json"  #: stands beside the examples


def case_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a case."""
    schema = Case.model_json_schema(by_alias=True)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$comment": "generated: galerna schema > examples/case.schema.json",
        **schema,
        "title": "galerna case",
    }


def shipped_schema() -> str:
    """The text of the schema that ships with the examples."""
    return (examples.folder() / FILE).read_text(encoding="utf-8")
