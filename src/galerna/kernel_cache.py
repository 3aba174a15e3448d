"""Keeps compiled kernels true to the sources.

Numba caches a kernel beside its module and compiles it again when that file changes, but
not when a kernel that it calls in another file does. So all of galerna's kernels are
dropped when any source of the package has changed since they were compiled.
"""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

PACKAGE = Path(__file__).parent
STAMP = "kernels.stamp"


def drop_stale_kernels(package: Path = PACKAGE) -> bool:
    """Delete cached kernels that may be older than the sources; True if some were.

    Where the package cannot be written to, Numba caches elsewhere and nothing is done.
    """
    sources = sorted(package.rglob("*.py"))
    facts = [(str(p.relative_to(package)), (s := p.stat()).st_mtime_ns, s.st_size) for p in sources]
    now = sha256(repr(facts).encode()).hexdigest()
    stamp = package / "__pycache__" / STAMP
    try:
        if stamp.is_file() and stamp.read_text() == now:
            return False
        stale = list(package.rglob("*.nb[ic]"))
        for kernel in stale:
            kernel.unlink(missing_ok=True)
        stamp.parent.mkdir(exist_ok=True)
        stamp.write_text(now)
    except OSError:
        return False
    return bool(stale)
