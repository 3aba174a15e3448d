"""Rotor speed, blade pitch and platform in wind and waves, linear: what the gains do to them.

With the hub's motion x, the rotor's speed W and the blades' pitch p about the point of operation,
s = i w, the wind u over the rotor and the waves' elevation z,

    thrust = (thrust, torque) by (u - s x, W, p)         W s I = torque         (constant torque)
    x = H thrust + X z                                   p = (K_P + K_I/s) F G W.

H and X are those of the spar in surge and pitch, without heave, with the drag of the waves'
velocities made linear; F is the filter of the generator's speed. The wake is in balance always.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.signal import welch

from galerna.contract import Array
from galerna.control.pitch import PitchGains
from galerna.coupling.gains import drive_inertia
from galerna.coupling.steady import FlexibleRotor, steady_flexible
from galerna.hydro.waves.spectra import default_peak_enhancement, jonswap
from galerna.inflow.mann import mann_box
from galerna.turbine import load
from galerna.turbine.model import Turbine
from galerna.units import DEG, RPM, SEA_WATER, STANDARD_GRAVITY

from .afloat import linear_machine
from .afloat_gains import TURBINE, schedule
from .afloat_operation import BOX, INTENSITY, SEA, WIND

Complex = NDArray[np.complex128]

FREQUENCY = np.concatenate([np.arange(0.001, 0.06, 0.0005), np.arange(0.06, 0.3, 0.002)])  #: Hz
LASTING = 600.0  #: s, of the runs
S = 2j * np.pi * FREQUENCY
STEPS = np.array([0.5, 0.02, 0.5 * DEG])  #: m/s, rad/s and rad, of the derivatives
IN_PLANE = [0, 4]  #: surge and pitch among the six
#: what is looked at, and its size in SI
OUTPUTS = {"rotor speed": RPM, "blade pitch": DEG, "surge": 1.0, "platform pitch": DEG}


@cache
def turbine() -> Turbine:
    """The OC3 turbine."""
    return load(TURBINE)


@cache
def balance() -> tuple[float, float, float]:
    """Blade pitch rad that gives rated power at 18 m/s, and the gains of the reference there."""
    pitch = float(steady_flexible(turbine(), [WIND])["pitch"][0])
    proportional, integral, _ = PitchGains.of_schedule(schedule()).at(pitch)
    return pitch, proportional, integral


@cache
def derivatives() -> Array:
    """Of thrust N and torque N m (2,3) by wind m/s, rotor speed rad/s and pitch rad."""
    rotor = FlexibleRotor(turbine())
    point = np.array([WIND, turbine().control.rated_rotor_speed, balance()[0]])

    def at(values: Array) -> Array:
        found = rotor.at(*values)
        return np.array([float(found["rotor_thrust"]), float(found["rotor_torque"])])

    columns = [(at(point + h) - at(point - h)) / (2.0 * h.sum()) for h in np.diag(STEPS)]
    return np.stack(columns, axis=1)


@cache
def platform() -> tuple[Complex, Complex]:
    """Surge m and pitch rad (f,2) of the spar for 1 N at the hub, and for 1 m of wave."""
    machine = linear_machine("rigid")

    def moved(frequency: float, force: Complex) -> Complex:
        return machine.answer(frequency, force)[machine.platform, IN_PLANE]

    thrust, wave, damping = [], [], drag()
    for w in S.imag:
        compliance = np.stack([moved(w, one + 0j) for one in np.eye(6)[IN_PLANE]], axis=1)
        with_drag = np.linalg.inv(np.linalg.inv(compliance) + 1j * w * damping)
        thrust.append(with_drag @ [1.0, turbine().hub_height])
        calm = moved(w, machine.database.excitation_at([w], 0.0)[0])
        wave.append(with_drag @ np.linalg.solve(compliance, calm))
    return np.array(thrust), np.array(wave)


def drag() -> Array:
    """Damping (2,2) of surge and pitch by the spar's drag in the waves (Borgman, 1967).

    |v| v of a normal velocity v is as sqrt(8/pi) of its deviation times v, at its best. Of the
    waves' velocities alone; their own drag on the spar, as of all else in it, is left out.
    """
    platform = turbine().platform
    assert platform is not None
    spar = platform.members[0]
    height = np.linspace(spar.start[2], 0.0, 241)
    along = (height - spar.start[2]) / spar.length
    diameter = np.interp(along, spar.span, spar.sides[:, 0])
    w = np.linspace(0.2, 2.5, 500)
    velocity = w * np.exp(np.outer(height, w**2 / STANDARD_GRAVITY))
    deviation = np.sqrt(np.trapezoid(velocity**2 * sea(w), w, axis=1))
    per_length = 0.5 * SEA_WATER * float(spar.drag_coefficient[0, 0]) * diameter
    per_length *= np.sqrt(8.0 / np.pi) * deviation
    lever = np.stack([np.ones_like(height), height])
    return np.asarray(np.trapezoid(per_length * lever[:, None] * lever, height, axis=2))


def sea(frequency: Array) -> Array:
    """Density m2 s/rad of the waves at frequencies rad/s."""
    height, period = (SEA["waves"][k] for k in ("significant_height_m", "peak_period_s"))
    return jonswap(frequency, height, period, default_peak_enhancement(height, period))


@cache
def wind(seed: int = BOX["seed"]) -> Array:
    """Wind m/s over time, mean over the rotor, of the box less its mean."""
    box = mann_box(
        tuple(BOX["points"]),
        tuple(BOX["spacing_m"]),
        length_scale=BOX["length_scale_m"],
        shear_parameter=BOX["shear_parameter"],
        mean_speed=WIND,
        hub_height=turbine().hub_height,
        seed=seed,
        turbulence_intensity=INTENSITY,
    )
    across = [np.arange(n) - 0.5 * (n - 1) for n in box.data.shape[2:]]
    y, z = np.meshgrid(
        *(d * a for d, a in zip(box.spacing[1:], across, strict=True)), indexing="ij"
    )
    disc = np.hypot(y, z) < turbine().rotor_radius
    return np.asarray(box.data[0][:, disc].mean(axis=1, dtype=float))


@cache
def wind_density() -> Array:
    """Density m2/s of that wind at ``FREQUENCY``."""
    rate = WIND / BOX["spacing_m"][0]
    frequency, power = welch(wind(), rate, nperseg=4096, detrend="linear")
    return np.exp(np.interp(np.log(FREQUENCY), np.log(frequency[1:]), np.log(power[1:])))


def answers(factor: float) -> Complex:
    """``OUTPUTS`` (2,f,4) for 1 m/s of wind and 1 m of wave, all gains times a factor."""
    (thrust_v, thrust_w, thrust_p), (torque_v, torque_w, torque_p) = derivatives()
    _, proportional, integral = balance()
    corner = turbine().control.speed_filter_frequency
    assert corner is not None
    seen = turbine().drivetrain.gear_ratio * corner / (S + corner)
    control = factor * (proportional + integral / S) * seen
    by_thrust, by_wave = platform()
    hub = np.array([1.0, turbine().hub_height])
    compliance, carried = by_thrust @ hub, by_wave @ hub
    matrix = np.empty((len(S), 2, 2), dtype=complex)
    matrix[:, 0, 0] = 1.0 + compliance * thrust_v * S
    matrix[:, 0, 1] = -compliance * (thrust_w + thrust_p * control)
    matrix[:, 1, 0] = torque_v * S
    matrix[:, 1, 1] = S * drive_inertia(turbine()) - torque_w - torque_p * control
    found = []
    still = np.zeros_like(S)
    for gust, right in (
        (1.0, (compliance * thrust_v, still + torque_v)),
        (0.0, (carried, still)),
    ):
        x, speed = np.linalg.solve(matrix, np.stack(right, axis=1)[..., None])[..., 0].T
        pitch = control * speed
        thrust = thrust_v * (gust - S * x) + thrust_w * speed + thrust_p * pitch
        moved = by_thrust * thrust[:, None] + (1.0 - gust) * by_wave
        found.append(np.column_stack([speed, pitch, moved]) / list(OUTPUTS.values()))
    return np.array(found)


@cache
def deviations(factor: float = 1.0, lasting: float = LASTING) -> dict[str, float]:
    """Standard deviations of ``OUTPUTS`` in the wind and sea of 5.3 in a run of ``lasting`` s.

    It shows the part of a spectrum that is quicker than one period of its length.
    """
    density = np.stack([wind_density(), 2.0 * np.pi * sea(S.imag)])[:, :, None]
    shown = FREQUENCY * lasting >= 1.0
    power = (np.abs(answers(factor)) ** 2 * density).sum(axis=0)[shown]
    variance = np.trapezoid(power, FREQUENCY[shown], axis=0)
    return dict(zip(OUTPUTS, np.sqrt(variance).tolist(), strict=True))


def change(quantity: str, factor: float, lasting: float = LASTING) -> float:
    """By what share a deviation differs where all gains are times a factor."""
    return deviations(factor, lasting)[quantity] / deviations(1.0, lasting)[quantity] - 1.0


def factor_of(quantity: str, wanted: float, lasting: float) -> float:
    """The factor on all gains that changes a deviation by a share."""

    def excess(factor: float) -> float:
        return change(quantity, factor, lasting) - wanted

    return float(brentq(excess, 0.2, 5.0, xtol=1e-3))


def damping() -> tuple[float, float]:
    """What slows the rotor's speed, N m s: the wind on the blades, and the proportional gain."""
    _, torque_w, torque_p = derivatives()[1]
    return -float(torque_w), -float(torque_p) * turbine().drivetrain.gear_ratio * balance()[1]


def speed_by_wind() -> float:
    """Share of the rotor's speed, and of power at constant torque, for 1 m/s in open loop."""
    torque_v, torque_w, _ = derivatives()[1]
    return float(-torque_v / torque_w) / turbine().control.rated_rotor_speed


def natural() -> tuple[float, float]:
    """Natural frequency rad/s and damping ratio of the rotor's speed, the platform held."""
    stiffness = damping()[1] * balance()[2] / balance()[1]
    inertia = drive_inertia(turbine())
    frequency = float(np.sqrt(stiffness / inertia))
    return frequency, sum(damping()) / (2.0 * inertia * frequency)
