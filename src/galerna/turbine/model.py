"""A wind turbine as plain data: SI and radians, axes of the design page.

Blade root axes are the section axes at zero twist: x downwind (suction side),
y towards the trailing edge, z outwards along the pitch axis. Twist and pitch
are positive about -z, towards feather. Section matrices are ordered
[Fx, Fy, Fz, Mx, My, Mz] in the section axes at the reference axis.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from galerna.turbine.platform import Platform

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Polar:
    """Static section coefficients at one Reynolds number, about the quarter chord.

    ``angle_of_attack`` (n,) rad ascends from -pi to pi; ``lift``, ``drag`` and
    ``moment`` (n,) are cl, cd and cm (nose-up positive). ``configuration`` tags the
    state of the surface, for example clean or tripped.
    """

    reynolds: float
    angle_of_attack: Array
    lift: Array
    drag: Array
    moment: Array
    configuration: str = "default"


@dataclass(frozen=True)
class UnsteadyParameters:
    """What Beddoes-Leishman models need of a section beside its polar.

    Angles in rad, slope in 1/rad, time constants in half-chords travelled.
    ``separation_angles`` are the angles of attack, above and below zero lift, at
    which the separation point stands at 0.7 chord. ``origin`` says whether the
    figures are published or fitted from the polar.
    """

    zero_lift_angle: float
    normal_force_slope: float
    separation_angles: tuple[float, float]
    critical_normal_force: tuple[float, float]
    zero_lift_drag: float
    zero_lift_moment: float
    pressure_lag: float = 1.7  #: T_p
    separation_lag: float = 3.0  #: T_f0
    vortex_decay: float = 6.0  #: T_V0
    vortex_travel: float = 11.0  #: T_VL
    indicial_amplitudes: tuple[float, float] = (0.3, 0.7)  #: A1, A2
    indicial_exponents: tuple[float, float] = (0.14, 0.53)  #: b1, b2
    strouhal: float = 0.19
    origin: str = "fitted from the polar"


@dataclass(frozen=True, eq=False)
class Airfoil:
    """One section shape with its polars, by rising Reynolds number.

    ``coordinates`` (n,2) run from the trailing edge over the suction side to the
    leading edge and back along the pressure side, in chords. ``camber`` (m,2) is
    the mean line (x/c, z/c) and ``None`` where no coordinates are known.
    """

    name: str
    relative_thickness: float
    aerodynamic_center: float
    polars: tuple[Polar, ...]
    unsteady: UnsteadyParameters
    coordinates: Array | None = None
    camber: Array | None = None


@dataclass(frozen=True, eq=False)
class BladeShape:
    """Outer shape on (n,) stations: what aerodynamics needs.

    ``span`` is the fraction of the reference axis' length. ``leading_edge_offset``
    m is the distance from the leading edge to the reference axis along the chord;
    ``normal_offset`` m is the distance of the chord line from the reference axis,
    towards the suction side. ``airfoil_span`` (k,) and ``airfoil_names`` (k,) place
    the airfoils; between two of them the polars are blended by relative thickness
    where it differs, by position where it does not.
    """

    span: Array
    chord: Array
    twist: Array
    relative_thickness: Array
    leading_edge_offset: Array
    normal_offset: Array
    airfoil_span: Array
    airfoil_names: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class SectionProperties:
    """Elastic and inertial properties of a beam on (n,) stations.

    ``span`` fraction of the reference axis; ``stiffness`` (n,6,6) N, N m, N m2 and
    ``inertia`` (n,6,6) kg/m, kg, kg m at the reference axis in the section axes;
    ``twist`` (n,) rad of those axes; ``damping`` (6,) s is proportional to stiffness,
    per direction (0 for all where ``damping_ratio`` is given instead).
    """

    span: Array
    stiffness: Array
    inertia: Array
    twist: Array
    damping: Array = field(default_factory=lambda: np.zeros(6))
    damping_ratio: float | None = None

    @property
    def mass(self) -> Array:
        """Mass per length (n,) kg/m."""
        return self.inertia[:, 0, 0]


@dataclass(frozen=True, eq=False)
class Blade:
    """One blade: reference axis (n,3) m in the root axes at the fractions ``axis_span``."""

    axis_span: Array
    axis: Array
    shape: BladeShape
    structure: SectionProperties | None = None

    @property
    def length(self) -> float:
        """Length of the reference axis, m."""
        return float(np.linalg.norm(np.diff(self.axis, axis=0), axis=1).sum())


@dataclass(frozen=True, eq=False)
class Hub:
    """Rigid hub. ``radius`` m to the blade roots; ``cone`` rad, tips upwind positive.

    ``center_of_mass`` m along the downwind shaft axis from the hub centre;
    ``inertia`` kg m2 about the shaft.
    """

    radius: float
    cone: float
    mass: float = 0.0
    inertia: float = 0.0
    center_of_mass: float = 0.0
    pitch_system_inertia: float = 0.0


@dataclass(frozen=True, eq=False)
class Nacelle:
    """Nacelle without the rotor. Lengths in m from the yaw bearing on the tower top.

    ``overhang`` is positive for an upwind rotor, measured along the shaft from the
    yaw axis to the hub centre; ``shaft_height`` is the height of the shaft over the
    tower top at the yaw axis; ``tilt`` rad lifts the upwind end. ``center_of_mass``
    (3,) in nacelle axes (x downwind, z up); ``yaw_inertia`` kg m2 about the yaw axis.
    ``drag_area`` (3,) m2 is drag coefficient times area along x, y and z.
    """

    overhang: float
    shaft_height: float
    tilt: float
    mass: float = 0.0
    center_of_mass: tuple[float, float, float] = (0.0, 0.0, 0.0)
    yaw_inertia: float = 0.0
    yaw_bearing_mass: float = 0.0
    yaw_stiffness: float = 0.0
    yaw_damping: float = 0.0
    drag_area: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Drivetrain:
    """Shaft, gearbox and generator; inertia and torque at the generator's own speed.

    ``shaft_stiffness`` N m/rad and ``shaft_damping`` N m s/rad are at the low-speed
    shaft; 0 stiffness means rigid.
    """

    gear_ratio: float = 1.0
    gearbox_efficiency: float = 1.0
    generator_efficiency: float = 1.0
    generator_inertia: float = 0.0
    shaft_stiffness: float = 0.0
    shaft_damping: float = 0.0


@dataclass(frozen=True, eq=False)
class Tower:
    """Tower: reference axis (n,3) m in global axes from base to top.

    ``diameter`` (n,) m and ``drag_coefficient`` (n,) stand on the fractions
    ``axis_span``.
    """

    axis_span: Array
    axis: Array
    diameter: Array
    drag_coefficient: Array
    structure: SectionProperties | None = None
    extra_masses: tuple[tuple[float, float], ...] = ()  #: (height m, mass kg)


@dataclass(frozen=True, eq=False)
class Control:
    """Published operating strategy and reference controller.

    Speeds rad/s at the rotor, torque N m at the generator, powers W (electrical),
    angles rad. ``optimal_mode_gain`` N m s2 is K in torque = K speed^2 at the generator.
    ``pitch_schedule`` (n,3) holds pitch rad, proportional gain s and integral gain
    (against generator speed, rad per rad/s and rad per rad).
    """

    rated_power: float
    rated_rotor_speed: float
    minimum_rotor_speed: float
    cut_in_wind_speed: float
    cut_out_wind_speed: float
    rated_wind_speed: float | None = None
    optimal_tip_speed_ratio: float | None = None
    fine_pitch: float = 0.0
    maximum_pitch: float = np.pi / 2
    maximum_pitch_rate: float = np.inf
    rated_torque: float | None = None
    maximum_torque: float | None = None
    maximum_torque_rate: float = np.inf
    optimal_mode_gain: float | None = None
    pitch_schedule: Array | None = None
    region_2_rotor_speed: float | None = None  #: rad/s, from where the optimal torque is held
    minimum_pitch_table: Array | None = None  #: (n,2): wind speed m/s, pitch rad
    speed_filter_frequency: float | None = None  #: rad/s, low-pass on the generator speed


@dataclass(frozen=True)
class Published:
    """A figure that the literature gives for the whole turbine, to hold galerna against.

    ``quantity`` is a key of ``turbine.summary``; ``value`` is in ``unit``.
    """

    quantity: str
    value: float
    unit: str
    source: str


@dataclass(frozen=True, eq=False)
class Turbine:
    """Everything that is simulated, from one file.

    ``sources`` names the publication per block; ``notes`` says what the reader
    decided, ignored or found odd.
    """

    name: str
    number_of_blades: int
    blade: Blade
    airfoils: dict[str, Airfoil]
    hub: Hub
    nacelle: Nacelle
    drivetrain: Drivetrain
    tower: Tower
    control: Control
    hub_height: float
    platform: Platform | None = None
    sources: dict[str, str] = field(default_factory=dict)
    published: tuple[Published, ...] = ()
    description: str = ""
    notes: tuple[str, ...] = ()

    @property
    def rotor_radius(self) -> float:
        """Distance of the undeflected tip from the shaft axis, m, cone and prebend included."""
        x, y, z = self.blade.axis[-1]
        c, s = np.cos(self.hub.cone), np.sin(self.hub.cone)
        return float(np.hypot(c * (self.hub.radius + z) + s * x, y))
