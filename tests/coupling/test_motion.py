"""Prescribed motion: of the base, the yaw drive, the pitch of each blade, from the start on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from galerna import turbine as turbines
from galerna.case import parse
from galerna.contract import Array, Loads, Stations
from galerna.coupling.build import turbine_options
from galerna.coupling.flexible import FlexibleMachine
from galerna.coupling.paths import BasePath, Harmonic, SignalPath, Spline, StepPath
from galerna.errors import InputError
from galerna.kinematics import PrescribedMotion, PrescribedOperation
from galerna.machine import build_machine
from galerna.signals import Signal
from galerna.structure import Tolerance, TurbineOptions, with_initial_accelerations
from galerna.structure.initial import with_fitting_velocities
from galerna.structure.placing import placed
from galerna.units import DEG

NREL = turbines.load("nrel5mw")
SPAR = turbines.load("nrel5mw_oc3")
SPAN = np.linspace(0.0, 1.0, 4)
GROUP = (Stations("blade1", SPAN), Stations("blade2", SPAN), Stations("hub"), Stations("nacelle"))


def swinging(place: Array) -> BasePath:
    """All six motions at once, each with a frequency of its own."""
    names = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    sizes = (2.0, 1.0, 0.5, 0.05, 0.08, 0.03)
    return BasePath(
        place,
        {
            name: Harmonic(0.3 * size, size, 0.05 + 0.02 * i, 0.4 * i)
            for i, (name, size) in enumerate(zip(names, sizes, strict=True))
        },
    )


SPEED, YAW = Signal.constant(1.2), Signal(np.array([-10.0, 90.0]), np.array([0.0, 2.0]))
PITCH = (Signal.constant(0.05), Signal.constant(0.1), Signal.constant(-0.02))


def rigid_machine(turbine, base: BasePath) -> FlexibleMachine:
    """Rigid parts on a moved base, the rotor turning, the nacelle yawing, in no gravity."""
    return FlexibleMachine(
        turbine,
        [GROUP],
        TurbineOptions(
            blade_elements=0,
            tower_elements=0,
            flexible_shaft=False,
            flexible_yaw=False,
            azimuth=0.3,
            rotor_motion=SignalPath(SPEED, integral=True),
            pitch=0.05,
            pitch_motion=tuple(SignalPath(angle, offset=-0.05) for angle in PITCH),
            yaw_motion=SignalPath(YAW),
            base_motion=base,
            gravity=(0.0, 0.0, 0.0),
        ),
        tolerance=Tolerance(),
    )


def exact(turbine, base: BasePath, place: Array) -> Callable[[float], Array]:
    """Positions (n,3) of the stations by rigid kinematics."""
    operation = PrescribedOperation(SPEED, PITCH, YAW, 0.3)
    fixed = PrescribedMotion(turbine, operation, [GROUP])

    def position(time: float) -> Array:
        fixed.move(time)
        x, R = base(time)
        return x + (fixed.motions[0].position - place) @ R.T

    return position


def start(machine: FlexibleMachine) -> None:
    """Start with velocities and accelerations that the joints' motions ask for."""
    state = with_fitting_velocities(machine.system, placed(machine.system, 0.0))
    machine.start(with_initial_accelerations(machine.system, state))


def step(machine: FlexibleMachine, dt: float) -> None:
    """A step without loads."""
    machine.predict(machine.accepted.time, dt)
    while not machine.balance([Loads.zero(len(machine.motions[0].position))]):
        pass
    machine.accept()


@pytest.mark.parametrize("turbine", [NREL, SPAR], ids=["land", "spar"])
def test_stations_on_a_swinging_base_move_as_rigid_kinematics_say(turbine) -> None:
    platform = turbine.platform
    place = np.array(turbine.tower.axis[0] if platform is None else platform.reference_point)
    base = swinging(place)
    position, time, h = exact(turbine, base, place), 1.6, 1e-3
    before, now, after = (position(time + k * h) for k in (-1, 0, 1))
    velocity, acceleration = (after - before) / (2 * h), (after - 2 * now + before) / h**2
    errors = []
    for dt in (0.04, 0.02):
        machine = rigid_machine(turbine, base)
        start(machine)
        for _ in range(round(time / dt)):
            step(machine, dt)
        motion = machine.motions[0]
        assert motion.position == pytest.approx(now, abs=1e-7)
        errors.append(
            (
                np.abs(motion.velocity - velocity).max(),
                np.abs(motion.acceleration - acceleration).max(),
            )
        )
    (coarse, _), (fine_v, fine_a) = errors
    assert fine_v < 2e-3
    assert fine_a < 2e-2
    assert coarse / fine_v == pytest.approx(4.0, rel=0.3)
    assert np.abs(acceleration).max() > 50.0


def test_the_base_carries_what_changes_the_momentum() -> None:
    """Gyroscopic and all other inertia: force and moment at the base are its rate."""
    base, dt = swinging(np.zeros(3)), 0.01
    machine = rigid_machine(NREL, base)
    start(machine)
    states = []
    for _ in range(101):
        step(machine, dt)
        states.append(machine.accepted)
    before, now, after = states[-3:]
    system = machine.system
    rate = (system.momentum(after) - system.momentum(before)) / (2 * dt)
    wrench = -system.node_wrenches(now)[system.pair("base"), 6:]
    foot = system.names.index("foot")
    R, x = now.rotation[foot], now.position[foot]
    force, moment = R @ wrench[:3], R @ wrench[3:]
    moment += np.cross(x, force)
    assert force == pytest.approx(rate[:3], abs=2e-3 * np.abs(rate[:3]).max())
    assert moment == pytest.approx(rate[3:], abs=2e-3 * np.abs(rate[3:]).max())


def test_paths_are_smooth_and_stay_where_they_end() -> None:
    harmonic = Harmonic(1.0, 2.0, 0.1, 0.3, ramp=4.0)
    assert harmonic(0.0) == 1.0
    h = 1e-3
    for t in (1e-3, 4.0, 7.0):
        jump = harmonic(t + h) - 2 * harmonic(t) + harmonic(t - h)
        assert abs(jump) / h**2 < 2.0
    assert harmonic(9.0) == pytest.approx(1.0 + 2.0 * np.sin(1.8 * np.pi + 0.3))
    spline = Spline(np.array([1.0, 2.0, 4.0]), np.array([0.5, 2.0, 1.0]))
    assert [spline(t) for t in (0.0, 1.0, 2.0, 4.0, 9.0)] == pytest.approx([0.5, 0.5, 2, 1, 1])
    for knot in (1.0, 4.0):
        assert (spline(knot + h) - spline(knot - h)) / (2 * h) == pytest.approx(0.0, abs=1e-2)


def test_a_controller_drives_the_yaw_through_the_bearings_spring() -> None:
    machine = FlexibleMachine(NREL, [GROUP], TurbineOptions(blade_elements=0, tower_elements=0))
    start(machine)
    for i in range(300):
        machine.go_yaw(min(0.005 * (i + 1) * 0.02, 0.02), 0.02 * i, 0.02)
        step(machine, 0.02)
    assert machine.yaw_drive(machine.accepted.time) == pytest.approx(0.02)
    assert machine.yaw == pytest.approx(0.02, abs=5e-4)
    saved = machine.state()
    other = FlexibleMachine(NREL, [GROUP], TurbineOptions(blade_elements=0, tower_elements=0))
    other.restore(saved)
    assert isinstance(other.yaw_drive, StepPath)
    assert other.yaw_drive(machine.accepted.time) == pytest.approx(0.02)


BASE = "galerna: 1\nturbine: {turbine}\nduration_s: 9\ninflow: {{wind_speed_m_s: 12}}\n"


def built(text: str, turbine: str = "nrel5mw"):
    return build_machine(parse(BASE.format(turbine=turbine) + text, "case", "."))


@pytest.mark.parametrize(
    "structure",
    [
        "{blades: rigid}",
        "{tower: rigid, blade_elements: 6}",
        "{shaft: rigid, yaw_bearing: rigid, blade_elements: 6, tower_elements: 4}",
        "rigid",
    ],
)
def test_any_parts_are_rigid_and_the_start_obeys_all_joints(structure: str) -> None:
    machine = built(
        f"structure: {structure}\n"
        "operation: {rotor_speed_rpm: 12, pitch_deg: [1, 2, 4], yaw_deg: 20, azimuth_deg: 30}\n"
        "base_motion: {surge_m: 3, pitch_deg: 5, yaw_deg: 10}\n"
    )
    simulation, moving = machine.simulation, machine.simulation.structure
    assert moving.system.violation(moving.accepted) < 1e-5
    foot = moving.accepted.position[moving.system.names.index("foot")]
    assert foot == pytest.approx([3.0, 0.0, 0.0], abs=1e-9)
    for _ in range(3):
        simulation.advance()
    assert moving.rotor_speed == pytest.approx(12 * 2 * np.pi / 60, rel=2e-3)
    assert moving.pitch_angles(0.06) == pytest.approx(np.array([1.0, 2.0, 4.0]) * DEG)
    assert moving.system.violation(moving.accepted) < 1e-9


def test_a_platform_stands_still_unless_it_is_moved() -> None:
    for text, surge in (("", 0.0), ("base_motion: {surge_m: 2}\n", 2.0)):
        machine = built("structure: rigid\ncontrol: baseline\n" + text, "nrel5mw_oc3")
        moving = machine.simulation.structure
        machine.simulation.advance()
        at = moving.accepted.position[moving.system.names.index("platform")]
        assert at == pytest.approx(SPAR.platform.reference_point + np.array([surge, 0, 0]))
        said = any("held still" in doubt for doubt in machine.doubts())
        assert said == (surge == 0.0)


def test_rotor_speed_pitch_and_yaw_follow_series_with_flexible_blades() -> None:
    machine = built(
        "structure: {blade_elements: 6, tower_elements: 4}\n"
        "operation:\n  rotor_speed_rpm: {time_s: [0, 1, 2], values: [12, 12.1, 12.1]}\n"
        "  pitch_deg: {time_s: [0, 1], values: [4, 5]}\n"
        "  yaw_deg: {time_s: [0, 1], values: [0, 0.3]}\n"
    )
    simulation, moving = machine.simulation, machine.simulation.structure
    for _ in range(100):
        simulation.advance()
    assert moving.rotor_speed == pytest.approx(12.1 * 2 * np.pi / 60, rel=1e-3)
    assert moving.pitch_angles(2.0) == pytest.approx(np.full(3, 5.0 * DEG))
    assert moving.yaw == pytest.approx(0.3 * DEG, abs=0.2 * DEG)


def test_parts_without_data_are_named() -> None:
    text = BASE.format(turbine="nrel5mw") + "control: baseline\nstructure: flexible\n"
    case = parse(text, "case", ".")
    operation = PrescribedOperation(SPEED, PITCH)
    bare = replace(NREL, blade=replace(NREL.blade, structure=None))
    with pytest.raises(InputError, match=r"^blades: .*no sectional stiffness"):
        turbine_options(case, bare, operation)
    bare = replace(NREL, tower=replace(NREL.tower, structure=None))
    with pytest.raises(InputError, match=r"(?s)^tower: .*tower: rigid"):
        turbine_options(case, bare, operation)
