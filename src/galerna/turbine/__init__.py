"""What is simulated: plain data, no numerics."""

from __future__ import annotations

from pathlib import Path

from galerna.errors import InputError, did_you_mean
from galerna.turbine import library
from galerna.turbine.library import names
from galerna.turbine.model import Turbine

__all__ = ["Turbine", "load", "names"]


def load(name_or_path: str | Path) -> Turbine:
    """A built-in turbine by name, or one from a windIO v2 file (.yaml) or OpenFAST deck (.fst).

    Raises InputError.
    """
    from galerna.turbine import windio

    if str(name_or_path) in names():
        return windio.read(library.file(str(name_or_path)), validate=False)
    path = Path(name_or_path)
    if path.stem in names() and not path.exists():
        raise InputError(str(path), "is not there", f"the built-in turbine is {path.stem!r}")
    match path.suffix.lower():
        case ".yaml" | ".yml":
            return windio.read(path)
        case ".fst":
            from galerna.turbine import openfast

            return openfast.read(path)
        case _:
            raise InputError(
                f"turbine {str(name_or_path)!r}",
                "is neither a built-in turbine nor a windIO (.yaml) or OpenFAST (.fst) file",
                did_you_mean(str(name_or_path), names()),
            )
