"""Power, thrust and torque coefficients over tip-speed ratio and pitch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from galerna.aero.bem import model as bem
from galerna.aero.bem import rotor as r
from galerna.aero.bem import strips as s
from galerna.aero.bem.checks import require_turbine
from galerna.aero.bem.dataset import dataset
from galerna.aero.bem.options import BemOptions
from galerna.aero.rigid_rotor import rigid_rotor_motion
from galerna.contract import Array, Motion
from galerna.turbine.model import Turbine

if TYPE_CHECKING:
    import xarray

WIND_SPEED = 10.0  #: m/s; the coefficients do not depend on it


def performance_surface(
    turbine: Turbine,
    tip_speed_ratios: ArrayLike,
    pitches: ArrayLike,
    *,
    options: BemOptions | None = None,
) -> xarray.Dataset:
    """Coefficients of a rigid rotor over tip-speed ratio (n,) and pitch (m,) rad.

    The wind blows along the shaft, so one blade stands for all; unsteady parts are off.
    Raises InputError where the turbine's blade or polars cannot be used.
    """
    require_turbine(turbine)
    ratios = np.atleast_1d(np.asarray(tip_speed_ratios, dtype=float))
    angles = np.atleast_1d(np.asarray(pitches, dtype=float))
    sweep = _Sweep(turbine, options or BemOptions())
    speeds = ratios * WIND_SPEED / turbine.rotor_radius
    loads = np.stack([sweep.loads(speeds, pitch) for pitch in angles], axis=1)
    force = 0.5 * WIND_SPEED**2 * np.pi * turbine.rotor_radius**2
    torque_coefficient = loads[..., 1] / (force * turbine.rotor_radius)
    over = ("tip_speed_ratio", "pitch")
    return dataset(
        {
            "power_coefficient": (over, torque_coefficient * ratios[:, None]),
            "thrust_coefficient": (over, loads[..., 0] / force),
            "torque_coefficient": (over, torque_coefficient),
        },
        {"tip_speed_ratio": ratios, "pitch": angles},
    )


class _Sweep:
    """One blade of a rotor, asked over many rotor speeds at once."""

    def __init__(self, turbine: Turbine, options: BemOptions) -> None:
        steady = options.model_copy(
            update={"quasi_steady": True, "skewed_wake": "none", "tower_influence": False}
        )
        self.turbine, self.sections = turbine, bem.rotor_sections(turbine, steady)
        settings = bem.rotor_settings(turbine, steady, 1.0, len(self.sections))
        self.rotor = settings._replace(blades=1)
        self.shape = bem.strip_shapes(self.sections, turbine.blade.length)
        self.tables = bem.stall_tables(self.sections, steady)
        self.spanwise = bem.spanwise_matrix(self.sections, turbine.blade.length, settings)

    def loads(self, speeds: Array, pitch: float) -> Array:
        """Thrust N and torque N m (k,2) of the whole rotor at rotor speeds (k,) in rad/s."""
        motion = rigid_rotor_motion(self.turbine, self.sections, 0.0, 1.0, float(pitch), 1)
        out, angles = np.zeros((len(speeds), 2)), np.zeros((len(speeds), len(self.sections)))
        _sweep(
            self.rotor,
            speeds,
            *_arrays(motion),
            self.shape,
            *self.tables,
            self.spanwise,
            angles,
            out,
        )
        self.sections.check_angles(angles)
        return out * self.turbine.number_of_blades


def _arrays(motion: Motion) -> tuple[Array, Array, Array, Array]:
    return motion.position, motion.rotation, motion.velocity, motion.angular_velocity


@njit(cache=True)
def _sweep(
    rotor: r.Rotor,
    speeds: Array,
    position: Array,
    rotation: Array,
    unit_velocity: Array,
    unit_angular_velocity: Array,
    shape: Array,
    table: Array,
    stall: Array,
    spanwise: Array,
    angles: Array,
    out: Array,
) -> None:
    """Loads (k,2) and angles of attack (k,n) at each of the k rotor speeds."""
    n = shape.shape[0]
    wind, points = np.zeros((n, 3)), np.zeros((n, 3))
    wind[:, 0] = WIND_SPEED
    before, after = np.zeros((n, r.MEMORY_COLUMNS)), np.zeros((n, r.MEMORY_COLUMNS))
    before[:, r.GUESS] = bem.FIRST_GUESS
    strips, totals = np.zeros((n, s.STRIP_COLUMNS)), np.zeros(r.ROOT_MOMENTS + 2)
    force, moment = np.zeros((n, 3)), np.zeros((n, 3))
    passes = bem.FEEDBACK_PASSES if rotor.spanwise_filter == r.FILTER_FEEDBACK else 1
    s.aerodynamic_centers(position, rotation, shape, points)
    for k in range(len(speeds)):
        velocity, turning = speeds[k] * unit_velocity, speeds[k] * unit_angular_velocity
        for _ in range(passes):
            r.rotor_loads(
                rotor,
                points,
                position,
                rotation,
                velocity,
                turning,
                wind,
                shape,
                table,
                stall,
                spanwise,
                before,
                -1.0,
                after,
                strips,
                totals,
                force,
                moment,
            )
            before[:] = after
        out[k, 0], out[k, 1] = totals[r.THRUST], totals[r.TORQUE]
        angles[k] = strips[:, s.ANGLE_OF_ATTACK]
