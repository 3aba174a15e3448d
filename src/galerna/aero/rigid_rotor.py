"""Motion of a rigid rotor in shaft axes, for tools that need no nacelle and no tower.

Shaft axes have their origin in the hub centre, x along the shaft downwind and z in the
vertical plane upwards; they do not turn with the rotor.
"""

from __future__ import annotations

import numpy as np

from galerna.aero.sections import BladeSections
from galerna.contract import Array, Motion
from galerna.structure.frames import rotation_about
from galerna.turbine.model import Turbine


def wind_in_shaft_axes(turbine: Turbine, wind_speed: float, yaw_error: float = 0.0) -> Array:
    """A horizontal wind (3,) m/s as the tilted shaft sees it, at a nacelle yaw error in rad."""
    shaft = rotation_about(2, yaw_error) @ rotation_about(1, turbine.nacelle.tilt)
    return shaft.T @ np.array([wind_speed, 0.0, 0.0])


def rigid_rotor_motion(
    turbine: Turbine,
    sections: BladeSections,
    azimuth: float,
    rotor_speed: float,
    pitch: float,
    blades: int | None = None,
) -> Motion:
    """Frames of the ``sections`` of each blade, then the hub's, turning at ``rotor_speed`` rad/s.

    ``azimuth`` of blade 1 and ``pitch`` in rad; ``blades`` takes the first few alone.
    """
    count = turbine.number_of_blades
    outwards = sections.position + np.array([0.0, 0.0, turbine.hub.radius])
    to_hub = rotation_about(1, -turbine.hub.cone) @ rotation_about(2, -pitch)
    hub = rotation_about(0, azimuth)
    axes = [rotation_about(0, azimuth + 2.0 * np.pi * b / count) @ to_hub for b in range(count)]
    axes = axes[:blades]
    motion = Motion.at_rest(len(axes) * len(sections) + 1)
    motion.position[:-1] = np.concatenate([outwards @ a.T for a in axes])
    motion.rotation[:-1] = np.concatenate([a @ sections.rotation for a in axes])
    motion.rotation[-1] = hub
    motion.angular_velocity[:, 0] = rotor_speed
    motion.velocity[:] = np.cross(motion.angular_velocity, motion.position)
    motion.acceleration[:] = np.cross(motion.angular_velocity, motion.velocity)
    return motion
