"""Kernels never outlive the sources they were compiled from."""

import subprocess
import sys

import pytest

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


@pytest.fixture
def package(tmp_path):
    """Two kernels, one of which calls the other, and a module that has none; compiled."""
    package = tmp_path / "trial"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "inner.py").write_text(INNER.format(1))
    (package / "outer.py").write_text(OUTER)
    (package / "other.py").write_text("from . import outer\n")
    assert drop_stale_kernels(package) is False  # nothing compiled yet
    assert run_outer(tmp_path).strip() == "2"
    assert drop_stale_kernels(package) is False  # nothing changed
    return package


def kernels(package) -> set[str]:
    return {path.name.split(".")[0] for path in package.glob("__pycache__/*.nbi")}


def test_a_change_in_a_called_kernel_reaches_its_caller(package):
    (package / "inner.py").write_text(INNER.format(100))
    assert drop_stale_kernels(package) is True
    assert run_outer(package.parent).strip() == "101"


def test_kernels_stay_where_nothing_that_they_read_has_changed(package):
    (package / "other.py").write_text("from . import outer  # and a word more\n")
    (package / "new.py").write_text("from trial.outer import outer\n")
    assert drop_stale_kernels(package) is False
    assert kernels(package) == {"inner", "outer"}


def test_a_caller_goes_and_what_it_calls_stays(package):
    (package / "outer.py").write_text(OUTER + "\n")
    assert drop_stale_kernels(package) is True
    assert kernels(package) == {"inner"}


def test_a_module_that_is_gone_or_half_written_stops_nothing(package):
    (package / "other.py").unlink()
    (package / "half.py").write_text("def half(:\n")
    assert drop_stale_kernels(package) is False
    (package / "inner.py").unlink()
    assert drop_stale_kernels(package) is True
    assert kernels(package) == {"inner"}  # of a module that is gone: never read again
