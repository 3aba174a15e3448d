"""Turbines that come with galerna: windIO files, each with a companion of sources."""

from __future__ import annotations

from pathlib import Path

FOLDER = Path(__file__).parent


def names() -> tuple[str, ...]:
    """Names of the built-in turbines."""
    return tuple(sorted(p.stem for p in FOLDER.glob("*.yaml") if "." not in p.stem))


def file(name: str) -> Path:
    """The windIO file of a built-in turbine."""
    return FOLDER / f"{name}.yaml"
