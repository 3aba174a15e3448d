"""Draws the figures of a page."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from validation.framework import NotRunError

FOLDER = Path(__file__).parent / "figures"


def draw_all(
    figures: Mapping[str, Callable[[], Figure]], names: Sequence[str] | None, dots_per_inch: int
) -> Path:
    """Draw the figures of these names, or all; what needs another program is left out."""
    for name in names or figures:
        try:
            figure = figures[name]()
        except NotRunError as reason:
            print(f"{name}: left out, {reason}", file=sys.stderr)
            continue
        figure.savefig(FOLDER / f"{name}.png", dpi=dots_per_inch)
    return FOLDER
