"""Keeps compiled kernels true to the sources.

Numba caches a kernel beside its module and compiles it again when that file changes, but
not when a kernel that it calls in another file does, or a constant that it has from there. So
the kernels of a module are dropped when the module, or one that it imports, has changed.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Iterator, Mapping, Set
from pathlib import Path

PACKAGE = Path(__file__).parent
STAMP = "kernels.stamp"

Facts = dict[str, list[int]]  #: of every source by its path in the package: time of change, size


def drop_stale_kernels(package: Path = PACKAGE) -> bool:
    """Delete cached kernels that may be older than the sources; True if some were.

    Where the package cannot be written to, Numba caches elsewhere and nothing is done.
    """
    now = _facts(package)
    stamp = package / "__pycache__" / STAMP
    try:
        text = stamp.read_text() if stamp.is_file() else ""
        if text == json.dumps(now):
            return False
        stale = [kernel for path in _stale(package, _read(text), now) for kernel in _kernels(path)]
        for kernel in stale:
            kernel.unlink(missing_ok=True)
        stamp.parent.mkdir(exist_ok=True)
        stamp.write_text(json.dumps(now))
    except OSError:
        return False
    return bool(stale)


def _facts(package: Path) -> Facts:
    paths = sorted(package.rglob("*.py"))
    stats = ((path, path.stat()) for path in paths)
    return {str(p.relative_to(package)): [s.st_mtime_ns, s.st_size] for p, s in stats}


def _read(stamp: str) -> Facts:
    """The facts of a stamp; none where there is none, or of another kind."""
    try:
        facts = json.loads(stamp)
    except ValueError:
        return {}
    return facts if isinstance(facts, dict) else {}


def _kernels(module: Path) -> Iterator[Path]:
    """What Numba keeps beside a module."""
    return module.parent.glob(f"__pycache__/{module.stem}.*.nb[ic]")


def _stale(package: Path, before: Facts, now: Facts) -> Iterator[Path]:
    """Modules that have changed, or that reach a changed one by their imports."""
    changed = {name for name in before.keys() | now.keys() if before.get(name) != now.get(name)}
    imports = {name: _imports(package, name) for name in now}
    return (package / name for name in now if not changed.isdisjoint(_reached(name, imports)))


def _reached(name: str, imports: Mapping[str, Set[str]]) -> set[str]:
    """A module and all that it imports, and they in turn."""
    reached, ahead = {name}, [name]
    while ahead:
        new = imports.get(ahead.pop(), set()) - reached
        reached |= new
        ahead += new
    return reached


def _imports(package: Path, name: str) -> set[str]:
    """Modules of the package that one of them imports; those that are gone too."""
    try:
        tree = ast.parse((package / name).read_bytes())
    except SyntaxError:  # as it stands it cannot be imported
        return set()
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found.update(entry.name for entry in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = _absolute(package, name, node)
            found |= {module, *(f"{module}.{entry.name}" for entry in node.names)}
    inside = (entry.split(".")[1:] for entry in found if entry.split(".")[0] == package.name)
    return {file for parts in inside for file in _files(parts)} - {name}


def _absolute(package: Path, name: str, node: ast.ImportFrom) -> str:
    """The module that a ``from`` names, dots at its front or not."""
    if not node.level:
        return node.module or ""
    above = (package.name, *Path(name).parts[: -node.level])
    return ".".join([*above, *([node.module] if node.module else [])])


def _files(parts: list[str]) -> tuple[str, ...]:
    """The two files that a dotted name below the package may stand for."""
    folder = "/".join(parts)
    return (f"{folder}.py", f"{folder}/__init__.py") if parts else ("__init__.py",)
