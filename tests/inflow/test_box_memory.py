"""What it takes to make a box, against the box itself, in memory as Python knows it."""

import math
import tracemalloc

import pytest

from galerna.inflow import mann
from galerna.inflow.kaimal import kaimal_box
from galerna.inflow.mann import mann_box
from galerna.inflow.sizing import mean_deviation

SPACING = (4.0, 6.0, 6.5)
USUAL = {"mean_speed": 12.0, "hub_height": 90.0, "seed": 5, "turbulence_intensity": 0.14}
MARGIN = 0.2  #: of a box, for the planes in work and what the interpreter holds


def mann_of(shape, normalise):
    eddies = {"length_scale": 33.6, "shear_parameter": 3.9, "lateral_period": 1.0}
    return mann_box(shape, SPACING, normalise=normalise, **eddies, **USUAL)


def kaimal_of(shape, normalise):
    return kaimal_box(shape, SPACING, normalise=normalise, **USUAL)


def peak_of(action):
    """Most bytes allocated at a time during the action, above those before, and its answer."""
    tracemalloc.start()
    try:
        answer = action()
        return tracemalloc.get_traced_memory()[1], answer
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("normalise", ["theory", "sample"])
@pytest.mark.parametrize(("make", "shape"), [(mann_of, (1024, 16, 16)), (kaimal_of, (512, 40, 40))])
def test_a_box_is_made_in_its_own_memory(make, shape, normalise, monkeypatch):
    """Its modes and its velocities share it: with both side by side the peak was 2.3 boxes."""
    monkeypatch.setattr(mann, "_MODES_AT_ONCE", 1 << 12)  # few for a box of 3 MB, as usual for 300
    make((8, *shape[1:]), normalise)  # what is made once and kept
    peak, box = peak_of(lambda: make(shape, normalise))
    assert peak < (1.0 + MARGIN) * box.data.nbytes


def test_the_deviation_of_a_box_is_found_without_a_copy():
    box = mann_of((1024, 16, 16), "theory")
    peak, deviation = peak_of(lambda: mean_deviation(box))
    assert peak < MARGIN * box.data.nbytes
    variance = box.data[0].astype(float).var(axis=0).mean()
    assert deviation == pytest.approx(math.sqrt(variance), rel=1e-12)
