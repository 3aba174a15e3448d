"""What the steady tools ask of their arguments."""

from __future__ import annotations

from galerna.errors import InputError
from galerna.turbine.model import Turbine


def require_turbine(turbine: object) -> None:
    """InputError where a name or a path stands for the turbine that was to be loaded from it."""
    if not isinstance(turbine, Turbine):
        found = repr(str(turbine)) if hasattr(turbine, "__fspath__") else repr(turbine)
        hint = f"galerna.load_turbine({found}) makes one of a built-in name or a file"
        raise InputError("turbine", f"expected a Turbine, found {found}", hint)
