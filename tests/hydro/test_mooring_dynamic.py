"""Lines by MoorDyn: at rest like catenaries, with damping in motion, pure and resumable."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from galerna.contract import LoadModel, Motion
from galerna.errors import InputError
from galerna.hydro.mooring import MooringLines
from galerna.hydro.mooring.moordyn import DynamicLines
from galerna.hydro.mooring.moordyn_input import input_text
from galerna.hydro.strips import Carrier
from galerna.turbine import load

OC3 = load("nrel5mw_oc3").platform
BODY = Carrier.rigid(OC3)
DEPTH, STEP = 320.0, 0.05


def surging(time: float, size: float = 3.0, period: float = 20.0) -> Motion:
    motion, rate = Motion.at_rest(1), 2.0 * np.pi / period
    motion.position[0, 0] = size * (1.0 - np.cos(rate * time))
    motion.velocity[0, 0] = size * rate * np.sin(rate * time)
    return motion


def march(lines: LoadModel, steps: range) -> list[bytes]:
    out = []
    for k in steps:
        lines.begin_step(STEP * k, STEP, surging(STEP * k))
        lines.loads(STEP * (k + 1), surging(STEP * (k + 3)))  # a trial that is not taken
        found = lines.loads(STEP * (k + 1), surging(STEP * (k + 1)))
        lines.end_step(STEP * (k + 1), surging(STEP * (k + 1)))
        out.append(np.concatenate([found.force[0], found.moment[0]]).tobytes())
    return out


@pytest.fixture(scope="module")
def settled() -> DynamicLines:
    pytest.importorskip("moordyn")
    lines = DynamicLines(OC3.mooring, BODY, DEPTH, segments=8)
    march(lines, range(1))
    return lines


def test_at_rest_like_catenaries(settled):
    assert isinstance(settled, LoadModel)
    quiet = MooringLines(OC3.mooring, BODY, DEPTH)
    still = Motion.at_rest(1)
    wanted = quiet.loads(0.0, still)
    assert settled.static_loads(still).force == pytest.approx(wanted.force, rel=1e-12, abs=1e-6)
    settled.begin_step(STEP, STEP, still)
    found = settled.loads(2 * STEP, still)
    assert found.force[0, 2] == pytest.approx(wanted.force[0, 2], rel=8e-3)
    assert found.force[0, :2] == pytest.approx([0.0, 0.0], abs=500.0)
    quiet.end_step(0.0, still)
    for name in ("fairlead_tension", "anchor_tension"):
        assert settled.record()[name] == pytest.approx(quiet.record()[name], rel=8e-3)
    assert settled.record()["grounded_length"] == pytest.approx(np.full(3, 134.8), abs=112.8)


def test_moving_lines_damp_and_resume_to_the_same_bits(settled):
    other = DynamicLines(OC3.mooring, BODY, DEPTH, segments=8)
    assert other.state()["moordyn"].size == 0
    march(settled, range(1, 40))
    state = settled.state()
    first = march(settled, range(40, 240))
    other.restore(state)
    assert march(other, range(40, 240)) == first
    quiet = MooringLines(OC3.mooring, BODY, DEPTH)
    force = np.array([np.frombuffer(bits)[0] for bits in first])
    times = STEP * (np.arange(40, 240) + 1)
    slow = np.array([quiet.loads(0.0, surging(t)).force[0, 0] for t in times])
    speed = np.array([surging(t).velocity[0, 0] for t in times])
    damping = -np.sum((force - slow) * speed) / np.sum(speed**2)
    assert 1e4 < damping < 3e5  # N s/m: drag on lines that are drawn through the water
    other.close()


def test_goes_back_to_before_the_first_step():
    lines = DynamicLines(OC3.mooring, BODY, DEPTH, segments=4)
    start = lines.state()
    first = march(lines, range(3))
    lines.restore(start)
    assert march(lines, range(3)) == first
    lines.close()


def test_without_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "moordyn", None)
    with pytest.raises(InputError, match=r"pip install 'galerna\[moordyn\]'"):
        DynamicLines(OC3.mooring, BODY, DEPTH)


def test_input_keeps_the_weight_in_water():
    heavier = [
        replace(line, line_type=replace(line.line_type, weight=650.0)) for line in OC3.mooring.lines
    ]
    mooring = replace(OC3.mooring, lines=tuple(heavier))
    network = MooringLines(mooring, BODY, DEPTH).network
    row = next(r for r in input_text(network, 1025.0, 9.80665).splitlines() if r[:5] == "type1")
    diameter, mass, _, _, _, drag, *_ = (float(x) for x in row.split()[1:])
    weight = (mass - 1025.0 * np.pi / 4.0 * diameter**2) * 9.80665
    assert weight == pytest.approx(650.0)
    assert drag * diameter == pytest.approx(1.6 * 0.09)
    with pytest.raises(InputError, match="more than its mass"):
        input_text(network, 1025.0, 6.0)


def test_nothing_is_said_on_the_terminal(capfd):
    pytest.importorskip("moordyn")
    lines = DynamicLines(OC3.mooring, BODY, DEPTH, segments=5)
    march(lines, range(2))
    lines.close()
    assert capfd.readouterr() == ("", "")
