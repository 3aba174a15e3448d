"""Networks of lines on a platform: published statics, tangents, connections, errors, resuming."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from galerna.contract import LoadModel, Motion
from galerna.errors import InputError
from galerna.hydro.mooring import MooringLines, Network, catenary
from galerna.hydro.strips import Carrier
from galerna.structure.frames import exp_so3
from galerna.turbine import load
from galerna.turbine.platform import LineType, Mooring, MooringLine, MooringNode

OC3 = load("nrel5mw_oc3").platform
CHAIN = LineType("chain", 0.09, 77.7066, 698.094, 384.243e6)
DEPTH = 320.0
BODY = Carrier.rigid(OC3)


def node(name: str, kind: str, *position: float, **other: float) -> MooringNode:
    return MooringNode(name, kind, np.array(position), **other)


def posed(displacement) -> Motion:
    motion = Motion.at_rest(1)
    motion.position[0], motion.rotation[0] = displacement[:3], exp_so3(np.array(displacement[3:]))
    return motion


def wrench(lines: MooringLines, motion: Motion) -> np.ndarray:
    loads = lines.loads(0.0, motion)
    return np.concatenate([loads.force[0], loads.moment[0]])


def difference(lines: MooringLines, displacement) -> np.ndarray:
    """Minus the slope of the loads, by central differences."""
    base, columns = posed(displacement), []
    for k in range(6):
        h = 1e-4 if k < 3 else 1e-6
        both = []
        for step in (h, -h):
            moved = posed(displacement)
            if k < 3:
                moved.position[0, k] += step
            else:
                moved.rotation[0] = exp_so3(step * np.eye(3)[k - 3]) @ base.rotation[0]
            both.append(wrench(lines, moved))
        columns.append((both[1] - both[0]) / (2 * h))
    return np.stack(columns, axis=1)


ANCHOR, FAIRLEAD = node("a", "fixed", 800.0, 0.0, -320.0), node("f", "vessel", 5.2, 0.0, -70.0)


def bridled() -> Mooring:
    """A main line with a clump weight whose end splits into two legs."""
    return Mooring(
        (
            ANCHOR,
            node("clump", "connection", 300.0, 0.0, -280.0, mass=2e4),
            node("delta", "connection", 40.0, 0.0, -100.0),
            node("left", "vessel", 2.0, 5.0, -70.0),
            node("right", "vessel", 2.0, -5.0, -70.0),
        ),
        (
            MooringLine("lower", "a", "clump", CHAIN, 560.0),
            MooringLine("upper", "delta", "clump", CHAIN, 250.0),
            MooringLine("leg 1", "left", "delta", CHAIN, 50.0),
            MooringLine("leg 2", "right", "delta", CHAIN, 50.0),
        ),
    )


MOORINGS = {
    "oc3": OC3.mooring,
    "oc3 with friction": replace(OC3.mooring, seabed_friction=0.7),
    "bridled": bridled(),
}
POSES = {
    "upright": np.zeros(6),
    "displaced": np.array([12.0, 3.0, -1.0, 0.05, 0.08, 0.1]),
    "far": np.array([-30.0, 20.0, 2.0, -0.3, 0.4, -0.8]),
}


def test_oc3_as_published():
    """MAP++ of the OpenFAST regression test, and the report's linear matrix (NREL/TP-500-47535)."""
    lines = MooringLines(OC3.mooring, BODY, DEPTH)
    motion = posed(np.zeros(6))
    loads = lines.loads(0.0, motion)
    lines.end_step(0.0, motion)
    record = lines.record()
    assert loads.force[0, 2] == pytest.approx(-1.607e6, rel=2e-4)
    assert np.hypot(736.939e3, 535.728e3) == pytest.approx(record["fairlead_tension"], rel=2e-6)
    assert record["anchor_tension"] == pytest.approx(np.full(3, 736.939e3), rel=2e-6)
    assert record["grounded_length"] == pytest.approx(np.full(3, 134.785), abs=2e-3)
    K = loads.stiffness[0]
    assert np.diag(K) == pytest.approx(
        [41180.0, 41180.0, 11940.0, 311.1e6, 311.1e6, 98.34e6 + 11.56e6], rel=2e-3
    )
    assert K[0, 4] == pytest.approx(-2.8185e6, rel=2e-3)  # the report's two differ by as much
    assert lines.hanging_weight(motion) == pytest.approx(-loads.force[0, 2])


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("name", MOORINGS)
def test_stiffness_is_the_slope_of_the_loads(name, pose):
    lines = MooringLines(MOORINGS[name], BODY, DEPTH)
    exact = lines.loads(0.0, posed(POSES[pose])).stiffness[0]
    size = np.sqrt(np.abs(np.outer(np.diag(exact), np.diag(exact))))
    assert np.abs((exact - difference(lines, POSES[pose])) / size).max() < 1e-6


def test_work_around_a_loop_is_nothing():
    """Platform motion in all six directions and back: the loads have a potential."""
    lines = MooringLines(replace(OC3.mooring, yaw_stiffness=0.0), BODY, DEPTH)
    size = np.array([15.0, 10.0, 3.0, 0.1, 0.15, 0.3])
    phase = np.array([0.0, 0.7, 2.0, 1.3, 2.9, 4.0])
    work = scale = 0.0
    n = 600
    for t in 2 * np.pi * np.arange(n) / n:
        turn = size[3:] * np.sin(t + phase[3:])
        here = np.concatenate([size[:3] * np.sin(t + phase[:3]), turn])
        rate = size * np.cos(t + phase)
        h = 1e-5
        ahead = exp_so3(turn + h * rate[3:]) @ exp_so3(turn - h * rate[3:]).T / (2 * h)
        spin = 0.5 * np.array(
            [ahead[2, 1] - ahead[1, 2], ahead[0, 2] - ahead[2, 0], ahead[1, 0] - ahead[0, 1]]
        )
        power = wrench(lines, posed(here)) @ np.concatenate([rate[:3], spin])
        work, scale = work + power / n, scale + abs(power) / n
    assert abs(work) < 1e-7 * scale


@pytest.mark.parametrize("reach", [848.67, 872.0, 600.0])
def test_a_joint_without_weight_changes_nothing(reach):
    """One line, or two of the same type joined in the middle, where it hangs or rests or lies."""
    anchor = node("a", "fixed", reach, 0.0, -320.0)
    fairlead = node("f", "vessel", 0.0, 0.0, -70.0)
    joint = node("j", "connection", 0.5 * reach, 1.0, -200.0)
    whole = Mooring((anchor, fairlead), (MooringLine("1", "a", "f", CHAIN, 902.2),))
    for lower in (100.0, 500.0):
        parts = Mooring(
            (anchor, fairlead, joint),
            (
                MooringLine("1", "a", "j", CHAIN, lower),
                MooringLine("2", "f", "j", CHAIN, 902.2 - lower),
            ),
        )
        one, two = (Network.of(m, DEPTH).at(Network.of(m, DEPTH).points) for m in (whole, parts))
        assert two.force[1] == pytest.approx(one.force[1], rel=2e-6, abs=1e-3)
        assert two.lines[:, 4].sum() == pytest.approx(one.lines[0, 4], abs=0.2)
        if lower == 500.0:  # where the joint hangs: on the seabed it sinks in and its line bends
            assert two.stiffness[3:6, 3:6] == pytest.approx(
                one.stiffness[3:6, 3:6], rel=1e-3, abs=1e-3 * np.abs(one.stiffness).max()
            )


def test_connections_are_in_balance():
    lines = MooringLines(bridled(), BODY, DEPTH)
    network = lines.network
    found = network.at(network.points)
    weight = np.zeros((5, 3))
    weight[1, 2] = -2e4 * 9.80665
    assert found.force[network.free] + weight[network.free] == pytest.approx(
        np.zeros((2, 3)), abs=1e-4
    )
    assert found.points[2, 1] == pytest.approx(0.0, abs=1e-6)
    up = found.force[0, 2] + found.force[3:, 2].sum()
    resting = 698.094 * found.lines[:, 4].sum()
    assert up == pytest.approx(-(2e4 * 9.80665 + 698.094 * 910.0 - resting), rel=1e-7)


def test_a_buoy_floats_and_a_weight_lies_down():
    tether = MooringLine("1", "a", "b", CHAIN, 50.0)
    anchor = node("a", "fixed", 0.0, 0.0, -40.0)
    buoy = node("b", "connection", 3.0, 1.0, -20.0, mass=1e3, volume=50.0)
    found = Network.of(Mooring((anchor, buoy), (tether,)), 40.0)
    top = found.at(found.points).points[1]
    radius = np.cbrt(0.75 * 50.0 / np.pi)
    wet = (1e3 * 9.80665 + 698.094 * 40.0) / (1025 * 9.80665 * 50.0)
    assert top[2] == pytest.approx(radius * (1.0 - 2.0 * wet), rel=1e-2)
    clump = replace(buoy, mass=1e5, volume=0.0)
    found = Network.of(Mooring((anchor, clump), (tether,)), 40.0)
    assert found.at(found.points).points[1, 2] == pytest.approx(-40.0, abs=0.011)


def test_yaw_spring_turns_back_by_the_heading():
    spring = Mooring((), (), yaw_stiffness=1e8)
    lines = MooringLines(spring, BODY, DEPTH)
    yaw = exp_so3(np.array([0.0, 0.0, 0.3]))
    motion = posed(np.zeros(6))
    motion.rotation[0] = yaw @ exp_so3(np.array([0.0, 0.2, 0.0]))
    assert wrench(lines, motion) == pytest.approx([0, 0, 0, 0, 0, -3e7])


def test_a_frame_on_the_spar_feels_the_same():
    """Fairleads on a frame elsewhere whose axes point elsewhere: the same load, carried there."""
    turned = exp_so3(np.array([np.pi, 0.0, 0.0])) @ exp_so3(np.array([0.0, 0.0, 0.4]))
    at = np.array([0.0, 0.0, -70.0])
    carrier = Carrier(BODY.stations, at[None], turned[None])
    moved = np.array([5.0, -3.0, 1.0, 0.1, -0.05, 0.2])
    body = posed(moved)
    frame = Motion.at_rest(1)
    frame.rotation[0] = body.rotation[0] @ turned
    frame.position[0] = body.position[0] + body.rotation[0] @ at
    one = wrench(MooringLines(OC3.mooring, BODY, DEPTH), body)
    other = wrench(MooringLines(OC3.mooring, carrier, DEPTH), frame)
    arm = frame.position[0] - body.position[0]
    assert other[:3] == pytest.approx(one[:3], rel=1e-9)
    assert other[3:] + np.cross(arm, other[:3]) == pytest.approx(one[3:], rel=1e-8)


def test_resumes_to_the_same_bits_and_loads_are_pure():
    def march(lines: MooringLines, steps: range) -> list[bytes]:
        out = []
        for k in steps:
            motion = posed(0.2 * k * np.array([1.0, 0.5, 0.1, 0.01, 0.02, 0.01]))
            lines.begin_step(0.1 * k, 0.1, motion)
            lines.loads(0.0, posed(np.full(6, 0.3)))
            out.append(wrench(lines, motion).tobytes())
            lines.end_step(0.1 * k, motion)
        return out

    first, second = (MooringLines(bridled(), BODY, DEPTH) for _ in range(2))
    assert isinstance(first, LoadModel)
    march(first, range(10))
    second.restore(first.state())
    assert march(first, range(10, 15)) == march(second, range(10, 15))


def test_own_gravity_and_density_of_the_water():
    usual, other = (Network.of(OC3.mooring, DEPTH, *water).figures[0, 1]
                    for water in ((), (1000.0, 9.81)))  # fmt: skip
    assert usual == 698.094
    area = 0.25 * np.pi * 0.09**2
    assert other == pytest.approx((77.7066 - 1000.0 * area) * 9.81, rel=1e-5)


def test_hanging_line_is_the_catenary():
    one = Mooring((ANCHOR, FAIRLEAD), (MooringLine("1", "f", "a", CHAIN, 902.2),))
    lines = MooringLines(one, BODY, DEPTH)
    line = catenary(794.8, 250.0, 902.2, 698.094, 384.243e6)
    assert wrench(lines, posed(np.zeros(6)))[:3] == pytest.approx(
        [line.horizontal_b, 0.0, -line.vertical_b]
    )


ONE = Mooring((ANCHOR, FAIRLEAD), (MooringLine("line1", "a", "f", CHAIN, 902.2),))


def with_line(**changes) -> Mooring:
    return replace(ONE, lines=(replace(ONE.lines[0], **changes),))


@pytest.mark.parametrize(
    ("mooring", "depth", "says"),
    [
        (with_line(length=700.0), DEPTH, r"line 'line1': 700 m long, it must span 833\.1.* 19\.0%"),
        (with_line(first="anchr"), DEPTH, r"no node 'anchr'\n.*"),
        (with_line(length=-1.0), DEPTH, "length -1 m"),
        (with_line(line_type=replace(CHAIN, stiffness=0.0)), DEPTH, "EA 0 N"),
        (with_line(line_type=replace(CHAIN, weight=0.0)), DEPTH, "without weight has no shape"),
        (with_line(second="a"), DEPTH, "begins and ends at 'a'"),
        (replace(ONE, nodes=(ANCHOR, node("f", "vessel", 0, 0, -330.0))), DEPTH,
         r"fairlead is at z = -330 m, the seabed at -320 m"),
        (ONE, 300.0, r"anchor is at z = -320 m, the seabed at -300 m"),
        (ONE, 0.0, "need the depth"),
        (replace(ONE, nodes=(ANCHOR, FAIRLEAD, node("j", "connection", 0, 0, 0))), DEPTH,
         "no line holds"),
        (replace(ONE, nodes=(ANCHOR, FAIRLEAD, ANCHOR)), DEPTH, "two nodes of this name"),
        (replace(ONE, seabed_friction=-1.0), DEPTH, "must not be negative"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_said_with_the_figures(mooring, depth, says):
    with pytest.raises(InputError, match=says):
        MooringLines(mooring, BODY, depth)


def test_an_anchor_above_the_seabed_may_let_its_line_lie():
    raised = replace(ONE, nodes=(node("a", "fixed", 800.0, 0.0, -310.0), FAIRLEAD))
    found = Network.of(raised, DEPTH)
    line = found.at(found.points).lines[0]
    assert line[4] > 0.0 > line[1]


def test_anchors_that_hang_above_the_seabed_are_doubted():
    assert MooringLines(OC3.mooring, BODY, DEPTH).warnings == ()
    deeper = MooringLines(OC3.mooring, BODY, DEPTH + 10.0).warnings
    assert deeper == ("mooring: 3 of 3 anchors stand up to 10 m above the seabed at 330 m",)


def test_description_names_every_line():
    text = list(MooringLines(OC3.mooring, BODY, DEPTH).describe(posed(np.zeros(6))))
    assert (
        text[0]
        == "line1: 911.1 kN at the platform, 736.9 kN at the other end, 134.8 m on the seabed"
    )
    assert text[-1] == "1607.2 kN of lines hang on the platform"
