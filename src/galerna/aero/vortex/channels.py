"""What the vortex lattice shows: its channels and how they are filled.

The air that a strip feels is not that at some point of it, where its own vortices would be met.
With G_k the net circulation of the segments along the span of one strip and u_k the whole velocity
of the air at them, relative to them,

    u = sum(G_k u_k) / sum(G_k)                                                            (1)

is the velocity that gives the strip's circulation its force (Joukowski). What the strip's
vortices do to each other cancels in it, in plane flow wholly, so u is what a lifting line calls
the effective velocity: its direction to the chord is the angle of attack, and what it lacks of
the undisturbed wind is the induction. Where the circulations cancel, their plain mean serves.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from galerna.aero.rotor_channels import (
    BLADE_CHANNELS,
    CALM,
    ROTOR_CHANNELS,
    STRIP_CHANNELS,
    rotor_values,
    strip_channel,
)
from galerna.aero.vortex.sheet import Sheet
from galerna.aero.vortex.surface import Surface
from galerna.contract import Array, Channel

CANCELLING = 0.02  #: of the circulations' sizes, where their sum begins to count as none
NO_CIRCULATION = 1e-12  #: m2/s

LATTICE_CHANNELS = (
    strip_channel("circulation", "m2/s", "circulation of the strip's vortices"),
    Channel("wake_panels", "1", "panels of all wakes"),
    Channel("sections_outside_polar", "1", "sections beyond the attached branch of their polar"),
)
PROBE_CHANNELS = tuple(
    Channel(f"probe_velocity_{axis}", "m/s", f"velocity along {axis} at the probes", ("probe",))
    for axis in "xyz"
)
_SHARED = tuple(c for c in STRIP_CHANNELS if c.name != "moment_coefficient")
CHANNELS = ROTOR_CHANNELS + BLADE_CHANNELS + _SHARED + LATTICE_CHANNELS


@dataclass(frozen=True, eq=False)
class Frames:
    """Frames of B blades with S stations each, and of the hub, copied from a motion.

    ``position``, ``velocity``, ``angular_velocity`` (B,S,3), ``rotation`` (B,S,3,3);
    ``hub`` (3,) m, ``shaft`` (3,3) its axes, ``hub_velocity`` (3,) and ``rotor_speed`` rad/s.
    """

    position: Array
    rotation: Array
    velocity: Array
    angular_velocity: Array
    hub: Array
    shaft: Array
    hub_velocity: Array
    rotor_speed: float


@dataclass(frozen=True, eq=False)
class StripState:
    """Strips (B,N,...) of an accepted step, bare ones first.

    ``width`` m along the span and ``chord`` m; ``air`` (B,N,3) m/s is the undisturbed air
    relative to the strip and ``effective`` that of eq. (1); ``force`` (B,N,3) N acts on it.
    """

    width: Array
    wind: Array
    air: Array
    effective: Array
    force: Array
    circulation: Array
    lift: Array
    drag: Array


def effective_air(surface: Surface, circulation: Array, relative: Array) -> Array:
    """Eq. (1) for the n strips of a surface, (n,3) m/s.

    ``circulation`` (m,n) of the rings; ``relative`` (m,n,3) m/s is the air's velocity, all vortices
    included, at the middles of the segments along the span, relative to them.
    """
    x = surface.lattice.vertices
    strength = Sheet(x, circulation).spanwise_strength[:-1]
    total = strength.sum(axis=0)
    little = np.maximum(CANCELLING * np.abs(strength).sum(axis=0), NO_CIRCULATION)
    weight = (strength * total + little**2 / len(strength)) / (total**2 + little**2)
    return np.einsum("kj,kja->ja", weight, relative)


def air_along_spans(surfaces: list[Surface], air: Array) -> list[Array]:
    """Velocity (m,n,3) m/s at the segments along the span, from that at all segments (S,3)."""
    found, first = [], 0
    for m, n in (s.shape for s in surfaces):
        found.append(air[first : first + m * n].reshape(m, n, 3))
        first += m * n + m * (n + 1)
    return found


def rotor_plane(frames: Frames) -> tuple[Array, Array]:
    """Unit vectors (B,N,3) of the strips: along the shaft but across the span; against the turn."""
    span = np.diff(frames.position, axis=1)
    span /= np.linalg.norm(span, axis=-1, keepdims=True)
    shaft = frames.shaft[:, 0]
    along = (span @ shaft)[..., None]
    normal = shaft - along * span
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-3)
    return normal, np.cross(span, normal)


def strip_values(frames: Frames, strips: StripState) -> dict[str, float | Array]:
    """The channels along the blades, each (B,N)."""
    normal, tangent = rotor_plane(frames)

    def across(vectors: Array) -> Array:
        return np.einsum("bna,bna->bn", vectors, normal)

    def along(vectors: Array) -> Array:
        return np.einsum("bna,bna->bn", vectors, tangent)

    chord = _middles(frames.rotation[..., 1])
    pitch = np.arctan2(across(chord), along(chord))
    inflow_angle = np.arctan2(across(strips.effective), along(strips.effective))
    turned = (inflow_angle - pitch + np.pi) % (2.0 * np.pi) - np.pi
    return {
        "angle_of_attack": turned,
        "inflow_angle": inflow_angle,
        "relative_speed": np.hypot(across(strips.effective), along(strips.effective)),
        "lift_coefficient": strips.lift,
        "drag_coefficient": strips.drag,
        "normal_force": across(strips.force) / strips.width,
        "tangential_force": -along(strips.force) / strips.width,
        "axial_induction": _ratio(across(strips.air - strips.effective), across(strips.air)),
        "tangential_induction": _ratio(along(strips.effective - strips.air), along(strips.air)),
        "circulation": strips.circulation,
    }


def whole_rotor(
    frames: Frames,
    strips: StripState,
    station_force: Array,
    station_moment: Array,
    rotor: tuple[float, float, float, float],
) -> dict[str, float | Array]:
    """The channels of the rotor and of its blades.

    ``station_force`` N and ``station_moment`` N m (B,S,3) are the loads on the frames; ``rotor``
    is air density, rotor radius, hub radius and cone angle. Means over the disc weigh each
    strip with the area it sweeps.
    """
    air_density, radius, hub_radius, cone = rotor
    shaft = frames.shaft[:, 0]
    arm = frames.position - frames.hub
    force = station_force.sum(axis=1)
    moment = (station_moment + np.cross(arm, station_force)).sum(axis=1)
    in_plane, out_of_plane = _root_moments(frames, force, moment, hub_radius, cone)
    outwards = _middles(arm)
    outwards = outwards - (outwards @ shaft)[..., None] * shaft
    area = np.linalg.norm(outwards, axis=-1) * strips.width
    area = area / area.sum()
    wind = float(np.sum(area * (strips.wind @ shaft)) - frames.hub_velocity @ shaft)
    induced = float(np.sum(area * ((strips.air - strips.effective) @ shaft)))
    thrust, torque = float(force.sum(axis=0) @ shaft), float(moment.sum(axis=0) @ shaft)
    return {
        **rotor_values(air_density, radius, wind, frames.rotor_speed, thrust, torque, induced),
        "aerodynamic_root_in_plane_moment": in_plane,
        "aerodynamic_root_out_of_plane_moment": out_of_plane,
    }


def probe_values(velocity: Array) -> Mapping[str, Array]:
    """The channels of the probes from their velocity (p,3) m/s."""
    return {c.name: velocity[:, i].copy() for i, c in enumerate(PROBE_CHANNELS)}


def _root_moments(
    frames: Frames, force: Array, moment: Array, hub_radius: float, cone: float
) -> tuple[Array, Array]:
    """Moments (B,) about the root axes, which cone with the blade and do not pitch."""
    turn = 2.0 * np.pi * np.arange(len(force)) / len(force)
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    shaft, left, up = frames.shaft.T
    outwards, across = c * up - s * left, c * left + s * up
    about = np.cos(cone) * shaft + np.sin(cone) * outwards
    root = hub_radius * (np.cos(cone) * outwards - np.sin(cone) * shaft)
    at_root = moment - np.cross(root, force)
    return np.sum(at_root * about, axis=1), np.sum(at_root * across, axis=1)


def _ratio(part: Array, whole: Array) -> Array:
    calm = np.abs(whole) <= CALM
    return np.where(calm, 0.0, part / np.where(calm, 1.0, whole))


def _middles(values: Array) -> Array:
    return 0.5 * (values[:, 1:] + values[:, :-1])
