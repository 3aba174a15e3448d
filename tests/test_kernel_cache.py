"""Kernels never outlive the sources they were compiled from."""

import subprocess
import sys

from galerna.kernel_cache import drop_stale_kernels

INNER = "from numba import njit\n\n\n@njit(cache=True)\ndef inner(x):\n    return x + {}\n"
OUTER = """from numba import njit

from trial.inner import inner


@njit(cache=True)
def outer(x):
    return inner(x)


print(outer(1))
"""


def run_outer(folder) -> str:
    command = [sys.executable, "-c", "import trial.outer"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout


def test_a_change_in_a_called_kernel_reaches_its_caller(tmp_path):
    package = tmp_path / "trial"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "inner.py").write_text(INNER.format(1))
    (package / "outer.py").write_text(OUTER)
    assert drop_stale_kernels(package) is False  # nothing compiled yet
    assert run_outer(tmp_path).strip() == "2"
    assert drop_stale_kernels(package) is False  # nothing changed
    (package / "inner.py").write_text(INNER.format(100))
    assert drop_stale_kernels(package) is True
    assert run_outer(tmp_path).strip() == "101"
