"""Hold a document against the windIO package's turbine schema, and say clearly what is wrong."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from galerna.errors import InputError, did_you_mean
from galerna.turbine.windio import yamlfile
from galerna.turbine.windio.block import describe, meant
from galerna.turbine.windio.yamlfile import Document, Keys, dotted_path

if TYPE_CHECKING:
    from jsonschema import ValidationError

_TYPO = 0.75  # how alike an unknown key and a valid one must be for the user to have meant it

#: Blocks that describe how a machine is built; galerna reads their elastic properties instead.
_NOT_READ: tuple[Keys, ...] = (
    ("components", "blade", "structure", "webs"),
    ("components", "blade", "structure", "layers"),
    ("components", "blade", "structure", "anchors"),
    ("components", "monopile"),
    ("components", "jacket"),
    ("outputs",),
)


def validate_document(document: Document) -> list[str]:
    """Raise InputError at the first departure from the windIO v2 schema that galerna would feel.

    Returns notes on keys that windIO does not know and that resemble none it knows.
    """
    schema = _schema()
    strangers: dict[Keys, list[str]] = {}
    for keys, valid, welcome in _unknown_keys(document.data, schema, schema, ()):
        name = str(keys[-1])
        if _is_misspelt(name, valid):
            raise document.error(keys, f"unknown key {name!r}", did_you_mean(name, valid))
        if not welcome:
            strangers.setdefault(keys[:-1], []).append(name)
    errors = _schema_errors(document.data)
    if errors:
        more = f" (and {len(errors) - 1} more departures from windIO v2)" if errors[1:] else ""
        raise _explained(document, errors[0], more)
    return [
        f"{dotted_path(keys) or 'file'}: ignored, as windIO v2 has no such keys: {', '.join(names)}"
        for keys, names in strangers.items()
    ]


def _is_misspelt(name: str, valid: list[str]) -> bool:
    """Whether a valid key was meant; WISDEM adds ``inertia_tt`` to ``inertia`` on purpose."""
    if any(name.startswith(f"{key}_") for key in valid):
        return False
    return bool(get_close_matches(name, valid, n=1, cutoff=_TYPO))


def _schema_errors(data: Any) -> list[ValidationError]:
    from jsonschema import Draft7Validator

    found = Draft7Validator(_schema()).iter_errors(data)
    try:
        felt = [e for e in found if not _is_under(tuple(e.absolute_path), _NOT_READ)]
    except RecursionError as e:
        raise InputError("windIO file", "nests too deeply to be a turbine") from e
    return sorted(felt, key=lambda e: [str(k) for k in e.absolute_path])


@cache
def _schema() -> dict[str, Any]:
    spec = find_spec("windIO")
    if spec is None or not spec.submodule_search_locations:
        raise InputError("windIO", "the package is not installed", "pip install windIO")
    folder = Path(next(iter(spec.submodule_search_locations)))
    data = yamlfile.load(folder / "schemas" / "turbine" / "turbine_schema.yaml").data
    return dict(data)


def _unknown_keys(
    data: Any, schema: dict[str, Any], root: dict[str, Any], keys: Keys
) -> Iterator[tuple[Keys, list[str], bool]]:
    """Keys that the schema does not name, those it names there, whether others are welcome."""
    schema = _resolved(schema, root)
    if isinstance(data, dict) and "properties" in schema and not _is_under(keys, _NOT_READ):
        for key, value in data.items():
            if key in schema["properties"]:
                yield from _unknown_keys(value, schema["properties"][key], root, (*keys, key))
            else:
                welcome = schema.get("additionalProperties") is True
                yield (*keys, key), list(schema["properties"]), welcome
    elif isinstance(data, list) and isinstance(schema.get("items"), dict):
        for i, item in enumerate(data):
            yield from _unknown_keys(item, schema["items"], root, (*keys, i))


def _resolved(schema: dict[str, Any], root: dict[str, Any]) -> dict[str, Any]:
    while "$ref" in schema:
        target: Any = root
        for key in schema["$ref"].removeprefix("#/").split("/"):
            target = target[key]
        schema = target
    return schema


def _is_under(keys: Keys, places: tuple[Keys, ...]) -> bool:
    return any(keys[: len(place)] == place for place in places)


def _explained(document: Document, error: ValidationError, more: str) -> InputError:
    keys: Keys = tuple(error.absolute_path)
    match error.validator:
        case "required":
            name = next(k for k in error.validator_value if k not in error.instance)
            return document.error(keys, f"{name!r} is missing{more}", meant(name, error.instance))
        case "type":
            what = f"expected {error.validator_value}, found {describe(error.instance)}"
        case "minimum" | "maximum":
            word = "least" if error.validator == "minimum" else "most"
            what = f"is {error.instance}; the {word} is {error.validator_value}"
        case "enum":
            what = f"found {describe(error.instance)}; valid are {error.validator_value}"
        case _:
            what = error.message if len(error.message) < 200 else error.message[:200] + "..."
    return document.error(keys, what + more)
