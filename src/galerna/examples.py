"""The built-in examples: cases that run by name, and scripts, as users copy them."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).parent


def folder() -> Path:
    """The examples' folder: inside an installed package, or at the root of a checkout."""
    installed = _PACKAGE / "_examples"
    return installed if installed.is_dir() else _PACKAGE.parents[1] / "examples"


def case_names() -> list[str]:
    """Names of the built-in cases."""
    return sorted(path.stem for path in folder().glob("*.yaml"))


def case_path(name: str) -> Path:
    """The file of a built-in case."""
    return folder() / f"{name}.yaml"
