"""Separated sections: the polar in plane flow, finite wings beyond stall, one solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from galerna import turbine
from galerna.aero.vortex import decambering
from galerna.aero.vortex.biot_savart import direct_velocity
from galerna.aero.vortex.blades import blade_lattice
from galerna.aero.vortex.decambering import Decambered, Decambering
from galerna.aero.vortex.influence import strip_influence
from galerna.aero.vortex.loads import lattice_loads
from galerna.aero.vortex.section_lift import SectionLift, strip_chords
from galerna.aero.vortex.section_polars import SectionPolars
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import (
    Surface,
    collocation_normals,
    collocation_points,
    collocation_velocities,
    segment_points,
    segment_velocities,
)
from galerna.aero.vortex.system import BoundSystem
from galerna.aero.vortex.wings import elliptic_wing, trapezoidal_wing
from galerna.errors import ConvergenceError
from galerna.turbine.geometry import blade_frames
from galerna.turbine.model import Polar

SPEED, STALL = 50.0, np.radians(12.0)
ANGLE = np.radians(np.linspace(-180.0, 180.0, 1441))


def stalling_polar(fall: float = 2.5) -> Polar:
    """A thin airfoil up to 12 deg, beyond which lift falls by ``fall`` per radian, to 0.5 less."""
    attached = np.clip(ANGLE, -STALL, STALL)
    beyond = np.abs(ANGLE) - np.abs(attached)
    lift = 2 * np.pi * np.sin(attached) - np.sign(ANGLE) * np.minimum(fall * beyond, 0.5)
    lift *= np.clip((np.pi - np.abs(ANGLE)) / 0.5, 0.0, 1.0)
    return Polar(1e6, ANGLE, lift, 0.01 + 0.0 * ANGLE, 0.0 * ANGLE)


@dataclass(eq=False)
class Steady:
    """Surfaces in a wind, whose straight wakes carry the circulation of the trailing edges."""

    surfaces: list[Surface]
    wind: np.ndarray

    def __post_init__(self) -> None:
        self.system = BoundSystem()
        self.system.place(self.surfaces)
        self.wakes = [self._wake(s) for s in self.surfaces]
        points, self.normals = collocation_points(self.surfaces), collocation_normals(self.surfaces)
        strips = np.concatenate([strip_influence(w, points, 0.0) for w in self.wakes], axis=1)
        self._strips = self.system.solve(np.einsum("kja,ka->kj", strips, self.normals))
        self.trailing = self.system.trailing_rings
        self.relative = self.wind - collocation_velocities(self.surfaces)
        self.circulation = self.solve(-np.sum(self.relative * self.normals, axis=1))

    def solve(self, normal_velocity: np.ndarray) -> np.ndarray:
        alone = self.system.solve(normal_velocity)
        schur = np.eye(len(self.trailing)) + self._strips[self.trailing]
        return alone - self._strips @ np.linalg.solve(schur, alone[self.trailing])

    def decambered(
        self, polars: list[SectionPolars], start: np.ndarray | None = None, **options: float
    ) -> Decambered:
        sections = [SectionLift.of_lattice(s.lattice) for s in self.surfaces]
        names = [f"blade{b + 1}" for b in range(len(self.surfaces))]
        model = Decambering(polars, sections, names, **options)
        response = model.response(self.solve, self.surfaces)
        return model.solve(self.surfaces, self.circulation, self.relative, response, start)

    def _wake(self, surface: Surface) -> np.ndarray:
        edge = surface.lattice.vertices[-1]
        away = self.wind - surface.velocity[-1]
        reach = 1e3 * np.ptp(edge, axis=0).max()
        return np.stack([edge, edge + reach * away / np.linalg.norm(away, axis=1, keepdims=True)])


def wing_in_wind(corners: np.ndarray, angle_deg: float) -> Steady:
    angle = np.radians(angle_deg)
    wind = SPEED * np.array([np.cos(angle), 0.0, np.sin(angle)])
    return Steady([Surface.at_rest(corners)], wind)


def lift_coefficients(flow: Steady, found: Decambered) -> np.ndarray:
    chord = np.concatenate([strip_chords(s.lattice.corners)[0] for s in flow.surfaces])
    return 2.0 * found.circulation[flow.trailing] / (chord * found.flow.speed)


def plane_wing() -> np.ndarray:
    return trapezoidal_wing(2000.0, 1.0, 4, 9, spanwise_spacing="uniform")


@pytest.mark.parametrize("angle_deg", [-15.0, 5.0, 13.0, 20.0, 45.0])
def test_in_plane_flow_lift_angle_and_force_are_the_polars(angle_deg: float) -> None:
    flow, polars = (
        wing_in_wind(plane_wing(), angle_deg),
        SectionPolars.of_polar(stalling_polar(), 9),
    )
    found = flow.decambered([polars])
    middle = 4
    lift = np.interp(np.radians(angle_deg), ANGLE, stalling_polar().lift)
    assert lift_coefficients(flow, found)[middle] == pytest.approx(lift, rel=2e-3)
    assert np.degrees(found.flow.angle_of_attack[middle]) == pytest.approx(angle_deg, rel=2e-3)
    force = strip_forces(flow, found.circulation)[middle] / (0.5 * SPEED**2 * 2000.0 / 9.0)
    across = np.array([-np.sin(np.radians(angle_deg)), 0.0, np.cos(np.radians(angle_deg))])
    assert force @ across == pytest.approx(lift, rel=2e-3)
    assert force @ flow.wind / SPEED == pytest.approx(0.0, abs=2e-3 * abs(lift))


def strip_forces(flow: Steady, circulation: np.ndarray) -> np.ndarray:
    """Joukowski forces (n,3) N on the strips of a wing in air of 1 kg/m3."""
    surface, wake = flow.surfaces[0], flow.wakes[0]
    rings = circulation.reshape(surface.shape)
    sheets = [Sheet(surface.lattice.vertices, rings), Sheet(wake, rings[-1:])]
    relative = flow.wind + direct_velocity(sheets, segment_points(flow.surfaces))
    relative -= segment_velocities(flow.surfaces)
    return lattice_loads(flow.surfaces, [rings], relative, 1.0)[0].strip_force


def test_an_attached_thin_airfoil_needs_no_wash() -> None:
    flow = wing_in_wind(elliptic_wing(8.0, 1.0, 4, 20), 6.0)
    found = flow.decambered([SectionPolars.of_polar(stalling_polar(), 20)])
    assert found.wash == pytest.approx(np.zeros(20), abs=2e-5 * SPEED)
    assert found.circulation == pytest.approx(flow.circulation, rel=1e-4)


def test_camber_that_the_polar_does_not_have_is_taken_away() -> None:
    camber = np.column_stack([(x := np.linspace(0, 1, 50)), 0.2 * x * (1 - x)])
    flow = wing_in_wind(trapezoidal_wing(2000.0, 1.0, 8, 5, camber=camber), 4.0)
    found = flow.decambered([SectionPolars.of_polar(stalling_polar(), 5)])
    lift = lift_coefficients(flow, found)[2]
    assert lift == pytest.approx(2 * np.pi * np.sin(np.radians(4.0)), rel=5e-3)
    assert found.wash[2] < 0.0


def sweep(angles: list[float], panels: int, **options: float) -> list[tuple[float, Decambered]]:
    """Each angle from the solution of the last; the wing's mean lift coefficient too."""
    polars, start, results = [SectionPolars.of_polar(stalling_polar(), panels)], None, []
    for angle in angles:
        flow = wing_in_wind(elliptic_wing(2.0 * np.pi, 1.0, 4, panels), angle)
        found = flow.decambered(polars, start, **options)
        y = flow.surfaces[0].lattice.corners[0, :, 1]
        area_lift = 2.0 * found.circulation[flow.trailing] @ np.diff(y) / SPEED
        results.append((area_lift / (np.pi**2 / 2.0), found))
        start = found.wash
    return results


def test_beyond_stall_there_is_one_solution_from_either_side() -> None:
    angles = [10.0, 14.0, 16.0, 18.0, 22.0, 30.0]
    up, down = sweep(angles, 30), sweep(angles[::-1], 30)[::-1]
    for (lift, found), (lift_back, found_back) in zip(up, down, strict=True):
        assert lift_back == pytest.approx(lift, rel=1e-5)
        assert found_back.wash == pytest.approx(found.wash, abs=1e-4 * SPEED)
        assert found.wash == pytest.approx(found.wash[::-1], abs=1e-4 * SPEED)
    lifts = [lift for lift, _ in up]
    assert np.argmax(lifts) in (2, 3)
    assert lifts[-1] < 0.85 * max(lifts)


def test_the_middle_of_a_stalled_wing_has_the_lift_of_its_polar() -> None:
    flow = wing_in_wind(elliptic_wing(2.0 * np.pi, 1.0, 4, 30), 20.0)
    polars = SectionPolars.of_polar(stalling_polar(), 30)
    found = flow.decambered([polars])
    lift = lift_coefficients(flow, found)
    wanted = polars.at_angle(found.flow.angle_of_attack)[:, 0]
    inner = slice(8, 22)
    assert lift[inner] == pytest.approx(wanted[inner], abs=0.01)
    unmixed = flow.decambered([polars], mixing=0.0)
    wanted = polars.at_angle(unmixed.flow.angle_of_attack)[:, 0]
    assert lift_coefficients(flow, unmixed) == pytest.approx(wanted, abs=1e-5)


def test_the_lift_beyond_stall_does_not_depend_on_the_panels() -> None:
    coarse, fine = sweep([14.0, 18.0, 24.0], 20), sweep([14.0, 18.0, 24.0], 60)
    for (few, _), (many, _) in zip(coarse, fine, strict=True):
        assert few == pytest.approx(many, rel=0.015)


def rotor(wind_speed: float) -> tuple[Steady, list[SectionPolars]]:
    """Two NREL 5 MW blades in the plane of rotation, with straight wakes."""
    machine = turbine.load("nrel5mw")
    blade = blade_lattice(machine, spanwise=16, chordwise=4)
    corners = blade.place(*blade_frames(machine.blade, blade.span))
    corners[..., 2] += machine.hub.radius
    turned = corners * np.array([1.0, -1.0, -1.0])
    surfaces = [Surface.turning(c, [1.2, 0.0, 0.0]) for c in (corners, turned)]
    assert blade.sections is not None
    polars = SectionPolars.of_table(blade.sections.table[blade.bare_strips :])
    return Steady(surfaces, np.array([wind_speed, 0.0, 0.0])), [polars, polars]


@pytest.mark.parametrize("wind_speed", [8.0, 14.0, 20.0, 30.0])
def test_rotor_blades_meet_measured_polars_alike_from_attached_to_deep_stall(
    wind_speed: float,
) -> None:
    flow, polars = rotor(wind_speed)
    found = flow.decambered(polars)
    first, second = found.wash.reshape(2, -1)
    assert first == pytest.approx(second, abs=1e-6 * np.abs(found.wash).max() + 1e-9)
    wanted = SectionPolars.joined(polars).at_angle(found.flow.angle_of_attack)[:, 0]
    lacking = np.abs(lift_coefficients(flow, found) - wanted)
    assert np.median(lacking) < 0.02
    assert np.isfinite(found.circulation).all()


def test_the_response_is_that_of_the_circulation() -> None:
    flow = wing_in_wind(elliptic_wing(8.0, 1.0, 4, 6), 6.0)
    model = Decambering(
        [SectionPolars.of_polar(stalling_polar(), 6)],
        [SectionLift.of_lattice(flow.surfaces[0].lattice)],
        ["wing"],
    )
    response = model.response(flow.solve, flow.surfaces)
    edges = flow.surfaces[0].lattice.corners[0, :, 1]
    strip = np.searchsorted(edges, collocation_points(flow.surfaces)[:, 1]) - 1
    for j in range(6):
        upwash = np.where(strip == j, 1.0, 0.0)  # through a flat wing
        assert response[:, j] == pytest.approx(flow.solve(-upwash), abs=1e-12)


def test_what_does_not_converge_names_the_strip(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(decambering, "ITERATIONS", 1)
    monkeypatch.setattr(decambering, "SETTLING_STEPS", 0)
    with pytest.raises(ConvergenceError, match="blade1: the lift of panel column"):
        sweep([20.0], 10)
