"""From what pydantic finds wrong to what a user can act on."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from galerna.case.document import KeyPath, Problem
from galerna.errors import did_you_mean

#: what pydantic calls by Python's names
PLAIN_WORDS = {
    "model_type": "a mapping of keys to values",
    "model_attributes_type": "a mapping of keys to values",
    "dict_type": "a mapping of keys to values",
    "tuple_type": "a list",
    "list_type": "a list",
    "string_type": "a text",
    "float_type": "a number",
    "float_parsing": "a number",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "bool_parsing": "true or false",
    "bool_type": "true or false",
}

#: what a list of a wrong length lacks: the limit it breaks, and in which sense
LENGTHS = {"too_short": ("min_length", "or more"), "too_long": ("max_length", "at most")}


def problems_of(error: ValidationError, model: type[BaseModel], values: Any) -> list[Problem]:
    """One problem for every key of ``values`` that ``model`` refuses."""
    problems: dict[KeyPath, Problem] = {}
    for entry in error.errors(include_url=False):
        path = _path(entry["loc"], values, entry["type"])
        if entry["type"] == "too_short" and any(p[: len(path)] == path for p in problems):
            continue  # its items were refused, and are named
        problems.setdefault(path, _problem(path, entry, model))
    return list(problems.values())


def _path(location: Sequence[str | int], values: Any, kind: str) -> KeyPath:
    """The keys of a location, without the names of union members that pydantic puts between."""
    path: list[str | int] = []
    for part in location:
        known = part in values if isinstance(values, Mapping) else _is_item(values, part)
        if not known:
            continue
        path.append(part)
        values = values[part]
    if kind == "missing":
        path.append(location[-1])
    return tuple(path)


def _is_item(values: Any, part: str | int) -> bool:
    return isinstance(values, Sequence) and isinstance(part, int) and part < len(values)


def _problem(path: KeyPath, entry: Mapping[str, Any], model: type[BaseModel]) -> Problem:
    kind, found, context = entry["type"], entry.get("input"), entry.get("ctx", {})
    if kind == "extra_forbidden":
        names = names_at(model, entry["loc"][:-1])
        return Problem(path, "unknown key", did_you_mean(str(path[-1]), names))
    if kind == "missing":
        noun = "value" if isinstance(path[-1], int) else "key"
        return Problem(path, f"this {noun} is missing", _describe(model, entry["loc"]))
    if kind == "union_tag_not_found":
        return Problem(path, f"needs the key {context['discriminator']}")
    if kind == "literal_error":
        valid = re.findall(r"'([^']*)'", context["expected"])
        hint = did_you_mean(str(found), valid) if valid else ""
        return Problem(path, f"expected {context['expected']}, found {_shown(found)}", hint)
    if kind == "union_tag_invalid":
        valid = re.findall(r"'([^']*)'", context["expected_tags"])
        key = context["discriminator"].strip("'")
        if key.endswith("()"):  # told apart by a function: of a key's value, or of the form
            named = [name for name, value in _items(found) if str(value) == context["tag"]]
            if not named:
                return Problem(path, f"expected a {' or a '.join(valid)}, found {_shown(found)}")
            key = named[0]
        what = f"expected {context['expected_tags']}, found {context['tag']!r}"
        return Problem((*path, key), what, did_you_mean(context["tag"], valid))
    if kind in LENGTHS:
        limit, sense = LENGTHS[kind]
        number, values = context[limit], "value" if context[limit] == 1 else "values"
        what = f"expected {number} {values} {sense}, found {context['actual_length']}"
        return Problem(path, what)
    message = entry["msg"].removeprefix("Value error, ")
    if message.startswith("Input should be "):
        expected = message.removeprefix("Input should be ").split(", unable to")[0]
        expected = PLAIN_WORDS.get(kind, expected)
        return Problem(path, f"expected {expected}, found {_shown(found)}")
    return Problem(path, message[:1].lower() + message[1:])


def _items(value: Any) -> Iterable[tuple[str, Any]]:
    return value.items() if isinstance(value, Mapping) else ()


def _shown(value: Any) -> str:
    """A value as the user wrote it, cut to a line."""
    if isinstance(value, Mapping):
        return "a mapping"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"a list of {len(value)}"
    if isinstance(value, bool):
        return str(value).lower()
    text = "nothing" if value is None else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _describe(model: type[BaseModel], location: Sequence[str | int]) -> str:
    """What a field is for, from its description."""
    for parent in _models_at(model, location[:-1]):
        field = parent.model_fields.get(str(location[-1]))
        if field is not None and field.description:
            return field.description
    return ""


def names_at(model: type[BaseModel], location: Sequence[str | int]) -> set[str]:
    """The keys that are valid at a location of a case."""
    return {
        field.alias or name
        for parent in _models_at(model, location)
        for name, field in parent.model_fields.items()
    }


def _models_at(model: type[BaseModel], location: Sequence[str | int]) -> list[type[BaseModel]]:
    """The models that can stand at a location; a union's member is chosen by its tag."""
    candidates = [model]
    for part in location:
        annotations = [
            field.annotation
            for parent in candidates
            for name, field in parent.model_fields.items()
            if part in (name, field.alias)
        ]
        if annotations:
            candidates = [found for a in annotations for found in _models_in(a)]
        else:
            candidates = [c for c in candidates if _is_tagged(c, part)] or candidates
    return candidates


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from _models_in(inner)


def _is_tagged(model: type[BaseModel], tag: str | int) -> bool:
    """Whether one of the model's fields can only be ``tag``."""
    return any(tag in get_args(field.annotation) for field in model.model_fields.values())
