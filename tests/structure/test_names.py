"""The public names of the structure module."""

import subprocess
import sys

import pytest

import galerna.structure


def test_every_public_name_is_there_and_no_other():
    for name in galerna.structure._HOMES:
        assert getattr(galerna.structure, name) is not None
        assert name in dir(galerna.structure)
    with pytest.raises(AttributeError, match="'Struktur'"):
        _ = galerna.structure.Struktur


def test_the_names_cost_nothing_until_they_are_used():
    code = "import sys, galerna.structure; assert 'numba' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
