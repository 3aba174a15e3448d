"""Dependencies point one way, as the map of the code says."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "src" / "galerna"
BASE = {"errors", "units", "contract"}
PARTS = {"structure", "aero", "inflow", "hydro", "control"}
ALLOWED = {
    "errors": set(),
    "units": set(),
    "contract": set(),
    "turbine": {"errors", "units"},
    **{part: BASE | {"turbine"} for part in PARTS},
}
SHARED = {"structure.frames"}  # the one module of a part that every part may read


def imports_of(path: Path) -> set[str]:
    """Modules of galerna that a file imports, without the leading ``galerna.``."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            if node.module == "galerna":
                names |= {alias.name for alias in node.names}
            elif node.module.startswith("galerna."):
                names.add(node.module.removeprefix("galerna."))
        elif isinstance(node, ast.Import):
            names |= {
                a.name.removeprefix("galerna.") for a in node.names if a.name.startswith("galerna.")
            }
    return names


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda p: str(p.name))
def test_imports_follow_the_map(path):
    part = path.relative_to(PACKAGE).with_suffix("").parts[0]
    if part not in ALLOWED:
        return
    for name in imports_of(path) - SHARED:
        top = name.split(".")[0]
        assert top == part or top in ALLOWED[part], f"{path} may not import galerna.{name}"
