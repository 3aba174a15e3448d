"""The first run says that it compiles; the next ones have nothing to say."""

from __future__ import annotations

import logging
import time

import numpy as np
import pytest
from numba import njit

from galerna import compiling


@pytest.fixture
def slow(monkeypatch):
    """Whatever compiles takes long enough to be told of."""
    monkeypatch.setattr(compiling, "SHORT", 0.0)
    compiling.watch()._forget()


def kernels():
    """Two new kernels, one of which calls the other."""

    @njit
    def inner(x):
        return x + 1

    @njit
    def outer(x):
        return inner(x) * inner(2 * x)

    return inner, outer


def test_it_says_once_that_it_compiles_and_then_for_how_long(slow, caplog):
    began = time.perf_counter()
    with caplog.at_level(logging.WARNING, "galerna"), compiling.announced():
        for kernel in kernels():
            kernel(1)
        kernels()[1](np.ones(3))
    elapsed = time.perf_counter() - began
    told = [record.getMessage() for record in caplog.records]
    assert len(told) == 2
    assert told[0].startswith("compiling the kernels, once for this version")
    count, seconds = int(told[1].split()[1]), float(told[1].split()[4])
    assert count >= 4
    assert 0 <= seconds <= elapsed + 0.5


def test_kernels_that_are_there_are_not_told_of(slow, caplog):
    inner, outer = kernels()
    outer(1)
    compiling.watch()._forget()
    with caplog.at_level(logging.WARNING, "galerna"), compiling.announced():
        inner(2), outer(2)
    assert not caplog.records


def test_a_little_compiling_is_not_told_of(monkeypatch, caplog):
    monkeypatch.setattr(compiling, "SHORT", 1e9)
    with caplog.at_level(logging.WARNING, "galerna"), compiling.announced():
        kernels()[1](1)
    assert not caplog.records
